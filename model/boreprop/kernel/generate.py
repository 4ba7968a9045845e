"""Write the C headers that repeat numbers of the Python core: ``python -m boreprop.kernel.generate``."""

from collections.abc import Sequence

from ..core import radau
from ..replacing import replacing
from .compiler import FOLDER

RADAU_TABLES = """\
/* The numbers of the Radau collocation in radau.h, generated from core/radau.py by python -m boreprop.kernel.generate:
   change them there. The tables lie column by column, so that a loop over points or parts is one over neighbours. */
#ifndef BOREPROP_RADAU_TABLES_H
#define BOREPROP_RADAU_TABLES_H

enum {{ S = {S}, POINTS = {points}, EIGENVALUES = {eigenvalues}, AT_CHECK = {at_check} }};

typedef struct {{
    double re, im;
}} Complex;

/* clang-format off */

/* The right Radau nodes on [0, 1], and between two of them the check, where the equation need not be met. */
static const double POINT[POINTS] = {POINT};

/* The eigenvalues of the inverse of the collocation matrix, one of each conjugate pair. */
static const Complex GAMMA[EIGENVALUES] = {GAMMA};

/* Parts of W times VALUES[part][k]: the step's polynomial at point k, less its start. */
static const double VALUES[S][POINTS] = {VALUES};

/* Parts of W times COEFFICIENTS[part][m]: its coefficient of t^(m+1). */
static const double COEFFICIENTS[S][S] = {COEFFICIENTS};

/* Parts of W times SLOPE[part]: its derivative at the check. */
static const double SLOPE[S] = {SLOPE};

/* Values of f at the points times INTO_PARTS[point][part]: a part of f, in which the check has no share. */
static const double INTO_PARTS[POINTS][S] = {INTO_PARTS};

/* clang-format on */

#endif
"""


def radau_tables() -> str:
    """The header radau_tables.h."""
    return RADAU_TABLES.format(
        S=radau.S,
        points=len(radau.POINTS),
        eigenvalues=len(radau.GAMMA),
        at_check=radau.AT_CHECK,
        POINT=_row(radau.POINTS),
        GAMMA=_rows([(gamma.real, gamma.imag) for gamma in radau.GAMMA]),
        VALUES=_columns(radau.VALUES),
        COEFFICIENTS=_columns(radau.COEFFICIENTS),
        SLOPE=_row(radau.SLOPE),
        INTO_PARTS=_columns(radau.INTO_PARTS),
    )


def _row(numbers: Sequence[float]) -> str:
    return "{" + ", ".join(repr(number) for number in numbers) + "}"


def _rows(table: Sequence[Sequence[float]]) -> str:
    return "{\n" + "".join(f"    {_row(row)},\n" for row in table) + "}"


def _columns(table: Sequence[Sequence[float]]) -> str:
    return _rows(list(zip(*table, strict=True)))


HEADERS = {"radau_tables.h": radau_tables}

if __name__ == "__main__":
    for name, text in HEADERS.items():
        with replacing(FOLDER / name) as draft:
            draft.write_text(text(), encoding="utf-8")

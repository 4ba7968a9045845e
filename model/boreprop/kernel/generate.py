"""Writes the C headers that follow from Python: ``python -m boreprop.kernel.generate``. A test compares them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import astuple, fields
from fractions import Fraction
from functools import cache
from hashlib import sha256

from ..core import radau
from ..core.options import Options
from ..core.problems import ANGLES, DERIVED, OUTSIDE, SENTENCES
from ..core.quantities import (
    INPUTS,
    MAX_POINTS,
    MAX_SECTIONS,
    MAX_SENSORS,
    MAX_STABILIZERS,
    MOST_DRILLED,
    OUTPUTS,
    PARAMETERS,
    QUANTITIES,
    Quantity,
    Structure,
)
from ..core.sag import OFTEN, POINTS
from ..core.system import LEAST_SPAN
from ..replacing import replacing
from .compiler import FOLDER

Table = tuple[Quantity, ...]
SYSTEM = tuple(quantity for quantity in PARAMETERS if quantity.kind != "String")
"""The parameters that the kernel has, in the order in which it takes their values."""

SIZES = {
    "1": "ONE",
    "n": "EACH_STABILIZER",
    "n-1": "EACH_NON_IDEAL",
    "uniform": "IF_UNIFORM",
    "sections": "EACH_SECTION",
    "stepped": "IF_STEPPED",
    "axial": "IF_AXIAL",
    "points": "EACH_POINT",
    "body": "IF_POINTS",
    "layered": "IF_LAYERED",
    "sensors": "EACH_SENSOR",
    "space": "IF_SPACE",
    "space n-1": "EACH_NON_IDEAL_IN_SPACE",
    "space sensors": "EACH_SENSOR_IN_SPACE",
    "space body": "IF_POINTS_IN_SPACE",
}
ROOMS = {
    "n": "[MAX_STABILIZERS]",
    "n-1": "[MAX_STABILIZERS - 1]",
    "space n-1": "[MAX_STABILIZERS - 1]",
    "sections": "[MAX_SECTIONS]",
    "points": "[MAX_POINTS]",
    "sensors": "[MAX_SENSORS]",
}
LARGEST = Structure(MAX_STABILIZERS, MAX_SECTIONS, 1, MAX_POINTS, 1, MAX_SENSORS, 1)

NAMES = {quantity.name: quantity.name for quantity in QUANTITIES} | {
    **{name: name for name in (f"{quantity.name}_slope" for quantity in INPUTS if quantity.slope)},
    **DERIVED,
    "parameters": "parameters",
    "state": "state",
    "start_time": "startTime",
    "current_time": "current_time",
    "step_size": "step_size",
    "step_end": "current_time + step_size",
    "step_length": "step_size * rate_of_penetration",
}
"""What a problem may be about → its name in messages: quantities, what is made of them, arguments of FMI calls."""

QUANTITIES_HEADER = """\
/* The table of quantities, as C needs it. Written from core/quantities.py by `python -m boreprop.kernel.generate`. */
#ifndef BOREPROP_QUANTITIES_H
#define BOREPROP_QUANTITIES_H

#include "problems.h"
#include <math.h>
#include <stddef.h>

/* clang-format off */

#define QUANTITIES_DIGEST "{digest}" /* of this file, but for this line, and of problems.h */
#define MOST_DRILLED {most_drilled!r} /* m in a communication step */
#define LEAST_SPAN {least_span!r} /* m between stabilizers, at least: forces between closer ones are rounding errors */
#define POINTS_ALONG_BHA {points} /* at which its distance from the hole is looked at */
#define OFTEN {often!r} /* of its length, at most, from look to look */

enum {{ MAX_STABILIZERS = {most}, MAX_SECTIONS = {most_sections}, MAX_POINTS = {most_points} }};
enum {{ MAX_SENSORS = {most_sensors} }};
enum {{ PARAMETER_COUNT = {parameters}, INPUT_COUNT = {inputs}, OUTPUT_COUNT = {outputs} }};

/* How a drilling system is made up, which says how many values each quantity has. */
typedef struct {{
    int n, sections; /* numbers of stabilizers and of sections */
    int axial;       /* whether the load along the beam counts */
    int points;      /* number of points at which the body between the stabilizers may touch the wall */
    int layered;     /* whether rock comes in layers by true vertical depth */
    int sensors;     /* their number */
    int space;       /* whether the hole may leave its vertical plane */
}} Structure;

/* The parameters, in SI units. */
typedef struct {{
    Structure structure;
{system}
}} System;

/* The inputs from where the bit is: their values, and the change of some per metre drilled. */
typedef struct {{
{acting}
}} Inputs;

/* How many values a quantity has. */
typedef enum {{ {sizes} }} Size;

/* A parameter or input, and its range: above < value, at_least <= value <= at_most. */
typedef struct {{
    Name name;
    Size size;
    size_t offset; /* of a parameter, in System */
    int is_whole;
    double above, at_least, at_most;
}} Quantity;

static const Quantity PARAMETER_TABLE[PARAMETER_COUNT] = {{
{parameter_table}
}};

typedef enum {{ {input_names} }} Input;
static const Quantity INPUT_TABLE[INPUT_COUNT] = {{
{input_table}
}};

/* The outputs, in their order. */
typedef enum {{
{output_names}
}} Output;
#define EACH_OUTPUT(of) {each_output}
static const Size OUTPUT_SIZE[OUTPUT_COUNT] = {{
{output_sizes}
}};
static const Name OUTPUT_NAME[OUTPUT_COUNT] = {{
{output_table}
}};
static const int OUTPUT_IS_WHOLE[OUTPUT_COUNT] = {{ {whole} }};
enum {{ MOST_PARAMETERS = {most_parameters}, MOST_OUTPUTS = {most_outputs} }}; /* values, of the largest assembly */

/* How the integrator takes its steps: core/options.py says what each is. */
typedef struct {{
    double {options};
}} Options;

static const Options USUAL_OPTIONS = {{{usual}}};

/* clang-format on */

#endif
"""

PROBLEMS_HEADER = """\
/* What can be wrong, and the sentence that says so. Written from core/problems.py by
   `python -m boreprop.kernel.generate`.

   {{name}}, {{value}}, {{before}}, {{limit}} and {{place}} stand for members of a Problem, {{count}} for its value as a
   whole number, {{unit}} for that of the limit of an angle. */
#ifndef BOREPROP_PROBLEMS_H
#define BOREPROP_PROBLEMS_H

/* clang-format off */

typedef enum {{
    NO_PROBLEM,
{codes}
    CODE_COUNT
}} Code;

/* What a problem is about: a quantity of the table, something made of quantities, or an argument of a call. */
typedef enum {{
    Q_NOTHING,
{names}
    NAME_COUNT
}} Name;

/* A format for five texts. */
#define OUTSIDE "{outside}"

static const char *const SENTENCE[CODE_COUNT] = {{
    "",
{sentences}
}};

static const char *const NAME[NAME_COUNT] = {{
    "",
{texts}
}};

static const int IS_ANGLE[NAME_COUNT] = {{{angles}}};

/* clang-format on */

#endif
"""

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

/* Values at the nodes, less the start, times DIFFERENCE[node][j]: the derivative at a node, times h. */
static const double DIFFERENCE[S][S] = {DIFFERENCE};

/* The same times POLYNOMIAL[j][m]: coefficient of t^(m+1). */
static const double POLYNOMIAL[S][S] = {POLYNOMIAL};

/* clang-format on */

#endif
"""


def acting(inputs: Table = INPUTS) -> list[tuple[str, str, str]]:
    """Name, unit and meaning of the members of the C struct Inputs."""
    members = []
    for quantity in inputs:
        if quantity.acts:
            members.append((quantity.name, quantity.unit, quantity.meaning))
            if quantity.slope:
                members.append((f"{quantity.name}_slope", f"{quantity.unit}/m", "its change per metre drilled"))
    return members


def quantities_header(system: Table = SYSTEM, inputs: Table = INPUTS, outputs: Table = OUTPUTS) -> str:
    """The text of quantities.h."""
    numbers = {
        "least_span": LEAST_SPAN,
        "most_drilled": MOST_DRILLED,
        "points": POINTS,
        "often": OFTEN,
        "most": MAX_STABILIZERS,
        "most_sections": MAX_SECTIONS,
        "most_points": MAX_POINTS,
        "most_sensors": MAX_SENSORS,
        "parameters": len(system),
        "inputs": len(inputs),
        "outputs": len(outputs),
        "system": _lines(f"double {q.name}{ROOMS.get(q.size, '')}; /* {_note(q.unit, q.meaning)} */" for q in system),
        "acting": _lines(f"double {name}; /* {_note(unit, meaning)} */" for name, unit, meaning in acting(inputs)),
        "sizes": ", ".join(SIZES.values()),
        "parameter_table": _lines(_range_row(q, f"offsetof(System, {q.name})") for q in system),
        "input_names": ", ".join(f"IN_{q.name.upper()}" for q in inputs),
        "input_table": _lines(_range_row(q, "0") for q in inputs),
        "output_names": _lines(f"OUT_{q.name.upper()}, /* {_note(q.unit, q.meaning)} */" for q in outputs),
        "each_output": " ".join(f"of(OUT_{q.name.upper()})" for q in outputs),
        "output_sizes": _lines(f"{SIZES[q.size]}, /* {q.name} */" for q in outputs),
        "output_table": _lines(f"Q_{q.name.upper()}," for q in outputs),
        "options": ", ".join(field.name for field in fields(Options)),
        "usual": ", ".join(repr(float(value)) for value in astuple(Options())),
        "whole": ", ".join(str(int(q.kind == "Integer")) for q in outputs),
        "most_parameters": sum(q.count(LARGEST) for q in system) + 2,
        "most_outputs": sum(q.count(LARGEST) for q in outputs),
    }
    text = QUANTITIES_HEADER.format(digest="", **numbers) + problems_header()
    return QUANTITIES_HEADER.format(digest=_digest(text), **numbers)


def problems_header() -> str:
    """The text of problems.h."""
    return PROBLEMS_HEADER.format(
        codes=_lines(f"{code.upper().replace(' ', '_')}," for code in SENTENCES),
        names=_lines(f"Q_{name.upper()}," for name in NAMES),
        outside=OUTSIDE.format(position="%s m", offset="%s mm", side="%s", when=" after %s m", beyond="%s mm"),
        sentences=_lines(f'"{sentence}",' for sentence in SENTENCES.values()),
        texts=_lines(f'"{text}",' for text in NAMES.values()),
        angles=", ".join(f"[Q_{name.upper()}] = 1" for name in NAMES if name in ANGLES),
    )


@cache
def quantities_digest() -> str:
    """What quantities.h says that it was made from, if it is made from the table as it is now."""
    return quantities_header().partition('QUANTITIES_DIGEST "')[2].partition('"')[0]


def _digest(text: str) -> str:
    return sha256(text.encode()).hexdigest()[:16]


def _lines(lines: Iterable[str]) -> str:
    return "\n".join(f"    {line}" for line in lines)


def _note(unit: str, meaning: str) -> str:
    return f"{unit}: {meaning}" if unit else meaning


def _range_row(quantity: Quantity, offset: str) -> str:
    bounds = ", ".join(_bound(bound) for bound in (quantity.above, quantity.at_least, quantity.at_most))
    return (
        f"{{Q_{quantity.name.upper()}, {SIZES[quantity.size]}, {offset}, {int(quantity.kind == 'Integer')}, {bounds}}},"
    )


def _bound(value: float) -> str:
    return repr(float(value)).replace("inf", "INFINITY")


def radau_tables() -> str:
    """The header radau_tables.h."""
    nodes = [point for k, point in enumerate(radau.POINTS) if k != radau.AT_CHECK]
    interpolating = [_interpolating(nodes, node) for node in nodes]
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
        DIFFERENCE=_rows([[_slope(own, node) for own in interpolating] for node in nodes]),
        POLYNOMIAL=_rows([[float(coefficient) for coefficient in own[1:]] for own in interpolating]),
    )


def _interpolating(nodes: Sequence[float], own: float) -> list[Fraction]:
    """Coefficients of t^0 … of the polynomial that is one at a node, and zero at 0 and at the others."""
    found = [Fraction(0), 1 / Fraction(own)]
    for node in nodes:
        if node != own:
            at, scale = Fraction(node), Fraction(own) - Fraction(node)
            found = [(a - at * b) / scale for a, b in zip([Fraction(0), *found], [*found, Fraction(0)], strict=True)]
    return found


def _slope(polynomial: Sequence[Fraction], t: float) -> float:
    return float(sum(m * coefficient * Fraction(t) ** (m - 1) for m, coefficient in enumerate(polynomial) if m))


def _row(numbers: Sequence[float]) -> str:
    return "{" + ", ".join(repr(number) for number in numbers) + "}"


def _rows(table: Sequence[Sequence[float]]) -> str:
    return "{\n" + "".join(f"    {_row(row)},\n" for row in table) + "}"


def _columns(table: Sequence[Sequence[float]]) -> str:
    return _rows(list(zip(*table, strict=True)))


HEADERS: dict[str, Callable[[], str]] = {
    "problems.h": problems_header,
    "quantities.h": quantities_header,
    "radau_tables.h": radau_tables,
}

if __name__ == "__main__":
    for name, text in HEADERS.items():
        with replacing(FOLDER / name) as draft:
            draft.write_text(text(), encoding="utf-8", newline="\n")

"""Reads surveys and force schedules from CSV files, see `boreprop.case.sheet` for what these may look like."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import radians
from pathlib import Path
from typing import NamedTuple

from ..core.errors import ParameterError
from ..core.quantities import QUANTITIES
from ..core.survey import Survey
from ..errors import InputError, shown
from .case import Schedule
from .sheet import Sheet, read_sheet

OTHER_UNITS = {"m": {"ft": 0.3048}, "N": {"kN": 1e3, "lbf": 4.4482216152605}}
"""Unit of a column → the ends of names under which it may stand in another unit, and what that is in the first one."""

NULLS = (-999.25, -9999.0, -9999.25)  # what loggers write where there is no value (LAS, WITSML)
LEAST_NULL = 1e30  # and beyond


def read_survey(path: str | Path) -> Survey:
    """Read a survey: a CSV file with the columns measured_depth (m) and inclination_deg (degrees).

    Depths in feet are read from a column measured_depth_ft.

    Raises
    ------
    InputError
        If the file cannot be read, an inclination is beyond ±180°, or the depths do not increase.
    """
    with naming(path):
        measured_depth, inclination_deg = _read_columns(
            path, "hole", ("measured_depth",), ("inclination_deg",)
        ).values()
        return Survey(measured_depth, tuple(map(radians, inclination_deg)))


def read_schedule(path: str | Path, bit_depth: float | None = None) -> Schedule:
    """Read a force schedule: a CSV file with the columns drilled_length or measured_depth (m), and force (N).

    They may also be drilled_length_ft or measured_depth_ft, and force_kN or force_lbf.

    Parameters
    ----------
    path
        The file.
    bit_depth
        Measured depth of the bit at the start of the run, m; None if it is not known.

    Raises
    ------
    InputError
        If the file cannot be read, has both drilled lengths and measured depths, or depths whereas that of the bit is
        not known; if the lengths do not start at 0, the depths start beyond the bit, or they do not increase.
    """
    found = _read_columns(path, "rss", ("drilled_length", "measured_depth"), ("force",))
    lengths, forces = found.values()
    with naming(path):
        if "drilled_length" in found:
            return Schedule(lengths, forces)
        if bit_depth is None:
            constraint = "must come with the depth of the bit, of which nothing is known here (use drilled_length)"
            raise ParameterError("measured_depth", constraint, lengths)
        return Schedule.by_depth(lengths, forces, bit_depth)


@contextmanager
def naming(path: str | Path) -> Iterator[None]:
    """Turn errors about what a file holds into an `InputError` that names the file."""
    try:
        yield
    except ParameterError as error:
        raise InputError(f"{path}: {error.name}: {error.constraint}, got {shown(error.value)}") from error


def _read_columns(path: str | Path, table: str, *wanted: tuple[str, ...]) -> dict[str, tuple[float, ...]]:
    """Columns of a table of a case file that stand in a CSV file of their own, in the units of the case file.

    Of each group of names it is the one that the file has: name → values.
    """
    spellings = [{heading: of for name in names for heading, of in _spellings(table, name).items()} for names in wanted]
    sheet = read_sheet(path, {heading for group in spellings for heading in group}.__contains__)
    found = {heading: group[heading] for group in spellings for heading in [_heading(sheet, group)]}
    numbers = sheet.numbers(list(found))
    for heading, column in zip(found, numbers, strict=True):
        for line, value in zip(sheet.lines, column, strict=True):
            if heading.endswith("_deg") and not -180.0 <= value <= 180.0:
                raise InputError(f"{path}:{line}: {heading}: must be between -180 and 180, got {value!r}")
            if value in NULLS or abs(value) >= LEAST_NULL:
                remedy = "which stands for no value: leave the row out"
                raise InputError(f"{path}:{line}: {heading}: must be a value, got {value!r}, {remedy}")
    return {
        of.name: tuple(column) if of.factor == 1.0 else tuple(of.factor * value for value in column)
        for of, column in zip(found.values(), numbers, strict=True)
    }


def _heading(sheet: Sheet, spellings: Mapping[str, "Spelling"]) -> str:
    """The first of some headings that a file has, all others of which must be of the same column."""
    there = [heading for heading in spellings if heading in sheet.headings]
    if not there:
        raise sheet.missing(*(f"{heading!r} ({of.unit})" for heading, of in spellings.items()))
    for other in there[1:]:
        if spellings[other].name != spellings[there[0]].name:
            both = f"{there[0]!r} and {other!r}"
            raise InputError(f"{sheet.path}: must have one of the columns {both}, got both: remove one")
    return there[0]


class Spelling(NamedTuple):
    """What a heading stands for: a column, in a unit that is `factor` times that of the column."""

    name: str
    unit: str
    factor: float


def _spellings(table: str, name: str) -> dict[str, Spelling]:
    """The headings under which a column of a table of a case file is found."""
    [quantity] = (quantity for quantity in QUANTITIES if quantity.key == f"{table}.{name}")
    unit = "degrees" if name.endswith("_deg") else quantity.unit
    others = OTHER_UNITS.get(unit, {}).items()
    return {name: Spelling(name, unit, 1.0)} | {f"{name}_{end}": Spelling(name, end, factor) for end, factor in others}

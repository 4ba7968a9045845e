"""Reads surveys and force schedules from CSV files, see `boreprop.case.sheet` for what these may look like."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import radians
from pathlib import Path

from ..core.errors import ParameterError
from ..core.quantities import QUANTITIES, columns_of
from ..core.survey import Survey
from ..errors import InputError, shown
from .case import Schedule
from .sheet import read_sheet

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
        measured_depth, inclination_deg = _read_columns(path, "hole")
        return Survey(measured_depth, tuple(map(radians, inclination_deg)))


def read_schedule(path: str | Path) -> Schedule:
    """Read a force schedule: a CSV file with the columns drilled_length (m) and force (N).

    They may also be drilled_length_ft, and force_kN or force_lbf.

    Raises
    ------
    InputError
        If the file cannot be read, or the lengths do not start at 0 or do not increase.
    """
    with naming(path):
        return Schedule(*_read_columns(path, "rss"))


@contextmanager
def naming(path: str | Path) -> Iterator[None]:
    """Turn errors about what a file holds into an `InputError` that names the file."""
    try:
        yield
    except ParameterError as error:
        raise InputError(f"{path}: {error.name}: {error.constraint}, got {shown(error.value)}") from error


def _read_columns(path: str | Path, table: str) -> list[tuple[float, ...]]:
    """The columns of a table of a case file that stands in a CSV file of its own, in the units of the case file."""
    columns = {name: _spellings(name, unit) for name, unit in _units(table).items()}
    known = {spelling for spellings in columns.values() for spelling in spellings}
    sheet = read_sheet(path, known.__contains__)
    found: dict[str, float] = {}
    for spellings in columns.values():
        spelling = next((spelling for spelling in spellings if spelling in sheet.headings), None)
        if spelling is None:
            raise sheet.missing(*(f"{spelling!r} ({unit})" for spelling, (unit, _) in spellings.items()))
        found[spelling] = spellings[spelling][1]
    numbers = sheet.numbers(list(found))
    for heading, column in zip(found, numbers, strict=True):
        for line, value in zip(sheet.lines, column, strict=True):
            if heading.endswith("_deg") and not -180.0 <= value <= 180.0:
                raise InputError(f"{path}:{line}: {heading}: must be between -180 and 180, got {value!r}")
            if value in NULLS or abs(value) >= LEAST_NULL:
                remedy = "which stands for no value: leave the row out"
                raise InputError(f"{path}:{line}: {heading}: must be a value, got {value!r}, {remedy}")
    return [
        tuple(column) if factor == 1.0 else tuple(factor * value for value in column)
        for factor, column in zip(found.values(), numbers, strict=True)
    ]


def _units(table: str) -> dict[str, str]:
    """The columns of a table of a case file, and their units there."""
    keys = {quantity.key.partition(".")[2]: quantity for quantity in QUANTITIES if quantity.key.startswith(table + ".")}
    return {name: "degrees" if name.endswith("_deg") else keys[name].unit for name in columns_of(table)}


def _spellings(name: str, unit: str) -> dict[str, tuple[str, float]]:
    """The names under which a column is found, each with its unit and with what that is in the column's own unit."""
    return {name: (unit, 1.0)} | {f"{name}_{end}": (end, factor) for end, factor in OTHER_UNITS.get(unit, {}).items()}

"""Reads surveys and schedules from CSV files, see `boreprop.case.sheet` for what these may look like."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import degrees, pi, radians
from pathlib import Path
from typing import NamedTuple

from ..core.checks import check_number
from ..core.errors import ParameterError
from ..core.quantities import CLEARANCES, QUANTITIES, Quantity, quantity_of
from ..core.survey import Survey
from ..errors import InputError, shown
from .inputs import NAMES_OF_COLUMNS, InputSchedule, Schedule
from .schedules import LENGTHS, force_schedule, input_schedule
from .sheet import Sheet, read_sheet

BY_KEY = {quantity.key: quantity for quantity in QUANTITIES if quantity.key}

OTHER_UNITS = {
    "m": {"ft": 0.3048},
    "N": {"kN": 1e3, "lbf": 4.4482216152605, "klbf": 4448.2216152605},
    "m/s": {"m_h": 1 / 3600, "ft_h": 0.3048 / 3600},
    "rad": {"deg": pi / 180},
}
"""Unit of a column → the ends of names under which it may stand in another unit, and what that is in the first one."""


ANGLES = {
    heading: quantity
    for quantity in QUANTITIES
    for heading in (f"{quantity.name}_deg", quantity.key.rpartition(".")[2])
    if quantity.unit == "rad" and quantity.key and heading.endswith("_deg")
}
"""Column of angles in degrees → its quantity."""


class Spelling(NamedTuple):
    """What a heading stands for: a column, in a unit that is `factor` times that of the column."""

    name: str
    unit: str
    factor: float


Group = dict[str, Spelling]  # headings → what they stand for: one column, or one of several
Column = tuple[float, ...]

NULLS = (-999.25, -9999.0, -9999.25)  # what loggers write where there is no value (LAS, WITSML)
LEAST_NULL = 1e30  # and beyond


def read_survey(path: str | Path) -> Survey:
    """Read a survey: a CSV file with the columns measured_depth (m), inclination_deg and perhaps azimuth_deg (degrees).

    Depths in feet are read from a column measured_depth_ft.

    Raises
    ------
    InputError
        If the file cannot be read, an inclination is beyond ±180° or an azimuth beyond ±360°, or the depths do not
        increase.
    """
    groups = [_group("hole", "measured_depth"), _group("hole", "inclination_deg")]
    with naming(path):
        columns = _read_columns(path, groups, if_there=[_group("hole", "azimuth_deg")])
        angles = (columns[name] for name in ("inclination_deg", "azimuth_deg") if name in columns)
        return Survey(columns["measured_depth"], *(tuple(map(radians, column)) for column in angles))


def read_schedule(
    path: str | Path,
    bit_depth: float | None = None,
    interpolation: str = "held",
    full_force: float | None = None,
    reference: str | Sequence[str] = (),
) -> Schedule:
    """Read a force schedule: a CSV file with the columns drilled_length or measured_depth (m), and force (N).

    They may also be drilled_length_ft or measured_depth_ft, and force_kN, force_lbf or force_klbf. A column
    toolface_deg (degrees) says to which side the force pushes.

    Parameters
    ----------
    path
        The file.
    bit_depth
        Measured depth of the bit at the start of the run, m; None if it is not known.
    interpolation
        "held" or "linear".
    full_force
        The force at a duty of 1, N; with it there are the columns duty and toolface_deg in place of the force.
    reference
        From where the toolface counts: "gravity", "north" or "frame", or one an entry; none: from the high side.

    Raises
    ------
    InputError
        If the file cannot be read, has both drilled lengths and measured depths, or depths whereas that of the bit is
        not known; if the lengths do not start at 0, the depths start beyond the bit, or they do not increase.
    """
    steering = ["force"] if full_force is None else ["duty", "toolface_deg"]
    groups = [_group("rss", *names) for names in (LENGTHS, *([name] for name in steering))]
    columns = _read_columns(path, groups, if_there=[_group("rss", "toolface_deg")] if full_force is None else [])
    with naming(path):
        return force_schedule(columns, bit_depth, interpolation, full_force, reference)


def read_inputs(
    path: str | Path, bit_depth: float | None = None, interpolation: str = "held"
) -> tuple[Schedule | None, InputSchedule | None]:
    """Read a schedule of inputs: a CSV file with the columns drilled_length or measured_depth (m), and names of inputs.

    These are in SI units; a force may also be rss_force_kN, active_weight_on_bit_lbf, …, and the rate of penetration
    rate_of_penetration_m_h or rate_of_penetration_ft_h. An input may also be called as in a case file: force,
    toolface_deg, tilt_limit_deg, ….

    Returns
    -------
    The schedule of the steering force and that of the other inputs; None of what is not there.

    Raises
    ------
    InputError
        As `read_schedule`, and if no input is there.
    """
    columns = _read_columns(path, [_group("rss", *LENGTHS)], [_input(name) for name in NAMES_OF_COLUMNS])
    with naming(path):
        return input_schedule(columns, bit_depth, interpolation)


@contextmanager
def naming(path: str | Path) -> Iterator[None]:
    """Turn errors about what a file holds into an `InputError` that names the file."""
    try:
        yield
    except ParameterError as error:
        raise InputError(f"{path}: {error.name}: {error.constraint}, got {shown(error.value)}") from error


def in_degrees(quantity: Quantity, value: object) -> str:
    """The constraint that an angle in degrees breaks; empty if it breaks none."""
    above, at_least, at_most = map(degrees, (quantity.above, quantity.at_least, quantity.at_most))
    try:
        if isinstance(value, (int, float)):
            check_number(quantity.key, value, above=above, at_least=at_least, at_most=at_most)
    except ParameterError as error:
        return error.constraint
    return ""


def _read_columns(
    path: str | Path, groups: list[Group], some_of: list[Group] | None = None, *, if_there: Sequence[Group] = ()
) -> dict[str, Column]:
    """Columns of a CSV file: of each group that of the heading that is there; name → values.

    Of the groups `some_of` at least one must be there, if they are given; of those `if_there` any may be.
    """
    everything = [heading for group in [*groups, *(some_of or []), *if_there] for heading in group]
    sheet = read_sheet(path, everything.__contains__)
    more = [group for group in [*(some_of or []), *if_there] if any(heading in sheet.headings for heading in group)]
    for group in [*(some_of or []), *if_there]:
        if group not in more:
            _check_no_other_unit(sheet, group)
    if some_of and not more:
        raise sheet.missing(*(repr(next(iter(group))) for group in some_of))
    found = {heading: group[heading] for group in [*groups, *more] for heading in [_heading(sheet, group)]}
    numbers = sheet.numbers(list(found))
    for heading, column in zip(found, numbers, strict=True):
        for line, value in zip(sheet.lines, column, strict=True):
            if heading in ANGLES and (constraint := in_degrees(ANGLES[heading], value)):
                raise InputError(f"{path}:{line}: {heading}: {constraint}, got {value!r}")
            if value in NULLS or abs(value) >= LEAST_NULL:
                remedy = "which stands for no value: leave the row out"
                raise InputError(f"{path}:{line}: {heading}: must be a value, got {value!r}, {remedy}")
    return {
        of.name: tuple(column) if of.factor == 1.0 else tuple(of.factor * value for value in column)
        for of, column in zip(found.values(), numbers, strict=True)
    }


def _heading(sheet: Sheet, spellings: Group) -> str:
    """The first of some headings that a file has, all others of which must be of the same column."""
    there = [heading for heading in spellings if heading in sheet.headings]
    if not there:
        raise sheet.missing(*(f"{heading!r} ({of.unit})" for heading, of in spellings.items()))
    for other in there[1:]:
        if spellings[other].name != spellings[there[0]].name:
            both = f"{there[0]!r} and {other!r}"
            raise InputError(f"{sheet.path}: must have one of the columns {both}, got both: remove one")
    return there[0]


def _check_no_other_unit(sheet: Sheet, spellings: Group) -> None:
    """Raise `InputError` if a column that the file lacks stands there with another ending: it would pass unread."""
    names = {heading.removesuffix(f"_{of.unit}").removesuffix("_deg") for heading, of in spellings.items()}
    for heading in sheet.headings:
        if any(heading == name or heading.startswith(f"{name}_") for name in names):
            known = " or ".join(f"{spelling!r} ({of.unit})" for spelling, of in spellings.items())
            raise InputError(f"{sheet.path}: must have the column {known}, or none of it, got {heading!r}")


def _group(table: str, *names: str) -> Group:
    """The headings under which one of some columns of a table of a case file is found."""
    units = {key: "degrees" if key.endswith("_deg") else BY_KEY[f"{table}.{key}"].unit for key in names}
    return {heading: of for name, unit in units.items() for heading, of in _spellings(name, unit).items()}


def _input(name: str) -> Group:
    """The headings under which an input is found: by its name, or by its key in a case file."""
    quantity = quantity_of(name)
    named = _spellings(name, quantity.unit)
    key = quantity.key.rpartition(".")[2]
    if name in CLEARANCES or not key:
        return named
    if key.endswith("_deg"):
        return named | {key: named[f"{name}_deg"]}
    return named | {heading: of._replace(name=name) for heading, of in _spellings(key, quantity.unit).items()}


def _spellings(name: str, unit: str) -> Group:
    """The headings under which a column is found."""
    others = OTHER_UNITS.get(unit, {}).items()
    return {name: Spelling(name, unit, 1.0)} | {f"{name}_{end}": Spelling(name, end, factor) for end, factor in others}


INPUTS_SPELLED = _group("rss", *LENGTHS) | {
    heading: of for name in NAMES_OF_COLUMNS for heading, of in _input(name).items()
}
"""Columns of a schedule of inputs, as people spell them."""

"""What is wrong with a case file, in its names and units.

The schema, pydantic and the dataclasses say it in theirs.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from pydantic_core import ErrorDetails

from ..core.errors import ParameterError
from ..core.quantities import quantity_of
from ..errors import InputError, shown
from .formations import file_degrees
from .schedules import LENGTHS
from .tables import BY_KEY, in_degrees

Document = dict[str, dict[str, Any]]  # table → key → value

TABLES = ("bha", "bit", "drilling", "hole", "rss", "run")  # of a file, in the order in which they are written

MAY_BE_ONE: dict[str, tuple[str, ...]] = {
    "hole.inclination_deg": ("measured_depth",),
    "hole.azimuth_deg": ("measured_depth",),
    "rss.toolface_deg": LENGTHS,
}
"""Angles that may be one number → the columns of which one is there, along which it then holds."""


@contextmanager
def naming_keys(table: str, source: Path) -> Iterator[None]:
    """Turn errors about what a table holds into an `InputError` that names file and key."""
    try:
        yield
    except ParameterError as error:
        quantity = quantity_of(error.name)
        key = quantity.key.rpartition(".")[2] if table != "drilling.schedule" else quantity.name
        where = f"{table}.{key}{error.name.removeprefix(quantity.name)}"
        constraint, value = error.constraint, error.value
        if key.endswith("_deg") and isinstance(value, (float, tuple)):
            value = tuple(map(file_degrees, value)) if isinstance(value, tuple) else file_degrees(value)
            constraint = in_degrees(quantity, value) or constraint
        raise InputError(f"{source}: {where}: {constraint}, got {shown(value)}") from error


def unknown_key(key: str) -> str:
    """The constraint that an unknown key breaks, with the key that was probably meant."""
    names = {table: table for table in TABLES}
    for where, quantity in BY_KEY.items():
        names |= {quantity.name: where, quantity.attribute: where, where.partition(".")[2]: where}
    meant = get_close_matches(key, names, n=1)
    return "must be a known key" + (f" ({names[meant[0]]}?)" if meant else "")


def message_of(error: ErrorDetails, document: Document) -> str:
    """The message for a wrong value, "TABLE.KEY: CONSTRAINT, got VALUE", in the names and units of the file."""
    if error["type"] == "value_error":
        return _out_of_range(error["ctx"]["error"], document)
    field = ".".join(part for part in error["loc"] if isinstance(part, str))
    index = next((part + 1 for part in error["loc"] if isinstance(part, int)), None)
    quantity = next((quantity for quantity in BY_KEY.values() if quantity.field == field), None)
    if quantity is None:  # the field is a whole part of a case: its table is missing
        where = next(key for key, quantity in BY_KEY.items() if quantity.part == field).partition(".")[0]
    else:
        where = quantity.key
    if error["type"] == "missing":
        return f"{where}: must be given, got nothing"
    return wrong_type(error, where, index, document)


def wrong_type(error: ErrorDetails, where: str, index: int | None, document: Document) -> str:
    """The message for a value, or for the one with an index in a list, that is of another type."""
    where += f"[{index}]" if index else ""
    given = written_at(document, where)
    value = shown(given)
    constraint = error["msg"].replace("Input should", "must")
    if error["type"] == "tuple_type":
        a_list = f"a list, such as [{value}]" if type(given) in (int, float) else "a list of numbers"
        constraint = f"must be a number or {a_list}" if where in MAY_BE_ONE else f"must be {a_list}"
    return f"{where}: {constraint}, got {value}"


def _out_of_range(error: ParameterError, document: Document) -> str:
    quantity, constraint, value = quantity_of(error.name), error.constraint, error.value
    where = quantity.key + error.name.removeprefix(quantity.name)
    if quantity.key.endswith("_deg"):
        value = written_at(document, where)
        constraint = in_degrees(quantity, value) or constraint
    if quantity.key.startswith("sensor."):  # sensor.position[1] stands under [[sensor]]
        where = re.sub(r"^sensor(\..+)(\[\d+\])$", r"sensor\2\1", where)
    return f"{where}: {constraint}, got {shown(value)}"


def written_at(document: Document, where: str) -> Any:
    """The value that the file has under "table.key" or "table.key[i]"; a key may itself end in an index."""
    value: Any = document
    for key in where.split("."):
        name, _, index = key.rpartition("[")
        value = value[key] if key in value else value[name][int(index[:-1]) - 1]
    return value

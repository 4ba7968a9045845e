"""Checks a case file and makes a `Case` of it.

The keys are those of the table of quantities; the types are those of the dataclasses that make up a `Case`.
"""

import json
import re
import tomllib
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict
from difflib import get_close_matches
from math import degrees, radians
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError
from pydantic_core import ErrorDetails

from ..core.checks import check_number
from ..core.errors import ParameterError
from ..core.quantities import QUANTITIES, Quantity, columns_of, quantity_of
from ..core.survey import Survey
from ..errors import InputError, shown
from .body import place_points
from .case import Case, Schedule
from .sections import lift_sections
from .tables import read_schedule, read_survey

Document = dict[str, dict[str, Any]]  # table → key → value

BY_KEY = {quantity.key: quantity for quantity in QUANTITIES if quantity.key}
DEEPEST = 100  # parts that a dotted key may have
TABLES = ("bha", "bit", "drilling", "hole", "rss", "run")  # of a file, in the order in which they are written
OF_FILES: dict[str, tuple[str, Callable[[Path], Survey | Schedule]]] = {
    "hole.survey": ("survey", read_survey),
    "rss.schedule": ("schedule", read_schedule),
}
"""Key that names a CSV file → the field of a `Case` that the file holds, and the function that reads it."""

PATHS = "must be a path with forward slashes or in single quotes, since in double quotes a backslash begins an escape"

_CASE = TypeAdapter(Case)


def parse(text: str, source: Path) -> Case:
    """See `boreprop.case.file.parse_case`."""
    document = read_toml(text, source)
    lift_sections(document, source)
    place_points(document, source)
    check_keys(document, source)
    fields = case_fields(document) | read_files(document, source)
    try:
        # Validated as JSON: there, even strict types accept an object for a dataclass and an array for a tuple.
        return _CASE.validate_json(json.dumps(fields, default=str), strict=True)
    except ValidationError as error:
        errors = error.errors(include_url=False)
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        raise InputError(f"{source}: {_message(errors[0], document)}{more}") from error


def _no_toml(error: tomllib.TOMLDecodeError, text: str) -> str:
    """What is wrong with a text that is no TOML: most often a path as Windows writes it."""
    at = re.search(r"\(at line (\d+)", str(error))
    if at:
        line = text.split("\n")[int(at[1]) - 1].strip()
        if re.search(r'"[^"]*\\', line):
            return f"line {at[1]}: {PATHS}, got {shown(line)}"
    return f"must be TOML, got: {error}"


def read_toml(text: str, source: Path) -> dict[str, Any]:
    """The document that a TOML text is; `InputError` if it is none, or holds what no case has and Python chokes on."""
    parts = re.split(r"[][{}=,#\n]", text)
    if any(len(re.findall(r"[^.]\.", part)) > DEEPEST for part in parts):  # tomllib's time goes with the square
        raise InputError(f"{source}: must be TOML with keys of at most {DEEPEST} parts, got more dots in one")
    try:
        document = tomllib.loads(text)
        json.dumps(document, default=str)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{source}: {_no_toml(error, text)}") from error
    except RecursionError as error:
        raise InputError(f"{source}: must be TOML without lists in lists, got hundreds in one another") from error
    except ValueError as error:  # an int of more digits than Python reads or writes
        raise InputError(
            f"{source}: must be TOML with numbers of usual size, got one of thousands of digits"
        ) from error
    return document


def check_keys(document: dict[str, Any], source: Path) -> None:
    """Raise `InputError` unless every key exists, and columns stand either in the case file or in a file that it names.

    Keys whose values are texts are checked for their type too; pydantic checks all other types.
    """
    for table, content in document.items():
        if table not in (*TABLES, "section"):
            raise InputError(f"{source}: {table}: {_unknown(table)}, got {shown(content)}")
        if not isinstance(content, dict):
            raise InputError(f"{source}: {table}: must be a table, got {shown(content)}")
        for key, value in content.items():
            where = f"{table}.{key}"
            if where not in BY_KEY:
                raise InputError(f"{source}: {where}: {_unknown(key)}, got {shown(value)}")
            if BY_KEY[where].kind == "String" and not isinstance(value, str):
                raise InputError(f"{source}: {where}: must be text in quotes, got {shown(value)}")
            if where in OF_FILES and any(escaped in value for escaped in "\b\t\n\f\r"):  # "\temp" begins with a tab
                raise InputError(f"{source}: {where}: {PATHS}, got {shown(value)}")
    for where in OF_FILES:
        table, _, file = where.partition(".")
        columns = columns_of(table)
        if table in document and set(document[table]) not in ({file}, set(columns)):
            constraint = f"must hold either {' and '.join(columns)}, or {file}"
            raise InputError(f"{source}: {table}: {constraint}, got {shown(document[table])}")


def case_fields(document: Document) -> dict[str, Any]:
    """The values of a case file as the fields of a `Case` and of its parts, in SI units."""
    fields: dict[str, Any] = {}
    for table, content in document.items():
        for key, value in content.items():
            quantity = BY_KEY[f"{table}.{key}"]
            if quantity.field:
                owner = fields.setdefault(quantity.part, {}) if quantity.part else fields
                owner[quantity.attribute] = _radians(value) if key.endswith("_deg") else value
    return fields


def read_files(document: Document, source: Path) -> dict[str, Any]:
    """The fields of a `Case` whose columns stand in files of their own, looked up beside the case file."""
    fields = {}
    for where, (part, read) in OF_FILES.items():
        table, _, key = where.partition(".")
        if key in document.get(table, {}):
            fields[part] = asdict(read(source.parent / document[table][key]))
    return fields


def _unknown(key: str) -> str:
    """The constraint that an unknown key breaks, with the key that was probably meant."""
    names = {table: table for table in TABLES}
    for where, quantity in BY_KEY.items():
        names |= {quantity.name: where, quantity.attribute: where, where.partition(".")[2]: where}
    meant = get_close_matches(key, names, n=1)
    return "must be a known key" + (f" ({names[meant[0]]}?)" if meant else "")


def _radians(value: Any) -> Any:
    """Degrees in radians. Anything but a number of usual size is returned as it is: the check of types reports it."""
    if isinstance(value, list):
        return [_radians(element) for element in value]
    with suppress(OverflowError):
        if type(value) in (int, float):
            return radians(value)
    return value


def _message(error: ErrorDetails, document: Document) -> str:
    """The message for a wrong value, "TABLE.KEY: CONSTRAINT, got VALUE", in the names and units of the file."""
    if error["type"] == "value_error":
        return _out_of_range(error["ctx"]["error"], document)
    field = ".".join(part for part in error["loc"] if isinstance(part, str))
    index = next((part + 1 for part in error["loc"] if isinstance(part, int)), None)
    quantity = next((quantity for quantity in BY_KEY.values() if quantity.field == field), None)
    if quantity is None:  # the field is a whole part of a case: its table is missing
        where = next(key for key, quantity in BY_KEY.items() if quantity.part == field).partition(".")[0]
    else:
        where = quantity.key + (f"[{index}]" if index else "")
    if error["type"] == "missing":
        return f"{where}: must be given, got nothing"
    constraint = "must be a list" if error["type"] == "tuple_type" else error["msg"].replace("Input should", "must")
    return f"{where}: {constraint}, got {shown(_written(document, where))}"


def _out_of_range(error: ParameterError, document: Document) -> str:
    quantity, constraint, value = quantity_of(error.name), error.constraint, error.value
    where = quantity.key + error.name.removeprefix(quantity.name)
    if quantity.key.endswith("_deg"):
        value = _written(document, where)
        constraint = _in_degrees(quantity, value) or constraint
    return f"{where}: {constraint}, got {shown(value)}"


def _in_degrees(quantity: Quantity, value: Any) -> str:
    """The constraint that an angle in degrees breaks; empty if it breaks none."""
    bounds: dict[str, Any] = {bound: degrees(getattr(quantity, bound)) for bound in ("above", "at_least", "at_most")}
    try:
        if isinstance(value, (int, float)):
            check_number(quantity.key, value, **bounds)
    except ParameterError as error:
        return error.constraint
    return ""


def _written(document: Document, where: str) -> Any:
    """The value that the file has under "table.key" or "table.key[i]"."""
    where, _, index = where.partition("[")
    table, key = where.split(".")
    value = document[table][key]
    return value[int(index[:-1]) - 1] if index else value

"""Checks a case file and makes a `Case` of it.

The keys are those of the table of quantities; the types are those of the dataclasses that make up a `Case`.
"""

import json
import re
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, replace
from difflib import get_close_matches
from math import degrees, radians
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import TypeAdapter, ValidationError
from pydantic_core import ErrorDetails

from ..core.checks import check_number
from ..core.errors import ParameterError
from ..core.quantities import BY_NAME, CLEARANCES, ROCK, Quantity, columns_of, quantity_of
from ..core.survey import Survey
from ..errors import InputError, shown
from .body import place_points
from .case import Case
from .formations import file_degrees, lift_formations, lift_wear
from .inputs import CLOSE, INTERPOLATIONS, NAMES_OF_COLUMNS, InputSchedule, Schedule
from .schedules import LENGTHS, force_schedule, input_schedule
from .sections import lift_sections
from .sensors import lift_sensors
from .tables import BY_KEY, read_inputs, read_schedule, read_survey

Document = dict[str, dict[str, Any]]  # table → key → value

IN_DEGREES = {f"{name}_deg": name for name in NAMES_OF_COLUMNS if quantity_of(name).unit == "rad"}
"""Columns of a schedule in degrees → what they stand for."""
DEEPEST = 100  # parts that a dotted key may have
TABLES = ("bha", "bit", "drilling", "hole", "rss", "run")  # of a file, in the order in which they are written
OF_FILES = ("hole.survey", "rss.schedule", "drilling.schedule")
"""Keys that name a CSV file."""

CHOICES: dict[str, tuple[tuple[str, ...], ...]] = {
    "hole": (columns_of("hole"), ("survey",)),
    "rss": (
        ("drilled_length", "force"),
        ("measured_depth", "force"),
        ("schedule",),
        ("drilled_length", "duty", "toolface_deg"),
        ("measured_depth", "duty", "toolface_deg"),
        ("drilled_length", "force", "toolface_deg"),
        ("measured_depth", "force", "toolface_deg"),
    ),
}
"""Table → the sets of keys of which it holds one."""

SCHEDULED = ("active_weight_on_bit", *ROCK)
"""Inputs that a case file gives by a key of their own, unless the schedule of the table [drilling] has them."""

BESIDE = {
    "hole": ("bit_depth", "true_vertical_depth", "azimuth_deg"),
    "rss": ("full_force", "interpolation", "toolface_reference"),
}
"""Table → the keys that may stand beside each of these sets."""

PATHS = "must be a path with forward slashes or in single quotes, since in double quotes a backslash begins an escape"

_CASE, _NUMBER, _COLUMN = TypeAdapter(Case), TypeAdapter(float), TypeAdapter(tuple[float, ...])
_TEXTS: TypeAdapter[str | tuple[str, ...]] = TypeAdapter(str | tuple[str, ...])


class Read(NamedTuple):
    """A case as its file describes it, and what was made of the file that its author may not expect: a phrase each."""

    case: Case
    notes: list[str]


def parse(text: str, source: Path) -> Read:
    """See `boreprop.case.file.parse_case`."""
    document = read_toml(text, source)
    formations, wear = lift_formations(document, source), lift_wear(document, source)
    lift_sections(document, source)
    lift_sensors(document, source)
    place_points(document, source)
    check_keys(document, source)
    repeat_angles(document)
    case, notes = _case(document, source), []
    if "bit_depth" in document["hole"]:
        bit_depth = _typed(_NUMBER, document, "hole.bit_depth", source)
        notes = _beyond(case.survey, bit_depth)
        with _naming("hole", source):
            case = replace(case, survey=case.survey.with_bit_at(bit_depth))
    bit = case.survey.measured_depth[-1]
    if "rss" in document:
        case = replace(case, schedule=_force(document, bit, source))
    if "schedule" in document["drilling"]:
        case = _with_inputs(case, document, bit, source)
    try:
        return Read(replace(case, formations=formations, wear=wear), notes)
    except ParameterError as error:
        raise InputError(f"{source}: formation: {error}") from error


def _force(document: Document, bit_depth: float, source: Path) -> Schedule:
    """The schedule of the table [rss]."""
    table = document["rss"]
    interpolation = table.get("interpolation", "held")
    full_force = _typed(_NUMBER, document, "rss.full_force", source) if "full_force" in table else None
    reference = _typed(_TEXTS, document, "rss.toolface_reference", source) if "toolface_reference" in table else ()
    if (full_force is None) == ("duty" in table) and "schedule" not in table:
        constraint = "must be given with duty and toolface_deg, and only with them"
        raise InputError(f"{source}: rss.full_force: {constraint}, got {shown(table)}")
    with _naming("rss", source):
        if "schedule" in table:
            return read_schedule(source.parent / table["schedule"], bit_depth, interpolation, full_force, reference)
        keys = [key for key in table if key not in BESIDE["rss"]]
        columns = {key: _typed(_COLUMN, document, f"rss.{key}", source) for key in keys}
        return force_schedule(columns, bit_depth, interpolation, full_force, reference)


def _with_inputs(case: Case, document: Document, bit_depth: float, source: Path) -> Case:
    """The case with the schedule of the table [drilling]."""
    table, given = document["drilling"], document["drilling"]["schedule"]
    interpolation, where = table.get("interpolation", "held"), "drilling.schedule"
    if isinstance(given, str):
        force, inputs = read_inputs(source.parent / given, bit_depth, interpolation)
    else:
        lengths = set(given) & set(LENGTHS)
        known = (*NAMES_OF_COLUMNS, *IN_DEGREES)
        if len(lengths) != 1 or len(given) == 1 or set(given) - lengths - set(known):
            constraint = f"must hold either {' or '.join(LENGTHS)}, and any of {', '.join(known)}"
            raise InputError(f"{source}: {where}: {constraint}, got {shown(given)}")
        columns = {key: _typed(_COLUMN, document, f"{where}.{key}", source) for key in given}
        for name in IN_DEGREES.keys() & columns.keys():
            columns[IN_DEGREES[name]] = tuple(map(radians, columns.pop(name)))
        with _naming(where, source):
            force, inputs = input_schedule(columns, bit_depth, interpolation)
    if force is not None:
        if "rss" in document:
            raise InputError(f"{source}: rss: must be left out where {where} gives rss_force, got both")
        case = replace(case, schedule=force)
    for name in SCHEDULED:
        _check_start(document, name, dict(inputs.inputs).get(name, ()) if inputs else (), source)
    _check_first_clearances(case, inputs, source)
    with _naming(where, source):
        scheduled = replace(case, weight_on_bit=0.0, inputs=inputs)
    with _naming("drilling", source):
        return replace(scheduled, weight_on_bit=case.weight_on_bit)


def _check_start(document: Document, name: str, scheduled: tuple[float, ...], source: Path) -> None:
    """Raise `InputError` unless an input is given by its key, or scheduled; by both only with the same start."""
    key = BY_NAME[name].key
    table, _, own = key.partition(".")
    written = document.get(table, {}).get(own)
    if written is None and not scheduled:
        raise InputError(f"{source}: {key}: must be given, got nothing")
    if written is None or not scheduled:
        return
    if (_radians(written) if key.endswith("_deg") else written) != scheduled[0]:
        start = file_degrees(scheduled[0]) if key.endswith("_deg") else scheduled[0]
        constraint = f"must be left out, or {start!r} as drilling.schedule has it at the start"
        raise InputError(f"{source}: {key}: {constraint}, got {shown(written)}")


def _check_first_clearances(case: Case, inputs: InputSchedule | None, source: Path) -> None:
    """Raise `InputError` unless clearances that are scheduled begin with those of the BHA."""
    own = dict(zip(CLEARANCES, case.bha.stabilizer_clearances, strict=False))
    for name, values in inputs.inputs if inputs else ():
        if name in own and values[0] != own[name]:
            where = f"{source}: bha.stabilizer_clearances[{CLEARANCES.index(name) + 1}]"
            raise InputError(
                f"{where}: must be {values[0]!r} as drilling.schedule has it at the start, got {own[name]!r}"
            )


def _case(document: Document, source: Path) -> Case:
    """The case with its survey as it is given, and without a schedule that depends on where the bit is."""
    fields = case_fields(document)
    if "survey" in document.get("hole", {}):
        fields["survey"] = asdict(_surveyed(document, source))
    fields.pop("schedule", None)
    if "schedule" in document.get("drilling", {}):  # what it holds takes the place of these
        for name in SCHEDULED:
            quantity = BY_NAME[name]
            (fields.setdefault(quantity.part, {}) if quantity.part else fields).setdefault(quantity.attribute, 1.0)
    try:
        # Validated as JSON: there, even strict types accept an object for a dataclass and an array for a tuple.
        return _CASE.validate_json(json.dumps(fields, default=str), strict=True)
    except ValidationError as error:
        errors = error.errors(include_url=False)
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        raise InputError(f"{source}: {_message(errors[0], document)}{more}") from error


def repeat_angles(document: Document) -> None:
    """Let an angle that is one number stand for a column of it."""
    hole = ("measured_depth",)
    for where, along in (("hole.inclination_deg", hole), ("hole.azimuth_deg", hole), ("rss.toolface_deg", LENGTHS)):
        name, _, key = where.partition(".")
        table = document.get(name, {})
        columns = [table[other] for other in along if isinstance(table.get(other), list)]
        if type(table.get(key)) in (int, float) and columns:
            table[key] = [table[key]] * len(columns[0])


def _surveyed(document: Document, source: Path) -> Survey:
    """The survey in the file that the table [hole] names, of the azimuth there if the file has none."""
    survey = read_survey(source.parent / document["hole"]["survey"])
    if "azimuth_deg" not in document["hole"]:
        return survey
    azimuth = _typed(_NUMBER, document, "hole.azimuth_deg", source)
    if survey.azimuth:
        constraint = f"must be left out, since {document['hole']['survey']} has a column azimuth_deg"
        raise InputError(f"{source}: hole.azimuth_deg: {constraint}, got {azimuth!r}")
    with _naming("hole", source):
        return replace(survey, azimuth=(radians(azimuth),) * len(survey.measured_depth))


def _beyond(survey: Survey, bit_depth: float) -> list[str]:
    """What is made of the hole between the bit and the end of its survey, if they are not at the same place."""
    end = survey.measured_depth[-1]
    if bit_depth - end > CLOSE:
        return [f"hole.bit_depth: {bit_depth - end:.4g} m beyond the survey: the hole is extended straight to the bit"]
    if end - bit_depth > CLOSE:
        return [f"hole.bit_depth: {end - bit_depth:.4g} m before the end of the survey: what lies beyond is left out"]
    return []


def _typed(kind: TypeAdapter[Any], document: Document, where: str, source: Path) -> Any:
    """The value under "table.key" or "table.key.key", which must be of a kind."""
    try:
        return kind.validate_json(json.dumps(_written(document, where), default=str), strict=True)
    except ValidationError as error:
        [first, *_] = error.errors(include_url=False)
        index = next((part + 1 for part in first["loc"] if isinstance(part, int)), None)
        raise InputError(f"{source}: {_wrong_type(first, where, index, document)}") from error


@contextmanager
def _naming(table: str, source: Path) -> Iterator[None]:
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
            constraint = _in_degrees(quantity, value) or constraint
        raise InputError(f"{source}: {where}: {constraint}, got {shown(value)}") from error


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
        if table not in (*TABLES, "section", "sensor"):
            raise InputError(f"{source}: {table}: {_unknown(table)}, got {shown(content)}")
        if not isinstance(content, dict):
            raise InputError(f"{source}: {table}: must be a table, got {shown(content)}")
        for key, value in content.items():
            where = f"{table}.{key}"
            if where not in BY_KEY:
                raise InputError(f"{source}: {where}: {_unknown(key)}, got {shown(value)}")
            if where == "drilling.schedule" and isinstance(value, dict):
                continue
            if BY_KEY[where].kind == "String" and not isinstance(value, str):
                raise InputError(f"{source}: {where}: must be text in quotes, got {shown(value)}")
            if where.endswith(".interpolation") and value not in INTERPOLATIONS:
                raise InputError(f"{source}: {where}: must be {' or '.join(INTERPOLATIONS)}, got {shown(value)}")
            if where in OF_FILES and any(escaped in value for escaped in "\b\t\n\f\r"):  # "\temp" begins with a tab
                raise InputError(f"{source}: {where}: {PATHS}, got {shown(value)}")
    for table, choices in CHOICES.items():
        given = set(document.get(table, {})) - set(BESIDE.get(table, ()))
        if table in document and given not in map(set, choices):
            constraint = f"must hold either {', or '.join(map(' and '.join, choices))}"
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
        where = quantity.key
    if error["type"] == "missing":
        return f"{where}: must be given, got nothing"
    return _wrong_type(error, where, index, document)


def _wrong_type(error: ErrorDetails, where: str, index: int | None, document: Document) -> str:
    """The message for a value, or for the one with an index in a list, that is of another type."""
    where += f"[{index}]" if index else ""
    value = shown(_written(document, where))
    constraint = f"must be a list, such as [{value}]" if error["type"] == "tuple_type" else error["msg"]
    return f"{where}: {constraint.replace('Input should', 'must')}, got {value}"


def _out_of_range(error: ParameterError, document: Document) -> str:
    quantity, constraint, value = quantity_of(error.name), error.constraint, error.value
    where = quantity.key + error.name.removeprefix(quantity.name)
    if quantity.key.endswith("_deg"):
        value = _written(document, where)
        constraint = _in_degrees(quantity, value) or constraint
    if quantity.key.startswith("sensor."):  # sensor.position[1] stands under [[sensor]]
        where = re.sub(r"^sensor(\..+)(\[\d+\])$", r"sensor\2\1", where)
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
    """The value that the file has under "table.key" or "table.key[i]"; a key may itself end in an index."""
    value: Any = document
    for key in where.split("."):
        name, _, index = key.rpartition("[")
        value = value[key] if key in value else value[name][int(index[:-1]) - 1]
    return value

"""Checks a case file and makes a `Case` of it.

The keys are those of the table of quantities; the types are those of the dataclasses that make up a `Case`.
"""

import json
import re
import tomllib
from contextlib import suppress
from dataclasses import asdict, replace
from math import isclose, radians
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import TypeAdapter, ValidationError

from ..core.errors import ParameterError
from ..core.quantities import BY_NAME, CLEARANCES, ROCK, columns_of
from ..core.survey import Survey
from ..errors import InputError, shown
from .body import place_points
from .case import Case, in_dimensions
from .formations import file_degrees, lift_formations, lift_wear
from .inputs import CLOSE, INTERPOLATIONS, NAMES_OF_COLUMNS, InputSchedule, Schedule
from .messages import MAY_BE_ONE, TABLES, Document, message_of, naming_keys, unknown_key, written_at, wrong_type
from .schedules import LENGTHS, force_schedule, input_schedule
from .sections import lift_sections
from .sensors import lift_sensors
from .tables import ANGLES, BY_KEY, INPUTS_SPELLED, in_degrees, read_inputs, read_schedule, read_survey

ROUNDING = 1e-15  # relative: not every angle in radians is one in degrees
DEEPEST = 100  # parts that a dotted key may have
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
        with naming_keys("hole", source):
            case = replace(case, survey=case.survey.with_bit_at(bit_depth))
    bit = case.survey.measured_depth[-1]
    if "rss" in document:
        case = replace(case, schedule=_force(document, bit, source))
    if "schedule" in document["drilling"]:
        case = _with_inputs(case, document, bit, source)
    if "dimensions" in document["drilling"]:
        with naming_keys("drilling", source):
            case = in_dimensions(case, case.dimensions)
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
    with naming_keys("rss", source):
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
        columns = _scheduled(document, source)
        with naming_keys(where, source):
            force, inputs = input_schedule(columns, bit_depth, interpolation)
    if force is not None:
        if "rss" in document:
            raise InputError(f"{source}: rss: must be left out where {where} gives rss_force, got both")
        case = replace(case, schedule=force)
    for name in SCHEDULED:
        _check_start(document, name, dict(inputs.inputs).get(name, ()) if inputs else (), source)
    _check_first_clearances(case, inputs, source)
    with naming_keys(where, source):
        scheduled = replace(case, weight_on_bit=0.0, inputs=inputs)
    with naming_keys("drilling", source):
        return replace(scheduled, weight_on_bit=case.weight_on_bit)


def _scheduled(document: Document, source: Path) -> dict[str, tuple[float, ...]]:
    """The columns of the schedule that stands in the table [drilling], spelled as in a CSV file, in SI units."""
    given, where = document["drilling"]["schedule"], "drilling.schedule"
    lengths = [key for key in given if key in INPUTS_SPELLED and INPUTS_SPELLED[key].name in LENGTHS]
    if len(lengths) != 1 or len(given) == 1 or given.keys() - INPUTS_SPELLED.keys():
        known = (*NAMES_OF_COLUMNS, *(key for key in INPUTS_SPELLED if key in ANGLES))
        constraint = f"must hold either {' or '.join(LENGTHS)}, and any of {', '.join(known)}"
        raise InputError(f"{source}: {where}: {constraint}, got {shown(given)}")
    columns: dict[str, tuple[float, ...]] = {}
    for key in given:
        of, values = INPUTS_SPELLED[key], _typed(_COLUMN, document, f"{where}.{key}", source)
        for index, value in enumerate(values if key in ANGLES else (), 1):
            if constraint := in_degrees(ANGLES[key], value):
                raise InputError(f"{source}: {where}.{key}[{index}]: {constraint}, got {value!r}")
        if of.name in columns:
            raise InputError(
                f"{source}: {where}.{key}: must be left out, since another column gives {of.name}, got both"
            )
        columns[of.name] = values if of.factor == 1.0 else tuple(of.factor * value for value in values)
    return columns


def _check_start(document: Document, name: str, scheduled: tuple[float, ...], source: Path) -> None:
    """Raise `InputError` unless an input is given by its key, or scheduled; by both only with the same start."""
    key = BY_NAME[name].key
    table, _, own = key.partition(".")
    written = document.get(table, {}).get(own)
    if written is None and not scheduled:
        raise InputError(f"{source}: {key}: must be given, got nothing")
    if written is None or not scheduled:
        return
    given = _radians(written) if key.endswith("_deg") else written
    if given != scheduled[0] and not (isinstance(given, float) and isclose(given, scheduled[0], rel_tol=ROUNDING)):
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
        raise InputError(f"{source}: {message_of(errors[0], document)}{more}") from error


def repeat_angles(document: Document) -> None:
    """Let an angle that is one number stand for a column of it."""
    for where, along in MAY_BE_ONE.items():
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
    with naming_keys("hole", source):
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
        return kind.validate_json(json.dumps(written_at(document, where), default=str), strict=True)
    except ValidationError as error:
        [first, *_] = error.errors(include_url=False)
        index = next((part + 1 for part in first["loc"] if isinstance(part, int)), None)
        raise InputError(f"{source}: {wrong_type(first, where, index, document)}") from error


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
            raise InputError(f"{source}: {table}: {unknown_key(table)}, got {shown(content)}")
        if not isinstance(content, dict):
            raise InputError(f"{source}: {table}: must be a table, got {shown(content)}")
        for key, value in content.items():
            where = f"{table}.{key}"
            if where not in BY_KEY:
                raise InputError(f"{source}: {where}: {unknown_key(key)}, got {shown(value)}")
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


def _radians(value: Any) -> Any:
    """Degrees in radians. Anything but a number of usual size is returned as it is: the check of types reports it."""
    if isinstance(value, list):
        return [_radians(element) for element in value]
    with suppress(OverflowError):
        if type(value) in (int, float):
            return radians(value)
    return value

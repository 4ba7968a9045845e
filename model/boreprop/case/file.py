"""Reads and writes case files, which are TOML.

A file has angles in degrees, a `Case` in radians. The table of quantities says which key of the file is which field of
the case.
"""

from dataclasses import asdict
from operator import attrgetter
from pathlib import Path
from typing import Any

import tomli_w

from ..core.columns import regular
from ..core.quantities import CLEARANCES, QUANTITIES, TOOLFACE_REFERENCES
from ..errors import InputError
from .case import Case
from .formations import file_degrees, formations_in_file
from .messages import TABLES
from .schema import OF_FILES, Read, parse, read_toml
from .sections import sections_in_file
from .sensors import sensors_in_file


def load_case(path: str | Path) -> Case:
    r"""Read a case file.

    Parameters
    ----------
    path
        The TOML file. Files that it names (a survey, a schedule) are looked up relative to its directory.

    Returns
    -------
    Case
        What is drilled, in SI units.

    Raises
    ------
    InputError
        If a file cannot be read, a key is missing or unknown, or a value breaks its constraint, among them that each
        clearance is less than the radius of the hole. The message names file, key, constraint and value.

    Examples
    --------
    A file that lacks a table is refused, in one line:

    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from boreprop import BorepropError, load_case
    >>> with TemporaryDirectory() as directory:
    ...     path = Path(directory, "case.toml")
    ...     _ = path.write_text("[drilling]\nlength = 100.0\nactive_weight_on_bit = 6e4\n")
    ...     try:
    ...         load_case(path)
    ...     except BorepropError as error:
    ...         print(str(error).partition("case.toml: ")[2])
    bha: must be given, got nothing (and 3 more)
    """
    return read_case(path).case


def read_case(path: str | Path) -> Read:
    """Read a case file, see `load_case`, with what was made of it that its author may not expect."""
    try:
        text = regular(path).read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: must be a readable TOML file, got: {error.strerror}") from error
    except UnicodeDecodeError as error:
        constraint = "must be a TOML file in UTF-8 (save it with that encoding)"
        raise InputError(f"{path}: {constraint}, got the byte 0x{error.object[error.start]:02x}") from error
    read = parse(text, Path(path))
    _check_clearances(read.case, path)
    return read


def _check_clearances(case: Case, path: str | Path) -> None:
    """Raise `InputError` unless the stabilizers have blades: a clearance is less than the radius of the hole.

    Of a file only, which has the numbers of a rig. What is drilled does not depend on the diameter, so that a case made
    in Python may have a stabilizer that never touches the wall.
    """
    clearances, radius = case.bha.stabilizer_clearances, case.bit_diameter / 2
    columns: dict[str, tuple[float, ...]] = {
        f"bha.stabilizer_clearances[{i}]": (value,) for i, value in enumerate(clearances, 1)
    }
    if case.inputs is not None:
        columns |= {f"drilling.schedule.{name}": column for name, column in case.inputs.inputs if name in CLEARANCES}
    for key, values in columns.items():
        if max(values) >= radius:
            raise InputError(f"{path}: {key}: must be < bit.diameter/2 = {radius:g}, got {max(values)!r}")


def parse_case(text: str, source: str | Path) -> Case:
    """The case that the text of a case file describes.

    Parameters
    ----------
    text
        The content of the file, TOML.
    source
        The path of the file. Errors name it, and files that the text names are looked up relative to its directory.

    Raises
    ------
    InputError
        If the text, or a file that it names, is malformed or breaks a constraint.
    """
    return parse(text, Path(source)).case


def files_named(path: Path) -> list[Path]:
    """The files that a case file names, there or not; none if it cannot be read, as `load_case` then says."""
    try:
        document = read_toml(regular(path).read_text(encoding="utf-8-sig"), path)
    except (OSError, UnicodeDecodeError, InputError):
        return []
    places = [where.split(".") for where in OF_FILES]
    tables = [(document.get(table), key) for table, key in places]
    names = [content.get(key) for content, key in tables if isinstance(content, dict)]
    return [path.parent / name for name in names if isinstance(name, str)]


def read_run(text: str) -> dict[str, str]:
    """The table [run] of a case file, which `dump_case` wrote; empty if the text has none or is not TOML."""
    try:
        run = read_toml(text, Path()).get("run", {})
        return {key: str(value) for key, value in run.items()}
    except (InputError, AttributeError):
        return {}


def dump_case(case: Case, **run: str | None) -> str:
    """The text of a case file that names no other file. `parse_case` gives the same case back.

    Parameters
    ----------
    case
        The case to write.
    run
        Facts about a run of the case, written to the table [run]: ``engine``, and ``stopped``, the reason why the run
        ended early. None is not written. `read_run` gives them back.
    """
    document: dict[str, Any] = {table: {} for table in TABLES if table != "run"}
    for quantity in QUANTITIES:
        there = quantity.size == "n-1" or quantity.count(case.structure)  # none: an empty list
        if quantity.key and quantity.field and there:
            table, key = quantity.key.split(".")
            value = attrgetter(quantity.field)(case)
            left_out = value in (quantity.start, ()) if isinstance(value, tuple) else value == quantity.start
            if left_out and quantity.size != "n-1":
                continue
            kinds = {"String": str, "Boolean": bool, "Integer": int}
            written = file_degrees if key.endswith("_deg") else kinds.get(quantity.kind, float)
            columns = document.setdefault(table, {})
            columns[key] = list(map(written, value)) if isinstance(value, tuple) else written(value)
    if set(case.schedule.toolface_reference) - {TOOLFACE_REFERENCES[0]}:
        document["rss"]["toolface_reference"] = list(case.schedule.toolface_reference)
    if "section" in document:
        document["bha"]["section"] = sections_in_file(document.pop("section"))
    if "sensor" in document:
        document["sensor"] = sensors_in_file(document["sensor"])
    if case.inputs is not None:
        entries = {"drilled_length": case.inputs.drilled_length, **dict(case.inputs.inputs)}
        document["drilling"]["schedule"] = {name: list(map(float, values)) for name, values in entries.items()}
        if case.inputs.interpolation != "held":
            document["drilling"]["interpolation"] = case.inputs.interpolation
    if case.wear is not None:
        document["bit"]["wear"] = asdict(case.wear)
    if case.formations:
        document["formation"] = formations_in_file(case.formations)
    facts = {key: text for key, text in run.items() if text is not None}
    if facts:
        document["run"] = facts
    return tomli_w.dumps(document)

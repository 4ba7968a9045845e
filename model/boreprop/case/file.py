"""A case: what is drilled, with what, from where, under which steering force. Read from and written to TOML.

The file speaks the field's language (long names, degrees), a `Case` the core's (SI, radians). The table of quantities
says which key of the file is which field of the case.
"""

import tomllib
from math import degrees, radians
from operator import attrgetter
from pathlib import Path
from typing import Any

import tomli_w

from ..core.quantities import QUANTITIES
from ..errors import InputError
from .case import Case
from .schema import TABLES, parse


def load_case(path: str | Path) -> Case:
    """Read a case file; `InputError` if it cannot be read or breaks a constraint."""
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: must be a readable TOML file, got: {getattr(error, 'strerror', error)}") from error
    return parse_case(text, path)


def parse_case(text: str, source: str | Path) -> Case:
    """The case that `text` (TOML) describes.

    Parameters
    ----------
    text
        The content of a case file.
    source
        Its path: named in errors, and the files that it refers to are looked up beside it.

    Raises
    ------
    InputError
        If the text is no TOML, breaks a constraint, or refers to a file that does.
    """
    return parse(text, Path(source))


def read_run(text: str) -> dict[str, str]:
    """What the text of a case file says of a run of the case: see `dump_case`. Nothing, if it is no case file."""
    try:
        run = tomllib.loads(text).get("run", {})
        return {key: str(value) for key, value in run.items()}
    except (tomllib.TOMLDecodeError, AttributeError):
        return {}


def dump_case(case: Case, **run: str | None) -> str:
    """`case` as the text of a case file that refers to no other file; `parse_case` gives the same case back.

    Parameters
    ----------
    case
        What to write.
    run
        What to say of a run of it: ``engine``, and ``stopped``, why it stopped before its end. `read_run` gives that
        back.
    """
    document: dict[str, dict[str, Any]] = {table: {} for table in TABLES if table != "run"}
    for quantity in QUANTITIES:
        if quantity.key and quantity.field:
            table, key = quantity.key.split(".")
            value = attrgetter(quantity.field)(case)
            written = _file_degrees if key.endswith("_deg") else float
            document[table][key] = list(map(written, value)) if isinstance(value, tuple) else written(value)
    told = {key: text for key, text in run.items() if text is not None}
    if told:
        document["run"] = told
    return tomli_w.dumps(document)


def _file_degrees(angle: float) -> float:
    """The degrees that a person would have written for `angle`, rad, if there are such; else the nearest."""
    short = round(degrees(angle), 10)
    return short if radians(short) == angle else degrees(angle)

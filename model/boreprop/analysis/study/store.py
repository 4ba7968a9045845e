"""The file of a study, .parquet or .csv: a line for each case, and what was computed of which case.

What was computed, and the case that was varied, are in the metadata of a Parquet file; with a CSV file they are in the
case file beside it (study.csv, study.case.toml). A value that is missing is an empty cell of a CSV file.
"""

import csv
import json
from collections.abc import Callable, Mapping, Sequence
from math import isnan, nan
from pathlib import Path
from typing import Any, NamedTuple

from ...case.case import Case
from ...case.file import dump_case, read_run
from ...core.columns import regular
from ...errors import InputError, shown
from ...replacing import replacing
from ...run.files import MARK, case_path, check_case_beside
from ...run.results import CASE_KEY

Line = dict[str, Any]  # has "case", the varied parameters, the results, and "error": None or the message
Columns = Mapping[str, Sequence[Any]]

STUDY_KEY = b"boreprop.study"


class Stored(NamedTuple):
    """What the file of a study holds: the names of its columns, its lines, what was computed, and the case file."""

    columns: list[str]
    lines: list[Line]
    identity: dict[str, str]
    case: str


def write(path: Path, columns: Columns, identity: dict[str, str], case: Case) -> None:
    """Write the file of a study. An existing file is replaced only once the new one is complete."""
    _store(path)[1](path, columns, identity, case)


def read(path: Path) -> Stored:
    """Read the file of a study; `InputError` if it is none."""
    return _store(path)[0](path)


def check(path: Path) -> None:
    """Raise `InputError` unless a study can have a file of this name."""
    _store(path)
    check_case_beside(path)


def _write_csv(path: Path, columns: Columns, identity: dict[str, str], case: Case) -> None:
    check_case_beside(path)
    with replacing(path) as draft:
        with open(draft, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            writer.writerows(map(_cell, line) for line in zip(*columns.values(), strict=True))
        with replacing(case_path(path)) as beside:
            beside.write_text(MARK + dump_case(case, study=json.dumps(identity)), encoding="utf-8")


def _cell(value: float | str | None) -> str:
    """A value as text, of which `_value` makes the same."""
    if value is None or (isinstance(value, float) and isnan(value)):
        return ""
    return value if isinstance(value, str) else repr(value)


def _write_parquet(path: Path, columns: Columns, identity: dict[str, str], case: Case) -> None:
    import pyarrow
    import pyarrow.parquet

    types = {"case": pyarrow.int64(), "error": pyarrow.string()}
    schema = pyarrow.schema(
        [(name, types.get(name, pyarrow.float64())) for name in columns],
        metadata={STUDY_KEY: json.dumps(identity), CASE_KEY: dump_case(case)},
    )
    with replacing(path) as draft:
        pyarrow.parquet.write_table(pyarrow.table(dict(columns), schema=schema), draft)


def _read_csv(path: Path) -> Stored:
    beside = case_path(path)
    try:
        case = regular(beside).read_text(encoding="utf-8")
        with open(regular(path), encoding="utf-8", newline="") as file:
            [columns, *rows] = csv.reader(file, strict=True)
    except (OSError, UnicodeDecodeError, csv.Error, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path}: must be the file of a study, with {beside.name} beside it, got: {reason}") from error
    study = read_run(case).get("study")
    if study is None or not {"case", "error"} <= set(columns):
        raise InputError(f"{path}: must be the file of a study, got columns {shown(columns)}")
    lines = []
    for number, row in enumerate(rows, start=2):
        if len(row) != len(columns):
            raise InputError(f"{path}:{number}: must have {len(columns)} values like the header, got {len(row)}")
        lines.append({name: _value(path, number, name, cell) for name, cell in zip(columns, row, strict=True)})
    return Stored(columns, lines, json.loads(study), case)


def _value(path: Path, number: int, name: str, cell: str) -> float | str | None:
    """The value in a cell."""
    if name == "error":
        return cell or None
    try:
        return int(cell) if name == "case" else float(cell or nan)
    except ValueError as error:
        raise InputError(f"{path}:{number}: {name}: must be a number, got {cell!r}") from error


def _read_parquet(path: Path) -> Stored:
    import pyarrow
    import pyarrow.parquet

    try:
        table = pyarrow.parquet.read_table(regular(path))
    except (OSError, pyarrow.ArrowException) as error:
        raise InputError(f"{path}: must be a readable Parquet file, got: {error}") from error
    metadata = table.schema.metadata or {}
    if STUDY_KEY not in metadata:
        raise InputError(f"{path}: must be the file of a study, got columns {shown(table.column_names)}")
    identity, case = json.loads(metadata[STUDY_KEY]), metadata[CASE_KEY].decode()
    return Stored(table.column_names, table.to_pylist(), identity, case)


STORES: dict[str, tuple[Callable[[Path], Stored], Callable[[Path, Columns, dict[str, str], Case], None]]] = {
    ".csv": (_read_csv, _write_csv),
    ".parquet": (_read_parquet, _write_parquet),
}
"""Ending → the functions that read and write the file."""


def _store(path: Path) -> tuple[Callable[[Path], Stored], Callable[[Path, Columns, dict[str, str], Case], None]]:
    if path.suffix not in STORES:
        raise InputError(f"{path}: must end in {' or '.join(STORES)}, got {path.suffix!r}")
    return STORES[path.suffix]

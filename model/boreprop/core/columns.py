"""Columns of numbers from a CSV file with a header row: surveys and force schedules."""

import csv
from errno import EINVAL
from math import isfinite
from pathlib import Path

from .errors import TableError


def regular(path: str | Path) -> Path:
    """The path of a file to read; `OSError` if it is a pipe or a device, from which reading might never end."""
    path = Path(path)
    if "\0" in str(path):
        raise OSError(EINVAL, "a name with a null character", str(path))
    if path.exists() and not (path.is_file() or path.is_dir()):  # a directory cannot be read, as the system will say
        raise OSError(EINVAL, "a pipe or a device", str(path))
    return path


def read_columns(path: str | Path, names: tuple[str, ...]) -> list[tuple[float, ...]]:
    """Read the named columns of a CSV file, in the order of `names`; other columns are ignored.

    Raises
    ------
    TableError
        If the file cannot be read, a column is missing, a row is ragged, or a value is not a finite number.
    """
    try:
        with open(regular(path), newline="", encoding="utf-8-sig") as file:
            rows = [(number, row) for number, row in enumerate(csv.reader(file), start=1) if row]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise TableError(f"{path}: must be a readable CSV file, got: {reason}") from error
    header = [name.strip() for name in rows[0][1]] if rows else []
    for name in names:
        if name not in header:
            raise TableError(f"{path}: must have a column {name!r}, got {header}")
    columns: list[list[float]] = [[] for _ in names]
    for number, row in rows[1:]:
        if len(row) != len(header):
            raise TableError(f"{path}:{number}: must have {len(header)} values like the header, got {len(row)}")
        for column, name in zip(columns, names, strict=True):
            text = row[header.index(name)]
            try:
                value = float(text)
            except ValueError:
                value = float("nan")
            if not isfinite(value):
                raise TableError(f"{path}:{number}: {name}: must be a finite number, got {text!r}")
            column.append(value)
    return [tuple(column) for column in columns]

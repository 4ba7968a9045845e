"""Columns of numbers from a plain CSV file: the survey that a host names to an FMU.

This reader travels inside the FMU, and its twin in C does the same. It takes the plain form only: UTF-8, commas,
decimal points, the units of the case file. `boreprop.case.sheet` reads what else people have.
"""

import csv
from errno import EINVAL
from math import isfinite
from pathlib import Path

from .errors import TableError

PLAIN = "plain CSV: UTF-8, commas, decimal points, depths in m, inclinations in degrees"


def regular(path: str | Path) -> Path:
    """The path of a file to read; `OSError` if it is a pipe or a device, from which reading might never end."""
    path = Path(path)
    if "\0" in str(path):
        raise OSError(EINVAL, "a name with a null character", str(path))
    if path.exists() and not (path.is_file() or path.is_dir()):  # a directory cannot be read, as the system will say
        raise OSError(EINVAL, "a pipe or a device", str(path))
    return path


def read_columns(path: str | Path, names: tuple[str, ...]) -> list[tuple[float, ...]]:
    """Read the named columns of a CSV file, in the order of `names`; other columns and rows of empty cells are ignored.

    Raises
    ------
    TableError
        If the file cannot be read, a column is missing, a row is ragged, a value is not a finite number, or one in a
        column whose name ends in _deg is beyond ±180.
    """
    try:
        with open(regular(path), newline="", encoding="utf-8-sig") as file:
            rows = [(number, row) for number, row in enumerate(csv.reader(file), start=1) if any(map(_text, row))]
    except UnicodeDecodeError as error:
        raise TableError(f"{path}: must be a readable CSV file, got: bytes that are no UTF-8 text") from error
    except (OSError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise TableError(f"{path}: must be a readable CSV file, got: {reason}") from error
    header = [name.strip() for name in rows[0][1]] if rows else []
    for name in names:
        if name not in header:
            raise TableError(f"{path}: must have a column {name!r} ({PLAIN}), got {header}")
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
            if name.endswith("_deg") and abs(value) > 180.0:
                raise TableError(f"{path}:{number}: {name}: must be between -180 and 180, got {text!r}")
            column.append(value)
    return [tuple(column) for column in columns]


def _text(cell: str) -> str:
    """A cell without the spaces around it, which are those of ASCII."""
    return cell.strip(" \t\v\f\r\n")

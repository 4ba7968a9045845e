"""Tables and JSON on the terminal."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table


def print_table(
    lines: Iterable[Sequence[str]],
    headings: Sequence[str],
    *,
    title: str | None = None,
    caption: str | None = None,
    width: int | None = None,
) -> None:
    """Print a table: `lines`, each with a cell under each heading. `width`, in characters, is else the terminal's."""
    table = Table(*headings, title=title, caption=caption)
    for line in lines:
        table.add_row(*line)
    Console(width=width).print(table)


def print_json(document: Any) -> None:
    """Print a document as JSON, see `plain`."""
    print(json.dumps(plain(document)))


def plain(value: Any) -> Any:
    """A value as what JSON has: fields of records by name, arrays as lists, null for what is not a finite number."""
    if is_dataclass(value):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return plain(value._asdict())
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    return None if isinstance(value, float) and not isfinite(value) else value

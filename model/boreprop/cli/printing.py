"""Tables and JSON on the terminal, or in a pipe or file."""

import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any

import numpy as np
from rich.cells import cell_len
from rich.console import Console
from rich.table import Table

from .console import color_system
from .signs import written

PIPE_WIDTH = 80  # characters of a table in a pipe or file
KEPT_IN_PIPE = 30  # characters of a line that is not wrapped there: numbers, ranges and short texts stay whole


def print_table(
    lines: Iterable[Sequence[str]],
    headings: Sequence[str],
    *,
    title: str | None = None,
    caption: str | None = None,
    width: int = 0,
) -> None:
    """Print a table: `lines`, each with a cell under each heading.

    Long lines are wrapped between words to the width of the terminal, or to `width`, characters, if that is more. In a
    pipe or file the width is 80, and only lines of more than 30 characters are wrapped. No word is cut anywhere.
    """
    encoding = sys.stdout.encoding
    title, caption = (text and written(text, encoding) for text in (title, caption))
    rows = [[written(cell, encoding) for cell in line] for line in (headings, *lines)]
    frame = 3 * len(headings) + 1
    on_terminal = sys.stdout.isatty()
    room = max(Console().width if on_terminal else PIPE_WIDTH, width) - frame
    widths = column_widths(rows, room, 0 if on_terminal else KEPT_IN_PIPE)
    table = Table(title=title, caption=caption)
    for heading, column_width in zip(rows[0], widths, strict=True):
        table.add_column(heading, width=column_width)
    for row in rows[1:]:
        table.add_row(*row)
    Console(width=sum(widths) + frame, color_system=color_system(), markup=False, emoji=False).print(table)


def column_widths(rows: Sequence[Sequence[str]], room: int, kept: int) -> list[int]:
    """The widths of columns that fit into a room, if they can.

    Where there is too little room the longest lines are wrapped first. No column is narrower than its longest word, nor
    than its lines of up to `kept` characters.
    """
    columns = list(zip(*rows, strict=True))
    most = [max(cell_len(line) for cell in column for line in cell.splitlines() or [""]) for column in columns]
    words = [max(cell_len(word) for cell in column for word in cell.split() or [""]) for column in columns]
    least = [max(word, min(line, kept)) for word, line in zip(words, most, strict=True)]
    widths = most.copy()
    while sum(widths) > room and widths != least:
        wrapped = max(range(len(widths)), key=lambda i: (widths[i] > least[i], widths[i]))
        widths[wrapped] -= 1
    return widths


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

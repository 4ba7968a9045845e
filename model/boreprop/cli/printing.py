"""Tables on the terminal."""

from collections.abc import Iterable, Sequence

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

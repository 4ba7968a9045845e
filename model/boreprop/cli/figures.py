"""The command `boreprop figures`."""

from pathlib import Path
from typing import Annotated

import typer

from ..report.figures.paper import make_figures
from . import console
from .fallback import warn_of_fallback


def figures_command(
    output: Annotated[Path, typer.Argument(metavar="OUT/", help="The directory to write them to.")],
) -> None:
    """Draw the paper's figures 6, 7 and 8 (PNG)."""
    output.mkdir(parents=True, exist_ok=True)
    warn_of_fallback()
    with console.progress("figures", 1.0) as done:
        make_figures(output, done)
    print(f"{output}: figures 6, 7 and 8")

"""Options and arguments that several commands have, and how their texts are read."""

from math import inf, nan
from pathlib import Path
from typing import Annotated

import typer

from ..core.quantities import BY_NAME


def positive(text: str) -> float:
    """Parse an option that takes a finite number > 0: ``typer.Option(parser=positive)``."""
    try:
        value = float(text)
    except ValueError:
        value = nan
    if not 0.0 < value < inf:
        raise typer.BadParameter(f"must be a number > 0, got {text!r}")
    return value


def tolerance(text: str) -> float:
    """Parse an option that takes a relative_tolerance in the range of the table of quantities."""
    allowed = BY_NAME["relative_tolerance"]
    value = positive(text)
    if not allowed.at_least <= value <= allowed.at_most:
        raise typer.BadParameter(f"must be {allowed.at_least:g} to {allowed.at_most:g}, got {text!r}")
    return value


CaseFile = Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")]
Tolerance = Annotated[
    float | None,
    typer.Option(
        parser=tolerance,
        metavar="X",
        help="Local error of a step of the integrator, over 1 rad and ℓ₁. Default: 1e-7.",
    ),
]
"""The option --tolerance of a command that drills: ``tolerance: Tolerance = None``."""
Engine = Annotated[
    str,
    typer.Option(
        metavar="auto|native|python", help="The model as compiled code or in Python; auto: the faster one here."
    ),
]

"""Options that several commands share, and the parsers of their values."""

from collections.abc import Callable, Iterable
from math import inf, nan
from pathlib import Path
from typing import Annotated

import typer

from ..core.quantities import BY_NAME
from ..errors import InputError
from ..units import field_units
from .console import check_output

LARGEST_TURN = 90.0  # degrees, of a kink in a hole


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


def turn(text: str) -> float:
    """Parse an option that takes a turn of a hole, degrees."""
    value = positive(text)
    if value > LARGEST_TURN:
        raise typer.BadParameter(f"must be <= {LARGEST_TURN:g}, got {text!r}")
    return value


def inclination(text: str) -> float:
    """Parse an option that takes an inclination, degrees."""
    try:
        value = float(text)
    except ValueError:
        value = nan
    if not -180.0 <= value <= 180.0:
        raise typer.BadParameter(f"must be a number from -180 to 180, got {text!r}")
    return value


def one_of(*choices: str) -> Callable[[str], str]:
    """A parser of an option that takes one of these words."""

    def choice(text: str) -> str:
        if text not in choices:
            raise typer.BadParameter(f"must be {', '.join(choices[:-1])} or {choices[-1]}, got {text!r}")
        return text

    return choice


CaseFile = Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")]
"""The argument CASE.toml: ``case_file: CaseFile``."""

Tolerance = Annotated[
    float | None,
    typer.Option(
        parser=tolerance,
        metavar="X",
        help="Error allowed in one step of the integrator, relative to 1 rad and to the length ℓ₁ from the bit to the "
        "first stabilizer. Default: 1e-7.",
    ),
]
"""The option --tolerance of a command that drills: ``tolerance: Tolerance = None``."""


def _show_in(context: typer.Context, system: str) -> str:
    if system == "field":
        context.with_resource(field_units())
    return system


Units = Annotated[
    str,
    typer.Option(
        parser=one_of("si", "field"),
        callback=_show_in,
        metavar="si|field",
        help="Units of what is printed or drawn: m, kN and °/30 m, or ft, klbf and °/100 ft.",
    ),
]
"""The option --units of a command that prints tables: ``units: Units = "si"``. It holds until the command ends."""

AsJson = Annotated[
    bool,
    typer.Option("--json", help="Print JSON instead: SI units, the names of the Python API, null for nothing."),
]
"""The option --json: ``as_json: AsJson = False``."""

Inclination = Annotated[
    float | None,
    typer.Option(
        parser=inclination,
        metavar="A",
        help="Inclination of the straight hole, degrees. Default: that at the end of the existing hole.",
    ),
]
"""The option --inclination-deg: ``inclination_deg: Inclination = None``."""

EtaPiRange = Annotated[str | None, typer.Option(metavar="START:STOP:COUNT", help="Values of ηΠ.")]
"""The option --eta-pi of a command that takes many: ``eta_pi: EtaPiRange = None``; see `ranges.parse_range`."""

ClearanceRange = Annotated[
    str | None,
    typer.Option(metavar="START:STOP:COUNT", help="Clearances, mm, of the first stabilizer that can touch the wall."),
]
"""The option --clearance-mm: ``clearance_mm: ClearanceRange = None``; see `ranges.parse_range`."""


def check_asked(output: Path | None, as_json: bool, *, reads: Iterable[Path]) -> None:
    """Raise `InputError` unless a picture that can be written, or JSON, is asked for; see `check_output`."""
    if output is not None:
        check_output(output, (".png",), reads=reads)
    elif not as_json:
        raise InputError("--output, --json: one must be given, got neither")

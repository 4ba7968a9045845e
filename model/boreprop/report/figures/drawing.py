"""What all figures share: colours, second axes, and how a picture gets into its file."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from ...case.case import Case
from ...replacing import replacing

COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7")  # Okabe and Ito: told apart by the colour-blind


def save(figure: Figure, path: Path) -> None:
    """Write a picture (PNG); nothing of that name changes before everything is written."""
    with replacing(path) as draft:
        figure.savefig(draft, dpi=150, format="png")


def multiple(factor: float) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """To and from the values of a second axis in another unit."""
    return lambda x: x * factor, lambda x: x / factor


def kilonewtons_per_eta_pi(case: Case) -> float:
    """Active weight on bit for each unit of ηΠ, kN."""
    return case.bha.force_scale / case.bit.lateral_steering_resistance / 1e3

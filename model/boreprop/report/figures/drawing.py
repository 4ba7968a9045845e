"""Colours, second axes and saving, for all figures."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from ...case.case import Case
from ...replacing import replacing

COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7")  # of Okabe and Ito: the colour-blind can tell them apart


def save(figure: Figure, path: Path) -> None:
    """Write a picture (PNG). An existing file is replaced only once the new one is complete."""
    with replacing(path) as draft:
        figure.savefig(draft, dpi=150, format="png")


def multiple(factor: float) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """The functions to and from the values of a second axis, which are `factor` times those of the first."""
    return lambda x: x * factor, lambda x: x / factor


def kilonewtons_per_eta_pi(case: Case) -> float:
    """The active weight on bit at ηΠ = 1, kN."""
    return case.bha.force_scale / case.bit.lateral_steering_resistance / 1e3

"""Colours, second axes and saving, for all figures."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...case.case import Case
from ...replacing import replacing
from ...units import UNITS

COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7")  # of Okabe and Ito: the colour-blind can tell them apart


def save(figure: Figure, path: Path) -> None:
    """Write a picture (PNG). An existing file is replaced only once the new one is complete."""
    with replacing(path) as draft:
        figure.savefig(draft, dpi=150, format="png")


def multiple(factor: float) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """The functions to and from the values of a second axis, which are `factor` times those of the first."""
    return lambda x: x * factor, lambda x: x / factor


def add_weight_axis(panel: Axes, case: Case) -> None:
    """Add a second axis, of the active weight on bit, to a panel over ηΠ."""
    unit = UNITS["N"]
    per_eta_pi = unit.factor * case.bha.force_scale / case.bit.lateral_steering_resistance
    weight = panel.secondary_xaxis("top", functions=multiple(per_eta_pi))
    weight.set_xlabel(unit.heading("active weight on bit"))

"""A run beside a survey as a picture: inclinations, and their differences."""

from matplotlib.figure import Figure

from ...analysis.comparison import Comparison
from ...units import UNITS
from .drawing import COLOURS


def draw(found: Comparison) -> Figure:
    """Draw predicted and measured inclination over the measured depth, and the measured less the predicted one."""
    unit, depth = UNITS["rad"], UNITS["m"].factor * found.measured_depth
    figure = Figure(figsize=(9, 7), layout="constrained")
    inclination, difference = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    inclination.plot(depth, unit.factor * found.predicted, color=COLOURS[0], label="predicted")
    inclination.plot(depth, unit.factor * found.measured, "o", color=COLOURS[1], markersize=4, label="measured")
    inclination.set_ylabel(unit.heading("inclination"))
    inclination.legend(frameon=False)
    difference.axhline(0.0, color="0.4", linewidth=0.8)
    difference.plot(depth, unit.factor * found.residual, "o-", color=COLOURS[1], markersize=3, linewidth=1)
    difference.set_ylabel(unit.heading("measured − predicted"))
    difference.set_xlabel(UNITS["m"].heading("measured depth"))
    for panel in (inclination, difference):
        panel.grid(alpha=0.3)
    return figure

"""A run beside a survey as a picture: inclinations and, in space, azimuths, their differences and the distance."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...analysis.comparison import Comparison
from ...arrays import Floats
from ...units import UNITS, Unit
from .drawing import COLOURS


def draw(found: Comparison) -> Figure:
    """Draw predicted and measured directions over the measured depth, and what the measured hole has more."""
    unit, away = UNITS["rad"], UNITS["m"]
    turned, depth = found.azimuth_residual, UNITS["m"].factor * found.measured_depth
    figure = Figure(figsize=(9, 7 if turned is None else 11), layout="constrained")
    count = 2 if turned is None else 4
    panels = figure.subplots(count, 1, sharex=True, height_ratios=(2, *(1,) * (count - 1)))
    _both(panels[0], depth, "inclination", found.predicted, found.measured)
    differences, distances = {"inclination": found.residual}, {"high": found.high, "right": found.right}
    if turned is not None and found.predicted_azimuth is not None and found.measured_azimuth is not None:
        _both(panels[1], depth, "azimuth", found.predicted_azimuth, found.measured_azimuth)
        differences["azimuth"] = turned
        _over_zero(panels[3], depth, away, {name: part for name, part in distances.items() if part is not None})
        panels[3].set_ylabel(away.heading("distance to a side"))
    _over_zero(panels[count // 2], depth, unit, differences)
    panels[count // 2].set_ylabel(unit.heading("measured − predicted"))
    panels[-1].set_xlabel(UNITS["m"].heading("measured depth"))
    for panel in panels:
        panel.grid(alpha=0.3)
    return figure


def _both(panel: Axes, depth: Floats, name: str, predicted: Floats, measured: Floats) -> None:
    """A predicted and a measured angle."""
    unit = UNITS["rad"]
    panel.plot(depth, unit.factor * predicted, color=COLOURS[0], label="predicted")
    panel.plot(depth, unit.factor * measured, "o", color=COLOURS[1], markersize=4, label="measured")
    panel.set_ylabel(unit.heading(name))
    panel.legend(frameon=False)


def _over_zero(panel: Axes, depth: Floats, unit: Unit, curves: dict[str, Floats]) -> None:
    """Differences, with their names if there are several."""
    panel.axhline(0.0, color="0.4", linewidth=0.8)
    for colour, (name, values) in zip((COLOURS[1], COLOURS[0]), curves.items(), strict=False):
        panel.plot(depth, unit.factor * values, "o-", color=colour, markersize=3, linewidth=1, label=name)
    if len(curves) > 1:
        panel.legend(frameon=False)

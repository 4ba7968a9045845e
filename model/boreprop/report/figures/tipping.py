"""A map of critical doglegs over weight and clearance."""

from math import degrees, radians

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, NullLocator

from ...analysis.tipping import DoglegMap
from ...case.case import Case
from ...units import UNITS, small_length
from .drawing import add_weight_axis, multiple

LEVELS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)  # ticks, in degrees and degrees per 30 m
NEVER = "0.8"  # grey


def draw(case: Case, found: DoglegMap, limit: float) -> Figure:
    """Draw the smallest dogleg that starts rippling; `limit` is the largest that was tried, rad."""
    figure = Figure(figsize=(9, 6), layout="constrained")
    figure.suptitle("Smallest kink in a straight hole that starts rippling")
    panel = figure.subplots()
    panel.set_facecolor(NEVER)
    panel.set_xlabel("ηΠ")
    small = small_length()
    panel.set_ylabel(small.heading(f"clearance of stabilizer {found.stabilizer}"))
    add_weight_axis(panel, case)
    x, y = found.eta_pi, small.factor * found.clearance
    angle = np.degrees(found.angle)
    between = np.where(np.isfinite(angle) & (angle > 0.0), angle, np.nan)
    low, high = (np.nanmin(between), 1.001 * np.nanmax(between)) if np.isfinite(between).any() else (1.0, 10.0)
    colours = colormaps["cividis"].with_extremes(under="k")
    shown = np.where(angle == 0.0, low / 2, between)
    shades = panel.pcolormesh(x, y, shown, norm=LogNorm(low, high), cmap=colours, shading="nearest")
    lines = panel.contour(x, y, between, [level for level in LEVELS if low < level < high], colors="w", linewidths=1.2)
    panel.clabel(lines, fmt=lambda level: f"{level:g}°")
    _add_scale(figure, shades, case.bha.half_length)
    keys: list[Artist] = [Patch(facecolor=NEVER, label=f"no turn up to {degrees(limit):.3g}° starts rippling")]
    if not angle.all():
        keys.append(Patch(facecolor="k", label="the straight hole ripples"))
    if np.isnan(angle).any():
        panel.pcolormesh(x, y, np.where(np.isnan(angle), 1.0, np.nan), cmap=ListedColormap(["w"]), shading="nearest")
        keys.append(Patch(facecolor="w", edgecolor="0.3", label="left out: a run stopped"))
    if not found.monotonic.all():
        rows, columns = np.nonzero(~found.monotonic)
        keys += panel.plot(x[columns], y[rows], "kx", label="not every larger turn starts it")
    own = case.eta_pi, small.factor * case.bha.stabilizer_clearances[found.stabilizer - 1]
    if x[0] <= own[0] <= x[-1] and y[0] <= own[1] <= y[-1]:
        keys += panel.plot(*own, "w*", markersize=14, markeredgecolor="k", label="the case")
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys))
    return figure


def _add_scale(figure: Figure, shades: ScalarMappable, length: float) -> None:
    """Add the scale of the colours, in degrees and as a dogleg severity."""
    bar = figure.colorbar(shades, label=f"turn (°) over the last {UNITS['m'].text(length, '.4g')}")
    severity = bar.ax.secondary_yaxis("left", functions=multiple(radians(UNITS["rad/m"].factor) / length))
    severity.set_ylabel(UNITS["rad/m"].heading("dogleg severity"))
    for axis in (bar.ax.yaxis, severity.yaxis):
        axis.set_major_locator(FixedLocator(LEVELS))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())

"""Tipping as pictures: critical doglegs over weight and clearance, and the loop of a ripple that dies out late."""

from collections.abc import Callable
from math import degrees, nan
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, NullLocator

from ...analysis.hysteresis import Hysteresis
from ...analysis.rippling import Rippling
from ...analysis.tipping import DoglegMap
from ...case.case import Case
from ...core.system import eta_pi
from ...units import BUILD_LENGTH
from .drawing import COLOURS

LEVELS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)  # degrees, and degrees per 30 m
NEVER = "0.8"  # grey


def draw_map(case: Case, found: DoglegMap, limit: float) -> Figure:
    """The smallest dogleg that tips a system over; `limit` is the largest that was tried, rad."""
    figure = Figure(figsize=(9, 6), layout="constrained")
    figure.suptitle("Smallest kink in a straight hole that starts rippling")
    panel = figure.subplots()
    panel.set_facecolor(NEVER)
    panel.set_xlabel("ηΠ")
    panel.set_ylabel(f"clearance of stabilizer {found.stabilizer} (mm)")
    weight = panel.secondary_xaxis("top", functions=_multiple(_kilonewtons(case)))
    weight.set_xlabel("active weight on bit (kN)")
    x, y = found.eta_pi, 1e3 * found.clearance
    angle = np.degrees(found.angle)
    between = np.where(np.isfinite(angle) & (angle > 0.0), angle, np.nan)
    low, high = (np.nanmin(between), 1.001 * np.nanmax(between)) if np.isfinite(between).any() else (1.0, 10.0)
    colours = colormaps["cividis"].with_extremes(under="k")
    shown = np.where(angle == 0.0, low / 2, between)
    shades = panel.pcolormesh(x, y, shown, norm=LogNorm(low, high), cmap=colours, shading="nearest")
    lines = panel.contour(x, y, between, [level for level in LEVELS if low < level < high], colors="w", linewidths=1.2)
    panel.clabel(lines, fmt=lambda level: f"{level:g}°")
    _add_scale(figure, shades, case.bha.half_length)
    keys: list[Artist] = [Patch(facecolor=NEVER, label=f"no turn up to {degrees(limit):.3g}° tips it")]
    if not angle.all():
        keys.append(Patch(facecolor="k", label="the straight hole ripples"))
    if np.isnan(angle).any():
        panel.pcolormesh(x, y, np.where(np.isnan(angle), 1.0, np.nan), cmap=ListedColormap(["w"]), shading="nearest")
        keys.append(Patch(facecolor="w", edgecolor="0.3", label="left out: a run stopped"))
    if not found.monotonic.all():
        rows, columns = np.nonzero(~found.monotonic)
        keys += panel.plot(x[columns], y[rows], "kx", label="not every larger turn does")
    own = (
        eta_pi(case.bha, case.bit, case.active_weight_on_bit),
        1e3 * case.bha.stabilizer_clearances[found.stabilizer - 1],
    )
    if x[0] <= own[0] <= x[-1] and y[0] <= own[1] <= y[-1]:
        keys += panel.plot(*own, "w*", markersize=14, markeredgecolor="k", label="the case")
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys))
    return figure


def _add_scale(figure: Figure, shades: ScalarMappable, length: float) -> None:
    """The colours as a turn, and as a dogleg severity."""
    bar = figure.colorbar(shades, label=f"turn (°) over the last {length:.4g} m")
    severity = bar.ax.secondary_yaxis("left", functions=_multiple(BUILD_LENGTH / length))
    severity.set_ylabel(f"dogleg severity (°/{BUILD_LENGTH:g} m)")
    for axis in (bar.ax.yaxis, severity.yaxis):
        axis.set_major_locator(FixedLocator(LEVELS))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())


def _kilonewtons(case: Case) -> float:
    """Of active weight on bit for each unit of ηΠ."""
    return case.bha.force_scale / case.bit.lateral_steering_resistance / 1e3


def _multiple(factor: float) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """To and from the values of a second axis."""
    return lambda x: x * factor, lambda x: x / factor


def draw_loop(case: Case, found: Hysteresis) -> Figure:
    """The ripple on the way up and on the way down along a parameter."""
    figure = Figure(figsize=(9, 6.5), layout="constrained")
    length = case.bha.half_length
    figure.suptitle(
        "Where a ripple dies out, and where a dogleg of "
        f"{degrees(found.dogleg):.3g}° over {length:.4g} m in a straight hole brings it back"
    )
    axis, inclination = figure.subplots(2, 1, sharex=True)
    clearance = found.name != "eta_pi"
    unit = 1e3 if clearance else 1.0
    x = unit * np.array(found.values)
    branches = (
        (found.up, found.dies, "o-", COLOURS[0], "going up, from a ripple"),
        (found.down, found.returns, "v--", COLOURS[1], "going down, from straight holes"),
    )
    for waves, end, style, colour, name in branches:
        drawn = {"color": colour, "markersize": 5, "label": name}
        axis.plot(x, [1e3 * _size(wave, "axis_amplitude") for wave in waves], style, **drawn)
        inclination.plot(x, [degrees(_size(wave, "amplitude")) for wave in waves], style, **drawn)
        if end:
            for panel in (axis, inclination):
                panel.axvspan(unit * end[0], unit * end[1], color=colour, alpha=0.4, linewidth=0)
    axis.set_ylabel("ripple of the hole axis (± mm)")
    inclination.set_ylabel("ripple of the inclination (± °)")
    inclination.set_xlabel(f"clearance of stabilizer {found.name.partition('[')[2][:-1]} (mm)" if clearance else "ηΠ")
    if not clearance:
        weight = axis.secondary_xaxis("top", functions=_multiple(_kilonewtons(case)))
        weight.set_xlabel("active weight on bit (kN)")
    for panel in (axis, inclination):
        panel.grid(alpha=0.3)
        panel.set_ylim(bottom=0.0)
    axis.legend(title="the ends lie in the bands" if found.dies or found.returns else None)
    return figure


def _size(wave: Rippling | None, what: str) -> float:
    """An amplitude; 0 without a ripple, nan where the run stopped."""
    if wave is None:
        return nan
    return float(getattr(wave, what)) if wave.ripples else 0.0

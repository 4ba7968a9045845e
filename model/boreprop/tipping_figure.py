"""Tipping as pictures: critical doglegs over weight and clearance, and the loop of a ripple that dies out late."""

from collections.abc import Callable, Sequence
from math import degrees
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, NullLocator

from .analysis.rippling import Rippling
from .analysis.tipping import DoglegMap
from .case import Case
from .core.assembly import eta_pi
from .drawing import COLOURS
from .summary import BUILD_LENGTH

LEVELS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)  # degrees, and degrees per 30 m
NEVER = "0.8"  # grey


def draw_map(case: Case, found: DoglegMap, limit: float) -> Figure:
    """The smallest dogleg that tips a system over; `limit` is the largest that was tried, rad."""
    figure = Figure(figsize=(9, 6), layout="constrained")
    figure.suptitle("How much dogleg straight drilling forgives: smallest turn over the last ℓ₁ that ends in rippling")
    panel = figure.subplots()
    panel.set_facecolor(NEVER)
    panel.set_xlabel("ηΠ")
    panel.set_ylabel("clearance of the first stabilizer (mm)")
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
    _add_scale(figure, shades, case.bha.length_scale)
    keys: list[Artist] = [Patch(facecolor=NEVER, label=f"no turn up to {degrees(limit):.3g}° tips it")]
    if not angle.all():
        keys.append(Patch(facecolor="k", label="any turn does"))
    if not found.monotonic.all():
        rows, columns = np.nonzero(~found.monotonic)
        keys += panel.plot(x[columns], y[rows], "kx", label="not every larger turn does")
    own = eta_pi(case.bha, case.bit, case.active_weight_on_bit), 1e3 * case.bha.stabilizer_clearances[0]
    if x[0] <= own[0] <= x[-1] and y[0] <= own[1] <= y[-1]:
        keys += panel.plot(*own, "w*", markersize=14, markeredgecolor="k", label="the case")
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys))
    return figure


def _add_scale(figure: Figure, shades: ScalarMappable, length_scale: float) -> None:
    """The colours as a turn, and as a dogleg severity."""
    bar = figure.colorbar(shades, label=f"turn (°) over ℓ₁ = {length_scale:g} m")
    severity = bar.ax.secondary_yaxis("left", functions=_multiple(BUILD_LENGTH / length_scale))
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


def draw_loop(
    x: Sequence[float], label: str, up: Sequence[Rippling], down: Sequence[Rippling], dogleg: float
) -> Figure:
    """The ripple on the way up and on the way down along a parameter with the values `x`, called `label`."""
    figure = Figure(figsize=(9, 6.5), layout="constrained")
    figure.suptitle(
        f"Where a ripple dies out, and where a dogleg of {degrees(dogleg):g}° over the last ℓ₁ brings it back"
    )
    axis, inclination = figure.subplots(2, 1, sharex=True)
    branches = (up, "o-", COLOURS[0], "going up, from a ripple"), (down, "v--", COLOURS[1], "going down")
    for branch, style, colour, name in branches:
        drawn = {"color": colour, "markersize": 5, "label": name}
        axis.plot(x, [1e3 * wave.axis_amplitude if wave.ripples else 0.0 for wave in branch], style, **drawn)
        inclination.plot(x, [degrees(wave.amplitude) if wave.ripples else 0.0 for wave in branch], style, **drawn)
    axis.set_ylabel("ripple of the hole axis (± mm)")
    inclination.set_ylabel("ripple of the inclination (± °)")
    inclination.set_xlabel(label)
    for panel in (axis, inclination):
        panel.grid(alpha=0.3)
        panel.set_ylim(bottom=0.0)
    axis.legend()
    return figure

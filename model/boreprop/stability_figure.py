"""The stability chart as a picture, figure 6."""

from math import degrees
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray
from scipy.interpolate import RegularGridInterpolator

from .analysis.characteristic import Floats
from .analysis.chart import VERDICTS, Chart, Panel, lambda_2
from .case import Case
from .core.assembly import eta_pi
from .stability_table import contact_text

SHADES = dict(zip(VERDICTS, ("#A9DBC8", "#8C8C8C", "#D55E00"), strict=True))
"""Green, grey and red as in the paper, told apart by the colour-blind and in grey by their lightness."""

MARKER: dict[str, Any] = {
    "linestyle": "",
    "marker": "o",
    "markersize": 8,
    "markerfacecolor": "white",
    "markeredgecolor": "black",
}
LINE = 1.0
NEAR = 0.1  # of a cell of the chart: a boundary this near to it is in it
LEFT_OUT = 0.02  # of the range of ηΠ, where boundaries would be one on the other


def draw(chart: Chart, case: Case) -> Figure:
    """The four modes over ηΠ and λ₂, with the point of the case."""
    bha, bit = case.bha, case.bit
    point = eta_pi(bha, bit, case.active_weight_on_bit), lambda_2(bha)
    epsilon = bit.angular_steering_resistance / bit.lateral_steering_resistance
    figure = Figure(figsize=(10, 8), layout="constrained")
    figure.suptitle(
        f"Local stability of a straight hole at {degrees(chart.inclination):.4g}° inclination, ε = {epsilon:.3g}"
    )
    panels = figure.subplots(2, 2, sharex=True, sharey=True)
    for axes, panel in zip(panels.flat, chart.panels, strict=True):
        draw_panel(axes, chart, panel, point)
    for axes in panels[1]:
        axes.set_xlabel("ηΠ")
    for axes in panels[:, 0]:
        axes.set_ylabel("$λ_2$")
    figure.legend(
        handles=[
            *(Patch(facecolor=shade, edgecolor="0.3", label=verdict) for verdict, shade in SHADES.items()),
            Line2D([], [], color="black", linewidth=LINE, label="roots on the imaginary axis"),
            Line2D([], [], label="the case", **MARKER),
        ],
        loc="outside lower center",
        ncols=5,
    )
    return figure


def draw_panel(axes: Axes, chart: Chart, panel: Panel, point: tuple[float, float]) -> None:
    """One mode."""
    axes.set_title(f"{contact_text(panel.contact)}, bit tilt {'saturated' if panel.saturated else 'not saturated'}")
    axes.pcolormesh(
        chart.eta_pi,
        chart.lambda2,
        panel.verdicts,
        cmap=ListedColormap(list(SHADES.values())),
        vmin=-0.5,
        vmax=len(SHADES) - 0.5,
        rasterized=True,
    )
    for line in boundaries(chart, panel):
        axes.plot(*line.T, color="black", linewidth=LINE)
    axes.plot(*point, **MARKER)
    axes.set_xlim(chart.eta_pi[0], chart.eta_pi[-1])
    axes.set_ylim(chart.lambda2[0], chart.lambda2[-1])


def boundaries(chart: Chart, panel: Panel) -> list[Floats]:
    """Where a root on the imaginary axis changes the verdict: lines of points (ηΠ, λ₂), shape (k, 2), nan in gaps.

    For a pair ±iω there is an equation for ω and λ₂ alone, and ηΠ follows; for the root 0 one for ηΠ and λ₂.
    """
    x, y, codes = chart.eta_pi, chart.lambda2, panel.verdicts
    rows = panel.characteristics
    b, c = np.array([row.at_zero() for row in rows]).T[..., None]
    lines = zero_lines(x, y, b * x + c)
    steps, numbers = np.array([row.sampling(float(max(x[0], LEFT_OUT * x[-1]))) for row in rows]).T
    omega = np.arange(steps.min(), (steps * numbers).max() + steps.min(), steps.min())
    value, crossing, _ = np.stack([row.on_imaginary_axis(omega) for row in rows], axis=1)
    at = RegularGridInterpolator((y, omega), crossing, bounds_error=False)
    pairs = zero_lines(omega, y, value)
    lines += [np.column_stack([at(line[:, ::-1]), line[:, 1]]) for line in pairs]
    corners = np.stack([codes[:-1, :-1], codes[:-1, 1:], codes[1:, :-1], codes[1:, 1:]])
    changes = np.ptp(corners, axis=0) > 0

    def kept(line: Floats) -> Floats:
        near = [
            changes[cell(y, line[:, 1], side_y), cell(x, line[:, 0], side_x)]
            for side_x in (-NEAR, NEAR)
            for side_y in (-NEAR, NEAR)
        ]
        return np.where(np.any(near, axis=0)[:, None], line, np.nan)

    return [kept(line[np.isfinite(line[:, 0])]) for line in lines]


def zero_lines(x: Floats, y: Floats, z: Floats) -> list[Floats]:
    """Lines of points (x, y), shape (k, 2), along which z, shape (len(y), len(x)), is zero."""
    from contourpy import contour_generator  # not before matplotlib, which brings it

    return cast(list[Floats], contour_generator(x, y, z).lines(0.0))


def cell(grid: Floats, at: Floats, aside: float) -> NDArray[np.int64]:
    """Index of the interval of `grid` in which a position lies, moved aside by a part of an interval."""
    position: Floats = np.interp(at, grid, np.arange(len(grid))) + aside
    return np.clip(position, 0, len(grid) - 2).astype(int)

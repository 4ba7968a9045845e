"""The stability chart as a picture, figure 6."""

from itertools import pairwise
from math import degrees, inf
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ...analysis.stability.chart import DRIFT, OSCILLATORY, STABLE, Band, Chart, Integers, Panel, lambda_2
from ...analysis.stability.contacts import steady_mode
from ...analysis.stability.roots import Verdict
from ...analysis.stability.straight import mode_verdict
from ...arrays import Floats
from ...case.case import Case
from ...units import UNITS
from ..tables.stability import contact_text, metres
from .drawing import add_weight_axis, multiple

SHADES = {
    "stable": "#A9DBC8",
    "slow drift": "#E9E9E9",
    "drift": "#9A9A9A",
    "fast drift": "#3C3C3C",
    "oscillatory": "#D55E00",
}
"""Green, greys and red as in the paper; they differ for the colour-blind, and in lightness when printed in grey."""

KIND = np.array([STABLE, DRIFT, DRIFT, DRIFT, OSCILLATORY])  # the code of the verdict that each shade stands for
DRIFTS = (inf, 1000.0, 100.0)  # m: a drift that doubles in a shorter length has the next darker shade
DRIFT_MEANINGS = ("drift that doubles in more than {0}", "drift: in {1} to {0}", "drift: in less than {1}")
MARKER: dict[str, Any] = {
    "linestyle": "",
    "marker": "o",
    "markersize": 8,
    "markerfacecolor": "white",
    "markeredgecolor": "black",
}
LINE = 1.0
FINER = 4  # rows of pixels for each λ₂ of the chart, so that limits are smooth
PIXELS = 1200  # across a panel, which is wider than on paper
SPECK = 0.01  # of the range of ηΠ: islands smaller than this and than one λ₂ come from the grid, and get no line
WIDTH, ROW, MARGINS = 10.0, 3.4, 1.4  # width of the picture, height of a row of panels, of the margins, inches


def draw(chart: Chart, case: Case) -> Figure:
    """Draw the verdicts over ηΠ and λ₂, and the case; there is a row of two panels for each set of contacts."""
    bha, bit = case.bha, case.bit
    point = case.eta_pi, lambda_2(bha)
    epsilon = bit.angular_steering_resistance / bit.lateral_steering_resistance
    here = steady_mode(case, case.schedule.rss_force[0], chart.inclination)
    rows = len(chart.panels) // 2
    figure = Figure(figsize=(WIDTH, ROW * rows + MARGINS), layout="constrained")
    figure.suptitle(
        f"Local stability of a straight hole at {degrees(chart.inclination):.4g}° inclination, ε = {epsilon:.3g}"
    )
    panels = figure.subplots(rows, 2, sharex=True, sharey=True, squeeze=False)
    for axes, panel in zip(panels.flat, chart.panels, strict=True):
        draw_panel(axes, chart, panel, point)
        if (panel.contact, panel.saturated) == here:
            grow = mode_verdict(case, *here, chart.inclination) is Verdict.OSCILLATORY
            so = "the case would drill in this mode, but waves grow" if grow else "the case drills in this mode"
            axes.set_title(f"{axes.get_title()}\n({so})", fontweight="bold")
    for axes in panels[-1]:
        axes.set_xlabel("ηΠ")
    for axes in panels[0]:
        add_weight_axis(axes, case)
    for axes in panels[:, 0]:
        axes.set_ylabel("$λ_2$")
    for axes in panels[:, 1]:
        right = axes.secondary_yaxis("right", functions=multiple(UNITS["m"].factor * case.length_scale))
        right.set_ylabel(UNITS["m"].heading("stabilizer 1 to 2"))
    figure.legend(
        handles=[
            *(
                Patch(facecolor=shade, edgecolor="0.3", label=meaning)
                for meaning, shade in zip(meanings(), SHADES.values(), strict=True)
            ),
            Line2D([], [], color="black", linewidth=LINE, label="limit"),
            Line2D([], [], label="the case", **MARKER),
        ],
        loc="outside lower center",
        ncols=4,
    )
    return figure


def meanings() -> list[str]:
    """What each shade means, in the units people use."""
    stable, *_, oscillatory = SHADES
    return [stable, *(text.format(*map(metres, DRIFTS[1:])) for text in DRIFT_MEANINGS), oscillatory]


def draw_panel(axes: Axes, chart: Chart, panel: Panel, point: tuple[float, float]) -> None:
    """Draw the verdicts on one mode."""
    axes.set_title(f"{contact_text(panel.contact)}, bit tilt {'saturated' if panel.saturated else 'not saturated'}")
    x, rows = finer(chart, panel)
    axes.imshow(
        np.array([shades[np.searchsorted(ends, x)] for ends, shades in rows]),
        cmap=ListedColormap(list(SHADES.values())),
        vmin=-0.5,
        vmax=len(SHADES) - 0.5,
        extent=(x[0], x[-1], chart.lambda2[0], chart.lambda2[-1]),
        origin="lower",
        aspect="auto",
        interpolation="nearest",
    )
    for line in boundaries(chart, panel):
        axes.plot(*line.T, color="black", linewidth=LINE)
    axes.plot(*point, **MARKER)
    axes.set_xlim(chart.eta_pi[0], chart.eta_pi[-1])
    axes.set_ylim(chart.lambda2[0], chart.lambda2[-1])


def shaded(chart: Chart, panel: Panel) -> list[Band]:
    """For each λ₂ the bands of equal shade along ηΠ; their codes are the positions of the shades in `SHADES`."""
    x, found = chart.eta_pi, []
    for verdicts, doubling in zip(panel.bands, panel.doubling, strict=True):
        slow = np.count_nonzero(doubling[:, None] <= DRIFTS, axis=-1)  # 1 to 3 where it drifts
        before = np.flatnonzero((slow[1:] != slow[:-1]) & (slow[1:] > 0) & (slow[:-1] > 0))
        ends = np.concatenate([verdicts.ends, (x[before] + x[before + 1]) / 2])
        order = np.argsort(ends)
        ends = ends[order]
        middles = (np.append(x[0], ends) + np.append(ends, x[-1])) / 2
        codes = verdicts.codes[np.searchsorted(verdicts.ends, middles)]
        drifts = np.maximum(slow[np.clip(np.searchsorted(x, middles), 0, len(x) - 1)], 1)
        found.append(Band(ends, np.select([codes == STABLE, codes == OSCILLATORY], [0, len(SHADES) - 1], drifts)))
    return found


def finer(chart: Chart, panel: Panel) -> tuple[Floats, list[Band]]:
    """The ηΠ of the pixels across a panel, and for each row of pixels the bands that are wide enough to be seen."""
    x = np.linspace(chart.eta_pi[0], chart.eta_pi[-1], PIXELS)
    return x, [visible(row, x[1] - x[0]) for row in in_between(shaded(chart, panel))]


def visible(row: Band, pixel: float) -> Band:
    """The bands of a row without those that are narrower than a pixel."""
    narrow = np.flatnonzero(np.diff(row.ends) < pixel)
    if not len(narrow):
        return row
    k = narrow[0]
    gone = [k, k + 1] if row.codes[k] == row.codes[k + 2] else [k]
    return visible(Band(np.delete(row.ends, gone), np.delete(row.codes, [k + 1, k + 2][: len(gone)])), pixel)


def in_between(rows: list[Band]) -> list[Band]:
    """The bands at `FINER` times as many λ₂: their ends are interpolated, or jump if the next λ₂ has other bands."""
    found = []
    for row, after in pairwise(rows):
        same = matched(row, after)
        for part in np.arange(FINER) / FINER:
            if same:
                found.append(Band(same[0] + (same[1] - same[0]) * part, same[2]))
            else:
                found.append(row if part < 0.5 else after)
    return [*found, rows[-1]]


def matched(row: Band, after: Band) -> tuple[Floats, Floats, Integers] | None:
    """The ends of the bands of two rows, made to correspond, and their codes; None if they do not correspond.

    A band that only one of the rows has gets no width in the other.
    """
    if len(row.codes) > len(after.codes):
        turned = matched(after, row)
        return turned and (turned[1], turned[0], turned[2])
    if np.array_equal(row.codes, after.codes):
        return row.ends, after.ends, row.codes
    best = None
    for k in range(1, len(after.codes)):
        for more in (1, 2):
            if not np.array_equal(np.delete(after.codes, range(k, min(k + more, len(after.codes)))), row.codes):
                continue
            where = row.ends[k - 1] if more == 1 and k <= len(row.ends) else after.ends[k - 1 : k + 1].mean()
            ends = np.sort(np.insert(row.ends, k - 1, [where] * more))
            if len(ends) == len(after.ends) and (best is None or moved(ends, after) < moved(best, after)):
                best = ends
    return None if best is None else (best, after.ends, after.codes)


def moved(ends: Floats, after: Band) -> float:
    """The sum of the distances between corresponding ends."""
    return float(abs(ends - after.ends).sum())


def boundaries(chart: Chart, panel: Panel) -> list[Floats]:
    """The limits at which the verdict changes: curves of points (ηΠ, λ₂), shape (k, 2) each.

    They are the zero lines of the distance in ηΠ to the nearest change, which is negative on one side of it.
    """
    x, rows = finer(chart, panel)
    lambda2 = np.interp(np.arange(len(rows)) / FINER, np.arange(len(chart.lambda2)), chart.lambda2)
    lines = []
    for kind in np.unique(panel.verdicts)[1:]:
        distance = np.full((len(rows), PIXELS), x[-1] - x[0])
        for away, (ends, shades) in zip(distance, rows, strict=True):
            inside = KIND[shades] >= kind
            limits = ends[inside[1:] != inside[:-1]]
            if len(limits):
                away[:] = abs(x[:, None] - limits).min(axis=1)
            away[~inside[np.searchsorted(ends, x)]] *= -1
        lines += zero_lines(x, lambda2, distance)
    return [line for line in lines if (np.ptp(line, axis=0) > (SPECK * x[-1], lambda2[FINER] - lambda2[0])).any()]


def zero_lines(x: Floats, y: Floats, z: Floats) -> list[Floats]:
    """Lines of points (x, y), shape (k, 2), along which z, shape (len(y), len(x)), is zero."""
    from contourpy import contour_generator  # it comes with matplotlib, which need not be installed

    return cast(list[Floats], contour_generator(x, y, z).lines(0.0))

"""Chooses the scales and ranges of a recording before its rows are drawn."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import floor, log10

import numpy as np

from boreprop.analysis.rippling import find_rippling
from boreprop.case.case import Case
from boreprop.core.quantities import BY_NAME
from boreprop.run.completion import case_of
from boreprop.run.trajectory import Trajectory
from boreprop.units import UNITS

from .scene import Array, Bounds, bit_positions, frame_bounds, section_bounds
from .style import BY_SEVERITY, PLOTS, Plot

WAVES = 11.0  # waves that ripple and modes show: more are too narrow to see, fewer do not show whether they last
USUAL_WAVELENGTH = 1.4  # half lengths of the BHA: the wavelength assumed before there is a ripple
STRIP_SHAPE = 0.2  # width of the strip over its height: it is narrow
STRIP_TOP, STRIP_BOTTOM, STRIP_LEFT = 0.08, 0.02, 0.38  # of its height, of its width: room for text
TREND = 0.75  # wavelengths, at most half the BHA: width of the trend, see `axis_ripple`, of which a wave leaves < 0.1 %
FULL_RIPPLE = 0.25  # ψ* times the wavelength: the ripple of a hole whose bit tilts from limit to limit
ROOM_FOR_LEGEND = 0.35  # of the span of all curves, above them, for each line of the legend
MARGIN = 0.1  # of that span, above and below the curves, so that they do not run along the edge
TILTS = 1.15  # tilt limits to either side in the plot of the tilt, so that a tilt at its limit does not lie on the edge
WALLS_APART = 0.6  # lengths of the BHA at most, in the bit frame: the factor that enlarges them is rounded down
LONGEST_ARROW = 7  # parts into which the BHA is divided for the longest arrow to be one
ARROWS = ("stabilizer_force", "bit_lateral_force", "rss_force")


@dataclass(frozen=True)
class StripScales:
    """The scales and ranges of the strip."""

    bounds: Bounds  # of the view: x = 0 is left of the holes, the numbers of metres are left of that
    start: float  # what the strip shows down the screen at a drilled length of 0: the measured depth there, or 0, m
    lateral: float  # factor by which the lateral axis is enlarged
    lanes: tuple[float, ...]  # x of the middle of each run


@dataclass(frozen=True)
class Scales:
    """The scales and ranges of the views, for all runs of a recording."""

    section: Bounds  # of the vertical section
    strip: StripScales
    frame: Bounds  # of the bit frame
    lateral: float  # factor by which the lateral axis of the bit frame is enlarged
    newtons_per_metre: float  # force over the length of its arrow
    severities: tuple[float, ...]  # dogleg severities between the colours of the vertical section, in the unit shown
    window: float  # length of hole up to the cursor that ripple and modes show, m
    ripple: float  # the largest ripple that its plot shows, mm
    trend: float  # width of the trend from which the ripple is measured, m
    start: float | None  # measured depth at which drilling starts, m; None if the runs differ
    ranges: dict[str, tuple[float, float] | None]  # plot → its range in the unit shown; None: the viewer chooses it

    def hold(self, rows: Trajectory) -> bool:
        """Whether vertical section and strip show the bit at all rows."""
        deepest = self.strip.start + rows["drilled_length"][-1]
        return self.section.hold(bit_positions(rows)) and deepest <= self.strip.bounds.y[1]

    def widened(self, rows: Trajectory) -> "Scales":
        """The same scales with a section at least twice as wide, and a strip twice as long, that also show the rows."""
        shown = np.concatenate((np.transpose((self.section.x, self.section.y)), bit_positions(rows)))
        section = section_bounds(shown, around=float(np.ptp(shown, axis=0).max()) / 2)
        top, bottom = self.strip.bounds.y
        deepest = max(self.strip.start + float(rows["drilled_length"][-1]), 2 * bottom - top)
        return replace(
            self, section=section, strip=replace(self.strip, bounds=Bounds(self.strip.bounds.x, (top, deepest)))
        )


def choose_scales(runs: Sequence[Trajectory], *, whole: bool, section: Array) -> Scales:
    """Choose the scales that suit some runs, each with its case.

    In the bit frame the walls are about half as far apart as the BHA is long, and the largest arrow is a seventh of it.

    Parameters
    ----------
    runs
        The runs, or their first rows, with all columns that are shown.
    whole
        Whether all rows are there. If not, the cases determine the scale of the arrows, and the plots have no ranges.
    section
        Positions that the vertical section should show, (N, 2).
    """
    cases = [case_of(run) for run in runs]
    wavelength = likely_wavelength(runs, cases, whole)
    reach = max(case.bha.stabilizer_positions[-1] for case in cases)
    largest = max(largest_force(run) for run in runs) if whole else max(likely_force(case) for case in cases)
    curves = {name: plot.curves(runs) for name, plot in PLOTS.items()}
    room = ROOM_FOR_LEGEND if len(runs) == 1 else 0.0
    ranges = {name: plot_range(PLOTS[name], found, room) if whole else None for name, found in curves.items() if found}
    starts = {case.survey.measured_depth[-1] for case in cases}
    limit = TILTS * UNITS["rad"].factor * max(case.bit.tilt_limit for case in cases)
    start = starts.pop() if len(starts) == 1 else None
    ripple = 1000 * FULL_RIPPLE * wavelength * max(case.bit.tilt_limit for case in cases)
    ends = [run["drilled_length"][-1] if whole else case.length for run, case in zip(runs, cases, strict=True)]
    drilled = min(float(run["drilled_length"][0]) for run in runs), float(max(ends))
    return Scales(
        section=section_bounds(section, around=2 * reach),
        strip=strip_scales(drilled, start or 0.0, ripple / 1000, len(runs)),
        frame=frame_bounds(reach),
        lateral=max(1.0, round_down(WALLS_APART * reach / max(case.bit_diameter for case in cases))),
        newtons_per_metre=max(largest, 1.0) / (reach / LONGEST_ARROW),
        severities=severities(cases),
        window=WAVES * wavelength,
        ripple=ripple,
        trend=min(TREND * wavelength, *(case.bha.half_length for case in cases)),
        start=start,
        ranges=ranges | {"bit_tilt": (-limit, limit)},
    )


def likely_wavelength(runs: Sequence[Trajectory], cases: Sequence[Case], whole: bool) -> float:
    """The longest wave with which one of the runs, if they are whole, ripples; else the longest to be expected, m."""
    waves = [find_rippling(run) for run in runs] if whole else []
    found = [wave.wavelength for wave in waves if wave.ripples]
    return max(found or [USUAL_WAVELENGTH * case.bha.half_length for case in cases])


def largest_force(run: Trajectory) -> float:
    """The largest force of a run for which an arrow is drawn, N."""
    columns = [run.columns[name] for arrow in ARROWS for name in BY_NAME[arrow].names(run.n) if name in run.columns]
    return max(float(np.abs(column).max()) for column in columns)


def likely_force(case: Case) -> float:
    """A force of the size to be expected in a case, N: that which bends half the BHA by ψ*/2, or that of the pads."""
    stiffness = 3 * case.bha.flexural_stiffness / case.bha.half_length**2
    return max(stiffness * case.bit.tilt_limit / 2, *map(abs, case.schedule.rss_force))


def severities(cases: Sequence[Case]) -> tuple[float, ...]:
    """Round dogleg severities, increasing to that of a hole that turns by 2 ψ* over half the BHA, in the unit shown."""
    highest = max(2 * case.bit.tilt_limit / case.bha.half_length for case in cases)
    found = [round_down(UNITS["rad/m"].factor * highest)]
    while len(found) < len(BY_SEVERITY) - 1:
        found.append(round_down(0.9 * found[-1]))
    return tuple(reversed(found))


def strip_scales(drilled: tuple[float, float], start: float, ripple: float, count: int) -> StripScales:
    """The scales of a strip of `count` runs over some drilled lengths, m, that can show a ripple, m, of each."""
    height = max(drilled[1] - drilled[0], 1.0) / (1 - STRIP_TOP - STRIP_BOTTOM)
    top, width = start + drilled[0] - STRIP_TOP * height, STRIP_SHAPE * height
    lane = (1 - STRIP_LEFT) * width / count
    return StripScales(
        bounds=Bounds((-STRIP_LEFT * width, (1 - STRIP_LEFT) * width), (top, top + height)),
        start=start,
        lateral=max(1.0, first_digit(0.45 * lane / ripple)),
        lanes=tuple(lane * (0.5 + place) for place in range(count)),
    )


def plot_range(plot: Plot, curves: Sequence[Array], room: float) -> tuple[float, float]:
    """The range of a plot of some curves, with room above them for each line of the legend."""
    low = plot.unit.factor * min(float(np.nanmin(curve)) for curve in curves)
    high = plot.unit.factor * max(float(np.nanmax(curve)) for curve in curves)
    span = (high - low) or 1.0
    return low - MARGIN * span, high + (MARGIN + room * len(curves)) * span


def first_digit(value: float) -> float:
    """`value` with all of its digits but the first set to zero."""
    power: float = 10.0 ** floor(log10(value))
    return floor(value / power) * power


def round_down(value: float) -> float:
    """The largest of 1, 2 and 5 times powers of ten that is not above `value`."""
    power = 10.0 ** floor(log10(value))
    return max(step * power for step in (1, 2, 5) if step * power <= value)

"""Chooses the scales and ranges of a recording before its rows are drawn."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import ceil, floor, log10

import numpy as np

from boreprop.analysis.axis import axis_away
from boreprop.analysis.hole import bit_positions
from boreprop.analysis.hole_in_space import positions_in_space
from boreprop.analysis.rippling import Rippling, find_rippling
from boreprop.case.case import Case
from boreprop.core.quantities import BY_NAME
from boreprop.run.completion import case_of
from boreprop.run.ground import largest_along
from boreprop.run.trajectory import Trajectory
from boreprop.units import SMALL_LENGTH, UNITS

from .scene import Array, Bounds, frame_bounds, round_down, section_bounds
from .space_scales import SpaceScales, plan_bounds, section_azimuth
from .style import (
    BY_SEVERITY,
    DECIMALS,
    LANES,
    LANES_IN_SPACE,
    LANES_TITLE,
    LANES_TITLE_IN_SPACE,
    PLOTS,
    PLOTS_IN_SPACE,
    Lanes,
    Plot,
)

WAVES = 11.0  # waves that ripple and modes show: more are too narrow to see, fewer do not show whether they last
USUAL_WAVELENGTH = 1.4  # half lengths of the BHA: the wavelength assumed before there is a ripple
STRIP_SHAPE = 0.2  # width of the strip over its height: it is narrow
STRIP_TOP, STRIP_BOTTOM, STRIP_LEFT = 0.1, 0.02, 0.38  # of its height, of its width: room for text
TREND = 0.75  # wavelengths, at most half the BHA: width of the trend, see `axis_ripple`, of which a wave leaves < 0.1 %
FULL_RIPPLE = 0.25  # ψ* times the wavelength: the ripple of a hole whose bit tilts from limit to limit
MARGIN = 0.1  # of the span of all curves, above and below them, so that they do not run along the edge
# powers of ten in the range of a plot for which it has room, in a small window, to number each: of three plots, of the
# ripple above the lanes of one run, and above those of several
MOST_STEPS, MOST_STEPS_OF_RIPPLE, MOST_STEPS_OF_RIPPLES = 6.0, 10.0, 7.5
SMALLEST_SPAN = 0.01  # of its largest value, which a plot shows to either side of a curve without a change
EDGE = 0.1  # of such a power, between a number and the edge of the plot
TILTS = 1.15  # tilt limits to either side in the plot of the tilt, so that a tilt at its limit does not lie on the edge
RIPPLES = 1.15  # ripples to either side in their plot
WALLS_APART = 0.6  # lengths of the BHA at most, in the bit frame: the factor that enlarges them is rounded down
CURVED = 0.4  # lengths of the BHA, at most, from the axis of the frame to the walls of a hole that curves
ENLARGED = 0.08  # of the length of a run, which the enlarged hole in space lies from its trend at most
THICKNESS = 0.2  # of the trend: the turns of a spiral do not touch
LONGEST_IN_SPACE = 0.8  # of the radius of a disc: the longest arrow
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
    rippling: bool  # whether a run is known to ripple
    ripple: tuple[float, float]  # the range of the plot of the ripple, mm
    trend: float  # width of the trend from which the ripple is measured, m
    length: float  # drilled length from the first row to the last, m
    duration: float | None  # time from the first row to the last, s; None if the runs have no time
    start: float | None  # measured depth at which drilling starts, m; None if the runs differ
    begin: float  # drilled length at the first row, m
    ranges: dict[str, tuple[float, float] | None]  # plot → its range in the unit shown; None: the viewer chooses it
    plots: Mapping[str, Plot] = field(default_factory=lambda: PLOTS, repr=False)  # which there may be
    space: SpaceScales | None = field(default=None, repr=False)  # those of runs in space

    @property
    def round_start(self) -> float:
        """A round measured depth, m, at the first row or above it by at most a tenth of the length of the run."""
        unit = 10.0 ** ceil(log10(max(self.length, 1.0) / 100.0))
        return unit * floor(((self.start or 0.0) + self.begin) / unit)

    @property
    def shown_length(self) -> float:
        """Length of hole that strip and enlarged hole show, m, of a run of a single row, too."""
        return max(self.length, 1.0)

    @property
    def along(self) -> str:
        """What the horizontal axis of the plots shows."""
        place = "drilled length (mm)" if self.start is None else "measured depth (mm)"
        return place if self.duration is None else f"{place} or time"

    @property
    def lanes(self) -> Lanes:
        """The words of the lanes of modes."""
        return LANES if self.space is None else LANES_IN_SPACE

    @property
    def lanes_title(self) -> str:
        """What the lanes show."""
        return LANES_TITLE if self.space is None else LANES_TITLE_IN_SPACE

    def plotted(self, rows: Trajectory) -> Trajectory:
        """Rows as they are plotted."""
        return rows if self.space is None else self.space.plotted(rows)

    def hold(self, rows: Trajectory) -> bool:
        """Whether vertical section and strip show the bit at all rows."""
        deepest = self.strip.start + rows["drilled_length"][-1]
        if self.space is not None:
            if not self.space.plan.hold(self.space.on_plan(positions_in_space(rows))):
                return False
            rows = self.space.projected(rows)
        return self.section.hold(bit_positions(rows)) and deepest <= self.strip.bounds.y[1]

    def widened(self, rows: Trajectory) -> "Scales":
        """The same scales with a section at least twice as wide, and a strip twice as long, that also show the rows."""
        space = self.space
        if space is not None:
            space, rows = space.widened(rows), space.projected(rows)
        shown = np.concatenate((np.transpose((self.section.x, self.section.y)), bit_positions(rows)))
        section = section_bounds(shown, around=float(np.ptp(shown, axis=0).max()) / 2)
        top, bottom = self.strip.bounds.y
        begin = top + STRIP_TOP * (bottom - top)
        deepest = max(self.strip.start + float(rows["drilled_length"][-1]), 2 * bottom - top)
        top = (begin - STRIP_TOP * deepest) / (1 - STRIP_TOP)  # there is room for text above the beginning again
        bounds = Bounds(self.strip.bounds.x, (top, deepest))
        return replace(self, section=section, strip=replace(self.strip, bounds=bounds), space=space)


def choose_scales(
    runs: Sequence[Trajectory], *, whole: bool, section: Array, ends: Sequence[Rippling] | None = None
) -> Scales:
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
    ends
        The waves with which the runs end; None: they are found.
    """
    cases = [case_of(run) for run in runs]
    ends = list(map(find_rippling, runs)) if whole and ends is None else ends or []
    waves = [wave for wave in ends if wave.ripples]
    # the longest wave with which one of the runs ripples, else the longest to be expected
    wavelength = max([wave.wavelength for wave in waves] or [USUAL_WAVELENGTH * case.bha.half_length for case in cases])
    reach = max(case.bha.stabilizer_positions[-1] for case in cases)
    largest = max(largest_force(run) for run in runs) if whole else max(likely_force(case) for case in cases)
    starts = {case.survey.measured_depth[-1] for case in cases}
    ripples = [RIPPLES * wave.axis_amplitude for wave in waves] or [
        FULL_RIPPLE * wavelength * max(largest_along(case, "bit_tilt_limit") for case in cases)
    ]
    most_steps = MOST_STEPS_OF_RIPPLE if len(runs) == 1 else MOST_STEPS_OF_RIPPLES
    length, duration = extent(runs, cases, whole)
    limit = TILTS * max(largest_along(case, "bit_tilt_limit") for case in cases)
    start = starts.pop() if len(starts) == 1 else None
    begin = min(float(run["drilled_length"][0]) for run in runs)
    return Scales(
        section=section_bounds(section, around=2 * reach),
        strip=strip_scales((start or 0.0) + begin, length, start or 0.0, max(ripples), len(runs)),
        frame=frame_bounds(reach),
        lateral=max(1.0, round_down(reach / max(map(lateral_room, runs)))),
        newtons_per_metre=max(largest, 1.0) / (reach / LONGEST_ARROW),
        severities=severities(cases),
        window=min(WAVES * wavelength, max(length, wavelength)),
        rippling=bool(waves),
        ripple=with_ticks(-1000 * max(ripples), 1000 * max(ripples), most_steps),
        trend=min(TREND * wavelength, *(case.bha.half_length for case in cases)),
        length=length,
        duration=duration,
        start=start,
        begin=begin,
        ranges=plot_ranges(PLOTS, runs, whole)
        | {"bit_tilt": with_ticks(-UNITS["rad"].factor * limit, UNITS["rad"].factor * limit)},
    )


def choose_scales_in_space(runs: Sequence[Trajectory], *, whole: bool, positions: Array) -> Scales:
    """Choose the scales that suit some runs in space, as `choose_scales` does for runs in the plane.

    The vertical section is that in which the runs extend farthest.

    Parameters
    ----------
    runs, whole
        As in `choose_scales`.
    positions
        Positions north, east and down that vertical section and plan view should show, (N, 3).
    """
    cases = [case_of(run) for run in runs]
    space = SpaceScales(section_azimuth(positions), Bounds((0.0, 1.0), (0.0, 1.0)), 1.0, 1.0, 1.0, 0, 0)
    seen = choose_scales(
        [space.projected(run) for run in runs],
        whole=whole,
        section=space.on_section(positions),
        ends=list(map(find_rippling, runs)) if whole else [],
    )
    ripple = seen.ripple[1] / SMALL_LENGTH.factor
    if whole:  # at first it may be larger than in the end
        ripple = max(ripple, *(RIPPLES * largest_ripple(run, seen.trend) for run in runs))
    space = replace(
        space,
        plan=plan_bounds(space.on_plan(positions), least=4 * max(case.bit_diameter for case in cases)),
        lateral=max(1.0, first_digit(ENLARGED * seen.shown_length / ripple)),
        thickness=THICKNESS * seen.trend,
        newtons=seen.newtons_per_metre
        * max(case.bha.stabilizer_positions[-1] for case in cases)
        / LONGEST_ARROW
        / LONGEST_IN_SPACE,
        stabilizers=max(len(case.bha.stabilizer_clearances) for case in cases),
        body=int(any(case.bha.body_point_positions for case in cases)),
    )
    size, plotted = SMALL_LENGTH.factor * ripple, [space.plotted(run) for run in runs]
    return replace(
        seen,
        ripple=with_ticks(-size, size, MOST_STEPS_OF_RIPPLE),
        ranges=plot_ranges(PLOTS_IN_SPACE, plotted, whole) | {"bit_tilt": seen.ranges["bit_tilt"]},
        plots=PLOTS_IN_SPACE,
        space=space,
    )


def largest_ripple(run: Trajectory, trend: float) -> float:
    """How far the axis of a run in space lies from its trend at most, m; 0 if the run is too short to have a trend."""
    _, away, _ = axis_away(run["drilled_length"], positions_in_space(run), trend)
    return float(np.linalg.norm(away, axis=1).max(initial=0.0))


def extent(runs: Sequence[Trajectory], cases: Sequence[Case], whole: bool) -> tuple[float, float | None]:
    """Drilled length, m, and time, s, from the first row to the last; if not all rows are there, those of the cases."""
    lengths = [length for run in runs for length in run["drilled_length"][[0, -1]]]
    times = [time for run in runs if "time" in run for time in run["time"][[0, -1]]]
    if whole:
        return float(np.ptp(lengths)), float(np.ptp(times)) if times else None
    rates = [float(run["rate_of_penetration"][-1]) if "rate_of_penetration" in run else 0.0 for run in runs]
    return (
        max(case.length for case in cases),
        max(case.length / (rate or 1.0) for case, rate in zip(cases, rates, strict=True)) if times else None,
    )


def largest_force(run: Trajectory) -> float:
    """The largest force of a run for which an arrow is drawn, N."""
    columns = [run.columns[name] for arrow in ARROWS for name in BY_NAME[arrow].names(run.n) if name in run.columns]
    return max(float(np.abs(column).max()) for column in columns)


def likely_force(case: Case) -> float:
    """A force of the size to be expected in a case, N: that which bends half the BHA by ψ*/2, or that of the pads."""
    stiffness = 3 * case.bha.flexural_stiffness / case.bha.half_length**2
    return max(stiffness * largest_along(case, "bit_tilt_limit") / 2, *map(abs, case.schedule.rss_force))


def severities(cases: Sequence[Case]) -> tuple[float, ...]:
    """Round dogleg severities, increasing to that of a hole that turns by 2 ψ* over half the BHA, in the unit shown."""
    highest = max(2 * largest_along(case, "bit_tilt_limit") / case.bha.half_length for case in cases)
    found = [round_down(UNITS["rad/m"].factor * highest)]
    while len(found) < len(BY_SEVERITY) - 1:
        found.append(round_down(0.9 * found[-1]))
    return tuple(reversed(found))


def strip_scales(begin: float, length: float, start: float, ripple: float, count: int) -> StripScales:
    """The scales of a strip, from `begin` on, of `count` runs, m, that can show a ripple, m, of each."""
    height = max(length, 1.0) / (1 - STRIP_TOP - STRIP_BOTTOM)
    top, width = begin - STRIP_TOP * height, STRIP_SHAPE * height
    lane = (1 - STRIP_LEFT) * width / count
    return StripScales(
        bounds=Bounds((-STRIP_LEFT * width, (1 - STRIP_LEFT) * width), (top, top + height)),
        start=start,
        lateral=max(1.0, first_digit(0.45 * lane / ripple)),
        lanes=tuple(lane * (0.5 + place) for place in range(count)),
    )


def lateral_room(run: Trajectory) -> float:
    """The length of a BHA that the bit frame shows beside its hole, m: more, where the hole curves along a long BHA."""
    case = case_of(run)
    straight = case.bit_diameter / WALLS_APART
    if any(name not in run for name in BY_NAME["average_inclination"].names(run.n)):
        return straight
    spans = np.diff(case.bha.stabilizer_positions, prepend=0.0)
    averages = run.stack("average_inclination")
    mean = averages @ spans / spans.sum()
    bend = float(np.abs(np.cumsum((averages - mean[:, None]) * spans, axis=1)).max(initial=0.0))
    return max(straight, (bend + case.bit_diameter / 2) / CURVED)


def plot_ranges(
    plots: Mapping[str, Plot], runs: Sequence[Trajectory], whole: bool
) -> dict[str, tuple[float, float] | None]:
    """The range of each plot for which some runs have values; None if not all of their rows are there."""
    curves = {name: plot.curves(runs) for name, plot in plots.items()}
    if not whole:
        return {name: None for name, some in curves.items() if some}
    there = {name: some for name, some in curves.items() if any(np.isfinite(curve).any() for curve in some)}
    return {name: plot_range(plots[name], some) for name, some in there.items()}


def plot_range(plot: Plot, curves: Sequence[Array]) -> tuple[float, float]:
    """The range of a plot of some curves, in the unit shown."""
    values = np.round(plot.unit.factor * np.concatenate(curves), DECIMALS)
    values = values[np.isfinite(values)]
    low, high = float(values.min()), float(values.max())
    margin = max(MARGIN * (high - low), SMALLEST_SPAN * max(abs(low), abs(high))) or 1.0
    return with_ticks(low - margin, high + margin)


class Extremes:
    """The smallest and largest values of all plots so far: those of a live run have no ranges before its end."""

    def __init__(self, plots: Mapping[str, Plot]) -> None:
        self.plots = plots
        self.found: dict[str, Array] = {}

    def take(self, rows: Trajectory) -> None:
        """Look at the next rows of a run, as they are plotted."""
        for name, plot in self.plots.items():
            values = np.concatenate([self.found.get(name, np.empty(0)), *plot.curves([rows])])
            finite = values[np.isfinite(values)]
            if len(finite):
                self.found[name] = np.array([finite.min(), finite.max()])

    def complete(self, scales: Scales) -> Scales:
        """The same scales with a range for each plot that has had a value."""
        ranges: dict[str, tuple[float, float] | None] = {
            name: span or plot_range(self.plots[name], [self.found[name]])
            for name, span in scales.ranges.items()
            if span or name in self.found
        }
        return replace(scales, ranges=ranges)


def with_ticks(low: float, high: float, most_steps: float = MOST_STEPS) -> tuple[float, float]:
    """A range of a plot, widened as little as possible until two of the values that the viewer numbers lie in it.

    The viewer numbers multiples of a power of ten, the smallest for which there is room.
    """
    step = 10.0 ** ceil(log10((high - low) / most_steps))
    pairs = [(step * (k - EDGE), step * (k + 1 + EDGE)) for k in range(floor(low / step), ceil(high / step))]
    bottom, top = min(pairs, key=lambda pair: max(low - pair[0], 0.0) + max(pair[1] - high, 0.0))
    return min(low, bottom), max(high, top)


def first_digit(value: float) -> float:
    """`value` with all of its digits but the first set to zero."""
    power: float = 10.0 ** floor(log10(value))
    return floor(value / power) * power

"""What is fixed for a recording before its rows are drawn: how large things are shown, and over which ranges."""

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

from .scene import Array, Bounds, frame_bounds, section_bounds
from .style import PLOTS, Plot

WAVES = 11.0  # in view at once
USUAL_WAVELENGTH = 1.4  # half lengths of the BHA: of a ripple that is not there yet
TREND = 0.75  # wavelengths, and no more than half the BHA: the trend keeps nothing of the wave
FULL_RIPPLE = 0.25  # ψ* times the wavelength: what a hole has whose bit tilts from limit to limit
ROOM_FOR_LEGEND = 0.35  # for each curve, over the span of them all
ARROWS = ("stabilizer_force", "bit_lateral_force", "rss_force")


@dataclass(frozen=True)
class Scales:
    """How large things are shown, and over which ranges, for all runs of a recording."""

    section: Bounds  # of the vertical section
    frame: Bounds  # of the bit frame
    lateral: float  # what the bit frame's lateral axis is multiplied by
    newtons_per_metre: float  # of an arrow
    window: float  # m of hole up to the cursor that ripple and lanes show
    ripple: float  # mm, the largest that its plot shows
    trend: float  # m, the width of the trend that the ripple is less
    start: float | None  # m, the measured depth where drilling starts, if it is the same for all
    ranges: dict[str, tuple[float, float] | None]  # of the plots that there are, in their unit; None: as the rows come

    def widened(self, position: Array) -> "Scales":
        """The same with a vertical section at least twice as wide, that shows positions (N, 2) too."""
        shown = np.concatenate((np.transpose((self.section.x, self.section.y)), position))
        return replace(self, section=section_bounds(shown, around=float(np.ptp(shown, axis=0).max()) / 2))


def choose_scales(runs: Sequence[Trajectory], *, whole: bool, section: Array) -> Scales:
    """Choose the scales that suit some runs, each with its case.

    In the bit frame the walls are about half as far apart as the BHA is long, and the largest arrow is a seventh of it.

    Parameters
    ----------
    runs
        The runs, or their beginnings, with all columns that are shown.
    whole
        Whether they are whole. If not, the cases say how long arrows are, and the plots have no ranges yet.
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
    limit = 1.15 * UNITS["rad"].factor * max(case.bit.tilt_limit for case in cases)
    return Scales(
        section=section_bounds(section, around=2 * reach),
        frame=frame_bounds(reach),
        lateral=max(1.0, round_down(0.6 * reach / max(case.bit_diameter for case in cases))),
        newtons_per_metre=max(largest, 1.0) / (reach / 7),
        window=WAVES * wavelength,
        ripple=1000 * FULL_RIPPLE * wavelength * max(case.bit.tilt_limit for case in cases),
        trend=min(TREND * wavelength, *(case.bha.half_length for case in cases)),
        start=starts.pop() if len(starts) == 1 else None,
        ranges=ranges | {"bit_tilt": (-limit, limit)},
    )


def likely_wavelength(runs: Sequence[Trajectory], cases: Sequence[Case], whole: bool) -> float:
    """The longest wave with which one of the runs, if they are whole, ripples; else that which one may come to, m."""
    waves = [find_rippling(run) for run in runs] if whole else []
    found = [wave.wavelength for wave in waves if wave.ripples]
    return max(found or [USUAL_WAVELENGTH * case.bha.half_length for case in cases])


def largest_force(run: Trajectory) -> float:
    """The largest force of a run that is drawn, N."""
    columns = [run.columns[name] for arrow in ARROWS for name in BY_NAME[arrow].names(run.n) if name in run.columns]
    return max(float(np.abs(column).max()) for column in columns)


def likely_force(case: Case) -> float:
    """A force of the size that comes up in a case, N: what bends half the BHA by ψ*/2, or the largest of the pads."""
    stiffness = 3 * case.bha.flexural_stiffness / case.bha.half_length**2
    return max(stiffness * case.bit.tilt_limit / 2, *map(abs, case.schedule.rss_force))


def plot_range(plot: Plot, curves: Sequence[Array], room: float) -> tuple[float, float]:
    """Axis of a plot of some curves, with room above for each in the legend."""
    low = plot.unit.factor * min(float(np.nanmin(curve)) for curve in curves)
    high = plot.unit.factor * max(float(np.nanmax(curve)) for curve in curves)
    span = (high - low) or 1.0
    return low - 0.1 * span, high + (0.1 + room * len(curves)) * span


def round_down(value: float) -> float:
    """Largest of 1, 2 and 5 times a power of ten that is not above `value`."""
    power = 10.0 ** floor(log10(value))
    return max(step * power for step in (1, 2, 5) if step * power <= value)

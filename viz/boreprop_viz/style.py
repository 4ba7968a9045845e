"""How a recording looks: colours, strokes, plots and lanes, and the scales and ranges that suit its runs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from math import degrees, floor, log10, pi

import numpy as np

from boreprop.analysis.rippling import find_rippling
from boreprop.case.case import Case
from boreprop.core.quantities import BY_NAME
from boreprop.run.completion import case_of
from boreprop.run.trajectory import Trajectory
from boreprop.units import BUILD_LENGTH

from .scene import Array, Bounds, frame_bounds, section_bounds

Colour = tuple[int, int, int]
# Okabe and Ito's colours: told apart with any colour vision
ORANGE, SKY_BLUE, GREEN, YELLOW = (230, 159, 0), (86, 180, 233), (0, 158, 115), (240, 228, 66)
VERMILION, PURPLE = (213, 94, 0), (204, 121, 167)
WHITE, GREY, FAINT, GROUND = (240, 240, 240), (150, 155, 160), (52, 58, 66), (20, 23, 28)
BY_STABILIZER = (VERMILION, PURPLE, YELLOW, SKY_BLUE, ORANGE)
BY_RUN = (ORANGE, SKY_BLUE, GREEN, PURPLE, YELLOW, VERMILION)


def shade(colour: Colour, lightness: float) -> Colour:
    """`colour` on its way to white, which it is at a lightness of 1."""
    red, green, blue = (round(c + lightness * (w - c)) for c, w in zip(colour, WHITE, strict=True))
    return red, green, blue


@dataclass(frozen=True)
class Stroke:
    """How lines are drawn: by what they show when one run is shown, by the run's own colour when there are several."""

    colour: Colour
    width: float  # points of the screen
    layer: float
    lightness: float = 0.0  # of the run's own colour

    def of(self, run: Colour) -> "Stroke":
        """The stroke for one of several runs."""
        return replace(self, colour=shade(run, self.lightness))


FURNITURE = {  # what belongs to no run
    "vertical_section/grid": Stroke(FAINT, 1.0, 0.0),
    "vertical_section/plan": Stroke(WHITE, 1.5, 1.5),
    "bit_frame/places": Stroke(FAINT, 1.0, 0.0),
    "bit_frame/scale": Stroke(GREY, 2.0, 0.0),
}
STROKES = {
    "vertical_section/existing_hole": Stroke(GREY, 3.0, 1.0, lightness=0.6),
    "vertical_section/drilled_hole": Stroke(ORANGE, 3.0, 2.0),
    "vertical_section/bha": Stroke(SKY_BLUE, 4.0, 3.0, lightness=0.4),
    "bit_frame/walls": Stroke(ORANGE, 3.0, 2.0),
    "bit_frame/bha": Stroke(SKY_BLUE, 4.0, 3.0, lightness=0.4),
    "bit_frame/stabilizers": Stroke(SKY_BLUE, 6.0, 4.0, lightness=0.4),
    "bit_frame/bit": Stroke(WHITE, 3.0, 5.0, lightness=0.7),
    "bit_frame/tilt/limits": Stroke(GREY, 1.0, 1.0),
    "bit_frame/tilt/hole_axis": Stroke(ORANGE, 2.0, 2.0),
    "bit_frame/tilt/bit_axis": Stroke(WHITE, 3.0, 3.0, lightness=0.7),
}


@dataclass(frozen=True)
class Unit:
    """The unit in which a quantity is shown, and the value in it over the SI value."""

    name: str
    factor: float


DEGREES, KILONEWTON = Unit("°", 180 / pi), Unit("kN", 1e-3)
DEGREES_PER_BUILD_LENGTH = Unit(f"°/{BUILD_LENGTH:g} m", BUILD_LENGTH * 180 / pi)
METRES_PER_HOUR = Unit("m/h", 3600.0)


@dataclass(frozen=True)
class Plot:
    """One plot over the drilled length: columns of one unit, and the colours of their curves in turn."""

    title: str
    unit: Unit
    columns: tuple[str, ...]
    colours: tuple[Colour, ...]

    def names(self, n: int) -> list[str]:
        """Scalars shown for `n` stabilizers; a column that is in no table is one of its own."""
        scalars = [BY_NAME[column].names(n) if column in BY_NAME else [column] for column in self.columns]
        return list(chain.from_iterable(scalars))

    def curves(self, runs: Sequence[Trajectory]) -> list[Array]:
        """What there is to show of some runs, in SI units."""
        return [run.columns[name] for run in runs for name in self.names(run.n) if name in run.columns]


PLOTS = {
    "inclination": Plot(
        "Inclination",
        DEGREES,
        ("borehole_inclination", "bit_inclination", "planned_inclination"),
        (ORANGE, SKY_BLUE, WHITE),
    ),
    "build_rate": Plot(
        f"Build rate over {BUILD_LENGTH:g} m, dogleg severity over half the BHA",
        DEGREES_PER_BUILD_LENGTH,
        ("dogleg_severity", "build_rate"),
        (GREY, GREEN),
    ),
    "bit_tilt": Plot("Bit tilt and its limits", DEGREES, ("bit_tilt",), (SKY_BLUE,)),
    "stabilizer_force": Plot("Contact forces, + from the low side", KILONEWTON, ("stabilizer_force",), BY_STABILIZER),
    "bit_lateral_force": Plot("Bit side force", KILONEWTON, ("bit_lateral_force",), (SKY_BLUE,)),
    "rss_force": Plot("RSS force, + builds", KILONEWTON, ("rss_force",), (GREEN,)),
    "active_weight_on_bit": Plot("Active weight on bit", KILONEWTON, ("active_weight_on_bit",), (YELLOW,)),
    "rate_of_penetration": Plot("Rate of penetration", METRES_PER_HOUR, ("rate_of_penetration",), (PURPLE,)),
}
TABS = {
    "Hole": ("inclination", "build_rate", "bit_tilt"),
    "Forces": ("stabilizer_force", "bit_lateral_force", "rss_force"),
    "Drilling": ("active_weight_on_bit", "rate_of_penetration"),
}

Lane = dict[int, tuple[str, Colour]]  # what a whole number of the table means, and its colour
LANES: dict[str, Lane] = {
    "stabilizer_contact": {1: ("low", ORANGE), -1: ("high", SKY_BLUE), 0: ("free", FAINT)},
    "bit_tilt_saturation": {1: ("+ψ*", VERMILION), -1: ("−ψ*", PURPLE), 0: ("free", FAINT)},
}


def curve_label(name: str) -> str:
    """Symbol, with its index, and name in words of a scalar of the table; of any other column its name in words."""
    column, _, index = name.rstrip("]").partition("[")
    words = column.replace("_", " ")
    if column not in BY_NAME:
        return words
    symbol = BY_NAME[column].symbol
    return f"{symbol.replace('i', index) if index else symbol}  {words}"


@dataclass(frozen=True)
class Look:
    """What is fixed for a recording before its rows are drawn."""

    section: Bounds  # of the vertical section
    frame: Bounds  # of the bit frame
    lateral: float  # what the bit frame's lateral axis is multiplied by
    newtons_per_metre: float  # of an arrow
    window: float  # m of hole up to the cursor that ripple and lanes show
    ripple: float  # mm, the largest that its plot shows
    trend: float  # m, the width of the trend that the ripple is less
    start: float | None  # m, the measured depth where drilling starts, if it is the same for all
    ranges: dict[str, tuple[float, float] | None]  # of the plots that there are, in their unit; None: as the rows come

    def around(self, position: Array) -> "Look":
        """The look with a vertical section twice as wide or more, that shows positions (N, 2) too."""
        shown = np.concatenate((np.transpose((self.section.x, self.section.y)), position))
        return replace(self, section=section_bounds(shown, around=float(np.ptp(shown, axis=0).max()) / 2))


WAVES = 11.0  # in view at once
USUAL_WAVELENGTH = 1.4  # half lengths of the BHA: of a ripple that is not there yet
TREND = 0.75  # wavelengths, and no more than half the BHA: the trend keeps nothing of the wave
FULL_RIPPLE = 0.25  # ψ* times the wavelength: what a hole has whose bit tilts from limit to limit


def look(runs: Sequence[Trajectory], *, whole: bool, section: Array) -> Look:
    """The look that suits runs of known case.

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
    limit = 1.15 * degrees(max(case.bit.tilt_limit for case in cases))
    return Look(
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


ARROWS = ("stabilizer_force", "bit_lateral_force", "rss_force")


def largest_force(run: Trajectory) -> float:
    """The largest force of a run that is drawn, N."""
    columns = [run.columns[name] for arrow in ARROWS for name in BY_NAME[arrow].names(run.n) if name in run.columns]
    return max(float(np.abs(column).max()) for column in columns)


def likely_force(case: Case) -> float:
    """A force of the size that comes up in a case, N: what bends half the BHA by ψ*/2, or the largest of the pads."""
    stiffness = 3 * case.bha.flexural_stiffness / case.bha.half_length**2
    return max(stiffness * case.bit.tilt_limit / 2, *map(abs, case.schedule.rss_force))


ROOM_FOR_LEGEND = 0.35  # for each curve, over the span of them all


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

"""How a recording looks: colours and plots, and the scales and ranges that suit a run."""

from dataclasses import dataclass
from math import degrees, floor, log10, pi

import numpy as np

from boreprop.case import Case
from boreprop.core.variables import BY_NAME
from boreprop.results import Trajectory

from .scene import Array, Bounds, bit_positions, frame_bounds, section_bounds

Colour = tuple[int, int, int]
# Okabe and Ito's colours: told apart with any colour vision
ORANGE, SKY_BLUE, GREEN, YELLOW = (230, 159, 0), (86, 180, 233), (0, 158, 115), (240, 228, 66)
VERMILION, PURPLE = (213, 94, 0), (204, 121, 167)
WHITE, GREY, FAINT, GROUND = (240, 240, 240), (150, 155, 160), (52, 58, 66), (20, 23, 28)
BY_STABILIZER = (VERMILION, PURPLE, YELLOW, SKY_BLUE, ORANGE)

STRIPS: dict[str, tuple[Colour, float, float]] = {  # colour, width in points of the screen, layer
    "vertical_section/grid": (FAINT, 1.0, 0.0),
    "vertical_section/existing_hole": (GREY, 3.0, 1.0),
    "vertical_section/drilled_hole": (ORANGE, 3.0, 2.0),
    "vertical_section/bha": (SKY_BLUE, 4.0, 3.0),
    "bit_frame/places": (FAINT, 1.0, 0.0),
    "bit_frame/scale": (GREY, 2.0, 0.0),
    "bit_frame/hole_axis": (GREY, 1.0, 1.0),
    "bit_frame/walls": (ORANGE, 3.0, 2.0),
    "bit_frame/bha": (SKY_BLUE, 4.0, 3.0),
    "bit_frame/stabilizers": (SKY_BLUE, 6.0, 4.0),
    "bit_frame/bit": (WHITE, 3.0, 5.0),
}

UNITS = {"rad": ("°", 180 / pi), "N": ("kN", 1e-3)}


@dataclass(frozen=True)
class Plot:
    """One plot over the drilled length: variables of one unit, and the colours of their curves in turn."""

    title: str
    variables: tuple[str, ...]
    colours: tuple[Colour, ...]

    @property
    def unit(self) -> str:
        """The unit shown."""
        return UNITS[BY_NAME[self.variables[0]].unit][0]

    @property
    def factor(self) -> float:
        """The value shown over the SI value."""
        return UNITS[BY_NAME[self.variables[0]].unit][1]

    @property
    def legend(self) -> bool:
        """Whether the title does not say it all."""
        return len(self.colours) > 1

    def names(self, n: int) -> list[str]:
        """Scalars shown for `n` stabilizers."""
        return [name for variable in self.variables for name in BY_NAME[variable].names(n)]


PLOTS = {
    "inclination": Plot("Inclination", ("borehole_inclination", "bit_inclination"), (ORANGE, SKY_BLUE)),
    "bit_tilt": Plot("Bit tilt ψ, limits ±{tilt_limit:.3g}", ("bit_tilt",), (SKY_BLUE,)),
    "stabilizer_force": Plot("Contact forces, + from the low side", ("stabilizer_force",), BY_STABILIZER),
    "rss_force": Plot("RSS force, + builds", ("rss_force",), (GREEN,)),
}


def curve_label(name: str) -> str:
    """Symbol, with its index, and name in words of a scalar of the table."""
    variable, _, index = name.rstrip("]").partition("[")
    symbol = BY_NAME[variable].symbol
    return f"{symbol.replace('i', index) if index else symbol}  {variable.replace('_', ' ')}"


@dataclass(frozen=True)
class Scales:
    """What is fixed for a recording."""

    section: Bounds  # of the vertical section
    frame: Bounds  # of the bit frame
    lateral: float  # what the bit frame's lateral axis is multiplied by
    newtons_per_metre: float  # of an arrow
    ranges: dict[str, tuple[float, float]]  # of the plots that there are, in the unit shown
    tilt_limit: float  # ψ*, degrees


def scales(run: Trajectory, case: Case) -> Scales:
    """Scales for a run.

    In the bit frame the walls are about half as far apart as the BHA is long, and the largest arrow is a seventh of it.
    """
    reach = case.bha.stabilizer_positions[-1]
    forces = np.column_stack((run.stack("stabilizer_force"), run["rss_force"]))
    curves = {entity: np.array([run[name] for name in plot.names(run.n)]) for entity, plot in PLOTS.items()}
    ranges = {entity: plot_range(plot, curves[entity]) for entity, plot in PLOTS.items() if curves[entity].size}
    limit = degrees(case.bit.tilt_limit)
    return Scales(
        section=section_bounds(bit_positions(run), around=2 * reach),
        frame=frame_bounds(reach),
        lateral=max(1.0, round_down(0.6 * reach / case.bit_diameter)),
        newtons_per_metre=max(float(np.abs(forces).max()), 1.0) / (reach / 7),
        ranges=ranges | {"bit_tilt": (-1.15 * limit, 1.15 * limit)},
        tilt_limit=limit,
    )


def plot_range(plot: Plot, curves: Array) -> tuple[float, float]:
    """Axis of a plot of `curves`, (curves, rows), with room above for the legend."""
    low, high = plot.factor * float(curves.min()), plot.factor * float(curves.max())
    span = (high - low) or 1.0
    return low - 0.1 * span, high + (0.1 + 0.25 * plot.legend * len(curves)) * span


def round_down(value: float) -> float:
    """Largest of 1, 2 and 5 times a power of ten that is not above `value`."""
    power = 10.0 ** floor(log10(value))
    return max(step * power for step in (1, 2, 5) if step * power <= value)

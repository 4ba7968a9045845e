"""The style of a recording: colours, strokes, plots and lanes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain

from boreprop.core.quantities import BY_NAME
from boreprop.run.trajectory import Trajectory
from boreprop.units import BUILD_LENGTH, UNITS, Unit

from .scene import Array

Colour = tuple[int, int, int]
# the colours of Okabe and Ito, which can be told apart with any colour vision
ORANGE, SKY_BLUE, GREEN, YELLOW = (230, 159, 0), (86, 180, 233), (0, 158, 115), (240, 228, 66)
VERMILION, PURPLE = (213, 94, 0), (204, 121, 167)
WHITE, GREY, FAINT, GROUND = (240, 240, 240), (150, 155, 160), (52, 58, 66), (20, 23, 28)
BY_STABILIZER = (VERMILION, PURPLE, YELLOW, SKY_BLUE, ORANGE)
# from the smallest to the largest dogleg severity, lighter and lighter, so that they can be told apart with any vision
BY_SEVERITY = ((140, 92, 10), (176, 116, 0), (208, 142, 8), (234, 170, 34), (250, 204, 90), (255, 240, 180))
BY_RUN = (ORANGE, SKY_BLUE, GREEN, PURPLE, YELLOW, VERMILION)


def shade(colour: Colour, lightness: float) -> Colour:
    """`colour` mixed with white: 0 is the colour itself, 1 is white."""
    red, green, blue = (round(c + lightness * (w - c)) for c, w in zip(colour, WHITE, strict=True))
    return red, green, blue


@dataclass(frozen=True)
class Stroke:
    """How lines are drawn. If there are several runs, each has its own colour, which replaces that of the stroke."""

    colour: Colour | None  # None: each line has its own
    width: float  # in points of the screen
    layer: float  # higher layers are drawn over lower ones
    lightness: float = 0.0  # to which the run's own colour is lightened

    def of(self, run: Colour) -> "Stroke":
        """The stroke for one of several runs."""
        return replace(self, colour=shade(run, self.lightness))


FURNITURE = {  # lines that are common to all runs
    "vertical_section/grid": Stroke(FAINT, 1.0, 0.0),
    "vertical_section/plan": Stroke(WHITE, 1.5, 1.5),
    "strip/grid": Stroke(FAINT, 1.0, 0.0),
    "bit_frame/places": Stroke(FAINT, 1.0, 0.0),
    "bit_frame/scale": Stroke(GREY, 2.0, 0.0),
}
STROKES = {
    "vertical_section/existing_hole": Stroke(GREY, 3.0, 1.0, lightness=0.6),
    "vertical_section/drilled_hole": Stroke(None, 3.0, 2.0),
    "vertical_section/newly_drilled": Stroke(None, 3.0, 2.0),
    "vertical_section/bha": Stroke(SKY_BLUE, 4.0, 3.0, lightness=0.4),
    "vertical_section/stabilizers": Stroke(SKY_BLUE, 6.0, 4.0, lightness=0.4),
    "strip/hole": Stroke(ORANGE, 1.0, 1.0),
    "bit_frame/walls": Stroke(ORANGE, 3.0, 2.0),
    "bit_frame/bha": Stroke(SKY_BLUE, 4.0, 3.0, lightness=0.4),
    "bit_frame/stabilizers": Stroke(SKY_BLUE, 6.0, 4.0, lightness=0.4),
    "bit_frame/bit": Stroke(WHITE, 3.0, 5.0, lightness=0.7),
    "bit_frame/tilt/limits": Stroke(GREY, 1.0, 1.0),
    "bit_frame/tilt/hole_axis": Stroke(ORANGE, 2.0, 2.0),
    "bit_frame/tilt/bit_axis": Stroke(WHITE, 3.0, 3.0, lightness=0.7),
}


SI_OF_HOLE = {"build_rate": "rad/m", "dogleg_severity": "rad/m"}  # SI units of `source.hole_columns`


@dataclass(frozen=True)
class Plot:
    """A plot over the drilled length: its columns, all of one unit, and the colours of their curves in turn."""

    title: str
    columns: tuple[str, ...]
    colours: tuple[Colour, ...]

    @property
    def unit(self) -> Unit:
        """The unit in which the columns are shown."""
        column = self.columns[0]
        return UNITS[BY_NAME[column].unit if column in BY_NAME else SI_OF_HOLE[column]]

    def names(self, n: int) -> list[str]:
        """The scalar names of the columns for `n` stabilizers. A column that is not in the table is a scalar."""
        scalars = [BY_NAME[column].names(n) if column in BY_NAME else [column] for column in self.columns]
        return list(chain.from_iterable(scalars))

    def curves(self, runs: Sequence[Trajectory]) -> list[Array]:
        """The values of all columns that some runs have, in SI units."""
        return [run.columns[name] for run in runs for name in self.names(run.n) if name in run.columns]


PLOTS = {
    "inclination": Plot(
        "Inclination",
        ("borehole_inclination", "bit_inclination", "planned_inclination"),
        (ORANGE, SKY_BLUE, WHITE),
    ),
    "build_rate": Plot(
        f"Build rate over {BUILD_LENGTH:g} m, dogleg severity over half the BHA",
        ("dogleg_severity", "build_rate"),
        (GREY, GREEN),
    ),
    "bit_tilt": Plot("Bit tilt and its limits", ("bit_tilt",), (SKY_BLUE,)),
    "stabilizer_force": Plot("Contact forces, + from the low side", ("stabilizer_force",), BY_STABILIZER),
    "bit_lateral_force": Plot("Bit side force", ("bit_lateral_force",), (SKY_BLUE,)),
    "rss_force": Plot("RSS force, + builds", ("rss_force",), (GREEN,)),
    "active_weight_on_bit": Plot("Active weight on bit", ("active_weight_on_bit",), (YELLOW,)),
    "rate_of_penetration": Plot("Rate of penetration", ("rate_of_penetration",), (PURPLE,)),
}
TABS = {
    "Hole": ("inclination", "build_rate", "bit_tilt"),
    "Forces": ("stabilizer_force", "bit_lateral_force", "rss_force"),
    "Drilling": ("active_weight_on_bit", "rate_of_penetration"),
}

Lane = dict[int, tuple[str, Colour]]  # value → its name and colour
LANES: dict[str, Lane] = {
    "stabilizer_contact": {1: ("low", ORANGE), -1: ("high", SKY_BLUE), 0: ("free", FAINT)},
    "bit_tilt_saturation": {1: ("+ψ*", VERMILION), -1: ("−ψ*", PURPLE), 0: ("free", FAINT)},
}


def curve_label(name: str) -> str:
    """The label of a curve: the symbol, with its index, and the name in words; without a symbol, the name alone."""
    column, _, index = name.rstrip("]").partition("[")
    words = column.replace("_", " ")
    if column not in BY_NAME:
        return words
    symbol = BY_NAME[column].symbol
    return f"{symbol.replace('i', index) if index else symbol}  {words}"

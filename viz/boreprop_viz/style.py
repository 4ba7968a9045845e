"""The style of a recording: colours, strokes, plots and lanes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain

from boreprop.core.quantities import BY_NAME, MAX_SENSORS, Structure
from boreprop.run.trajectory import Trajectory
from boreprop.units import BUILD_LENGTH, SMALL_LENGTH, UNITS, Unit

from .scene import Array

Colour = tuple[int, int, int]
DECIMALS = 4  # of the values of a curve
# the colours of Okabe and Ito, which can be told apart with any colour vision, less their yellow: each of these shows
# on white and on black
ORANGE, SKY_BLUE, GREEN = (230, 159, 0), (86, 180, 233), (0, 158, 115)
VERMILION, PURPLE, BLUE = (213, 94, 0), (204, 121, 167), (0, 114, 178)
OLIVE, VIOLET, BROWN = (150, 145, 50), (140, 115, 220), (165, 115, 90)
CRIMSON, TEAL = (200, 60, 110), (0, 150, 160)
WHITE, GREY, FAINT, GROUND = (240, 240, 240), (150, 155, 160), (52, 58, 66), (20, 23, 28)
# one colour, one meaning, in all views
HOLE, BIT, PLAN, RSS, BODY = ORANGE, SKY_BLUE, PURPLE, GREEN, WHITE
BY_STABILIZER = (VERMILION, VIOLET, BROWN, CRIMSON, TEAL)
# from the smallest to the largest dogleg severity, lighter and lighter, so that they can be told apart with any vision
BY_SEVERITY = ((140, 92, 10), (176, 116, 0), (208, 142, 8), (234, 170, 34), (250, 204, 90), (255, 240, 180))
BY_RUN = (ORANGE, SKY_BLUE, GREEN, VERMILION, BLUE, VIOLET, OLIVE, BROWN, CRIMSON, TEAL)


# of a run's colour, the first is the colour itself, the others are greyer
SHADES = (0.0, 0.5, 0.65, 0.75, 0.8, 0.83, 0.86, 0.88)


def mixed(colour: Colour, other: Colour, share: float) -> Colour:
    """`colour` with a share of another one."""
    red, green, blue = (round(c + share * (o - c)) for c, o in zip(colour, other, strict=True))
    return red, green, blue


BY_SENSOR = tuple(mixed(BLUE, WHITE, i / MAX_SENSORS) for i in range(MAX_SENSORS))


@dataclass(frozen=True)
class Stroke:
    """How lines are drawn. If there are several runs, each has its own colour, which replaces that of the stroke."""

    colour: Colour | None  # None: each line has its own
    width: float  # in points of the screen
    layer: float  # higher layers are drawn over lower ones
    lightness: float = 0.0  # to which the run's own colour is lightened

    def of(self, run: Colour) -> "Stroke":
        """The stroke for one of several runs."""
        return replace(self, colour=mixed(run, WHITE, self.lightness))


FURNITURE = {  # lines that are common to all runs
    "vertical_section/grid": Stroke(FAINT, 1.0, 0.0),
    "vertical_section/plan": Stroke(PLAN, 1.5, 1.5),
    "strip/grid": Stroke(FAINT, 1.0, 0.0),
    "bit_frame/places": Stroke(FAINT, 1.0, 0.0),
    "bit_frame/scale": Stroke(GREY, 2.0, 0.0),
}
STROKES = {
    "vertical_section/existing_hole": Stroke(GREY, 3.0, 1.0, lightness=0.6),
    "vertical_section/drilled_hole": Stroke(None, 3.0, 2.0),
    "vertical_section/newly_drilled": Stroke(None, 3.0, 2.0),
    "vertical_section/bha": Stroke(BIT, 4.0, 3.0, lightness=0.4),
    "vertical_section/stabilizers": Stroke(BIT, 6.0, 4.0, lightness=0.4),
    "strip/hole": Stroke(HOLE, 1.0, 1.0),
    "bit_frame/walls": Stroke(HOLE, 3.0, 2.0),
    "bit_frame/bha": Stroke(BIT, 4.0, 3.0, lightness=0.4),
    "bit_frame/body": Stroke(BIT, 1.0, 3.0, lightness=0.4),
    "bit_frame/stabilizers": Stroke(BIT, 6.0, 4.0, lightness=0.4),
    "bit_frame/bit": Stroke(BIT, 3.0, 5.0, lightness=0.7),
    "bit_frame/tilt/limits": Stroke(GREY, 1.0, 1.0),
    "bit_frame/tilt/hole_axis": Stroke(HOLE, 2.0, 2.0),
    "bit_frame/tilt/bit_axis": Stroke(BIT, 3.0, 3.0, lightness=0.7),
}


STROKES_IN_SPACE = {
    "plan_view/existing_hole": STROKES["vertical_section/existing_hole"],
    "plan_view/drilled_hole": STROKES["vertical_section/drilled_hole"],
    "plan_view/newly_drilled": STROKES["vertical_section/newly_drilled"],
    "plan_view/bha": STROKES["vertical_section/bha"],
    "across/blades": Stroke(BIT, 4.0, 2.0, lightness=0.4),
    "across/tilt": Stroke(BIT, 3.0, 3.0, lightness=0.7),
}

SI_OF_HOLE = {  # SI units of `source.hole_columns`, …
    "build_rate": "rad/m",
    "walk_rate": "rad/m",
    "dogleg_severity": "rad/m",
    "distance_from_plan": "m",
    "distance_from_plan_high": "m",
    "distance_from_plan_right": "m",
    "inclination_less_plan": "rad",
    "azimuth_less_plan": "rad",
}
OVER = {name: f"over {BUILD_LENGTH:g} m" for name in ("build_rate", "walk_rate")} | {
    "dogleg_severity": "over half the BHA"
}  # … and over what they are


@dataclass(frozen=True)
class Plot:
    """A plot over the drilled length: its columns, all of one unit, and the colours of their curves in turn."""

    title: str
    columns: tuple[str, ...]
    colours: tuple[Colour, ...]
    planned: str = ""  # the column with what is planned, which all runs share
    small: bool = False  # a length shown in mm

    @property
    def unit(self) -> Unit:
        """The unit in which the columns are shown."""
        column = self.columns[0]
        if self.small:
            return SMALL_LENGTH
        return UNITS[BY_NAME[column].unit if column in BY_NAME else SI_OF_HOLE[column]]

    def names(self, structure: int | Structure) -> list[str]:
        """The scalar names of the columns for a structure. A column that is not in the table is a scalar."""
        scalars = [BY_NAME[column].names(structure) if column in BY_NAME else [column] for column in self.columns]
        return list(chain.from_iterable(scalars))

    def curves(self, runs: Sequence[Trajectory]) -> list[Array]:
        """The values of all columns that some runs have, in SI units."""
        return [
            run.columns[name]
            for run in runs
            for name in [*self.names(run.structure), self.planned]
            if name in run.columns
        ]


PLOTS = {
    "inclination": Plot("Inclination", ("borehole_inclination", "bit_inclination"), (HOLE, BIT), "planned_inclination"),
    "build_rate": Plot("Build rate, dogleg severity", ("build_rate", "dogleg_severity"), (HOLE, OLIVE)),
    "distance_from_plan": Plot("Distance from the plan, + on its high side", ("distance_from_plan",), (HOLE,)),
    "inclination_less_plan": Plot("Inclination less that of the plan", ("inclination_less_plan",), (HOLE,)),
    "bit_tilt": Plot("Bit tilt", ("bit_tilt",), (BIT,)),
    "bit_lateral_force": Plot("Bit side force", ("bit_lateral_force",), (BIT,)),
    "stabilizer_force": Plot("Contact forces, + from the low side", ("stabilizer_force",), BY_STABILIZER),
    "rss_force": Plot("RSS force, + builds", ("rss_force",), (RSS,)),
    "sensor_inclination": Plot("Inclination at the sensors", ("sensor_inclination",), BY_SENSOR),
    "sensor_bending_moment": Plot("Bending moment at the sensors", ("sensor_bending_moment",), BY_SENSOR),
    "sensor_clearance": Plot(
        "Distance of the body from the wall at the sensors", ("sensor_clearance",), BY_SENSOR, small=True
    ),
    "active_weight_on_bit": Plot("Active weight on bit", ("active_weight_on_bit",), (BLUE,)),
    "rate_of_penetration": Plot("Rate of penetration", ("rate_of_penetration",), (BLUE,)),
}
PLOTS_IN_SPACE = {
    "inclination": PLOTS["inclination"],
    "azimuth": Plot("Azimuth", ("borehole_azimuth", "bit_azimuth"), (HOLE, BIT), "planned_azimuth"),
    "build_rate": Plot(
        "Build and walk rate, dogleg severity", ("build_rate", "walk_rate", "dogleg_severity"), (HOLE, BLUE, OLIVE)
    ),
    "distance_from_plan": Plot(
        "Distance from the plan: magnitude, high, right",
        ("distance_from_plan", "distance_from_plan_high", "distance_from_plan_right"),
        (GREY, BIT, BLUE),
    ),
    "inclination_less_plan": PLOTS["inclination_less_plan"],
    "azimuth_less_plan": Plot("Azimuth less that of the plan", ("azimuth_less_plan",), (HOLE,)),
    "bit_tilt": Plot(
        "Bit tilt: magnitude, high, right", ("bit_tilt", "bit_tilt_high", "bit_tilt_right"), (GREY, BIT, BLUE)
    ),
    "bit_lateral_force": Plot(
        "Bit side force: magnitude, high, right",
        ("bit_lateral_force", "bit_lateral_force_high", "bit_lateral_force_right"),
        (GREY, BIT, BLUE),
    ),
    "stabilizer_force": replace(PLOTS["stabilizer_force"], title="Contact forces"),
    "rss_force": replace(PLOTS["rss_force"], title="RSS force"),
    "rss_toolface": Plot("Toolface", ("rss_toolface",), (RSS,)),
    "sensor_inclination": PLOTS["sensor_inclination"],
    "sensor_azimuth": Plot("Azimuth at the sensors", ("sensor_azimuth",), BY_SENSOR),
    "sensor_bending_moment": PLOTS["sensor_bending_moment"],
    "sensor_clearance": PLOTS["sensor_clearance"],
    "active_weight_on_bit": PLOTS["active_weight_on_bit"],
    "rate_of_penetration": PLOTS["rate_of_penetration"],
}
TABS_IN_SPACE = (
    ("Hole", ("inclination", "azimuth", "build_rate")),
    ("Plan", ("distance_from_plan", "inclination_less_plan", "azimuth_less_plan")),
    ("Tilt", ("bit_tilt", "bit_lateral_force")),
    ("Forces", ("stabilizer_force", "rss_force", "rss_toolface")),
    ("Sensors", ("sensor_inclination", "sensor_azimuth", "sensor_bending_moment", "sensor_clearance")),
    ("Drilling", ("active_weight_on_bit", "rate_of_penetration")),
)
TABS = (  # names of tabs and the plots in each
    ("Hole", ("inclination", "build_rate", "bit_tilt")),
    ("Plan", ("distance_from_plan", "inclination_less_plan")),
    ("Forces", ("stabilizer_force", "rss_force", "bit_lateral_force")),
    ("Sensors", ("sensor_inclination", "sensor_bending_moment", "sensor_clearance")),
    ("Drilling", ("active_weight_on_bit", "rate_of_penetration")),
)

# value → the word in a lane, short enough for a narrow one, and which shade of the lane's colour; None is faint
Lanes = dict[str, dict[int, tuple[str, int | None]]]
LANES: Lanes = {
    "stabilizer_contact": {1: ("L", 0), -1: ("H", 1), 0: ("–", None)},
    "bit_tilt_saturation": {1: ("+", 0), -1: ("−", 1), 0: ("–", None)},
}
LANES_TITLE = "Contacts: low, high side; saturated tilt: +, −"
LANES_TITLE_IN_SPACE = "Contacts: on the wall; tilt at its limit ψ*"
LANES_IN_SPACE: Lanes = {
    "stabilizer_contact": {1: ("on", 0), 0: ("–", None)},
    "bit_tilt_saturation": {1: ("ψ*", 0), 0: ("–", None)},
}


def curve_label(name: str, unit: Unit) -> str:
    """The label of a curve: the name in words, with its index, and the unit."""
    column, _, index = name.rstrip("]").partition("[")
    return unit.heading(f"{column.replace('_', ' ')} {OVER.get(column, index)}".rstrip())

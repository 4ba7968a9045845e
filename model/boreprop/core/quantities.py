"""The one table of everything that goes into or comes out of the model.

The case file's keys and messages, the FMU's description, the C structs, result files, tables and pictures all follow
from it. `n` is the number of stabilizers, counted from the bit up; a quantity of size "n" or "n-1" has one element for
each (non-ideal) stabilizer, named ``name[1]``, ``name[2]``, …; the other sizes are those of a `Structure`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import inf, isfinite, pi
from typing import Any, Literal, NamedTuple

Role = Literal["input", "output", "parameter", "case"]  # "case": only a case has it, an FMU has not
Kind = Literal["Real", "Integer", "Boolean", "String"]
Size = Literal[
    "1",
    "n",
    "n-1",
    "uniform",
    "sections",
    "stepped",
    "axial",
    "points",
    "body",
    "layered",
    "sensors",
    "space",
    "space n-1",
    "space sensors",
    "space body",
    "column",
    "space column",
]  # "column": as long as its table

MAX_STABILIZERS = 6
MAX_SECTIONS = 24
MAX_POINTS = 128  # of the body at which it may touch the wall
MOST_WALK = 89 / 180 * pi  # rad: at a right angle the tilt is no longer unique
MAX_SENSORS = 8
MOST_DRILLED = 1e5  # m in a communication step of an FMU: no hole is longer, and a step must end soon
TOOLFACE_REFERENCES = ("gravity", "north", "frame")
"""From where a toolface counts: from the high side, from north, or from the frame of the bit, which does not twist."""
RELATIVE_TOLERANCE = 1e-7  # with it θ is within 5e-7 rad of the reference trajectories


class Structure(NamedTuple):
    """How a drilling system is made up, which says how many values each quantity has."""

    stabilizers: int
    sections: int = 0  # of the beam; none: it is uniform
    axial_load: int = 0  # 1: the load along the beam counts
    body_points: int = 0  # of the beam between the stabilizers, at which its body may touch the wall
    layered: int = 0  # 1: rock comes in layers by true vertical depth
    sensors: int = 0
    space: int = 0  # 1: the hole may leave its vertical plane

    @property
    def is_of_the_paper(self) -> bool:
        """Whether it is a uniform beam without a load along it, the paper's."""
        return not self.beyond_the_paper

    @property
    def beyond_the_paper(self) -> str:
        """What it has that the paper's beam has not, by the names in case files; empty if nothing."""
        has = {"section": self.sections, "axial_load": self.axial_load, "body_contact": self.body_points}
        return ", ".join(name for name, count in has.items() if count)


@cache
def counts(structure: Structure) -> dict[str, int]:
    """Size → how many values a quantity of that size has."""
    n, sections, axial, points, layered, sensors, space = structure
    return {
        "1": 1,
        "n": n,
        "n-1": n - 1,
        "column": 1,
        "uniform": int(not sections),
        "stepped": int(bool(sections)),
        "sections": sections,
        "axial": axial,
        "points": points,
        "body": int(bool(points)),
        "layered": layered,
        "sensors": sensors,
        "space": space,
        "space n-1": space * (n - 1),
        "space sensors": space * sensors,
        "space body": space * bool(points),
        "space column": space,
    }


@dataclass(frozen=True, eq=False)
class Quantity:
    """One quantity at the edge of the model, in SI units.

    Parameters
    ----------
    name, role, unit, symbol, equation, meaning
        What it is; symbol and equation are the paper's.
    kind, size
        Type and number of its values.
    above, at_least, at_most
        The accepted range of each value: above < value, at_least <= value <= at_most. Constraints between several
        values (positions must increase) are checked where the values come together.
    nominal
        Its usual magnitude.
    start
        Its value where a case does not give one.
    follows
        Of an output, the inputs and parameters that it follows at once, without any drilling.
    tunable
        Of a parameter, whether it may change along a run.
    slope
        Of an input, whether the engines also take its change per metre drilled; without it, it is held along a leg.
    key
        Its table and key in a case file, such as "bha.rss_position". A key that ends in _deg holds degrees.
    field
        The field of a `Case` that holds it, such as "bha.rss_position".
    """

    name: str
    role: Role
    unit: str
    symbol: str
    equation: str
    meaning: str
    kind: Kind = "Real"
    size: Size = "1"
    above: float = -inf
    at_least: float = -inf
    at_most: float = inf
    nominal: float = 1.0
    start: float | str | None = None
    follows: tuple[str, ...] = ()
    slope: bool = False
    tunable: bool = False
    key: str = ""
    field: str = ""

    def names(self, structure: int | Structure) -> list[str]:
        """The scalar names of this quantity, for a structure or for so many stabilizers on the paper's beam."""
        count = self.count(structure)
        return [f"{self.name}[{i}]" for i in range(1, count + 1)] if self.is_list else [self.name] * count

    def count(self, structure: int | Structure) -> int:
        """How many values it has, for a structure or for so many stabilizers on the paper's beam."""
        made = structure if isinstance(structure, Structure) else Structure(structure)
        return counts(made)[self.size]

    @property
    def is_list(self) -> bool:
        """Whether its values are numbered."""
        return self.size in ("n", "n-1", "sections", "points", "sensors", "space n-1", "space sensors")

    @property
    def acts(self) -> bool:
        """Whether it is an input of the drilling system: the rate of penetration, which no case has, is none."""
        return self.role == "input" and self.name != "rate_of_penetration"

    @property
    def part(self) -> str:
        """The part of a `Case` that holds it, such as "bha"; empty for the case itself."""
        return self.field.rpartition(".")[0]

    @property
    def attribute(self) -> str:
        """Its name in that part."""
        return self.field.rpartition(".")[2]

    @property
    def range(self) -> str:
        """The accepted range in words, such as "> 0, <= 1"; empty if every value is accepted."""
        bounds = ((">", self.above), (">=", self.at_least), ("<=", self.at_most))
        return ", ".join(f"{sign} {bound:g}" for sign, bound in bounds if isfinite(bound))


SHAPE = (
    *("stabilizer_position", "stabilizer_clearance", "rss_position", "distributed_weight", "flexural_stiffness"),
    *("section_length", "section_distributed_weight", "section_flexural_stiffness", "end_deflection"),
    *("body_point_position", "body_point_clearance"),
)
FORCE = ("rss_force", "rss_toolface", "toolface_reference", "weight_on_bit", "survey_file", *SHAPE)
INSTRUMENT = ("sensor_bias", "sensor_noise", "sensor_seed")
FORCE_AND_WEIGHT = (*FORCE, "active_weight_on_bit", "lateral_steering_resistance", "bit_tilt_limit", "bit_walk_angle")

QUANTITIES: tuple[Quantity, ...] = (
    Quantity("drilled_length", "output", "m", "ξ ℓ₁", "(17)", "length drilled since the start of the run", at_least=0.0, nominal=100.0, key="rss.drilled_length", field="schedule.drilled_length"),

    Quantity("rss_force", "input", "N", "F_RSS", "(21)", "force of the steering pads on the BHA, positive builds", nominal=1e4, slope=True, key="rss.force", field="schedule.rss_force"),
    Quantity("active_weight_on_bit", "input", "N", "Π F*", "(3)", "weight on bit that goes into drilling", above=0.0, nominal=1e4, slope=True, key="drilling.active_weight_on_bit", field="active_weight_on_bit"),
    Quantity("rate_of_penetration", "input", "m/s", "", "", "drilled length per time", at_least=0.0, start=1.0),
    Quantity("lateral_steering_resistance", "input", "", "η", "(4)", "lateral over axial drilling resistance", above=0.0, nominal=10.0, slope=True, key="bit.lateral_steering_resistance", field="bit.lateral_steering_resistance"),
    Quantity("angular_steering_resistance", "input", "", "χ", "(4)", "angular over axial drilling resistance", above=0.0, slope=True, key="bit.angular_steering_resistance", field="bit.angular_steering_resistance"),
    Quantity("bit_tilt_limit", "input", "rad", "ψ*", "(10)", "tilt at which the bit gauge meets the wall", above=0.0, at_most=pi / 2, nominal=0.01, slope=True, key="bit.tilt_limit_deg", field="bit.tilt_limit"),
    Quantity("weight_on_bit", "input", "N", "W", "(3)", "all of the weight on bit, which presses the BHA along its axis; 0: the active weight", size="axial", at_least=0.0, nominal=1e5, key="drilling.weight_on_bit", field="weight_on_bit"),
    Quantity("bit_walk_angle", "input", "rad", "ϖ", "", "walk angle: from the lateral penetration of the bit to the lateral force, positive from the high side to the right looking down the hole", at_least=-MOST_WALK, at_most=MOST_WALK, nominal=0.1, start=0.0, size="space", key="bit.walk_angle_deg", field="bit.walk_angle"),
    Quantity("rss_toolface", "input", "rad", "γ", "", "side to which the pads push, looking down the hole: 0 up or north, π/2 to the right", at_least=-2 * pi, at_most=2 * pi, size="space", start=0.0, key="rss.toolface_deg", field="schedule.rss_toolface"),
    Quantity("toolface_reference", "input", "", "", "", "from where the toolface counts: 0 from the high side, 1 from north, 2 from the frame of the bit", kind="Integer", size="space", at_least=0, at_most=2, start=0.0, key="rss.toolface_reference"),

    Quantity("bit_inclination", "output", "rad", "θ", "(17)", "inclination of the bit axis from the downward vertical", follows=("survey_file",)),
    Quantity("borehole_inclination", "output", "rad", "Θ", "(16)", "inclination of the borehole at the bit", follows=FORCE_AND_WEIGHT),
    Quantity("bit_tilt", "output", "rad", "ψ", "(10)", "bit inclination minus borehole inclination", nominal=0.01, follows=FORCE_AND_WEIGHT),
    Quantity("average_inclination", "output", "rad", "⟨Θ⟩_i", "(6)", "borehole inclination averaged between stabilizers i−1 and i", size="n", follows=("survey_file", "stabilizer_position")),
    Quantity("stabilizer_deflection", "output", "m", "δ_i", "(5)", "offset of the BHA from the borehole axis, positive to the high side", size="n-1", nominal=1e-3, follows=FORCE),
    Quantity("stabilizer_force", "output", "N", "F_ℓi − F_ui", "(7)", "force of the wall on the stabilizer, positive from the lower wall", size="n-1", nominal=1e4, follows=FORCE),
    Quantity("stabilizer_contact", "output", "", "", "(7)", "1 on the lower wall, −1 on the upper wall, 0 free", kind="Integer", size="n-1", at_least=-1, at_most=1, follows=FORCE),
    Quantity("bit_tilt_saturation", "output", "", "", "(11)", "1 at +ψ*, −1 at −ψ*, 0 between", kind="Integer", at_least=-1, at_most=1, follows=FORCE_AND_WEIGHT),
    Quantity("bit_lateral_force", "output", "N", "F_0", "(14)", "lateral force on the bit", nominal=1e4, follows=FORCE),
    Quantity("bit_moment", "output", "N.m", "M_0", "(9)", "moment on the bit", nominal=1e4, follows=FORCE),
    Quantity("borehole_curvature", "output", "rad/m", "Θ'", "", "change of borehole inclination over the last ℓ₁, per length", nominal=1e-3, follows=FORCE_AND_WEIGHT),
    Quantity("body_contact_force", "output", "N", "F_ℓ − F_u", "(7)", "largest force of the wall on the body between the stabilizers, positive from the lower wall", size="body", nominal=1e4, follows=FORCE),
    Quantity("body_contact_position", "output", "m", "s", "", "where that force acts, from the bit; 0 if the body touches no wall", size="body", at_least=0.0, nominal=10.0, follows=FORCE),
    Quantity("wall_distance", "output", "m", "", "", "least distance of the body from the wall", size="body", nominal=1e-2, follows=FORCE),
    Quantity("body_contact_force_high", "output", "N", "", "", "part of that force to the high side, in a nearly vertical hole to north", size="space body", nominal=1e4, follows=FORCE),
    Quantity("body_contact_force_right", "output", "N", "", "", "part of that force to the right of that, looking down the hole", size="space body", nominal=1e4, follows=FORCE),
    Quantity("bit_azimuth", "output", "rad", "", "", "azimuth of the bit axis, from north over east", size="space", follows=("survey_file",)),
    Quantity("borehole_azimuth", "output", "rad", "", "", "azimuth of the borehole at the bit, from north over east", size="space", follows=FORCE_AND_WEIGHT),
    Quantity("bit_tilt_high", "output", "rad", "ψ", "", "part of the bit tilt to the high side, in a nearly vertical hole to north", size="space", nominal=0.01, follows=FORCE_AND_WEIGHT),
    Quantity("bit_tilt_right", "output", "rad", "ψ", "", "part of the bit tilt to the right of that, looking down the hole", size="space", nominal=0.01, follows=FORCE_AND_WEIGHT),
    Quantity("bit_lateral_force_high", "output", "N", "F_0", "", "part of the lateral force on the bit to the high side, in a nearly vertical hole to north", size="space", nominal=1e4, follows=FORCE),
    Quantity("bit_lateral_force_right", "output", "N", "F_0", "", "part of the lateral force on the bit to the right of that, looking down the hole", size="space", nominal=1e4, follows=FORCE),
    Quantity("stabilizer_force_high", "output", "N", "F_i", "", "part of the force of the wall on the stabilizer to the high side, in a nearly vertical hole to north", size="space n-1", nominal=1e4, follows=FORCE),
    Quantity("stabilizer_force_right", "output", "N", "F_i", "", "part of the force of the wall on the stabilizer to the right of that, looking down the hole", size="space n-1", nominal=1e4, follows=FORCE),
    Quantity("stabilizer_deflection_high", "output", "m", "δ_i", "", "part of the offset of the BHA from the borehole axis to the high side, in a nearly vertical hole to north", size="space n-1", nominal=1e-3, follows=FORCE),
    Quantity("stabilizer_deflection_right", "output", "m", "δ_i", "", "part of the offset of the BHA from the borehole axis to the right of that, looking down the hole", size="space n-1", nominal=1e-3, follows=FORCE),
    Quantity("north", "output", "m", "", "", "position of the bit north of the start of the run", size="space", nominal=100.0),
    Quantity("east", "output", "m", "", "", "position of the bit east of the start of the run", size="space", nominal=100.0),
    Quantity("sensor_inclination", "output", "rad", "", "", "inclination of the BHA at the sensor; with an interval its last reading, with bias and noise", size="sensors", follows=(*FORCE, "sensor_position", *INSTRUMENT)),
    Quantity("sensor_bending_moment", "output", "N.m", "", "", "bending moment of the BHA at the sensor, positive as in a hole that builds; at the bit the moment on the bit", size="sensors", nominal=1e4, follows=(*FORCE, "sensor_position")),
    Quantity("sensor_clearance", "output", "m", "", "", "distance of the body at the sensor from the wall; negative beyond it", size="sensors", nominal=1e-2, follows=(*FORCE, "sensor_position", "sensor_body_clearance")),
    Quantity("sensor_azimuth", "output", "rad", "", "", "azimuth of the BHA at the sensor, from north over east; with an interval its last reading, with noise", size="space sensors", follows=(*FORCE, "sensor_position", *INSTRUMENT)),
    Quantity("sensor_bending_moment_high", "output", "N.m", "", "", "part of the bending moment at the sensor that bends the BHA to the high side, in a nearly vertical hole to north", size="space sensors", nominal=1e4, follows=(*FORCE, "sensor_position")),
    Quantity("sensor_bending_moment_right", "output", "N.m", "", "", "part of the bending moment at the sensor that bends the BHA to the right of that, looking down the hole", size="space sensors", nominal=1e4, follows=(*FORCE, "sensor_position")),
    Quantity("displacement", "output", "m", "x", "", "horizontal position of the bit from the start of the run", nominal=100.0),
    Quantity("true_vertical_depth", "output", "m", "z", "", "depth of the bit below the start of the run", nominal=100.0),
    Quantity("eta_pi", "output", "", "ηΠ", "(9)", "lateral penetration stiffness of the rock over the BHA's bending stiffness", nominal=0.01, follows=("active_weight_on_bit", "lateral_steering_resistance", "flexural_stiffness", "stabilizer_position")),

    Quantity("formation", "output", "", "", "", "number of the formation by true vertical depth in which the bit is, from the top; 0 above the first", kind="Integer", size="layered", at_least=0),

    Quantity("stabilizer_position", "parameter", "m", "s_i", "", "distance of the stabilizer from the bit; the last one is ideal", size="n", above=0.0, nominal=10.0, key="bha.stabilizer_positions", field="bha.stabilizer_positions"),
    Quantity("stabilizer_clearance", "parameter", "m", "y*_i", "(7)", "clearance between stabilizer and wall on each side", size="n-1", at_least=0.0, nominal=1e-3, tunable=True, key="bha.stabilizer_clearances", field="bha.stabilizer_clearances"),
    Quantity("rss_position", "parameter", "m", "Δ", "", "distance of the steering pads from the bit", at_least=0.0, key="bha.rss_position", field="bha.rss_position"),
    Quantity("distributed_weight", "parameter", "N/m", "w", "", "buoyant weight of the BHA per length", size="uniform", at_least=0.0, nominal=1e3, key="bha.distributed_weight", field="bha.distributed_weight"),
    Quantity("flexural_stiffness", "parameter", "N.m2", "EI", "", "bending stiffness of the BHA", size="uniform", above=0.0, nominal=1e7, key="bha.flexural_stiffness", field="bha.flexural_stiffness"),
    Quantity("section_length", "parameter", "m", "", "", "length of a section of the BHA, from the bit up", size="sections", above=0.0, nominal=10.0, key="section.length", field="bha.section_lengths"),
    Quantity("section_distributed_weight", "parameter", "N/m", "w", "", "buoyant weight of the section per length", size="sections", at_least=0.0, nominal=1e3, key="section.distributed_weight", field="bha.section_distributed_weights"),
    Quantity("section_flexural_stiffness", "parameter", "N.m2", "EI", "", "bending stiffness of the section", size="sections", above=0.0, nominal=1e7, key="section.flexural_stiffness", field="bha.section_flexural_stiffnesses"),
    Quantity("body_point_position", "parameter", "m", "s", "", "where the body between the stabilizers may touch the wall, from the bit", size="points", above=0.0, nominal=10.0, key="bha.body_point_positions", field="bha.body_point_positions"),
    Quantity("body_point_clearance", "parameter", "m", "y*", "(7)", "clearance between the body there and the wall on each side", size="points", above=0.0, nominal=1e-2, key="bha.body_point_clearances", field="bha.body_point_clearances"),
    Quantity("end_deflection", "parameter", "m", "δ_n", "(5)", "offset of the BHA from the borehole axis at the last stabilizer, positive to the high side", size="stepped", nominal=1e-2, key="bha.end_deflection", field="bha.end_deflection"),
    Quantity("sensor_position", "parameter", "m", "s", "", "distance of the sensor from the bit", size="sensors", at_least=0.0, nominal=10.0, key="sensor.position", field="bha.sensor_positions"),
    Quantity("sensor_interval", "parameter", "m", "", "", "drilled length from reading to reading of the inclination; 0: it is read all the time", size="sensors", at_least=0.0, nominal=10.0, key="sensor.interval", field="bha.sensor_intervals"),
    Quantity("sensor_bias", "parameter", "rad", "", "", "what is always added to a reading", size="sensors", at_least=-pi, at_most=pi, nominal=1e-3, key="sensor.bias_deg", field="bha.sensor_biases"),
    Quantity("sensor_noise", "parameter", "rad", "", "", "standard deviation of what is added to each reading", size="sensors", at_least=0.0, at_most=pi, nominal=1e-3, key="sensor.noise_deg", field="bha.sensor_noises"),
    Quantity("sensor_seed", "parameter", "", "", "", "which noise: the same seed gives the same readings again", kind="Integer", size="sensors", at_least=0, at_most=2**31 - 1, key="sensor.seed", field="bha.sensor_seeds"),
    Quantity("sensor_body_clearance", "parameter", "m", "", "", "clearance between the body at the sensor, where it is centred, and the wall on each side", size="sensors", at_least=0.0, nominal=1e-2, key="sensor.body_clearance", field="bha.sensor_body_clearances"),
    Quantity("relative_tolerance", "parameter", "", "", "", "local error allowed in one step of the integrator, relative to 1 rad and ℓ₁", at_least=1e-12, at_most=1e-2, nominal=1e-7, start=RELATIVE_TOLERANCE),
    Quantity("survey_file", "parameter", "", "", "", "survey of the existing hole, its last station is the bit (plain CSV: UTF-8, commas, decimal points, m, degrees); empty: the survey packed in the FMU", kind="String", start="", key="hole.survey"),

    Quantity("section_outer_diameter", "case", "m", "", "", "outer diameter of the section; 0: not given", size="sections", at_least=0.0, key="section.outer_diameter", field="bha.section_outer_diameters"),
    Quantity("mud_density", "case", "kg/m3", "", "", "density of the mud, for the buoyant weight of sections given by their diameters", at_least=0.0, key="bha.mud_density"),
    Quantity("body_contact", "case", "", "", "", "whether the body between the stabilizers may touch the wall", kind="Boolean", key="bha.body_contact"),
    Quantity("body_contact_spacing", "case", "m", "", "", "distance between the points of the body that may touch the wall", above=0.0, key="bha.body_contact_spacing"),
    Quantity("axial_load", "case", "", "N", "", "whether the load along the BHA counts in its bending", kind="Boolean", size="axial", key="bha.axial_load", field="bha.axial_load"),
    Quantity("bit_diameter", "case", "m", "", "", "diameter of the hole", above=0.0, at_most=1.5, key="bit.diameter", field="bit_diameter"),
    Quantity("length", "case", "m", "", "", "length to drill", above=0.0, key="drilling.length", field="length"),
    Quantity("measured_depth", "case", "m", "", "", "stations along the existing hole, the last one is the bit if bit_depth does not say where it is", size="column", key="hole.measured_depth", field="survey.measured_depth"),
    Quantity("inclination", "case", "rad", "Θ", "", "inclination of the existing hole at each station", at_least=-pi, at_most=pi, size="column", key="hole.inclination_deg", field="survey.inclination"),
    Quantity("azimuth", "case", "rad", "", "", "azimuth of the existing hole at each station, from north over east; one number: of all of it", at_least=-2 * pi, at_most=2 * pi, size="space column", key="hole.azimuth_deg", field="survey.azimuth"),
    Quantity("bit_depth", "case", "m", "", "", "measured depth of the bit at the start of the run; beyond the survey the hole is straight", nominal=1e3, key="hole.bit_depth"),
    Quantity("bit_true_vertical_depth", "case", "m", "", "", "true vertical depth of the bit at the start of the run, from which those of formations count", nominal=1e3, start=0.0, key="hole.true_vertical_depth", field="true_vertical_depth"),
    Quantity("schedule_depth", "case", "m", "", "", "measured depths at which the forces begin, in place of drilled lengths", size="column", nominal=1e3, key="rss.measured_depth"),
    Quantity("full_force", "case", "N", "", "", "force of the steering pads at a duty of 1", at_least=0.0, nominal=1e4, key="rss.full_force"),
    Quantity("duty", "case", "", "", "", "share of the time in which the pads push to the side of the toolface", size="column", at_least=0.0, at_most=1.0, key="rss.duty"),
    Quantity("dimensions", "case", "", "", "", "3: drill in space, which a case does anyway that has an azimuth, a walk angle, or a toolface other than 0 or 180°", kind="Integer", at_least=2, at_most=3, start=2, key="drilling.dimensions", field="dimensions"),
    Quantity("drilling_schedule", "case", "", "", "", "inputs over drilled length or measured depth (a CSV file, or columns in the case file)", kind="String", key="drilling.schedule"),
    Quantity("drilling_interpolation", "case", "", "", "", "how these inputs go from each entry to the next: held or linear", kind="String", start="held", key="drilling.interpolation"),
    Quantity("interpolation", "case", "", "", "", "how the force goes from each entry to the next: held or linear", kind="String", start="held", key="rss.interpolation", field="schedule.interpolation"),
    Quantity("schedule_file", "case", "", "", "", "steering force over drilled length or measured depth (CSV)", kind="String", key="rss.schedule"),
    Quantity("engine", "case", "", "", "", "which engine drilled the case, in the case file beside the run", kind="String", key="run.engine"),
    Quantity("study", "case", "", "", "", "what a study computed and which parameters it varied, in the case file beside its results", kind="String", key="run.study"),
    Quantity("stopped", "case", "", "", "", "why the run ended before the length of the case, in the case file beside the run", kind="String", key="run.stopped"),
)  # fmt: skip

BY_NAME = {quantity.name: quantity for quantity in QUANTITIES}
INPUTS = tuple(quantity for quantity in QUANTITIES if quantity.role == "input")
OUTPUTS = tuple(quantity for quantity in QUANTITIES if quantity.role == "output")
PARAMETERS = tuple(quantity for quantity in QUANTITIES if quantity.role == "parameter")
ACTING = tuple(name for q in INPUTS if q.acts for name in ((q.name, f"{q.name}_slope") if q.slope else (q.name,)))
"""What an engine is given for a leg: the inputs where it starts, and the changes per metre of those that may change."""
SLOPES = tuple(f"{q.name}_slope" for q in INPUTS if q.slope)
"""The changes per metre that an engine is given."""
IN_SPACE_ONLY = tuple(q.name for q in INPUTS if q.size == "space")
"""The inputs that count only where the hole may leave its vertical plane."""
ROCK = tuple(q.name for q in INPUTS if q.part == "bit" and q.name not in IN_SPACE_ONLY)
"""The inputs that say what bit and rock are like."""
CLEARANCES = tuple(f"stabilizer_clearance[{i}]" for i in range(1, MAX_STABILIZERS))
"""The clearances that a schedule may change, of as many stabilizers as there may be."""
VARIABLES = INPUTS + OUTPUTS + PARAMETERS  # what an FMU has


def scalar_names(quantities: tuple[Quantity, ...], structure: int | Structure) -> list[str]:
    """The scalar names of `quantities`, in the order of the table; the structure is as in `Quantity.names`."""
    return list(_scalar_names(quantities, structure))


@cache
def _scalar_names(quantities: tuple[Quantity, ...], structure: int | Structure) -> tuple[str, ...]:
    return tuple(name for quantity in quantities for name in quantity.names(structure))


def names_of_runs(n: int) -> list[str]:
    """The scalar names of all inputs and outputs that a run with `n` stabilizers may have, whatever its beam."""
    made = Structure(n, axial_load=1, body_points=1, layered=1, sensors=MAX_SENSORS, space=1)
    return scalar_names(INPUTS + OUTPUTS, made)


def quantity_of(scalar_name: str) -> Quantity:
    """The quantity that a scalar name, ``name`` or ``name[i]``, is a value of; `KeyError` if there is none."""
    return BY_NAME[scalar_name.partition("[")[0]]


def followed(quantity: Quantity, structure: int | Structure) -> frozenset[str]:
    """The inputs and parameters that an output follows at once in a BHA of this structure.

    A weight on bit of 0 stands for the active weight, which then loads the BHA along its axis.
    """
    names = frozenset(quantity.follows)
    if isinstance(structure, Structure) and structure.axial_load and "weight_on_bit" in names:
        names |= {"active_weight_on_bit"}
    return names


def columns_of(table: str) -> tuple[str, ...]:
    """The columns, as people name them, of "hole" or "rss": tables of a case file that may be CSV files of their own.

    Without those that only count in space, which may be left out.
    """
    columns = (quantity for quantity in QUANTITIES if quantity.key and quantity.part and "space" not in quantity.size)
    keys = (quantity.key.split(".") for quantity in columns)
    return tuple(key for place, key in keys if place == table)


# A part of a drilling system is a dataclass, say `BottomHoleAssembly`, whose fields the table names.


def values_of(part: str, fields: Any) -> dict[str, float]:
    """The inputs and parameters in a part of a drilling system, by scalar name; a column is represented by its first value, an empty one left out.

    Parameters
    ----------
    part
        Its name in the table: "bha", "bit", …; empty for the case itself.
    fields
        The part.
    """
    values: dict[str, float] = {}
    for attribute, quantity in _given_in(part).items():
        value = getattr(fields, attribute)
        if quantity.is_list:
            values |= {f"{quantity.name}[{i}]": element for i, element in enumerate(value, 1)}
        elif not isinstance(value, tuple):
            values[quantity.name] = value
        elif value:
            values[quantity.name] = value[0]
    return values


@cache
def _given_in(part: str) -> dict[str, Quantity]:
    """The inputs and parameters that a part of a drilling system holds, by their names there."""
    return {
        quantity.attribute: quantity for quantity in INPUTS + PARAMETERS if quantity.field and quantity.part == part
    }


def fields_of(part: str, values: Mapping[str, float], structure: int | Structure) -> dict[str, Any]:
    """The fields of a part of a drilling system of this structure, from values as `values_of` gives them."""
    fields: dict[str, Any] = {}
    for attribute, quantity in _given_in(part).items():
        if quantity.is_list or quantity.count(structure):
            elements = tuple(values[name] for name in quantity.names(structure))
            fields[attribute] = elements if quantity.is_list else elements[0]
    return fields

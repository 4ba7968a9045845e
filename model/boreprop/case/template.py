"""The text of a case file from what an engineer knows of an assembly, a bit and a hole."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan, ceil, degrees

from ..core.quantities import MAX_POINTS
from .body import FURTHER_UP, LONG_SPAN, PARTS_OF_FIRST_SPAN
from .collar import STEEL_DENSITY, YOUNGS_MODULUS, buoyant_weight, flexural_stiffness

SECTION = 3  # values of a section: length, outer and inner diameter
ANGULAR_OVER_LATERAL = 0.05  # χ/η; the paper: χ is one or two orders of magnitude smaller than η


@dataclass(frozen=True)
class Answer:
    """What was answered to a question.

    Parameters
    ----------
    values
        The amounts, in the unit of the question.
    text
        The answer in its own words.
    """

    values: tuple[float, ...]
    text: str

    @property
    def value(self) -> float:
        """The only amount."""
        (value,) = self.values
        return value


def clearances(answers: Mapping[str, Answer]) -> tuple[float, ...]:
    """The clearance on each side, m, of every stabilizer but the last: half of what it lacks on its diameter."""
    count = len(answers["stabilizers"].values) - 1
    lacking = answers["under_gauge"].values if count else ()
    return tuple(amount / 2 for amount in (lacking * count if len(lacking) == 1 else lacking))


def tilt_limit(answers: Mapping[str, Answer]) -> float:
    """ψ*, rad: the tilt at which the end of the bit's gauge meets the wall of a hole of the bit's size."""
    return atan(answers["gauge_relief"].value / 2 / answers["gauge_length"].value)


def sections(answers: Mapping[str, Answer]) -> list[tuple[float, ...]]:
    """Length, outer and inner diameter of each section, m, from the bit up; none of a BHA of one collar."""
    values = answers["sections"].values if "sections" in answers else ()
    return [values[k : k + SECTION] for k in range(0, len(values), SECTION)]


def template(answers: Mapping[str, Answer]) -> str:
    """The text of a case file, in SI units; its comments say what was answered and how each number follows.

    Parameters
    ----------
    answers
        The answer to each of the questions of ``boreprop new``, by its name, such as ``hole_size``; lengths in m,
        forces in N, densities in kg/m³, angles in degrees, shares as fractions. With `sections`, whose values are those
        of one after the other, there are no `collar_outer` and `collar_inner`.

    Raises
    ------
    KeyError
        If an answer is missing.
    """
    given = {name: answer.text for name, answer in answers.items()}
    value = {name: answer.values[0] for name, answer in answers.items()}
    stepped = sections(answers)
    beam, stiffness = _sections(answers, stepped) if stepped else _collar(answers)
    positions = answers["stabilizers"].values
    eta = 1 / value["steerability"]
    active = value["weight_on_bit"] * (1 - value["bluntness"])
    eta_pi = eta * active * positions[0] ** 2 / (3 * stiffness)
    depth, reach = value["measured_depth"], positions[-1]
    stations = (depth - reach, depth) if depth > reach else (0.0, depth) if depth > 0 else (depth,)
    straight = "straight along the BHA" if depth > reach else "shorter than the BHA: extended straight"
    under = f"half of {given['under_gauge']} under gauge on diameter" if len(positions) > 1 else "none is needed"
    whole = f"weight_on_bit        = {_number(value['weight_on_bit'])}  # N, all of it\n" if stepped else ""
    return f"""\
# Written by `boreprop new`. A comment says what was answered, and how the number follows from it.

[bha]
# m from the bit: {given["stabilizers"]}; the last one is taken to be centred
stabilizer_positions  = {_list(positions)}
# m each side, one for each but the last: {under}
stabilizer_clearances = {_list(clearances(answers))}
rss_position          = {_number(value["rss_position"])}  # m from the bit: {given["rss_position"]}
{beam}
[bit]
# η: 1 / steerability of {given["steerability"]}; 5 to 100 in the paper
lateral_steering_resistance = {_number(eta)}
# χ: {ANGULAR_OVER_LATERAL:g} η; one or two orders of magnitude below η in the paper
angular_steering_resistance = {_number(ANGULAR_OVER_LATERAL * eta)}
# ψ*, where the gauge meets the wall: atan(relief / 2 / length); about 1° or less in the paper
# relief of {given["gauge_relief"]} on diameter, length of {given["gauge_length"]}
tilt_limit_deg              = {_number(degrees(tilt_limit(answers)))}
diameter                    = {_number(value["hole_size"])}  # m, the hole: {given["hole_size"]}

[drilling]
# Of {given["weight_on_bit"]} on the bit, bluntness takes {given["bluntness"]}, which does not drill
active_weight_on_bit = {_number(active)}  # N, here ηΠ = {eta_pi:.3g}
{whole}length               = {_number(value["length"])}  # m to drill: {given["length"]}

[hole]  # the last station is the bit; {straight}
measured_depth  = {_list(stations)}  # m; the bit: {given["measured_depth"]}
inclination_deg = {_list((value["inclination"],) * len(stations))}  # °: {given["inclination"]}

[rss]  # held from each drilled length to the next; further entries may follow
drilled_length = [0.0]  # m
force          = [{_number(value["rss_force"])}]  # N, positive builds: {given["rss_force"]}
"""


def _collar(answers: Mapping[str, Answer]) -> tuple[str, float]:
    """The keys of a BHA of one collar, and its stiffness."""
    outer, inner, mud = (answers[name].value for name in ("collar_outer", "collar_inner", "mud_weight"))
    stiffness, weight = flexural_stiffness(outer, inner), buoyant_weight(outer, inner, mud)
    return (
        f"""\
# One steel collar stands for the whole BHA: D = {answers["collar_outer"].text}, d = {answers["collar_inner"].text}
# in mud of {answers["mud_weight"].text}
distributed_weight    = {_number(weight)}  # N/m: π/4 (D² − d²) · ({STEEL_DENSITY:g} − {mud:.5g}) kg/m³ · g
flexural_stiffness    = {_number(stiffness)}  # N m²: E π/64 (D⁴ − d⁴) with E = {YOUNGS_MODULUS / 1e9:g} GPa
""",
        stiffness,
    )


def _sections(answers: Mapping[str, Answer], stepped: list[tuple[float, ...]]) -> tuple[str, float]:
    """The keys of a BHA in sections, and the stiffness of that at the bit."""
    tables = (
        f"""
[[bha.section]]  # from the bit up, of steel: {text.strip()}
length         = {_number(length)}  # m
outer_diameter = {_number(outer)}  # m
inner_diameter = {_number(inner)}  # m
"""
        for (length, outer, inner), text in zip(stepped, answers["sections"].text.split(";"), strict=True)
    )
    mud = answers["mud_weight"]
    return (
        f"""\
mud_density           = {_number(mud.value)}  # kg/m³: {mud.text}
axial_load            = true  # the weight on bit, and that of the BHA, count in its bending
{_body_contact(answers["stabilizers"].values, len(stepped))}  # the body of the BHA may lie on the wall
{"".join(tables)}""",
        flexural_stiffness(*stepped[0][1:]),
    )


def _body_contact(stabilizers: tuple[float, ...], steps: int) -> str:
    """The key that lets the body touch the wall: with the usual points, or with fewer where these would be too many."""
    fine = stabilizers[min(stabilizers[0] < LONG_SPAN, len(stabilizers) - 1)]
    usual = PARTS_OF_FIRST_SPAN * (1 + (stabilizers[0] < LONG_SPAN)) + (stabilizers[-1] - fine) / FURTHER_UP
    if usual + len(stabilizers) + steps < MAX_POINTS:
        return "body_contact          = true"
    return (
        f"body_contact_spacing  = {_number(ceil(10 * stabilizers[-1] / (MAX_POINTS - len(stabilizers) - steps)) / 10)}"
    )


def _number(value: float) -> str:
    """A number as TOML spells it, without the digits that converting units left."""
    return repr(float(f"{value:.9g}"))


def _list(values: tuple[float, ...]) -> str:
    return f"[{', '.join(map(_number, values))}]"

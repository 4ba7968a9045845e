"""What can be wrong: every code with its sentence, the same for both engines and for both flavours of the FMU.

The C sources have codes and sentences from a header that is written from this file.
"""

from dataclasses import dataclass
from math import nan

from .quantities import QUANTITIES

F_STAR = "(3 flexural_stiffness / stabilizer_position[1]^2)"
LENGTH_SCALE = "stabilizer_position[1]"
DERIVED = {
    "scaled_force": f"rss_force / {F_STAR}",
    "scaled_slope": f"rss_force_slope / {F_STAR}",
    "eta_pi_change": f"change of eta_pi over {LENGTH_SCALE}",
    "chi_pi_change": f"change of eta_pi angular_steering_resistance / lateral_steering_resistance over {LENGTH_SCALE}",
    "psi_star_change": f"change of bit_tilt_limit over {LENGTH_SCALE}",
    "inverse_eta_pi": "1 / eta_pi",
    "force_scale": F_STAR.strip("()"),
    "scaled_reach": "stabilizer_position[n] / stabilizer_position[1]",
    "scaled_weight": f"distributed_weight stabilizer_position[1] / {F_STAR}",
    "epsilon": "angular_steering_resistance / lateral_steering_resistance",
    "inverse_epsilon": "lateral_steering_resistance / angular_steering_resistance",
    "station_rate": "stabilizer_position[1] / distance between stations of the survey",
}
"""What is made of quantities of the table, and how messages name it: by what a user has given."""

ANGLES = frozenset(quantity.name for quantity in QUANTITIES if quantity.unit == "rad")
"""What a message gives in rad and says so, since people think of angles in degrees."""

CONSTRAINTS = {
    "not a number": ("must be a finite number", "{value}"),
    "not above": ("must be > {limit}{unit}", "{value}"),
    "too small": ("must be >= {limit}{unit}", "{value}"),
    "too large": ("must be <= {limit}{unit}", "{value}"),
    "not increasing": ("must increase", "({before}, {value})"),
    "too close": ("must be at least {limit} m from each other and from the bit", "({before}, {value})"),
    "wrong count": ("must hold 1 to {limit} values", "{count}"),
    "out of reach": ("must reach the last stabilizer, {limit} m from the bit, together", "{value}"),
    "buckles": ("must be < {limit}, where the BHA buckles between its stabilizers", "{value}"),
    "buckles in space": (
        "must be < {limit} in space, where no wall holds the BHA sideways between bit and last stabilizer, so that it "
        "buckles; put the last stabilizer nearer to the bit, or take stiffer sections",
        "{value}",
    ),
    "no station": ("must hold at least one station", "()"),
    "no start": ("must give a finite state where the run starts", "{value}"),
    "no state": ("must be a valid saved state of this system", "{count} numbers that are not"),
}
"""Constraints on given values, by code: the constraint, and what there is instead."""

OBSTACLES = {
    "not finite": ("the state is not finite at {place} m", "check inputs and parameters"),
    "turns over": (
        "the bit turns over at {place} m",
        "its inclination grows beyond a full turn; use a smaller or shorter rss_force, a larger active_weight_on_bit, "
        "or check the parameters",
    ),
    "too short": (
        "the steps of the integrator become too short at {place} m",
        "raise relative_tolerance (--tolerance), now {limit}",
    ),
    "no mode": ("no contacts are found that hold at {place} m", "change relative_tolerance (--tolerance), now {limit}"),
    "snaps": (
        "at {place} m the BHA comes free of the wall at a stabilizer without which it buckles: it would bear {limit} N",
        "use a smaller weight_on_bit",
    ),
    "too crowded": (
        "more than {limit} supports touch the wall, or are near it, at {place} m",
        "put fewer points on the body (bha.body_contact_spacing)",
    ),
    "too many": (
        "from {place} m on, more than {limit} steps of the integrator would be needed in one call",
        "drill to a nearer length, change inputs less often, or raise relative_tolerance (--tolerance)",
    ),
    "worn out": (
        "from {place} m on the flats of the worn bit bear all of the active weight on bit",
        "raise active_weight_on_bit, or lower bit.wear.largest_weight",
    ),
    "no memory": (
        "there is too little memory for the hole behind the bit, at most {limit} pieces",
        "give a survey with fewer stations, or change inputs less often",
    ),
}
"""What may stop an engine on its way, by code: what it is, and what helps."""

OUTSIDE = (
    "{position} behind the bit the axis of the BHA is {offset} {side} that of the hole{when}, "
    "{beyond} beyond its wall: its body would lie on the wall, which the model leaves out, "
    "so forces and build rates are not to be trusted"
)
"""Where the model ends: a warning. Lengths come with their units, in those of the reader."""

SENTENCES = {code: f"{{name}}: {constraint}, got {got}" for code, (constraint, got) in CONSTRAINTS.items()} | {
    code: f"{met}: {helps}" for code, (met, helps) in OBSTACLES.items()
}


@dataclass(frozen=True)
class Problem:
    """What is wrong: all that its sentence is made of. NaN stands for a number that it does not have.

    Parameters
    ----------
    code
        A key of `CONSTRAINTS` or `OBSTACLES`.
    quantity
        What has the wrong value; empty for an obstacle.
    index
        Which of several values, counted from 1; 0 for a single value.
    value, before
        The wrong value, and the value before it in a list that must increase.
    limit
        What the value, the number of steps or that of pieces must keep to; for other obstacles the tolerance.
    place
        Where the bit was when an engine met it, m from the start of the run.
    """

    code: str
    quantity: str = ""
    index: int = 0
    value: float = nan
    before: float = nan
    limit: float = nan
    place: float = nan

    @property
    def name(self) -> str:
        """The scalar name of the value."""
        return f"{self.quantity}[{self.index}]" if self.index else self.quantity

    def tell(self, template: str) -> str:
        """A template with the numbers put in."""
        return template.format(
            name=self.name,
            value=repr(self.value),
            before=repr(self.before),
            count=f"{self.value:g}",
            limit=f"{self.limit:g}",
            unit=" rad" if self.quantity in ANGLES else "",
            place=f"{self.place:.9g}",
        )

    @property
    def sentence(self) -> str:
        """What is wrong, in one line."""
        return self.tell(SENTENCES[self.code])

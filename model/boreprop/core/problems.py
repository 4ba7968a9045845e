"""What can be wrong: every code with its sentence, the same for both engines and for both flavours of the FMU.

The engine in C has the codes, and the FMU in C the sentences too, from a header that is written from this file.
"""

from dataclasses import dataclass
from math import nan

CONSTRAINTS = {
    "not a number": ("must be a finite number", "{value}"),
    "not above": ("must be > {limit}", "{value}"),
    "too small": ("must be >= {limit}", "{value}"),
    "too large": ("must be <= {limit}", "{value}"),
    "not increasing": ("must increase", "({before}, {value})"),
    "too close": ("must be at least {limit} m from each other and from the bit", "({before}, {value})"),
    "wrong count": ("must hold 1 to {limit} positions", "{count}"),
    "no station": ("must hold at least one station", "()"),
    "no start": ("must give a finite state where the run starts", "{value}"),
    "no state": ("must be a valid saved state of this system", "{count} numbers that are not"),
}
"""What a given value breaks, by code: the constraint, and what there is instead."""

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
    "no mode": ("no contact mode holds at {place} m", "change relative_tolerance (--tolerance), now {limit}"),
    "too many": ("step", "must take at most {limit} steps of the integrator, got more"),
    "no memory": ("memory", "must hold the hole behind the bit, in at most {limit} pieces, got too little"),
}
"""What an engine meets on its way, by code: what it is, and what helps."""

SENTENCES = {code: f"{{name}}: {constraint}, got {got}" for code, (constraint, got) in CONSTRAINTS.items()} | {
    code: f"{met}: {helps}" for code, (met, helps) in OBSTACLES.items()
}


@dataclass(frozen=True)
class Problem:
    """What is wrong: all that its sentence is made of. NaN stands for what it has not.

    Parameters
    ----------
    code
        A key of `CONSTRAINTS` or `OBSTACLES`.
    quantity
        What has the wrong value; empty for an obstacle.
    index
        Which of several values, from 1 on; 0 where there is one.
    value, before
        The wrong value, and of a list that must increase the one before it.
    limit
        What the value, or the number of steps, must keep to; of other obstacles the tolerance.
    place
        Where an engine has met it, m from the start of the run.
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
            place=f"{self.place:.9g}",
        )

    @property
    def sentence(self) -> str:
        """What is wrong, in one line."""
        return self.tell(SENTENCES[self.code])

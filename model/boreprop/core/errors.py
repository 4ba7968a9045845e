"""What goes wrong in a way that a user can do something about: what travels with the core."""

from math import nan


class BorepropError(Exception):
    """The base of the errors of this package. The message is one line."""


class ParameterError(BorepropError, ValueError):
    """A parameter breaks a constraint. Carries ``name``, ``constraint`` and ``value``."""

    def __init__(self, name: str, constraint: str, value: object) -> None:
        super().__init__(f"{name}: {constraint}, got {value!r}")
        self.name, self.constraint, self.value = name, constraint, value


class TableError(BorepropError, ValueError):
    """A table file cannot be read. The message names the file, the line, the constraint and the value."""


class CannotContinue(BorepropError):
    """An engine cannot drill on. Nothing has changed then: the bit is where it was, under the inputs it had.

    Attributes
    ----------
    code
        What it has met: a key of `OBSTACLES`, or "" where the engine gives a line only.
    place
        Where, m from the start of the run; nan where the engine gives a line only.
    helps
        What a user can do about it.
    """

    def __init__(self, line: str, code: str = "", place: float = nan, helps: str = "") -> None:
        super().__init__(line, code, place, helps)
        self.code, self.place, self.helps = code, place, helps

    def __str__(self) -> str:
        return str(self.args[0])

    @classmethod
    def because(cls, code: str, place: float, limit: float) -> "CannotContinue":
        """The error for an obstacle met at `place`, m; `limit` is the tolerance, or the number of steps, at hand."""
        met, helps = OBSTACLES[code]
        helps = helps.format(limit=limit)
        return cls(f"{met.format(place=place, limit=limit)}: {helps}", code, place, helps)


OBSTACLES = {
    "not finite": ("the state is not finite at {place:.9g} m", "check inputs and parameters"),
    "turns over": (
        "the bit turns over at {place:.9g} m",
        "its inclination grows beyond a full turn; use a smaller or shorter rss_force, a larger active_weight_on_bit, "
        "or check the parameters",
    ),
    "too short": (
        "the steps of the integrator become too short at {place:.9g} m",
        "raise relative_tolerance (--tolerance), now {limit:g}",
    ),
    "no mode": (
        "no contact mode holds at {place:.9g} m",
        "change relative_tolerance (--tolerance), now {limit:g}",
    ),
    "too many": ("step", "must take at most {limit:.0f} steps of the integrator, got more"),
}

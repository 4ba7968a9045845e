"""A case: what is drilled, with what, from where, under which steering force."""

from dataclasses import dataclass

from ..core.checks import check_increasing, check_number
from ..core.errors import ParameterError
from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly, eta_pi

SAMPLE_INTERVAL = 0.1  # m between the rows of a run, unless told otherwise: some 50 for each wave of a rippling hole


@dataclass(frozen=True)
class Schedule:
    """The force of the steering pads over the drilled length.

    Parameters
    ----------
    drilled_length
        m from the start of the run: 0, then increasing.
    rss_force
        N, held from each length to the next, the last one to the end. Positive builds.

    Raises
    ------
    ParameterError
        If a value breaks one of these constraints.
    """

    drilled_length: tuple[float, ...] = (0.0,)
    rss_force: tuple[float, ...] = (0.0,)

    def __post_init__(self) -> None:
        if not self.drilled_length or self.drilled_length[0] != 0.0:
            raise ParameterError("drilled_length", "must start at 0", self.drilled_length)
        check_increasing("drilled_length", self.drilled_length)
        if len(self.rss_force) != len(self.drilled_length):
            constraint = f"must hold one value per drilled_length, here {len(self.drilled_length)}"
            raise ParameterError("rss_force", constraint, self.rss_force)
        for force in self.rss_force:
            check_number("rss_force", force)


@dataclass(frozen=True)
class Case:
    """One run: the drilling system, the existing hole and the steering force.

    Parameters
    ----------
    bha, bit
        The drilling system.
    bit_diameter
        m, for drawing the hole; no part of the physics.
    active_weight_on_bit
        N.
    length
        Length to drill, m.
    survey
        The existing hole.
    schedule
        The steering force.

    Raises
    ------
    ParameterError
        If one of the three numbers is not positive.
    """

    bha: BottomHoleAssembly
    bit: BitRock
    bit_diameter: float
    active_weight_on_bit: float
    length: float
    survey: Survey
    schedule: Schedule = Schedule()

    def __post_init__(self) -> None:
        for name in ("bit_diameter", "active_weight_on_bit", "length"):
            check_number(name, getattr(self, name), above=0.0)

    @property
    def eta_pi(self) -> float:
        """ηΠ, the active weight on bit in the group that the stability of the hole depends on, (3) and (9)."""
        return eta_pi(self.bha, self.bit, self.active_weight_on_bit)

    @property
    def length_scale(self) -> float:
        """ℓ₁, from the bit to the first stabilizer, m."""
        return self.bha.length_scale

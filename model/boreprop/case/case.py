"""A case: the drilling system, the existing hole, the active weight on bit, the steering force and the length."""

from dataclasses import dataclass
from itertools import repeat

from ..core.checks import check_increasing, check_number, check_part, checked_float
from ..core.errors import ParameterError
from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly, eta_pi


@dataclass(frozen=True)
class Schedule:
    """The force of the steering pads over the drilled length, constant from each entry to the next.

    Parameters
    ----------
    drilled_length
        Lengths from the start of the run at which an entry begins, m, shape (k,). The first is 0, and they increase.
    rss_force
        The force from each of these lengths to the next, N, shape (k,); the last one acts to the end of the run. A
        positive force builds inclination.

    Raises
    ------
    ParameterError
        If a value is not finite, the lengths do not start at 0 or do not increase, or the two shapes differ.

    Examples
    --------
    >>> from boreprop import Schedule
    >>> Schedule(drilled_length=(0.0, 50.0), rss_force=(0.0, 8e3)).rss_force[1]
    8000.0
    """

    drilled_length: tuple[float, ...] = (0.0,)
    rss_force: tuple[float, ...] = (0.0,)

    def __post_init__(self) -> None:
        for name in ("drilled_length", "rss_force"):
            object.__setattr__(self, name, tuple(map(checked_float, repeat(name), getattr(self, name))))
        if not self.drilled_length or self.drilled_length[0] != 0.0:
            raise ParameterError("drilled_length", "must start at 0", self.drilled_length)
        check_increasing("drilled_length", self.drilled_length)
        if len(self.rss_force) != len(self.drilled_length):
            constraint = f"must hold one value per drilled_length, {len(self.drilled_length)} in all"
            raise ParameterError("rss_force", constraint, self.rss_force)
        check_part("schedule", self)


@dataclass(frozen=True)
class Case:
    """What is drilled: the drilling system, the existing hole, active weight on bit, steering force and length.

    Parameters
    ----------
    bha
        The bottom-hole assembly.
    bit
        The law of bit and rock.
    bit_diameter
        Diameter of the hole, m. It is used for drawing only and does not enter the physics.
    active_weight_on_bit
        The part of the weight on bit that drills, Π F* in the paper, N.
    length
        Length to drill, m.
    survey
        The existing hole. Its last station is the bit at the start of the run.
    schedule
        The steering force over the drilled length; without it there is none.
    weight_on_bit
        All of the weight on bit, N, which presses a BHA with `axial_load`; 0: it is the active weight on bit.

    Raises
    ------
    ParameterError
        If the diameter, the weight or the length is not finite and positive, or the diameter is beyond 1.5 m.

    Examples
    --------
    >>> from boreprop import paper_case
    >>> case = paper_case()
    >>> round(case.eta_pi, 4), case.length_scale
    (0.01, 3.66)
    """

    bha: BottomHoleAssembly
    bit: BitRock
    bit_diameter: float
    active_weight_on_bit: float
    length: float
    survey: Survey
    schedule: Schedule = Schedule()
    weight_on_bit: float = 0.0

    def __post_init__(self) -> None:
        check_part("", self)
        if self.weight_on_bit:
            check_number("weight_on_bit", self.weight_on_bit, at_least=self.active_weight_on_bit)

    @property
    def length_scale(self) -> float:
        """ℓ₁, m: the distance from the bit to the first stabilizer."""
        return self.bha.length_scale

    @property
    def eta_pi(self) -> float:
        """ηΠ: the stiffness of the rock over that of the BHA, dimensionless, eq. (9)."""
        return eta_pi(self.bha, self.bit, self.active_weight_on_bit)

"""A case: the drilling system, the existing hole, the active weight on bit, the steering force and the length."""

from bisect import bisect_right
from dataclasses import dataclass
from itertools import repeat

from ..core.checks import check_increasing, check_part, checked_float
from ..core.errors import ParameterError
from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly, eta_pi

CLOSE = 0.005  # m: depths are given to the centimetre, so a first entry this little beyond the bit is at it


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

    @classmethod
    def by_depth(cls, measured_depth: tuple[float, ...], rss_force: tuple[float, ...], bit_depth: float) -> "Schedule":
        """A schedule whose entries begin at measured depths.

        Parameters
        ----------
        measured_depth
            Depths at which an entry begins, m, increasing, shape (k,). The last one at or before the bit acts from the
            start of the run; those before it are left out.
        rss_force
            The force from each of these depths to the next, N, shape (k,).
        bit_depth
            Measured depth of the bit at the start of the run, m: that of the last station of a `Survey`.

        Returns
        -------
        Schedule
            The same forces over the drilled length.

        Raises
        ------
        ParameterError
            If the first entry lies beyond the bit, for then no force is given at the start; or as for any schedule.

        Examples
        --------
        >>> from boreprop import Schedule
        >>> Schedule.by_depth((2500.0, 2590.0, 2600.0), (0.0, 8e3, 4e3), bit_depth=2594.0)
        Schedule(drilled_length=(0.0, 6.0), rss_force=(8000.0, 4000.0))
        """
        check_increasing("measured_depth", measured_depth)
        if not measured_depth or measured_depth[0] > bit_depth + CLOSE:
            constraint = f"must start at {bit_depth:.9g} or before, where the bit starts"
            raise ParameterError("measured_depth", constraint, measured_depth)
        if len(rss_force) != len(measured_depth):
            constraint = f"must hold one value per measured_depth, {len(measured_depth)} in all"
            raise ParameterError("rss_force", constraint, rss_force)
        first = max(bisect_right(measured_depth, bit_depth) - 1, 0)
        later = (depth - bit_depth for depth in measured_depth[first + 1 :])
        return cls((0.0, *later), rss_force[first:])


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

    def __post_init__(self) -> None:
        check_part("", self)

    @property
    def length_scale(self) -> float:
        """ℓ₁, m: the distance from the bit to the first stabilizer."""
        return self.bha.length_scale

    @property
    def eta_pi(self) -> float:
        """ηΠ: the stiffness of the rock over that of the BHA, dimensionless, eq. (9)."""
        return eta_pi(self.bha, self.bit, self.active_weight_on_bit)

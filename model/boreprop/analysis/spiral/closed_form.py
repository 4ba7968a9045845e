"""The spiral into which a case may drill a vertical hole, in closed form, and where it ends.

In space the ripple of a plane is not stable: such a hole winds around, in a spiral of constant pitch and radius. That
is a steady state in a frame that turns, so it follows from a few equations, see `turning`. The hole is vertical,
whatever the hole of the case, and no force steers.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import exp, inf, isfinite, log, nan, pi
from typing import NamedTuple

from ...arrays import Floats
from ...case.case import Case
from ...core.checks import check_number
from ...core.errors import ParameterError
from ...errors import SpiralNotFound
from ..rippling import longest_wave
from ..stability.roots import NEUTRAL, SMALLEST_ETA_PI, CriticalEtaPi
from .branch import Condition, at_limit, beginning, follow, keep, meet
from .stability import roots
from .straight import critical, rightmost
from .turning import GAP, LOG_ETA_PI, MU, OMEGA, Turning, beam_of, theta, tilt, y_star_of

HANDS = ("right", "left")
WIDEST = 100.0  # gap: stabilizers that may move so far, compared with the inclination, touch no wall
LESS = 8.0  # by which ηΠ is divided in search of one at which there is a spiral, so many times:
MOST_DIVISIONS = 3


@dataclass(frozen=True)
class Winding:
    """A hole that winds around the vertical at a constant rate.

    Parameters
    ----------
    pitch
        Drilled length of a turn, m.
    radius
        Of the hole's axis, m.
    hole_inclination, bit_inclination
        Of the hole and of the bit's axis, rad.
    bit_tilt
        The angle between these two, rad.
    stabilizer_force
        The force of the wall on each non-ideal stabilizer, N; 0 where it does not touch.
    bit_lateral_force
        The lateral force on the bit, N.
    growth
        Of the disturbance that grows fastest, or dies out most slowly, per metre drilled.
    stable
        Whether all small disturbances die out.
    """

    pitch: float
    radius: float
    hole_inclination: float
    bit_inclination: float
    bit_tilt: float
    stabilizer_force: tuple[float, ...]
    bit_lateral_force: float
    growth: float
    stable: bool


@dataclass(frozen=True)
class Spiral(Winding):
    """The spiral of a case in a vertical hole, to one side; where there is none, its numbers are nan.

    Parameters
    ----------
    handedness
        "right", "left", or "either" if the bit does not walk: then the spirals are mirror images.
    edge
        The small spiral, unstable, between a straight hole and this one: a disturbance must be about as large to lead
        to it. None if there is none.
    least_tilt_limit
        Below this ψ* there is no spiral, rad; nan if there is none at this weight and walk.
    widest_clearance
        Above this clearance of the stabilizer with the largest one there is no spiral, m, the others in proportion; nan
        as above, inf if no stabilizer has a clearance.
    least_eta_pi, largest_eta_pi
        The ηΠ between which there is a spiral with these clearances and tilt limit, nan if there is none. A least one
        of 0 means that there is one at 1e-4, the smallest that is tried.
    critical
        The ηΠ below which a small spiral grows about a straight hole with all stabilizers on the wall, and the pitch of
        that. None if there is none.
    straight_growth
        The growth of such a small spiral at the case's ηΠ, the fastest one, per metre drilled.
    """

    handedness: str
    edge: Winding | None
    least_tilt_limit: float
    widest_clearance: float
    least_eta_pi: float
    largest_eta_pi: float
    critical: CriticalEtaPi | None
    straight_growth: float

    @property
    def exists(self) -> bool:
        """Whether there is one."""
        return isfinite(self.pitch)


NOWHERE = Winding(nan, nan, nan, nan, nan, (), nan, nan, False)


class Found(NamedTuple):
    """The spirals of one curve, from a gap of zero to its edge."""

    own: Floats | None  # with the clearances and the tilt limit of the case
    edge: Floats | None
    least_ratio: float  # of tilt and gap, along the curve; nan if there is none


def spiral(case: Case, handedness: str | None = None) -> Spiral:
    """Compute the spiral into which a case may drill a vertical hole, in closed form.

    Parameters
    ----------
    case
        The drilling system: BHA, bit, with the walk angle, and active weight on bit. Hole, force and length have no
        influence.
    handedness
        "right" or "left"; without it the side to which the bit walks.

    Returns
    -------
    Spiral
        Pitch, radius and forces of the spiral, whether it is stable, and where it ends.

    Raises
    ------
    ParameterError
        If the body may touch the wall, the BHA buckles, ηΠ is below 1e-4, or there is no such side.
    SpiralNotFound
        If the equations could not be solved.

    Examples
    --------
    >>> from boreprop import paper_case, spiral
    >>> found = spiral(paper_case())
    >>> round(found.pitch, 2), round(1e3 * found.radius, 1), found.stable
    (5.1, 21.4, True)
    """
    walk = case.bit.walk_angle
    if handedness not in (None, *HANDS):
        raise ParameterError("handedness", "must be right or left", handedness)
    left = handedness == "left" if handedness else walk < 0
    side = HANDS[left] if walk or handedness else "either"
    with solving(case):
        return Search(case, -walk if left else walk).found(side)


@contextmanager
def solving(case: Case) -> Iterator[None]:
    """Turn the failure of an iteration into a `SpiralNotFound` that says what helps."""
    try:
        yield
    except ArithmeticError as error:
        where = f"the spiral at ηΠ = {case.eta_pi:.6g}"
        raise SpiralNotFound(f"{where}: {error}; use a slightly different active weight on bit") from error


class Search:
    """The spirals to the right of one drilling system."""

    def __init__(self, case: Case, walk: float) -> None:
        check_number("eta_pi", case.eta_pi, at_least=SMALLEST_ETA_PI)
        self.case, self.walk, self.length_scale = case, walk, case.length_scale
        self.turning = Turning(beam_of(case), y_star_of(case), walk)
        self.psi_star, self.clearance = case.bit.tilt_limit, self.turning.widest
        self.ratio = self.psi_star / self.clearance if self.clearance else inf

    def found(self, handedness: str) -> Spiral:
        """All about the spiral of the case."""
        found = self.at(self.case.eta_pi)
        lowest, highest = self.eta_pi_range(found.own)
        return Spiral(
            **vars(NOWHERE if found.own is None else self.winding(found.own)),
            handedness=handedness,
            edge=None if found.edge is None else self.winding(found.edge),
            least_tilt_limit=found.least_ratio * self.clearance,
            widest_clearance=self.widest_clearance(found.least_ratio),
            least_eta_pi=lowest,
            largest_eta_pi=highest,
            critical=self.critical(),
            straight_growth=self.straight_growth(),
        )

    def at(self, eta_pi: float) -> "Found":
        """The spiral of the case at some ηΠ, and the edge.

        If it is not on the curve that begins with all stabilizers on the wall, those with wide clearances are idle.
        """
        tightest = sorted(self.turning.y.tolist())
        found = self.along(eta_pi, inf)
        for widest in reversed(tightest[:-1]):
            if found.own is not None or widest == tightest[-1]:
                break
            further = self.along(eta_pi, widest)
            if further.own is not None or found.least_ratio != found.least_ratio:
                found = further
        return found

    def along(self, eta_pi: float, widest: float) -> "Found":
        """The spirals along a curve that begins with the stabilizers of no wider relative clearance on the wall."""
        fixed, touching = keep(LOG_ETA_PI, log(eta_pi)), tuple(int(y <= widest) for y in self.turning.y.tolist())
        start = beginning(self.turning, eta_pi, touching)
        if start is None or not self.clearance:
            return Found(start, None, nan if start is None else 0.0)
        met: list[Floats] = []  # spirals with the ratio of the case, of which the first has the stiffest gauge
        points = self.curve(start, fixed)
        last = next(points)
        least = ratio_of(last)
        outside = least > self.ratio
        for point in points:
            x = point
            if x[MU] <= 0:
                x = meet(self.turning, last, x, fixed, keep(MU, 0.0))
            least = min(least, ratio_of(x))
            outside, before = ratio_of(x) > self.ratio, outside
            if outside != before and (met or before):
                met.append(meet(self.turning, last, x, fixed, at_limit(self.ratio)))
            if x[MU] == 0 and len(met) == 1:
                met.append(x)
            if not 0 <= x[GAP] < WIDEST or x[MU] == 0:
                break
            last = x
        return Found(met[0] if met else None, met[1] if len(met) > 1 else None, least)

    def curve(self, start: Floats, fixed: Condition) -> Iterator[Floats]:
        """The points of a curve, from its narrowest gap on."""
        before: list[Floats] = []
        if start[GAP] > 0:
            for x in follow(self.turning, start, fixed, GAP, -1.0):
                if x[GAP] <= 0 or x[MU] <= 0:
                    break
                before.append(x)
        yield from reversed(before[1:])
        yield from follow(self.turning, start, fixed, GAP, 1.0)

    def eta_pi_range(self, x: Floats | None) -> tuple[float, float]:
        """The ηΠ between which there is a spiral, from x on if that is one; 0 for a least one below 1e-4."""
        x = self.elsewhere() if x is None else x
        lowest, highest = (nan if x is None else self.end(x, side) for side in (-1.0, 1.0))
        return (0.0 if lowest < SMALLEST_ETA_PI else lowest), highest

    def largest_eta_pi(self) -> float:
        """The largest ηΠ with a spiral, nan if none is found."""
        own = self.at(self.case.eta_pi).own
        x = self.elsewhere() if own is None else own
        return nan if x is None else self.end(x, 1.0)

    def elsewhere(self) -> Floats | None:
        """A spiral at a smaller ηΠ than the case's."""
        eta_pi = self.case.eta_pi
        for _ in range(MOST_DIVISIONS):
            eta_pi /= LESS
            x = self.at(eta_pi).own if eta_pi >= SMALLEST_ETA_PI else None
            if x is not None:
                return x
        return None

    def end(self, x: Floats, side: float) -> float:
        """The ηΠ at which the spirals end, from x on, towards larger (side 1) or smaller ones (−1)."""
        fixed = at_limit(self.ratio) if self.clearance else keep(GAP, 0.0)
        last = x
        for point in follow(self.turning, x, fixed, LOG_ETA_PI, side):
            if point[MU] <= 0:
                last = meet(self.turning, last, point, fixed, keep(MU, 0.0))
                break
            if side * point[LOG_ETA_PI] < side * last[LOG_ETA_PI]:  # it turns back
                break
            last = point
            if point[LOG_ETA_PI] < log(SMALLEST_ETA_PI):
                break
        return exp(last[LOG_ETA_PI])

    def widest_clearance(self, least_ratio: float) -> float:
        """The largest clearance with which there is a spiral, m."""
        return self.psi_star / least_ratio * self.length_scale if least_ratio else inf

    def critical(self) -> CriticalEtaPi | None:
        """The largest ηΠ at which a small spiral keeps itself up in a straight hole."""
        bha = self.case.bha
        found = critical(self.turning.beam, self.walk, longest_wave(bha) / self.length_scale)
        if found is None:
            return None
        weight = found.eta_pi * bha.force_scale / self.case.bit.lateral_steering_resistance
        return CriticalEtaPi(found.eta_pi, weight, found.omega, 2 * pi / found.omega * self.length_scale)

    def straight_growth(self) -> float:
        """The growth of the fastest small spiral about a straight hole, per metre."""
        return rightmost(self.turning.beam, self.walk, self.case.eta_pi).real / self.length_scale

    def winding(self, x: Floats) -> Winding:
        """What x is in SI units."""
        inclination = self.clearance / float(x[GAP]) if x[GAP] > 0 else self.psi_star / tilt(x)
        touched, force = self.turning.contact(x), inclination * self.case.bha.force_scale
        growth = float(roots(self.turning, x)[0].real)
        return Winding(
            pitch=2 * pi / float(x[OMEGA]) * self.length_scale,
            radius=inclination / float(x[OMEGA]) * self.length_scale,
            hole_inclination=inclination,
            bit_inclination=inclination * abs(theta(x)),
            bit_tilt=inclination * tilt(x),
            stabilizer_force=tuple((force * abs(touched.F)).tolist()),
            bit_lateral_force=force
            * float(abs(self.turning.response(self.turning.offsets(x), theta(x), touched.F).F_0)),
            growth=growth / self.length_scale,
            stable=growth < NEUTRAL,
        )


def ratio_of(x: Floats) -> float:
    """Tilt over gap."""
    return tilt(x) / float(x[GAP]) if x[GAP] > 0 else inf

"""How large a dogleg in the existing hole a drilling system forgives before it ripples.

Straight drilling and rippling coexist: which of the two it comes to depends on the hole there is. `critical_dogleg`
asks that of a family of holes,

    straight at the inclination of the case's hole half a BHA behind the bit, then turning evenly by an angle, its
    dogleg, over that half of the BHA before the bit.

Half the BHA, whichever of its blades touch, is the length that everything here is measured in.
"""

from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from math import inf, nan, pi, radians
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..case.case import Case
from ..core.checks import check_number
from ..core.options import RELATIVE_TOLERANCE, Options
from ..core.quantities import OUTPUTS, scalar_names
from ..core.survey import Survey
from ..core.system import eta_pi
from ..errors import CannotContinue
from ..run.engines import Engine, engine, start
from ..run.trajectory import Stopped, Trajectory
from ..run.workers import WorkerLost, work
from .rippling import Rippling, State, find_rippling, last_wave
from .stability.contacts import can_touch, first_that_touches
from .stability.roots import critical_eta_pi
from .study.design import vary
from .waves import without_trend

ROWS = 50  # per half BHA: a wave of the paper has 70, …
LARGEST_INTERVAL = 0.1  # … but no further apart than this, m: a wave of near-bit stabilizers is a metre long
FIRST_CHECK = 8.0  # half BHAs before a run is looked at: the start itself takes that long to pass the BHA four times
LATER = 1.25  # each check comes after so many times the length of the one before: a run is a quarter too long at most
EARLIEST = 30.0  # half BHAs before a ripple is believed: of those at 20, one in ten is an echo of the start
LONGEST = 120.0  # half BHAs before it is taken for steady: chaotic ripples may never be
FALLING = -0.002  # change of the size per wave: a wave that falls faster may yet die out, …
RISING = 0.01  # … and one that rises faster is still starting
STRAIGHT = radians(0.003)  # what a straight hole keeps of the start: far below any ripple that lasts, …
STRAIGHT_OVER = 4.0  # … over so many half BHAs: the two BHAs that the bit feels
LARGEST_DOGLEG = radians(10.0)  # in half a BHA: no collar passes through a sharper turn
SCAN = 6  # doglegs tried first, each half of the one before: down to 0.3°, a usual survey's accuracy
SMALL = 11  # the same where the straight hole ripples by itself: does it after the smallest turns, too?
TOLERANCE = 0.02  # of the critical dogleg: far less than anybody knows the hole
FINEST = radians(0.001)  # what tips at less is tipped by any dogleg


def drill_until_steady(case: Case, *, relative_tolerance: float = RELATIVE_TOLERANCE) -> tuple[Trajectory, Rippling]:
    """Drill a case under its first steering force until it plainly ripples or plainly does not.

    It does not when over two BHAs less than 0.003° is left of the start, or when its wave dies out and changes no
    contact and no saturation any more, so nothing can keep it up. It does when its waves last, lose less than 0.2 %
    from one to the next, and at least 15 lengths of the BHA are drilled. After 60 lengths it does unless
    its waves still fall by more.

    In an inclined hole gravity changes the inclination on the way: the answer is for where it starts. With several
    stabilizers a ripple may be chaotic, and some of those die out after hundreds of BHAs, when nobody can tell before.

    Parameters
    ----------
    case
        What is drilled; its length does not matter.
    relative_tolerance
        Of the integrator.

    Returns
    -------
    run, rippling
        What was drilled, and the wave that it ends with.

    Raises
    ------
    Stopped
        If the integrator cannot go on.
    """
    half, drilled = case.bha.half_length, _OpenEndedRun.of(case, relative_tolerance)
    target = FIRST_CHECK * half
    while True:
        run = drilled.drill_to(target)
        wave = last_wave(run)
        if _is_steady(run, wave, half):
            return run, find_rippling(run)
        if target >= LONGEST * half:
            found = find_rippling(run)
            return run, replace(found, state=State.DYING) if wave.growth * wave.wavelength < FALLING else found
        target = min(LATER * target, LONGEST * half)


@dataclass
class _OpenEndedRun:
    """A case that is drilled further and further, with its rows so far."""

    case: Case
    drilling: Engine
    interval: float  # m between two rows
    names: list[str]
    rows: Floats

    @classmethod
    def of(cls, case: Case, relative_tolerance: float) -> "_OpenEndedRun":
        names = scalar_names(OUTPUTS, len(case.bha.stabilizer_positions))
        interval = min(case.bha.half_length / ROWS, LARGEST_INTERVAL)
        return cls(case, start(case, engine(), Options(relative_tolerance)), interval, names, np.empty((0, len(names))))

    def drill_to(self, length: float) -> Trajectory:
        """The run down to a drilled length, m; `Stopped` if the integrator cannot go on."""
        more = np.empty((int(length / self.interval) + 1 - len(self.rows), len(self.names)))
        lengths = self.interval * np.arange(len(self.rows), len(self.rows) + len(more), dtype=np.float64)
        force = np.full(len(more), self.case.schedule.rss_force[0])
        each = np.arange(len(more), dtype=np.intc)
        try:
            self.drilling.follow(lengths, force, self.case.active_weight_on_bit, each, more)
        except CannotContinue as error:
            raise Stopped(f"after {self.drilling.drilled_length:g} m: {error}") from error
        self.rows = np.concatenate((self.rows, more))
        return Trajectory(dict(zip(self.names, self.rows.T, strict=True)), self.case)


def _is_steady(run: Trajectory, wave: Rippling, half: float) -> bool:
    """Whether more of a run would not tell more of it."""
    drilled = run["drilled_length"][-1]
    if wave.ripples:
        return drilled >= EARLIEST * half and FALLING < wave.growth * wave.wavelength < RISING
    if wave.state is State.NONE:
        recent = run["drilled_length"] >= drilled - STRAIGHT_OVER * half
        left = without_trend(run["drilled_length"][recent], run["borehole_inclination"][recent])
        return float(np.ptp(left)) / 2 < STRAIGHT
    return wave.switching is False


@dataclass(frozen=True)
class CriticalDogleg:
    """The smallest dogleg that tips a system over.

    Parameters
    ----------
    angle
        The turn of the hole over the last half of the BHA, rad: half-way between the smallest that tips, of those
        tried, and the next smaller one. 0 if the straight hole ripples by itself or as soon as it turns by 0.001°, inf
        if no turn up to the limit tips it.
    curvature
        The same as a dogleg severity, rad/m.
    monotonic
        False if a larger turn, of those tried, does not tip it.
    tried
        (turn, whether it ripples) in order of the turn: one simulation each.
    """

    angle: float
    curvature: float
    monotonic: bool
    tried: tuple[tuple[float, bool], ...]


def with_dogleg(case: Case, turn: float) -> Case:
    """`case` with a straight hole that turns by `turn`, rad, over the last half of the BHA; positive builds.

    The inclination of the straight hole is that of the case's hole half a BHA behind the bit.
    """
    half, depth = case.bha.half_length, case.survey.measured_depth
    behind = float(np.interp(depth[-1] - half, depth, case.survey.inclination))
    return replace(case, survey=Survey((0.0, half), (behind, behind + float(turn))))  # numpy's own slow the core down


def critical_dogleg(
    case: Case,
    *,
    side: Literal[1, -1] = 1,
    limit: float = LARGEST_DOGLEG,
    tolerance: float = TOLERANCE,
    relative_tolerance: float = RELATIVE_TOLERANCE,
) -> CriticalDogleg:
    """The smallest dogleg in the existing hole from which a system ripples.

    The straight hole and turns of `limit`, a half of it, … to 1/32 are tried first, and down to 1/1024 where the
    straight hole ripples by itself; the interval below the smallest that tips is then halved (in proportion). In an
    inclined hole gravity disturbs even the straight one, and the inclination changes on the way; the answer is
    for where it starts.

    Parameters
    ----------
    case
        The system, its weight on bit, its first steering force, and the inclination of its hole behind the bit.
    side
        1: the hole turns up (builds), −1: down (drops).
    limit
        Largest turn, rad.
    tolerance
        Width of the last interval over the turn.
    relative_tolerance
        Of the integrator.

    Raises
    ------
    ParameterError
        If the limit or the tolerance is out of range.
    Stopped
        If the integrator cannot go on.
    """
    check_limits(limit, tolerance)
    tried: dict[float, bool] = {}

    def tips(turn: float) -> bool:
        bent = with_dogleg(case, side * turn)
        tried[turn] = drill_until_steady(bent, relative_tolerance=relative_tolerance)[1].ripples
        return tried[turn]

    for k in range(SMALL if tips(0.0) else SCAN):
        tips(limit / 2**k)
    high = min((turn for turn, ripples in tried.items() if ripples), default=inf)
    low = max((turn for turn in tried if turn < high), default=0.0)
    angle = high
    if 0.0 < high < inf:
        while high - low > max(tolerance * high, FINEST):
            middle = (low * high) ** 0.5 if low else high / 2
            low, high = (low, middle) if tips(middle) else (middle, high)
        angle = (low + high) / 2 if high > FINEST else 0.0
    ordered = tuple(sorted(tried.items()))
    monotonic = all(ripples for turn, ripples in ordered if turn >= high)
    return CriticalDogleg(angle, angle / case.bha.half_length, monotonic, ordered)


def check_limits(limit: float, tolerance: float) -> None:
    """Raise `ParameterError` unless the largest turn and the tolerance of a critical dogleg make sense."""
    check_number("limit", limit, above=0.0, at_most=pi / 2)
    check_number("tolerance", tolerance, above=0.0, at_most=1.0)


@dataclass(frozen=True, eq=False)
class DoglegMap:
    """Critical doglegs over weight on bit and clearance, see `CriticalDogleg`.

    Parameters
    ----------
    eta_pi, clearance
        ηΠ, shape (m,), and the clearance of one stabilizer, m, shape (k,).
    stabilizer
        The number of that stabilizer, the first that can touch the wall.
    angle
        rad, shape (k, m); nan where a run could not go on.
    monotonic
        Shape (k, m).
    stopped
        Why that run stopped, "" elsewhere, shape (k, m).
    """

    eta_pi: NDArray[np.float64]
    clearance: NDArray[np.float64]
    stabilizer: int
    angle: NDArray[np.float64]
    monotonic: NDArray[np.bool_]
    stopped: NDArray[np.str_]


def usual_map(case: Case) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """ηΠ and clearances of the first stabilizer that can touch, m, for a map that shows where a case ripples, and it.

    The ηΠ go from the case's, or less, up to where the BHA in contact no longer oscillates, or beyond the case's.
    """
    own = eta_pi(case.bha, case.bit, case.active_weight_on_bit)
    inclination = case.survey.inclination[-1]
    contact = can_touch(case.bha, case.bit, inclination, case.schedule.rss_force)
    critical = critical_eta_pi(case, contact=contact, inclination=inclination)
    highest = max(1.1 * critical.eta_pi if critical else 0.0, 1.5 * own)
    clearance = (*case.bha.stabilizer_clearances, 0.0)[first_that_touches(case) - 1]
    return (
        np.linspace(min(own, highest / 16), highest, 16),
        np.linspace(min(0.5e-3, clearance), max(8e-3, 1.5 * clearance), 8),
    )


def dogleg_map(
    case: Case,
    eta_pi: NDArray[np.float64],
    clearance: NDArray[np.float64],
    *,
    side: Literal[1, -1] = 1,
    limit: float = LARGEST_DOGLEG,
    tolerance: float = TOLERANCE,
    relative_tolerance: float = RELATIVE_TOLERANCE,
    workers: int | None = None,
    progress: Callable[[float], None] = lambda _: None,
) -> DoglegMap:
    """`critical_dogleg` over ηΠ, reached by the weight, and the clearance, m, of the first stabilizer that can touch.

    It works on `workers` processes, one for each core unless told otherwise; `boreprop.analysis.study` says what a
    script must do for them. `progress` is called with the number of points done. A point of which a run cannot go on
    is left out.

    Raises
    ------
    InputError, ParameterError
        If the case has no stabilizer with clearance, or a value is out of range.
    """
    check_limits(limit, tolerance)
    axes = clearance.tolist(), eta_pi.tolist()
    stabilizer = first_that_touches(case)
    cases = [vary(case, {"eta_pi": x, f"stabilizer_clearance[{stabilizer}]": y}) for y, x in product(*axes)]
    compute = partial(
        critical_dogleg_or_why, side=side, limit=limit, tolerance=tolerance, relative_tolerance=relative_tolerance
    )
    found: dict[int, CriticalDogleg | str] = {}
    with closing(work(compute, dict(enumerate(cases)), workers=workers)) as finished:
        for batch in finished:
            found |= {key: str(one) if isinstance(one, WorkerLost) else one for key, one in batch}
            progress(len(found))
    ordered = [found[key] for key in range(len(cases))]
    shape = len(clearance), len(eta_pi)
    return DoglegMap(
        eta_pi,
        clearance,
        stabilizer,
        angle=np.array([nan if isinstance(one, str) else one.angle for one in ordered]).reshape(shape),
        monotonic=np.array([isinstance(one, str) or one.monotonic for one in ordered]).reshape(shape),
        stopped=np.array([one if isinstance(one, str) else "" for one in ordered]).reshape(shape),
    )


def critical_dogleg_or_why(case: Case, **options: Any) -> CriticalDogleg | str:
    """A `critical_dogleg`, or why a run could not go on."""
    try:
        return critical_dogleg(case, **options)
    except Stopped as error:
        return str(error)

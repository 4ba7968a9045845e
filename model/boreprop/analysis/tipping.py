"""Finds the smallest dogleg in the existing hole that starts rippling.

A system may drill a straight hole or a rippling one, depending on the existing hole. `critical_dogleg` tries a family
of existing holes: each is straight, at the inclination that the case's hole has half the length of the BHA behind the
bit, and then turns at a constant rate by an angle, its dogleg, over the last half length before the bit.

Lengths here are measured in half lengths of the BHA, which do not depend on which stabilizers touch the wall.
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
from ..errors import CannotContinue, ParameterError
from ..run.engines import Engine, engine, held, start
from ..run.trajectory import Stopped, Trajectory
from ..run.workers import WorkerLost, work
from .rippling import Rippling, find_rippling, last_wave
from .search import State
from .stability.contacts import can_touch, first_that_touches
from .stability.roots import critical_eta_pi
from .study.design import vary
from .waves import without_trend

ROWS = 50  # rows in half a length of the BHA: a wave of the paper's case has 70, …
LARGEST_INTERVAL = 0.1  # m, … and the largest distance between rows: with a stabilizer near the bit a wave is 1 m long
FIRST_CHECK = 8.0  # half lengths drilled before the first check: the starting point has then passed the BHA four times
LATER = 1.25  # each check comes at this many times the length of the last, so a run is at most a quarter too long
EARLIEST = 30.0  # half lengths before a ripple is accepted: of those at 20, one in ten is an echo of the start
LONGEST = 120.0  # half lengths after which a run counts as steady: chaotic ripples may never become so
FALLING = -0.002  # growth per wave: a wave that falls faster may yet die out, …
RISING = 0.01  # … and one that rises faster has not reached its size yet
STRAIGHT = radians(0.003)  # a deviation from the trend this small is a straight hole: far below any lasting ripple, …
STRAIGHT_OVER = 4.0  # … over this many half lengths: two BHAs
LARGEST_DOGLEG = radians(10.0)  # over half a length of the BHA: no drill collar passes through a sharper turn
SCAN = 6  # doglegs tried first, each half of the last: from 10° down to 0.3°, the accuracy of a usual survey
SMALL = 11  # the same if the straight hole ripples by itself, to see whether it also does after the smallest turns
TOLERANCE = 0.02  # relative, of the critical dogleg: no hole is surveyed as precisely
FINEST = radians(0.001)  # a critical dogleg below this counts as zero
COLUMNS, ROWS_OF_MAP = 16, 8  # of a map: each of its points takes ten runs or more, and together they take minutes
CLEARANCES = 0.5e-3, 8e-3  # m, of a map, at least: from a stabilizer that hardly has any to one that hardly touches


def drill_until_steady(case: Case, *, relative_tolerance: float = RELATIVE_TOLERANCE) -> tuple[Trajectory, Rippling]:
    """Drill a case under its first steering force until it clearly ripples or clearly does not.

    It does not ripple if, over two lengths of the BHA, the inclination deviates from its trend by less than ±0.003°, or
    if there is a wave that dies out and changes no contact and no saturation, so that nothing can sustain it. It
    ripples if its waves last, lose less than 0.2 % and gain less than 1 % of their size from one to the next, and at
    least 15 lengths of the BHA are drilled. After 60 lengths it ripples unless its waves still fall faster.

    In an inclined hole gravity changes the inclination as the hole is drilled; the answer is for the inclination at the
    start. With several stabilizers a ripple may be chaotic, and some chaotic ripples die out after hundreds of BHA
    lengths, which cannot be foreseen.

    Parameters
    ----------
    case
        What is drilled; its length has no influence.
    relative_tolerance
        Error allowed in one step of the integrator, see `simulate`.

    Returns
    -------
    run, rippling
        The run, and the wave with which it ends.

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
    """A case that is drilled ever further, with its rows so far."""

    case: Case
    drilling: Engine
    interval: float  # distance between rows, m
    names: list[str]
    rows: Floats

    @classmethod
    def of(cls, case: Case, relative_tolerance: float) -> "_OpenEndedRun":
        names = scalar_names(OUTPUTS, case.bha.structure)
        interval = min(case.bha.half_length / ROWS, LARGEST_INTERVAL)
        return cls(case, start(case, engine(), Options(relative_tolerance)), interval, names, np.empty((0, len(names))))

    def drill_to(self, length: float) -> Trajectory:
        """The run down to a drilled length, m; `Stopped` if the integrator cannot go on."""
        more = np.empty((int(length / self.interval) + 1 - len(self.rows), len(self.names)))
        lengths = self.interval * np.arange(len(self.rows), len(self.rows) + len(more), dtype=np.float64)
        case = self.case
        force, weight = case.schedule.rss_force[0], case.active_weight_on_bit
        inputs = held(len(more), force, weight, case.bit, case.weight_on_bit)
        each = np.arange(len(more), dtype=np.intc)
        try:
            self.drilling.follow(lengths, inputs, each, more)
        except CannotContinue as error:
            raise Stopped(f"after {self.drilling.drilled_length:g} m: {error}") from error
        self.rows = np.concatenate((self.rows, more))
        return Trajectory(dict(zip(self.names, self.rows.T, strict=True)), self.case)


def _is_steady(run: Trajectory, wave: Rippling, half: float) -> bool:
    """Whether a run has been drilled long enough to say whether it ripples."""
    drilled = run["drilled_length"][-1]
    if wave.ripples:
        return drilled >= EARLIEST * half and FALLING < wave.growth * wave.wavelength < RISING
    if wave.state is State.NONE:
        recent = run["drilled_length"] >= drilled - STRAIGHT_OVER * half
        deviation = without_trend(run["drilled_length"][recent], run["borehole_inclination"][recent])
        return float(np.ptp(deviation)) / 2 < STRAIGHT
    return wave.switching is False


@dataclass(frozen=True)
class CriticalDogleg:
    """The smallest dogleg that starts rippling.

    Parameters
    ----------
    angle
        The turn of the hole over the last half length of the BHA, rad: half-way between the smallest tried that starts
        rippling and the next smaller one tried. 0 if the straight hole ripples by itself or after a turn of 0.001°, inf
        if no turn up to the limit starts rippling.
    curvature
        The angle over half the length of the BHA, as a dogleg severity, rad/m.
    monotonic
        Whether all larger turns that were tried start rippling, too.
    tried
        Each turn that was tried, rad, increasing, and whether the system ripples after it: one simulation each.
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
    return replace(case, survey=Survey((0.0, half), (behind, behind + float(turn))))  # numpy's floats slow the core


def critical_dogleg(
    case: Case,
    *,
    side: Literal[1, -1] = 1,
    limit: float = LARGEST_DOGLEG,
    tolerance: float = TOLERANCE,
    relative_tolerance: float = RELATIVE_TOLERANCE,
) -> CriticalDogleg:
    """Find the smallest dogleg in the existing hole that starts rippling.

    Tried first are the straight hole and turns of `limit`, of half of it, … down to 1/32 of it; if the straight hole
    ripples by itself, down to 1/1024. The interval below the smallest turn that starts rippling is then bisected, at
    its geometric mean.

    A straight inclined hole may need no dogleg: under its weight the BHA drops, perhaps with a stabilizer on the wall,
    and if that mode oscillates, waves grow until the hole is nearly vertical. The inclination changes as the hole is
    drilled; the answer is for that at the start.

    Parameters
    ----------
    case
        The system, its active weight on bit, its first steering force, and the inclination of its hole behind the bit.
        The length has no influence.
    side
        1 if the hole turns up (builds), −1 if it turns down (drops).
    limit
        Largest turn that is tried, rad.
    tolerance
        Width of the last interval over the turn.
    relative_tolerance
        Error allowed in one step of the integrator, see `simulate`.

    Returns
    -------
    CriticalDogleg
        The angle over half the length of the BHA, and all turns that were tried.

    Raises
    ------
    ParameterError
        If the side, the limit or the tolerance is out of range.
    Stopped
        If the integrator cannot go on.

    Examples
    --------
    >>> from math import degrees
    >>> from boreprop import critical_dogleg, paper_case
    >>> found = critical_dogleg(paper_case(), tolerance=0.1)
    >>> round(degrees(found.angle), 2), found.monotonic
    (0.42, True)
    """
    check_limits(side, limit, tolerance)
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


def check_limits(side: int, limit: float, tolerance: float) -> None:
    """Raise `ParameterError` unless the side, the largest turn and the tolerance of a critical dogleg are in range."""
    if side not in (1, -1):
        raise ParameterError("side", "must be 1 or -1", side)
    check_number("limit", limit, above=0.0, at_most=pi / 2)
    check_number("tolerance", tolerance, above=0.0, at_most=1.0)


@dataclass(frozen=True, eq=False)
class DoglegMap:
    """Critical doglegs over active weight on bit and clearance, see `CriticalDogleg`.

    Parameters
    ----------
    eta_pi
        ηΠ, shape (m,).
    clearance
        Clearances of one stabilizer, m, shape (k,).
    stabilizer
        The number of that stabilizer, the first that can touch the wall.
    angle, monotonic
        Those fields of the critical doglegs, shape (k, m); the angle, rad, is nan where a run could not go on.
    stopped
        The reason why that run stopped, elsewhere empty, shape (k, m).
    """

    eta_pi: NDArray[np.float64]
    clearance: NDArray[np.float64]
    stabilizer: int
    angle: NDArray[np.float64]
    monotonic: NDArray[np.bool_]
    stopped: NDArray[np.str_]


def usual_map(case: Case) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """ηΠ and clearances, m, of the first stabilizer that can touch, for a map of where a system ripples.

    The map includes the case. Its ηΠ go from that of the case, or less, to a little beyond that at which the BHA in
    contact no longer oscillates, and at least to 1.5 times that of the case.
    """
    own = case.eta_pi
    inclination = case.survey.inclination[-1]
    contact = can_touch(case.bha, case.bit, inclination, case.schedule.rss_force)
    modal = not case.bha.body_point_positions  # else there is no critical ηΠ
    critical = critical_eta_pi(case, contact=contact, inclination=inclination) if modal else None
    highest = max(1.1 * critical.eta_pi if critical else 0.0, 1.5 * own)
    clearance = (*case.bha.stabilizer_clearances, 0.0)[first_that_touches(case) - 1]
    smallest, largest = CLEARANCES
    return (
        np.linspace(min(own, highest / COLUMNS), highest, COLUMNS),
        np.linspace(min(smallest, clearance), max(largest, 1.5 * clearance), ROWS_OF_MAP),
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
    """Map `critical_dogleg` over ηΠ and the clearance of the first stabilizer that can touch the wall.

    Parameters
    ----------
    case
        The system.
    eta_pi
        ηΠ, shape (m,), reached by the active weight on bit.
    clearance
        Clearances, m, shape (k,).
    side, limit, tolerance, relative_tolerance
        As in `critical_dogleg`.
    workers
        Number of processes; None: one for each core. A script must start them as `boreprop.study` says.
    progress
        Called with the number of points done.

    Returns
    -------
    DoglegMap
        The critical dogleg at every point. A point at which a run cannot go on has the reason instead.

    Raises
    ------
    InputError, ParameterError
        If the case has no stabilizer with clearance, or a value is out of range.
    """
    check_limits(side, limit, tolerance)
    axes = clearance.tolist(), eta_pi.tolist()
    stabilizer = first_that_touches(case)
    cases = [vary(case, {"eta_pi": x, f"stabilizer_clearance[{stabilizer}]": y}) for y, x in product(*axes)]
    compute = partial(
        critical_dogleg_or_why, side=side, limit=limit, tolerance=tolerance, relative_tolerance=relative_tolerance
    )
    found: dict[int, CriticalDogleg | str] = {}
    with closing(work(compute, dict(enumerate(cases)), workers=workers)) as finished:
        for batch in finished:
            found |= {key: str(result) if isinstance(result, WorkerLost) else result for key, result in batch}
            progress(len(found))
    points = [found[key] for key in range(len(cases))]
    shape = len(clearance), len(eta_pi)
    return DoglegMap(
        eta_pi,
        clearance,
        stabilizer,
        angle=np.array([nan if isinstance(point, str) else point.angle for point in points]).reshape(shape),
        monotonic=np.array([isinstance(point, str) or point.monotonic for point in points]).reshape(shape),
        stopped=np.array([point if isinstance(point, str) else "" for point in points]).reshape(shape),
    )


def critical_dogleg_or_why(case: Case, **options: Any) -> CriticalDogleg | str:
    """The `critical_dogleg`, or the reason why a run could not go on."""
    try:
        return critical_dogleg(case, **options)
    except Stopped as error:
        return str(error)

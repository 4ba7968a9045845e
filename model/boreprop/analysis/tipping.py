"""How large a dogleg in the existing hole a drilling system forgives before it ripples, and when a ripple dies out.

Straight drilling and rippling coexist: which of the two it comes to depends on the hole there is. `critical_dogleg`
asks that of a family of holes,

    straight at the inclination of the case's hole ℓ₁ behind the bit, then turning evenly by an angle, its dogleg, over
    the last ℓ₁ before the bit,

and `hysteresis` of the holes that a system leaves to itself while a parameter changes.
"""

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from itertools import count, product
from math import inf, pi, radians
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..case import Case
from ..core.assembly import check_number
from ..core.hole import Survey
from ..core.propagation import RELATIVE_TOLERANCE
from ..core.variables import OUTPUTS, scalar_names
from ..results import Trajectory
from ..simulation import SimulationError, best_engine, follow, start
from .design import vary
from .rippling import REACH, SMALLEST_AMPLITUDE, TREND, WINDOW, Rippling, examine_rippling, find_rippling
from .workers import WorkerLost, work

ROWS = 40  # per ℓ₁
LOOK = 3.0  # ℓ₁ between two looks at whether it has settled
EARLIEST = WINDOW + 2 * REACH * TREND + 6.0  # ℓ₁ before a ripple is believed: what `find_rippling` sees, and the start
LONGEST = 150.0  # ℓ₁ before the end is taken for settled
LARGEST_CHANGE = 0.01  # of the amplitude over the waves looked at: what falls faster may yet die out
LARGEST_DOGLEG = radians(10.0)
SCAN = 6  # doglegs tried first, each half of the one before
TOLERANCE = 0.02
FINEST = radians(0.001)  # what tips at less is tipped by any dogleg


def drill_until_settled(case: Case, *, relative_tolerance: float = RELATIVE_TOLERANCE) -> tuple[Trajectory, Rippling]:
    """Drill a case under its first steering force until it plainly ripples or plainly does not.

    It does not when what is left of a wave, over more than the length of the BHA, is smaller than 0.01° and falls. It
    does when the size of the waves in the last 12 ℓ₁ changes by less than 1 %; so near the edge of what can last, a
    wave that takes hundreds of ℓ₁ to die out counts as a ripple. A run of 150 ℓ₁ is cut off: it ripples if its waves
    still grow.

    Returns
    -------
    run, rippling
        The case's length does not matter.

    Raises
    ------
    SimulationError
        If the integrator cannot go on.
    """
    bha, l1 = case.bha, case.bha.length_scale
    drilling = start(case, best_engine(), relative_tolerance)
    names = scalar_names(OUTPUTS, len(bha.stabilizer_positions))
    rows = np.empty((0, len(names)))
    while True:
        more = np.empty((int(LOOK * ROWS), len(names)))
        lengths = np.arange(len(rows), len(rows) + len(more)) * l1 / ROWS
        force = np.full(len(more), case.schedule.rss_force[0])
        failure = follow(drilling, lengths, force, case.active_weight_on_bit, np.arange(len(more), dtype=np.intc), more)
        if failure:
            raise SimulationError(f"after {drilling.drilled_length:g} m: {failure}")
        rows = np.concatenate((rows, more))
        run = Trajectory(dict(zip(names, rows.T, strict=True)), case)
        if _at_rest(run, bha.stabilizer_positions[-1] + LOOK * l1):
            return run, Rippling(False)
        if len(rows) >= EARLIEST * ROWS:
            found = find_rippling(run["drilled_length"], run["borehole_inclination"], l1)
            change = found.amplitude_drift * WINDOW * l1 / found.amplitude  # nan, neither large nor small, without one
            if abs(change) < LARGEST_CHANGE:
                return run, examine_rippling(run, l1)
            if len(rows) >= LONGEST * ROWS:
                return run, examine_rippling(run, l1) if change > 0 else Rippling(False)


def _at_rest(run: Trajectory, length: float) -> bool:
    """Whether over the last `length`, m, waves have been small and falling."""
    recent = run["drilled_length"] > run["drilled_length"][-1] - length
    if recent.all():
        return False
    at, inclination = run["drilled_length"][recent], run["borehole_inclination"][recent]
    wave = inclination - np.polynomial.Polynomial.fit(at, inclination, 2)(at)
    early, late = (float(np.std(half)) for half in np.array_split(wave, 2))
    return late <= early and late < SMALLEST_AMPLITUDE


# From straight holes with a dogleg


@dataclass(frozen=True)
class CriticalDogleg:
    """The smallest dogleg that tips a system over.

    Parameters
    ----------
    angle
        The turn of the hole over the last ℓ₁, rad: half-way between the smallest that tips, of those tried, and the
        next smaller one. 0 if the straight hole ripples by itself or as soon as it turns by 0.001°, inf if no turn up
        to the limit tips it.
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
    """`case` with a straight hole that turns by `turn`, rad, over the last ℓ₁; positive builds."""
    return replace(case, survey=_bent(_inclination_behind(case), turn, case.bha.length_scale))


def critical_dogleg(
    case: Case,
    *,
    side: Literal[1, -1] = 1,
    limit: float = LARGEST_DOGLEG,
    tolerance: float = TOLERANCE,
    relative_tolerance: float = RELATIVE_TOLERANCE,
) -> CriticalDogleg:
    """The smallest dogleg in the existing hole from which a system ripples.

    The straight hole and turns of `limit`, a half of it, … to 1/32 are tried first; the interval below the smallest
    that tips is then halved (in proportion). In an inclined hole gravity disturbs even the straight one, and the
    inclination changes while it settles; the answer is for where it starts.

    Parameters
    ----------
    case
        The system, its weight on bit, its first steering force, and the inclination of its hole ℓ₁ behind the bit.
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
    SimulationError
        If the integrator cannot go on.
    """
    check_number("limit", limit, above=0.0, at_most=pi / 2)
    check_number("tolerance", tolerance, above=0.0, at_most=1.0)
    tried: dict[float, bool] = {}

    def tips(turn: float) -> bool:
        bent = with_dogleg(case, side * turn)
        tried[turn] = drill_until_settled(bent, relative_tolerance=relative_tolerance)[1].ripples
        return tried[turn]

    for turn in (0.0, *(limit / 2**k for k in reversed(range(SCAN)))):
        tips(turn)
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
    return CriticalDogleg(angle, angle / case.bha.length_scale, monotonic, ordered)


@dataclass(frozen=True, eq=False)
class DoglegMap:
    """Critical doglegs over weight on bit and clearance, see `CriticalDogleg`.

    Parameters
    ----------
    eta_pi, clearance
        ηΠ, shape (m,), and the clearance of the first stabilizer, m, shape (k,).
    angle
        rad, shape (k, m).
    monotonic
        Shape (k, m).
    """

    eta_pi: NDArray[np.float64]
    clearance: NDArray[np.float64]
    angle: NDArray[np.float64]
    monotonic: NDArray[np.bool_]


def dogleg_map(
    case: Case,
    eta_pi: NDArray[np.float64],
    clearance: NDArray[np.float64],
    *,
    side: Literal[1, -1] = 1,
    limit: float = LARGEST_DOGLEG,
    tolerance: float = TOLERANCE,
    workers: int | None = None,
    progress: Callable[[float], None] = lambda _: None,
) -> DoglegMap:
    """`critical_dogleg` over ηΠ, reached by the weight on bit, and the clearance of the first stabilizer, m.

    It works on `workers` processes, one for each core unless told otherwise; `boreprop.analysis.study` says what a
    script must do for them. `progress` is called with the number of points done.

    Raises
    ------
    InputError, ParameterError
        If the case has no stabilizer with clearance, or a value is out of range.
    SimulationError
        If the integrator cannot go on.
    """
    axes = clearance.tolist(), eta_pi.tolist()
    cases = [vary(case, {"eta_pi": x, "stabilizer_clearance[1]": y}) for y, x in product(*axes)]
    compute = partial(critical_dogleg, side=side, limit=limit, tolerance=tolerance)
    found: dict[int, CriticalDogleg] = {}
    with closing(work(compute, dict(enumerate(cases)), workers=workers)) as finished:
        for batch in finished:
            for key, one in batch:
                if isinstance(one, WorkerLost):
                    raise one
                found[key] = one
            progress(len(found))
    shape = len(clearance), len(eta_pi)
    ordered = [found[key] for key in range(len(cases))]
    angle = np.array([one.angle for one in ordered]).reshape(shape)
    return DoglegMap(eta_pi, clearance, angle, np.array([one.monotonic for one in ordered]).reshape(shape))


# From the holes that it leaves to itself


def hysteresis(
    cases: Sequence[Case], dogleg: float, progress: Callable[[float], None] = lambda _: None
) -> tuple[list[Rippling], list[Rippling]]:
    """How a system ripples while a parameter goes up and down again, slowly.

    Each case is drilled until it settles, in the hole that the case before it left. A hole that was left straight would
    stay straight for ever: it gets a dogleg, as the next survey, connection or formation would give it one. Going up
    starts from one that makes the first case ripple, if any does; going down starts from the dogleg.

    Parameters
    ----------
    cases
        The same system with a parameter in rising order.
    dogleg
        What turn, over ℓ₁, a straight hole always has, rad.
    progress
        Called with the number of runs done, of twice the number of cases.

    Returns
    -------
    up, down
        The rippling of each case, in the order of `cases` both.
    """
    done = count(1)

    def branch(cases: Sequence[Case], turn: float) -> list[Rippling]:
        found = []
        survey = with_dogleg(cases[0], turn).survey
        for case in cases:
            run, rippling = drill_until_settled(replace(case, survey=survey))
            survey = _left_behind(run, case) if rippling.ripples else _straight_behind(run, case, dogleg)
            found.append(rippling)
            progress(next(done))
        return found

    tipping = (turn for turn, ripples in critical_dogleg(cases[0], tolerance=0.5).tried if ripples)
    return branch(cases, next(tipping, dogleg)), branch(cases[::-1], dogleg)[::-1]


def _left_behind(run: Trajectory, case: Case) -> Survey:
    """The drilled hole as a survey of chords, as far as the next run can feel it.

    It ends where the tilt was least: a run starts with the bit along the hole.
    """
    length, l1 = run["drilled_length"], case.bha.length_scale
    recent = length >= length[-1] - 2 * l1
    end = int(np.flatnonzero(recent)[np.argmin(np.abs(run["bit_tilt"][recent]))])
    first = int(np.searchsorted(length, length[end] - case.bha.stabilizer_positions[-1] - l1))
    kept = slice(max(first, 0), end + 1)
    along = np.diff(run["displacement"][kept]), np.diff(run["true_vertical_depth"][kept])
    middles = (length[kept][1:] + length[kept][:-1]) / 2
    return Survey(tuple(middles.tolist()), tuple(np.arctan2(*along).tolist()))


def _straight_behind(run: Trajectory, case: Case, turn: float) -> Survey:
    return _bent(float(run["average_inclination[1]"][-1]), turn, case.bha.length_scale)


def _bent(inclination: float, turn: float, length: float) -> Survey:
    return Survey((0.0, length), (inclination, inclination + float(turn)))  # numpy's own slow the core down


def _inclination_behind(case: Case) -> float:
    depth = case.survey.measured_depth
    return float(np.interp(depth[-1] - case.bha.length_scale, depth, case.survey.inclination))

"""When a ripple dies out as weight or clearance goes up, and where it comes back on the way down."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..case.case import Case
from ..core.options import RELATIVE_TOLERANCE
from ..core.survey import Survey
from ..run.trajectory import Stopped, Trajectory
from .rippling import Rippling
from .study.design import vary
from .tipping import LARGEST_DOGLEG, SCAN, drill_until_steady, with_dogleg

END = 0.01  # to which part of the parameter the ends of a loop are found

Bracket = tuple[float, float]


@dataclass(frozen=True)
class Hysteresis:
    """How a system ripples while a parameter goes slowly up and down again.

    Parameters
    ----------
    name, values
        The parameter, see `design.vary`, and its values in rising order.
    dogleg
        What turn, over half the BHA, straight holes have, rad.
    up, down
        The rippling at each value on the way up and on the way down; None where a run could not go on.
    dies
        Between which two values the ripple dies out on the way up, to a hundredth; None if it does not, or never was.
    returns
        Between which two values the dogleg brings the ripple back on the way down, the larger one without ripple;
        None if it does not, or if it ripples from the largest value on.
    """

    name: str
    values: tuple[float, ...]
    dogleg: float
    up: tuple[Rippling | None, ...]
    down: tuple[Rippling | None, ...]
    dies: Bracket | None
    returns: Bracket | None


def hysteresis(
    case: Case,
    name: str,
    values: Sequence[float],
    dogleg: float,
    *,
    relative_tolerance: float = RELATIVE_TOLERANCE,
    progress: Callable[[float], None] = lambda _: None,
) -> Hysteresis:
    """How a system ripples while a parameter goes up and down again, slowly.

    Going up starts from a ripple: from a dogleg that makes the case with the first value ripple, if any does. Each case
    then drills on in the hole that the one before it left, until it is steady. A straight hole would stay straight for
    ever, though the next survey, connection or formation makes it turn: so each case that no ripple goes before starts
    in the hole of `with_dogleg`, straight at the inclination of the case, with the dogleg. So do all cases going down,
    until one ripples.

    Parameters
    ----------
    case, name, values
        What is drilled, the parameter that changes, see `design.vary`, and its values in rising order.
    dogleg
        What turn, over half the BHA, straight holes have, rad.
    relative_tolerance
        Of the integrator.
    progress
        Called with the number of values done, of twice as many as there are.

    Raises
    ------
    InputError, ParameterError
        If a value is out of range.
    """
    ramp = _Ramp(case, name, dogleg, relative_tolerance)
    for value in values:
        ramp.at(value)  # what is out of range is refused before the work
    up: list[Rippling | None] = []
    dies: Bracket | None = None
    hole = ramp.rippling_hole(values[0])
    for k, value in enumerate(values):
        end = ramp.drill(value, hole)
        if hole and k and not end.hole:
            between, end = ramp.follow(values[k - 1], value, hole, end)
            dies = dies or between
        hole = end.hole
        up.append(end.wave)
        progress(k + 1)
    down: list[Rippling | None] = []
    returns: Bracket | None = None
    hole = None
    for k, value in enumerate(reversed(values)):
        end = ramp.drill(value, hole)
        if end.hole and not hole and k and not returns:
            returns = ramp.bisect(value, values[-k])
        hole = end.hole
        down.append(end.wave)
        progress(len(values) + k + 1)
    return Hysteresis(name, tuple(values), dogleg, tuple(up), tuple(reversed(down)), dies, returns)


class _End(NamedTuple):
    """What a run came to: its rippling, None if it could not go on; and the hole it leaves, if it ripples."""

    wave: Rippling | None
    hole: Survey | None


@dataclass(frozen=True)
class _Ramp:
    """Runs of a case at different values of a parameter."""

    case: Case
    name: str
    dogleg: float
    relative_tolerance: float

    def at(self, value: float) -> Case:
        """The case at a value of the parameter."""
        return vary(self.case, {self.name: value})

    def drill(self, value: float, hole: Survey | None) -> _End:
        """Drill at a value of the parameter in a hole; None: the straight one with the dogleg."""
        case = self.at(value)
        case = replace(case, survey=hole) if hole else with_dogleg(case, self.dogleg)
        try:
            run, wave = drill_until_steady(case, relative_tolerance=self.relative_tolerance)
        except Stopped:
            return _End(None, None)
        return _End(wave, _left_behind(run, case) if wave.ripples else None)

    def rippling_hole(self, value: float) -> Survey | None:
        """A hole with as small a dogleg as makes the system ripple at a value of the parameter; None if none does."""
        case = self.at(value)
        holes = (with_dogleg(case, LARGEST_DOGLEG / 2**k).survey for k in reversed(range(SCAN)))
        return next((hole for hole in holes if self.drill(value, hole).hole), None)

    def follow(self, low: float, high: float, hole: Survey, end: _End) -> tuple[Bracket | None, _End]:
        """Follow the ripple that left `hole` at `low` in shorter steps towards `high`, where at once it came to `end`.

        A ripple may survive a slow change that is too much for it at once. So wherever it does not survive a step, the
        step is halved, down to a hundredth of the parameter: between which two values it dies, None if it does not, and
        what it comes to at `high`.
        """
        step, here = high - low, high
        while step > END * here:
            step /= 2
            while low < high:
                here = min(low + step, high)
                found = self.drill(here, hole)
                if not found.hole:
                    break
                low, hole, end = here, found.hole, found if here == high else end
            else:
                return None, end
        return (low, here), end

    def bisect(self, low: float, high: float) -> Bracket:
        """Between which two values the dogleg starts a ripple, given one where it does and a larger one where not."""
        while high - low > END * high:
            middle = (low + high) / 2
            low, high = (middle, high) if self.drill(middle, None).hole else (low, middle)
        return low, high


def _left_behind(run: Trajectory, case: Case) -> Survey:
    """The drilled hole as a survey of chords, as far as the next run can feel it.

    It ends where the tilt was least: a run starts with the bit along the hole.
    """
    length, half = run["drilled_length"], case.bha.half_length
    recent = length >= length[-1] - 2 * half
    end = int(np.flatnonzero(recent)[np.argmin(np.abs(run["bit_tilt"][recent]))])
    first = int(np.searchsorted(length, length[end] - 3 * half))
    kept = slice(max(first, 0), end + 1)
    along = np.diff(run["displacement"][kept]), np.diff(run["true_vertical_depth"][kept])
    middles = (length[kept][1:] + length[kept][:-1]) / 2
    return Survey(tuple(middles.tolist()), tuple(np.arctan2(*along).tolist()))

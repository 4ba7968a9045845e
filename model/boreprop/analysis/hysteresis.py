"""Where a ripple dies out as weight or clearance is raised, and where it comes back as it is lowered."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import NamedTuple

import numpy as np

from ..case.case import Case
from ..core.checks import check_increasing, check_number, some_numbers
from ..core.options import RELATIVE_TOLERANCE
from ..core.survey import Survey
from ..run.trajectory import Stopped, Trajectory
from .rippling import Rippling
from .study.design import vary
from .tipping import LARGEST_DOGLEG, SCAN, drill_until_steady, with_dogleg

END = 0.01  # of the parameter: the ends of a loop are bracketed this closely; halving this costs a run or two more

Bracket = tuple[float, float]


@dataclass(frozen=True)
class Hysteresis:
    """How a system ripples while a parameter goes slowly up and down again.

    Parameters
    ----------
    name
        The parameter, see `vary`.
    values
        Its values in increasing order, in SI units.
    dogleg
        The turn, over half the length of the BHA, of the holes that are otherwise straight, rad.
    up, down
        The rippling at each of `values` on the way up and on the way down; None where a run could not go on.
    dies
        The two values between which the ripple dies out on the way up, within a hundredth of each other; None if it
        does not die out or never was there.
    returns
        The two values between which the dogleg brings the ripple back on the way down; at the larger one there is no
        ripple. None if it does not come back, or if there is a ripple at the largest value already.
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
    """Find how a system ripples while a parameter goes slowly up and down again.

    The way up starts from a ripple, in a hole with a dogleg that makes the case with the first value ripple, if there
    is such a dogleg. Each case then drills on, until it is steady, in the hole that the case before it drilled, turned
    back to the inclination of the case. If that one did not ripple, the hole is straight at that inclination, with the
    given dogleg before the bit: a perfectly straight vertical hole would stay straight for ever, but in the field the
    next survey, connection or formation makes it turn. On the way down all cases start in such a hole until one
    ripples. In an inclined hole a dogleg also changes the inclination, on which it depends whether a ripple lasts.

    Parameters
    ----------
    case
        What is drilled.
    name
        The parameter that changes, see `vary`: "eta_pi", say, or "stabilizer_clearance[1]".
    values
        Its values in increasing order, in SI units.
    dogleg
        The turn, over half the length of the BHA, of the holes that are otherwise straight, rad.
    relative_tolerance
        Error allowed in one step of the integrator, see `simulate`.
    progress
        Called with the number of values done; there are ``2 * len(values)``, those up and those down.

    Returns
    -------
    Hysteresis
        The rippling at each value, and the ends of the loop.

    Raises
    ------
    InputError, ParameterError
        If a name or a value is not accepted.

    Examples
    --------
    A dogleg of 0.5° does not start the ripple at ηΠ = 0.1, though a ripple that exists lasts there:

    >>> from math import radians
    >>> from boreprop import hysteresis, paper_case
    >>> found = hysteresis(paper_case(), "eta_pi", [0.1], radians(0.5))
    >>> [wave.ripples for wave in found.up], [wave.ripples for wave in found.down]
    ([True], [False])
    """
    values = some_numbers("values", values)
    check_increasing("values", values)
    check_number("dogleg", dogleg, at_least=-pi / 2, at_most=pi / 2)
    ramp = _Ramp(case, name, dogleg, relative_tolerance)
    for value in values:
        ramp.at(value)  # raises if the value is out of range, before any work is done
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
    """How a run ended: its rippling, None if it could not go on; and the hole that it drilled, None if it is smooth."""

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
        """Drill at a value of the parameter in a hole; None is the straight hole with the dogleg."""
        case = self.at(value)
        case = replace(case, survey=hole) if hole else with_dogleg(case, self.dogleg)
        try:
            run, wave = drill_until_steady(case, relative_tolerance=self.relative_tolerance)
        except Stopped:
            return _End(None, None)
        return _End(wave, self._drilled_hole(run, wave) if wave.ripples else None)

    def rippling_hole(self, value: float) -> Survey | None:
        """The hole with the smallest dogleg tried that makes the system ripple at a value; None if none does."""
        case = self.at(value)
        holes = (with_dogleg(case, LARGEST_DOGLEG / 2**k).survey for k in reversed(range(SCAN)))
        return next((hole for hole in holes if self.drill(value, hole).hole), None)

    def follow(self, low: float, high: float, hole: Survey, end: _End) -> tuple[Bracket | None, _End]:
        """Follow the ripple that drilled `hole` at `low` to `high` in shorter steps; in one step it ended as `end`.

        A ripple may survive a gradual change that it does not survive in one step. So wherever it dies in a step, the
        step is halved, down to a hundredth of the parameter. Returned are the two values between which it dies, None if
        it survives, and how it ends at `high`.
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
        """The two values between which the dogleg ceases to start a ripple: it does at `low` and does not at `high`."""
        while high - low > END * high:
            middle = (low + high) / 2
            low, high = (middle, high) if self.drill(middle, None).hole else (low, middle)
        return low, high

    def _drilled_hole(self, run: Trajectory, wave: Rippling) -> Survey:
        """The end of the drilled hole as a survey of the chords between its rows, as far up as the next BHA reaches.

        It ends where the bit tilt was smallest, since a run starts with the bit aligned with the hole. It is turned as
        a whole to swing about the inclination of the case: otherwise it would drop from run to run.
        """
        length, half = run["drilled_length"], self.case.bha.half_length
        swings_about = run["borehole_inclination"][length > length[-1] - wave.wavelength].mean()
        back = with_dogleg(self.case, 0.0).survey.inclination[-1] - swings_about
        recent = length >= length[-1] - 2 * half
        end = int(np.flatnonzero(recent)[np.argmin(np.abs(run["bit_tilt"][recent]))])
        first = int(np.searchsorted(length, length[end] - 3 * half))
        kept = slice(max(first, 0), end + 1)
        along = np.diff(run["displacement"][kept]), np.diff(run["true_vertical_depth"][kept])
        middles = (length[kept][1:] + length[kept][:-1]) / 2
        return Survey(tuple(middles.tolist()), tuple((np.arctan2(*along) + back).tolist()))

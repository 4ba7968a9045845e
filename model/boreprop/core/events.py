"""Where a trial step first meets a bound of its regime."""

from collections.abc import Callable
from math import sin
from typing import NamedTuple

from . import radau
from .hole import Hole
from .law import Bound, Law
from .modes import ROUNDING, side_beyond
from .step import Step, Trial

NEAR = 0.3  # how far beyond its values at the points of a step a value may lie between them, over the range of these: a
# bound farther away is not searched for. A parabola lies beyond them by an eighth of the range at most
CLOSE = 1e-12  # ℓ₁: an event is located when the places on both sides of it are this close, or the value is rounding
MOST_TRIES = 60  # to locate an event: plain bisection of the longest step would need 40


class Event(NamedTuple):
    """At `xi` the bound of `part` is met, on `side`: 1 above, −1 below."""

    xi: float
    part: int
    side: int


def first_event(law: Law, hole: Hole, trial: Trial, slack: float) -> Event | None:
    """The first event of a trial step, if it has any.

    A bound is met if the value lies beyond it by more than `slack` at a point of the step or an extreme between points.
    """
    first = None
    for bound in law.bounds:
        values = law.bounded_along(bound, trial.thetas, trial.Ys, trial.delayed, trial.sines, trial.aheads)
        low, high = min(values), max(values)
        near = NEAR * (high - low)
        if low - near >= bound.lower and high + near <= bound.upper:
            continue
        event = _meet(bound, value_along(law, bound, trial.step, hole), trial.step, values, slack)
        if event and event.xi < (first.xi if first else trial.step.end):
            first = event
    return first


def value_along(law: Law, bound: Bound, step: Step, hole: Hole) -> Callable[[float], float]:
    """The value that a bound is on, over ξ along a step."""

    def value(xi: float) -> float:
        theta, Y = step.state(xi)
        delayed = [hole.Y(xi - s_i) for s_i in law.s]
        return law.bounded_at(bound, xi, theta, Y, delayed, sin(Y - delayed[0]))

    return value


def _meet(bound: Bound, value: Callable[[float], float], step: Step, values: list[float], slack: float) -> Event | None:
    """Where a step first meets one bound, given its value over ξ, and at the points."""
    start = step.xi, value(step.xi)
    samples = [(step.xi + t * step.h, v) for t, v in zip(radau.POINTS, values)]
    # it may leave and come back between two points
    samples += [(xi, value(xi)) for xi in extremes([start, *samples]) if xi > samples[0][0]]
    samples.sort()
    before = step.xi  # where by rounding the value may lie beyond the bound that it has just come from
    for after, beyond in samples:
        side = side_beyond(beyond, bound.lower, bound.upper, slack)
        if side:
            return Event(_passed(bound, side, value, before, after, beyond), bound.part, side)
        before = after
    return None


def _passed(
    bound: Bound, side: int, value: Callable[[float], float], before: float, after: float, beyond: float
) -> float:
    """Where a bound is passed on `side` between two places, at the second of which the value is `beyond`."""
    limit = bound.upper if side > 0 else bound.lower
    return crossing(lambda xi: side * (value(xi) - limit), before, after, side * (beyond - limit))


def extremes(points: list[tuple[float, float]]) -> list[float]:
    """Where a smooth function through points (x, y), in order of x, has extremes: a parabola through each three."""
    found = []
    for (x0, y0), (x1, y1), (x2, y2) in zip(points, points[1:], points[2:]):
        slope, later = (y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1)
        if slope * later <= 0 and slope != later:
            found.append((x0 + x1) / 2 - slope * (x2 - x0) / 2 / (later - slope))
    return found


def crossing(f: Callable[[float], float], a: float, b: float, f_b: float) -> float:
    """Zero of `f` in [a, b], where f(a) <= 0 < f(b) = f_b, by regula falsi with the weights of Anderson and Björck."""
    f_a = f(a)
    if f_a >= 0:
        return a
    c = b
    for _ in range(MOST_TRIES):
        c = (a * f_b - b * f_a) / (f_b - f_a)
        f_c = f(c)
        if abs(f_c) < ROUNDING / 10 or abs(b - a) < CLOSE:
            break
        if (f_c > 0) == (f_b > 0):
            weight = 1 - f_c / f_b
            f_a *= weight if weight > 0 else 0.5
        else:
            a, f_a = b, f_b
        b, f_b = c, f_c
    return c

"""The spirals of a drilling system as curves: where they begin, how they go on, and where they end.

At a gap of zero all stabilizers are held, the equations are linear, and a spiral is a zero of a function of ω. From
there a curve of spirals goes to wider gaps, until μ = 0: that is the *edge*, where the gauge just touches the wall. The
curve may turn back on its way, so it is followed by its arc length (Keller 1977).
"""

from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import islice, pairwise
from math import log, pi

import numpy as np

from ...arrays import Floats
from ..stability.characteristic import SAMPLES, Characteristic
from .turning import GAP, LOG_ETA_PI, MU, OMEGA, THETA, THETA_ACROSS, Turning, tilt

Condition = Callable[[Floats], tuple[float, Floats]]
"""A further equation: its residual at x, and the slopes of that, shape (6,)."""

SCALES = np.array([5.0, 1.0, 1.0, 0.1, 0.3, 1.0])  # about how much the unknowns change along a curve
MOST_ITERATIONS = 20  # of Newton's method, which takes about five
CONVERGED = 1e-9  # of the scales: a step of Newton's method this small ends it, as the next would be rounding
BEYOND = 100.0  # |ln ηΠ| at which it has lost its way
FIRST, LONGEST, SHORTEST = 0.02, 0.2, 1e-5  # steps along a curve, in the scales
ASIDE = 0.5  # of a step: how far beside its tangent a curve may be, so that no other curve is taken for it
STRAIGHT = 0.9  # cosine of the angle by which a curve may turn in a step, unless it is shorter than …
KINK = 1e-3  # … this: it has a kink where a stabilizer comes off the wall
FINER = 4.0  # parts of a step in which a curve meets a condition, where Newton's method does not find it at once
MOST_PARTS = 40  # of such a step: a curve that turns back in it is longer
MOST_STEPS = 500  # along a curve; usual ones take fewer than a hundred
BARELY = 1.1  # times the gap at which stabilizers just do not touch: with it they do not
BLOCK = 8 * pi  # 1/s_n: the frequencies that are looked through first; then twice as many, and so on


def keep(index: int, value: float) -> Condition:
    """The condition that an unknown has a value."""
    unit = np.eye(6)[index]
    return lambda x: (x[index] - value, unit)


def at_limit(ratio: float) -> Condition:
    """The condition that the tilt is at its limit; `ratio` is ψ* over the largest clearance."""

    def condition(x: Floats) -> tuple[float, Floats]:
        slopes = np.zeros(6)
        slopes[[THETA, THETA_ACROSS, GAP]] = 2 * (x[THETA] - 1.0), 2 * x[THETA_ACROSS], -2 * ratio**2 * x[GAP]
        return tilt(x) ** 2 - (ratio * x[GAP]) ** 2, slopes

    return condition


def solve(turning: Turning, x: Floats, *conditions: Condition) -> Floats:
    """A spiral near x under two further conditions; `ArithmeticError` if Newton's method does not converge."""
    for _ in range(MOST_ITERATIONS):
        residual = turning.residual(x)
        further = [condition(x) for condition in conditions]
        value = np.append(residual.value, [each for each, _ in further])
        slopes = np.vstack([residual.slopes, *(slope for _, slope in further)]) * SCALES
        try:
            step = np.linalg.solve(slopes, value)
        except np.linalg.LinAlgError as error:
            raise ArithmeticError("the equations of a spiral are singular") from error
        x = x - SCALES * step
        if not abs(x[LOG_ETA_PI]) < BEYOND:
            break
        if abs(step).max() < CONVERGED:
            return x
    raise ArithmeticError("no spiral is found")


def beginning(turning: Turning, eta_pi: float, touching: tuple[int, ...]) -> Floats | None:
    """A spiral to the right, with the stiffest gauge, where the equations are nearly linear; None if there is none.

    All stabilizers are held (1 for each in `touching`) at a gap of zero; or, at a gap at which the others (0) just do
    not touch, the rest hardly move. The stiffest gauge is that which lasts to the largest ηΠ and the widest gaps. Other
    spirals turn several times faster; those of the paper's case are unstable. |F_0/ψ| falls as 1/ω, so the search ends.
    """
    held = turning.beam.characteristic(touching)
    spacing, best = 2 * pi / SAMPLES / held.s[-1], None
    start, end = 0.5 * spacing, BLOCK / held.s[-1]
    while True:
        for x in _beginnings(held, turning, eta_pi, np.arange(start, end + spacing, spacing), touching):
            if best is None or x[MU] > best[MU]:
                best = x
        at_end = 2 * (abs(held.f).sum() + abs(held.f_theta)) / end
        if at_end < eta_pi + (best[MU] if best is not None else 0.0):
            return best
        start, end = end, 2 * end


def _beginnings(
    held: Characteristic, turning: Turning, eta_pi: float, omega: Floats, touching: tuple[int, ...]
) -> Iterator[Floats]:
    """Such spirals with ω between the given ones, those with a gauge that pushes inwards."""
    p = 1j * omega
    B = -np.expm1(-np.multiply.outer(held.s, p)) / p
    bit = (held.m @ B) / (p * held.epsilon * eta_pi - held.m_theta)
    gauge = (held.f @ B + held.f_theta * bit) / (bit - 1.0) - eta_pi * turning.walk
    for k in np.flatnonzero((gauge.imag[1:] * gauge.imag[:-1] <= 0) & (gauge.real[1:] > 0)):
        x = np.array([omega[k], bit[k].real, bit[k].imag, gauge[k].real, 0.0, log(eta_pi)])
        x[GAP] = BARELY * turning.free_gap(x, np.array(touching, bool))
        with suppress(ArithmeticError):  # it was a pole
            x = solve(turning, x, keep(GAP, x[GAP]), keep(LOG_ETA_PI, log(eta_pi)))
            if x[MU] > 0 and abs(x[OMEGA] - omega[k]) < 2 * (omega[1] - omega[0]) + x[GAP]:
                yield x


def follow(
    turning: Turning, x: Floats, condition: Condition, index: int, side: float, longest: float = LONGEST
) -> Iterator[Floats]:
    """The points of a curve from x on, x the first: to larger values of an unknown (side 1) or smaller ones (−1).

    `longest` is the longest step, in the scales.
    """
    tangent = _tangent(turning, x, condition)
    tangent *= side * np.sign(tangent[index])
    length = min(FIRST, longest)
    yield x
    for _ in range(MOST_STEPS):
        ahead = x + length * SCALES * tangent
        try:
            y = solve(turning, ahead, condition, _across(tangent, ahead))
            turned = _tangent(turning, y, condition)
            turned *= np.sign(turned @ tangent)
        except ArithmeticError:
            y, turned = x, np.zeros(6)
        near = abs((y - ahead) / SCALES).max() < ASIDE * length
        if near and (turned @ tangent > STRAIGHT or length < KINK):
            x, tangent, length = y, turned, min(1.5 * length, longest)
            yield x
        elif length > SHORTEST:
            length /= 2
        else:
            return


def meet(turning: Turning, before: Floats, after: Floats, fixed: Condition, condition: Condition) -> Floats:
    """The point of a curve, between two of its points, at which the residual of a further condition changes sign."""
    (first, _), (last, _), way = condition(before), condition(after), after - before
    with suppress(ArithmeticError):
        near = before + first / (first - last) * way
        found = solve(turning, near, fixed, condition)
        if abs((found - near) / SCALES).max() < ASIDE * abs(way / SCALES).max():
            return found
    length, index = float(np.linalg.norm(way / SCALES)), int(abs(way / SCALES).argmax())
    if length > SHORTEST:
        for start, side in ((before, 1.0), (after, -1.0)):  # in between there may be a corner, where both ways end
            points = follow(turning, start, fixed, index, side * float(np.sign(way[index])), length / FINER)
            for low, high in pairwise(islice(points, MOST_PARTS)):
                if condition(low)[0] * condition(high)[0] <= 0:
                    return meet(turning, low, high, fixed, condition)
    raise ArithmeticError("the end of a curve of spirals is not found")


def _tangent(turning: Turning, x: Floats, condition: Condition) -> Floats:
    """The direction of a curve, in the scales, of length one."""
    slopes = np.vstack([turning.residual(x).slopes, condition(x)[1]]) * SCALES
    direction: Floats = np.linalg.svd(slopes)[2][-1]
    return direction


def _across(tangent: Floats, ahead: Floats) -> Condition:
    """The condition that a point is on the plane across a tangent at a point ahead."""
    return lambda x: (float(tangent @ ((x - ahead) / SCALES)), tangent / SCALES)

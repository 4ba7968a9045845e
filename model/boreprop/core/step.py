"""One step of the integrator: the state as polynomials, and the collocation that gives them."""

from math import cos, inf, perm, sin
from typing import NamedTuple

from . import radau
from .hole import Hole
from .law import Law, Sine
from .options import Options

GAUSS = [(0.5 - 0.15**0.5, 5 / 18), (0.5, 8 / 18), (0.5 + 0.15**0.5, 5 / 18)]  # nodes and weights on [0, 1]
REST = 0.03  # what may be neglected of sin⟨Θ⟩_1, in tolerances of θ: little beside the error that a step may have
LESS_REST = 0.003  # the same where kinks are many: steps that pass kinks leave no room for more
MIDDLE = 2  # the point next to the middle of a step
ITERATIONS = 10  # on what is neglected, at most; each gains two digits or more
RAMP_ITERATIONS = 20  # the same under a changing ηΠ; each gains a digit or more
NOT_FOUND = 2.0  # the least error of a trial whose iterations do not end: it is tried again, shorter

Pair = tuple[list[float], list[float]]  # of θ and of Y, at the points


class Step(NamedTuple):
    """A stretch [xi, end] of the run: the state as polynomials in t = (ξ − xi)/h, and the event at its end, if any."""

    xi: float
    h: float
    theta: tuple[float, ...]  # coefficients of t^0 … t^S
    Y: tuple[float, ...]
    end: float
    event: int | None = None  # the part whose bound is met at the end
    side: int = 0  # and on which side
    next_h: float = inf  # length planned for the next step

    @classmethod
    def standstill(cls, xi: float, theta: float, Y: float) -> "Step":
        """A step of length zero at the bit, so that a run can start or restart there."""
        rest = (0.0,) * radau.S
        return cls(xi, 1.0, (theta, *rest), (Y, *rest), xi)

    def state(self, xi: float) -> tuple[float, float]:
        """(θ, Y) at `xi`."""
        t = (xi - self.xi) / self.h
        a0, a1, a2, a3, a4, a5 = self.theta
        b0, b1, b2, b3, b4, b5 = self.Y
        theta = a0 + t * (a1 + t * (a2 + t * (a3 + t * (a4 + t * a5))))
        return theta, b0 + t * (b1 + t * (b2 + t * (b3 + t * (b4 + t * b5))))

    def derivative(self, order: int, xi: float) -> float:
        """A derivative of Y at `xi`."""
        t, value = (xi - self.xi) / self.h, 0.0
        for m in range(radau.S, order - 1, -1):
            value = value * t + perm(m, order) * self.Y[m]
        return value / self.h**order

    def displacement(self, xi: float) -> tuple[float, float]:
        """∫ sin Θ dξ and ∫ cos Θ dξ from the start of the step to `xi`."""
        _, c1, c2, c3, c4, c5 = self.Y
        length, x, z = xi - self.xi, 0.0, 0.0
        for node, weight in GAUSS:
            t = node * length / self.h
            Theta = (c1 + t * (2 * c2 + t * (3 * c3 + t * (4 * c4 + t * 5 * c5)))) / self.h
            x += weight * sin(Theta)
            z += weight * cos(Theta)
        return x * length, z * length


class Trial(NamedTuple):
    """A step as the collocation gives it, before events cut it. Lists run over `radau.POINTS`."""

    step: Step
    thetas: list[float]
    Ys: list[float]
    delayed: list[list[float]]  # Y(ξ − s_i), a list for each stabilizer
    sines: list[float]
    aheads: list[float]  # distance from where the law was made; none if the inputs do not change
    error: float  # estimated, over the tolerance


def try_step(
    law: Law,
    hole: Hole,
    xi: float,
    h: float,
    theta: float,
    Y: float,
    options: Options,
    many_kinks: bool = False,
    last: Step | None = None,
) -> Trial:
    """Collocation from (θ, Y) at `xi` over `h`, in the regime of `law`.

    This is one linear solve, but for sin⟨Θ⟩_1: its linear part belongs to the Jacobian. Where the rest counts, it is
    added to the right-hand side and the solve is repeated. That part is at the start of the step; after a last step, if
    it has a length, at the middle, if the step goes straight on from it: the sine is half as far from it.
    """
    delayed = [hole.look_up(xi - s_i, h, radau.POINTS) for s_i in law.s]
    average = Y - delayed[0][0]
    if last and last.end > last.xi:
        average = Y + last.derivative(1, last.end) * h * radau.POINTS[MIDDLE] - delayed[0][MIDDLE]
    sine = Sine(average, sin(average), cos(average))
    J = law.jacobian(sine)
    aheads = [xi - law.xi + t * h for t in radau.POINTS] if law.inputs.ramp else []
    if law.changes:
        return _try_ramp(law, J, Trial(Step(xi, h, (theta,), (Y,), xi + h), [], [], delayed, [], aheads, inf), options)
    frozen = sine.linear([Y - Y_1 for Y_1 in delayed[0]])
    allowed = (LESS_REST if many_kinks else REST) * options.relative_tolerance * (abs(law.theta_rate.theta) + 1 / h)
    for _ in range(ITERATIONS):
        f_theta, f_Y = law.frozen(theta, Y, delayed, frozen, aheads)
        parts_theta, parts_Y = radau.collocate(h, J, f_theta, f_Y)
        Ys = radau.values(Y, parts_Y)
        averages = [Y_t - Y_1 for Y_t, Y_1 in zip(Ys, delayed[0])]
        if sine.largest_error(averages) * abs(law.theta_rate.g) <= allowed:
            sines = sine.linear(averages)
            break
        assumed = [s + sine.slope * (Y_t - Y) for s, Y_t in zip(frozen, Ys)]
        sines = [sin(average) for average in averages]
        rest = [s - linear for s, linear in zip(sines, assumed)]
        if max(map(abs, rest)) * abs(law.theta_rate.g) <= allowed:
            break
        frozen = [s + r for s, r in zip(frozen, rest)]
    thetas = radau.values(theta, parts_theta)
    step = Step(xi, h, radau.coefficients(theta, parts_theta), radau.coefficients(Y, parts_Y), xi + h)
    error = _error(h, J, (f_theta, f_Y), (parts_theta, parts_Y), (thetas, Ys), (theta, Y), options)
    return Trial(step, thetas, Ys, delayed, sines, aheads, error)


def _error(
    h: float,
    J: radau.Jacobian,
    f: Pair,
    parts: tuple[radau.Parts, radau.Parts],
    values: Pair,
    start: tuple[float, float],
    options: Options,
) -> float:
    """The error of a trial over the tolerance, from the right-hand side with the state frozen at the start."""
    at, (parts_theta, parts_Y) = radau.AT_CHECK, parts
    moved_theta, moved_Y = values[0][at] - start[0], values[1][at] - start[1]
    error_theta, error_Y = radau.error(
        h,
        J,
        radau.slope(parts_theta) - h * (f[0][at] + J[0] * moved_theta + J[1] * moved_Y),
        radau.slope(parts_Y) - h * (f[1][at] + J[2] * moved_theta + J[3] * moved_Y),
    )
    return max(options.theta_weight * abs(error_theta), abs(error_Y)) / options.relative_tolerance


def _try_ramp(law: Law, J: radau.Jacobian, trial: Trial, options: Options) -> Trial:
    """A trial of a law that changes, given its place and the delayed hole.

    What the Jacobian, which is that at the start, neglects is added to the right-hand side until it is small. Where it
    does not become small, the error is made intolerable.
    """
    (xi, h, (theta,), (Y,), *_), delayed, aheads = trial.step, trial.delayed, trial.aheads
    thetas, Ys = [theta] * len(aheads), [Y] * len(aheads)
    sines = [sin(Y - Y_1) for Y_1 in delayed[0]]
    ratios = law.ratios_along(aheads)
    f_theta, f_Y = law.along(thetas, Ys, delayed, sines, aheads, ratios)
    allowed, found = REST * options.relative_tolerance, False
    for _ in range(RAMP_ITERATIONS):
        parts = parts_theta, parts_Y = radau.collocate(h, J, f_theta, f_Y)
        thetas, Ys = radau.values(theta, parts_theta), radau.values(Y, parts_Y)
        sines = [sin(Y_t - Y_1) for Y_t, Y_1 in zip(Ys, delayed[0])]
        rates, Thetas = law.along(thetas, Ys, delayed, sines, aheads, ratios)
        moved = [(theta_t - theta, Y_t - Y) for theta_t, Y_t in zip(thetas, Ys)]
        off_theta = [rate - f - J[0] * a - J[1] * b for rate, f, (a, b) in zip(rates, f_theta, moved)]
        off_Y = [Theta - f - J[2] * a - J[3] * b for Theta, f, (a, b) in zip(Thetas, f_Y, moved)]
        small = max(map(abs, off_theta)) <= allowed * (abs(law.theta_rate.theta) + 1 / h)
        found = small and max(map(abs, off_Y)) <= allowed / h
        if found:
            break
        f_theta = [f + off for f, off in zip(f_theta, off_theta)]
        f_Y = [f + off for f, off in zip(f_Y, off_Y)]
    error = _error(h, J, (f_theta, f_Y), parts, (thetas, Ys), (theta, Y), options)
    step = Step(xi, h, radau.coefficients(theta, parts_theta), radau.coefficients(Y, parts_Y), xi + h)
    return Trial(step, thetas, Ys, delayed, sines, aheads, error if found else max(error, NOT_FOUND))

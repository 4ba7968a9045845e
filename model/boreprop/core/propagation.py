"""The borehole propagation: the state (θ, Y) and the integrator that advances it.

Within a mode the right-hand side (`law`) is linear but for sin⟨Θ⟩_1, so one step is one linear solve of Radau
collocation (`radau`). A step ends where the solution is not smooth: on a change of input, on an event (contact or
saturation comes or goes), and where a stabilizer passes the kink that either left in the hole. The steps are the
integrator's own: the bit may stop anywhere.
"""

from bisect import insort
from collections.abc import Callable
from itertools import takewhile
from math import cos, factorial, inf, isfinite, perm, pi, sin
from typing import Any, NamedTuple

from . import radau
from .beam import Beam
from .hole import Drilled, Hole
from .law import Bound, Law
from .modes import ROUNDING, Loads, Mode, Modes, bit_tilt, change, left
from .survey import Survey
from .system import Scaled

RELATIVE_TOLERANCE = 1e-7

SMALLEST_STEP = 1e-12
LARGEST_STEP = 1.0  # ℓ₁: the shortest delay, so a step never needs a hole that is not yet drilled
LOOK_BACK = 1.0  # ℓ₁: how far behind the bit Θ may be asked for
LARGEST_GROWTH = 8.0
SAFETY = 0.85
THETA_WEIGHT = 0.1  # θ forgets an error within εηΠ, Y carries it for the length of the BHA
REST = 0.03  # what may be left of sin⟨Θ⟩_1 beyond its linear part, in tolerances of θ
ITERATIONS = 10  # on that rest; each gains two digits or more
LAYERS = 16.0  # first step after a kink, in relaxation lengths of θ
STRETCH = 1.3  # how much longer than planned a step may be if it then ends on the next kink
SMOOTHEST_KINK = 3  # jumps in higher derivatives of the hole are left to the error estimate
LARGEST_INCLINATION = 2 * pi
TURNS_OVER = (
    "its inclination grows beyond a full turn; use a smaller or shorter rss_force, a larger active_weight_on_bit, "
    "or check the parameters"
)
NEAR = 0.3  # how far beyond its values at the points of a step a value may lie between them, over their range
MERGE = 1e-9  # kinks closer than this are one
CLOSER = 8.0  # how much shorter a step is tried where each mode meets a bound before its first point,
MOST_SLACK = 1e-6  # while a value may lie so much farther beyond its bound at the points, at last by this
ORIGIN_LIMIT = 8.0  # |Y| beyond which the origin of Y is moved to the bit
MOST_PIECES = 2**19  # of hole, in one way to drill
GAUSS = [(0.5 - 0.15**0.5, 5 / 18), (0.5, 8 / 18), (0.5 + 0.15**0.5, 5 / 18)]  # nodes and weights on [0, 1]


class Step(NamedTuple):
    """A stretch [xi, end] of the run: the state as polynomials in t = (ξ − xi)/h, and why it ends."""

    xi: float
    h: float
    theta: tuple[float, ...]  # coefficients of t^0 … t^S
    Y: tuple[float, ...]
    end: float
    event: int | None = None  # the part whose bound is met at the end
    side: int = 0  # and on which side
    next_h: float = inf

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
    error: float  # estimated, over the tolerance


class Kink(NamedTuple):
    """At `xi` stabilizer `i` passes a jump of size `jump` in derivative `order` of the hole's Y."""

    xi: float
    order: int
    jump: float
    i: int


class Propagation:
    """The bit at the front of its hole, dimensionless: `drill` moves it, the rest looks.

    A change of input restarts the integrator where the bit is, and nothing else does: results do not depend on where
    the bit stops on the way.
    """

    def __init__(
        self,
        scaled: Scaled,
        survey: Survey,
        length_scale: float,
        F_rss: float,
        eta_pi: float,
        relative_tolerance: float = RELATIVE_TOLERANCE,
    ) -> None:
        self.scaled = scaled
        self.hole = Hole(survey, length_scale, scaled.s[-1] + LOOK_BACK)
        self.beam = Beam(scaled)
        self.modes = Modes(self.beam, scaled.y_star)
        self.length_scale, self.tolerance = length_scale, relative_tolerance
        self.xi = 0.0
        self.F_rss, self.eta_pi = F_rss, eta_pi
        self.contact: tuple[int, ...] = (0,) * len(scaled.y_star)
        self.tilt = 0
        self.path = (0.0, 0.0)  # ∫ sin Θ dξ, ∫ cos Θ dξ up to the start of the present step
        self.origin = 0.0  # of Y
        self.laws: dict[tuple[tuple[int, ...], int], Law] = {}  # by contact and tilt, under the present inputs
        self.kinks: list[Kink] = []  # those ahead, in order
        self.last_kink: tuple[float, int, float] = (-inf, 0, 0.0)  # at this ξ, in this derivative, of this size
        for kink, jump in self.hole.kinks:
            self._add_images(kink, 2, jump)
        self.step = self._standstill(self.hole.final_inclination, 0.0)
        self._restart(self.hole.final_inclination)

    # moving

    def drill(self, xi: float, F_rss: float, eta_pi: float) -> str | None:
        """Drill on to `xi` under inputs that act from where the bit is.

        None, or what went wrong and what helps; then nothing has changed.
        """
        inputs = F_rss, eta_pi
        if inputs == (self.F_rss, self.eta_pi) and xi <= self.step.end:
            self.xi = xi
            return None
        before = self.save()
        try:
            failure = self._drill(xi, F_rss, eta_pi)
        except (ArithmeticError, ValueError):  # what other languages call inf and nan
            failure = self._not_finite(self.step.end)
        if failure:
            self.restore(before)
        return failure

    def _drill(self, xi: float, F_rss: float, eta_pi: float) -> str | None:
        if (F_rss, eta_pi) != (self.F_rss, self.eta_pi):
            self._steer(F_rss, eta_pi)
        pieces = len(self.hole.starts)  # that there are, and that the kernel in C would keep for the way back
        while xi > self.step.end:
            pieces += 1
            if pieces + len(self.hole.starts) > MOST_PIECES:
                return f"step: must take at most {MOST_PIECES // 2} steps of the integrator, got more"
            failure = self._take_step()
            if failure:
                return failure
        self.xi = xi
        return None

    def advance(self, xi: float) -> str | None:
        """Drill on to `xi` under the inputs as they are, see `drill`."""
        return self.drill(xi, self.F_rss, self.eta_pi)

    def steer(self, F_rss: float, eta_pi: float) -> None:
        """Take over inputs where the bit is."""
        self.drill(self.xi, F_rss, eta_pi)

    def _steer(self, F_rss: float, eta_pi: float) -> None:
        before = self.inclination()
        self.F_rss, self.eta_pi = F_rss, eta_pi
        self._move_path(self.xi)
        self.step = self._standstill(*self.step.state(self.xi))
        self._restart(before)

    # looking

    def state(self) -> tuple[float, float]:
        """θ and Y (counted from the start of the run) at the bit."""
        theta, Y = self.step.state(self.xi)
        return theta, Y + self.origin

    def inclination(self) -> float:
        """Θ at the bit, eq. (16): algebraic, it jumps with the inputs."""
        return self._inclination(self.step.state(self.xi)[0], self.loads(), self.eta_pi)

    def earlier_inclination(self, xi: float) -> float:
        """What Θ was when the bit was at `xi`, at most LOOK_BACK behind; where it jumped, after the jump."""
        hole = self.hole
        k = hole.find(xi + MERGE)
        drilled = hole.drilled[k]
        if drilled is None:
            return hole.Theta(xi)
        xi = max(xi, hole.starts[k])
        theta = drilled.at((xi - hole.starts[k]) * hole.rates[k])
        return self._inclination(theta, self._loads(xi, theta, hole.Y(xi), drilled.F_rss), drilled.eta_pi)

    def _inclination(self, theta: float, loads: Loads, eta_pi: float) -> float:
        return theta - bit_tilt(self.settled(loads).F_0(loads), eta_pi, self.scaled.psi_star)

    def loads(self) -> Loads:
        """What bends the beam where the bit is."""
        return self._loads(self.xi, *self.step.state(self.xi), self.F_rss)

    def _loads(self, xi: float, theta: float, Y: float, F_rss: float) -> Loads:
        delayed = [self.hole.Y(xi - s_i) for s_i in self.scaled.s]
        e = [Y - Y_i - s_i * theta for Y_i, s_i in zip(delayed, self.scaled.s)]
        return Loads(e, F_rss, sin(Y - delayed[0]))

    def settled(self, loads: Loads) -> Mode:
        """The contacts under `loads`."""
        return self.modes.settle(loads, self.contact)

    def position(self) -> tuple[float, float]:
        """Position of the bit in the vertical plane, sideways and down, from the start of the run."""
        x, z = self.step.displacement(self.xi)
        return self.path[0] + x, self.path[1] + z

    # keeping

    def save(self) -> dict[str, Any]:
        """The whole evolving state; what it holds is never changed afterwards."""
        return {
            "xi": self.xi,
            "F_rss": self.F_rss,
            "eta_pi": self.eta_pi,
            "contact": self.contact,
            "tilt": self.tilt,
            "path": self.path,
            "origin": self.origin,
            "kinks": self.kinks[:],
            "last_kink": self.last_kink,
            "step": self.step,
            "hole": self.hole.save(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Go back to a state from `save`, also after a journey through JSON."""
        self.xi, self.origin, self.tilt = state["xi"], state["origin"], state["tilt"]
        self.F_rss, self.eta_pi = state["F_rss"], state["eta_pi"]
        self.contact, self.path = tuple(state["contact"]), (state["path"][0], state["path"][1])
        self.kinks = [Kink(*kink) for kink in state["kinks"]]
        xi, order, jump = state["last_kink"]
        self.last_kink = xi, order, jump
        xi, h, theta, Y, *rest = state["step"]
        self.step = Step(xi, h, tuple(theta), tuple(Y), *rest)
        self.hole.restore(state["hole"])
        self.laws = {}

    # the integrator

    def _standstill(self, theta: float, Y: float) -> Step:
        """A step of no length where the bit is."""
        rest = (0.0,) * radau.S
        return Step(self.xi, 1.0, (theta, *rest), (Y, *rest), self.xi)

    def _restart(self, Theta: float) -> None:
        """Find the mode under new inputs and mark the jump of the inclination, which was Θ, that they make.

        Raises `ArithmeticError` if numbers have run away.
        """
        self.laws = {}
        loads = self.loads()
        mode = self.settled(loads)
        F_0, psi_star = mode.F_0(loads), self.scaled.psi_star
        self.contact = mode.contact
        self.tilt = left(F_0 / self.eta_pi, -psi_star, psi_star)
        jump = abs(self.step.theta[0] - bit_tilt(F_0, self.eta_pi, psi_star) - Theta)
        if not (isfinite(jump) and isfinite(F_0)):
            raise ArithmeticError(self._not_finite(self.xi))
        self._add_images(self.xi, 1, jump)

    def _law(self) -> Law:
        key = (self.contact, self.tilt)
        if key not in self.laws:
            mode = self.modes[self.contact]
            self.laws[key] = Law(self.scaled, self.modes, mode, self.tilt, self.F_rss, self.eta_pi)
        return self.laws[key]

    def _switch(self, part: int, side: int) -> None:
        """Go to the mode on the other side of a bound."""
        if part < len(self.contact):
            contact = change(self.contact[part], side)
            self.contact = (*self.contact[:part], contact, *self.contact[part + 1 :])
        else:
            self.tilt = 0 if self.tilt else side

    def _move_path(self, xi: float) -> None:
        x, z = self.step.displacement(xi)
        self.path = (self.path[0] + x, self.path[1] + z)

    def _add_images(self, xi: float, order: int, jump: float) -> None:
        """Mark where the stabilizers will pass a jump in a derivative of the hole's Y at `xi`; there they add up."""
        if order > SMOOTHEST_KINK:
            return
        if (xi, order) == self.last_kink[:2]:  # the inputs change once more where the bit is
            earlier = self.last_kink[2]
            for i, s_i in enumerate(self.scaled.s):
                self.kinks.remove(Kink(xi + s_i, order, earlier, i))
            jump += earlier
        for i, s_i in enumerate(self.scaled.s):
            insort(self.kinks, Kink(xi + s_i, order, jump, i))
        self.last_kink = xi, order, jump

    def _kink_here(self, xi: float) -> int | None:
        """Take the kinks up to `xi` off the list; the lowest derivative of Y that those at `xi` make jump, if any."""
        near = max(MERGE, 2 * shortest_step(xi))  # half the way to a kink is no shorter than a step may be
        passed = list(takewhile(lambda kink: kink.xi - xi <= near, self.kinks))
        del self.kinks[: len(passed)]
        return min((kink.order + 1 for kink in passed if xi - kink.xi <= near), default=None)

    def _next_kink(self, law: Law, xi: float, h: float) -> float:
        """Where the next kink lies over which a step of length `h` must not pass; it may pass over slighter ones."""
        for kink in self.kinks:
            if kink.xi >= xi + h:
                break
            if law.gains[kink.i] * kink.jump * h ** (kink.order + 1) > self.tolerance * factorial(kink.order + 1):
                return kink.xi
        return inf

    def _leave(self, last: Step) -> tuple[float, float, int | None]:
        """Draw the consequences of how the last step ended: θ and Y there, and the order of a kink of Y, if any."""
        self._move_path(last.end)
        theta, Y = last.state(last.end)
        if abs(Y) > ORIGIN_LIMIT:
            self.hole.shift(Y)
            self.origin += Y
            Y = 0.0
        self.hole.forget(last.end - LOOK_BACK - self.scaled.s[-1])
        kink = self._kink_here(last.end)
        if last.event is not None:
            self._switch(last.event, last.side)
            kink = 2
        return theta, Y, kink

    def _take_step(self) -> str | None:
        """Append one step at the end of the last one; None, or why that failed and what helps.

        A bound that is met where the step starts switches the mode there. By the rates exactly one mode holds, but
        perhaps for a touch that is over before the first point of the step: then each mode finds itself beyond a bound
        there, and the step is tried shorter. At h → 0 the mode that holds shows. Where rounding hides it, a value may
        lie beyond its bound by a slack that grows as h falls; their product, what a wrong mode adds to the state, is
        the same each time.
        """
        last, xi, shortest = self.step, self.step.end, shortest_step(self.step.end)
        theta, Y, kink = self._leave(last)
        law = self._law()
        planned = resumed = last.next_h
        if (kink is not None and kink <= SMOOTHEST_KINK) or last.end == last.xi:
            planned = min(planned, LAYERS * law.relaxation)
            if last.event is not None:
                resumed = planned
        stretch, switches, slack = STRETCH, 0, ROUNDING
        while True:
            h = min(planned, LARGEST_STEP)
            to_kink = self._next_kink(law, xi, 2 * h) - xi
            if to_kink < 2 * h:
                h = to_kink if to_kink <= min(stretch * h, LARGEST_STEP) else to_kink / 2
            if h < shortest:
                return self._failed_at_tolerance("the steps of the integrator become too short", xi, "raise")
            trial = self._try(law, xi, h, theta, Y)
            if not isfinite(trial.error):
                return self._not_finite(xi)
            growth = SAFETY * max(trial.error, 1e-12) ** (-1 / (radau.S + 1))
            if trial.error > 1.0:
                planned = resumed = h * max(growth, 0.1)
                stretch = 1.0
                continue
            end, event, side = self._first_event(law, trial, slack)
            if event is None or end - xi >= shortest:
                break
            if switches < 2 * len(law.bounds):
                self._switch(event, side)
                law = self._law()
                switches += 1
                continue
            planned = max(h / CLOSER, shortest)
            stretch, switches, slack = 1.0, 0, slack * CLOSER
            if slack >= MOST_SLACK:
                return self._failed_at_tolerance("no contact mode holds", xi, "change")
        if h == to_kink and event is None:
            end = xi + to_kink
        next_h = max(resumed if h < resumed else 0.0, h * min(growth, LARGEST_GROWTH))
        turned, _ = trial.step.state(end)
        if not abs(turned) <= LARGEST_INCLINATION:
            return self._failed("the bit turns over", end, TURNS_OVER)
        self.step = Step(xi, h, trial.step.theta, trial.step.Y, end, event, side, next_h)
        self.hole.append(xi, h, self.step.Y, Drilled(self.step.theta, self.F_rss, self.eta_pi))
        if kink is not None:
            self._add_images(xi, kink, abs(self.step.derivative(kink, xi) - last.derivative(kink, xi)))
        return None

    def _try(self, law: Law, xi: float, h: float, theta: float, Y: float) -> Trial:
        """Collocation from (θ, Y) at `xi` over `h` in one mode."""
        delayed = [self.hole.look_up(xi - s_i, h, radau.POINTS) for s_i in self.scaled.s]
        rate, Theta = law.theta_rate, law.Theta
        # sin⟨Θ⟩_1 about a value near its start, ⟨Θ⟩_1 = Y(ξ) − Y(ξ−1); its part with Y belongs to the Jacobian
        near = Y - delayed[0][0]
        sine, cosine = sin(near), cos(near)
        J = (rate.theta, rate.Y + rate.g * cosine, Theta.theta, Theta.Y + Theta.g * cosine)
        held = [sine + cosine * (Y - Y_1 - near) for Y_1 in delayed[0]]
        allowed = REST * self.tolerance * (abs(rate.theta) + 1 / h)
        for _ in range(ITERATIONS):
            f_theta = rate.held(theta, Y, delayed, held)
            f_Y = Theta.held(theta, Y, delayed, held)
            parts_theta, parts_Y = radau.collocate(h, J, f_theta, f_Y)
            Ys = radau.values(Y, parts_Y)
            averages = [Y_t - Y_1 for Y_t, Y_1 in zip(Ys, delayed[0])]
            sines = [sine + cosine * (average - near) for average in averages]
            far = max(max(averages) - near, near - min(averages))
            if far * far / 2 * abs(rate.g) <= allowed:  # |sin(a + d) − sin a − d cos a| <= d²/2
                break
            assumed = [s + cosine * (Y_t - Y) for s, Y_t in zip(held, Ys)]
            sines = [sin(average) for average in averages]
            rest = [s - linear for s, linear in zip(sines, assumed)]
            if max(map(abs, rest)) * abs(rate.g) <= allowed:
                break
            held = [s + r for s, r in zip(held, rest)]
        thetas = radau.values(theta, parts_theta)
        at = radau.AT_CHECK
        moved_theta, moved_Y = thetas[at] - theta, Ys[at] - Y
        error_theta, error_Y = radau.error(
            h,
            J,
            radau.slope(parts_theta) - h * (f_theta[at] + J[0] * moved_theta + J[1] * moved_Y),
            radau.slope(parts_Y) - h * (f_Y[at] + J[2] * moved_theta + J[3] * moved_Y),
        )
        step = Step(xi, h, radau.coefficients(theta, parts_theta), radau.coefficients(Y, parts_Y), xi + h)
        error = max(THETA_WEIGHT * abs(error_theta), abs(error_Y)) / self.tolerance
        return Trial(step, thetas, Ys, delayed, sines, error)

    def _first_event(self, law: Law, trial: Trial, slack: float) -> tuple[float, int | None, int]:
        """Where a trial step first meets a bound of its mode, whose, and on which side; its end if it meets none.

        It meets those beyond which its points lie by more than `slack`.
        """
        step = trial.step
        first, event, first_side = step.xi + step.h, None, 0
        for bound in law.bounds:
            values = bound.value.along(trial.thetas, trial.Ys, trial.delayed, trial.sines)
            low, high = min(values), max(values)
            near = NEAR * (high - low)
            if low - near >= bound.lower and high + near <= bound.upper:
                continue
            met = self._meet(bound, step, values, slack)
            if met and met[0] < first:
                first, event, first_side = met[0], bound.part, met[1]
        return first, event, first_side

    def _meet(self, bound: Bound, step: Step, values: list[float], slack: float) -> tuple[float, int] | None:
        """Where a step first meets one bound, and on which side, given the bound's value at the points."""

        def value(xi: float) -> float:
            theta, Y = step.state(xi)
            delayed = [self.hole.Y(xi - s_i) for s_i in self.scaled.s]
            return bound.value.at(theta, Y, delayed, sin(Y - delayed[0]))

        start = step.xi, value(step.xi)
        known = [(step.xi + t * step.h, v) for t, v in zip(radau.POINTS, values)]
        # it may leave and come back between two points
        known += [(xi, value(xi)) for xi in extremes([start, *known]) if xi > known[0][0]]
        known.sort()
        before = step.xi  # where by rounding the value may lie beyond the bound that it has just come from
        for after, beyond in known:
            side = left(beyond, bound.lower, bound.upper, slack)
            if side:
                return self._crossing(value, bound, side, before, after, beyond), side
            before = after
        return None

    def _failed(self, what: str, xi: float, helps: str) -> str:
        """The line that says what the integrator has met at `xi`, and what helps."""
        return f"{what} at {xi * self.length_scale:.9g} m: {helps}"

    def _failed_at_tolerance(self, what: str, xi: float, helps: str) -> str:
        """The same where another tolerance helps."""
        return self._failed(what, xi, f"{helps} relative_tolerance (--tolerance), now {self.tolerance:g}")

    def _not_finite(self, xi: float) -> str:
        """The line that says that numbers have run away."""
        return self._failed("the state is not finite", xi, "check inputs and parameters")

    @staticmethod
    def _crossing(
        value: Callable[[float], float], bound: Bound, side: int, before: float, after: float, beyond: float
    ) -> float:
        """Where `value` leaves its bounds on `side` between two positions, the second with a value `beyond`."""
        limit = bound.upper if side > 0 else bound.lower
        return crossing(lambda xi: side * (value(xi) - limit), before, after, side * (beyond - limit))


def shortest_step(xi: float) -> float:
    """The shortest step at `xi`: the next position must differ."""
    return SMALLEST_STEP * max(1.0, xi)


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
    for _ in range(60):
        c = (a * f_b - b * f_a) / (f_b - f_a)
        f_c = f(c)
        if abs(f_c) < ROUNDING / 10 or abs(b - a) < SMALLEST_STEP:
            break
        if (f_c > 0) == (f_b > 0):
            weight = 1 - f_c / f_b
            f_a *= weight if weight > 0 else 0.5
        else:
            a, f_a = b, f_b
        b, f_b = c, f_c
    return c

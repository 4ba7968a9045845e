"""The integrator: it drills the hole of a law, step by step.

Within a regime the right-hand side (`law`) is linear but for sin⟨Θ⟩_1, so one step is one linear solve of collocation
(`step`, `radau`). A step ends where the solution is not smooth: on a change of input, on an event (`events`: contact
or saturation comes or goes), and where a stabilizer passes the kink that either left in the hole (`kinks`). The steps
are the integrator's own: the bit may stop anywhere.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import isfinite, pi, sin
from typing import Any

from .errors import CannotContinue
from .events import Event, first_event
from .hole import Drilled, Hole
from .inputs import Inputs
from .kinks import MERGE, Kinks
from .law import Law, Laws, bend
from .modes import Loads, Mode, Modes, Regime, bit_tilt, saturation
from .options import Options, Statistics
from .plan import CLOSER, LARGEST_GROWTH, Plan, first_plan, growth
from .problems import Problem
from .sensors import Reading, Sensed
from .step import Step, Trial, try_step
from .survey import Survey

LOOK_BACK = 1.0  # ℓ₁: how far behind the bit Θ may be asked for, as the curvature over the last ℓ₁ does
STRETCH = 1.3  # how much longer than planned a step may be to end on the next kink: one long step before two short ones
LARGEST_INCLINATION = 2 * pi  # beyond a full turn nothing is drilled
MOST_SLACK = 1e-6  # of that slack: what needs more is no touch that rounding hides
ORIGIN_LIMIT = 8.0  # |Y| beyond which the origin of Y is moved to the bit: rounding errors of Y stay below 1e-15


class Integrator:
    """The bit at the front of its hole, dimensionless: `drill` and `step` move it, other methods tell where it is.

    Only a change of input restarts the integrator, at the bit. So results do not depend on where the bit stops on the
    way.

    Parameters
    ----------
    modes
        The modes of the drilling system.
    survey
        The existing hole, in SI units.
    length_scale
        ℓ₁, m.
    F_rss, eta_pi
        The inputs at the start.
    options
        How the integrator takes its steps.

    Raises
    ------
    ParameterError
        If the stations of the survey are too close to each other.
    CannotContinue
        If there is no finite state to start from.
    """

    stay = 0.0  # where the bit may leave again the last layer that it has met, if it has met any

    def __init__(
        self,
        modes: Modes,
        survey: Survey,
        length_scale: float,
        F_rss: float,
        eta_pi: float,
        options: Options = Options(),  # noqa: B008 - frozen
    ) -> None:
        self.modes, self.scaled = modes, modes.scaled
        self.length_scale, self.options = length_scale, options
        self.hole = Hole(survey, length_scale, self.scaled.s[-1] + LOOK_BACK)
        self.xi = 0.0
        self.regime = modes.free()
        self.path = (0.0, 0.0)  # ∫ sin Θ dξ, ∫ cos Θ dξ up to the start of the present step
        self.origin = 0.0  # of Y
        self._accepted = self._rejected = self._events = 0
        self.cleared = 0.0  # where the stabilizers got the clearances that they have
        self.kinks = Kinks(self.scaled.s)
        for kink, jump in self.hole.kinks:
            self.kinks.add_images(kink, 2, jump)
        theta = self.hole.final_inclination
        self.present = Step.standstill(0.0, theta, 0.0)  # the step that the bit is in
        inputs = Inputs(F_rss, eta_pi, self.scaled.epsilon * eta_pi, self.scaled.psi_star)
        self.readings = [Reading() for _ in self.scaled.sensors]
        self._restart(self._loads(0.0, theta, 0.0, F_rss), inputs, theta)
        self._read(0.0)

    # moving

    def drill(self, xi: float, inputs: Inputs) -> None:
        """Drill on to `xi` under inputs that act from where the bit is.

        Raises `CannotContinue` if that fails; then nothing has changed.
        """
        way = xi - self.xi
        changed = not self.inputs_here().same(inputs, way if way > 0.0 else 1.0)
        if changed or xi > self.present.end:
            with self._all_or_nothing():
                if changed:
                    self._steer(inputs)
                self._take_steps(xi)
        self.xi = xi
        self._read(xi)

    def change_clearances(self, y_star: tuple[float, ...]) -> None:
        """Let the stabilizers have other clearances from where the bit is; errors as in `drill`."""
        with self._all_or_nothing():
            loads, (theta, Y), inputs = self.loads(), self.present.state(self.xi), self.inputs_here()
            Theta = self._inclination(theta, loads, inputs)
            self.path = self.position()
            self.present = Step.standstill(self.xi, theta, Y)
            self._clear(y_star, self.xi)
            self._restart(loads, inputs, Theta)

    def _clear(self, y_star: tuple[float, ...], xi: float) -> None:
        self.cleared, self.kinks.many = xi, self.kinks.many or xi > 0.0
        if y_star != self.scaled.y_star:
            self.scaled = replace(self.scaled, y_star=y_star)
            self.modes = Modes(self.scaled)

    def advance(self, xi: float) -> None:
        """Drill on to `xi` under the inputs as they are, see `drill`."""
        self.drill(xi, self.inputs_here())

    def steer(self, F_rss: float, eta_pi: float) -> None:
        """Take over other inputs where the bit is, see `drill`; bit and rock stay."""
        here = self.inputs_here()
        self.drill(self.xi, Inputs(F_rss, eta_pi, here.epsilon * eta_pi, here.psi_star))

    def step(self) -> Step:
        """Drill on to the end of the integrator's next step, and return that step; errors as in `drill`."""
        with self._all_or_nothing():
            self._take_step()
        self.xi = self.present.end
        self._read(self.xi)
        return self.present

    @contextmanager
    def _all_or_nothing(self) -> Iterator[None]:
        """Go back to the state before if the block fails."""
        before = self.save()
        try:
            yield
        except CannotContinue:
            self.restore(before)
            raise
        except (ArithmeticError, ValueError) as error:  # Python raises where C goes on with inf and nan
            failure = self._failure("not finite", self.present.end)
            self.restore(before)
            raise failure from error

    def _take_steps(self, xi: float) -> None:
        last = self._accepted + self.options.most_steps
        while xi > self.present.end:
            self._check_way(xi, last)
            self._take_step()

    def _read(self, xi: float) -> None:
        """Let each sensor take the last reading that is due with the bit at `xi`, in the present step."""
        for i, sensor in enumerate(self.scaled.sensors):
            if sensor.interval and (number := sensor.due(xi)) > self.readings[i].number:
                inclination = self.sensed(sensor.s, min(number * sensor.interval, xi)).inclination
                self.readings[i] = Reading(number, sensor.reads(inclination, i, number))

    def _check_way(self, xi: float, last: int) -> None:
        """Raise unless so many steps at most may lead to `xi`."""
        most = self.options.most_steps
        if xi - self.xi > most * self.options.largest_step or self._accepted == last:
            raise CannotContinue(Problem("too many", limit=most, place=self.xi * self.length_scale))

    def _steer(self, inputs: Inputs) -> None:
        """Take over inputs where the bit is. Where a slope or ε changes, the curvature jumps."""
        loads, (theta, Y), before = self.loads(), self.present.state(self.xi), self.inputs_here()
        Theta = self._inclination(theta, loads, before)
        self.path = self.position()
        self.present = Step.standstill(self.xi, theta, Y)
        self.kinks.many |= self.xi > 0.0 and inputs.changes_law(before)
        loads = loads._replace(F_rss=inputs.F_rss)
        self._restart(loads, inputs, Theta)
        bent = bend(self._law, self.modes[self.regime.contact], loads, before, inputs)
        if not isfinite(bent):
            raise self._failure("not finite", self.xi)
        if bent:
            self.kinks.add_images(self.xi, 2, abs(bent))

    # looking

    def inputs_here(self) -> Inputs:
        """The inputs where the bit is."""
        return self.inputs.ahead(self.xi - self.inputs_xi)

    @property
    def F_rss(self) -> float:
        """The steering force where the bit is."""
        return self.inputs_here().F_rss

    @property
    def eta_pi(self) -> float:
        """ηΠ where the bit is."""
        return self.inputs_here().eta_pi

    def state(self) -> tuple[float, float]:
        """θ and Y (counted from the start of the run) at the bit."""
        theta, Y = self.present.state(self.xi)
        return theta, Y + self.origin

    def inclination(self) -> float:
        """Θ at the bit, eq. (16): algebraic, it jumps with the inputs."""
        return self._inclination(self.present.state(self.xi)[0], self.loads(), self.inputs_here())

    def earlier_inclination(self, xi: float) -> float:
        """Θ as it was when the bit was at `xi`, at most LOOK_BACK behind; where Θ jumped, its value after the jump."""
        hole = self.hole
        k = hole.find(xi + MERGE)
        drilled = hole.drilled[k]
        if drilled is None or xi + MERGE < self.cleared:  # with other clearances its law was another
            return hole.Theta(xi)
        xi = max(xi, hole.starts[k])
        theta = drilled.at((xi - hole.starts[k]) * hole.rates[k])
        inputs = drilled.inputs.ahead(xi - hole.starts[k])
        return self._inclination(theta, self._loads(xi, theta, hole.Y(xi), inputs.F_rss), inputs)

    def _inclination(self, theta: float, loads: Loads, inputs: Inputs) -> float:
        return theta - bit_tilt(self.settled(loads).F_0(loads), inputs.eta_pi, inputs.psi_star)

    def loads(self) -> Loads:
        """What bends the beam where the bit is."""
        return self._loads(self.xi, *self.present.state(self.xi), self.F_rss)

    def _loads(self, xi: float, theta: float, Y: float, F_rss: float) -> Loads:
        delayed = [self.hole.Y(xi - s_i) for s_i in self.scaled.s]
        e = [Y - Y_i - s_i * theta for Y_i, s_i in zip(delayed, self.scaled.s)]
        return Loads(e, F_rss, sin(Y - delayed[0]))

    def sensed(self, s: float, xi: float) -> Sensed:
        """The BHA at `s` behind the bit while that is at `xi`, in the present step."""
        theta, Y = self.present.state(xi)
        loads = self._loads(xi, theta, Y, self.inputs.ahead(xi - self.inputs_xi).F_rss)
        v, slope, moment = self.settled(loads).line(self.modes.beam, s, loads)
        return Sensed(theta - slope, Y - self.hole.Y(xi - s) - s * theta + v, moment)

    def settled(self, loads: Loads) -> Mode:
        """The mode whose contacts hold under `loads`."""
        return self.modes.settle(loads, self.regime.contact)

    @property
    def statistics(self) -> Statistics:
        """What the integrator has done since the start of the run."""
        return Statistics(self._accepted, self._rejected, self._events)

    def position(self) -> tuple[float, float]:
        """Position of the bit in the vertical plane, sideways and down, from the start of the run."""
        return self._path_to(self.xi)

    def _path_to(self, xi: float) -> tuple[float, float]:
        x, z = self.present.displacement(xi)
        return self.path[0] + x, self.path[1] + z

    # keeping

    def save(self) -> dict[str, Any]:
        """The whole evolving state. Drilling on does not change what is saved."""
        return {
            "xi": self.xi,
            "inputs": self.inputs,
            "inputs_xi": self.inputs_xi,
            "regime": self.regime,
            "path": self.path,
            "origin": self.origin,
            "clearances": (self.scaled.y_star, self.cleared),
            "statistics": self.statistics,
            "kinks": self.kinks.save(),
            "step": self.present,
            "hole": self.hole.save(),
            "readings": self.readings[:],
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Go back to a state from `save`, also after a journey through JSON."""
        self.xi, self.origin = state["xi"], state["origin"]
        self.path = (state["path"][0], state["path"][1])
        y_star, cleared = state["clearances"]
        self._clear(tuple(y_star), cleared)
        self._accepted, self._rejected, self._events = state["statistics"]
        self.kinks.restore(state["kinks"])
        xi, h, theta, Y, *rest = state["step"]
        self.present = Step(xi, h, tuple(theta), tuple(Y), *rest)
        self.hole.restore(state["hole"])
        self.readings = [Reading(*reading) for reading in state["readings"]]
        self._take_over(Inputs(*state["inputs"]), state["inputs_xi"])
        contact, side = state["regime"]
        self._change_regime(Regime(tuple(contact), side))

    # stepping

    def _take_over(self, inputs: Inputs, xi: float) -> None:
        self.inputs, self.inputs_xi = inputs, xi
        self._laws = Laws(self.modes, inputs, xi)

    def _restart(self, loads: Loads, inputs: Inputs, Theta: float) -> None:
        """Take over inputs, find the regime under them, and mark the jump of the inclination, which was Θ so far."""
        self._take_over(inputs, self.xi)
        mode, psi_star = self.settled(loads), inputs.psi_star
        F_0 = mode.F_0(loads)
        jump = abs(self.present.theta[0] - bit_tilt(F_0, self.eta_pi, psi_star) - Theta)
        if not (isfinite(jump) and isfinite(F_0)):
            raise self._failure("not finite", self.xi)
        self._change_regime(Regime(mode.contact, saturation(F_0, self.eta_pi, psi_star)))
        self.kinks.add_images(self.xi, 1, jump)

    def _change_regime(self, regime: Regime) -> None:
        self.regime, self._law = regime, self._laws[regime]

    def _leave(self, last: Step) -> tuple[float, float, int | None]:
        """Go over the end of the last step, with its event: gives θ, Y and the order of the kink of Y there, if any."""
        self.path = self._path_to(last.end)
        theta, Y = last.state(last.end)
        if abs(Y) > ORIGIN_LIMIT:
            self.hole.shift(Y)
            self.origin += Y
            Y = 0.0
        self.hole.forget(last.end - LOOK_BACK - self.scaled.s[-1])
        kink = self.kinks.kink_here(last.end, self.options.shortest_step(last.end))
        if last.event is not None:
            self._change_regime(self.regime.switch(last.event, last.side))
            self._events += 1
            kink = 2  # over a bound Y' is continuous, Y'' is not
        return theta, Y, kink

    def _take_step(self) -> None:
        """Append one step at the end of the last one."""
        last, xi = self.present, self.present.end
        self._read(xi)
        theta, Y, kink = self._leave(last)
        inputs = self.inputs.ahead(xi - self.inputs_xi)
        if inputs.law_changes:  # each step has laws of its own
            self._laws = Laws(self.modes, inputs, xi)
            self._change_regime(self.regime)
        plan = first_plan(last, kink, self.options.layers * self._law.relaxation, self.kinks.many)
        trial, event = self._find_step(plan, xi, theta, Y)
        _, h, thetas, Ys, end, *_ = trial.step
        next_h = h * min(growth(trial.error), LARGEST_GROWTH)
        if h < plan.resumed:
            next_h = max(next_h, plan.resumed)
        end, part, side = event or (end, None, 0)
        self.present = step = Step(xi, h, thetas, Ys, end, part, side, next_h)
        if not abs(step.state(step.end)[0]) <= LARGEST_INCLINATION:
            raise self._failure("turns over", step.end)
        self.hole.append(xi, h, step.Y, Drilled(step.theta, inputs))
        if kink is not None:
            self.kinks.add_images(xi, kink, abs(step.derivative(kink, xi) - last.derivative(kink, xi)))
        self._accepted += 1

    def _find_step(self, plan: Plan, xi: float, theta: float, Y: float) -> tuple[Trial, Event | None]:
        """The first trial of a step whose error is tolerable and whose regime holds beyond its start; its first event.

        A bound that is met where the step starts switches the regime there. By the rates exactly one regime holds, but
        perhaps for a touch that is over before the first point of the step: then each regime finds itself beyond a
        bound there, and the step is tried shorter. At h → 0 the regime that holds shows. Where rounding hides it, a
        value may lie beyond its bound by a slack that grows as h falls; their product, what a wrong regime adds to the
        state, is the same each time.
        """
        shortest, last = self.options.shortest_step(xi), self.present if self.stay else None
        while True:
            law = self._law
            h = self._choose_length(law, plan, xi)
            if h < shortest:
                raise self._failure("too short", xi)
            trial = try_step(law, self.hole, xi, h, theta, Y, self.options, self.kinks.many, last)
            if not isfinite(trial.error):
                raise self._failure("not finite", xi)
            if trial.error > 1.0:
                plan.shorten(h, trial.error)
                self._rejected += 1
                continue
            event = first_event(law, self.hole, trial, plan.slack)
            if event is None or event.xi - xi >= shortest:
                return trial, event
            if plan.switches < 2 * len(law.bounds):
                self._change_regime(self.regime.switch(event.part, event.side))
                plan.switches += 1
                continue
            plan.look_closer(max(h / CLOSER, shortest))
            if plan.slack >= MOST_SLACK:
                raise self._failure("no mode", xi)

    def _choose_length(self, law: Law, plan: Plan, xi: float) -> float:
        """Length of the next trial: as planned, but no kink lies within it, and none is left a short step ahead."""
        largest = min(self.options.largest_step, law.longest)
        h, to_kink = self.kinks.reach(xi, min(plan.h, largest), law.gains, self.options)
        longest = h if plan.repeated else min(STRETCH * h, largest)
        return h if to_kink >= 2 * h else to_kink if to_kink <= longest else to_kink / 2

    def _failure(self, code: str, xi: float) -> CannotContinue:
        return CannotContinue(Problem(code, limit=self.options.relative_tolerance, place=xi * self.length_scale))

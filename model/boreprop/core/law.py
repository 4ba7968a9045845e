"""The planar law: the right-hand side of the propagation, regime by regime.

    εηΠ θ' = M ,   Y' = Θ = θ − ψ ,   ψ = clip(F_0/(ηΠ), −ψ*, ψ*)                                      (16), (17)

with M and F_0 from the beam in the hole it drilled, e_i = Y(ξ) − Y(ξ−s_i) − s_i θ. Within a regime (which stabilizers
touch which wall, tilt saturated or not) only sin⟨Θ⟩_1 is not linear.
"""

from math import inf
from typing import NamedTuple

from .inputs import SAME, Inputs
from .linear import dot, ratio, total
from .modes import Loads, Mode, Modes, Regime, Row
from .radau import Jacobian

LONGEST_RAMP = 0.1  # by which share ηΠ, χΠ or ψ* changes within a step, at most: it then takes about six iterations

Ratios = tuple[list[float], list[float]]  # of M/χΠ and of F_0/(ηΠ), at the points


class Linear(NamedTuple):
    """A `Row` under given inputs, on the state.

    It is theta θ + Y Y + Σ_i delayed[i] Y(ξ−s_i) + g sin⟨Θ⟩_1 + constant + slope (ξ − ξ of the inputs).
    """

    theta: float
    Y: float
    delayed: tuple[float, ...]
    g: float
    constant: float
    slope: float = 0.0

    @classmethod
    def of(cls, row: Row, s: tuple[float, ...], inputs: Inputs, scale: float) -> "Linear":
        """`scale` times `row`, with e_i = Y − Y(ξ−s_i) − s_i θ put in."""
        return cls(
            theta=-scale * dot(row.e, s),
            Y=scale * total(row.e),
            delayed=tuple(-scale * c for c in row.e),
            g=scale * row.g,
            constant=scale * (row.rss * inputs.F_rss + row.constant),
            slope=scale * row.rss * inputs.F_rss_slope,
        )

    def at(self, theta: float, Y: float, delayed: list[float], sine: float, ahead: float) -> float:
        """Value at one point, `ahead` of where the inputs are those that it was made under."""
        value = self.theta * theta + self.Y * Y + self.g * sine + self.constant + self.slope * ahead
        for c, Y_i in zip(self.delayed, delayed):
            value += c * Y_i
        return value

    def frozen(
        self, theta: float, Y: float, delayed: list[list[float]], sines: list[float], aheads: list[float]
    ) -> list[float]:
        """Values along a step with (θ, Y) frozen; `delayed` has one list for each stabilizer."""
        state, g, c = self.theta * theta + self.Y * Y + self.constant, self.g, self.delayed[0]
        return self._add_others([state + g * sine + c * Y_1 for sine, Y_1 in zip(sines, delayed[0])], delayed, aheads)

    def along(
        self,
        thetas: list[float],
        Ys: list[float],
        delayed: list[list[float]],
        sines: list[float],
        aheads: list[float],
    ) -> list[float]:
        """Values along a step; `delayed` has one list for each stabilizer."""
        a, b, c, g, constant = self.theta, self.Y, self.delayed[0], self.g, self.constant
        points = zip(thetas, Ys, delayed[0], sines)
        return self._add_others(
            [constant + a * theta + b * Y + c * Y_1 + g * sine for theta, Y, Y_1, sine in points], delayed, aheads
        )

    def _add_others(self, values: list[float], delayed: list[list[float]], aheads: list[float]) -> list[float]:
        """Add the parts of stabilizers 2 … n, and that of a force which changes along the step."""
        for c, Y_i in zip(self.delayed[1:], delayed[1:]):
            if c:
                values = [value + c * y for value, y in zip(values, Y_i)]
        if self.slope:
            values = [value + self.slope * ahead for value, ahead in zip(values, aheads)]
        return values


class Sine(NamedTuple):
    """sin⟨Θ⟩_1 about its value at one place of a step, where ⟨Θ⟩_1 = Y(ξ) − Y(ξ−1) is `average`."""

    average: float
    value: float
    slope: float

    def linear(self, averages: list[float]) -> list[float]:
        """Its linear part, at values of ⟨Θ⟩_1."""
        at, value, slope = self
        return [value + slope * (average - at) for average in averages]

    def largest_error(self, averages: list[float]) -> float:
        """A bound on what the linear part neglects: |sin(a + d) − sin a − d cos a| <= d²/2."""
        at = self.average
        far = max(max(averages) - at, at - min(averages))
        return far * far / 2


class Bound(NamedTuple):
    """A `modes.Bound` under given inputs: `value` lies between `lower` and `upper` while the regime holds."""

    part: int
    value: Linear
    lower: float
    upper: float


class Law:
    """The right-hand side in one regime, and the bounds within which it holds, under inputs as they are at `xi`."""

    def __init__(self, modes: Modes, regime: Regime, inputs: Inputs, xi: float) -> None:
        mode, eta_pi = modes[regime.contact], inputs.eta_pi
        self.s = modes.scaled.s  # the delays
        self.xi, self.inputs = xi, inputs  # where it is made; the inputs there
        self.changes = inputs.law_changes  # along the way
        self.longest = LONGEST_RAMP / inputs.growth if self.changes else inf  # step of a law that changes
        self.bounds = [
            Bound(bound.part, Linear.of(bound.row, self.s, inputs, bound.scale), bound.lower, bound.upper)
            for bound in regime.bounds(modes, eta_pi, inputs.psi_star)
        ]
        psi = self.bounds[0].value  # without saturation
        self.saturation, self._tilt = regime.saturation, self.bounds[0].part
        self.theta_rate = Linear.of(mode.M, self.s, inputs, ratio(1, inputs.chi_pi))
        if regime.saturation:
            side, nothing = regime.saturation, (0.0,) * len(self.s)
            self.Theta = Linear(1.0, 0.0, nothing, 0.0, -side * inputs.psi_star, -side * inputs.psi_star_slope)
        else:
            less = tuple(-c for c in psi.delayed)
            self.Theta = Linear(1.0 - psi.theta, -psi.Y, less, -psi.g, -psi.constant, -psi.slope)
        self.relaxation = ratio(1, abs(self.theta_rate.theta + self.Theta.Y))  # length over which θ forgets
        # per change of Y(ξ−s_i) the change of Θ, once θ has followed, or that of a bounded value if it is larger
        self.gains = [
            max(abs(ratio(a, self.theta_rate.theta)) + abs(b), *(abs(bound.value.delayed[i]) for bound in self.bounds))
            for i, (a, b) in enumerate(zip(self.theta_rate.delayed, self.Theta.delayed))
        ]
        self.gains[0] += abs(ratio(self.theta_rate.g, self.theta_rate.theta)) + abs(self.Theta.g)

    def jacobian(self, sine: Sine) -> Jacobian:
        """∂(θ', Y')/∂(θ, Y), row by row."""
        rate, Theta = self.theta_rate, self.Theta
        return (rate.theta, rate.Y + rate.g * sine.slope, Theta.theta, Theta.Y + Theta.g * sine.slope)

    def frozen(
        self, theta: float, Y: float, delayed: list[list[float]], sines: list[float], aheads: list[float]
    ) -> tuple[list[float], list[float]]:
        """θ' and Y' along a step with (θ, Y) frozen at its start, of a law that does not change."""
        rates = self.theta_rate.frozen(theta, Y, delayed, sines, aheads)
        return rates, self.Theta.frozen(theta, Y, delayed, sines, aheads)

    def along(
        self,
        thetas: list[float],
        Ys: list[float],
        delayed: list[list[float]],
        sines: list[float],
        aheads: list[float],
        ratios: Ratios,
    ) -> tuple[list[float], list[float]]:
        """θ' and Y' along a step of a law that changes."""
        rates = self.theta_rate.along(thetas, Ys, delayed, sines, aheads)
        Thetas = self.Theta.along(thetas, Ys, delayed, sines, aheads)
        rates = [rate * p for rate, p in zip(rates, ratios[0])]
        return rates, [theta + p * (Theta - theta) for theta, Theta, p in zip(thetas, Thetas, ratios[1])]

    def ratios_along(self, aheads: list[float]) -> Ratios:
        """Of a law that changes, by what M/χΠ and F_0/(ηΠ) as under its inputs are multiplied along a step."""
        own = self.inputs
        eta = [1.0 if self.saturation else own.eta_pi / own.eta_pi_at(ahead) for ahead in aheads]
        return [own.chi_pi / own.chi_pi_at(ahead) for ahead in aheads], eta

    def tilt_ratio(self, ahead: float) -> float:
        """By what F_0/(ηΠ), as under the inputs of a law that changes, is multiplied a length `ahead` of there.

        It is then bounded there as well by the ψ* of these inputs: it is their ηΠψ* over that ahead.
        """
        own = self.inputs
        return own.eta_pi * own.psi_star / (own.eta_pi_at(ahead) * own.psi_star_at(ahead))

    def _is_on_ramp(self, bound: Bound) -> bool:
        """Whether a bounded value is to be multiplied by that."""
        return self.changes and bound.part == self._tilt

    def bounded_at(self, bound: Bound, xi: float, theta: float, Y: float, delayed: list[float], sine: float) -> float:
        """The value that a bound is on, at one place."""
        value = bound.value.at(theta, Y, delayed, sine, xi - self.xi)
        return value * self.tilt_ratio(xi - self.xi) if self._is_on_ramp(bound) else value

    def bounded_along(
        self,
        bound: Bound,
        thetas: list[float],
        Ys: list[float],
        delayed: list[list[float]],
        sines: list[float],
        aheads: list[float],
    ) -> list[float]:
        """The value that a bound is on, along a step."""
        values = bound.value.along(thetas, Ys, delayed, sines, aheads)
        if self._is_on_ramp(bound):
            values = [value * self.tilt_ratio(ahead) for value, ahead in zip(values, aheads)]
        return values


class Laws:
    """The laws of one drilling system under inputs as they are at `xi`, each made when it is first asked for."""

    def __init__(self, modes: Modes, inputs: Inputs, xi: float) -> None:
        self._modes, self._inputs, self._xi = modes, inputs, xi
        self._made: dict[Regime, Law] = {}

    def __getitem__(self, regime: Regime) -> Law:
        if regime not in self._made:
            self._made[regime] = Law(self._modes, regime, self._inputs, self._xi)
        return self._made[regime]


def bend(law: Law, mode: Mode, loads: Loads, before: Inputs, inputs: Inputs) -> float:
    """The jump of Θ' = θ' − ψ' where a slope of the inputs, or ε, changes; `law` is that beyond it."""
    jump = 0.0
    if abs(inputs.epsilon - before.epsilon) > SAME * before.epsilon:  # θ' = M/(εηΠ)
        jump = law.Theta.theta * mode.M(loads) / inputs.eta_pi * (1 / inputs.epsilon - 1 / before.epsilon)
    force, stiffness = inputs.F_rss_slope - before.F_rss_slope, inputs.eta_pi_slope - before.eta_pi_slope
    if law.saturation:
        jump -= law.saturation * (inputs.psi_star_slope - before.psi_star_slope)
    elif force or stiffness:  # (F_0/ηΠ)' = (F_0' − ψ ηΠ')/ηΠ
        psi = mode.F_0(loads) / inputs.eta_pi
        jump -= (force * mode.F_0.rss - stiffness * psi) / inputs.eta_pi
    return jump

"""The right-hand side of the propagation, mode by mode, as a linear function of the state and the delayed hole.

    εηΠ θ' = M ,   Y' = Θ = θ − ψ ,   ψ = clip(F_0/(ηΠ), −ψ*, ψ*)                                      (16), (17)

with M and F_0 from the beam in the hole it drilled, e_i = Y(ξ) − Y(ξ−s_i) − s_i θ. Within a mode (which stabilizers
touch which wall, tilt saturated or not) only sin⟨Θ⟩_1 is not linear.
"""

from math import inf
from typing import NamedTuple

from .linear import dot, ratio, total
from .modes import Mode, Modes, Row
from .system import Scaled


class Linear(NamedTuple):
    """A `Row` under given inputs, on the state: theta θ + Y Y + Σ_i delayed[i] Y(ξ−s_i) + g sin⟨Θ⟩_1 + one."""

    theta: float
    Y: float
    delayed: tuple[float, ...]
    g: float
    one: float

    @classmethod
    def of(cls, row: Row, s: tuple[float, ...], F_rss: float, scale: float) -> "Linear":
        """`scale` times `row`, with e_i = Y − Y(ξ−s_i) − s_i θ put in."""
        return cls(
            theta=-scale * dot(row.e, s),
            Y=scale * total(row.e),
            delayed=tuple(-scale * c for c in row.e),
            g=scale * row.g,
            one=scale * (row.rss * F_rss + row.one),
        )

    def at(self, theta: float, Y: float, delayed: list[float], sine: float) -> float:
        """Value at one point."""
        value = self.theta * theta + self.Y * Y + self.g * sine + self.one
        for c, Y_i in zip(self.delayed, delayed):
            value += c * Y_i
        return value

    def held(self, theta: float, Y: float, delayed: list[list[float]], sines: list[float]) -> list[float]:
        """Values along a step with (θ, Y) held; `delayed` has one list for each stabilizer."""
        state, g, c = self.theta * theta + self.Y * Y + self.one, self.g, self.delayed[0]
        return self._add_others([state + g * sine + c * Y_1 for sine, Y_1 in zip(sines, delayed[0])], delayed)

    def along(
        self, thetas: list[float], Ys: list[float], delayed: list[list[float]], sines: list[float]
    ) -> list[float]:
        """Values along a step; `delayed` has one list for each stabilizer."""
        a, b, c, g, one = self.theta, self.Y, self.delayed[0], self.g, self.one
        points = zip(thetas, Ys, delayed[0], sines)
        return self._add_others(
            [one + a * theta + b * Y + c * Y_1 + g * sine for theta, Y, Y_1, sine in points], delayed
        )

    def _add_others(self, values: list[float], delayed: list[list[float]]) -> list[float]:
        """Add the parts of stabilizers 2 … n."""
        for c, Y_i in zip(self.delayed[1:], delayed[1:]):
            if c:
                values = [value + c * y for value, y in zip(values, Y_i)]
        return values


class Bound(NamedTuple):
    """What stays between `lower` and `upper` while a mode holds: of stabilizer `part`, or of the tilt (part n−1)."""

    part: int
    value: Linear
    lower: float
    upper: float


class Law:
    """The right-hand side in one mode under given inputs, and the bounds within which it holds."""

    def __init__(self, scaled: Scaled, modes: Modes, mode: Mode, tilt: int, F_rss: float, eta_pi: float) -> None:
        s, psi_star, contacts = scaled.s, scaled.psi_star, len(mode.contact)
        psi = Linear.of(mode.F_0, s, F_rss, 1 / eta_pi)
        self.theta_rate = Linear.of(mode.M, s, F_rss, ratio(1, scaled.epsilon * eta_pi))
        if tilt:
            self.Theta = Linear(1.0, 0.0, (0.0,) * len(s), 0.0, -tilt * psi_star)
        else:
            self.Theta = Linear(1.0 - psi.theta, -psi.Y, tuple(-c for c in psi.delayed), -psi.g, -psi.one)
        self.relaxation = ratio(1, abs(self.theta_rate.theta + self.Theta.Y))
        tilt_bounds = {0: (-psi_star, psi_star), 1: (psi_star, inf), -1: (-inf, -psi_star)}
        self.bounds = [Bound(contacts, psi, *tilt_bounds[tilt])]
        for i in range(contacts):
            row, lower, upper = modes.bounds(mode, i)
            if (lower, upper) != (-inf, inf):
                self.bounds.append(Bound(i, Linear.of(row, s, F_rss, 1.0), lower, upper))
        # change per change of Y(ξ−s_i): of Θ, θ having settled, or of what the bounds are on
        self.gains = [
            max(abs(ratio(a, self.theta_rate.theta)) + abs(b), *(abs(bound.value.delayed[i]) for bound in self.bounds))
            for i, (a, b) in enumerate(zip(self.theta_rate.delayed, self.Theta.delayed))
        ]
        self.gains[0] += abs(ratio(self.theta_rate.g, self.theta_rate.theta)) + abs(self.Theta.g)

"""The two nonlinearities: stabilizers that touch the wall or not, and a bit tilt that saturates.

With the contacts known (a mode), F follows from q̃ by elimination, so M, F_0, δ and F are linear functions of the hole,
the RSS force and the weight. A regime is a mode and the saturation of the tilt: which one holds is found by pivoting
from the last one. It solves the paper's linear complementarity problem (15), which `analysis.complementarity` states
as matrices.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf
from typing import NamedTuple

from .beam import Beam, Line
from .linear import dot, inverse
from .system import Scaled

ROUNDING = 1e-13  # how far a force or deflection of order one may lie beyond its bound by rounding alone
MOST_PIVOTS = 3**5  # contacts at five stabilizers: a search that takes more pivots goes in circles
LOOSER = 8.0  # factor on it for the next search: about a digit, so that hardly more is allowed than needed

Contact = tuple[int, ...]
"""For each non-ideal stabilizer 1 at the lower wall, −1 at the upper wall, 0 free."""


class Loads(NamedTuple):
    """What bends the beam besides the contacts: offsets e_1 … e_n, F_RSS and sin⟨Θ⟩_1."""

    e: list[float]
    F_rss: float
    sin_Theta_1: float


@dataclass(frozen=True)
class Row:
    """A linear function of the loads: e · e_i + rss · F_RSS + g · sin⟨Θ⟩_1 + constant."""

    e: list[float]
    rss: float
    g: float
    constant: float = 0.0

    def __call__(self, loads: Loads) -> float:
        """Value under `loads`."""
        return dot(self.e, loads.e) + self.rss * loads.F_rss + self.g * loads.sin_Theta_1 + self.constant

    def plus(self, factors: list[float], rows: "list[Row]") -> "Row":
        """Add a sum of factors times rows."""
        return Row(
            [own + dot(factors, [row.e[i] for row in rows]) for i, own in enumerate(self.e)],
            self.rss + dot(factors, [row.rss for row in rows]),
            self.g + dot(factors, [row.g for row in rows]),
            self.constant + dot(factors, [row.constant for row in rows]),
        )


class Bound(NamedTuple):
    """A part of a regime stays as it is while scale · row lies between `lower` and `upper`.

    Stabilizer i is part i − 1, the tilt of the bit the last part, n − 1.
    """

    part: int
    row: Row
    scale: float
    lower: float
    upper: float


class Mode:
    """The beam with a known contact at each non-ideal stabilizer: 1 lower wall, −1 upper wall, 0 free.

    In contact δ_i = −contact_i y*_i, so F_C = −K_C (q̃_C + contact_C y*_C) with K_C = (K⁻¹_CC)⁻¹, and F = 0 elsewhere.
    """

    def __init__(self, beam: Beam, y_star: tuple[float, ...], contact: Contact) -> None:
        n = len(beam.s)
        self.contact = contact
        q = [
            Row([(j == i) + (j == n - 1) * beam.delta_e[i] for j in range(n)], beam.delta_rss[i], beam.delta_g[i])
            for i in range(n - 1)
        ]
        zero = Row([0.0] * n, 0.0, 0.0)
        C = [i for i in range(n - 1) if contact[i]]
        K_C = inverse([[beam.K_inv[i][j] for j in C] for i in C])
        to_wall = [Row(q[i].e, q[i].rss, q[i].g, contact[i] * y_star[i]) for i in C]
        self.F = [zero] * (n - 1)
        for row, i in zip(K_C, C, strict=True):
            self.F[i] = zero.plus([-k for k in row], to_wall)
        e_n = [0.0] * (n - 1) + [1.0]
        self.delta = [q[i].plus(beam.K_inv[i], self.F) for i in range(n - 1)]
        self.M = Row([beam.M_e * c for c in e_n], beam.M_rss, beam.M_g).plus(beam.M_F, self.F)
        self.F_0 = Row([beam.F0_e * c for c in e_n], beam.F0_rss, beam.F0_g).plus(beam.F0_F, self.F)
        self.bounds = [self._bound(i, y) for i, y in enumerate(y_star) if y]

    def line(self, beam: Beam, s: float, loads: Loads) -> Line:
        """The beam of this mode at `s` under `loads`."""
        F = [row(loads) for row in self.F]
        return beam.line(s, self.M(loads), self.F_0(loads), F, loads.F_rss, loads.sin_Theta_1)

    def _bound(self, i: int, y_star: float) -> Bound:
        """While it touches a wall, F_i keeps its sign; while it is free, δ_i stays within the clearance, (7).

        A stabilizer without clearance is held on both sides and has no bound.
        """
        if self.contact[i]:
            return Bound(i, self.F[i], 1.0, *((0.0, inf) if self.contact[i] > 0 else (-inf, 0.0)))
        return Bound(i, self.delta[i], 1.0, -y_star, y_star)


class Modes:
    """The modes of one drilling system, each made when it is first asked for."""

    def __init__(self, scaled: Scaled) -> None:
        self.scaled, self.beam = scaled, Beam(scaled)
        self._made: dict[Contact, Mode] = {}

    def __getitem__(self, contact: Contact) -> Mode:
        if contact not in self._made:
            self._made[contact] = Mode(self.beam, self.scaled.y_star, contact)
        return self._made[contact]

    def touching(self, contact: Contact) -> Contact:
        """`contact`, with the stabilizers that have no clearance touching."""
        if all(self.scaled.y_star):
            return contact
        return tuple(c if y else 1 for c, y in zip(contact, self.scaled.y_star, strict=True))

    def free(self) -> "Regime":
        """The regime in which no more stabilizers touch than must, and the tilt is not saturated."""
        return Regime(self.touching((0,) * len(self.scaled.y_star)), 0)

    def settle(self, loads: Loads, contact: Contact) -> Mode:
        """The mode whose contacts satisfy (7) under `loads`, starting the search from `contact`.

        The tilt has no part in that, since the contacts do not depend on it.
        """
        start = Regime(self.touching(contact), 0)
        return self[start.settle(lambda regime: (self[regime.contact].bounds, loads)).contact]


class Regime(NamedTuple):
    """The contacts, and the saturation of the bit tilt: 1 at ψ*, −1 at −ψ*, 0 between."""

    contact: Contact
    saturation: int

    def bounds(self, modes: Modes, eta_pi: float, psi_star: float) -> list[Bound]:
        """The bounds within which this regime holds: of ψ = F_0/(ηΠ), (11), then of the stabilizers, (7)."""
        mode = modes[self.contact]
        lower, upper = {0: (-psi_star, psi_star), 1: (psi_star, inf), -1: (-inf, -psi_star)}[self.saturation]
        return [Bound(len(self.contact), mode.F_0, 1 / eta_pi, lower, upper), *mode.bounds]

    def switch(self, part: int, side: int) -> "Regime":
        """The regime beyond the bound of `part` on `side`.

        A touching stabilizer comes free, a free one touches at δ = ±y*; the tilt comes to its limit, or leaves it.
        """
        if part == len(self.contact):
            return Regime(self.contact, 0 if self.saturation else side)
        contact = 0 if self.contact[part] else -side
        return Regime((*self.contact[:part], contact, *self.contact[part + 1 :]), self.saturation)

    def settle(self, problem: "Callable[[Regime], tuple[Iterable[Bound], Loads]]") -> "Regime":
        """The regime that is within its bounds under its loads, starting the search from this one.

        `problem` gives both for any regime. Least-index pivoting: switch the first part that is beyond its bound, until
        none is. K is positive definite, so no regime comes back and the search ends (Murty 1974; Júdice & Pires 1992
        for two walls). Where one does come back, by rounding under huge loads or of stabilizers close together, parts
        may lie beyond their bounds by more and more until a regime is within them: at last by any amount.
        """
        regime, slack, pivots = self, ROUNDING, 0
        while True:
            bounds, loads = problem(regime)
            for part, row, scale, lower, upper in bounds:
                side = side_beyond(scale * row(loads), lower, upper, slack)
                if side:
                    regime = regime.switch(part, side)
                    break
            else:
                return regime
            pivots += 1
            if pivots % MOST_PIVOTS == 0:
                slack *= LOOSER


def side_beyond(value: float, lower: float, upper: float, slack: float = ROUNDING) -> int:
    """1 if `value` is above its bounds by more than `slack`, −1 if below, else 0."""
    return 1 if value > upper + slack else -1 if value < lower - slack else 0


def wall(F: float) -> int:
    """The wall that bears a stabilizer with the force F: 1 the lower, −1 the upper, 0 none."""
    return 1 if F > 0 else -1 if F < 0 else 0


def bit_tilt(F_0: float, eta_pi: float, psi_star: float) -> float:
    """ψ = clip(F_0/(ηΠ), −ψ*, ψ*), eqs. (10) and (11)."""
    return min(max(F_0 / eta_pi, -psi_star), psi_star)


def saturation(F_0: float, eta_pi: float, psi_star: float) -> int:
    """1 where ψ is at its limit ψ*, −1 at −ψ*, 0 between, eq. (11)."""
    return side_beyond(F_0 / eta_pi, -psi_star, psi_star)

"""The two nonlinearities: stabilizers that touch the wall or not, and a bit tilt that saturates.

Two ways to the same answer. The paper's linear complementarity problem (15) as matrices, with a residual;
and, for the integrator, modes: with the contacts known, F follows from q̃ by elimination, so M, F_0, δ and F are linear
functions of the hole, the RSS force and the weight, and which contacts hold is found by pivoting from the last mode.
"""

from dataclasses import dataclass
from math import inf

from .beam import Beam
from .linear import dot, inverse


@dataclass(frozen=True)
class Loads:
    """What bends the beam besides the contacts: offsets e_1 … e_n, F_RSS and sin⟨Θ⟩_1."""

    e: list[float]
    F_rss: float
    sin_Theta_1: float


@dataclass(frozen=True)
class Row:
    """A linear function of the loads: e · e_i + rss · F_RSS + g · sin⟨Θ⟩_1 + one."""

    e: list[float]
    rss: float
    g: float
    one: float = 0.0

    def __call__(self, loads: Loads) -> float:
        """Value under `loads`."""
        return dot(self.e, loads.e) + self.rss * loads.F_rss + self.g * loads.sin_Theta_1 + self.one

    def plus(self, factors: list[float], rows: "list[Row]") -> "Row":
        """Add a sum of factors times rows."""
        return Row(
            [own + dot(factors, [row.e[i] for row in rows]) for i, own in enumerate(self.e)],
            self.rss + dot(factors, [row.rss for row in rows]),
            self.g + dot(factors, [row.g for row in rows]),
            self.one + dot(factors, [row.one for row in rows]),
        )


class Mode:
    """The beam with a known contact at each non-ideal stabilizer: 1 lower wall, −1 upper wall, 0 free.

    In contact δ_i = −contact_i y*_i, so F_C = −K_C (q̃_C + contact_C y*_C) with K_C = (K⁻¹_CC)⁻¹, and F = 0 elsewhere.
    """

    def __init__(self, beam: Beam, y_star: tuple[float, ...], contact: tuple[int, ...]) -> None:
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


class Modes:
    """The modes of one beam, made when first asked for."""

    def __init__(self, beam: Beam, y_star: tuple[float, ...]) -> None:
        self.beam, self.y_star = beam, y_star
        self._made: dict[tuple[int, ...], Mode] = {}

    def __getitem__(self, contact: tuple[int, ...]) -> Mode:
        if contact not in self._made:
            self._made[contact] = Mode(self.beam, self.y_star, contact)
        return self._made[contact]

    def bounds(self, mode: Mode, i: int) -> tuple[Row, float, float]:
        """What must lie between two bounds for stabilizer `i` to stay as it is in `mode`: F_i in contact, else δ_i.

        Without clearance the stabilizer is held on both sides and nothing can change.
        """
        if self.y_star[i] == 0.0:
            return mode.F[i], -inf, inf
        if mode.contact[i]:
            return mode.F[i], *((0.0, inf) if mode.contact[i] > 0 else (-inf, 0.0))
        return mode.delta[i], -self.y_star[i], self.y_star[i]

    def settle(self, loads: Loads, contact: tuple[int, ...]) -> Mode:
        """The mode that satisfies (7) under `loads`, starting the search from `contact`.

        Least-index pivoting: change the first stabilizer whose condition fails, until none does. K is positive
        definite, so no set of contacts comes back and the search ends (Murty 1974; Júdice & Pires 1992 for two walls).
        Where one does come back, by rounding under huge loads or of stabilizers close together, conditions may fail by
        more and more until a mode satisfies them: at last by any amount.
        """
        contact = tuple(c if y else 1 for c, y in zip(contact, self.y_star, strict=True))
        slack, pivots = ROUNDING, 0
        while True:
            mode = self[contact]
            for i in range(len(contact)):
                row, lower, upper = self.bounds(mode, i)
                side = left(row(loads), lower, upper, slack)
                if side:
                    contact = (*contact[:i], change(contact[i], side), *contact[i + 1 :])
                    break
            else:
                return mode
            pivots += 1
            if pivots % MOST_PIVOTS == 0:
                slack *= LOOSER


ROUNDING = 1e-13  # how far a force or deflection of order one may lie beyond its bound by rounding alone
MOST_PIVOTS = 243  # there are no more modes: three contacts at each of five stabilizers
LOOSER = 8.0  # how much farther it may lie there in the next search


def left(value: float, lower: float, upper: float, slack: float = ROUNDING) -> int:
    """1 if `value` is above its bounds by more than `slack`, −1 if below, else 0."""
    return 1 if value > upper + slack else -1 if value < lower - slack else 0


def change(contact: int, side: int) -> int:
    """The contact after leaving the bounds on `side`: a touching stabilizer comes free, a free one touches δ = ±y*."""
    return 0 if contact else -side


def wall(F: float) -> int:
    """The wall that bears a stabilizer with the force F: 1 the lower, −1 the upper, 0 none."""
    return 1 if F > 0 else -1 if F < 0 else 0


def bit_tilt(F_0: float, eta_pi: float, psi_star: float) -> float:
    """ψ = clip(F_0/(ηΠ), −ψ*, ψ*), eqs. (10) and (11)."""
    return min(max(F_0 / eta_pi, -psi_star), psi_star)

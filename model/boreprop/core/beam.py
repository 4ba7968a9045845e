"""The BHA as an Euler–Bernoulli beam in the hole behind the bit: clamped to the bit, hinged at the last stabilizer.

Everything here is dimensionless. What bends the beam are the offsets

    e_i = Σ_{k≤i} λ_k (⟨Θ⟩_k − θ) = Y(ξ) − Y(ξ−s_i) − s_i θ ,        i = 1 … n,

of the bit's own axis from the hole axis at the stabilizers, the RSS force, the weight, and the contact forces. The
sums over ⟨Θ⟩_k − θ in (14), (17) and (21) depend on these offsets only, so the coefficients below belong to e_i.
"""

from typing import NamedTuple

from .linear import dot
from .system import Scaled


def flexibility(s: float, p: float, lambda_: float) -> float:
    """Deflection at `s` under a unit force at `p`, eq. (20); symmetric in s and p."""
    if s < p:
        s, p = p, s
    return p * p / (4 * lambda_**3) * (2 * lambda_**3 * (3 * s - p) + (p - 3 * lambda_) * s * s * (3 * lambda_ - s))


def end_offset_deflection(s: float, lambda_: float) -> float:
    """Deflection at `s` under a unit offset e_n of the last stabilizer: ζ_k(s)/λ_k of eq. (21)."""
    return s * s * (s - 3 * lambda_) / (2 * lambda_**3)


def weight_deflection(s: float, w: float, lambda_: float) -> float:
    """Deflection at `s` under the weight, per sin⟨Θ⟩_1: ζ_{n+2}(s) of eq. (21)."""
    return w / 16 * s * s * (2 * s - 3 * lambda_) * (lambda_ - s)


def force_moment(p: float, lambda_: float) -> float:
    """Moment M at the bit under a unit force at `p`: (23b) and (23c) times εηΠ."""
    return p * (p - lambda_) * (2 * lambda_ - p) / (2 * lambda_ * lambda_)


def force_reaction(p: float, lambda_: float) -> float:
    """Lateral force F_0 at the bit under a unit force at `p`: (24b) and (24c)."""
    return -(2 * lambda_**3 - 3 * lambda_ * p * p + p**3) / (2 * lambda_**3)


class Line(NamedTuple):
    """The beam at a place, from the bit's axis: its distance, the slope of that, and the bending moment."""

    v: float
    slope: float
    moment: float


class Beam:
    """M, F_0 and δ of one BHA as linear functions of e, F, F_RSS and sin⟨Θ⟩_1.

    With n stabilizers and i, j = 1 … n−1:

        δ_i = e_i + delta_e[i] e_n + Σ_j K_inv[i][j] F_j + delta_rss[i] F_RSS + delta_g[i] sin⟨Θ⟩_1      (5), (21)
        M   =       M_e e_n        + Σ_j M_F[j] F_j      + M_rss F_RSS        + M_g sin⟨Θ⟩_1             (17), (23)
        F_0 =       F0_e e_n       + Σ_j F0_F[j] F_j     + F0_rss F_RSS       + F0_g sin⟨Θ⟩_1            (14), (24)

    where M = −M_0 is the moment that turns the bit, εηΠ θ' = M.
    """

    def __init__(self, scaled: Scaled) -> None:
        s, Delta, w = scaled.s[:-1], scaled.Delta, scaled.w
        lambda_ = scaled.s[-1]
        self.s, self.Delta, self.w, self.lambda_ = scaled.s, Delta, w, lambda_
        self.K_inv = [[flexibility(s_i, s_j, lambda_) for s_j in s] for s_i in s]
        self.delta_e = [end_offset_deflection(s_i, lambda_) for s_i in s]
        self.delta_rss = [flexibility(s_i, Delta, lambda_) for s_i in s]
        self.delta_g = [weight_deflection(s_i, w, lambda_) for s_i in s]
        self.M_e = 1 / (lambda_ * lambda_)
        self.M_F = [force_moment(s_i, lambda_) for s_i in s]
        self.M_rss = force_moment(Delta, lambda_)
        self.M_g = w * lambda_ * lambda_ / 8
        self.F0_e = 1 / lambda_**3
        self.F0_F = [force_reaction(s_i, lambda_) for s_i in s]
        self.F0_rss = force_reaction(Delta, lambda_)
        self.F0_g = 5 / 8 * w * lambda_

    def q_tilde(self, e: list[float], F_rss: float, sin_Theta_1: float) -> list[float]:
        """q̃_i, the deflection without contact forces, eq. (21)."""
        return [
            e[i] + self.delta_e[i] * e[-1] + self.delta_rss[i] * F_rss + self.delta_g[i] * sin_Theta_1
            for i in range(len(e) - 1)
        ]

    def bit_moment(self, e_n: float, F: list[float], F_rss: float, sin_Theta_1: float) -> float:
        """M = −M_0, the moment that turns the bit, eq. (17)."""
        contact = dot(self.M_F, F)
        return self.M_e * e_n + contact + self.M_rss * F_rss + self.M_g * sin_Theta_1

    def bit_force(self, e_n: float, F: list[float], F_rss: float, sin_Theta_1: float) -> float:
        """F_0, the lateral force on the bit, eq. (14)."""
        contact = dot(self.F0_F, F)
        return self.F0_e * e_n + contact + self.F0_rss * F_rss + self.F0_g * sin_Theta_1

    def shape(self, s: float, e_n: float, F: list[float], F_rss: float, sin_Theta_1: float) -> float:
        """Deflection of the BHA axis at `s` from the bit's axis, 0 <= s <= λ, positive to the high side.

        The deflection from the *hole* axis, eq. (5), is this plus e(s) = Y(ξ) − Y(ξ−s) − s θ.
        """
        contact = dot([flexibility(s, s_j, self.lambda_) for s_j in self.s[:-1]], F)
        return (
            end_offset_deflection(s, self.lambda_) * e_n
            + contact
            + flexibility(s, self.Delta, self.lambda_) * F_rss
            + weight_deflection(s, self.w, self.lambda_) * sin_Theta_1
        )

    def line(self, s: float, M: float, F_0: float, F: list[float], F_rss: float, sin_Theta_1: float) -> Line:
        """The beam at `s`, 0 <= s <= λ, from the bit on: v'' = 3 m, m'' = −w sin⟨Θ⟩_1 and the forces, m(0) = −M."""
        v = -M * s * s / 2 + F_0 * s**3 / 6 - self.w * sin_Theta_1 * s**4 / 24
        slope = -M * s + F_0 * s * s / 2 - self.w * sin_Theta_1 * s**3 / 6
        moment = -M + F_0 * s - self.w * sin_Theta_1 * s * s / 2
        for p, force in zip((self.Delta, *self.s), (F_rss, *F)):  # noqa: B905 - nothing pushes the last stabilizer
            above = max(s - p, 0.0)
            v += force * above**3 / 6
            slope += force * above * above / 2
            moment += force * above
        return Line(3 * v, 3 * slope, moment)

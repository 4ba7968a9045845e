"""The linearised equations of a mode, derived anew, as a determinant and as a Chebyshev pseudospectral matrix.

Everything starts from the averages ⟨Θ⟩_i: with d_k = ⟨Θ⟩_k − θ,

    q̃_i = Σ_{k≤i} λ_k d_k + Σ_k ζ_k(s_i) d_k + ζ_{n+2}(s_i) sin⟨Θ⟩_1 ,   F_C = −(K⁻¹_CC)⁻¹ q̃_C ,
    M   = Σ λ_k/λ² d_k + Σ s_i(s_i−λ)(2λ−s_i)/(2λ²) F_i + w̃λ²/8 sin⟨Θ⟩_1 ,
    F_0 = Σ λ_k/λ³ d_k − Σ (2λ³−3λs_i²+s_i³)/(2λ³) F_i + (5/8)w̃λ sin⟨Θ⟩_1 .
"""

from dataclasses import dataclass
from math import cos

import numpy as np

from boreprop.core.system import Scaled


@dataclass(frozen=True)
class LinearMode:
    """M and F_0 as linear functions of (θ, ⟨Θ⟩_1 … ⟨Θ⟩_n)."""

    s: np.ndarray
    M: np.ndarray
    F_0: np.ndarray
    epsilon: float
    saturated: bool

    @classmethod
    def of(cls, scaled: Scaled, contact: tuple[int, ...], saturated: bool, inclination: float) -> "LinearMode":
        n, w, lam = len(scaled.s), scaled.w, scaled.s[-1]
        lambda_ = np.diff([0.0, *scaled.s])
        s = np.array(scaled.s[:-1])
        d = np.hstack([-np.ones((n, 1)), np.eye(n)])
        sine = np.zeros(n + 1)
        sine[1] = cos(inclination)
        high, low = np.maximum.outer(s, s), np.minimum.outer(s, s)
        K_inv = low**2 / (4 * lam**3) * (2 * lam**3 * (3 * high - low) + (low - 3 * lam) * high**2 * (3 * lam - high))
        zeta = (s**2 * (s - 3 * lam) / (2 * lam**3))[:, None] * lambda_
        q = (np.tri(n - 1, n) * lambda_ + zeta) @ d
        q += np.outer(w / 16 * s**2 * (2 * s - 3 * lam) * (lam - s), sine)
        F = np.zeros((n - 1, n + 1))
        C = np.flatnonzero(contact)
        F[C] = -np.linalg.solve(K_inv[np.ix_(C, C)], q[C])
        M = lambda_ / lam**2 @ d + s * (s - lam) * (2 * lam - s) / (2 * lam**2) @ F + w * lam**2 / 8 * sine
        F_0 = lambda_ / lam**3 @ d - (2 * lam**3 - 3 * lam * s**2 + s**3) / (2 * lam**3) @ F + 5 / 8 * w * lam * sine
        return cls(np.array(scaled.s), M, F_0, scaled.epsilon, saturated)

    def determinant(self, nu: np.ndarray, eta_pi: float) -> np.ndarray:
        """Of the two equations for (θ, Θ), each ~ e^{νξ}, with its sign changed; zero at the roots."""
        s = np.concatenate([[0.0], self.s])
        A = -np.diff(np.exp(-nu[:, None] * s)) / (nu[:, None] * np.diff(s))
        m, f = A @ self.M[1:], A @ self.F_0[1:]
        turn = [self.epsilon * eta_pi * nu - self.M[0], -m]
        tilt = [1.0, -1.0] if self.saturated else [eta_pi - self.F_0[0], -eta_pi - f]
        return np.asarray(turn[1] * tilt[0] - turn[0] * tilt[1])

    def unstable(self, eta_pi: float, top: float, shift: float = 1e-7) -> int:
        """How many roots lie right of `shift` below |Im ν| = `top`, where there are none: the argument principle.

        The determinant grows like ν to the right, and turns by half a turn on the way back.
        """
        reach = self.s[-1]
        omega = np.concatenate([[0.0], np.geomspace(1e-9, 0.3 / reach, 40), np.arange(0.6 / reach, top, 0.3 / reach)])
        value = self.determinant(shift + 1j * omega, eta_pi)
        while True:
            turns = np.angle(value[1:] / value[:-1])
            coarse = np.flatnonzero(abs(turns) > 0.7)
            if not len(coarse):
                return round(0.5 - float(turns.sum()) / np.pi)
            between = (omega[coarse] + omega[coarse + 1]) / 2
            omega = np.insert(omega, coarse + 1, between)
            value = np.insert(value, coarse + 1, self.determinant(shift + 1j * between, eta_pi))

    def top(self, eta_pi: float) -> float:
        """A frequency far above those of the roots in the right half plane: there e^{−νs} hardly counts."""
        of_M, of_F_0 = (2 * (abs(row[1:]) / np.diff([0.0, *self.s])).sum() for row in (self.M, self.F_0))
        drag, share = self.epsilon * eta_pi, 1.0 if self.saturated else abs(1 - self.F_0[0] / eta_pi)
        bounds = [2.0, abs(self.M[0]) / drag, np.sqrt(of_M * share / drag), 0.0 if self.saturated else of_F_0 / eta_pi]
        return 4 * float(max(bounds))

    def matrix(self, eta_pi: float, nodes: int) -> np.ndarray:
        """The generator of (θ, Y on [−s_n, 0]) on Chebyshev nodes, shape (nodes + 1, nodes + 1).

        Besides the roots it has an eigenvalue zero, for moving the hole sideways.
        """
        angles = np.pi * np.arange(nodes) / (nodes - 1)
        x = (np.cos(angles) - 1) / 2 * self.s[-1]  # 0 down to −s_n
        weights = np.where(np.arange(nodes) % 2, -1.0, 1.0)
        weights[[0, -1]] /= 2
        away = x[:, None] - x + np.eye(nodes)
        derivative = weights / weights[:, None] / away
        np.fill_diagonal(derivative, 0.0)
        np.fill_diagonal(derivative, -derivative.sum(axis=1))
        delayed = np.zeros((len(self.s) + 1, nodes))
        for row, position in zip(delayed, [0.0, *-self.s], strict=True):
            distance = position - x
            if abs(distance).min() < 1e-12:
                row[np.argmin(abs(distance))] = 1.0
            else:
                row[:] = weights / distance / (weights / distance).sum()
        averages = (delayed[:-1] - delayed[1:]) / np.diff([0.0, *self.s])[:, None]
        on_state = np.zeros((len(self.s) + 1, nodes + 1))
        on_state[0, 0] = 1.0
        on_state[1:, 1:] = averages
        generator = np.zeros((nodes + 1, nodes + 1))
        generator[2:, 1:] = derivative[1:]
        generator[0] = self.M @ on_state / (self.epsilon * eta_pi)
        generator[1, 0] = 1.0
        if not self.saturated:
            generator[1] -= self.F_0 @ on_state / eta_pi
        return generator

    def roots(self, eta_pi: float, nodes: int) -> np.ndarray:
        """Its eigenvalues but for the zero of moving the hole sideways."""
        eigenvalues = np.linalg.eigvals(self.matrix(eta_pi, nodes))
        return np.delete(eigenvalues, np.argmin(abs(eigenvalues)))

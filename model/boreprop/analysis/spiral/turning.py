"""A hole that winds around the vertical, in the frame that turns with it, where nothing changes.

Vectors across the vertical are complex numbers: real to one side, imaginary to the side 90° to the right of it looking
down the hole. In a spiral Θ = T e^{iωξ} and θ = ϑ e^{iωξ}; with p = iω and B_i = (1 − e^{−p s_i})/p the offsets are
e_i = B_i T − s_i ϑ, and

    M(e, F, B_1 T) = p εηΠ ϑ ,   F_0(e, F, B_1 T) = (ηΠ e^{iϖ} + μ)(ϑ − T) .

F are the contact forces in a round hole, see `discs`, and μ >= 0 is the stiffness with which the gauge holds a tilt
that has come to its limit. The equations are homogeneous in T, ϑ, F and y*, so T is 1 here, and y* is a `gap` that is
common to all stabilizers, times their clearances over the largest one. A case has ψ*/y*, which is |ϑ − 1| over the gap.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Complexes, Floats
from ...core.beam import Beam
from ...core.system import Scaled
from ..stability.characteristic import lag
from .discs import Contact, contact, real

OMEGA, THETA, THETA_ACROSS, MU, GAP, LOG_ETA_PI = range(6)  # the unknowns: ω, Re ϑ, Im ϑ, μ, the gap, ln ηΠ


class Response(NamedTuple):
    """M, F_0 and the contact forces of the beam, or their changes."""

    M: complex
    F_0: complex
    F: Complexes


class Residual(NamedTuple):
    """How far numbers are from a spiral: real and imaginary parts of both equations, and their slopes."""

    value: Floats  # shape (4,)
    slopes: Floats  # by the unknowns, shape (4, 6)


class Turning:
    """The equations of one drilling system whose bit walks by ϖ."""

    def __init__(self, scaled: Scaled, walk: float) -> None:
        beam, n = Beam(scaled), len(scaled.s)
        self.s, self.epsilon = np.array(scaled.s), scaled.epsilon
        self.walk: complex = np.exp(1j * walk)  # e^{iϖ}
        self.widest = max(scaled.y_star, default=0.0)
        self.y = np.array(scaled.y_star) / (self.widest or 1.0)
        self.K_inv = np.array(beam.K_inv).reshape(n - 1, n - 1)
        self.q_e = np.eye(n)[:-1]
        self.q_e[:, -1] += beam.delta_e
        self.q_g = np.array(beam.delta_g)
        self.M_e, self.M_F, self.M_g = beam.M_e, np.array(beam.M_F), beam.M_g
        self._near = np.zeros(n - 1, complex)  # contact forces, from which the next ones are sought
        self.F0_e, self.F0_F, self.F0_g = beam.F0_e, np.array(beam.F0_F), beam.F0_g

    def lags(self, x: Floats) -> tuple[Complexes, Complexes]:
        """B_i, and its derivative by p."""
        values = [lag(np.array([1j * x[OMEGA]]), s_i) for s_i in self.s.tolist()]
        B, slopes = np.array(values)[:, :, 0].T
        return B, slopes

    def loads(self, x: Floats) -> tuple[Complexes, complex]:
        """The offsets e_i, and the direction of the weight, B_1."""
        B, _ = self.lags(x)
        return B - self.s * theta(x), complex(B[0])

    def contact(self, x: Floats) -> Contact:
        """The contact forces in a spiral."""
        return self.contact_under(*self.loads(x), x[GAP])

    def contact_under(self, e: Complexes, G: complex, gap: float) -> Contact:
        """The contact forces under offsets and weight."""
        found = contact(self.K_inv, self.q_e @ e + self.q_g * G, gap * self.y, self._near)
        self._near = found.F
        return found

    def free_gap(self, x: Floats, held: NDArray[np.bool_]) -> float:
        """The least gap at which stabilizers that are not held do not touch; 0 if all are held."""
        e, G = self.loads(x)
        q, free = self.q_e @ e + self.q_g * G, ~held
        if not free.any():
            return 0.0
        F = np.zeros(len(q), complex)
        F[held] = -np.linalg.solve(self.K_inv[np.ix_(held, held)], q[held])
        return float((abs(q + self.K_inv @ F)[free] / self.y[free]).max())

    def response(self, e: Complexes, G: complex, F: Complexes) -> Response:
        """M and F_0 under offsets, weight and contact forces; or their changes with those."""
        return Response(
            self.M_e * e[-1] + self.M_F @ F + self.M_g * G, self.F0_e * e[-1] + self.F0_F @ F + self.F0_g * G, F
        )

    def change(self, touched: Contact, e: Complexes, G: complex, y: Floats | None = None) -> Response:
        """The changes of M, F_0 and F with those of the offsets, of the weight and of the clearances."""
        dy = np.zeros(len(self.y)) if y is None else y
        return self.response(e, G, touched.change(self.q_e @ e + self.q_g * G, dy))

    def residual(self, x: Floats) -> Residual:
        """Both equations at x."""
        p, eta_pi, mu, bit = 1j * x[OMEGA], np.exp(x[LOG_ETA_PI]), x[MU], theta(x)
        stiffness, psi, drag = eta_pi * self.walk + mu, bit - 1.0, self.epsilon * eta_pi
        B, slopes = self.lags(x)
        e, G = B - self.s * bit, complex(B[0])
        touched = self.contact_under(e, G, x[GAP])
        M, F_0, _ = self.response(e, G, touched.F)
        still = np.zeros(len(self.s), complex)
        columns = []
        for (de, dG, dy), turning, tilting in (
            ((1j * slopes, 1j * slopes[0], None), 1j * drag * bit, 0.0),
            ((-self.s + 0j, 0.0, None), p * drag, stiffness),
            ((-1j * self.s, 0.0, None), 1j * p * drag, 1j * stiffness),
            ((still, 0.0, None), 0.0, psi),
            ((still, 0.0, self.y), 0.0, 0.0),
            ((still, 0.0, None), p * drag * bit, eta_pi * self.walk * psi),
        ):
            dM, dF_0, _ = self.change(touched, de, dG, dy)
            columns.append(real(np.array([dM - turning, dF_0 - tilting])))
        value = real(np.array([M - p * drag * bit, F_0 - stiffness * psi]))
        return Residual(value, np.column_stack(columns))


def theta(x: Floats) -> complex:
    """ϑ, the direction of the bit over that of the hole."""
    return complex(x[THETA], x[THETA_ACROSS])


def tilt(x: Floats) -> float:
    """|ϑ − 1|, the tilt of the bit over the inclination of the hole."""
    return abs(theta(x) - 1.0)

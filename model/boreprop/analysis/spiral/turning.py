"""A hole that winds around the vertical, in the frame that turns with it, where nothing changes.

Vectors across the vertical are complex numbers: real to one side, imaginary to the side 90° to the right of it looking
down the hole. In a spiral Θ = T e^{iωξ} and θ = ϑ e^{iωξ}; with p = iω and B_i = (1 − e^{−p s_i})/p the offsets are
e_i = B_i T − s_i ϑ, and

    M(e, F, g) = p εηΠ ϑ ,   F_0(e, F, g) = (ηΠ e^{iϖ} + μ)(ϑ − T) ,

where g, the angle of the weight, is B_1 T = e_1/s_1 + ϑ, or ϑ under an axial load.
F are the contact forces in a round hole, see `discs`, and μ >= 0 is the stiffness with which the gauge holds a tilt
that has come to its limit. The equations are homogeneous in T, ϑ, F and y*, so T is 1 here, and y* is a `gap` that is
common to all stabilizers, times their clearances over the largest one. A case has ψ*/y*, which is |ϑ − 1| over the gap.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Complexes, Floats
from ...case.case import Case
from ...core.errors import ParameterError
from ..lying import pressing_weight
from ..stability.any_beam import AnyBeam
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


def beam_of(case: Case) -> AnyBeam:
    """The beam of a case in a vertical hole, where all stabilizers may move within discs.

    Raises
    ------
    ParameterError
        As by `AnyBeam.of`; if the BHA buckles between bit and last stabilizer, since no wall holds it sideways; or if
        the last stabilizer lies to the low side, which a vertical hole does not have.
    """
    weight, offset = pressing_weight(case), case.bha.end_deflection
    if offset:
        constraint = "must be 0 for a spiral, since a vertical hole has no low side"
        raise ParameterError("bha.end_deflection", constraint, offset)
    beam = AnyBeam.of(case.bha, case.bit, weight)
    if np.linalg.eigvalsh(beam.K_inv).min(initial=1.0) <= 0.0:
        constraint = "must be less for a spiral, since the BHA buckles between bit and last stabilizer"
        raise ParameterError("weight_on_bit", constraint, weight)
    return beam


def y_star_of(case: Case) -> Floats:
    """The clearances y* of a case."""
    return np.array(case.bha.stabilizer_clearances) / case.length_scale


class Turning:
    """The equations of one drilling system, whose stabilizers have the clearances y* and whose bit walks by ϖ."""

    def __init__(self, beam: AnyBeam, y_star: Floats, walk: float) -> None:
        self.beam, self.rows, self.s = beam, beam.rows(), beam.s
        self.walk: complex = np.exp(1j * walk)  # e^{iϖ}
        self.widest = float(y_star.max(initial=0.0))
        self.y = y_star / (self.widest or 1.0)
        self._near = np.zeros(len(y_star), complex)  # contact forces, from which the next ones are sought

    def lags(self, x: Floats) -> tuple[Complexes, Complexes]:
        """B_i, and its derivative by p."""
        values = [lag(np.array([1j * x[OMEGA]]), s_i) for s_i in self.s.tolist()]
        B, slopes = np.array(values)[:, :, 0].T
        return B, slopes

    def offsets(self, x: Floats) -> Complexes:
        """The offsets e_i."""
        offsets: Complexes = self.lags(x)[0] - self.s * theta(x)
        return offsets

    def bend(self, e: Complexes, bit: complex) -> Complexes:
        """The deflections q̃ without contact."""
        q: Complexes = self.rows.q @ np.append(e, bit)
        return q

    def contact(self, x: Floats) -> Contact:
        """The contact forces in a spiral."""
        return self.contact_under(self.offsets(x), theta(x), x[GAP])

    def contact_under(self, e: Complexes, bit: complex, gap: float) -> Contact:
        """The contact forces under offsets and a direction of the bit."""
        found = contact(self.beam.K_inv, self.bend(e, bit), gap * self.y, self._near)
        self._near = found.F
        return found

    def free_gap(self, x: Floats, held: NDArray[np.bool_]) -> float:
        """The least gap at which stabilizers that are not held do not touch; 0 if all are held."""
        q, free, K_inv = self.bend(self.offsets(x), theta(x)), ~held, self.beam.K_inv
        if not free.any():
            return 0.0
        F = np.zeros(len(q), complex)
        F[held] = -np.linalg.solve(K_inv[np.ix_(held, held)], q[held])
        return float((abs(q + K_inv @ F)[free] / self.y[free]).max())

    def response(self, e: Complexes, bit: complex, F: Complexes) -> Response:
        """M and F_0 under offsets, a direction of the bit and contact forces; or their changes with those."""
        by = np.append(e, bit)
        return Response(self.rows.M @ by + self.beam.M_F @ F, self.rows.F_0 @ by + self.beam.F0_F @ F, F)

    def change(self, touched: Contact, e: Complexes, bit: complex, y: Floats | None = None) -> Response:
        """The changes of M, F_0 and F with those of the offsets, of the bit's direction and of the clearances."""
        dy = np.zeros(len(self.y)) if y is None else y
        return self.response(e, bit, touched.change(self.bend(e, bit), dy))

    def residual(self, x: Floats) -> Residual:
        """Both equations at x."""
        p, eta_pi, mu, bit = 1j * x[OMEGA], np.exp(x[LOG_ETA_PI]), x[MU], theta(x)
        stiffness, psi, drag = eta_pi * self.walk + mu, bit - 1.0, self.beam.epsilon * eta_pi
        B, slopes = self.lags(x)
        e = B - self.s * bit
        touched = self.contact_under(e, bit, x[GAP])
        M, F_0, _ = self.response(e, bit, touched.F)
        still, along, faster = (np.asarray(each, complex) for each in (0 * self.s, -self.s, 1j * slopes))
        columns = []
        for (de, dbit, dy), turning, tilting in (
            ((faster, 0.0, None), 1j * drag * bit, 0.0),
            ((along, 1.0, None), p * drag, stiffness),
            ((1j * along, 1j, None), 1j * p * drag, 1j * stiffness),
            ((still, 0.0, None), 0.0, psi),
            ((still, 0.0, self.y), 0.0, 0.0),
            ((still, 0.0, None), p * drag * bit, eta_pi * self.walk * psi),
        ):
            dM, dF_0, _ = self.change(touched, de, dbit, dy)
            columns.append(real(np.array([dM - turning, dF_0 - tilting])))
        value = real(np.array([M - p * drag * bit, F_0 - stiffness * psi]))
        return Residual(value, np.column_stack(columns))


def theta(x: Floats) -> complex:
    """ϑ, the direction of the bit over that of the hole."""
    return complex(x[THETA], x[THETA_ACROSS])


def tilt(x: Floats) -> float:
    """|ϑ − 1|, the tilt of the bit over the inclination of the hole."""
    return abs(theta(x) - 1.0)

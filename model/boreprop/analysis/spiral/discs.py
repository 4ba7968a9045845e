"""Contact in a round hole: each stabilizer may move within a disc, and the wall pushes it radially inwards.

Vectors across the hole are complex numbers. The deflections δ = q̃ + K⁻¹F obey |δ_i| <= y*_i, and F_i is zero or points
against a δ_i with |δ_i| = y*_i. F is unique: it minimises ½F·K⁻¹F + q̃·F + Σ y*_i |F_i|, a second-order cone problem.
"""

from typing import NamedTuple

import numpy as np

from ...arrays import Complexes, Floats

MOST_ITERATIONS = 100  # of Newton's method, which takes about five
SMALLEST_STEP = 1e-4  # share of a step of Newton's method
ROUNDING = 1e-15  # of the sizes of what adds up to a deflection
ENOUGH = 1e3  # times that: it ends where a step does not help any more
TINY = 1e-300  # in place of a length of zero that is divided by


class Contact(NamedTuple):
    """Contact forces, and their derivatives by the deflections without contact."""

    F: Complexes
    slope: Floats  # of F, as real and imaginary parts, by what moves δ against its disc, shape (2m, 2m)
    held: Floats  # 1 − the derivative of the projection onto the discs, shape (2m, 2m)
    outwards: Complexes  # where a stabilizer is on its wall, the direction to it; else 0

    def change(self, dq: Complexes, dy: Floats) -> Complexes:
        """The change of F with changes of q̃ and y*."""
        turned: Complexes = (self.slope @ (self.held @ real(dq) - real(self.outwards * dy))).view(complex)
        return turned


def real(z: Complexes) -> Floats:
    """Complex numbers as their real and imaginary parts, one after the other."""
    return np.ascontiguousarray(z, complex).view(float)


def contact(K_inv: Floats, q: Complexes, y_star: Floats, start: Complexes | None = None) -> Contact:
    """Find the contact forces by Newton's method for the projection onto the discs, δ_i = P_i(δ_i − K⁻¹_ii F_i).

    Parameters
    ----------
    K_inv
        The flexibilities, shape (m, m).
    q
        The deflections without contact, shape (m,).
    y_star
        The clearances, shape (m,).
    start
        Contact forces near the ones that are sought.

    Raises
    ------
    ArithmeticError
        If they are not found.
    """
    own, wide = np.diag(K_inv).copy(), np.kron(K_inv, np.eye(2))
    F = np.zeros(len(q), complex) if start is None else start
    residual = _residual(K_inv, own, q, y_star, F)
    for _ in range(MOST_ITERATIONS):
        held, outwards = _held(K_inv, own, q, y_star, F)
        # d(residual) = held · dδ + (1 − held) · K⁻¹_ii dF_i
        slope = held @ wide + (np.eye(len(held)) - held) * np.repeat(own, 2)
        size, rounding = abs(residual).max(initial=0.0), ROUNDING * (abs(q) + abs(K_inv) @ abs(F)).max(initial=0.0)
        step = np.linalg.solve(slope, real(residual)).view(complex)
        share, closer = 1.0, _residual(K_inv, own, q, y_star, F - step)
        if size <= rounding or (size <= ENOUGH * rounding and abs(closer).max(initial=0.0) >= size):
            F = np.where(outwards != 0, F, 0.0)
            return Contact(F, np.asarray(-np.linalg.inv(slope), float), held, outwards)
        while share > SMALLEST_STEP and abs(closer).max(initial=0.0) >= size:
            share /= 2
            closer = _residual(K_inv, own, q, y_star, F - share * step)
        F, residual = F - share * step, closer
    raise ArithmeticError("no contacts are found in the round hole")


def _residual(K_inv: Floats, own: Floats, q: Complexes, y_star: Floats, F: Complexes) -> Complexes:
    """δ − P(δ − K⁻¹_ii F_i)."""
    delta = q + K_inv @ F
    z = delta - own * F
    size = abs(z)
    residual: Complexes = delta - z * np.where(size > y_star, y_star / np.maximum(size, TINY), 1.0)
    return residual


def _held(K_inv: Floats, own: Floats, q: Complexes, y_star: Floats, F: Complexes) -> tuple[Floats, Complexes]:
    """1 − P′: what walls take of a movement, all of it outwards and a part across. And the directions outwards."""
    z = q + K_inv @ F - own * F
    size = abs(z)
    touches = size > y_star
    n = np.where(touches, z / np.maximum(size, TINY), 0.0)
    across = np.where(touches, 1.0 - y_star / np.maximum(size, TINY), 0.0)
    held = np.zeros((len(q), 2, len(q), 2))
    each = range(len(q))
    blocks = np.stack([n.real, n.imag], axis=1)
    held[each, :, each, :] = across[:, None, None] * np.eye(2) + (1.0 - across)[:, None, None] * (
        blocks[:, :, None] * blocks[:, None, :]
    )
    return held.reshape(2 * len(q), 2 * len(q)), n

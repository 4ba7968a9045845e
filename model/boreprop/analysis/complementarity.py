"""The paper's linear complementarity problem (15): w = M z + q, 0 ≤ w ⊥ z ≥ 0, z = (F_ℓ, F_u, F̂_ℓ, F̂_u)."""

from ..core.beam import Beam
from ..core.linear import dot
from ..core.modes import Loads

Matrix = list[list[float]]


def lcp(
    beam: Beam, y_star: tuple[float, ...], psi_star: float, eta_pi: float, loads: Loads
) -> tuple[Matrix, list[float]]:
    """The paper's LCP (15) for n stabilizers, dimensionless.

    Parameters
    ----------
    beam
        The BHA.
    y_star
        Clearances of the non-ideal stabilizers over ℓ₁, (n − 1,).
    psi_star
        ψ*, rad.
    eta_pi
        ηΠ.
    loads
        What bends the beam besides the contacts.

    Returns
    -------
    M, q
        Shapes (2n, 2n) and (2n,), in the order of z = (F_ℓ, F_u, F̂_ℓ, F̂_u): two blocks of n − 1, then two numbers.
    """
    m = len(y_star)
    M = [[0.0] * (2 * m + 2) for _ in range(2 * m + 2)]
    for i in range(m):
        for j in range(m):
            M[i][j] = M[m + i][m + j] = beam.K_inv[i][j]
            M[i][m + j] = M[m + i][j] = -beam.K_inv[i][j]
        M[2 * m][i] = M[2 * m + 1][m + i] = beam.F0_F[i] / eta_pi
        M[2 * m][m + i] = M[2 * m + 1][i] = -beam.F0_F[i] / eta_pi
    M[2 * m][2 * m] = M[2 * m + 1][2 * m + 1] = 1 / (2 * eta_pi)
    M[2 * m][2 * m + 1] = M[2 * m + 1][2 * m] = -1 / (2 * eta_pi)
    q_tilde = beam.q_tilde(loads.e, loads.F_rss, loads.sin_Theta_1)
    q_hat = beam.bit_force(loads.e[-1], [0.0] * m, loads.F_rss, loads.sin_Theta_1) / eta_pi
    q = [q_tilde[i] + y_star[i] for i in range(m)] + [-q_tilde[i] + y_star[i] for i in range(m)]
    return M, [*q, q_hat + psi_star, -q_hat + psi_star]


def residual(M: Matrix, q: list[float], z: list[float]) -> float:
    """The largest |min(z_i, (Mz + q)_i|: zero if z solves the LCP."""
    return max(abs(min(z_i, dot(row, z) + q_i)) for row, q_i, z_i in zip(M, q, z, strict=True))

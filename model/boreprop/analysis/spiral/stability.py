"""Whether a spiral keeps itself up: the roots of the equations about it, in the frame that turns with it.

There the disturbances u of the bit's axis and y of the hole obey delay equations with constant coefficients,

    u' = −iω u + dM/(εηΠ) ,   y' = −iω y + u − dψ ,   de_i = y(ξ) − e^{−iωs_i} y(ξ − s_i) − s_i u ,

whose coefficients differ for real and imaginary parts, since walls and gauge are stiff one way and soft the other. They
become ordinary ones with y at Chebyshev points of the last λ, and its derivative along the hole there (Breda, Maset and
Vermiglio 2005). The eigenvalues converge faster than any power of the number of points.
"""

from math import ceil
from typing import Any

import numpy as np

from ...arrays import Complexes, Floats
from .discs import real
from .turning import LOG_ETA_PI, MU, OMEGA, Response, Turning, theta

FEWEST = 24  # Chebyshev points, and …
PER_RADIAN = 3.0  # … so many more for each radian by which the spiral turns over the length of the BHA
TRIVIAL = 1e-5  # per ℓ₁: how far roots that are known, of other numbers than these, may be from where they are


def roots(turning: Turning, x: Floats) -> Complexes:
    """The roots ν about a spiral, those with Im ν >= 0, per ℓ₁, the rightmost first.

    Left out are those that change nothing: 0, a turn about the vertical, and ±iω, a shift of the whole hole.
    """
    omega, reach = x[OMEGA], turning.s[-1]
    count = FEWEST + ceil(PER_RADIAN * omega * reach)
    points, derivative, weights = chebyshev(count)
    rows = [interpolation(points, weights, 1 - 2 * s / reach) for s in (0.0, *turning.s)]
    # y(0), y(−s_1) … y(−s_n), u  as functions of  y at the points, u
    seen = np.vstack([np.pad(np.array(rows), ((0, 0), (0, 1))), np.eye(count + 2)[-1]])
    bend = np.zeros((count + 2, count + 2))
    bend[1:-1, :-1] = (derivative * 2 / reach)[1:]
    matrix = np.kron(bend, np.eye(2))
    ends = np.kron(np.eye(count + 2)[:, [0, -1]], np.eye(2))
    matrix += ends @ rates(turning, x) @ np.kron(seen, np.eye(2))
    found = eigenvalues(matrix)
    for known in (0.0, 1j * omega, -1j * omega):
        nearest = int(np.argmin(abs(found - known)))
        if abs(found[nearest] - known) < TRIVIAL:
            found = np.delete(found, nearest)
    found = found[found.imag >= 0]
    return found[np.argsort(-found.real)]


def eigenvalues(matrix: Any) -> Complexes:
    """The eigenvalues of a real matrix, as complex numbers, in pairs."""
    return np.asarray(np.linalg.eigvals(matrix), complex)


def rates(turning: Turning, x: Floats) -> Floats:
    """Y' at the bit and u' by y(0), y(−s_1) … y(−s_n) and u: real and imaginary parts, shape (4, 2(n + 2))."""
    n, omega, eta_pi = len(turning.s), x[OMEGA], np.exp(x[LOG_ETA_PI])
    psi, touched = theta(x) - 1.0, turning.contact(x)
    columns = []
    for k in range(n + 2):
        for unit in (1.0, 1j):
            seen = np.zeros(n + 2, complex)
            seen[k] = unit
            y, u = seen[0], seen[-1]
            e = y - np.exp(-1j * omega * turning.s) * seen[1:-1] - turning.s * u
            change = turning.change(touched, e, u)
            turn = change.M / (turning.beam.epsilon * eta_pi)
            rate = [-1j * omega * y + u - tilts(turning, x, psi, change), -1j * omega * u + turn]
            columns.append(real(np.array(rate)))
    return np.column_stack(columns)


def tilts(turning: Turning, x: Floats, psi: complex, change: Response) -> complex:
    """dψ: along the force, or, where the gauge holds the tilt, across it only."""
    rock: complex = np.exp(x[LOG_ETA_PI]) * turning.walk
    if x[MU] <= 0:
        return change.F_0 / rock
    return 1j * psi * float((change.F_0 / psi).imag / (rock.real + x[MU]))


def chebyshev(count: int) -> tuple[Floats, Floats, Floats]:
    """The points cos(jπ/count), j = 0 … count, the matrix of the derivative there, and the barycentric weights."""
    angle = np.pi * np.arange(count + 1) / count
    points: Floats = np.cos(angle)
    weights: Floats = np.where(np.arange(count + 1) % 2, -1.0, 1.0)
    weights[[0, -1]] /= 2
    apart = points[:, None] - points + np.eye(count + 1)
    derivative: Floats = weights / weights[:, None] / apart
    np.fill_diagonal(derivative, 0.0)
    np.fill_diagonal(derivative, -derivative.sum(axis=1))
    return points, derivative, weights


def interpolation(points: Floats, weights: Floats, at: float) -> Floats:
    """The row that interpolates values at the points, by the barycentric formula."""
    near = np.flatnonzero(abs(points - at) < 1e-14)
    terms: Floats = np.eye(len(points))[near[0]] if len(near) else weights / (at - points)
    row: Floats = terms / terms.sum()
    return row

"""The opponent in space: classical RK4 on a fixed grid, hard-coded for stabilizers at 1 and 2, compiled with numba.

The step is 1/m, as in rk4_two_stabilizers.py: delayed values at the ends of a step are grid values and those in its
middle come from cubic Hermite interpolation. Contact and saturation are what the discs say. No events, no error
control, no pads; of the frame only the rows north and down are carried along, and where the bit is is left out.
"""

from math import asin, cos, hypot, sin
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@njit  # type: ignore[untyped-decorator]
def rates(x: Floats, Y_1: Floats, Y_2: Floats, p: Floats, out: Floats) -> None:
    """The derivatives of θ, Y and the rows of the frame, given Y(ξ−1) and Y(ξ−2); all with s = (1, 2) written out."""
    w, eta_pi, epsilon, psi_star, walk, y_star = p
    a, b = x[2] - Y_1[0] - x[0], x[3] - Y_1[1] - x[1]  # e_1
    c, d = x[2] - Y_2[0] - 2 * x[0], x[3] - Y_2[1] - 2 * x[1]  # e_2
    down_2, down_3, down_d = x[7], x[8], x[9]
    angle = hypot(a, b)
    sine = sin(angle) / angle if angle > 0 else 1.0
    versine = 2 * (sin(angle / 2) / angle) ** 2 if angle > 0 else 0.5
    along = versine * (a * down_2 + b * down_3) + sine * down_d
    G_2, G_3 = a * along - down_2, b * along - down_3
    q_2, q_3 = a - 0.3125 * c - w / 4 * G_2, b - 0.3125 * d - w / 4 * G_3
    size = hypot(q_2, q_3)
    stiffness = 32 / 7 * max(1 - y_star / size, 0.0) if size > 0 else 0.0
    F_2, F_3 = -stiffness * q_2, -stiffness * q_3
    f_2 = 0.125 * c - 0.6875 * F_2 + 1.25 * w * G_2
    f_3 = 0.125 * d - 0.6875 * F_3 + 1.25 * w * G_3
    size = hypot(f_2, f_3)
    if size <= eta_pi * psi_star:
        turn, tilt = walk, 1 / eta_pi
    else:
        turn, tilt = asin(eta_pi * psi_star * sin(walk) / size), psi_star / size
    psi_2, psi_3 = tilt * (cos(turn) * f_2 + sin(turn) * f_3), tilt * (cos(turn) * f_3 - sin(turn) * f_2)
    out[0] = (0.25 * c - 0.375 * F_2 + w / 2 * G_2) / (epsilon * eta_pi)
    out[1] = (0.25 * d - 0.375 * F_3 + w / 2 * G_3) / (epsilon * eta_pi)
    out[2], out[3] = x[0] - psi_2, x[1] - psi_3
    for row in (4, 7):
        out[row], out[row + 1] = -x[row + 2] * out[0], -x[row + 2] * out[1]
        out[row + 2] = x[row] * out[0] + x[row + 1] * out[1]


@njit  # type: ignore[untyped-decorator]
def steps(x: Floats, Y: Floats, slope: Floats, m: int, p: Floats, bit: Floats) -> None:
    """March over the grid; Y and its slopes are given up to its start, 2m. `bit` becomes the axis, north and down."""
    h, x_k, k_1, k_2, k_3, k_4 = 1 / m, x, np.empty(10), np.empty(10), np.empty(10), np.empty(10)
    x, middle_1, middle_2 = x_k.copy(), np.empty(2), np.empty(2)
    rates(x, Y[m], Y[0], p, k_1)
    for k in range(len(bit)):
        slope[k + 2 * m], bit[k, 0], bit[k, 1] = k_1[2:4], x_k[6], x_k[9]
        if k == len(bit) - 1:
            return
        for d in range(2):
            middle_1[d] = (Y[k + m, d] + Y[k + m + 1, d]) / 2 + h / 8 * (slope[k + m, d] - slope[k + m + 1, d])
            middle_2[d] = (Y[k, d] + Y[k + 1, d]) / 2 + h / 8 * (slope[k, d] - slope[k + 1, d])
        for c in range(10):
            x[c] = x_k[c] + h / 2 * k_1[c]
        rates(x, middle_1, middle_2, p, k_2)
        for c in range(10):
            x[c] = x_k[c] + h / 2 * k_2[c]
        rates(x, middle_1, middle_2, p, k_3)
        for c in range(10):
            x[c] = x_k[c] + h * k_3[c]
        rates(x, Y[k + m + 1], Y[k + 1], p, k_4)
        for c in range(10):
            x_k[c] += h / 6 * (k_1[c] + 2 * (k_2[c] + k_3[c]) + k_4[c])
        Y[k + 2 * m + 1] = x_k[2:4]
        rates(x_k, Y[k + m + 1], Y[k + 1], p, k_1)


def rk4(case: dict[str, Any], length: float, m: int) -> Floats:
    """The bit's axis, north and down, on the grid ξ = k/m of one of the cases in space with stabilizers at 1 and 2."""
    hole, count = case["hole"], round(length * m)
    grid, developed, frame = np.arange(-2 * m, 1) / m, np.array(hole["developed"]), np.array(hole["Q0"])
    slope, Y = np.zeros((2 * m + count + 1, 2)), np.zeros((2 * m + count + 1, 2))
    for d in range(2):
        before = np.interp(grid, hole["xi"], developed[:, d])
        rise = np.concatenate([[0.0], np.cumsum(before[1:] + before[:-1]) / (2 * m)])
        slope[: 2 * m + 1, d], Y[: 2 * m + 1, d] = before, rise - rise[-1]
    names = ("w", "eta_pi", "epsilon", "psi_star", "walk")
    parameters = np.array([*(case[name] for name in names), case["y_star"][0]])
    x, bit = np.concatenate([developed[-1], [0.0, 0.0], frame[0], frame[2]]), np.empty((count + 1, 2))
    steps(x, Y, slope, m, parameters, bit)
    return bit

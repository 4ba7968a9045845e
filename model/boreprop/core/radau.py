"""One step of Radau IIA collocation for x' = J x + g(t), with a constant 2×2 matrix J and x = (θ, Y).

The solution over the step is the polynomial of degree S that meets the equation at the S right Radau nodes. Within a
mode of the drilling system the equation is linear, so one linear solve gives it, with no Newton iteration. The
eigenvalues of the collocation matrix split that solve into one 2×2 solve per eigenvalue (Hairer & Wanner, Solving
Ordinary Differential Equations II, sections IV.5 and IV.8).
"""

from typing import NamedTuple

from .linear import inverse

S = 5
# The right Radau nodes on [0, 1], and the eigenvalues of A⁻¹, A the collocation matrix (one of each conjugate pair):
# the poles of the (S−1, S) Padé approximant of the exponential.
NODES = [0.057104196114517682193, 0.27684301363812382768, 0.58359043236891682006, 0.86024013565621944785, 1.0]
GAMMA = [
    6.2867047517292766452 + 0.0j,
    5.7009532986717894192 + 3.2102656003085498884j,
    3.6556943254635722582 + 6.543736899360077294j,
]


def _node_polynomial() -> list[float]:
    """Coefficients, ascending, of R(t) = Π (t − t_j)."""
    r = [1.0]
    for node in NODES:
        r = [below - node * c for below, c in zip([0.0, *r], [*r, 0.0], strict=True)]
    return r


def _eigenpolynomial(gamma: complex, r: list[float]) -> list[complex]:
    """Coefficients of t … t^S of the polynomial v, v(0) = 0, with v' − γ v = R: v' = γ v at every node."""
    v: list[complex] = [0.0] * (S + 2)
    for m in range(S, 0, -1):
        v[m] = ((m + 1) * v[m + 1] - r[m]) / gamma
    return v[1 : S + 1]


def _in_real_parts(values: list[complex]) -> tuple[float, ...]:
    """Factors of the parts of W in Re Σ_k values[k] W_k, the conjugate halves added."""
    parts: list[float] = []
    for gamma, v in zip(GAMMA, values, strict=True):
        parts += [v.real] if gamma.imag == 0 else [2 * v.real, -2 * v.imag]
    return tuple(parts)


_EIGENPOLYNOMIALS = [_eigenpolynomial(gamma, _node_polynomial()) for gamma in GAMMA]


def _at(t: float, derivative: int = 0) -> tuple[float, ...]:
    """Value or derivative at `t` of the step's polynomial, as factors of the parts of W."""
    powers = [t ** (m + 1) if derivative == 0 else (m + 1) * t**m for m in range(S)]
    return _in_real_parts([sum(c * power for c, power in zip(v, powers, strict=True)) for v in _EIGENPOLYNOMIALS])


# W holds one complex number for each eigenvalue, W_k = (γ_k − hJ)⁻¹ h f_k, where f_k is the share of the right-hand
# side in eigenvector k. Its five parts (real; real, imaginary; real, imaginary) times a row of these tables give:
CHECK = 0.72  # a point well between two nodes, where the polynomial need not meet the equation
POINTS = sorted([*NODES, CHECK])
_CHECK_INDEX = POINTS.index(CHECK)
_VALUES = [_at(t) for t in POINTS]  # the step's polynomial at the points, less its start
_COEFFICIENTS = [_in_real_parts([v[m] for v in _EIGENPOLYNOMIALS]) for m in range(S)]  # and its coefficients of t … t^S
_SLOPE = _at(CHECK, derivative=1)
_FROM_W = [*_VALUES, *_COEFFICIENTS, _SLOPE]
# and this one the parts of f from its values at the points (the check has no share)
_INTO_W = [
    (*row[:_CHECK_INDEX], 0.0, *row[_CHECK_INDEX:])
    for row in inverse([list(row) for row, t in zip(_VALUES, POINTS, strict=True) if t != CHECK])
]


class Solution(NamedTuple):
    """One component of a collocation step."""

    values: list[float]  # at the points, less the start
    coefficients: list[float]  # of t … t^S
    defect: float  # at the check: h times (slope − right-hand side)


def collocate(
    h: float, J: tuple[float, float, float, float], f_theta: list[float], f_Y: list[float]
) -> tuple[Solution, Solution]:
    """One step of length `h` for θ and Y.

    `f_theta` and `f_Y` are the right-hand sides at the points with (θ, Y) held at the start of the step; `J` is row
    by row.
    """
    h11, h12, h21, h22 = h * J[0], h * J[1], h * J[2], h * J[3]
    p1, p2, p3, p4, p5, p6 = f_theta
    q1, q2, q3, q4, q5, q6 = f_Y
    f = [a * p1 + b * p2 + c * p3 + d * p4 + e * p5 + g * p6 for a, b, c, d, e, g in _INTO_W]
    g = [a * q1 + b * q2 + c * q3 + d * q4 + e * q5 + g * q6 for a, b, c, d, e, g in _INTO_W]
    # (γ − hJ) W = h (f, g), by Cramer's rule
    gamma = GAMMA[0].real
    s11, s22 = gamma - h11, gamma - h22
    scale = h / (s11 * s22 - h12 * h21)
    p1, q1 = scale * (s22 * f[0] + h12 * g[0]), scale * (h21 * f[0] + s11 * g[0])
    (p2, p3), (q2, q3) = _solve_complex(GAMMA[1], h, h11, h12, h21, h22, complex(f[1], f[2]), complex(g[1], g[2]))
    (p4, p5), (q4, q5) = _solve_complex(GAMMA[2], h, h11, h12, h21, h22, complex(f[3], f[4]), complex(g[3], g[4]))
    theta = [a * p1 + b * p2 + c * p3 + d * p4 + e * p5 for a, b, c, d, e in _FROM_W]
    Y = [a * q1 + b * q2 + c * q3 + d * q4 + e * q5 for a, b, c, d, e in _FROM_W]
    at, after = _CHECK_INDEX, S + 1
    defect_theta = theta[-1] - h * f_theta[at] - h11 * theta[at] - h12 * Y[at]
    defect_Y = Y[-1] - h * f_Y[at] - h21 * theta[at] - h22 * Y[at]
    return Solution(theta[:after], theta[after:-1], defect_theta), Solution(Y[:after], Y[after:-1], defect_Y)


def _solve_complex(
    gamma: complex, h: float, h11: float, h12: float, h21: float, h22: float, f: complex, g: complex
) -> tuple[tuple[float, float], tuple[float, float]]:
    s11, s22 = gamma - h11, gamma - h22
    scale = h / (s11 * s22 - h12 * h21)
    theta, Y = scale * (s22 * f + h12 * g), scale * (h21 * f + s11 * g)
    return (theta.real, theta.imag), (Y.real, Y.imag)


def damped(h: float, J: tuple[float, float, float, float], defect_theta: float, defect_Y: float) -> tuple[float, float]:
    """(1 − hJ/γ)⁻¹ times a defect, γ the real eigenvalue: an error estimate that stiffness does not blow up."""
    h11, h12, h21, h22 = [h * j / GAMMA[0].real for j in J]
    determinant = (1 - h11) * (1 - h22) - h12 * h21
    return (
        ((1 - h22) * defect_theta + h12 * defect_Y) / determinant,
        (h21 * defect_theta + (1 - h11) * defect_Y) / determinant,
    )

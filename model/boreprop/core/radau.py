"""One step of Radau IIA collocation for x' = J x + g(t), with a constant 2×2 matrix J and x = (θ, Y).

The solution over the step is the polynomial of degree S that meets the equation at the S right Radau nodes. Within a
mode of the drilling system the equation is linear, so one linear solve gives it, with no Newton iteration. The
eigenvalues of the collocation matrix split that solve into one 2×2 solve per eigenvalue (Hairer & Wanner, Solving
Ordinary Differential Equations II, sections IV.5 and IV.8).
"""

from .linear import dot, inverse

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
    return _in_real_parts(
        [complex(dot([c.real for c in v], powers), dot([c.imag for c in v], powers)) for v in _EIGENPOLYNOMIALS]
    )


# W holds one complex number for each eigenvalue, W_k = (γ_k − hJ)⁻¹ h f_k, where f_k is the share of the right-hand
# side in eigenvector k. A step of one component is the five parts of its W (real; real, imaginary; real, imaginary);
# times a row of these tables they give
CHECK = 0.72  # a point well between two nodes, where the polynomial need not meet the equation
POINTS = sorted([*NODES, CHECK])
AT_CHECK = POINTS.index(CHECK)
_VALUES = [_at(t) for t in POINTS]  # the step's polynomial at the points, less its start
_COEFFICIENTS = [_in_real_parts([v[m] for v in _EIGENPOLYNOMIALS]) for m in range(S)]  # and its coefficients of t … t^S
_SLOPE = _at(CHECK, derivative=1)
# and this one the parts of f from its values at the points, the check having no share
_INTO_PARTS = [
    (*row[:AT_CHECK], 0.0, *row[AT_CHECK:])
    for row in inverse([list(row) for row, t in zip(_VALUES, POINTS, strict=True) if t != CHECK])
]

Parts = tuple[float, float, float, float, float]
Jacobian = tuple[float, float, float, float]  # row by row


def collocate(h: float, J: Jacobian, f_theta: list[float], f_Y: list[float]) -> tuple[Parts, Parts]:
    """One step of length `h` for θ and Y, for `values`, `coefficients` and `error`.

    `f_theta` and `f_Y` are the right-hand sides at the points with (θ, Y) held at the start of the step.
    """
    h11, h12, h21, h22 = h * J[0], h * J[1], h * J[2], h * J[3]
    f1, f2, f3, f4, f5 = _into_parts(f_theta)
    g1, g2, g3, g4, g5 = _into_parts(f_Y)
    # (γ − hJ) W = h (f, g), by Cramer's rule
    gamma = GAMMA[0].real
    s11, s22 = gamma - h11, gamma - h22
    scale = h / (s11 * s22 - h12 * h21)
    theta_1, Y_1 = scale * (s22 * f1 + h12 * g1), scale * (h21 * f1 + s11 * g1)
    z11, z22, f, g = GAMMA[1] - h11, GAMMA[1] - h22, complex(f2, f3), complex(g2, g3)
    factor = h / (z11 * z22 - h12 * h21)
    theta_2, Y_2 = factor * (z22 * f + h12 * g), factor * (h21 * f + z11 * g)
    z11, z22, f, g = GAMMA[2] - h11, GAMMA[2] - h22, complex(f4, f5), complex(g4, g5)
    factor = h / (z11 * z22 - h12 * h21)
    theta_3, Y_3 = factor * (z22 * f + h12 * g), factor * (h21 * f + z11 * g)
    return (
        (theta_1, theta_2.real, theta_2.imag, theta_3.real, theta_3.imag),
        (Y_1, Y_2.real, Y_2.imag, Y_3.real, Y_3.imag),
    )


def _into_parts(f: list[float]) -> list[float]:
    f1, f2, f3, f4, f5, f6 = f
    return [a * f1 + b * f2 + c * f3 + d * f4 + e * f5 + g * f6 for a, b, c, d, e, g in _INTO_PARTS]


def values(start: float, parts: Parts) -> list[float]:
    """The component at the points."""
    p1, p2, p3, p4, p5 = parts
    return [start + a * p1 + b * p2 + c * p3 + d * p4 + e * p5 for a, b, c, d, e in _VALUES]


def coefficients(start: float, parts: Parts) -> tuple[float, ...]:
    """Coefficients of t^0 … t^S of the component."""
    p1, p2, p3, p4, p5 = parts
    return (start, *[a * p1 + b * p2 + c * p3 + d * p4 + e * p5 for a, b, c, d, e in _COEFFICIENTS])


def slope(parts: Parts) -> float:
    """Derivative of the component at the check, times h."""
    a, b, c, d, e = _SLOPE
    p1, p2, p3, p4, p5 = parts
    return a * p1 + b * p2 + c * p3 + d * p4 + e * p5


def error(h: float, J: Jacobian, defect_theta: float, defect_Y: float) -> tuple[float, float]:
    """Errors of θ and Y from h times the defects at the check, slope less right-hand side.

    (1 − hJ/γ)⁻¹ times the defects, γ the real eigenvalue: stiffness does not blow that up.
    """
    scale = h / GAMMA[0].real
    h11, h12, h21, h22 = scale * J[0], scale * J[1], scale * J[2], scale * J[3]
    determinant = (1 - h11) * (1 - h22) - h12 * h21
    return (
        ((1 - h22) * defect_theta + h12 * defect_Y) / determinant,
        (h21 * defect_theta + (1 - h11) * defect_Y) / determinant,
    )

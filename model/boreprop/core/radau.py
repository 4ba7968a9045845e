"""One step of Radau IIA collocation for x' = J x + g(t), with a constant 2×2 matrix J and x = (θ, Y).

The solution over the step is the polynomial of degree S that meets the equation at the S right Radau nodes. Within a
regime of the drilling system the equation is linear, so one linear solve gives it, with no Newton iteration. The
eigenvalues of the collocation matrix split that solve into one 2×2 solve per eigenvalue (Hairer & Wanner, Solving
Ordinary Differential Equations II, sections IV.5 and IV.8).

The tables are printed numbers, as in that book; a test computes them anew from the nodes.
"""

S = 5
CHECK = 0.72  # a point well between two nodes, where the polynomial need not meet the equation
AT_CHECK = 3
# the right Radau nodes on [0, 1], and the check
POINTS = [0.057104196114517682, 0.27684301363812383, 0.58359043236891682, CHECK, 0.86024013565621945, 1.0]
# The eigenvalues of A⁻¹, A the collocation matrix (one of each conjugate pair): the poles of the (S−1, S) Padé
# approximant of the exponential.
GAMMA = (
    6.2867047517292766 + 0.0j,
    5.7009532986717894 + 3.2102656003085499j,
    3.6556943254635723 + 6.5437368993600773j,
)

# W holds one complex number for each eigenvalue, W_k = (γ_k − hJ)⁻¹ h f_k, where f_k is the share of the right-hand
# side in eigenvector k. A step of one component is the five parts of its W (real; real, imaginary; real, imaginary).
# Times a row of these tables they give the step's polynomial at the points, less its start,
VALUES = (
    (
        -0.00025271652607697549,
        -0.00048904698559391934,
        6.3792433843492817e-05,
        -0.0004375202069046077,
        0.00011745903057017495,
    ),
    (
        -3.0115206893667392e-05,
        0.00046088152761641563,
        0.00053241861483126337,
        0.00099251494105583298,
        1.4811728885849996e-05,
    ),
    (
        -0.0014734251430335455,
        0.0021695649679600304,
        0.00072742391090131406,
        -0.0018264241860372708,
        -0.0014703226299679316,
    ),
    (
        -0.0032836038683892767,
        0.0053069710906357009,
        -0.00063379087130020773,
        -0.0034707912222464374,
        0.0007128645306736861,
    ),
    (
        -0.0076736350457070335,
        0.010474319444404412,
        -0.0065510442994358709,
        -0.0022561714617306203,
        0.005102738883355884,
    ),
    (-0.018613758215072551, 0.014374014654596756, -0.02311397294211831, 0.0042397435604757117, 0.0082665093133248713),
)
# its coefficients of t … t^S,
COEFFICIENTS = (
    (
        -0.0079365079365079343,
        -0.015873015873015862,
        -4.6205774282513513e-18,
        -0.015873015873015862,
        8.0816275713433614e-18,
    ),
    (0.074259108128058429, 0.15316703731212866, 0.025478298415147191, 0.16939925138520978, 0.051934419836191063),
    (-0.2412103675161158, -0.4753207164611577, -0.1154854271966417, -0.47394510649891697, -0.30621592270732145),
    (0.31533985353696187, 0.61875886371324085, 0.21688217951101324, 0.45479017163868601, 0.49548506766508943),
    (-0.15906584442746913, -0.26635815403659918, -0.14998902367163702, -0.13013155709148724, -0.23293705548063418),
)
# and its derivative at the check.
SLOPE = (
    -0.019069507064421704,
    0.031367239268746572,
    -0.020649998892506766,
    -0.0048762718868647081,
    0.02531795941059739,
)
# A row of this one times the values of f at the points, the check having no share, gives a part of f.
INTO_PARTS = (
    (-1488.0226473155772, -686.76823689227865, -172.37192777734208, 0.0, 51.11758739180334, -39.838837888497764),
    (-909.72901369917656, -34.51524902705944, 56.397088141427048, 0.0, 73.535515934913576, -22.372623795425696),
    (863.78149221219599, 730.33012654355707, 42.518940259061878, 0.0, 50.020408198953788, -36.895973715602445),
    (-96.458501119107325, 607.31251285029794, -49.121630686410406, 0.0, -61.798110098189028, 29.692042739674598),
    (695.95829735945313, 244.21024348834197, -342.11504504300672, 0.0, 158.79354632237366, -48.226554130239222),
)

Parts = tuple[float, float, float, float, float]
Jacobian = tuple[float, float, float, float]  # row by row


def collocate(h: float, J: Jacobian, f_theta: list[float], f_Y: list[float]) -> tuple[Parts, Parts]:
    """One step of length `h` for θ and Y, for `values`, `coefficients` and `error`.

    `f_theta` and `f_Y` are the right-hand sides at the points with (θ, Y) frozen at the start of the step.
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
    return [a * f1 + b * f2 + c * f3 + d * f4 + e * f5 + g * f6 for a, b, c, d, e, g in INTO_PARTS]


def values(start: float, parts: Parts) -> list[float]:
    """The component at the points."""
    p1, p2, p3, p4, p5 = parts
    return [start + a * p1 + b * p2 + c * p3 + d * p4 + e * p5 for a, b, c, d, e in VALUES]


def coefficients(start: float, parts: Parts) -> tuple[float, ...]:
    """Coefficients of t^0 … t^S of the component."""
    p1, p2, p3, p4, p5 = parts
    return (start, *[a * p1 + b * p2 + c * p3 + d * p4 + e * p5 for a, b, c, d, e in COEFFICIENTS])


def slope(parts: Parts) -> float:
    """Derivative of the component at the check, times h."""
    a, b, c, d, e = SLOPE
    p1, p2, p3, p4, p5 = parts
    return a * p1 + b * p2 + c * p3 + d * p4 + e * p5


def error(h: float, J: Jacobian, defect_theta: float, defect_Y: float) -> tuple[float, float]:
    """Errors of θ and Y from h times the defects at the check, slope less right-hand side.

    They are (1 − hJ/γ)⁻¹ times the defects, with the real eigenvalue γ, so that stiffness does not blow them up.
    """
    scale = h / GAMMA[0].real
    h11, h12, h21, h22 = scale * J[0], scale * J[1], scale * J[2], scale * J[3]
    determinant = (1 - h11) * (1 - h22) - h12 * h21
    return (
        ((1 - h22) * defect_theta + h12 * defect_Y) / determinant,
        (h21 * defect_theta + (1 - h11) * defect_Y) / determinant,
    )

"""How fast a ripple leaves its plane: the Floquet multipliers of what is across a planar ripple of a vertical hole.

A small disturbance across the plane obeys linear delay equations whose coefficients follow from the planar ripple, of
period P: a wall that bears a stabilizer with the force F gives way sideways as a pendulum does, and so does a gauge,

    K⁻¹F⊥ + y*/|F| F⊥ = −q̃⊥  (of those that touch) ,   ψ⊥ = F_0⊥ / max(ηΠ, |F_0|/ψ*) .

With the history on a grid they make a matrix over one period; its eigenvalues e^{σP} give the growth σ.
"""

from dataclasses import dataclass, replace
from math import nan, radians

import numpy as np

from ...arrays import Complexes, Floats
from ...case.case import Case
from ...core.errors import ParameterError
from ...core.survey import Survey
from ...run.completion import case_of
from ...run.simulate import simulate
from ...run.trajectory import Trajectory
from ..rippling import find_rippling
from ..stability.any_beam import AnyBeam
from .stability import eigenvalues
from .turning import beam_of, y_star_of

DOGLEG = radians(0.5)  # over ℓ₁, in the vertical hole from which the planar ripple starts
SETTLED = 200.0  # ℓ₁ drilled until the planar ripple is periodic
WAVES = 10  # at the end of the run, whose mean is the period
FINE = 0.002  # ℓ₁ between the rows of the planar run
PARTS = 400  # of a period: steps of the matrix, of order 2; the growth is then right to about 0.002 per ℓ₁
NEUTRAL = 2  # multipliers of 1: a shift across, and a turn of the plane, which change nothing


@dataclass(frozen=True)
class TransverseGrowth:
    """What becomes of a disturbance across the plane of a ripple.

    Parameters
    ----------
    growth
        Its growth per metre drilled; nan if the case does not ripple in the plane.
    wavelength
        Of the planar ripple, m; likewise.
    """

    growth: float
    wavelength: float


def transverse_growth(case: Case) -> TransverseGrowth:
    """Compute how fast the planar ripple of a case grows out of its plane, by Floquet multipliers.

    The ripple is drilled in a plane, from a vertical hole that ends with a dogleg of 0.5° over ℓ₁.

    Parameters
    ----------
    case
        The drilling system: BHA, bit and active weight on bit. Hole, force and length have no influence.

    Returns
    -------
    TransverseGrowth
        The growth of a small disturbance across the plane: > 0 if the hole leaves it and winds.

    Raises
    ------
    ParameterError
        If the bit walks, so that there is no planar ripple, the body may touch the wall, or the BHA buckles.
    Stopped
        If the case cannot be drilled.

    Examples
    --------
    >>> from boreprop import paper_case, transverse_growth
    >>> found = transverse_growth(paper_case())
    >>> round(found.growth, 3), round(found.wavelength, 2)
    (0.085, 5.07)
    """
    if case.bit.walk_angle:
        constraint = "must be 0 for a ripple in a plane, which a bit that walks leaves at once"
        raise ParameterError("bit_walk_angle", constraint, case.bit.walk_angle)
    beam, l1 = beam_of(case), case.length_scale
    alone = replace(case, schedule=type(case.schedule)(), inputs=None, formations=(), wear=None, dimensions=2)
    vertical = replace(alone, survey=Survey((0.0, l1), (0.0, DOGLEG)))
    run = simulate(vertical, length=SETTLED * l1, sample_interval=FINE * l1)
    if not find_rippling(run).ripples:
        return TransverseGrowth(nan, nan)
    start, period = last_period(run["drilled_length"] / l1, run["bit_inclination"])
    at: Floats = start + period / PARTS * np.arange(PARTS + 1.0)
    multipliers: Complexes = eigenvalues(over_a_period(*coefficients(beam, run, at), beam, case.eta_pi, period))
    for _ in range(NEUTRAL):
        multipliers = np.delete(multipliers, np.argmin(abs(multipliers - 1.0)))
    return TransverseGrowth(float(np.log(abs(multipliers).max())) / period / l1, period * l1)


def last_period(xi: Floats, inclination: Floats) -> tuple[float, float]:
    """Where the last whole wave begins, rising through zero, and the mean length of the last waves."""
    rises = np.flatnonzero((inclination[:-1] < 0) & (inclination[1:] >= 0))
    before, after = inclination[rises], inclination[rises + 1]
    places = xi[rises] + (xi[rises + 1] - xi[rises]) * before / (before - after)
    return float(places[-2]), float(places[-1] - places[-1 - WAVES]) / WAVES


def coefficients(beam: AnyBeam, run: Trajectory, at: Floats) -> tuple[Floats, Floats]:
    """M⊥ and ψ⊥ by the offsets e_i and by θ across the plane, at each of some places, shape (k, n + 1)."""
    case = case_of(run)
    force_scale, eta_pi = case.bha.force_scale, case.eta_pi
    n, xi, y_star = len(beam.s), run["drilled_length"] / case.length_scale, y_star_of(case)
    F = np.array([np.interp(at, xi, run[f"stabilizer_force[{i}]"]) for i in range(1, n)]).reshape(n - 1, -1).T
    F_0, F = np.interp(at, xi, run["bit_lateral_force"]) / force_scale, abs(F) / force_scale
    q, *free = beam.rows()
    rows_M, rows_psi = (np.tile(row, (len(at), 1)) for row in free)
    for k, forces in enumerate(F):
        touching = np.flatnonzero(forces > 0)
        stiff = beam.K_inv[np.ix_(touching, touching)] + np.diag(y_star[touching] / forces[touching])
        across = -np.linalg.solve(stiff, q[touching])
        rows_M[k] += beam.M_F[touching] @ across
        rows_psi[k] += beam.F0_F[touching] @ across
    return rows_M, rows_psi / np.maximum(eta_pi, abs(F_0) / case.bit.tilt_limit)[:, None]


def over_a_period(rows_M: Floats, rows_psi: Floats, beam: AnyBeam, eta_pi: float, period: float) -> Floats:
    """The matrix that takes θ⊥ and the history of Y⊥, on a grid back to λ and a little beyond, over one period.

    The trapezoidal rule; delayed values between the points of the grid are those of cubics.
    """
    s, step, drag = beam.s, period / PARTS, beam.epsilon * eta_pi
    length = int(np.ceil(s[-1] / step)) + 3
    size = length + 1  # Y at 0, −1, …, −(length − 1) steps, then θ
    history: Floats = np.eye(length, size)
    theta: Floats = np.eye(size)[-1]
    delays = [_cubic(s_i / step, length) for s_i in s.tolist()]

    def rates(k: int) -> tuple[Floats, Floats]:
        """What θ′ and Y′ are of θ and Y, and of the delayed Y."""
        M, psi = rows_M[k] / drag, rows_psi[k]
        by_Y = np.array([M[:-1].sum(), -psi[:-1].sum()])
        by_theta = np.array([M[-1] - M[:-1] @ s, 1.0 - psi[-1] + psi[:-1] @ s])
        return np.column_stack([by_theta, by_Y]), np.array([-M[:-1], psi[:-1]])

    jacobian, terms = rates(0)
    slope = jacobian @ np.vstack([theta, history[0]]) + terms @ [d @ history for d in delays]
    for k in range(1, PARTS + 1):
        jacobian, terms = rates(k)
        ahead = np.array([d[1:] @ history[:-1] for d in delays])  # the grid has moved on by a step
        known = np.vstack([theta, history[0]]) + step / 2 * (slope + terms @ ahead)
        theta, Y = new = np.linalg.solve(np.eye(2) - step / 2 * jacobian, known)
        slope = jacobian @ new + terms @ ahead
        history = np.vstack([Y, history[:-1]])
    return np.vstack([history, theta])


def _cubic(place: float, length: int) -> Floats:
    """Weights of the points of a grid, of spacing one, for a value at a place between them, by a cubic."""
    first = int(place) - 1
    nodes = np.arange(first, first + 4)
    row = np.zeros(length)
    for node in nodes:
        others = nodes[nodes != node]
        row[node] = np.prod((place - others) / (node - others))
    return row

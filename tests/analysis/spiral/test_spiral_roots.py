"""The roots about a spiral, against the characteristic determinant in the turning frame and a simulation."""

from itertools import pairwise

import numpy as np
import pytest

from boreprop.analysis.spiral.closed_form import Search
from boreprop.analysis.spiral.stability import roots
from boreprop.analysis.spiral.turning import LOG_ETA_PI, MU, OMEGA, Turning, theta
from boreprop.arrays import Complexes, Floats
from spirals import paper_spiral


def determinant(turning: Turning, x: Floats, nu: complex) -> complex:
    """The determinant of the linear equations for disturbances e^{νξ} of Θ, θ and μ, and of their conjugates.

    Written for two stabilizers from K(1 − y*/|q|), without the program's contact.
    """
    eta_pi, omega, psi = np.exp(x[LOG_ETA_PI]), x[OMEGA], theta(x) - 1.0
    beam, s, K = turning.beam, turning.s, 1.0 / turning.beam.K_inv[0, 0]
    e = turning.offsets(x)
    q = complex((beam.q_e @ e)[0] + beam.q_g[0] * (e[0] + theta(x)))
    share = x[4] / abs(q)
    along, across = K * (1 - share / 2), K * share / 2 * (q / abs(q)) ** 2  # dF = −along dq − across dq̄
    stiffness = eta_pi * turning.walk + x[MU]
    B, B_bar = ((1 - np.exp(-p * s)) / p for p in (nu + 1j * omega, nu - 1j * omega))
    moment, force = np.zeros((2, 5), complex), np.zeros((2, 5), complex)
    bend = np.zeros((2, 5), complex)  # q and its conjugate by Θ, Θ̄, θ, θ̄, μ
    for k, b in enumerate((B, B_bar)):
        bend[k, k] = (beam.q_e @ b)[0] + beam.q_g[0] * b[0]
        bend[k, 2 + k] = -(beam.q_e @ s)[0]
    wall = -np.array([[along, across], [across.conjugate(), along]]) @ bend
    for k, (b, p) in enumerate(((B, nu + 1j * omega), (B_bar, nu - 1j * omega))):
        moment[k] = beam.M_F[0] * wall[k]
        moment[k, k] += beam.M_e * b[-1] + beam.M_g * b[0]
        moment[k, 2 + k] -= beam.M_e * s[-1] + p * beam.epsilon * eta_pi
        force[k] = beam.F0_F[0] * wall[k]
        held = stiffness if k == 0 else stiffness.conjugate()
        force[k, k] += beam.F0_e * b[-1] + beam.F0_g * b[0] + held
        force[k, 2 + k] -= beam.F0_e * s[-1] + held
        force[k, 4] = -(psi if k == 0 else psi.conjugate())
    gauge = np.array([-psi.conjugate(), -psi, psi.conjugate(), psi, 0.0])
    if x[MU] > 0:
        return complex(np.linalg.det(np.vstack([moment, force, gauge])))
    return complex(np.linalg.det(np.vstack([moment, force])[:, :4]))


def spirals(eta_pi: float, walk_deg: float) -> tuple[Turning, list[Floats]]:
    case = paper_spiral(eta_pi, walk_deg=walk_deg)
    search = Search(case, case.bit.walk_angle)
    found = search.at(eta_pi)
    assert found.own is not None
    assert found.edge is not None
    return search.turning, [found.own, found.edge]


@pytest.mark.parametrize(("eta_pi", "walk_deg"), [(0.01, 0.0), (0.1, 0.0), (0.05, 15.0), (0.05, -15.0)])
def test_the_roots_are_zeros_of_the_determinant(eta_pi: float, walk_deg: float) -> None:
    turning, both = spirals(eta_pi, walk_deg)
    for x in both:
        first: Complexes = roots(turning, x)[:4]
        for root in first.tolist():
            value = determinant(turning, x, root)
            slope = (determinant(turning, x, root + 1e-5) - determinant(turning, x, root - 1e-5)) / 2e-5
            assert abs(value / slope) < 1e-6


def test_no_root_is_missing() -> None:
    """The argument principle on the determinant, which has a root at 0, too."""
    turning, both = spirals(0.05, 0.0)
    left, right, top = -0.2, 10.0, 60.0
    sides = (left - 1j * top, right - 1j * top, right + 1j * top, left + 1j * top, left - 1j * top)
    contour = np.concatenate([np.linspace(a, b, 300) for a, b in pairwise(sides)])
    for x in both:
        value = np.array([determinant(turning, x, nu) for nu in contour.tolist()])
        turns = float(np.angle(value[1:] / value[:-1]).sum()) / (2 * np.pi)
        found = [root for root in roots(turning, x).tolist() if root.real > left]
        assert turns == pytest.approx(1 + sum(2 if root.imag > 0 else 1 for root in found), abs=1e-6)


def test_the_edge_has_unstable_roots_and_the_spiral_has_none() -> None:
    turning, (own, edge) = spirals(0.1, 0.0)
    assert roots(turning, own)[0].real < 0
    assert roots(turning, edge)[0].real > 0

"""Contact forces and bit tilt: the fast path of the integrator against the paper's LCP (15)."""

from math import inf, nan

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from boreprop.analysis.complementarity import lcp, residual
from boreprop.core.beam import Beam
from boreprop.core.modes import Loads, Modes, Regime, bit_tilt, side_beyond
from boreprop.core.system import Scaled
from lemke import lemke
from systems import loads, scaled_systems

System = tuple[Scaled, Loads, float, list[int]]


@st.composite
def systems(draw: st.DrawFn) -> System:
    """A system under loads, its ηΠ, and contacts to start the search from."""
    scaled = draw(scaled_systems())
    guess = [draw(st.sampled_from([-1, 0, 1])) for _ in scaled.y_star]
    return scaled, draw(loads(len(scaled.s))), draw(st.floats(1e-3, 10.0)), guess


def fast_path(system: System) -> tuple[list[float], float]:
    scaled, at, eta_pi, guess = system
    mode = Modes(scaled).settle(at, tuple(guess))
    return [row(at) for row in mode.F], bit_tilt(mode.F_0(at), eta_pi, scaled.psi_star)


@settings(max_examples=500, deadline=None)
@given(systems())
def test_fast_path_gives_the_forces_and_the_tilt_of_the_lcp(system: System) -> None:
    scaled, at, eta_pi, _ = system
    M, q = lcp(Beam(scaled), scaled.y_star, scaled.psi_star, eta_pi, at)
    z = lemke(M, q)
    w = np.array(M) @ z + q
    m = len(scaled.y_star)
    F, psi = fast_path(system)
    assert F == pytest.approx([z[i] - z[m + i] for i in range(m)], abs=1e-9)
    assert psi == pytest.approx(w[2 * m] - scaled.psi_star, abs=1e-9)


@settings(max_examples=500, deadline=None)
@given(systems())
def test_fast_path_solves_the_lcp_by_its_definition(system: System) -> None:
    scaled, at, eta_pi, _ = system
    M, q = lcp(Beam(scaled), scaled.y_star, scaled.psi_star, eta_pi, at)
    F, psi = fast_path(system)
    F_0 = Beam(scaled).bit_force(at.e[-1], F, at.F_rss, at.sin_Theta_1)
    F_hat = 2 * (eta_pi * psi - F_0)  # (12)
    z = [max(f, 0.0) for f in F] + [max(-f, 0.0) for f in F] + [max(F_hat, 0.0), max(-F_hat, 0.0)]
    assert residual(M, q, z) <= 1e-10


@settings(max_examples=200, deadline=None)
@given(systems(), st.sampled_from([-1, 0, 1]))
def test_the_regime_has_the_walls_and_the_saturation_of_the_lcp(system: System, side: int) -> None:
    """From any regime to start from; (12): the tilt is at its limit where F̂ is not zero."""
    scaled, at, eta_pi, guess = system
    modes, m = Modes(scaled), len(scaled.y_star)
    start = Regime(modes.touching(tuple(guess)), side)
    regime = start.settle(lambda regime: (regime.bounds(modes, eta_pi, scaled.psi_star), at))
    z = lemke(*lcp(modes.beam, scaled.y_star, scaled.psi_star, eta_pi, at))
    expected = [z[i] - z[m + i] for i in range(m)] + [z[2 * m + 1] - z[2 * m]]
    for value, got, clearance in zip(
        expected, (*regime.contact, regime.saturation), (*scaled.y_star, 1.0), strict=True
    ):
        if clearance and abs(value) > 1e-9:
            assert got == np.sign(value)


NO_CLEARANCE = Scaled((1.0, 2.0, 2.5, 2.875, 3.1875, 4.6875), (0.0,) * 5, 0.0, 0.0078125, 0.125, 0.03125)


@settings(max_examples=200, deadline=None)
@example((NO_CLEARANCE, Loads([0.0, 0.0, 0.015625, 0.0, 0.0, 0.0], 0.0, 1.0), 1.0, [0] * 5))
@given(systems())
def test_lemke_solves_the_lcp_by_its_definition(system: System) -> None:
    scaled, at, eta_pi, _ = system
    M, q = lcp(Beam(scaled), scaled.y_star, scaled.psi_star, eta_pi, at)
    assert residual(M, q, lemke(M, q)) <= 1e-9


@settings(max_examples=200, deadline=None)
@given(systems())
def test_forces_have_the_least_energy(system: System) -> None:
    """F minimises ½FᵀK⁻¹F + q̃ᵀF + Σ y*_i|F_i|: no other force has less."""
    scaled, at, _, _ = system
    beam = Beam(scaled)
    m = len(scaled.y_star)
    K_inv = np.array(beam.K_inv).reshape(m, m)
    q_tilde = np.array(beam.q_tilde(at.e, at.F_rss, at.sin_Theta_1))

    def energy(F: np.ndarray) -> float:
        return float(F @ K_inv @ F / 2 + q_tilde @ F + np.array(scaled.y_star) @ np.abs(F))

    F = np.array(fast_path(system)[0])
    random = np.random.default_rng(0)
    for size in (1e-2, 1e-3, 1e-4):
        assert energy(F) <= energy(F + size * random.normal(size=F.shape)) + 1e-15


def test_several_stabilizers_touch_different_walls_at_once() -> None:
    scaled = Scaled((1.0, 2.0, 3.0, 4.0), (1e-3, 1e-3, 1e-3), 0.16, 0.0, 0.1, 0.03)
    at = Loads([-0.02, 0.03, -0.02, 0.0], 0.0, 0.0)
    mode = Modes(scaled).settle(at, (0, 0, 0))
    assert mode.contact == (1, -1, 1)
    assert [row(at) for row in mode.delta] == pytest.approx([-1e-3, 1e-3, -1e-3])


def test_without_clearance_a_stabilizer_is_held_on_both_sides() -> None:
    scaled = Scaled((1.0, 2.0), (0.0,), 0.16, 2e-3, 0.1, 0.03)
    for offset in (-1e-3, 0.0, 1e-3):
        at = Loads([offset, 0.0], 0.0, 0.0)
        mode = Modes(scaled).settle(at, (0,))
        assert mode.delta[0](at) == pytest.approx(0.0, abs=1e-15)
        assert mode.F[0](at) == pytest.approx(-offset * 32 / 7)


def test_where_rounding_brings_a_set_of_contacts_back_the_search_ends_with_what_holds_but_for_that() -> None:
    """Stabilizers 0.1 mm apart: the force between them is rounding, 0.1 went round in circles under these loads."""
    l1 = 3.66
    scaled = Scaled((1.0, 3.6601 / l1, 3.6602 / l1, 2.0), (1e-3 / l1,) * 3, 0.16, 2e-3, 0.1, 0.03)
    at = Loads(
        [-0.0050000000000000044, -0.0050002732240438386, -0.005000546448087562, -0.015000000000000124], 0.0, 0.48
    )
    mode = Modes(scaled).settle(at, (0, 0, 0))
    for i, contact in enumerate(mode.contact):
        delta, F = mode.delta[i](at), mode.F[i](at)
        assert abs(delta) <= scaled.y_star[i] + 1e-9
        assert F * contact >= -1e-9


@pytest.mark.parametrize("size", [1e10, 1e100, 1e300, inf, nan])
def test_the_search_for_contacts_ends_under_any_loads(size: float) -> None:
    scaled = Scaled((1.0, 1.004, 1.008, 2.0), (1e-3, 1e-9, 2e-3), 0.16, 2e-3, 0.1, 0.03)
    at = Loads([size, -size / 3, size / 7, 0.0], size, 0.5)
    assert len(Modes(scaled).settle(at, (0, 0, 0)).contact) == 3


def test_residual_is_large_where_z_does_not_solve_the_lcp() -> None:
    M, q = [[1.0, 0.0], [0.0, 1.0]], [-1.0, 2.0]
    assert residual(M, q, [1.0, 0.0]) == 0.0
    assert residual(M, q, [0.0, 0.0]) == 1.0  # infeasible
    assert residual(M, q, [1.0, 3.0]) == 3.0  # not complementary


def test_lemke_reports_a_problem_without_a_solution() -> None:
    with pytest.raises(ArithmeticError, match="secondary ray"):
        lemke([[-1.0]], [-1.0])


@pytest.mark.parametrize(("value", "side"), [(-1.25, 0), (-1.26, -1), (2.25, 0), (2.26, 1)])
def test_a_value_may_lie_beyond_its_bounds_by_the_slack(value: float, side: int) -> None:
    assert side_beyond(value, -1.0, 2.0, 0.25) == side

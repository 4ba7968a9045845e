"""Each engine against solutions that are known exactly, and against itself at tighter tolerances and shorter steps."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from boreprop.core.beam import Beam
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled
from boreprop.run.engines import Engine
from engine_runs import VERTICAL, begin, columns, start, step_ends

ONE = Scaled(s=(1.0,), y_star=(), Delta=0.16, w=0.0, epsilon=0.1, psi_star=1.0)


def test_one_stabilizer_in_a_straight_hole_is_a_matrix_exponential(engine: str) -> None:
    """On the first ℓ₁ the delayed Y is the survey's, here 0, and without gravity the equations are linear."""
    F, eta_pi = 2e-3, 0.05
    beam = Beam(ONE)
    # M = M_e (Y − θ) + M_rss F,  F_0 = F0_e (Y − θ) + F0_rss F
    J = np.array([[-1, 1], [0, 0]]) * beam.M_e / (ONE.epsilon * eta_pi)
    J[1] = [1 + beam.F0_e / eta_pi, -beam.F0_e / eta_pi]
    constant = np.array([beam.M_rss / (ONE.epsilon * eta_pi), -beam.F0_rss / eta_pi]) * F
    rest = np.linalg.solve(J, -constant)
    xis = np.linspace(0.0, 1.0, 50)
    exact = np.array([rest - expm(xi * J) @ rest for xi in xis])
    got = columns(begin(engine, ONE, VERTICAL, F, eta_pi, relative_tolerance=1e-10), xis, F, eta_pi)
    found = np.column_stack((got["bit_inclination"], got["average_inclination[1]"]))
    assert found == pytest.approx(exact, abs=1e-9)


@pytest.mark.parametrize("s", [(1.0,), (1.0, 2.0), (1.0, 1.9, 3.2)])
def test_a_constant_force_without_gravity_and_contact_drills_an_arc(engine: str, s: tuple[float, ...]) -> None:
    """Put Θ = κξ, θ = κξ + ψ into (14), (17): e_n = −ψ λ − κ λ²/2, and M = εηΠ κ, F_0 = ηΠ ψ give κ and ψ."""
    scaled = replace(ONE, s=s, y_star=(1.0,) * (len(s) - 1))
    beam, F, eta_pi, end = Beam(scaled), 1e-3, 0.5, 400.0
    half = s[-1] ** 2 / 2
    left = np.array(
        [
            [scaled.epsilon * eta_pi + beam.M_e * half, beam.M_e * s[-1]],
            [beam.F0_e * half, eta_pi + beam.F0_e * s[-1]],
        ]
    )
    kappa, psi = np.linalg.solve(left, np.array([beam.M_rss, beam.F0_rss]) * F)
    run = begin(engine, scaled, VERTICAL, F, eta_pi, relative_tolerance=1e-9)
    got = columns(run, np.array([end, end + 50.0]), F, eta_pi)
    before, after = got["borehole_inclination"]
    assert got["bit_tilt"][1] == pytest.approx(psi, abs=1e-8)
    assert (after - before) / 50.0 == pytest.approx(kappa, rel=1e-5)
    assert got["borehole_curvature"][1] == pytest.approx(kappa, rel=1e-5)


def test_a_straight_vertical_hole_stays_straight(engine: str) -> None:
    """Rippling and straight drilling exist side by side: without a dogleg nothing starts."""
    scaled = Scaled((1.0, 2.0), (1e-3,), 0.16, 2.4514e-3, 0.1, 0.0349)
    run = begin(engine, scaled, VERTICAL, 0.0, 0.01)
    run.advance(50.0, 0.0, 0.01)
    assert run.outputs()["borehole_inclination"] == 0.0


def test_the_path_is_the_integral_of_the_drilled_inclination(engine: str) -> None:
    xis = np.linspace(0.0, 4.9, 5001)
    got = columns(start(engine, "steering_two_stabilizers"), xis, 2e-3, 0.5)
    Theta, path = got["borehole_inclination"], (got["displacement"][-1], got["true_vertical_depth"][-1])
    assert path == pytest.approx((np.trapezoid(np.sin(Theta), xis), np.trapezoid(np.cos(Theta), xis)), abs=1e-6)


def smooth_run(engine: str, w: float = 2.4e-3, **options: float) -> tuple[Engine, np.ndarray]:
    """A force on a straight inclined hole, free and unsaturated: kinks at the start's images only."""
    scaled = Scaled((1.0, 2.0), (1.0,), 0.16, w, 0.1, 1.0)
    run = begin(engine, scaled, Survey((0.0,), (0.5,)), 2e-3, 0.5, **options)
    got = columns(run, np.linspace(0.0, 20.0, 400), 2e-3, 0.5)
    return run, np.column_stack((got["bit_inclination"], got["average_inclination[1]"]))


def test_error_falls_with_the_tolerance_at_the_order_of_the_method(engine: str) -> None:
    """The estimate is of a local error of order S + 1 = 6 and the error carried on of order S = 5, so the slope of the
    error over the tolerance lies between 5/6 and, where the ends of steps are better still, a little above one.
    """
    _, exact = smooth_run(engine, relative_tolerance=1e-12)
    tolerances = 10.0 ** np.arange(-9, -3)
    errors = [np.abs(smooth_run(engine, relative_tolerance=tol)[1] - exact).max() for tol in tolerances.tolist()]
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert 0.8 < slope < 1.2


def test_error_falls_with_the_step_at_order_five_or_more(engine: str) -> None:
    """Steps of 1/m: the kinks at 1, 2, 3, … lie on the grid, and no layer step and no error estimate disturbs it.

    Without weight, as the iteration on sin⟨Θ⟩_1 stops at the tolerance, here none.
    """
    _, exact = smooth_run(engine, w=0.0, relative_tolerance=1e-12)
    fixed = {"relative_tolerance": 1e-2, "layers": 1e9, "theta_weight": 0.0}
    steps, errors = 1 / np.array([4, 6, 8, 12]), []
    for h in steps.tolist():
        run, got = smooth_run(engine, w=0.0, largest_step=h, **fixed)
        assert np.diff(step_ends(run, 21.0)) == pytest.approx(h)
        assert run.statistics.rejected == 0
        errors.append(np.abs(got - exact).max())
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > 4.5


def test_the_error_of_a_rippling_run_falls_with_the_tolerance(engine: str) -> None:
    """With a hundred events on the way: contact and saturation cost no order."""

    def inclinations(relative_tolerance: float) -> np.ndarray:
        run = start(engine, "fig7_psi_2deg", relative_tolerance=relative_tolerance)
        return columns(run, np.linspace(0.0, 20.0, 1000), 0.0, 0.01)["average_inclination[1]"]

    exact = inclinations(1e-10)
    tolerances = 10.0 ** np.arange(-9, -5)
    errors = [np.abs(inclinations(tolerance) - exact).max() for tolerance in tolerances.tolist()]
    assert np.polyfit(np.log(tolerances), np.log(errors), 1)[0] > 0.8


def test_a_short_stay_beyond_a_bound_between_the_points_of_a_step_is_found(engine: str) -> None:
    """A tilt that leaves saturation and comes back within a step half an ℓ₁ long: loose and tight tolerances agree."""
    scaled = Scaled((1.0, 1.7966442656541493), (9.314e-4,), 0.5938, 7.5747e-3, 0.060913, 2.5946e-3)
    survey = Survey((0.0, 0.5, 1.0), (1.26505, 1.26505, 1.25687))
    ends = []
    for tolerance in (1e-5, 1e-8, 1e-11):
        run = begin(engine, scaled, survey, 3.4404e-3, 0.019786, relative_tolerance=tolerance)
        run.advance(1.1, 3.4404e-3, 0.019786)
        ends.append(run.outputs()["average_inclination[1]"])
    assert ends == pytest.approx([ends[-1]] * 3, abs=2e-6)

"""The integrator: exact solutions, order, breakpoints, its own grid, work and memory over length."""

import gc
import json
import sys
from dataclasses import replace
from math import pi, radians
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from boreprop.core.beam import Beam
from boreprop.core.errors import CannotContinue
from boreprop.core.integrator import Integrator
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled
from reference_cases import at_the_bit, drilled_rows, start
from systems import begin, scaled_systems

ONE = Scaled(s=(1.0,), y_star=(), Delta=0.16, w=0.0, epsilon=0.1, psi_star=1.0)
VERTICAL = Survey((0.0,), (0.0,))


def states(model: Integrator, xis: np.ndarray) -> np.ndarray:
    """θ and Y at increasing positions."""
    rows = []
    for xi in xis:
        model.advance(float(xi))
        rows.append(model.state())
    return np.array(rows)


def test_one_stabilizer_in_a_straight_hole_is_a_matrix_exponential() -> None:
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
    assert states(begin(ONE, VERTICAL, F, eta_pi, 1e-10), xis) == pytest.approx(exact, abs=1e-9)


@pytest.mark.parametrize("s", [(1.0,), (1.0, 2.0), (1.0, 1.9, 3.2)])
def test_a_constant_force_without_gravity_and_contact_drills_an_arc(s: tuple[float, ...]) -> None:
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
    model = begin(scaled, VERTICAL, F, eta_pi, 1e-9)
    model.advance(end)
    before = at_the_bit(model)
    model.advance(end + 50.0)
    after = at_the_bit(model)
    assert after["psi"] == pytest.approx(psi, abs=1e-8)
    assert (after["Theta"] - before["Theta"]) / 50.0 == pytest.approx(kappa, rel=1e-5)


def smooth_run(relative_tolerance: float, w: float = 2.4e-3, **options: Any) -> tuple[Integrator, np.ndarray]:
    """A force on a straight inclined hole, free and unsaturated: kinks at the start's images only."""
    scaled = Scaled((1.0, 2.0), (1.0,), 0.16, w, 0.1, 1.0)
    model = begin(scaled, Survey((0.0,), (0.5,)), 2e-3, 0.5, relative_tolerance, **options)
    return model, states(model, np.linspace(0.0, 20.0, 400))


def test_error_falls_with_the_tolerance_at_the_order_of_the_method() -> None:
    """The estimate is of a local error of order S + 1 = 6 and the error carried on of order S = 5, so the slope of the
    error over the tolerance lies between 5/6 and, where the ends of steps are better still, a little above one.
    """
    _, exact = smooth_run(1e-12)
    tolerances = 10.0 ** np.arange(-9, -3)
    errors = [np.abs(smooth_run(tolerance)[1] - exact).max() for tolerance in tolerances]
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert 0.8 < slope < 1.2


def test_error_falls_with_the_step_at_order_five_or_more() -> None:
    """Steps of 1/m: the kinks at 1, 2, 3, … lie on the grid, and no layer step and no error estimate disturbs it.

    Without weight, as the iteration on sin⟨Θ⟩_1 stops at the tolerance, here none.
    """
    _, exact = smooth_run(1e-12, w=0.0)
    steps, errors = 1 / np.array([4, 6, 8, 12]), []
    for h in steps.tolist():
        model, got = smooth_run(1e-2, w=0.0, layers=1e9, theta_weight=0.0, largest_step=h)
        assert model.present.h == pytest.approx(h)
        assert model.statistics.rejected == 0
        errors.append(np.abs(got - exact).max())
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > 4.5


def test_the_error_of_a_rippling_run_falls_with_the_tolerance() -> None:
    """With 340 events on the way: contact and saturation cost no order."""
    exact = drilled_rows("fig7_psi_2deg", 1e-10)["Y"]
    tolerances = 10.0 ** np.arange(-9, -5)
    errors = [np.abs(drilled_rows("fig7_psi_2deg", tolerance)["Y"] - exact).max() for tolerance in tolerances]
    assert np.polyfit(np.log(tolerances), np.log(errors), 1)[0] > 0.8


def step_ends(model: Integrator, to: float) -> list[float]:
    """Where the integrator's own steps end."""
    ends = []
    while model.xi < to:
        ends.append(model.step().end)
    return ends


def test_the_sine_of_a_bha_that_weight_bends_much_is_solved_to_the_tolerance() -> None:
    """What is left of sin⟨Θ⟩_1 in a step counts by the weight, here w = 20."""
    heavy, places = replace(ONE, w=20.0, Delta=0.0), np.arange(0.1, 3.0, 0.1)
    rough, fine = (
        states(begin(heavy, Survey((0.0,), (0.6,)), 0.0, 0.5, tolerance), places) for tolerance in (1e-6, 1e-11)
    )
    assert np.abs(rough - fine)[:, 1].max() <= 1e-6


def test_steps_end_on_the_images_of_a_force_jump() -> None:
    scaled = Scaled((1.0, 1.7, 2.9), (1e-3, 1e-3), 0.16, 2.4e-3, 0.1, 0.03)
    model = begin(scaled, Survey((0.0,), (0.5,)), 0.0, 0.1, 1e-7)
    model.advance(5.0)
    model.steer(2e-3, 0.1)
    ends = step_ends(model, 9.0)
    first = [5.0 + s_i for s_i in scaled.s]
    second = [5.0 + a + b for a in scaled.s for b in scaled.s if a + b < 3.9]
    for xi in first + second:
        assert min(abs(end - xi) for end in ends) < 1e-8


def test_a_bend_of_the_existing_hole_comes_back_as_a_jump_of_the_second_derivative() -> None:
    """Y' = Θ is continuous at a station, its slope goes from 0.1 to −0.3 there."""
    survey = Survey((0.0, 1.0, 1.5), (0.4, 0.5, 0.35))
    kinks = begin(Scaled((1.0, 1.7), (1e-3,), 0.16, 2.4e-3, 0.1, 0.03), survey, 0.0, 0.1).kinks.ahead
    assert {(kink.xi, kink.order, kink.i, round(kink.jump, 12)) for kink in kinks} >= {
        (0.5, 2, 0, 0.4),
        (1.2, 2, 1, 0.4),
    }


def test_a_small_step_of_force_does_not_cut_the_steps_of_its_images() -> None:
    """A controller changes the force often and little: steps may pass over kinks below the tolerance."""
    model = start("steering_two_stabilizers", 1e-6)
    model.advance(4.37)
    model.steer(model.F_rss + 1e-12, model.eta_pi)
    ends = step_ends(model, 7.0)
    assert min(abs(end - image) for end in ends for image in (5.37, 6.37)) > 1e-8


@settings(max_examples=20, deadline=None)
@given(st.lists(st.floats(0.0, 8.0), max_size=30))
def test_results_do_not_depend_on_where_the_bit_stops_on_the_way(stops: list[float]) -> None:
    straight, stopping = start("fig7_psi_2deg"), start("fig7_psi_2deg")
    straight.advance(8.0)
    for xi in sorted(stops):
        stopping.advance(xi)
        at_the_bit(stopping)
    stopping.advance(8.0)
    assert at_the_bit(stopping) == at_the_bit(straight)


def test_an_input_that_is_set_again_unchanged_restarts_nothing() -> None:
    once, often = start("fig7_psi_2deg"), start("fig7_psi_2deg")
    once.advance(3.0)
    for xi in np.linspace(0.0, 3.0, 300):
        often.steer(often.F_rss, often.eta_pi)
        often.advance(float(xi))
    assert at_the_bit(often) == at_the_bit(once)


@pytest.mark.parametrize("where", [0.0, 0.0137, 4.4, 33.3])
def test_a_saved_state_runs_on_bit_by_bit_also_through_json(where: float) -> None:
    original = start("fig7_psi_2deg")
    original.advance(where)
    saved = json.loads(json.dumps(original.save()))
    original.advance(where + 6.0)
    other = start("fig7_psi_2deg")
    other.restore(saved)
    other.advance(where + 6.0)
    assert at_the_bit(other) == at_the_bit(original)


def test_a_saved_state_does_not_change_while_the_run_goes_on() -> None:
    model = start("fig7_psi_2deg")
    model.advance(5.0)
    saved = model.save()
    before = json.dumps(saved)
    model.advance(15.0)
    assert json.dumps(saved) == before


def assert_failing_changes_nothing(model: Integrator, to: float, code: str, told: str) -> None:
    before = json.dumps(model.save())
    with pytest.raises(CannotContinue, match=told) as caught:
        model.advance(to)
    assert caught.value.code == code
    assert json.dumps(model.save()) == before


def test_steps_that_become_too_short_change_nothing_and_say_what_helps() -> None:
    model, other = start("fig7_psi_2deg", smallest_step=1e-2), start("fig7_psi_2deg")
    other.advance(2.0)
    model.restore(other.save())
    told = "the steps of the integrator become too short at .* m: raise relative_tolerance .*, now 1e-07"
    assert_failing_changes_nothing(model, 4.0, "too short", told)
    other.restore(model.save())
    other.advance(4.0)


def test_a_way_of_too_many_steps_ends_and_changes_nothing() -> None:
    model = start("fig7_psi_2deg", most_steps=200)
    model.advance(2.0)
    assert_failing_changes_nothing(model, 50.0, "too many", "step: must take at most 200 steps of the integrator, got")
    model.advance(4.0)


def test_a_failed_step_changes_nothing() -> None:
    model = start("fig7_psi_2deg", smallest_step=0.5)
    before = json.dumps(model.save())
    with pytest.raises(CannotContinue, match="too short at 0 m"):
        model.step()
    assert json.dumps(model.save()) == before


def test_statistics_count_the_steps_and_the_bounds_met() -> None:
    model = start("fig7_psi_2deg", 1e-5)
    steps = [model.step() for _ in range(300)]
    assert model.statistics.accepted == 300
    assert model.statistics.events == sum(step.event is not None for step in steps[:-1])
    assert 0 < model.statistics.rejected < 300


def test_a_step_that_is_tried_a_second_time_counts_as_rejected_once() -> None:
    """A trial whose error is too large is shortened to 0.85 of its length at most: above 0.85² it was one."""
    model = begin(ONE, VERTICAL, 1e-3, 0.05, 1.4e-5, layers=1e6, largest_step=0.3)
    assert 0.85**2 < model.step().h / 0.3 <= 0.85
    assert model.statistics.rejected == 1


@pytest.mark.parametrize("F_rss", [1e2, 1e6, 1e12, 1e300])
def test_a_force_beyond_all_sense_fails_at_once(F_rss: float) -> None:
    model = start("fig7_psi_2deg")
    with pytest.raises(CannotContinue):
        model.drill(5.0, F_rss, 0.01)
    assert (model.xi, model.F_rss) == (0.0, 0.0)


def test_a_straight_vertical_hole_stays_straight() -> None:
    """Rippling and straight drilling exist side by side: without a dogleg nothing starts."""
    model = begin(start("fig7_psi_2deg").scaled, VERTICAL, 0.0, 0.01, 1e-7)
    model.advance(50.0)
    assert at_the_bit(model)["Theta"] == 0.0


def test_the_path_is_the_integral_of_the_drilled_inclination() -> None:
    model = start("steering_two_stabilizers")
    xis = np.linspace(0.0, 4.9, 20001)
    Theta, positions = [], []
    for xi in xis:
        model.advance(float(xi))
        Theta.append(at_the_bit(model)["Theta"])
        positions.append(model.position())
    x, z = np.trapezoid(np.sin(Theta), xis), np.trapezoid(np.cos(Theta), xis)
    assert positions[-1] == pytest.approx((x, z), abs=1e-6)


@settings(max_examples=25, deadline=None)
@given(scaled_systems(), st.floats(0.005, 2.0), st.floats(-3e-3, 3e-3), st.floats(0.0, pi / 2))
def test_any_system_drills(scaled: Scaled, eta_pi: float, F_rss: float, inclination: float) -> None:
    """One to six stabilizers, with and without clearance: every step is taken, no number is lost."""
    survey = Survey((0.0, 1.0), (inclination, inclination + radians(0.5)))
    model = begin(scaled, survey, F_rss, eta_pi, 1e-6)
    model.advance(3.0)
    assert all(np.isfinite(list(at_the_bit(model).values())))


@settings(max_examples=40, deadline=None)
@given(scaled_systems(), st.floats(0.005, 1.0), st.floats(-3e-3, 3e-3))
def test_the_drilled_hole_has_everywhere_the_inclination_that_the_contact_problem_gives(
    scaled: Scaled, eta_pi: float, F_rss: float
) -> None:
    """Y' of the step's polynomial against Θ from the contact problem solved afresh: no event is passed over.

    Θ = θ − F_0/(ηΠ) multiplies what the step leaves of error in θ and Y by about 1/(ηΠ).
    """
    model = begin(scaled, Survey((0.0, 1.0), (0.5, 0.5 + radians(0.5))), F_rss, eta_pi, 1e-9)
    while model.xi < 3.0:
        step = model.step()
        for xi in np.linspace(step.xi, step.end, 12)[1:-1].tolist():
            model.advance(xi)  # back, within the step
            assert step.derivative(1, xi) == pytest.approx(model.inclination(), abs=1e-6 + 1e-7 / eta_pi)


def test_a_short_stay_beyond_a_bound_between_the_points_of_a_step_is_found() -> None:
    """A tilt that leaves saturation and comes back within a step half an ℓ₁ long: loose and tight tolerances agree."""
    scaled = Scaled((1.0, 1.7966442656541493), (9.314e-4,), 0.5938, 7.5747e-3, 0.060913, 2.5946e-3)
    ends = []
    for tolerance in (1e-5, 1e-8, 1e-11):
        survey = Survey((0.0, 0.5, 1.0), (1.26505, 1.26505, 1.25687))
        model = begin(scaled, survey, 3.4404e-3, 0.019786, tolerance)
        model.advance(1.1)
        ends.append(model.state()[1])
    assert ends == pytest.approx([ends[-1]] * 3, abs=2e-6)


@settings(max_examples=10, deadline=None)
@given(scaled_systems(min_n=2), st.floats(0.02, 1.0))
def test_a_tighter_tolerance_gives_the_same_run(scaled: Scaled, eta_pi: float) -> None:
    """Any system, with its events: two tolerances agree to what the looser one allows."""
    survey = Survey((0.0, 1.0), (0.5, 0.5 + radians(0.3)))
    results = []
    for tolerance in (1e-6, 1e-9):
        model = begin(scaled, survey, 1e-3, eta_pi, tolerance)
        model.advance(3.0)
        results.append(model.state())
    assert results[0] == pytest.approx(results[1], abs=1e-4)


@pytest.mark.slow
def test_work_and_memory_per_length_do_not_grow_over_ten_kilometres() -> None:
    """The paper's rippling case, 10 km of it: 2732 times ℓ₁ = 3.66 m."""
    model = start("fig7_psi_2deg", 1e-6)
    kilometre = 1000 / 3.66
    work, blocks, kept = [], [], []
    for k in range(1, 11):
        model.advance(k * kilometre)
        gc.collect()
        work.append(sum(model.statistics[:2]))
        blocks.append(sys.getallocatedblocks())
        kept.append(len(json.dumps(model.save())))
    per_kilometre = np.diff(work)
    assert per_kilometre.max() <= 1.05 * per_kilometre.min()
    assert max(blocks[1:]) <= blocks[0] + 2000  # a history of 10 km would be 100 000 pieces
    assert max(kept) <= 1.3 * min(kept)

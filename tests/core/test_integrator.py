"""What can be seen of the integrator from inside only; tests/engines holds what both engines promise."""

import gc
import json
import sys
from dataclasses import replace
from math import radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.core.survey import Survey
from boreprop.core.system import Scaled
from reference_cases import at_the_bit, start
from systems import begin, scaled_systems

ONE = Scaled(s=(1.0,), y_star=(), Delta=0.16, w=0.0, epsilon=0.1, psi_star=1.0)


def test_a_saved_state_runs_on_bit_by_bit_also_through_json() -> None:
    original = start("fig7_psi_2deg")
    original.advance(4.4)
    saved = json.loads(json.dumps(original.save()))
    original.advance(10.4)
    other = start("fig7_psi_2deg")
    other.restore(saved)
    other.advance(10.4)
    assert at_the_bit(other) == at_the_bit(original)


def test_each_step_that_ends_on_a_bound_is_counted_once() -> None:
    model = start("fig7_psi_2deg", 1e-5)
    steps = [model.step() for _ in range(300)]
    assert model.statistics.events == sum(step.event is not None for step in steps[:-1])


def test_the_sine_of_a_bha_that_weight_bends_much_is_solved_to_the_tolerance() -> None:
    """What is left of sin⟨Θ⟩_1 in a step counts by the weight, here w = 20."""
    heavy, places = replace(ONE, w=20.0, Delta=0.0), np.arange(0.1, 3.0, 0.1)

    def lateral(tolerance: float) -> list[float]:
        model, found = begin(heavy, Survey((0.0,), (0.6,)), 0.0, 0.5, tolerance), []
        for xi in places.tolist():
            model.advance(xi)
            found.append(model.state()[1])
        return found

    assert lateral(1e-6) == pytest.approx(lateral(1e-11), abs=1e-6)


def test_a_bend_of_the_existing_hole_comes_back_as_a_jump_of_the_second_derivative() -> None:
    """Y' = Θ is continuous at a station, its slope goes from 0.1 to −0.3 there."""
    survey = Survey((0.0, 1.0, 1.5), (0.4, 0.5, 0.35))
    kinks = begin(Scaled((1.0, 1.7), (1e-3,), 0.16, 2.4e-3, 0.1, 0.03), survey, 0.0, 0.1).kinks.ahead
    assert {(kink.xi, kink.order, kink.i, round(kink.jump, 12)) for kink in kinks} >= {
        (0.5, 2, 0, 0.4),
        (1.2, 2, 1, 0.4),
    }


def test_a_step_that_is_tried_a_second_time_counts_as_rejected_once() -> None:
    """A trial whose error is too large is shortened to 0.85 of its length at most: above 0.85² it was one."""
    model = begin(ONE, Survey((0.0,), (0.0,)), 1e-3, 0.05, 1.4e-5, layers=1e6, largest_step=0.3)
    assert 0.85**2 < model.step().h / 0.3 <= 0.85
    assert model.statistics.rejected == 1


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


@pytest.mark.slow
def test_work_and_memory_per_length_do_not_grow_over_kilometres() -> None:
    """The paper's rippling case, 3 km of it: 820 times ℓ₁ = 3.66 m."""
    model = start("fig7_psi_2deg", 1e-6)
    half_a_kilometre = 500 / 3.66
    work, blocks, kept = [], [], []
    for k in range(1, 7):
        model.advance(k * half_a_kilometre)
        gc.collect()
        work.append(sum(model.statistics[:2]))
        blocks.append(sys.getallocatedblocks())
        kept.append(len(json.dumps(model.save())))
    each = np.diff(work)
    assert each.max() <= 1.05 * each.min()
    assert max(blocks[1:]) <= blocks[0] + 2000  # a history of 3 km would be 30 000 pieces
    assert max(kept) <= 1.3 * min(kept)

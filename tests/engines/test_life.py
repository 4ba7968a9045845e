"""What each engine promises of a run: steps, stops, saved states, failures and counts."""

import json
from math import isfinite, pi, radians
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.core.errors import CannotContinue
from boreprop.core.options import Options
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled
from boreprop.run.engines import DRILLING, Engine, held
from engine_runs import begin, start, step_ends
from systems import scaled_systems

RIPPLING, ETA_PI = "fig7_psi_2deg", 0.01


def rippling(engine: str, **options: float) -> Engine:
    return start(engine, RIPPLING, **options)


def kept(run: Engine) -> str:
    """The whole state of a run as text."""
    state = run.save()
    return json.dumps(state.tolist() if isinstance(state, np.ndarray) else state)


# steps and stops


def test_steps_of_the_integrator_lead_where_one_advance_does(engine: str) -> None:
    stepping, straight = rippling(engine), rippling(engine)
    step_ends(stepping, 3.0)
    straight.advance(stepping.drilled_length, 0.0, ETA_PI)
    assert straight.outputs() == stepping.outputs()
    assert straight.statistics == stepping.statistics
    assert straight.statistics.accepted > 10


THREE = Scaled((1.0, 1.7, 2.9), (1e-3, 1e-3), 0.16, 2.4e-3, 0.1, 0.03)


def test_steps_end_on_the_images_of_a_force_jump(engine: str) -> None:
    run = begin(engine, THREE, Survey((0.0,), (0.5,)), 0.0, 0.1, relative_tolerance=1e-11)
    run.advance(5.0, 0.0, 0.1)
    run.advance(5.0, 2e-3, 0.1)
    ends = step_ends(run, 9.0)
    first = [5.0 + s_i for s_i in THREE.s]
    second = [5.0 + a + b for a in THREE.s for b in THREE.s if a + b < 3.9]
    for xi in first + second:
        assert min(abs(end - xi) for end in ends) < 1e-8


def test_a_small_step_of_force_does_not_cut_the_steps_of_its_images(engine: str) -> None:
    """A controller changes the force often and little: steps may pass over kinks below the tolerance."""
    run = start(engine, "steering_two_stabilizers", relative_tolerance=1e-6)
    run.advance(4.37, 2e-3, 0.5)
    run.advance(4.37, 2e-3 + 1e-12, 0.5)
    ends = step_ends(run, 7.0)
    assert min(abs(end - image) for end in ends for image in (5.37, 6.37)) > 1e-8


@settings(max_examples=20)
@given(st.lists(st.floats(0.0, 8.0), max_size=30))
def test_results_do_not_depend_on_where_the_bit_stops_on_the_way(engine: str, stops: list[float]) -> None:
    straight, stopping = rippling(engine), rippling(engine)
    straight.advance(8.0, 0.0, ETA_PI)
    for xi in sorted(stops):
        stopping.advance(xi, 0.0, ETA_PI)
        stopping.outputs()
    stopping.advance(8.0, 0.0, ETA_PI)
    assert stopping.outputs() == straight.outputs()
    assert kept(stopping) == kept(straight)


def test_following_legs_is_advancing_along_each(engine: str) -> None:
    following, advancing = rippling(engine), rippling(engine)
    lengths, forces = np.array([0.5, 0.5, 1.3, 2.0]), np.array([0.0, 1e-3, 1e-3, -1e-3])
    inputs, which = held(3, np.array([-1e-3, 0.0, 1e-3]), ETA_PI, following.bit), np.array([1, 2, 2, 0], dtype=np.intc)
    table = np.full((len(following.outputs()), 3), np.nan).T
    following.follow(lengths, inputs, np.array([1, -1, -1, 0], dtype=np.intc), table, which)
    found = {}
    for length, force in zip(lengths.tolist(), forces.tolist(), strict=True):
        advancing.advance(length, force, ETA_PI)
        found[length, force] = list(advancing.outputs().values())
    assert table[:2].tolist() == [found[2.0, -1e-3], found[0.5, 0.0]]
    assert np.isnan(table[2]).all()
    assert kept(following) == kept(advancing)


def test_a_leg_that_fails_leaves_the_bit_at_the_end_of_the_one_before(engine: str) -> None:
    run = rippling(engine)
    table = np.full((3, len(run.outputs())), np.nan)
    inputs = held(3, np.array([0.0, 1e3, 0.0]), ETA_PI, run.bit)
    with pytest.raises(CannotContinue):
        run.follow(np.arange(1.0, 4.0), inputs, np.arange(3, dtype=np.intc), table)
    assert run.drilled_length == 1.0
    assert np.isnan(table[:, 0]).tolist() == [False, True, True]


# saved states


@pytest.mark.parametrize("where", [0.0, 0.0137, 4.4, 33.3])
def test_a_saved_state_runs_on_bit_by_bit(engine: str, where: float) -> None:
    original, other = rippling(engine), rippling(engine)
    original.advance(where, 0.0, ETA_PI)
    state, text = original.save(), kept(original)
    original.advance(where + 6.0, 0.0, ETA_PI)
    assert kept(original) != text
    other.restore(state)
    assert (other.drilled_length, kept(other)) == (where, text)
    other.advance(where + 6.0, 0.0, ETA_PI)
    assert kept(other) == kept(original)
    assert other.outputs() == original.outputs()


def test_a_run_that_is_restored_takes_over_inputs_that_it_has_had_elsewhere(engine: str) -> None:
    straight, restored = rippling(engine), rippling(engine)
    straight.advance(4.4, 0.0, ETA_PI)
    restored.restore(straight.save())
    restored.advance(4.5, 1e-3, ETA_PI)
    restored.restore(straight.save())
    for run in (straight, restored):
        run.advance(4.4 + 1e-9, 1e-3, ETA_PI)  # within the step
    assert restored.outputs() == straight.outputs()


def test_a_state_after_any_step_can_be_restored(engine: str) -> None:
    run, other = rippling(engine), rippling(engine)
    for _ in range(200):
        run.step()
        other.restore(run.save())
        assert kept(other) == kept(run)


def test_going_back_forgets_the_inputs_since(engine: str) -> None:
    run, same = rippling(engine), rippling(engine)
    for one in (run, same):
        one.advance(5.0, 1e-3, ETA_PI)
    state = run.save()
    run.advance(5.5, -4e-3, 2 * ETA_PI)
    run.restore(state)
    for one in (run, same):
        one.advance(15.0, 1e-3, ETA_PI)
    assert kept(run) == kept(same)


def test_an_input_that_is_set_again_unchanged_restarts_nothing(engine: str) -> None:
    once, often = rippling(engine), rippling(engine)
    once.advance(3.0, 0.0, ETA_PI)
    for xi in np.linspace(0.0, 3.0, 300).tolist():
        often.advance(xi, 0.0, ETA_PI)
    assert kept(often) == kept(once)


# failures


def refused(run: Engine, *leg: float) -> CannotContinue:
    """What the engine says of a leg, or a step, that fails, and that nothing has moved."""
    before, outputs = kept(run), run.outputs()
    with pytest.raises(CannotContinue) as caught:
        run.advance(*leg) if leg else run.step()
    assert kept(run) == before
    assert run.outputs() == outputs
    return caught.value


def test_steps_that_become_too_short_change_nothing_and_say_what_helps(engine: str) -> None:
    short, other = rippling(engine, smallest_step=1e-2), rippling(engine)
    other.advance(2.0, 0.0, ETA_PI)
    short.restore(other.save())
    error = refused(short, 4.0, 0.0, ETA_PI)
    assert error.code == "too short"
    assert error.helps == "raise relative_tolerance (--tolerance), now 1e-07"
    assert str(error) == f"the steps of the integrator become too short at {error.place:.9g} m: {error.helps}"
    assert 2.0 <= error.place < 4.0
    other.restore(short.save())
    other.advance(4.0, 0.0, ETA_PI)


def test_a_failed_step_changes_nothing(engine: str) -> None:
    error = refused(rippling(engine, smallest_step=0.5))
    assert (error.code, error.place) == ("too short", 0.0)


@pytest.mark.parametrize("to", [50.0, 1e9])
def test_a_way_of_too_many_steps_ends_and_changes_nothing(engine: str, to: float) -> None:
    run = rippling(engine, most_steps=200)
    run.advance(2.0, 0.0, ETA_PI)
    error = refused(run, to, 0.0, ETA_PI)
    assert (error.code, error.place) == ("too many", 2.0)
    assert str(error).startswith("from 2 m on, more than 200 steps of the integrator would be needed in one call: ")
    run.advance(4.0, 0.0, ETA_PI)


def test_a_bit_that_turns_over_is_told_with_the_place_from_the_start_of_the_run(engine: str, case: Case) -> None:
    weight = case.active_weight_on_bit
    run = DRILLING[engine](case.bha, case.bit, case.survey, active_weight_on_bit=weight, options=Options())
    run.advance(10.0, 100.0, weight)
    error = refused(run, 40.0, 1e9, weight)
    assert error.code == "turns over"
    assert 10.0 <= error.place < 40.0
    assert str(error).startswith("the bit turns over at 10")
    run.advance(11.0, 100.0, weight)


@pytest.mark.parametrize("F_rss", [1e2, 1e6, 1e12, 1e300])
def test_a_force_beyond_all_sense_fails_at_once(engine: str, F_rss: float) -> None:
    assert refused(rippling(engine), 5.0, F_rss, ETA_PI).code in ("turns over", "not finite", "too short")


# counts


def test_statistics_count_the_steps_and_the_bounds_met(engine: str) -> None:
    run = rippling(engine, relative_tolerance=1e-5)
    for _ in range(300):
        run.step()
    assert run.statistics.accepted == 300
    assert 0 < run.statistics.rejected < 300
    assert 0 < run.statistics.events < 300


def test_no_bound_is_met_where_nothing_touches(engine: str) -> None:
    free = Scaled((1.0, 2.0), (1.0,), 0.16, 0.0, 0.1, 1.0)
    run = begin(engine, free, Survey((0.0,), (0.5,)), 1e-3, 0.5)
    run.advance(10.0, 1e-3, 0.5)
    assert run.statistics.events == 0
    assert run.statistics.accepted >= 10


# any system


@settings(max_examples=25)
@given(scaled_systems(), st.floats(0.005, 2.0), st.floats(-3e-3, 3e-3), st.floats(0.0, pi / 2))
def test_any_system_drills(engine: str, scaled: Scaled, eta_pi: float, F_rss: float, inclination: float) -> None:
    """One to six stabilizers, with and without clearance: every step is taken, no number is lost."""
    survey = Survey((0.0, 1.0), (inclination, inclination + radians(0.5)))
    run = begin(engine, scaled, survey, F_rss, eta_pi, relative_tolerance=1e-6)
    run.advance(3.0, F_rss, eta_pi)
    assert all(isfinite(value) for value in run.outputs().values())


@settings(max_examples=10)
@given(scaled_systems(min_n=2), st.floats(0.02, 1.0))
def test_a_tighter_tolerance_gives_the_same_run(engine: str, scaled: Scaled, eta_pi: float) -> None:
    """Any system, with its events: two tolerances agree to what the looser one allows."""
    survey = Survey((0.0, 1.0), (0.5, 0.5 + radians(0.3)))
    results: list[Any] = []
    for tolerance in (1e-6, 1e-9):
        run = begin(engine, scaled, survey, 1e-3, eta_pi, relative_tolerance=tolerance)
        run.advance(3.0, 1e-3, eta_pi)
        outputs = run.outputs()
        results.append((outputs["bit_inclination"], outputs["average_inclination[1]"]))
    assert results[0] == pytest.approx(results[1], abs=1e-4)

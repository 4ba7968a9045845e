"""Random drilling systems in space, a few of those of fuzz_space.py, some of them made simpler."""

from dataclasses import replace

import numpy as np
import pytest

from boreprop.core.options import Options
from boreprop.kernel.binding import available
from boreprop.run.engines import start_in_space
from fuzz_legs import goes_on_as_it_was
from fuzz_space import SAME, draw, ending, examine_all, plain, way
from space_runs import SpatialCase, direction

pytestmark = pytest.mark.skipif(not available(), reason="the kernel is not built")


@pytest.mark.parametrize("number", [(11, 228), (1001, 2923), (1001, 3413), (1001, 3945)])
def test_each_random_case_that_could_not_be_drilled_is_drilled(number: tuple[int, int]) -> None:
    """A tilt that reaches its limit under hardly any force; stabilizers centimetres apart, one of which comes free."""
    assert ending(*plain(*number)) == ("drilled", None)


def test_contacts_are_searched_for_where_those_that_follow_an_event_have_no_answer() -> None:
    case, tolerance = draw(9004, 103)
    assert ending(replace(case, length=24.0), tolerance) == ("drilled", None)


def test_a_hole_does_not_wind_by_noise_where_clearances_are_far_smaller_than_the_tolerance() -> None:
    case, _ = plain(2002, 6595)  # clearances of 2e-9 ℓ₁
    inclinations = []
    for tolerance in (1e-7, 1e-9):
        run = start_in_space(case, Options(relative_tolerance=tolerance))
        run.advance(0.03 * case.length_scale, case.schedule.rss_force[0], case.active_weight_on_bit)
        inclinations.append(run.outputs()["borehole_inclination"])
    assert inclinations[0] == pytest.approx(inclinations[1], abs=1e-6)


@pytest.mark.parametrize("number", [(4005, 8428), (5001, 30125), (5001, 35143), (7001, 59541), (8001, 4615)])
def test_a_disc_far_smaller_than_the_tolerance_is_not_left_and_entered_in_every_step(number: tuple[int, int]) -> None:
    """Of the tilt, at walks of 84°, 79° and 36°; of stabilizers under hardly any force, in 2e-8 ℓ₁ and in 1e-7 ℓ₁."""
    case, tolerance = draw(*number)
    np.testing.assert_allclose(way(case, tolerance), way(case, tolerance / 10), rtol=0, atol=SAME * tolerance)


@pytest.mark.parametrize("y_star", [8e-8, 1e-8])
def test_a_stabilizer_in_a_clearance_below_the_tolerance_touches_no_more_often_than_under_a_tighter_one(
    y_star: float,
) -> None:
    """Where a hole ends in a bend, and nearly nothing acts on the BHA any more."""
    case = SpatialCase(
        s=(1.0, 2.4, 3.7),
        y_star=(0.0, y_star),
        w=6.4e-6,
        eta_pi=5e-5,
        epsilon=4e-3,
        psi_star=0.04,
        walk=1.551,
        stations=(-4.0, -0.25, 0.0),
        inclination=(0.0, 0.0, 0.0247),
    )
    events = []
    for tolerance in (1e-6, 1e-7, 1e-9):
        run = case.begin(relative_tolerance=tolerance)
        case.advance(run, 0.25)
        events.append(run.statistics.events)
    assert events == [4, 4, 4]


def test_a_bit_that_turns_at_once_by_far_more_than_a_clearance_passes_its_contacts() -> None:
    """θ forgets within 1e-10 ℓ₁ what the hole, which turns by more than a right angle, leaves it."""
    case = SpatialCase(
        s=(1.0, 2.0, 3.0),
        y_star=(1e-5, 1e-8),
        w=1e-4,
        eta_pi=3.2e-6,
        epsilon=1.28e-4,
        psi_star=0.0164,
        walk=0.75,
        stations=(-4.71, -0.43, 0.0),
        inclination=(2.568, 2.568, -2.607),
        azimuth=(-2.957, -2.957, -2.93),
    )
    coarse, fine = (direction(case.rows([1e-3], relative_tolerance=tolerance)[0], "bit") for tolerance in (1e-6, 1e-8))
    np.testing.assert_allclose(coarse, fine, rtol=0, atol=SAME * 1e-6)


def test_hardly_a_step_is_tried_in_vain_with_a_body_on_the_wall_at_many_points() -> None:
    case, tolerance = draw(3001, 13368)
    run = start_in_space(case, Options(relative_tolerance=tolerance))
    run.advance(2.9, case.schedule.rss_force[0], case.active_weight_on_bit, weight_on_bit=case.weight_on_bit)
    assert run.statistics.rejected < run.statistics.accepted / 2


def test_a_run_that_is_saved_where_its_body_turned_round_near_the_wall_goes_on_as_it_was() -> None:
    assert goes_on_as_it_was(*draw(5001, 2620))


def test_random_cases_in_space_do_not_fail() -> None:
    assert [found for found in examine_all(5, range(20, 41)) if found[2]] == []

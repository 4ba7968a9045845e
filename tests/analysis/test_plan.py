"""Holes of surveys, plans and runs, and how far they are off a plan, against closed forms."""

import math

import numpy as np
import pytest

from boreprop.analysis.hole import HoleAxis, SurveyedHole, existing_hole, turning
from boreprop.analysis.plan import deviation_from, planned_hole
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.completion import axis_of


def test_a_path_of_few_stations_is_exactly_an_arc() -> None:
    length, curvature, start = np.array([0.0, 11.0, 130.0, 200.0]), 3e-3, 0.2
    inclination = start + curvature * length
    x = (math.cos(start) - np.cos(inclination)) / curvature
    z = (np.sin(inclination) - math.sin(start)) / curvature
    np.testing.assert_allclose(axis_of(length, inclination), np.column_stack((x, z)), atol=1e-11)


def test_an_existing_hole_ends_at_the_origin_and_goes_on_straight_above_its_survey() -> None:
    hole = existing_hole(Survey((2594.0, 2600.0), (0.3, 0.5)), reach=20.0, spacing=0.1)
    assert hole.length[0] == -20.0
    np.testing.assert_array_equal(hole.position[-1], 0.0)
    slope = np.diff(hole.at(np.array([-20.0, -6.0])), axis=0) / 14.0
    np.testing.assert_allclose(slope, [[math.sin(0.3), math.cos(0.3)]], atol=1e-12)
    radius = 6.0 / 0.2
    np.testing.assert_allclose(np.linalg.norm(hole.at(np.array(-6.0))), 2 * radius * math.sin(0.1), atol=1e-12)


def test_a_hole_keeps_every_position_from_the_given_length_on() -> None:
    hole = HoleAxis(np.array([-2.0, -1.0, 0.0, 3.0]), np.arange(8.0).reshape(4, 2))
    lengths = np.linspace(-0.5, 3.0, 9)
    np.testing.assert_array_equal(hole.since(-0.5).at(lengths), hole.at(lengths))


def test_an_evenly_curved_hole_turns_by_its_curvature() -> None:
    hole = existing_hole(Survey((0.0, 100.0), (0.2, 0.5)), reach=20.0, spacing=0.1)
    rate = turning(hole, np.array([0.0, -20.0]), over=30.0, chord=3.66)
    np.testing.assert_allclose(rate, 3e-3, rtol=1e-6)


def test_a_plan_passes_where_drilling_starts_and_follows_its_stations() -> None:
    plan = planned_hole(Survey((1000.0, 1100.0, 1200.0), (0.3, 0.3, 0.7)), start=1050.0)
    np.testing.assert_allclose(plan.at(np.array(0.0)), 0.0, atol=1e-9)
    np.testing.assert_allclose(plan.at(np.array(50.0)), [50 * math.sin(0.3), 50 * math.cos(0.3)], atol=1e-9)
    turn = 250.0 * np.array([math.cos(0.3) - math.cos(0.7), math.sin(0.7) - math.sin(0.3)])
    np.testing.assert_allclose(plan.at(np.array(150.0)) - plan.at(np.array(50.0)), turn, atol=1e-9)


@pytest.mark.parametrize("curvature", [2e-3, -4e-3])
def test_an_arc_leaves_a_straight_plan_by_its_sagitta(curvature: float) -> None:
    """A plan at inclination a, and a hole that leaves it with curvature k: across (1 − cos kL)/k, at an angle kL."""
    start, over, length = 0.6, 7.0, np.linspace(0.0, 300.0, 31)
    plan = planned_hole(Survey((1000.0, 2000.0), (start, start)), start=1500.0)
    stations = np.linspace(-10.0, 300.0, 60_000)
    inclination = start + curvature * np.maximum(stations, 0.0)
    position = axis_of(stations, inclination)
    hole = HoleAxis(stations, position - position[np.searchsorted(stations, 0.0)])
    found = deviation_from(plan, hole, length, over)
    np.testing.assert_allclose(found.distance, (1 - np.cos(curvature * length)) / curvature, atol=1e-3)
    later = length >= over
    np.testing.assert_allclose(found.inclination[later], curvature * (length[later] - over / 2), atol=1e-6)
    assert found.distance[0] == pytest.approx(0.0, abs=1e-3)


def test_an_arc_beside_a_planned_arc_is_as_far_off_as_the_circles_are_apart() -> None:
    """Two circles through the origin with one tangent: the distance is from a point of one to the other's centre."""
    plan = SurveyedHole.of(Survey((0.0, 500.0), (0.0, 500.0 / 300.0)), 0.0)  # about (300, 0)
    length = np.linspace(0.0, 400.0, 41)
    hole = SurveyedHole.of(Survey((0.0, 500.0), (0.0, 500.0 / 400.0)), 0.0)
    position = hole.at(length)
    _, across = plan.away(position, plan.nearest(position, length))
    np.testing.assert_allclose(across, 300.0 - np.hypot(position[:, 0] - 300.0, position[:, 1]), atol=1e-9)
    assert across[-1] < -40.0  # it is below the plan, which builds faster


def test_the_nearest_point_is_where_the_plan_is_nearest_of_all() -> None:
    depth = np.cumsum([0.0, 60.0, 50.0, 90.0, 40.0, 70.0])
    plan = SurveyedHole.of(Survey(tuple(depth), (0.0, 0.1, 0.5, 0.3, 0.3, 0.8)), 0.0)
    length = np.linspace(20.0, 290.0, 100)
    position = plan.at(length) + 12.0 * np.random.default_rng(3).uniform(-1.0, 1.0, (100, 2))
    dense = plan.at(np.linspace(0.0, 310.0, 62_001))  # a point every 5 mm
    least = np.array([np.hypot(*(dense - point).T).min() for point in position])
    along, across = plan.away(position, plan.nearest(position, length))
    np.testing.assert_allclose(along, 0.0, atol=1e-8)
    assert np.all(np.abs(across) < least + 1e-9)
    assert np.all(np.hypot(across, 0.0026) > least)


def test_a_hole_as_planned_is_not_off_its_plan_and_below_the_plan_nothing_is_said() -> None:
    plan = planned_hole(Survey((100.0, 200.0, 260.0), (0.1, 0.1, 0.5)), start=150.0)
    hole = HoleAxis(length := np.linspace(-20.0, 130.0, 15_001), plan.at(length))
    found = deviation_from(plan, hole, np.linspace(0.0, 120.0, 13), over=10.0)
    np.testing.assert_allclose(found.distance[:12], 0.0, atol=1e-6)
    np.testing.assert_allclose(found.inclination[:12], 0.0, atol=1e-6)
    assert np.isnan([found.distance[12], found.inclination[12], found.planned_inclination[12]]).all()


def test_a_plan_that_does_not_include_the_start_is_refused() -> None:
    with pytest.raises(InputError, match=r"must include 90 m, where drilling starts, got 100 to 260"):
        planned_hole(Survey((100.0, 260.0), (0.1, 0.5)), start=90.0)


def test_a_plan_that_turns_is_refused_in_the_plane() -> None:
    with pytest.raises(InputError, match=r"must be the same everywhere .*drilling.dimensions = 3"):
        planned_hole(Survey((100.0, 260.0), (0.1, 0.5), (0.0, 0.5)), start=150.0)

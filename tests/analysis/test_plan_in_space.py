"""The deviation of a hole in space from its plan, against points put beside it and the nearest of many points."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from boreprop.analysis.hole import HoleAxis
from boreprop.analysis.plan_in_space import deviation_in_space, planned_in_space
from boreprop.core.survey import Survey
from boreprop.errors import InputError

Array = NDArray[np.float64]
BIT = Survey((0.0, 100.0), (0.6, 0.6), (1.0, 1.0))


def integrated(plan: Survey, length: Array) -> tuple[Array, Array]:
    """Directions and positions along a plan from its first station on, by turning and adding up short pieces."""
    depth = np.array(plan.measured_depth) - plan.measured_depth[0]
    sine = np.sin(plan.inclination)
    station = np.column_stack((sine * np.cos(plan.azimuth), sine * np.sin(plan.azimuth), np.cos(plan.inclination)))
    fine = np.linspace(0.0, depth[-1], 40_001)
    piece = np.clip(np.searchsorted(depth, fine, side="right") - 1, 0, len(depth) - 2)
    share = ((fine - depth[piece]) / np.diff(depth)[piece])[:, None]
    a, b = station[piece], station[piece + 1]
    turn = np.arccos(np.clip(np.sum(a * b, axis=1), -1.0, 1.0))[:, None]
    direction = (np.sin((1 - share) * turn) * a + np.sin(share * turn) * b) / np.sin(turn)
    steps = (direction[1:] + direction[:-1]) / 2 * np.diff(fine)[:, None]
    position = np.concatenate((np.zeros((1, 3)), np.cumsum(steps, axis=0)))
    found = [np.column_stack([np.interp(length, fine, part) for part in of.T]) for of in (direction, position)]
    return found[0], found[1]


def hole_through(length: Array, position: Array) -> HoleAxis:
    """A hole through points, with one 9 m before the first one."""
    before = position[:1] - 9.0 * (position[1:2] - position[:1]) / (length[1] - length[0])
    return HoleAxis(np.append(length[0] - 9.0, length), np.concatenate((before, position)))


def winding(rng: np.random.Generator) -> Survey:
    """A plan from 0 to 400 m that turns by some 5°/30 m."""
    inclination = np.clip(0.7 + np.cumsum(rng.normal(0.0, 0.15, 9)), 0.2, 1.5)
    return Survey(tuple(np.arange(0.0, 401.0, 50.0)), tuple(inclination), tuple(1.0 + np.cumsum(rng.normal(0, 0.2, 9))))


@pytest.mark.parametrize("seed", range(5))
def test_a_hole_beside_its_plan_is_as_far_off_to_either_side_as_it_was_put(seed: int) -> None:
    rng = np.random.default_rng(seed)
    plan = winding(rng)
    at = np.linspace(120.0, 380.0, 60)
    direction, position = integrated(plan, at)
    _, start = integrated(plan, np.array([100.0]))
    high, right = rng.uniform(-20.0, 20.0, (2, len(at)))
    level = np.column_stack((-direction[:, 1], direction[:, 0], np.zeros(len(at))))
    level /= np.linalg.norm(level, axis=1)[:, None]
    up = np.array([0.0, 0.0, -1.0]) + direction * direction[:, 2:]
    up /= np.linalg.norm(up, axis=1)[:, None]
    beside = position - start + high[:, None] * up + right[:, None] * level
    off = deviation_in_space(planned_in_space(plan, BIT), hole_through(at - 100.0, beside), at - 100.0, 5.0)
    np.testing.assert_allclose(off.high, high, atol=1e-3)
    np.testing.assert_allclose(off.right, right, atol=1e-3)
    np.testing.assert_allclose(off.distance, np.hypot(high, right), atol=1e-3)


def test_no_point_of_the_plan_is_nearer() -> None:
    rng = np.random.default_rng(7)
    plan = winding(rng)
    fine = np.linspace(0.0, 400.0, 8001)
    _, many = integrated(plan, fine)
    _, start = integrated(plan, np.array([100.0]))
    length = np.linspace(20.0, 280.0, 40)
    wandering = integrated(plan, length + 100.0)[1] - start + np.cumsum(rng.normal(0.0, 1.0, (40, 3)), axis=0)
    off = deviation_in_space(planned_in_space(plan, BIT), hole_through(length, wandering), length, 5.0)
    nearest = np.linalg.norm(wandering[:, None] - (many - start), axis=2).min(axis=1)
    np.testing.assert_allclose(off.distance, nearest, atol=1e-3)


def test_directions_are_compared_at_equal_measured_depth_round_north() -> None:
    """A straight hole at an azimuth of 10° and a straight plan at 350°: the difference is 20°, not -340°."""
    plan = Survey((0.0, 300.0), (0.5, 0.5), (math.radians(350.0),) * 2)
    length = np.array([10.0, 100.0, 199.0, 201.0])
    level = math.sin(0.6) * np.array([math.cos(math.radians(10.0)), math.sin(math.radians(10.0))])
    path = length[:, None] * np.append(level, math.cos(0.6))
    off = deviation_in_space(planned_in_space(plan, BIT), hole_through(length, path), length, 5.0)
    np.testing.assert_allclose(off.azimuth[:3], math.radians(20.0))
    np.testing.assert_allclose(off.inclination[:3], 0.1)
    np.testing.assert_allclose(off.planned_azimuth[:3], math.radians(350.0))
    assert np.isnan([off.azimuth[3], off.distance[3], off.inclination[3]]).all()  # beyond the end of the plan


def test_a_plan_without_azimuths_lies_where_the_hole_starts_to() -> None:
    flat, turned = Survey((0.0, 400.0), (0.2, 1.2)), Survey((0.0, 400.0), (0.2, 1.2), (1.0, 1.0))
    length = np.linspace(-100.0, 300.0, 9)
    found = planned_in_space(flat, BIT).at(length)
    np.testing.assert_allclose(found, planned_in_space(turned, BIT).at(length), atol=1e-12)
    assert found[length == 0.0] == pytest.approx(np.zeros((1, 3)), abs=1e-12)


def test_beside_a_vertical_plan_there_is_no_high_side() -> None:
    plan = planned_in_space(Survey((0.0, 400.0), (0.0, 0.0)), BIT)
    length = np.array([10.0, 20.0])
    hole = HoleAxis(np.array([0.0, 10.0, 20.0]), np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 10.0], [3.0, 4.0, 20.0]]))
    off = deviation_in_space(plan, hole, length, 5.0)
    np.testing.assert_allclose(off.distance, 5.0)
    assert np.isnan([off.high, off.right, off.azimuth, off.planned_azimuth]).all()


def test_a_plan_that_does_not_reach_the_start_is_refused() -> None:
    with pytest.raises(InputError, match="must include 100 m, where drilling starts"):
        planned_in_space(Survey((0.0, 90.0), (0.0, 0.0), (0.0, 0.0)), BIT)

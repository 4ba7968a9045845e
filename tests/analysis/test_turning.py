"""How holes in space turn, against wells and helices in closed form."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from boreprop.analysis.axis import axis_away
from boreprop.analysis.hole import HoleAxis
from boreprop.analysis.turning import beside_trend, dogleg_severity, existing_in_space, turning_in_space
from boreprop.core.survey import Survey

Vectors = NDArray[np.float64]
PER_30_M = np.deg2rad(1.0) / 30.0


def turning_well(inclination: float, walk: float) -> HoleAxis:
    """A well of constant inclination, rad, whose azimuth grows by `walk`, rad/m, from −20°: exact positions."""
    length = np.arange(0.0, 200.0, 0.05)
    azimuth = np.deg2rad(-20.0) + walk * length
    north, east = np.sin(inclination) / walk * np.array([np.sin(azimuth), -np.cos(azimuth)])
    return HoleAxis(length, np.column_stack((north, east, length * np.cos(inclination))))


def helix(axis: Vectors, radius: float, pitch: float, sense: float) -> tuple[HoleAxis, Vectors]:
    """A helix around a straight axis, and its vector from that axis at each point."""
    along = np.arange(0.0, 150.0, 0.02)
    side = np.cross(axis, [0.3, -0.5, 0.1])
    side /= np.linalg.norm(side)
    turn = sense * 2 * np.pi * along / pitch
    away = radius * (np.cos(turn)[:, None] * side + np.sin(turn)[:, None] * np.cross(axis, side))
    return HoleAxis(along, along[:, None] * axis + away), away


@pytest.mark.parametrize("inclination", [10.0, 30.0, 90.0])
@pytest.mark.parametrize("walk", [3.0, -2.0])
def test_a_well_that_turns_at_a_constant_inclination_walks_and_does_not_build(inclination: float, walk: float) -> None:
    hole, at = turning_well(np.deg2rad(inclination), walk * PER_30_M), np.array([60.0, 120.0, 199.0])
    build, walked = turning_in_space(hole, at, over=30.0, chord=5.0)
    np.testing.assert_allclose(walked, walk * PER_30_M, rtol=1e-4)
    np.testing.assert_allclose(build, 0.0, atol=1e-6 * PER_30_M)
    severity = dogleg_severity(hole, at, over=5.0)
    np.testing.assert_allclose(severity, abs(walk) * PER_30_M * np.sin(np.deg2rad(inclination)), rtol=1e-3)


def test_a_nearly_vertical_hole_has_no_walk_rate_and_still_a_dogleg() -> None:
    hole, at = turning_well(np.deg2rad(2.9), 40 * PER_30_M), np.array([100.0])
    assert np.isnan(turning_in_space(hole, at, over=30.0, chord=1.0)[1]).all()
    assert dogleg_severity(hole, at, over=1.0)[0] == pytest.approx(40 * PER_30_M * np.sin(np.deg2rad(2.9)), rel=1e-3)


def test_an_azimuth_that_passes_south_does_not_jump() -> None:
    hole = turning_well(np.deg2rad(40.0), 60 * PER_30_M)
    walk = turning_in_space(hole, np.arange(40.0, 199.0), over=30.0, chord=1.0)[1]
    np.testing.assert_allclose(walk, 60 * PER_30_M, rtol=1e-3)


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("down", [(0.0, 0.0, 1.0), (0.5, 0.2, 0.8), (-0.7, 0.7, 0.1)])
def test_beside_its_trend_a_helix_is_a_circle_of_its_radius_and_its_sense(
    down: tuple[float, float, float], sense: float
) -> None:
    axis = np.array(down) / np.linalg.norm(down)
    hole, truth = helix(axis, radius=0.02, pitch=5.0, sense=sense)
    length, away, forward = axis_away(hole.length, hole.position, 3.6)
    beside = beside_trend(away, forward)
    np.testing.assert_allclose(np.hypot(*beside.T), 0.02, rtol=2e-2)
    turn = np.unwrap(np.arctan2(beside[:, 1], beside[:, 0]))
    np.testing.assert_allclose(np.diff(turn) / np.diff(length), sense * 2 * np.pi / 5.0, rtol=2e-2)
    if axis[2] == 1.0:  # then the parts are those to north and to east
        exact = np.column_stack([np.interp(length, hole.length, part) for part in truth.T])
        np.testing.assert_allclose(beside, exact[:, :2], atol=4e-4)


def test_the_existing_hole_has_the_positions_of_minimum_curvature() -> None:
    depth, inclination, azimuth = (0.0, 30.0, 75.0), np.deg2rad([5.0, 12.0, 20.0]), np.deg2rad([350.0, 20.0, 60.0])
    survey = Survey(depth, tuple(inclination), tuple(azimuth))
    hole = existing_in_space(survey, reach=100.0, spacing=0.5)
    station: list[Any] = [hole.at(np.array(at - depth[-1])) for at in depth]
    for k in (0, 1):
        (one, two), (a, b) = inclination[k : k + 2], azimuth[k : k + 2]
        dogleg = np.arccos(np.cos(two - one) - np.sin(one) * np.sin(two) * (1 - np.cos(b - a)))
        factor = (depth[k + 1] - depth[k]) / 2 * (2 / dogleg) * np.tan(dogleg / 2)
        north = factor * (np.sin(one) * np.cos(a) + np.sin(two) * np.cos(b))
        east = factor * (np.sin(one) * np.sin(a) + np.sin(two) * np.sin(b))
        down = factor * (np.cos(one) + np.cos(two))
        np.testing.assert_allclose(station[k + 1] - station[k], (north, east, down), atol=1e-9)
    assert hole.length[0] == -100.0

"""Sensors in space: against the planar law, finite elements in two planes, and turns of the whole."""

from dataclasses import replace
from math import cos, pi, radians, sin
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from beam_in_elements import Elements
from boreprop.case.paper import paper_case
from boreprop.core.options import Options
from boreprop.core.sensors import normal
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock
from boreprop.kernel.binding import NativeDrilling, available
from boreprop.kernel.space import SpaceDrilling
from space_runs import IN_SECTIONS, TURNING, Outputs, Vector, direction, pair

pytestmark = pytest.mark.skipif(not available(), reason="the kernel is not built")

INSTRUMENTS: dict[str, Any] = {
    "sensor_positions": (0.0, 1.3, 3.66, 5.0, 6.0),
    "sensor_intervals": (0.0, 0.0, 0.0, 0.0, 2.3),
    "sensor_biases": (0.0, 0.0, 0.0, radians(0.1), 0.0),
    "sensor_noises": (0.0, 0.0, 0.0, 0.0, 1e-3),
    "sensor_seeds": (0, 0, 0, 0, 7),
    "sensor_body_clearances": (0.02,) * 5,
}
SENSING = replace(IN_SECTIONS, sensor_positions=(0.0, 2.0, 6.5, 16.0), sensor_body_clearances=(0.05,) * 4)
SENSING_TURN = replace(TURNING, sensors=(0.7, 1.0, 2.5))


def axis(row: Outputs, i: int) -> Vector:
    """The axis of the BHA at a sensor, north, east and down."""
    return direction({f"at_{name}": row[f"sensor_{name}[{i}]"] for name in ("inclination", "azimuth")}, "at")


def same_in_both(flat: Outputs, row: Outputs, azimuth: float, i: int) -> None:
    assert axis(row, i) == pytest.approx(
        [*(sin(flat[f"sensor_inclination[{i}]"]) * np.array([cos(azimuth), sin(azimuth)])),
         cos(flat[f"sensor_inclination[{i}]"])], abs=1e-7
    )  # fmt: skip
    scale = 1e-7 * 1e6
    assert pair(row, "sensor_bending_moment", i) == pytest.approx([flat[f"sensor_bending_moment[{i}]"], 0.0], abs=scale)
    assert row[f"sensor_bending_moment[{i}]"] == pytest.approx(abs(flat[f"sensor_bending_moment[{i}]"]), abs=scale)
    assert row[f"sensor_clearance[{i}]"] == pytest.approx(flat[f"sensor_clearance[{i}]"], abs=1e-7)


def test_in_a_vertical_plane_sensors_are_those_of_the_planar_law() -> None:
    case, options, azimuth = paper_case(), Options(relative_tolerance=1e-9), 2.0
    bha = replace(case.bha, **(INSTRUMENTS | {"sensor_noises": (0.0,) * 5}))
    survey = Survey((0.0, 7.32), (0.3, 0.31))
    inputs: dict[str, Any] = {"active_weight_on_bit": case.active_weight_on_bit, "rss_force": 3e3, "options": options}
    planar = NativeDrilling(bha, case.bit, survey, **inputs)
    spatial = SpaceDrilling(bha, case.bit, survey, (azimuth,) * 2, **inputs)
    for length in (0.0, 3.0, 20.0):
        for run in (planar, spatial):
            run.advance(length, 3e3, case.active_weight_on_bit)
        for i in range(1, 6):
            same_in_both(planar.outputs(), spatial.outputs(), azimuth, i)


def test_sensors_on_sections_under_axial_load_are_those_of_the_planar_law() -> None:
    bit, survey = BitRock(20.0, 1.0, 0.02), Survey((0.0, 17.0), (0.7, 0.72))
    inputs: dict[str, Any] = {"active_weight_on_bit": 8e3, "rss_force": 4e3, "weight_on_bit": 8e4}
    planar = NativeDrilling(SENSING, bit, survey, **inputs)
    spatial = SpaceDrilling(SENSING, bit, survey, (0.3, 0.3), **inputs)
    for i in range(1, 5):
        same_in_both(planar.outputs(), spatial.outputs(), 0.3, i)


@pytest.mark.parametrize("toolface", [0.0, 1.1, pi / 2, 4.0])
def test_axis_moment_and_clearance_are_those_of_finite_elements_in_two_planes(toolface: float) -> None:
    """In a straight hole, where the weight pulls to the low side and the pads to the toolface."""
    inclination, azimuth, force, weight = 0.7, 0.3, 2e4, 8e4
    run = SpaceDrilling(
        SENSING,
        BitRock(20.0, 1.0, 0.02),
        Survey((0.0, 17.0), (inclination, inclination)),
        (azimuth, azimuth),
        active_weight_on_bit=8e3,
        rss_force=force,
        rss_toolface=toolface,
        weight_on_bit=weight,
    )
    row, planes = run.outputs(), []
    for side, share in enumerate((cos(toolface), sin(toolface))):
        elements = Elements(SENSING, weight, inclination, sin(inclination) * (not side))
        elements.push(SENSING.rss_position, force * share)
        for i, s in enumerate(SENSING.stabilizer_positions[:-1], 1):
            elements.push(s, pair(row, "stabilizer_force", i)[side])
        planes.append((elements, elements.solve(0.0 if side else -SENSING.end_deflection)))
    frame = Rotation.from_euler("ZY", [azimuth, inclination]).as_matrix()  # high, right, ahead
    for i, s in enumerate(SENSING.sensor_positions, 1):
        v, slope = np.array([bent[2 * elements.node(s) :][:2] for elements, bent in planes]).T
        ahead = frame @ [-slope[0], -slope[1], 1.0]
        assert axis(row, i) == pytest.approx(ahead / np.linalg.norm(ahead), abs=1e-7)
        assert row[f"sensor_clearance[{i}]"] == pytest.approx(0.05 - np.hypot(*v), abs=1e-7)
        moments = [elements.moment(bent, s) for elements, bent in planes]
        assert pair(row, "sensor_bending_moment", i) == pytest.approx(moments, abs=30.0)  # of 50 kN m


def test_without_weight_a_bha_in_any_plane_is_bent_as_in_a_vertical_one() -> None:
    given = replace(SENSING_TURN, w=0.0, walk=0.0, reference="frame", toolface=0.0, azimuth=(0.0,) * 4)
    tilt = Rotation.from_rotvec([0.5, 0.1, 0.9]).as_matrix()
    turned = [tilt @ [sin(angle), 0.0, cos(angle)] for angle in given.inclination]
    tilted = replace(
        given,
        inclination=tuple(float(np.arccos(d[2])) for d in turned),
        azimuth=tuple(float(np.arctan2(d[1], d[0])) for d in turned),
    )
    high, normal_of_plane = tilt @ [cos(0.51), 0.0, -sin(0.51)], tilt @ [0.0, 1.0, 0.0]
    own = np.array([cos(tilted.azimuth[-1]), sin(tilted.azimuth[-1]), 0.0]) * cos(tilted.inclination[-1])
    own[2] = -sin(tilted.inclination[-1])
    right = np.cross(turned[-1], own)
    tilted = replace(tilted, toolface=float(np.arctan2(high @ right, high @ own)))
    [flat], [row] = (case.rows([4.0], relative_tolerance=1e-9) for case in (given, tilted))
    for i in (1, 2, 3):
        assert axis(row, i) == pytest.approx(tilt @ axis(flat, i), abs=1e-8)
        assert axis(row, i) @ normal_of_plane == pytest.approx(0.0, abs=1e-9)
        for name in ("sensor_bending_moment", "sensor_clearance"):
            assert row[f"{name}[{i}]"] == pytest.approx(flat[f"{name}[{i}]"], abs=1e-8)


def test_a_turn_about_the_vertical_turns_the_sensors() -> None:
    turned = replace(SENSING_TURN, azimuth=tuple(a + 2.0 for a in SENSING_TURN.azimuth))
    [row], [other] = (case.rows([7.0], relative_tolerance=1e-9) for case in (SENSING_TURN, turned))
    turn = np.array([[cos(2.0), -sin(2.0), 0.0], [sin(2.0), cos(2.0), 0.0], [0.0, 0.0, 1.0]])
    for i in (1, 2, 3):
        assert axis(other, i) == pytest.approx(turn @ axis(row, i), abs=1e-9)
        assert pair(other, "sensor_bending_moment", i) == pytest.approx(pair(row, "sensor_bending_moment", i), abs=1e-9)
        assert np.hypot(*pair(row, "sensor_bending_moment", i)) == pytest.approx(row[f"sensor_bending_moment[{i}]"])


# readings


def instrument(inclination: float, **changes: Any) -> SpaceDrilling:
    case = paper_case()
    bha = replace(case.bha, **(INSTRUMENTS | changes))
    survey = Survey((0.0, 7.32), (inclination, inclination))
    weight = case.active_weight_on_bit
    return SpaceDrilling(bha, case.bit, survey, (1.0, 1.0), active_weight_on_bit=weight)


def test_noise_turns_the_axis_to_its_sides_as_much_as_up_and_down() -> None:
    noise, inclination = 1e-3, 0.4
    errors = []
    for seed in range(200):
        row = instrument(inclination, sensor_seeds=(0, 0, 0, 0, seed), sensor_positions=(6.0,) * 5).outputs()
        up = row["sensor_inclination[5]"] - row["sensor_inclination[1]"]
        errors.append((up, (row["sensor_azimuth[5]"] - row["sensor_azimuth[1]"]) * sin(inclination)))
        assert up == pytest.approx(noise * normal(seed, 4, 0), abs=1e-14)  # as in the plane
    found = np.array(errors)
    assert found.std(axis=0) == pytest.approx([noise, noise], rel=0.15)
    assert abs(np.corrcoef(found.T)[0, 1]) < 0.2


def test_beyond_the_vertical_a_sensor_looks_to_the_other_side() -> None:
    row = instrument(radians(0.02), sensor_biases=(0.0, 0.0, 0.0, radians(-0.5), 0.0)).outputs()
    unbiased = instrument(radians(0.02), sensor_biases=(0.0,) * 5).outputs()
    expected = radians(0.5) - unbiased["sensor_inclination[4]"]
    assert row["sensor_inclination[4]"] == pytest.approx(expected, abs=1e-15)
    assert abs(row["sensor_azimuth[4]"] - unbiased["sensor_azimuth[4]"]) == pytest.approx(pi, abs=1e-12)


def test_readings_are_the_same_wherever_the_run_stops_and_in_a_state_that_is_restored() -> None:
    often, seldom, other = (instrument(0.4) for _ in "abc")
    weight = paper_case().active_weight_on_bit
    for length in np.linspace(0.0, 9.0, 40):
        often.advance(float(length), 0.0, weight)
    seldom.advance(9.0, 0.0, weight)
    assert often.outputs() == seldom.outputs()
    other.restore(seldom.save())
    assert other.outputs() == seldom.outputs()
    bare = instrument(0.4, **dict.fromkeys(INSTRUMENTS, ()))
    bare.advance(9.0, 0.0, weight)
    assert {name: seldom.outputs()[name] for name in bare.outputs()} == bare.outputs()
    assert bare.statistics == seldom.statistics

"""The viewer's geometry against closed forms, a finite-element beam, and the model's own results."""

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from boreprop.analysis.axis import AXIS_REACH
from boreprop.analysis.hole import HoleAxis, bit_positions, existing_hole
from boreprop.analysis.rippling import find_rippling
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.inputs import Schedule
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz.scales import choose_scales
from boreprop_viz.scene import (
    Array,
    BitFrame,
    Bounds,
    Shapes,
)
from near_bit import NEAR_BIT, near_bit_case

THREE = Case(
    bha=BottomHoleAssembly((3.66, 6.954, 11.712), (3.66e-3, 7.32e-3), 0.6, 1080.0, 7.2e6),
    bit=BitRock(10.0, 1.0, math.radians(0.8)),
    bit_diameter=0.2159,
    active_weight_on_bit=12900.0,
    length=60.0,
    survey=Survey((0.0,), (math.radians(60.0),)),
    schedule=Schedule((0.0, 29.28), (4837.0, 0.0)),
)


@pytest.fixture(scope="module", params=["paper", "three stabilizers"])
def drilled(request: pytest.FixtureRequest, paper_case: Path) -> Shapes:
    """The shapes of a run that touches both walls."""
    case = THREE if request.param == "three stabilizers" else replace(load_case(paper_case), length=60.0)
    run = simulate(case, sample_interval=0.01)
    frame = BitFrame(case)
    start = existing_hole(case.survey, frame.s_hole[-1], spacing=0.05)
    shapes = frame.shapes(run, start.followed_by(run["drilled_length"], bit_positions(run)))
    forces = run.stack("stabilizer_force")
    assert np.all(forces.max(axis=0) > 0.0)
    assert forces.min() < 0.0
    return shapes


def row(case: Case, **values: float | list[float]) -> Trajectory:
    """A run of one row; what is not given is zero."""
    n = len(case.bha.stabilizer_positions)
    columns = dict.fromkeys(
        ("drilled_length", "bit_inclination", "rss_force", "displacement", "true_vertical_depth"), 0.0
    )
    columns |= {f"average_inclination[{i + 1}]": 0.0 for i in range(n)}
    columns |= {f"stabilizer_force[{i + 1}]": 0.0 for i in range(n - 1)}
    for name, value in values.items():
        columns |= {f"{name}[{i + 1}]": v for i, v in enumerate(value)} if isinstance(value, list) else {name: value}
    return Trajectory({name: np.array([value]) for name, value in columns.items()}, case)


def test_bounds_hold_what_lies_between_them() -> None:
    bounds = Bounds((0.0, 1.0), (-2.0, 3.0))
    assert bounds.hold(np.array([[0.0, -2.0], [1.0, 3.0]]))
    assert not bounds.hold(np.array([[0.5, 0.0], [0.5, 3.1]]))


def test_in_the_bit_frame_a_hole_of_constant_curvature_is_a_parabola() -> None:
    curvature, top = 2e-3, THREE.bha.stabilizer_positions[-1]
    hole = existing_hole(Survey((0.0, 30.0), (0.4, 0.4 + 30.0 * curvature)), reach=20.0, spacing=0.01)
    ends = np.array([0.0, *THREE.bha.stabilizer_positions])
    averages = 0.4 + curvature * (30.0 - (ends[1:] + ends[:-1]) / 2)
    frame = BitFrame(THREE)
    axis = frame.shapes(row(THREE, average_inclination=averages.tolist()), hole).hole_axis[0]
    np.testing.assert_allclose(axis, -curvature * frame.s_hole * (top - frame.s_hole) / 2, atol=2e-5)


def test_the_hole_axis_at_the_stabilizers_is_what_the_averages_say_however_coarse_the_path() -> None:
    averages = np.array([0.41, 0.43, 0.40])
    hole = existing_hole(Survey((0.0, 20.0), (0.38, 0.42)), reach=20.0, spacing=20.0)
    frame = BitFrame(THREE)
    axis = frame.shapes(row(THREE, average_inclination=averages.tolist()), hole).hole_axis[0]
    spans = np.diff(frame.stabilizer, prepend=0.0)
    mean = averages @ spans / spans.sum()
    np.testing.assert_allclose(axis[frame.at_stabilizer], -np.cumsum(spans * (averages - mean)), atol=1e-14)


def finite_element_beam(s: Array, stiffness: float, slope: float, weight: float, forces: dict[int, float]) -> Array:
    """Deflection at the nodes `s` of a beam clamped at s = 0 under `slope`, held at 0 at the end, hinged there."""
    size = 2 * len(s)
    matrix, load = np.zeros((size, size)), np.zeros(size)
    for i, h in enumerate(np.diff(s)):
        at = slice(2 * i, 2 * i + 4)
        matrix[at, at] += (stiffness / h**3) * np.array(
            [
                [12, 6 * h, -12, 6 * h],
                [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                [-12, -6 * h, 12, -6 * h],
                [6 * h, 2 * h**2, -6 * h, 4 * h**2],
            ]
        )
        load[at] -= weight * h * np.array([1 / 2, h / 12, 1 / 2, -h / 12])
    for node, force in forces.items():
        load[2 * node] += force
    solution = np.zeros(size)
    solution[1] = slope
    free = [k for k in range(2, size) if k != size - 2]
    solution[free] = np.linalg.solve(matrix[np.ix_(free, free)], load[free] - matrix[free, 1] * slope)
    return solution[::2]


def test_the_bha_has_the_shape_of_a_finite_element_beam_under_the_same_loads() -> None:
    frame, bha = BitFrame(THREE), THREE.bha
    averages, forces, rss = [0.99, 1.01, 1.02], [8e3, -3e3], 5e3
    rows = row(THREE, bit_inclination=1.015, average_inclination=averages, stabilizer_force=forces, rss_force=rss)
    shapes = frame.shapes(rows, existing_hole(THREE.survey, 20.0, spacing=1.0))
    spans = np.diff(frame.stabilizer, prepend=0.0)
    turn = averages @ spans / spans.sum() - 1.015
    expected = finite_element_beam(
        frame.s,
        bha.flexural_stiffness,
        slope=turn,
        weight=bha.distributed_weight * math.sin(averages[0]),
        forces={
            int(np.argmin(abs(frame.s - at))): force
            for at, force in zip((*bha.stabilizer_positions[:-1], bha.rss_position), (*forces, rss), strict=True)
        },
    )
    np.testing.assert_allclose(shapes.bha_axis[0], expected, atol=1e-9)


def test_bha_and_hole_are_as_far_apart_at_the_stabilizers_as_the_model_says(drilled: Shapes) -> None:
    at = drilled.frame.at_stabilizer
    apart = drilled.bha_axis[:, at] - drilled.hole_axis[:, at]
    np.testing.assert_allclose(apart[:, :-1], drilled.rows.stack("stabilizer_deflection"), atol=1e-9)
    np.testing.assert_allclose(apart[:, -1], 0.0, atol=1e-12)
    np.testing.assert_allclose(drilled.bha_axis[:, 0], 0.0, atol=1e-12)
    np.testing.assert_allclose(drilled.hole_axis[:, 0], 0.0, atol=1e-12)


def test_a_blade_touches_the_wall_where_there_is_contact_and_only_there(drilled: Shapes) -> None:
    low, high = drilled.walls[:, 0, drilled.frame.at_stabilizer], drilled.walls[:, 1, drilled.frame.at_stabilizer]
    gap_low, gap_high = drilled.blades[..., 0] - low, high - drilled.blades[..., 1]
    contact = drilled.rows.stack("stabilizer_contact")
    np.testing.assert_allclose(gap_low[:, :-1][contact == 1], 0.0, atol=1e-8)
    np.testing.assert_allclose(gap_high[:, :-1][contact == -1], 0.0, atol=1e-8)
    assert np.all(gap_low[:, :-1][contact != 1] > 0.0)
    assert np.all(gap_high[:, :-1][contact != -1] > 0.0)


def test_a_contact_point_is_where_wall_and_blade_meet(drilled: Shapes) -> None:
    contact = drilled.rows.stack("stabilizer_contact")
    touching = np.where(contact == 1, drilled.blades[:, :-1, 0], drilled.blades[:, :-1, 1])
    np.testing.assert_allclose(drilled.contact_points[contact != 0], touching[contact != 0], atol=1e-8)
    assert np.all(np.isnan(drilled.contact_points[contact == 0]))


def test_the_hole_between_the_stabilizers_follows_the_inclination_that_was_drilled(drilled: Shapes) -> None:
    # Y by the trapezoidal rule over Θ, which the path and the averages were not made from
    length, inclination = drilled.rows["drilled_length"], drilled.rows["borehole_inclination"]
    Y = np.append(0.0, np.cumsum(np.diff(length) * (inclination[1:] + inclination[:-1]) / 2))
    last, s = len(length) - 1, drilled.frame.s_hole
    expected = np.interp(length[last] - s, length, Y) - Y[last] + s * drilled.mean_inclination[last]
    np.testing.assert_allclose(drilled.hole_axis[last], expected, atol=5e-4)


def test_in_the_vertical_section_the_bha_starts_at_the_bit_and_ends_in_the_hole(drilled: Shapes) -> None:
    section = drilled.bha_in_section
    position, top = bit_positions(drilled.rows), drilled.frame.stabilizer[-1]
    np.testing.assert_allclose(section[:, 0], position, atol=1e-12)
    behind = HoleAxis(drilled.rows["drilled_length"], position).at(drilled.rows["drilled_length"][-1] - top)
    np.testing.assert_allclose(section[-1, -1], behind, atol=0.01)
    bends = [np.linalg.norm(after - before) for before, after in pairwise(section[-1])]
    np.testing.assert_allclose(bends, np.diff(drilled.frame.stabilizer, prepend=0.0), rtol=1e-3)


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize(("fate", "number"), [("ripples", 4), ("straight", 0)])
def test_ripple_and_lanes_show_the_last_waves_of_a_run_whatever_their_length(fate: str, number: int) -> None:
    case = near_bit_case(NEAR_BIT[fate][number], 400.0)
    run = simulate(case, engine="native")
    wave, scales = find_rippling(run), choose_scales([run], whole=True, section=bit_positions(run))
    if wave.ripples:
        assert wave.wavelength < case.bha.half_length / 4
        assert scales.window == pytest.approx(11 * wave.wavelength)
        assert scales.trend * AXIS_REACH < scales.window / 2  # the ripple is known in half of what is shown
        assert scales.ripple[1] > 1000 * wave.axis_amplitude
    else:
        assert scales.trend == case.bha.half_length

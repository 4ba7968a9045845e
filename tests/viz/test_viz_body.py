"""A BHA whose body lies on the wall, in a recording and in its scales."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boreprop.case.file import load_case
from boreprop.case.inputs import Schedule
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz.card import case_facts
from boreprop_viz.record import record
from boreprop_viz.scales import choose_scales
from boreprop_viz.space_scene import disc_places
from places import EXAMPLES
from rrd import read

pytestmark = pytest.mark.usefixtures("kernel")


@pytest.fixture(scope="module")
def run(kernel: None) -> Trajectory:
    return simulate(replace(load_case(EXAMPLES / "pendulum.toml"), length=60.0), sample_interval=2.0)


@pytest.fixture(scope="module")
def recorded(run: Trajectory, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recording") / "run.rrd"
    record(run, save=path)
    return path


def test_the_body_touches_the_wall_where_it_is_pushed(recorded: Path, run: Trajectory) -> None:
    """At each marked point one side of the body is on the wall of the hole, up to the spacing of what is drawn."""
    marks = read(recorded, "bit_frame/body_contact_point", "Points2D:positions")
    bodies = read(recorded, "bit_frame/body", "LineStrips2D:strips")
    walls = read(recorded, "bit_frame/walls", "LineStrips2D:strips")
    assert len(marks) == run.row_count
    marked = 0
    for tick, points in marks.items():
        low_wall, low_side = (np.array(of[tick][0]) for of in (walls, bodies))
        for x, y in points:
            marked += 1
            assert np.interp(-y, -low_wall[:, 1], low_wall[:, 0]) == pytest.approx(x, abs=1e-3)
            assert np.interp(-y, -low_side[:, 1], low_side[:, 0]) == pytest.approx(x, abs=0.1)
    assert marked > 2 * run.row_count


def test_the_largest_arrow_is_the_force_that_the_run_says(recorded: Path, run: Trajectory) -> None:
    """Up to the spacing of the rows, between which the hole is drawn straight."""
    scales = choose_scales([run], whole=True, section=np.zeros((1, 2)))
    arrows = read(recorded, "bit_frame/body_contact_force", "Arrows2D:vectors")
    largest = scales.newtons_per_metre * np.array([max(x for x, _ in each) for each in arrows.values()])
    assert np.median(np.abs(largest / run["body_contact_force"] - 1.0)) < 0.1


def test_across_a_hole_in_space_the_largest_force_is_on_the_side_from_which_it_pushes(tmp_path: Path) -> None:
    case = replace(load_case(EXAMPLES / "pendulum.toml"), length=6.0, dimensions=3)
    side = Schedule((0.0,), (2e4,), rss_toolface=(1.5,))
    run = simulate(replace(case, schedule=side), sample_interval=2.0)
    record(run, save=tmp_path / "run.rrd")
    disc = disc_places(5)[2]  # after those of two stabilizers, before those of tilt and toolface
    marks = read(tmp_path / "run.rrd", "across/contact_point/body", "Points2D:positions")
    arrows = read(tmp_path / "run.rrd", "across/contact_force/body", "Arrows2D:vectors")
    from_the_bit = read(tmp_path / "run.rrd", "across/body/label", "Points2D:labels")
    right, high = run["body_contact_force_right"], run["body_contact_force_high"]
    assert (abs(right) > high).any()
    pushes = np.column_stack((right, -high)) / np.hypot(right, high)[:, None]
    np.testing.assert_allclose([mark[0] for mark in marks.values()], disc - pushes, atol=1e-6)
    lengths, force = [np.hypot(*arrow[0]) for arrow in arrows.values()], run["body_contact_force"]
    np.testing.assert_allclose(lengths / lengths[0], force / force[0], rtol=1e-5)
    assert from_the_bit[0] == [f"{run['body_contact_position'][0]:.1f} m"]


def test_a_hole_that_curves_along_a_long_bha_fits_into_the_bit_frame(run: Trajectory) -> None:
    scales = choose_scales([run], whole=True, section=np.zeros((1, 2)))
    spans = np.diff(load_case(EXAMPLES / "pendulum.toml").bha.stabilizer_positions, prepend=0.0)
    averages = run.stack("average_inclination")
    turns = averages - (averages @ spans / spans.sum())[:, None]
    farthest = np.abs(np.cumsum(turns * spans, axis=1)).max() + 0.2286 / 2
    assert scales.lateral * farthest < scales.frame.x[1]


def test_the_card_says_what_the_beam_is_made_of_and_what_is_not_known() -> None:
    facts = case_facts(load_case(EXAMPLES / "pendulum.toml"))
    assert "1 section" in facts["beam"]
    assert "89.0 kN along it" in facts["beam"]
    assert "on the wall" in facts["beam"]
    assert facts["its critical ηΠ"] == "not known"
    assert facts["drilling straight, contact"] == "1 low, 2 low"

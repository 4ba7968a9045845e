"""A run beside a survey: the survey of the run itself, one that is off by a known angle, and the command."""

import json
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

from boreprop.analysis.comparison import compare
from boreprop.case.file import load_case
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.completion import axis_of
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from conftest import Command, assert_refused
from places import EXAMPLES

PAPER = load_case(EXAMPLES / "paper_case.toml")
START, CURVATURE = 1000.0, radians(2.0) / 30.0


@pytest.fixture(scope="module")
def arc() -> Trajectory:
    """A hole that builds evenly by 2 °/30 m from 20°, below an existing one that does."""
    length = np.linspace(0.0, 120.0, 1201)
    inclination = radians(20.0) + CURVATURE * length
    x, z = axis_of(length, inclination).T
    existing = Survey((START - 100.0, START), (radians(20.0) - 100.0 * CURVATURE, radians(20.0)))
    columns = {"drilled_length": length, "borehole_inclination": inclination, "displacement": x}
    columns |= {"true_vertical_depth": z, "stabilizer_contact[1]": 0.0 * x, "bit_tilt_saturation": 0.0 * x}
    return Trajectory(columns, replace(PAPER, survey=existing))


def measured(depth: list[float], off: float = 0.0) -> Survey:
    """What a survey of the arc measures, `off` by an angle, rad."""
    return Survey(tuple(depth), tuple(radians(20.0) + CURVATURE * (at - START) + off for at in depth))


def test_a_survey_of_the_run_itself_differs_in_nothing(arc: Trajectory) -> None:
    found = compare(arc, measured([1000.0, 1030.0, 1075.0]))
    np.testing.assert_allclose(found.residual, 0.0, atol=1e-5)
    np.testing.assert_allclose(found.predicted_build_rate[1:], CURVATURE, rtol=1e-4)
    np.testing.assert_allclose(found.measured_build_rate[1:], CURVATURE, rtol=1e-9)
    assert np.isnan(found.predicted_build_rate[0])


def test_a_survey_that_is_off_by_an_angle_differs_by_it(arc: Trajectory) -> None:
    found = compare(arc, measured([1010.0, 1040.0, 1070.0], off=radians(0.5)))
    np.testing.assert_allclose(found.residual, radians(0.5), atol=1e-5)
    assert found.root_mean_square == pytest.approx(radians(0.5), abs=1e-5)


def test_stations_outside_what_is_drilled_are_left_out(arc: Trajectory) -> None:
    found = compare(arc, measured([950.0, 1010.0, 1119.0, 1200.0]))
    assert found.measured_depth.tolist() == [1010.0]


def test_a_ripple_does_not_show_in_the_prediction() -> None:
    run = simulate(PAPER, sample_interval=0.1)
    depth = np.linspace(100.0, 200.0, 21)
    found = compare(run, Survey(tuple(depth.tolist()), (0.0,) * 21))
    assert np.abs(found.predicted).max() < radians(0.1)  # the hole itself swings by ±2.4°


def test_a_survey_of_another_hole_is_refused_by_its_file(
    command_here: Command, arc: Trajectory, tmp_path: Path
) -> None:
    write_trajectory(simulate(PAPER, length=20.0), tmp_path / "run.csv")
    (tmp_path / "other.csv").write_text("measured_depth,inclination_deg\n500,1\n530,2\n")
    with pytest.raises(InputError, match=r"must have a station from 1000 to 1118\.17 m"):
        compare(arc, Survey((10.0, 20.0), (0.0, 0.0)))
    done = command_here("boreprop", "compare", "run.csv", "other.csv")
    assert_refused(done, "other.csv: measured_depth: must have a station from 7.32 to ")


def test_the_command_prints_a_line_a_station_and_draws_them(command_here: Command, tmp_path: Path) -> None:
    run = simulate(load_case(EXAMPLES / "build_section.toml"), length=100.0)
    write_trajectory(run, tmp_path / "run.csv")
    done = command_here(
        "boreprop", "compare", "run.csv", EXAMPLES / "build_section_plan.csv", "--output", "both.png", "--json"
    )
    assert (done.returncode, done.stderr) == (0, "")
    document = json.loads(done.stdout)
    assert len(document["residual"]) == len(document["measured_depth"]) > 0
    assert (tmp_path / "both.png").read_bytes().startswith(b"\x89PNG")
    table = command_here("boreprop", "compare", "run.csv", EXAMPLES / "build_section_plan.csv").stdout
    for depth in document["measured_depth"]:
        assert f" {depth:.1f} " in table


def test_azimuths_that_a_run_in_a_plane_has_not_are_told_to_be_left_out(command_here: Command, tmp_path: Path) -> None:
    write_trajectory(simulate(PAPER, length=20.0), tmp_path / "run.csv")
    warning = "warning: survey.csv: its azimuths are left out, since the run stays in a plane"
    for azimuth, said in ((10, warning), (9, "")):
        (tmp_path / "survey.csv").write_text(f"measured_depth,inclination_deg,azimuth_deg\n0,9,9\n15,9,{azimuth}\n")
        done = command_here("boreprop", "compare", "run.csv", "survey.csv")
        assert done.returncode == 0
        assert done.stderr.startswith(said)
        assert bool(done.stderr) == bool(said)

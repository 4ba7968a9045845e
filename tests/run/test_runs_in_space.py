"""Runs in space through `simulate`, result files and what is made of them."""

import json
from dataclasses import replace
from math import cos, hypot, isnan, pi, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from boreprop.analysis.comparison import compare
from boreprop.analysis.hole_in_space import SurveyInSpace
from boreprop.analysis.plan_in_space import DeviationInSpace, deviation_of, plan_of
from boreprop.analysis.stations import list_stations
from boreprop.analysis.summary import summarize
from boreprop.case.case import Case
from boreprop.case.formations import Formation
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.core.ground import Wear
from boreprop.core.survey import Survey
from boreprop.core.system import BottomHoleAssembly
from boreprop.errors import ParameterError
from boreprop.report.tables.summary import lines
from boreprop.run.completion import complete
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from conftest import Command
from space_runs import SpatialCase

SIDES = ("stabilizer_force", "stabilizer_deflection", "bit_tilt", "bit_lateral_force")


@pytest.fixture(scope="module")
def inclined(case: Case) -> Case:
    """The paper's case in a hole that is inclined by 40° to the north-east, and turns right by a steering force."""
    survey = Survey((0.0, 30.0), (radians(40.0),) * 2, (radians(45.0),) * 2)
    return replace(case, survey=survey, length=60.0, schedule=Schedule((0.0,), (6e3,), rss_toolface=(pi / 2,)))


@pytest.fixture(scope="module")
def turning(inclined: Case) -> Trajectory:
    return simulate(inclined, sample_interval=0.25)


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"formations": tuple(Formation(None, eta, true_vertical_depth=z) for z, eta in ((2.0, 20.0), (9.0, 5.0)))},
        {"wear": Wear(20.0, 400.0)},
        {"inputs": InputSchedule((0.0, 8.0), (("stabilizer_clearance[1]", (1e-3, 5e-3)),))},
    ],
    ids=["alike", "layers", "wear", "clearances"],
)
def test_a_planar_case_in_space_is_the_planar_run(case: Case, changed: dict[str, Any]) -> None:
    inclined = replace(case, survey=Survey((0.0, 30.0), (0.5, 0.5)), schedule=Schedule((0.0,), (3e3,)), **changed)
    plane = simulate(inclined, length=30.0, sample_interval=0.5, relative_tolerance=1e-11)
    space = simulate(inclined, length=30.0, sample_interval=0.5, relative_tolerance=1e-11, dimensions=3)
    assert space.case == replace(inclined, dimensions=3)
    for name in ("bit_inclination", "borehole_inclination", "displacement", "true_vertical_depth"):
        np.testing.assert_allclose(space[name], plane[name], atol=1e-6)
    for name in ("bit_tilt", "bit_lateral_force"):
        np.testing.assert_allclose(space[f"{name}_high"], plane[name], atol=1e-6 * np.abs(plane[name]).max())
        assert not space[f"{name}_right"].any()
    np.testing.assert_allclose(space["north"], plane["displacement"], atol=1e-6)
    for name in {"formation", "eta_pi", "stabilizer_clearance[1]"} & set(plane):
        np.testing.assert_allclose(space[name], plane[name], rtol=1e-9)
    alike = simulate(replace(inclined, formations=(), wear=None, inputs=None), length=30.0, sample_interval=0.5)
    assert (np.abs(alike["bit_inclination"] - plane["bit_inclination"]).max() > 1e-4) == bool(changed)


def test_a_case_that_drills_in_the_plane_has_no_columns_of_space(case: Case) -> None:
    run = simulate(case, length=5.0)
    assert not {"north", "rss_toolface", "bit_azimuth"} & set(run)
    assert list(simulate(case, length=5.0, dimensions=2)) == list(run)


def test_simulate_is_the_engine_driven_by_hand() -> None:
    by_hand = SpatialCase(
        inclination=(0.3, 0.3, 0.3), azimuth=(0.2, 0.4, 0.6), force=0.01, toolface=1.0, reference="north"
    )
    run, places = by_hand.begin(), np.arange(1.0, 8.0)
    rows = []
    for xi in places:
        by_hand.advance(run, float(xi))
        rows.append(run.outputs())
    started = by_hand.begin()
    case = Case(
        bha=BottomHoleAssembly(by_hand.s, by_hand.y_star, by_hand.Delta, by_hand.w, 1 / 3),
        bit=started.bit,
        bit_diameter=0.2,
        active_weight_on_bit=by_hand.eta_pi,
        length=7.0,
        survey=Survey((0.0, 1.0, 2.0), by_hand.inclination, by_hand.azimuth),
        schedule=Schedule((0.0,), (0.01,), rss_toolface=(1.0,), toolface_reference=("north",)),
    )
    found = simulate(case, sample_interval=1.0)
    for name in ("bit_azimuth", "north", "stabilizer_force_right[1]", "bit_tilt_high"):
        expected = np.array([row[name] for row in rows])
        np.testing.assert_allclose(found[name][1:], expected, atol=1e-9)


def test_sides_and_magnitudes_agree(turning: Trajectory) -> None:
    for name in SIDES:
        index = "[1]" if name.startswith("stabilizer") else ""
        parts = turning[f"{name}_high{index}"], turning[f"{name}_right{index}"]
        np.testing.assert_allclose(np.hypot(*parts), turning[name + index], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(np.hypot(turning["north"], turning["east"]), turning["displacement"], atol=1e-9)


def test_the_position_is_the_integral_of_the_direction(turning: Trajectory) -> None:
    fine = simulate(turning.case, length=20.0, sample_interval=0.005)  # type: ignore[arg-type]
    inclination, azimuth = fine["borehole_inclination"], fine["borehole_azimuth"]
    for name, slope in (
        ("north", np.sin(inclination) * np.cos(azimuth)),
        ("east", np.sin(inclination) * np.sin(azimuth)),
        ("true_vertical_depth", np.cos(inclination)),
    ):
        walked = np.concatenate(([0.0], np.cumsum((slope[1:] + slope[:-1]) / 2 * np.diff(fine["drilled_length"]))))
        np.testing.assert_allclose(fine[name], walked, atol=2e-4)


def test_a_force_to_the_right_turns_the_hole_to_the_right(turning: Trajectory) -> None:
    found = summarize(turning)
    assert found.start_azimuth == pytest.approx(radians(45.0), abs=1e-3)
    assert found.end_azimuth is not None
    assert found.end_azimuth > radians(46.0)


def test_schedules_change_toolface_and_walk_where_they_say(inclined: Case) -> None:
    schedule = Schedule((0.0, 7.3), (6e3, 6e3), rss_toolface=(0.0, -pi / 2), toolface_reference=("frame", "gravity"))
    walk = InputSchedule((0.0, 4.0), (("bit_walk_angle", (0.0, 0.1)),))
    case = replace(inclined, schedule=schedule, inputs=walk)
    run = simulate(case, length=12.0, sample_interval=0.5)
    first = replace(
        case, inputs=None, schedule=Schedule((0.0,), (6e3,), rss_toolface=(0.0,), toolface_reference=("frame",))
    )
    before = simulate(first, length=12.0, sample_interval=0.5)
    same = run["drilled_length"] < 4.0
    assert (run["bit_azimuth"][same] == before["bit_azimuth"][same]).all()
    assert run["bit_azimuth"][-1] != before["bit_azimuth"][-1]
    assert run["rss_toolface"][[0, -1]].tolist() == [0.0, -pi / 2]
    assert run["bit_walk_angle"][[7, 8]].tolist() == [0.0, 0.1]


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_result_file_gives_the_run_back(turning: Trajectory, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"run{suffix}"
    write_trajectory(turning, path)
    again = read_trajectory(path)
    assert again.case == turning.case
    assert list(again) == list(turning)
    assert all((again[name] == turning[name]).all() for name in turning)


def test_nothing_of_the_plane_completes_a_run_in_space(turning: Trajectory) -> None:
    kept = {name: values for name, values in turning.items() if name not in ("displacement", "eta_pi", "bit_tilt")}
    completed = complete(replace(turning, columns=kept))
    assert "displacement" not in completed
    assert "bit_tilt" not in completed
    np.testing.assert_allclose(completed["eta_pi"], turning["eta_pi"])


@pytest.mark.parametrize("turn", [1e-9, 1e-4, 0.3, 2.0])
def test_minimum_curvature_between_two_stations_is_the_textbook_formula(turn: float) -> None:
    """d/2 · RF · (u₁ + u₂) with RF = tan(β/2)/(β/2)."""
    survey = Survey((0.0, 30.0), (0.4, 0.4 + turn), (1.0, 1.0 + turn))
    i, a = np.array(survey.inclination), np.array(survey.azimuth)
    u = np.column_stack((np.sin(i) * np.cos(a), np.sin(i) * np.sin(a), np.cos(i)))
    beta = 2 * np.arcsin(np.linalg.norm(u[1] - u[0]) / 2)
    factor = np.tan(beta / 2) / (beta / 2)
    hole = SurveyInSpace.of(survey)
    np.testing.assert_allclose(hole.position[1] - hole.position[0], 15.0 * factor * (u[0] + u[1]), atol=1e-7)
    np.testing.assert_allclose(hole.at(np.array([-30.0, 0.0])), hole.position, atol=1e-7)
    np.testing.assert_allclose(hole.at(np.array([-40.0])), hole.position[:1] - 10.0 * u[:1], atol=1e-9)


def level_turn(case: Case, rate: float, drilled: float) -> Trajectory:
    """A hole at 90° that turns at a constant rate, made by hand: azimuth, position and dogleg severity are known."""
    length = np.arange(0.0, drilled + 0.5, 0.5)
    zeros = np.zeros_like(length)
    turned = rate * length
    columns = {
        "drilled_length": length,
        "north": np.sin(turned) / rate,
        "east": (1.0 - np.cos(turned)) / rate,
        "true_vertical_depth": zeros,
        "bit_inclination": zeros + pi / 2,
        "borehole_inclination": zeros + pi / 2,
        "borehole_azimuth": turned,
        "bit_tilt": zeros,
        "bit_tilt_saturation": zeros,
        "stabilizer_contact[1]": zeros,
        "stabilizer_force[1]": zeros,
    }
    parts = ("bit_tilt_high", "bit_tilt_right", "stabilizer_force_high[1]", "stabilizer_force_right[1]")
    columns |= dict.fromkeys(parts, zeros)
    survey = Survey((0.0, 100.0), (pi / 2,) * 2, (0.0, 0.0))
    return Trajectory(columns, replace(case, survey=survey, dimensions=3, true_vertical_depth=2000.0))


def test_the_dogleg_severity_of_a_level_turn(case: Case) -> None:
    rate = radians(3.0) / 30.0
    found = summarize(level_turn(case, rate, 300.0))
    turned = 300.0 - found.averaging_length / 2  # the mean direction is that in the middle of its chord
    assert found.dogleg_severity == pytest.approx(rate * turned / 300.0, rel=1e-4)
    assert found.largest_dogleg_severity == pytest.approx(rate, rel=1e-4)
    assert found.largest_build_rate == pytest.approx(0.0, abs=1e-9)
    assert ("dogleg severity, mean", "2.98 °/30 m, 29.8 ° in all") in lines(found)
    assert isnan(summarize(level_turn(case, rate, 29.0)).largest_dogleg_severity or 0.0)


def test_stations_of_a_level_turn(case: Case) -> None:
    rate = radians(3.0) / 30.0
    run = level_turn(case, rate, 300.0)
    found = list_stations(run, 30.0, averaged_over=3.0)
    at = found.measured_depth - 100.0
    assert found.azimuth is not None
    assert found.north is not None
    np.testing.assert_allclose(found.azimuth[1:], (at[1:] - 1.5) * rate, atol=1e-6)  # of the chord, at its middle
    np.testing.assert_allclose(found.north, np.sin(rate * at) / rate, atol=1e-4)
    np.testing.assert_allclose(found.dogleg_severity[2:], rate, rtol=1e-4)
    np.testing.assert_allclose(found.inclination, pi / 2, atol=1e-9)
    np.testing.assert_allclose(found.true_vertical_depth, 2000.0)  # level, at the depth of the bit at the start


def test_a_survey_of_the_run_compares_by_its_inclination(turning: Trajectory) -> None:
    depth = tuple(30.0 + 10.0 * k for k in range(1, 5))
    at = [int(np.searchsorted(turning["drilled_length"], d - 30.0)) for d in depth]
    survey = Survey(depth, tuple(turning["borehole_inclination"][at].tolist()))
    found = compare(turning, survey)
    np.testing.assert_allclose(found.predicted, found.measured, atol=radians(3.0))


def test_a_run_is_not_off_a_plan_and_a_survey_of_its_own_rows(turning: Trajectory) -> None:
    columns = [30.0 + turning["drilled_length"]]
    columns += [turning[f"borehole_{name}"] for name in ("inclination", "azimuth")]
    own = Survey(*(tuple(column.tolist()) for column in columns))
    off, found = deviation_of(turning, plan_of(turning, own), 4.0), compare(turning, own)
    assert isinstance(off, DeviationInSpace)
    assert found.high is not None
    assert found.right is not None
    for distance in (off.distance, found.high, found.right):
        assert np.abs(distance).max() < 0.01  # in a hole that ripples by more, and turns by metres to the right
    for angle in (off.azimuth[16:], off.inclination[16:]):
        assert np.abs(angle).max() < radians(0.1)


def test_summary_and_compare_tell_it_to_the_high_side_and_to_the_right(
    command_here: Command, tmp_path: Path, turning: Trajectory
) -> None:
    write_trajectory(turning, tmp_path / "run.csv")
    (tmp_path / "plan.csv").write_text("measured_depth,inclination_deg,azimuth_deg\n0,40,45\n60,40,45\n120,40,45\n")
    printed = command_here("boreprop", "summary", "run.csv", "--plan", "plan.csv", "--stations", "30").stdout
    assert max(map(len, printed.splitlines())) <= 80
    assert " right, " in printed
    document = json.loads(command_here("boreprop", "summary", "run.csv", "--plan", "plan.csv", "--json").stdout)
    off = document["off_plan"]
    assert off["distance"] == pytest.approx(hypot(off["high"], off["right"]))
    done = command_here("boreprop", "compare", "run.csv", "plan.csv", "--output", "both.png", "--json")
    compared = json.loads(done.stdout)
    there = int(np.searchsorted(turning["drilled_length"], 30.0))
    ahead = 30.0 * sin(radians(40.0)) / 2**0.5  # to the north and to the east
    off_north, off_east = ahead - turning["north"][there], ahead - turning["east"][there]
    azimuth = compared["predicted_azimuth"][0]
    assert compared["right"] == [pytest.approx(off_east * cos(azimuth) - off_north * sin(azimuth), abs=1e-6)]
    assert compared["azimuth_residual"] == [pytest.approx(radians(45.0) - azimuth)]
    assert max(map(len, command_here("boreprop", "compare", "run.csv", "plan.csv").stdout.splitlines())) <= 80


def test_the_python_engine_and_two_dimensions_are_refused(inclined: Case) -> None:
    with pytest.raises(ParameterError, match="engine: must be native for what drills in space, got 'python'"):
        simulate(inclined, engine="python")
    with pytest.raises(ParameterError, match="dimensions: must be 3 for a case with an azimuth"):
        simulate(inclined, dimensions=2)


HOLE = """
[bha]
stabilizer_positions = [3.66, 7.32]
stabilizer_clearances = [3.66e-3]
rss_position = 0.6
distributed_weight = 1080.0
flexural_stiffness = 7.2e6
[bit]
lateral_steering_resistance = 10.0
angular_steering_resistance = 1.0
tilt_limit_deg = 2.0
diameter = 0.2159
[drilling]
active_weight_on_bit = 1612.469
length = 20.0
[hole]
measured_depth = [0.0, 30.0]
inclination_deg = [40.0, 41.0]
"""


def test_the_commands_drill_and_list_a_case_in_space(command: Command, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(HOLE + "azimuth_deg = [10.0, 20.0]\n")
    done = command("boreprop", "simulate", "case.toml", "--output", "run.csv")
    assert done.returncode == 0, done.stderr
    listed = command("boreprop", "summary", "run.csv", "--stations", "10")
    assert listed.returncode == 0, listed.stderr
    assert "azimuth at the end" in listed.stdout
    assert "azim." in listed.stdout
    (tmp_path / "plane.toml").write_text(HOLE)
    assert command("boreprop", "simulate", "plane.toml", "--output", "s.csv", "--dimensions", "3").returncode == 0
    assert "bit_azimuth" in read_trajectory(tmp_path / "s.csv")


@pytest.mark.parametrize(("azimuth", "refused"), [("20.0", False), ("[10.0, 20.0]", True)])
def test_analyses_of_the_plane_take_its_azimuth_but_no_turn(
    command: Command, tmp_path: Path, azimuth: str, refused: bool
) -> None:
    (tmp_path / "case.toml").write_text(HOLE + f"azimuth_deg = {azimuth}\n")
    done = command("boreprop", "steering", "case.toml")
    assert (done.returncode == 2) == refused, done.stderr
    assert ("hole.azimuth_deg: must be the same at all stations" in done.stderr) == refused


def test_a_direction_by_inclination_and_azimuth_starts_the_bit(turning: Trajectory) -> None:
    direction = [f(turning["bit_azimuth"][0]) * sin(turning["bit_inclination"][0]) for f in (cos, sin)]
    np.testing.assert_allclose(direction, [sin(radians(40.0)) * cos(pi / 4)] * 2, atol=1e-9)

"""The command `boreprop summary` with a listing at survey stations and with a plan."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boreprop.analysis.plan import planned_hole
from boreprop.analysis.plan_in_space import deviation_of
from boreprop.analysis.stations import list_stations
from boreprop.analysis.summary import summarize
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.tables import read_survey
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from conftest import Command, assert_refused
from places import EXAMPLES

PLAN = EXAMPLES / "build_section_plan.csv"


@pytest.fixture
def built(tmp_path: Path) -> Trajectory:
    """The first hundred metres of the build section, in run.csv."""
    run = simulate(load_case(EXAMPLES / "build_section.toml"), length=100.0, sample_interval=0.5)
    write_trajectory(run, tmp_path / "run.csv")
    return run


def cells(printed: str) -> list[list[str]]:
    """The cells of the lines of all tables."""
    return [[cell.strip() for cell in line.strip("│").split("│")] for line in printed.splitlines() if line[0] == "│"]


def test_stations_follow_the_summary_with_their_units(command_here: Command, built: Trajectory) -> None:
    result = command_here("boreprop", "summary", "run.csv", "--stations", "30")
    assert (result.returncode, result.stderr) == (0, "")
    for heading in ("MD", "incl.", "TVD", "displ.", "DLS", "(m)", "(°)", "(°/30 m)"):
        assert heading in result.stdout
    assert "off" not in result.stdout
    listed = [line for line in cells(result.stdout) if len(line) == 5]
    assert [line[0] for line in listed] == ["2594.0", "2610.0", "2640.0", "2670.0", "2694.0"]
    expected = list_stations(built, 30.0)
    shown = np.array(listed, dtype=float).T
    np.testing.assert_allclose(shown[1], np.degrees(expected.inclination), atol=0.00501)
    np.testing.assert_allclose(shown[4], 30.0 * np.degrees(expected.dogleg_severity), atol=0.00501)
    assert f"last {expected.averaging_length:.3g} m" in " ".join(result.stdout.split())


def test_with_a_plan_it_says_how_far_the_hole_is_off(command_here: Command, built: Trajectory) -> None:
    summary = summarize(built)
    plan = planned_hole(read_survey(PLAN), 2594.0)
    off = deviation_of(built, plan, summary.averaging_length)
    most = int(np.argmax(np.abs(off.distance)))
    side = {True: "high", False: "low"}
    alone = dict(cells(command_here("boreprop", "summary", "run.csv", "--plan", str(PLAN)).stdout))
    end = f"{abs(off.distance[-1]):.2f} m {side[off.distance[-1] > 0]}"
    turned = f"inclination {np.degrees(off.inclination[-1]):+.2f} °"
    assert alone["off the plan at the end"] == f"{end}, {turned}"
    farthest = f"{abs(off.distance[most]):.2f} m {side[off.distance[most] > 0]}"
    assert alone["off the plan at most"] == f"{farthest} at {2594.0 + built['drilled_length'][most]:.1f} m"
    both = command_here("boreprop", "summary", "run.csv", "--plan", str(PLAN), "--stations", "30").stdout
    listed = [line for line in cells(both) if len(line) == 8]
    assert max(map(len, both.splitlines())) <= 80  # no heading and no value is cut on a plain terminal
    assert float(listed[0][7]) == 0.0
    assert float(listed[-1][5]) == pytest.approx(float(listed[-1][1]) - float(listed[-1][6]), abs=0.011)
    assert float(listed[-1][7]) == pytest.approx(off.distance[-1], abs=0.0051)


def test_below_the_end_of_the_plan_nothing_is_compared(
    command_here: Command, built: Trajectory, tmp_path: Path
) -> None:
    (tmp_path / "plan.csv").write_text("measured_depth,inclination_deg\n2500,26.37\n2650,29\n")
    printed = command_here("boreprop", "summary", "run.csv", "--plan", "plan.csv", "--stations", "30").stdout
    assert "off the plan where it ends, 2650.0 m" in printed
    listed = [line for line in cells(printed) if len(line) == 8]
    assert [line[5:] for line in listed][3:] == [["–"] * 3] * 2
    assert "–" not in listed[2]


def test_a_plan_that_does_not_include_the_start_is_refused(command_here: Command, tmp_path: Path, case: Case) -> None:
    write_trajectory(simulate(replace(case, length=1.0)), tmp_path / "run.csv")
    result = command_here("boreprop", "summary", "run.csv", "--plan", str(PLAN))
    assert_refused(result, "build_section_plan.csv: ", "must include 7.32 m", "2594 to 3438")


def test_a_spacing_that_is_no_length_is_refused(command_here: Command) -> None:
    assert_refused(command_here("boreprop", "summary", "run.csv", "--stations", "0"), "--stations", "> 0", "'0'")

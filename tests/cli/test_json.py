"""What the commands print with --json, against what the Python API computes."""

import json
from math import inf, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from boreprop.analysis.hysteresis import hysteresis
from boreprop.analysis.stability.chart import stability_chart
from boreprop.analysis.stations import list_stations
from boreprop.analysis.summary import summarize
from boreprop.analysis.tipping import critical_dogleg
from boreprop.case.file import load_case
from boreprop.cli.printing import plain
from boreprop.report.tables.steering import summarize as summarize_steering
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.simulate import simulate
from conftest import Command
from places import EXAMPLES

PAPER = EXAMPLES / "paper_case.toml"


def printed(command: Command, *arguments: str | Path) -> Any:
    """The document that a command prints, and nothing else."""
    done = command("boreprop", *arguments, "--json")
    assert (done.returncode, done.stderr) == (0, "")
    [line] = done.stdout.splitlines()
    return json.loads(line)


def test_a_summary_has_the_fields_of_the_api(command_here: Command, tmp_path: Path) -> None:
    write_trajectory(simulate(load_case(PAPER), sample_interval=0.25), tmp_path / "run.csv")
    document = printed(command_here, "summary", "run.csv", "--stations", "50")
    summary = summarize(read_trajectory(tmp_path / "run.csv"))
    assert document["rippling"]["state"] == "lasting"
    assert document["rippling"]["wavelength"] == summary.rippling.wavelength
    assert document["largest_contact_force"] == summary.largest_contact_force.tolist()
    assert document["sag"]["offset"] == summary.sag.offset if summary.sag else None
    listed = list_stations(read_trajectory(tmp_path / "run.csv"), 50.0, averaged_over=summary.averaging_length)
    np.testing.assert_allclose(document["stations"]["inclination"], listed.inclination)
    assert document["off_plan"] is None


def test_off_the_plan_is_in_metres_and_radians(command_here: Command, tmp_path: Path) -> None:
    write_trajectory(simulate(load_case(EXAMPLES / "build_section.toml"), length=50.0), tmp_path / "run.csv")
    document = printed(command_here, "summary", "run.csv", "--plan", EXAMPLES / "build_section_plan.csv")
    assert abs(document["off_plan"]["distance"]) < 0.1
    assert abs(document["off_plan"]["inclination"]) < 0.01
    assert document["stations"] is None


def test_steering_has_the_pieces_of_the_curve(command_here: Command) -> None:
    document = printed(command_here, "steering", EXAMPLES / "build_section.toml")
    summary = summarize_steering(load_case(EXAMPLES / "build_section.toml"))
    assert [piece["gain"] for piece in document["curve"]] == [piece.gain for piece in summary.curve]
    assert document["free"]["build_rate"] == summary.free.build_rate


def test_doglegs_go_by_the_side_to_which_they_turn(command_here: Command) -> None:
    document = printed(command_here, "dogleg", PAPER)
    assert set(document) == {"up", "down"}
    assert document["up"]["angle"] == critical_dogleg(load_case(PAPER)).angle


def test_a_loop_is_printed_without_a_picture(command_here: Command, tmp_path: Path) -> None:
    document = printed(command_here, "hysteresis", PAPER, "--eta-pi", "0.1:0.2:2")
    found = hysteresis(load_case(PAPER), "eta_pi", [0.1, 0.2], np.radians(0.5))
    assert document == plain(found)
    assert not list(tmp_path.iterdir())


def test_a_chart_has_its_verdicts_in_words(command_here: Command) -> None:
    document = printed(command_here, "stability", PAPER, "--eta-pi", "0.05:0.2:2", "--lambda2", "1:2:2")
    chart = stability_chart(load_case(PAPER), np.array([0.05, 0.2]), np.array([1.0, 2.0]))
    words = {0: "stable", 1: "drift", 2: "oscillatory"}
    panels = {(tuple(panel["contact"]), panel["saturated"]): panel["verdicts"] for panel in document["panels"]}
    for panel in chart.panels:
        if (panel.contact, panel.saturated) in panels:
            found = [[words[int(code)] for code in row] for row in panel.verdicts]
            assert panels[panel.contact, panel.saturated] == found
    assert document["limits"][0]["critical"]["eta_pi"] == pytest.approx(0.14676, abs=1e-5)


@pytest.mark.parametrize("command", ["hysteresis", "stability"])
def test_neither_picture_nor_json_is_refused(command_here: Command, command: str) -> None:
    options = ("--eta-pi", "0.1:0.2:2") if command == "hysteresis" else ()
    done = command_here("boreprop", command, PAPER, *options)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "error: --output, --json: one must be given, got neither\n"


def test_what_is_not_a_number_is_null() -> None:
    assert plain({"a": (nan, inf, 1.5, True, None, "x", np.float64(2.0), np.array([1, 2]))}) == {
        "a": [None, None, 1.5, True, None, "x", 2.0, [1, 2]]
    }

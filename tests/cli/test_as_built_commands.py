"""Every command on BHAs as they are built: with sections, axial load, body contact, or all of them."""

import json
from pathlib import Path

import pytest

from conftest import Command, assert_refused
from places import EXAMPLES

pytestmark = pytest.mark.usefixtures("kernel")
WITHOUT = {
    "all": (),
    "sections only": ("axial_load", "body_contact", "weight_on_bit"),
    "sections and axial load": ("body_contact",),
    "sections and body contact": ("axial_load", "weight_on_bit"),
}


@pytest.fixture
def case_file(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """The pendulum of the examples without some of its keys, and short."""
    text = (EXAMPLES / "pendulum.toml").read_text(encoding="utf-8").replace("= 150.0", "= 15.0")
    kept = [line for line in text.splitlines() if not line.startswith(WITHOUT[request.param])]
    file = tmp_path / "case.toml"
    file.write_text("\n".join(kept), encoding="utf-8")
    return file


@pytest.mark.parametrize("case_file", WITHOUT, indirect=True)
def test_commands_that_take_any_bha(case_file: Path, command_here: Command) -> None:
    assert command_here("boreprop", "simulate", case_file, "--output", "run.csv").returncode == 0
    summary = command_here("boreprop", "summary", "run.csv", "--json")
    body = json.loads(summary.stdout)["body_contact"]
    assert (body is not None) == ("\nbody_contact " in case_file.read_text(encoding="utf-8"))
    steering = command_here("boreprop", "steering", case_file, "--output", "steering.png")
    assert steering.returncode == 0
    assert "1 section" in steering.stdout
    assert (case_file.parent / "steering.png").stat().st_size > 10_000
    assert command_here("boreprop-view", "run.csv", "--save", "run.rrd").returncode == 0
    assert command_here("boreprop-fmu", "build", case_file, "--output", "case.fmu").returncode == 0


@pytest.mark.parametrize("case_file", WITHOUT, indirect=True)
def test_commands_that_take_the_papers_beam_refuse_others_in_one_line(case_file: Path, command_here: Command) -> None:
    python = command_here("boreprop", "simulate", case_file, "--output", "run.csv", "--engine", "python")
    assert_refused(python, "uniform beam", "native engine")
    fmu = command_here("boreprop-fmu", "build", case_file, "--output", "case.fmu", "--runtime", "python")
    assert fmu.returncode == 2
    assert "must be native for a BHA with section" in fmu.stderr


@pytest.mark.parametrize("case_file", ["sections and axial load"], indirect=True)
def test_roots_stability_and_spiral_take_sections_and_axial_load(case_file: Path, command_here: Command) -> None:
    roots = command_here("boreprop", "roots", case_file, "--all", "--json")
    assert [mode["verdict"] for mode in json.loads(roots.stdout)] == ["stable", "drift"]
    stability = command_here(
        "boreprop", "stability", case_file, "--eta-pi", "0.01:0.3:4", "--lambda2", "0.5:1.5:3", "--output", "chart.png"
    )
    assert stability.returncode == 0, stability.stderr
    spiral = command_here("boreprop", "spiral", case_file, "--json")
    assert json.loads(spiral.stdout)["straight_growth"] < 0


@pytest.mark.parametrize("case_file", ["all"], indirect=True)
def test_roots_stability_and_spiral_refuse_body_contact_in_one_line(case_file: Path, command_here: Command) -> None:
    commands = ("roots",), ("roots", "--contact", "1"), ("stability", "--output", "chart.png"), ("spiral",)
    for name, *options in commands:
        assert_refused(command_here("boreprop", name, case_file, *options), "bha.body_contact", "simulate")


@pytest.mark.parametrize("case_file", ["all"], indirect=True)
def test_a_study_of_the_weight_on_bit(case_file: Path, command_here: Command) -> None:
    vary = ("--vary", "weight_on_bit=70e3:90e3:2")
    result = command_here("boreprop", "study", case_file, *vary, "--output", "study.csv", "--workers", "1")
    assert result.returncode == 0, result.stderr
    first, second = (case_file.parent / "study.csv").read_text().splitlines()[-2:]
    assert first.split(",")[1:] != second.split(",")[1:]

"""The option --units: the same numbers in the units of the field."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from boreprop.analysis.comparison import compare
from boreprop.case.file import load_case
from boreprop.case.tables import read_survey
from boreprop.report.figures.comparison import draw
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.simulate import simulate
from boreprop.units import field_units
from conftest import Command, assert_refused
from places import EXAMPLES

CASE = EXAMPLES / "build_section.toml"
KLBF, FEET = 4448.2216, 0.3048  # N, m


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """The first hundred metres of the build section."""
    path = tmp_path / "run.csv"
    write_trajectory(simulate(load_case(CASE), length=100.0), path)
    return path


def numbers(printed: str) -> list[list[float]]:
    """The numbers in the cells of each line of the tables."""
    lines = [line for line in printed.splitlines() if line.startswith("│")]
    return [[float(text) for text in re.findall(r"[-+]?\d+\.\d+", line)] for line in lines]


def test_stations_are_in_feet_and_degrees_per_hundred_feet(command_here: Command, run: Path) -> None:
    si, field = (
        np.array([line for line in numbers(printed.stdout) if len(line) == 5])
        for printed in (
            command_here("boreprop", "summary", str(run), "--stations", "30"),
            command_here("boreprop", "summary", str(run), "--stations", "30", "--units", "field"),
        )
    )
    assert si.shape == field.shape == (5, 5)
    for column in (0, 2, 3):
        np.testing.assert_allclose(field[:, column] * FEET, si[:, column], atol=0.07)
    np.testing.assert_array_equal(field[:, 1], si[:, 1])
    np.testing.assert_allclose(field[:, 4] / (100 * FEET), si[:, 4] / 30, atol=0.0004)


def test_forces_are_in_thousands_of_pounds(command_here: Command) -> None:
    def highest(printed: str) -> tuple[float, float]:
        found = re.search(r"highest build rate\s*│\s*([-+.\d]+) \S+ \S+ at ([-+.\d]+) (?:kN|klbf)", printed)
        assert found, printed
        return float(found[1]), float(found[2])

    rate, force = highest(command_here("boreprop", "steering", str(CASE)).stdout)
    printed = command_here("boreprop", "steering", str(CASE), "--units", "field").stdout
    rate_there, force_there = highest(printed)
    assert force_there * KLBF == pytest.approx(force * 1e3, abs=40.0)
    assert rate_there / (100 * FEET) == pytest.approx(rate / 30, abs=0.0004)
    assert "kN" not in printed
    assert "30 m" not in printed


def test_a_summary_has_no_metres_left(command_here: Command, run: Path) -> None:
    """Not even that of a hole that ripples, which is described in more lines."""
    write_trajectory(simulate(load_case(EXAMPLES / "paper_case.toml"), length=150.0), run)
    printed = command_here("boreprop", "summary", str(run), "--units", "field").stdout
    assert "yes" in printed
    assert not re.findall(r"\d (?:m|mm|kN)\b", printed)


def test_the_units_last_as_long_as_the_command(command_here: Command, run: Path) -> None:
    before = command_here("boreprop", "summary", str(run)).stdout
    in_field_units = command_here("boreprop", "summary", str(run), "--units", "field").stdout
    assert command_here("boreprop", "summary", str(run)).stdout == before != in_field_units
    assert command_here("boreprop", "summary", str(run), "--units", "si").stdout == before


def test_other_units_are_refused(command_here: Command, run: Path) -> None:
    assert_refused(command_here("boreprop", "summary", str(run), "--units", "miles"), "--units", "si or field", "miles")


def test_roots_have_lengths_in_feet(command_here: Command) -> None:
    def lengths(printed: str, unit: str) -> list[float]:
        return [float(text) for text in re.findall(rf"(?:doubles|halves) in ([\d.e+]+) {unit}\b", printed)]

    si = lengths(command_here("boreprop", "roots", str(CASE)).stdout, "m")
    printed = command_here("boreprop", "roots", str(CASE), "--units", "field").stdout
    assert len(si) == 8
    assert [FEET * length for length in lengths(printed, "ft")] == pytest.approx(si, rel=0.01)
    assert not re.findall(r"\d (?:m|kN)\b", printed)


def test_a_comparison_is_in_feet(command_here: Command, run: Path) -> None:
    survey = run.with_name("survey.csv")
    survey.write_text("measured_depth,inclination_deg\n2620,26.5\n2650,28.5\n2680,30.4\n", encoding="utf-8")
    si, field = (
        np.array([line for line in numbers(printed.stdout) if len(line) == 6])
        for printed in (
            command_here("boreprop", "compare", str(run), str(survey)),
            command_here("boreprop", "compare", str(run), str(survey), "--units", "field"),
        )
    )
    assert len(si) == len(field) >= 2
    np.testing.assert_allclose(field[:, 0] * FEET, si[:, 0], atol=0.07)
    np.testing.assert_array_equal(field[:, 1:4], si[:, 1:4])
    np.testing.assert_allclose(field[:, 4:] / (100 * FEET), si[:, 4:] / 30, atol=0.0004)


def test_the_picture_of_a_comparison_is_in_feet(run: Path) -> None:
    survey = run.with_name("survey.csv")
    survey.write_text("measured_depth,inclination_deg\n2620,26.5\n2650,28.5\n2680,30.4\n", encoding="utf-8")
    found = compare(read_trajectory(run), read_survey(survey))
    with field_units():
        panel = draw(found).axes[-1]
    assert panel.get_xlabel() == "measured depth (ft)"
    np.testing.assert_allclose(FEET * np.asarray(panel.lines[-1].get_xdata()), found.measured_depth)


def test_a_dogleg_is_over_feet(command_here: Command, paper_case: Path, tmp_path: Path) -> None:
    shutil.copy(paper_case, tmp_path)
    si = command_here("boreprop", "dogleg", "paper_case.toml", "--tolerance", "1e-5").stdout
    field = command_here("boreprop", "dogleg", "paper_case.toml", "--tolerance", "1e-5", "--units", "field").stdout
    found = re.findall(r"([\d.]+)° over ([\d.]+) m +\(([-+\d.]+) °/30 m\)", " ".join(si.replace("│", " ").split()))
    there = re.findall(
        r"([\d.]+)° over ([\d.]+) ft +\(([-+\d.]+) °/100 ft\)", " ".join(field.replace("│", " ").split())
    )
    assert len(found) == len(there) == 2
    for (turn, length, rate), (same, feet, steeper) in zip(found, there, strict=True):
        assert turn == same
        assert FEET * float(feet) == pytest.approx(float(length), rel=1e-3)
        assert float(steeper) / 30.48 == pytest.approx(float(rate) / 30, abs=0.004)

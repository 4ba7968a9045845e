"""The option --units: the same numbers in the units of the field."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from matplotlib.text import Text

from boreprop.analysis.comparison import compare
from boreprop.analysis.hysteresis import Hysteresis
from boreprop.analysis.stability.chart import stability_chart
from boreprop.case.file import load_case
from boreprop.case.tables import read_survey
from boreprop.report.figures import hysteresis as hysteresis_picture
from boreprop.report.figures import stability as stability_picture
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


@pytest.fixture
def short(tmp_path: Path, paper_text: str) -> Path:
    """The paper's case, over 60 m."""
    path = tmp_path / "case.toml"
    path.write_text(paper_text.replace("= 219.6", "= 60.0"), encoding="utf-8")
    return path


def test_a_study_is_in_feet(command_here: Command, short: Path) -> None:
    def table(*more: str) -> dict[str, list[float]]:
        printed = command_here(
            "boreprop", "study", short, "--vary", "rss_force=0,500", "--output", "study.csv", "--workers", "1", *more
        ).stdout
        lines: list[list[str]] = []
        for line in printed.splitlines():
            cells = [cell.strip() for cell in line.strip("│").split("│")]
            if line.startswith("│") and cells[1]:
                lines.append(cells)
            elif line.startswith("│"):  # the line before goes on
                lines[-1][0] += " " + cells[0]
        return {what: list(map(float, values)) for what, *values in lines if "–" not in values}

    si, field = table(), table("--units", "field")
    assert len(si) == len(field) >= 8
    pairs = {
        "build rate, mean (°/30 m)": ("build rate, mean (°/100 ft)", 30.48 / 30),
        "build rate, largest over 30 m (°/30 m)": ("build rate, largest over 98.4 ft (°/100 ft)", 30.48 / 30),
        "largest contact force, stabilizer 1 (kN)": ("largest contact force, stabilizer 1 (klbf)", 1e3 / KLBF),
        "inclination at the end (°)": ("inclination at the end (°)", 1.0),
    }
    for ours, (theirs, factor) in pairs.items():
        np.testing.assert_allclose(field[theirs], factor * np.array(si[ours]), rtol=2e-3)
    assert not any(re.search(r"\(1?/?(?:m|kN)\)|\d m\b", what) for what in field)


def test_a_hysteresis_loop_is_in_inches_and_feet(command_here: Command, paper_case: Path) -> None:
    loops = ["hysteresis", str(paper_case), "--tolerance", "1e-5", "--output", "loop.png", "--clearance-mm", "0.5:1:2"]
    si, field = (command_here("boreprop", *loops, *more).stdout for more in ([], ["--units", "field"]))
    metres, feet = re.search(r"over ([\d.]+) m in", si), re.search(r"over ([\d.]+) ft in", field)
    assert metres is not None
    assert feet is not None
    assert FEET * float(feet[1]) == pytest.approx(float(metres[1]), rel=1e-3)
    assert re.findall(r"[\d.]+ mm", si)
    assert not re.findall(r"\d (?:m|mm|kN)\b", field)
    inches = [0.0254 * float(text) for text in re.findall(r"([\d.]+) in\b(?! a)", field)]
    assert inches == pytest.approx([float(text) / 1e3 for text in re.findall(r"([\d.]+) mm", si)], rel=1e-3)


def test_a_stability_chart_is_in_feet_and_pounds(command_here: Command, paper_case: Path) -> None:
    chart = ["stability", str(paper_case), "--output", "chart.png", "--eta-pi", "0.01:0.2:3", "--lambda2", "0.5:2:3"]
    si, field = (command_here("boreprop", *chart, *more).stdout for more in ([], ["--units", "field"]))
    [waves], [feet] = re.findall(r"waves of ([\d.]+) m", si), re.findall(r"waves of ([\d.]+) ft", field)
    assert FEET * float(feet) == pytest.approx(float(waves), rel=5e-3)
    weights = [float(text) * 1e3 for text in re.findall(r"([\d.]+) kN", si)]
    assert [KLBF * float(text) for text in re.findall(r"([\d.]+) klbf", field)] == pytest.approx(weights, rel=1e-3)
    assert not re.findall(r"\d (?:m|kN)\b", field)


def test_the_axes_of_the_pictures_are_in_field_units() -> None:
    case = load_case(EXAMPLES / "paper_case.toml")
    chart = stability_chart(case, np.array([0.01, 0.1]), np.array([0.5, 2.0]), contacts=[(), (1,)])
    none: tuple[None, None] = (None, None)
    loop = Hysteresis("stabilizer_clearance[1]", (1e-3, 2e-3), 0.01, none, none, None, None)
    with field_units():
        pictures = [stability_picture.draw(chart, case), hysteresis_picture.draw(case, loop)]
    drawn = " ".join(text.get_text() for picture in pictures for text in picture.findobj(Text))
    for text in (
        "active weight on bit (klbf)",
        "stabilizer 1 to 2 (ft)",
        "in 328 ft to 3280 ft",
        "of stabilizer 1 (in)",
    ):
        assert text in drawn
    assert "ripple of the hole axis (± in)" in drawn
    assert "over 12.01 ft in a straight hole" in drawn
    assert not re.search(r"\((?:± )?(?:m|mm|kN)\)|\d k?m\b", drawn)

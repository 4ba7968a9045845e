"""The command `boreprop spiral`."""

import json
from pathlib import Path

import pytest
from matplotlib.image import imread

from boreprop.analysis.spiral.closed_form import spiral
from boreprop.case.file import load_case
from boreprop.report.tables.spiral import lines
from conftest import Command, assert_refused
from places import EXAMPLES


@pytest.fixture
def walking(tmp_path: Path) -> Path:
    text = (EXAMPLES / "paper_case.toml").read_text(encoding="utf-8")
    path = tmp_path / "walks.toml"
    path.write_text(text.replace("[bit]\n", "[bit]\nwalk_angle_deg = -10.0\n"), encoding="utf-8")
    return path


def test_it_prints_pitch_radius_and_where_spirals_end(command: Command, paper_case: Path) -> None:
    done = command("boreprop", "spiral", paper_case, "--ripple")
    assert (done.returncode, done.stderr) == (0, "")
    for text in ("to either side", "5.102 m", "21.4 mm", "19.4 kN", "0.235 °", "0.1327 (21.4 kN)", "0.1468 (23.66 kN)"):
        assert text in done.stdout
    assert "the hole of the case ends at 0.50 ° inclination: that has no part here" in " ".join(done.stdout.split())
    assert "a ripple in a plane, in waves of 5.07 m: a disturbance across it doubles in 8.1" in done.stdout


def test_json_has_the_fields_of_the_api_and_of_both_sides_if_the_bit_walks(
    command_here: Command, walking: Path
) -> None:
    document, case = json.loads(command_here("boreprop", "spiral", walking, "--json").stdout), load_case(walking)
    assert (document["handedness"], document["other"]["handedness"]) == ("left", "right")
    for printed, found in ((document, spiral(case, "left")), (document["other"], spiral(case, "right"))):
        assert printed["pitch"] == pytest.approx(found.pitch)
        assert printed["radius"] == pytest.approx(found.radius)
        assert printed["stabilizer_force"] == pytest.approx(found.stabilizer_force)
        assert found.edge is not None
        assert printed["edge"]["hole_inclination"] == pytest.approx(found.edge.hole_inclination)
    assert document["ripple"] is None


def test_a_case_without_a_spiral_has_none(command_here: Command, tmp_path: Path) -> None:
    text = (EXAMPLES / "paper_case.toml").read_text(encoding="utf-8")
    stiff = text.replace("tilt_limit_deg              = 2.0", "tilt_limit_deg = 0.2")
    (tmp_path / "stiff.toml").write_text(stiff, encoding="utf-8")
    document = json.loads(command_here("boreprop", "spiral", "stiff.toml", "--json").stdout)
    assert document["pitch"] is None
    assert document["edge"] is None
    case = load_case(tmp_path / "stiff.toml")
    [first, *others] = lines(case, spiral(case))
    assert first == ("spiral", "none")
    assert others
    assert not any("none" in line for line in others)


@pytest.mark.slow
def test_both_spirals_of_a_bit_that_walks_are_printed_in_units_of_the_field(
    command_here: Command, walking: Path
) -> None:
    printed = command_here("boreprop", "spiral", walking, "--units", "field").stdout
    for text in ("to the left", "to the right", "16.69 ft", "0.844 in"):
        assert text in printed


@pytest.mark.slow
def test_it_draws_a_chart_over_the_walk_angle(command_here: Command, tmp_path: Path, walking: Path) -> None:
    done = command_here("boreprop", "spiral", walking, "--chart", "chart.png")
    assert done.returncode == 0
    assert "chart.png: up to which ηΠ holes spiral" in done.stdout
    assert imread(tmp_path / "chart.png")[..., :3].std() > 0.05


def test_the_ripple_of_a_bit_that_walks_is_refused(command_here: Command, walking: Path) -> None:
    assert_refused(
        command_here("boreprop", "spiral", walking, "--ripple"), "--ripple: must be left out for a bit that walks"
    )


def test_a_wrong_picture_is_refused(command_here: Command, tmp_path: Path, paper_case: Path) -> None:
    done = command_here("boreprop", "spiral", paper_case, "--chart", "chart.pdf")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert not list(tmp_path.iterdir())

"""The commands `boreprop roots` and `boreprop stability`."""

import json
from pathlib import Path

import pytest
from matplotlib.image import imread

from boreprop.analysis.stability.roots import find_roots
from boreprop.case.case import Case
from conftest import Command, assert_refused


def test_roots_prints_json_rightmost_first(command: Command, paper_case: Path) -> None:
    arguments = ("--contact", "1", "--eta-pi", "0.01", "--inclination-deg", "0", "--json")
    result = command("boreprop", "roots", paper_case, *arguments)
    printed = json.loads(result.stdout)
    assert list(printed) == ["eta_pi", "mode", "roots", "verdict"]
    assert printed["eta_pi"] == 0.01
    assert printed["mode"] == {"contact": [1], "saturated": False}
    assert printed["roots"][0] == pytest.approx([0.313087, 18.174473], abs=1e-6)
    assert printed["verdict"] == "oscillatory"
    assert printed["roots"] == sorted(printed["roots"], key=lambda root: (-root[0], root[1]))
    assert all(imaginary >= 0 for _, imaginary in printed["roots"])


def test_roots_takes_eta_pi_and_the_inclination_from_the_case_and_no_contact(
    command: Command, paper_case: Path, case: Case
) -> None:
    printed = json.loads(command("boreprop", "roots", paper_case, "--saturated", "--json").stdout)
    found = find_roots(case, saturated=True)
    assert printed["roots"] == [[root.real, root.imag] for root in found.roots]
    assert printed["mode"] == {"contact": [], "saturated": True}


def test_a_root_at_zero_is_not_said_to_grow(command_here: Command, paper_case: Path) -> None:
    # without contact nothing turns a horizontal hole back, so a change of its inclination stays
    result = command_here("boreprop", "roots", paper_case, "--inclination-deg", "90", "--contact", "")
    [line] = [line for line in result.stdout.splitlines() if "0.000000" in line]
    assert "stays" in line


def test_what_not_met_means_is_said_where_it_stands(command_here: Command, tmp_path: Path, paper_text: str) -> None:
    file = tmp_path / "case.toml"
    file.write_text(paper_text.replace("[3.66e-3]", "[0.1]"), encoding="utf-8")
    result = command_here("boreprop", "roots", file)
    assert result.stdout.count("not met") == 3  # two modes and the caption
    file.write_text(paper_text, encoding="utf-8")
    assert "not met" not in command_here("boreprop", "roots", file).stdout


def test_roots_prints_a_line_for_each_mode(command: Command, paper_case: Path) -> None:
    result = command("boreprop", "roots", paper_case)
    lines = [line for line in result.stdout.splitlines() if "saturated" in line]
    assert len(lines) == 4
    for line, texts in zip(
        lines,
        [
            ("1 ", "not saturated", "oscillatory", "doubles in 8.1 m", "1.27 m", "would drill so"),
            ("1 ", "saturated", "drift", "doubles in 4160 m"),
            ("none", "not saturated", "stable", "halves in 11.5 m"),
            ("none", "saturated", "drift", "doubles in 1040 m"),
        ],
        strict=True,
    ):
        assert all(text in line for text in texts)
    assert "1.612 kN" in result.stdout


def test_roots_prints_all_modes_as_json(command: Command, paper_case: Path) -> None:
    printed = json.loads(command("boreprop", "roots", paper_case, "--all", "--json").stdout)
    assert [(mode["mode"]["contact"], mode["mode"]["saturated"]) for mode in printed] == [
        ([1], False),
        ([1], True),
        ([], False),
        ([], True),
    ]
    one = json.loads(command("boreprop", "roots", paper_case, "--json").stdout)
    assert one == printed[2]


def test_roots_of_no_contact_asked_for_are_a_table(command: Command, paper_case: Path) -> None:
    result = command("boreprop", "roots", paper_case, "--contact", "")
    assert "no contact, bit tilt not saturated: stable" in result.stdout
    assert "-0.220685" in result.stdout


def test_roots_prints_a_table(command: Command, paper_case: Path) -> None:
    result = command("boreprop", "roots", paper_case, "--contact", "1")
    assert result.returncode == 0
    for text in ("oscillatory", "stabilizer 1 in contact", "0.313087", "18.174473", "1.27 m"):
        assert text in result.stdout


def test_stability_draws_a_picture_and_prints_the_critical_eta_pi(
    command: Command, paper_case: Path, tmp_path: Path
) -> None:
    ranges = ("--eta-pi", "0.02:0.3:8", "--lambda2", "0.5:2:6")
    result = command("boreprop", "stability", paper_case, "--output", "chart.png", *ranges)
    assert result.stderr == ""
    assert "8 × 6 points" in result.stdout
    assert "stabilizer 1 in contact: oscillatory up to ηΠ = 0.146757 (23.66 kN; waves of 4.88 m)" in result.stdout
    assert "no contact: never oscillatory" in result.stdout
    assert imread(tmp_path / "chart.png")[..., :3].std() > 0.05
    assert [path.name for path in tmp_path.iterdir()] == ["chart.png"]


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("roots", "--contact", "1,x"), ("--contact", "'1,x'")),
        (("roots", "--all", "--contact", "1"), ("--all", "--contact '1'")),
        (("roots", "--contact", "2"), ("contact", "there are 1", "got 2")),
        (("roots", "--eta-pi", "1e-5"), ("eta_pi", "0.0001", "1e-05")),
        (("roots", "--inclination-deg", "nan"), ("--inclination-deg", "from -180 to 180", "nan")),
        (("stability", "--output", "chart.pdf"), ("chart.pdf", ".png")),
        (("stability", "--output", "chart.png", "--eta-pi", "0:1:5"), ("--eta-pi", "START:STOP:COUNT", "'0:1:5'")),
        (("stability", "--output", "chart.png", "--lambda2", "1:2"), ("--lambda2", "START:STOP:COUNT", "'1:2'")),
    ],
)
def test_commands_refuse_what_they_cannot_use(
    command_here: Command, paper_case: Path, tmp_path: Path, arguments: tuple[str, ...], named: tuple[str, ...]
) -> None:
    assert_refused(command_here("boreprop", arguments[0], paper_case, *arguments[1:]), *named)
    assert not list(tmp_path.iterdir())

"""The walk angle of the bit: a key of case files, which what drills in a plane refuses."""

from collections.abc import Callable
from dataclasses import replace
from math import radians
from pathlib import Path

import pytest

from boreprop.analysis.stability.roots import find_roots
from boreprop.analysis.steering import steady_response
from boreprop.case.case import Case
from boreprop.case.file import dump_case, load_case, parse_case
from boreprop.case.paper import paper_case
from boreprop.core.errors import ParameterError
from boreprop.errors import InputError
from conftest import Command
from places import EXAMPLES

WALKING = replace(paper_case(), bit=replace(paper_case().bit, walk_angle=radians(10.0)))


def with_walk(angle: str) -> str:
    text = (EXAMPLES / "paper_case.toml").read_text(encoding="utf-8")
    return text.replace("[bit]\n", f"[bit]\nwalk_angle_deg = {angle}\n")


def test_a_case_file_gives_it_in_degrees_and_one_without_has_none() -> None:
    assert parse_case(with_walk("-7.5"), "case.toml").bit.walk_angle == radians(-7.5)
    assert load_case(EXAMPLES / "paper_case.toml").bit.walk_angle == 0.0


def test_a_written_case_has_it_only_where_the_bit_walks() -> None:
    assert parse_case(dump_case(WALKING), "case.toml") == WALKING
    assert "walk" not in dump_case(paper_case())


@pytest.mark.parametrize(("angle", "constraint"), [("90.0", "<= 89"), ("-90.0", ">= -89")])
def test_a_right_angle_is_refused(angle: str, constraint: str) -> None:
    with pytest.raises(InputError, match=rf"^case.toml: bit.walk_angle_deg: must be {constraint}, got {angle}$"):
        parse_case(with_walk(angle), "case.toml")


@pytest.mark.parametrize(
    "planar",
    [
        lambda case: find_roots(case),
        lambda case: steady_response(case, 0.0, 0.0),
    ],
)
def test_what_is_planar_refuses_a_bit_that_walks(planar: Callable[[Case], object]) -> None:
    with pytest.raises(ParameterError, match=r"^bit_walk_angle: must be 0 for what drills in a plane; .*, got 0\.17"):
        planar(WALKING)


def test_a_command_says_so_in_one_line(command_here: Command, tmp_path: Path) -> None:
    (tmp_path / "walks.toml").write_text(with_walk("10.0"), encoding="utf-8")
    done = command_here("boreprop", "steering", "walks.toml")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert "bit.walk_angle_deg: must be 0" in done.stderr

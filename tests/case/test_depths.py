"""The bit before, at and beyond the end of its survey, and schedules by measured depth."""

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.analysis.comparison import compare
from boreprop.case.case import Case
from boreprop.case.file import dump_case, load_case, parse_case, read_case
from boreprop.case.inputs import Schedule
from boreprop.case.tables import read_schedule, read_survey
from boreprop.core.errors import ParameterError
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.simulate import simulate
from conftest import Command, assert_refused

FOOT = 0.3048
SOURCE = "case.toml"


@st.composite
def surveys(draw: st.DrawFn) -> Survey:
    """A survey of stands, singles or a few centimetres, from anywhere."""
    first, count = draw(st.floats(0.0, 6000.0)), draw(st.integers(1, 8))
    apart = draw(st.lists(st.floats(0.01, 40.0), min_size=count - 1, max_size=count - 1))
    angles = draw(st.lists(st.floats(-3.1, 3.1), min_size=count, max_size=count))
    return Survey(tuple(np.cumsum([first, *apart]).tolist()), tuple(angles))


@st.composite
def bits(draw: st.DrawFn) -> tuple[Survey, float]:
    """A survey, and a bit between its stations, at one of them, or beyond."""
    survey = draw(surveys())
    first, last = survey.measured_depth[0], survey.measured_depth[-1]
    between, beyond = st.floats(first, last), st.floats(last, last + 500.0)
    return survey, draw(st.one_of(between, st.sampled_from(survey.measured_depth), beyond))


@given(bits(), st.lists(st.floats(0.0, 1.0), min_size=1, max_size=20))
@settings(max_examples=300)
def test_the_hole_up_to_the_bit_is_that_of_the_survey_and_straight_beyond_it(
    given_bit: tuple[Survey, float], shares: list[float]
) -> None:
    survey, bit = given_bit
    hole = survey.with_bit_at(bit)
    assert hole.measured_depth[-1] == bit
    depth = survey.measured_depth[0] + np.array(shares) * (bit - survey.measured_depth[0])
    expected = np.interp(depth, survey.measured_depth, survey.inclination)
    # a station within a micrometre before the bit is at it
    steepest = np.abs(np.diff(survey.inclination) / np.diff(survey.measured_depth)).max(initial=0.0)
    found = np.interp(depth, hole.measured_depth, hole.inclination)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 + 2e-6 * steepest)


def test_a_bit_above_the_survey_or_nowhere_is_refused() -> None:
    survey = Survey((100.0, 200.0), (0.0, 0.1))
    with pytest.raises(ParameterError, match=r"bit_depth: must be >= 100, the first station of the survey, got 99\.0"):
        survey.with_bit_at(99.0)
    with pytest.raises(ParameterError, match="bit_depth: must be a finite number, got nan"):
        survey.with_bit_at(float("nan"))


def force_at(schedule: Schedule, length: float) -> float:
    return schedule.rss_force[bisect_right(schedule.drilled_length, length) - 1]


@given(
    bit=st.floats(0.0, 6000.0),
    before=st.lists(st.floats(0.01, 50.0), max_size=4),
    apart=st.lists(st.floats(0.01, 50.0), max_size=6),
    forces=st.lists(st.floats(-3e4, 3e4), min_size=12, max_size=12),
    feet=st.booleans(),
    tmp=st.uuids(),
)
@settings(max_examples=100)
def test_at_every_depth_the_force_is_that_of_the_last_entry_before_it(
    tmp_path_factory: pytest.TempPathFactory,
    bit: float,
    before: list[float],
    apart: list[float],
    forces: list[float],
    feet: bool,
    tmp: object,
) -> None:
    depths = sorted(
        {bit - d for d in np.cumsum(before).tolist()} | {bit} | {bit + d for d in np.cumsum(apart).tolist()}
    )
    unit, heading = (FOOT, "measured_depth_ft") if feet else (1.0, "measured_depth")
    file = tmp_path_factory.getbasetemp() / f"depths_{tmp}.csv"
    lines = [f"{depth / unit!r},{force!r}" for depth, force in zip(depths, forces, strict=False)]
    file.write_text("\n".join([f"{heading},force", *lines]))
    schedule = read_schedule(file, bit)
    file.unlink()
    for k, depth in enumerate(depths):
        if depth >= bit:
            assert force_at(schedule, depth - bit + 1e-9) == forces[k]
        if depth > bit:
            assert force_at(schedule, depth - bit - 1e-6) == forces[k - 1]


def test_a_first_entry_beyond_the_bit_is_refused_unless_only_by_rounding() -> None:
    assert Schedule.by_depth((2594.004,), (1.0,), 2594.0) == Schedule((0.0,), (1.0,))  # from feet with one decimal
    with pytest.raises(ParameterError) as caught:
        Schedule.by_depth((2594.1, 2600.0), (1.0, 2.0), 2594.0)
    constraint = "must start at 2594 or before, where the bit starts"
    assert str(caught.value) == f"measured_depth: {constraint}, got (2594.1, 2600.0)"


@pytest.fixture
def by_depth(paper_text: str) -> Callable[[str, str], str]:
    """The paper's case in a hole from 1000 m, with another end of the table [hole] and another table [rss]."""

    def text(hole: str, rss: str) -> str:
        head = paper_text.partition("[hole]")[0]
        survey = "measured_depth = [1000, 1010, 1040]\ninclination_deg = [0, 1, 4]\n"
        return f"{head}[hole]\n{survey}{hole}\n[rss]\n{rss}\n"

    return text


Text = Callable[[str, str], str]


def test_a_case_by_depth_is_the_same_case_by_drilled_length(by_depth: Text) -> None:
    rss = "measured_depth = [1000, 1020, 1033]\nforce = [1, 2, 3]"
    case = parse_case(by_depth("bit_depth = 1025", rss), SOURCE)
    assert case.schedule == Schedule((0.0, 8.0), (2.0, 3.0))
    assert case.survey.measured_depth == (1000.0, 1010.0, 1025.0)
    assert case.survey.inclination == pytest.approx(tuple(map(radians, (0.0, 1.0, 2.5))))
    without = parse_case(by_depth("", "measured_depth = [990, 1040.5]\nforce = [5, 6]"), SOURCE)
    assert without.schedule == Schedule((0.0, 0.5), (5.0, 6.0))
    assert parse_case(dump_case(case), "elsewhere.toml").schedule == case.schedule


@pytest.mark.parametrize(
    ("hole", "rss", "message"),
    [
        ("bit_depth = 999", "", "hole.bit_depth: must be >= 1000, the first station of the survey, got 999"),
        ("bit_depth = true", "", "hole.bit_depth: must be a valid number, got True"),
        ("bit_depth = [1]", "", "hole.bit_depth: must be a valid number, got [1]"),
        ("bit_depth = nan", "", "hole.bit_depth: must be a finite number, got nan"),
        ("", "measured_depth = 1\nforce = [1]", "rss.measured_depth: must be a list, such as [1], got 1"),
        ("", 'measured_depth = [1, "x"]\nforce = [1, 2]', "rss.measured_depth[2]: must be a valid number, got 'x'"),
        ("", "measured_depth = [1]\nforce = [false]", "rss.force[1]: must be a valid number, got False"),
        ("", "measured_depth = [1, 1]\nforce = [1, 2]", "rss.measured_depth: must increase, got (1.0, 1.0)"),
        ("", "measured_depth = [1]\nforce = []", "rss.force: must hold one value per measured_depth, 1 in all, got ()"),
        ("", "measured_depth = []\nforce = []", "rss.measured_depth: must start at 1040 or before, "),
        ("", "measured_depth = [1041]\nforce = [1]", "rss.measured_depth: must start at 1040 or before, "),
        ("", "measured_depth = [nan]\nforce = [1]", "rss.measured_depth: must be a finite number, got nan"),
        ("", "measured_depth = [1]\nforce = [inf]", "rss.force[1]: must be a finite number, got inf"),
        ("", "measured_depth = [1]\ndrilled_length = [0]\nforce = [1]", "rss: must hold either drilled_length and fo"),
        ("bit_dept = 1", "", "hole.bit_dept: must be a known key (hole.bit_depth?), got 1"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_depth_is_said(by_depth: Text, hole: str, rss: str, message: str) -> None:
    text = by_depth(hole, rss or "drilled_length = [0]\nforce = [0]")
    with pytest.raises(InputError) as caught:
        parse_case(text, SOURCE)
    assert str(caught.value).startswith(f"{SOURCE}: {message}")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            "measured_depth,force\n1041,1\n",
            ": measured_depth: must start at 1040 or before, where the bit starts, got ",
        ),
        ("measured_depth,drilled_length,force\n0,0,1\n", ": must have one of the columns 'drilled_length' and 'measur"),
        ("measured_depth_ft,drilled_length,force\n0,0,1\n", ": must have one of the columns 'drilled_length' and 'mea"),
    ],
)
def test_what_is_wrong_with_a_schedule_file_by_depth_is_said(
    by_depth: Text, tmp_path: Path, content: str, message: str
) -> None:
    (tmp_path / "s.csv").write_text(content)
    with pytest.raises(InputError) as caught:
        parse_case(by_depth("", 'schedule = "s.csv"'), tmp_path / SOURCE)
    assert str(caught.value).startswith(f"{tmp_path / 's.csv'}{message}")


def test_without_the_depth_of_the_bit_a_schedule_by_depth_is_refused(tmp_path: Path) -> None:
    (tmp_path / "s.csv").write_text("measured_depth,force\n0,1\n")
    with pytest.raises(InputError, match=r"s\.csv: measured_depth: must come with the depth of the bit, .*drilled_len"):
        read_schedule(tmp_path / "s.csv")


def test_files_by_depth_are_read_with_the_bit_of_the_case(by_depth: Text, tmp_path: Path) -> None:
    text = by_depth("", "").partition("[hole]")[0]
    text += '[hole]\nsurvey = "survey.csv"\nbit_depth = 1100\n[rss]\nschedule = "s.csv"\n'
    (tmp_path / SOURCE).write_text(text)
    (tmp_path / "survey.csv").write_text("measured_depth_ft,inclination_deg\n3000,10\n3500,20\n")
    (tmp_path / "s.csv").write_text(f"measured_depth_ft,force_kN\n0,1\n{1150 / FOOT!r},2\n")
    case, notes = read_case(tmp_path / SOURCE)
    assert case.survey.measured_depth == pytest.approx((3000 * FOOT, 3500 * FOOT, 1100.0))
    assert case.survey.inclination == pytest.approx(tuple(map(radians, (10, 20, 20))))
    assert case.schedule.drilled_length == pytest.approx((0.0, 50.0))
    assert case.schedule.rss_force == (1e3, 2e3)
    assert notes == ["hole.bit_depth: 33.2 m beyond the survey: the hole is extended straight to the bit"]


@pytest.mark.parametrize(
    ("bit", "notes"),
    [
        ("1040.004", []),
        ("1039.996", []),
        ("1050", ["hole.bit_depth: 10 m beyond the survey: the hole is extended straight to the bit"]),
        ("1001.5", ["hole.bit_depth: 38.5 m before the end of the survey: what lies beyond is left out"]),
    ],
)
def test_a_command_says_what_is_made_of_the_hole(
    by_depth: Text, command_here: Command, tmp_path: Path, bit: str, notes: list[str]
) -> None:
    (tmp_path / SOURCE).write_text(by_depth(f"bit_depth = {bit}", "drilled_length = [0]\nforce = [0]"))
    done = command_here("boreprop", "simulate", SOURCE, "--output", "run.csv", "--length", "1")
    assert done.returncode == 0
    said = [line for line in done.stderr.splitlines() if "bit_depth" in line]
    assert [line.removeprefix(f"warning: {SOURCE}: ").partition("; ")[0] for line in said] == notes


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_a_run_by_depth_keeps_its_meaning_in_its_file(by_depth: Text, tmp_path: Path, suffix: str) -> None:
    case = parse_case(by_depth("bit_depth = 1025", "measured_depth = [900, 1026]\nforce = [0, 4e3]"), SOURCE)
    run = simulate(case, length=5.0)
    write_trajectory(run, tmp_path / f"run.{suffix}")
    kept = read_trajectory(tmp_path / f"run.{suffix}").case
    assert kept is not None
    assert kept.schedule == case.schedule
    again = simulate(kept, length=5.0)
    for name in run:
        np.testing.assert_allclose(again[name], run[name], rtol=1e-12, atol=1e-12)


def test_a_hole_cut_at_the_bit_is_compared_with_the_rest_of_its_survey(by_depth: Text, tmp_path: Path) -> None:
    file = tmp_path / "survey.csv"
    file.write_text("measured_depth,inclination_deg\n1000,2\n1030,2\n1060,2\n1090,2\n")
    head = by_depth("", "").partition("[hole]")[0]
    (tmp_path / SOURCE).write_text(f'{head}[hole]\nsurvey = "survey.csv"\nbit_depth = 1035\n')
    case = load_case(tmp_path / SOURCE)
    found = compare(simulate(case, length=60.0), read_survey(file))
    assert found.measured_depth.tolist() == [1060.0, 1090.0]


def test_a_case_without_a_bit_depth_is_as_it_was(case: Case, paper_text: str) -> None:
    assert parse_case(paper_text, SOURCE) == case
    end = case.survey.measured_depth[-1]
    assert parse_case(paper_text.replace("[hole]", f"[hole]\nbit_depth = {end}"), SOURCE) == case
    assert replace(case, survey=case.survey.with_bit_at(end)) == case


def test_another_tools_fmu_has_no_bit_to_count_depths_from(command_here: Command, tmp_path: Path) -> None:
    (tmp_path / "s.csv").write_text("measured_depth,force\n0,1\n")
    (tmp_path / "x.fmu").write_bytes(b"PK\x05\x06" + bytes(18))  # an archive without files
    done = command_here("boreprop-fmu", "run", "x.fmu", "--schedule", "s.csv", "--output", "run.csv")
    assert_refused(done, "s.csv: measured_depth: must come with the depth of the bit")

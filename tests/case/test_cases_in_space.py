"""Cases that leave their vertical plane: azimuth, toolface and walk angle in case files."""

import re
from collections.abc import Callable
from dataclasses import replace
from math import cos, pi, radians, sin
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.file import dump_case, load_case, parse_case
from boreprop.case.inputs import Schedule
from boreprop.case.paper import paper_case
from boreprop.case.parameters import parameters, with_parameters
from boreprop.case.tables import read_survey
from boreprop.core.survey import Survey
from boreprop.errors import InputError, ParameterError

HOLE = "[hole]\nmeasured_depth = [0.0, 100.0, 200.0]\ninclination_deg = [10.0, 20.0, 30.0]\n"
FORCE = "[rss]\ndrilled_length = [0.0, 5.0]\nforce = [1e3, 2e3]\n"

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes the paper's case with other tables [hole] and [rss], and lines more in others."""

    def write(hole: str = HOLE, rss: str = "", **more: str) -> Path:
        text = dump_case(paper_case())
        text = text[: text.index("[hole]")]
        for table, line in more.items():
            text = text.replace(f"[{table}]\n", f"[{table}]\n{line}\n")
        path = tmp_path / "case.toml"
        path.write_text(text + hole + rss)
        return path

    return write


def test_a_case_of_the_plane_is_not_in_space(write: Write) -> None:
    case = load_case(write(rss=FORCE + "toolface_deg = [0, 180]\n"))
    assert not case.in_space
    assert case.schedule == Schedule((0.0, 5.0), (1e3, -2e3))


@pytest.mark.parametrize(
    ("hole", "rss", "more"),
    [
        (HOLE + "azimuth_deg = [40.0, 40.0, 40.0]\n", "", {}),
        (HOLE + "azimuth_deg = 40\n", "", {}),
        (HOLE, FORCE + "toolface_deg = 90.0\n", {}),
        (HOLE, FORCE + 'toolface_deg = 0\ntoolface_reference = "north"\n', {}),
        (HOLE, "", {"bit": "walk_angle_deg = -3.0"}),
        (HOLE, "", {"drilling": "dimensions = 3"}),
    ],
    ids=["azimuths", "one azimuth", "toolface", "reference", "walk", "dimensions"],
)
def test_what_takes_a_case_into_space(write: Write, hole: str, rss: str, more: dict[str, str]) -> None:
    case = load_case(write(hole, rss, **more))
    assert case.in_space
    assert case.structure.space == 1
    assert parse_case(dump_case(case), "again.toml") == case


def test_one_azimuth_is_that_of_every_station(write: Write, tmp_path: Path) -> None:
    columns = load_case(write(HOLE + "azimuth_deg = 40\n")).survey
    (tmp_path / "survey.csv").write_text("measured_depth,inclination_deg\n0,10\n100,20\n200,30\n")
    by_file = load_case(write('[hole]\nsurvey = "survey.csv"\nazimuth_deg = 40.0\n')).survey
    assert columns.azimuth == (radians(40),) * 3
    assert by_file == columns


def test_one_inclination_is_that_of_every_station(write: Write) -> None:
    hole = "[hole]\nmeasured_depth = [0.0, 10.0, 20.0]\ninclination_deg = 30\n"
    assert load_case(write(hole)).survey.inclination == (radians(30),) * 3


def test_a_survey_in_a_file_may_have_azimuths_all_round(tmp_path: Path) -> None:
    path = tmp_path / "survey.csv"
    path.write_text("measured_depth,inclination_deg,azimuth_deg\n0,10,359\n100,20,181\n")
    assert read_survey(path).azimuth == (radians(359), radians(181))
    path.write_text("measured_depth,inclination_deg,azimuth_deg\n0,10,361\n")
    with pytest.raises(InputError, match=r"survey.csv:2: azimuth_deg: must be <= 360, got 361.0"):
        read_survey(path)


def test_an_azimuth_is_not_given_twice(write: Write, tmp_path: Path) -> None:
    (tmp_path / "survey.csv").write_text("measured_depth,inclination_deg,azimuth_deg\n0,10,3\n")
    with pytest.raises(
        InputError, match=r"hole.azimuth_deg: must be left out, since survey.csv has a column azimuth_deg"
    ):
        load_case(write('[hole]\nsurvey = "survey.csv"\nazimuth_deg = 40.0\n'))


@pytest.mark.parametrize(
    ("hole", "rss", "says"),
    [
        (HOLE + "azimuth_deg = [1.0]\n", "", r"azimuth_deg: must hold one value per measured_depth, 3 in all"),
        (HOLE + "azimuth_deg = 400.0\n", "", r"hole.azimuth_deg\[1\]: must be <= 360, got 400.0"),
        (
            '[hole]\nsurvey = "survey.csv"\nazimuth_deg = 400.0\n',
            "",
            r"hole.azimuth_deg\[1\]: must be <= 360, got 400.0",
        ),
        (HOLE + "azimuth_deg = '45'\n", "", r"hole.azimuth_deg: must be a number or a list of numbers, got '45'$"),
        (HOLE, FORCE + "toolface_deg = 400\n", r"rss.toolface_deg\[1\]: must be <= 360, got 400.0$"),
        (HOLE, FORCE + "toolface_deg = -720\n", r"rss.toolface_deg\[1\]: must be >= -360, got -720.0$"),
        (HOLE, FORCE + "toolface_deg = [90.0]\n", r"must hold one value per drilled_length, 2 in all, got \(90.0,\)"),
        (HOLE, FORCE + 'toolface_deg = 9\ntoolface_reference = "up"\n', r"must be gravity, north or frame, got 'up'"),
        (HOLE, FORCE + "toolface_deg = 9\ntoolface_reference = 1\n", r"rss.toolface_reference: .*got 1$"),
    ],
)
def test_wrong_azimuths_and_toolfaces_are_refused(write: Write, hole: str, rss: str, says: str) -> None:
    path = write(hole, rss)
    (path.parent / "survey.csv").write_text("measured_depth,inclination_deg\n0,10\n")
    with pytest.raises(InputError, match=says) as caught:
        load_case(path)
    assert "\n" not in str(caught.value)


def test_duty_pushes_to_any_side(write: Write) -> None:
    rss = "[rss]\ndrilled_length = [0.0, 5.0]\nduty = [0.5, 1.0]\nfull_force = 2e4\ntoolface_deg = [0.0, 120.0]\n"
    schedule = load_case(write(rss=rss)).schedule
    assert schedule == Schedule((0.0, 5.0), (1e4, 2e4), rss_toolface=(0.0, radians(120.0)))


def test_a_schedule_in_a_file_may_have_a_toolface(write: Write, tmp_path: Path) -> None:
    (tmp_path / "s.csv").write_text("measured_depth,force,toolface_deg\n190,1e3,0\n210,2e3,270\n")
    schedule = load_case(write(rss='[rss]\nschedule = "s.csv"\ntoolface_reference = "frame"\n')).schedule
    assert (schedule.drilled_length, schedule.rss_force) == ((0.0, 10.0), (1e3, 2e3))
    assert schedule.rss_toolface == (0.0, radians(270.0))
    assert schedule.toolface_reference == ("frame", "frame")


def test_a_schedule_of_inputs_may_have_toolface_and_walk(write: Write) -> None:
    columns = "drilled_length = [0.0, 9.0], rss_force = [1e3, 2e3], rss_toolface_deg = [0.0, 45.0]"
    walk = ", bit_walk_angle_deg = [0.0, 5.0], toolface_reference = [0, 1]"
    case = load_case(write(drilling=f"schedule = {{ {columns}{walk} }}"))
    assert case.in_space
    assert case.schedule == Schedule((0.0, 9.0), (1e3, 2e3), "held", (0.0, radians(45.0)), ("gravity", "north"))
    assert case.profiles()["bit_walk_angle"].values == (0.0, radians(5.0))
    assert parse_case(dump_case(case), "again.toml") == case


def test_a_schedule_of_inputs_is_spelled_as_in_a_csv_file(write: Write, tmp_path: Path) -> None:
    columns = {"drilled_length_ft": 0.0, "force_kN": 8.0, "toolface_deg": 45.0, "walk_angle_deg": -5.0}
    inline = ", ".join(f"{name} = [{value}]" for name, value in columns.items())
    (tmp_path / "s.csv").write_text(f"{','.join(columns)}\n{','.join(map(str, columns.values()))}\n")
    here, there = (load_case(write(drilling=f"schedule = {table}")) for table in (f"{{ {inline} }}", '"s.csv"'))
    assert here == there
    assert here.schedule == Schedule((0.0,), (8e3,), rss_toolface=(radians(45.0),))


@pytest.mark.parametrize(
    ("column", "value", "says"),
    [
        ("toolface_deg", 400, "must be <= 360, got 400.0"),
        ("rss_toolface_deg", -400, "must be >= -360, got -400.0"),
        ("bit_walk_angle_deg", 100, "must be <= 89, got 100.0"),
        ("tilt_limit_deg", 0, "must be > 0, got 0.0"),
    ],
)
def test_an_angle_in_degrees_is_refused_in_degrees(
    write: Write, tmp_path: Path, column: str, value: float, says: str
) -> None:
    (tmp_path / "s.csv").write_text(f"drilled_length,force,{column}\n0,1e3,{value}\n")
    for table, where in (
        (f"{{ drilled_length = [0.0], force = [1e3], {column} = [{value}] }}", f"drilling.schedule.{column}[1]"),
        ('"s.csv"', f"s.csv:2: {column}"),
    ):
        with pytest.raises(InputError, match=re.escape(f"{where}: {says}")):
            load_case(write(drilling=f"schedule = {table}"))


def test_a_column_is_not_given_under_two_names(write: Write) -> None:
    with pytest.raises(InputError, match=r"drilling.schedule.rss_force: must be left out, since another column gives"):
        load_case(write(drilling="schedule = { drilled_length = [0.0], force = [1e3], rss_force = [1e3] }"))


def test_an_angle_without_its_unit_does_not_pass_unread(write: Write, tmp_path: Path) -> None:
    (tmp_path / "s.csv").write_text("drilled_length,force,toolface\n0,1e3,90\n")
    with pytest.raises(InputError, match=r"or 'toolface_deg' \(deg\), or none of it, got 'toolface'$"):
        load_case(write(drilling='schedule = "s.csv"'))


def test_two_dimensions_are_refused_to_a_case_in_space(write: Write) -> None:
    with pytest.raises(InputError, match=r"drilling.dimensions: must be 3 for a case with an azimuth, .*, got 2$"):
        load_case(write(HOLE + "azimuth_deg = 40\n", drilling="dimensions = 2"))
    assert not load_case(write(HOLE, drilling="dimensions = 2")).in_space


def test_a_toolface_without_a_force_is_refused(write: Write) -> None:
    columns = "drilled_length = [0.0], rss_toolface = [1.0]"
    with pytest.raises(InputError, match="rss_toolface: must come with rss_force"):
        load_case(write(drilling=f"schedule = {{ {columns} }}"))


def test_toolface_and_walk_are_parameters_of_a_study(case: Case) -> None:
    in_space = replace(case, dimensions=3)
    changed = with_parameters(in_space, {"rss_force": 5e3, "rss_toolface": 1.0, "bit_walk_angle": 0.1})
    assert changed.schedule == Schedule((0.0,), (5e3,), rss_toolface=(1.0,))
    assert parameters(changed)["bit_walk_angle"] == 0.1
    assert parameters(with_parameters(changed, {"rss_position": 0.5}))["rss_toolface"] == 1.0
    assert "rss_toolface" not in parameters(case)


ANGLE = st.floats(-2 * pi, 2 * pi)
INCLINATION = st.floats(0.01, pi - 0.01)


@given(INCLINATION, ANGLE, INCLINATION, ANGLE, st.floats(0.0, 1.0))
def test_a_bit_between_stations_is_on_the_great_circle(
    i_0: float, a_0: float, i_1: float, a_1: float, t: float
) -> None:
    survey = Survey((0.0, 100.0), (i_0, i_1), (a_0, a_1)).with_bit_at(100.0 * t)
    start, end, at = (
        np.array([sin(i) * cos(a), sin(i) * sin(a), cos(i)])
        for i, a in ((i_0, a_0), (i_1, a_1), (survey.inclination[-1], survey.azimuth[-1]))
    )

    def angle(p: np.ndarray, q: np.ndarray) -> float:
        return float(2 * np.arctan2(np.linalg.norm(p - q), np.linalg.norm(p + q)))

    whole = angle(start, end)
    if whole < pi - 1e-3:  # opposite directions have no great circle of their own
        assert angle(start, at) == pytest.approx(t * whole, abs=1e-6)
        assert angle(at, end) == pytest.approx((1 - t) * whole, abs=1e-6)


def test_a_hole_that_only_looks_as_if_it_turned_stays_in_its_plane() -> None:
    assert not Survey((0.0, 10.0, 20.0), (0.0, 0.1, 0.2), (1.0, 0.3, 0.3)).turns  # the first station is vertical
    assert Survey((0.0, 10.0, 20.0), (0.1, 0.1, 0.2), (1.0, 0.3, 0.3)).turns


@pytest.mark.parametrize("toolface", [0.0, pi, -pi, 2 * pi, -2 * pi])
def test_up_and_down_are_signs_of_the_force(toolface: float) -> None:
    assert Schedule((0.0,), (1e3,), rss_toolface=(toolface,)) == Schedule((0.0,), (1e3 * round(cos(toolface)),))


def test_a_schedule_of_another_reference_is_refused() -> None:
    with pytest.raises(ParameterError, match="must be gravity, north or frame, got 'magnetic'"):
        Schedule((0.0,), (1e3,), toolface_reference=("magnetic",))

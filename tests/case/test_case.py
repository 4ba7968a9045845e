"""Case files: what is written reads back, and what is wrong is said in one line."""

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.file import dump_case, load_case, parse_case
from boreprop.case.inputs import Schedule
from boreprop.case.schema import PATHS
from boreprop.case.tables import read_schedule, read_survey
from boreprop.core.errors import ParameterError
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly, eta_pi, scale
from boreprop.errors import InputError

SOURCE = "case.toml"


def real(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_subnormal=False)


@st.composite
def increasing(draw: st.DrawFn, first: st.SearchStrategy[float], size: int) -> tuple[float, ...]:
    values = [draw(first)]
    for _ in range(size - 1):
        values.append(values[-1] + draw(real(0.01, 30.0)))
    return tuple(values)


angles = real(-pi, pi).map(lambda angle: angle if abs(angle) > 1e-9 else 0.0)


@st.composite
def cases(draw: st.DrawFn) -> Case:
    n, stations, steps = draw(st.integers(1, 6)), draw(st.integers(1, 5)), draw(st.integers(1, 5))
    positions = draw(increasing(real(0.5, 5.0), n))
    return Case(
        bha=BottomHoleAssembly(
            stabilizer_positions=positions,
            stabilizer_clearances=draw(st.tuples(*[real(0.0, 0.02)] * (n - 1))),
            rss_position=positions[0] * draw(real(0.0, 1.0)),
            distributed_weight=draw(real(0.0, 1e4)),
            flexural_stiffness=draw(real(1e3, 1e9)),
        ),
        bit=BitRock(draw(real(0.1, 100.0)), draw(real(0.01, 10.0)), draw(real(1e-5, pi / 2))),
        bit_diameter=draw(real(0.05, 1.0)),
        active_weight_on_bit=draw(real(1.0, 1e6)),
        length=draw(real(0.1, 1e4)),
        survey=Survey(draw(increasing(real(-1e3, 1e4), stations)), draw(st.tuples(*[angles] * stations))),
        schedule=Schedule(draw(increasing(st.just(0.0), steps)), draw(st.tuples(*[real(-1e5, 1e5)] * steps))),
    )


@given(cases())
@settings(max_examples=100, deadline=None)
def test_a_case_written_reads_back_the_same(case: Case) -> None:
    back = parse_case(dump_case(case), SOURCE)
    bit, survey = back.bit, back.survey
    assert bit.tilt_limit == pytest.approx(case.bit.tilt_limit, rel=5e-16, abs=0)
    assert survey.inclination == pytest.approx(case.survey.inclination, rel=5e-16, abs=0)
    assert case == replace(
        back,
        bit=replace(bit, tilt_limit=case.bit.tilt_limit),
        survey=replace(survey, inclination=case.survey.inclination),
    )


def test_a_case_made_with_numpy_is_written_like_another(case: Case) -> None:
    bit = replace(case.bit, walk_angle=np.radians(2.0), tilt_limit=np.float64(0.02))
    made = replace(case, bit=bit, active_weight_on_bit=np.float64(2e3))
    assert parse_case(dump_case(made), SOURCE) == made


@given(st.integers(-180_000_000, 180_000_000))
@settings(deadline=None)
def test_degrees_that_a_person_writes_are_written_back_as_they_were(paper_text: str, millionths: int) -> None:
    text = paper_text.replace("[0.0, 0.0, 0.5]", f"[0.0, 0.0, {millionths / 1e6}]")
    assert f"    {millionths / 1e6},\n" in dump_case(parse_case(text, SOURCE))


def test_the_paper_case_has_the_papers_dimensionless_numbers(paper_case: Path) -> None:
    case = load_case(paper_case)
    scaled = scale(case.bha, case.bit)
    assert case.bha.force_scale == pytest.approx(1.612469e6, rel=1e-6)
    assert eta_pi(case.bha, case.bit, case.active_weight_on_bit) == pytest.approx(0.01, rel=1e-6)
    assert scaled.w == pytest.approx(2.451395e-3, rel=1e-6)
    assert scaled.lambda_ == pytest.approx((1, 1))
    assert scaled.y_star == pytest.approx((1e-3,))
    assert scaled.Delta == pytest.approx(0.6 / 3.66)
    assert scaled.epsilon == pytest.approx(0.1)
    assert scaled.psi_star == pytest.approx(2 * pi / 180)
    assert case.length == pytest.approx(60 * 3.66)
    assert case.survey.inclination == pytest.approx((0, 0, 0.5 * pi / 180))


def test_without_an_rss_table_there_is_no_force(paper_text: str) -> None:
    assert parse_case(paper_text.partition("[rss]")[0], SOURCE).schedule == Schedule((0.0,), (0.0,))


def test_survey_and_schedule_files_are_looked_up_beside_the_case_file(paper_text: str, tmp_path: Path) -> None:
    head = paper_text.partition("[hole]")[0]
    (tmp_path / "case.toml").write_text(head + '[hole]\nsurvey = "s.csv"\n[rss]\nschedule = "rss/f.csv"\n')
    (tmp_path / "s.csv").write_text("inclination_deg,comment,measured_depth\n0,from,100\n90,to,200\n")
    (tmp_path / "rss").mkdir()
    (tmp_path / "rss" / "f.csv").write_text("drilled_length,force\n0,1e3\n10,-2e3\n")
    case = load_case(tmp_path / "case.toml")
    assert case.survey == Survey((100.0, 200.0), (0.0, pi / 2))
    assert case.schedule == Schedule((0.0, 10.0), (1000.0, -2000.0))
    assert parse_case(dump_case(case), "elsewhere.toml") == case


def test_a_byte_order_mark_and_windows_line_ends_are_no_trouble(paper_text: str, tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_bytes(b"\xef\xbb\xbf" + paper_text.replace("\n", "\r\n").encode())
    assert load_case(file) == parse_case(paper_text, SOURCE)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("rss_position ", "rss_positon ", "bha.rss_positon: must be a known key (bha.rss_position?), got 0.6"),
        ("tilt_limit_deg ", "tilt_limit ", "bit.tilt_limit: must be a known key (bit.tilt_limit_deg?), got 2.0"),
        ("[drilling]", "[driling]", "driling: must be a known key (drilling?), got ['active_weight_on_bit', 'length']"),
        ("[3.66, 7.32]", '[3.66, "7"]', "bha.stabilizer_positions[2]: must be a valid number, got '7'"),
        ("[3.66, 7.32]", "[]", "bha.stabilizer_positions: must hold 1 to 6 values, got ()"),
        ("[3.66e-3]", "[-1e-3]", "bha.stabilizer_clearances[1]: must be >= 0, got -0.001"),
        ("= 0.6", "= 4", "bha.rss_position: must be <= 3.66, got 4.0"),
        ("= 0.6", "= true", "bha.rss_position: must be a valid number, got True"),
        ("= 0.6", "= 1979-05-27", "bha.rss_position: must be a valid number, got datetime.date(1979, 5, 27)"),
        ("= 2.0", "= 95", "bit.tilt_limit_deg: must be <= 90, got 95"),
        ("= 0.2159", "= 0", "bit.diameter: must be > 0, got 0.0"),
        ("= 0.2159", "= 8.5", "bit.diameter: must be <= 1.5, got 8.5"),
        ("[0.0, 0.0, 0.5]", "[0.0, -999.25, 0.5]", "hole.inclination_deg[2]: must be >= -180, got -999.25"),
        ("[0.0, 0.0, 0.5]", "[0.0, 0.0, 180.1]", "hole.inclination_deg[3]: must be <= 180, got 180.1"),
        ("= 1612.469", "= -1", "drilling.active_weight_on_bit: must be > 0, got -1.0"),
        ("= 219.6", f"= 1{'0' * 400}", "drilling.length: must be "),
        ("= 219.6", "= inf", "drilling.length: must be a finite number, got inf"),
        ("[0.0, 0.0, 0.5]", "[0.0, 0.5]", "hole.inclination_deg: must hold one value per measured_depth, 3 in all"),
        ("[0.0, 0.0, 0.5]", "[0.0, nan, 0.5]", "hole.inclination_deg[2]: must be a finite number, got nan"),
        ("[hole]", '[hole]\nsurvey = ""', "hole: must hold either measured_depth and inclination_deg, or survey, got "),
        ("drilled_length = [0.0]", "", "rss: must hold either drilled_length and force, or measured_depth and force"),
        ("drilled_length = [0.0]", "drilled_length = [1]", "rss.drilled_length: must start at 0, got (1.0,)"),
        ("drilled_length = [0.0]", "drilled_length = [0, 5, 5]", "rss.drilled_length: must increase, got "),
        ("force          = [0.0]", "force = []", "rss.force: must hold one value per drilled_length, 1 in all, got ()"),
        ("[rss]", "[[rss]]", "rss: must be a table, got [{'drilled_length': [0.0], 'force': [0.0]}]"),
        ("[bit]", "[bit", "must be TOML, got: Expected ']' at the end of a table declaration (at line "),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_with_its_key_constraint_and_value(
    paper_text: str, old: str, new: str, message: str
) -> None:
    assert paper_text.count(old) == 1
    with pytest.raises(InputError) as caught:
        parse_case(paper_text.replace(old, new), SOURCE)
    assert str(caught.value).startswith(f"{SOURCE}: {message}")


@given(st.data())
@settings(max_examples=300, deadline=None)
def test_a_garbled_file_is_a_case_or_a_one_line_error(paper_text: str, data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(paper_text)))
    end = data.draw(st.integers(start, min(start + 20, len(paper_text))))
    inserted = data.draw(st.text(st.sampled_from("0123456789.-e[]{}\"'=,#\n abnistrue"), max_size=10))
    try:
        parse_case(paper_text[:start] + inserted + paper_text[end:], SOURCE)
    except InputError as error:
        message = str(error)
    else:
        return
    assert message.startswith(f"{SOURCE}: ")
    assert "\n" not in message


BACKSLASH = (
    "must be a path with forward slashes or in single quotes, since in double quotes a backslash begins an escape"
)


@pytest.mark.parametrize("path", ["C:/Me/me/s.csv", "data/survey.csv", "C:/new/temp/s.csv", "C:/x/", "//pc/s.csv"])
def test_a_path_as_windows_writes_it_is_refused_with_the_remedy(paper_text: str, tmp_path: Path, path: str) -> None:
    windows = path.replace("/", "\\")
    text = paper_text.partition("[hole]")[0] + f'[hole]\nsurvey = "{windows}"\n'
    with pytest.raises(InputError, match=rf"case\.toml: .*{PATHS}, got ") as caught:
        parse_case(text, tmp_path / "case.toml")
    assert "\n" not in str(caught.value)
    for readable in (f'"{path}"', f"'{windows}'"):
        with pytest.raises(InputError, match="must be a readable CSV file, got: "):
            parse_case(text.replace(f'"{windows}"', readable), tmp_path / "case.toml")


@pytest.mark.parametrize("clearance", ["0.10795", "3.66"])
def test_a_clearance_as_wide_as_half_the_hole_is_refused(paper_text: str, tmp_path: Path, clearance: str) -> None:
    file = tmp_path / "case.toml"
    file.write_text(paper_text.replace("[3.66e-3]", f"[{clearance}]"))
    with pytest.raises(InputError) as caught:
        load_case(file)
    constraint = "must be < bit.diameter/2 = 0.10795"
    assert str(caught.value) == f"{file}: bha.stabilizer_clearances[1]: {constraint}, got {clearance}"
    file.write_text(paper_text.replace("[3.66e-3]", "[0.1079]"))
    load_case(file)


def test_a_case_file_in_another_encoding_is_refused_with_the_remedy(paper_text: str, tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_bytes(b"# 40\xb0 51 N\n" + paper_text.encode())
    with pytest.raises(InputError, match=r"case\.toml: must be a TOML file in UTF-8 .*, got the byte 0xb0"):
        load_case(file)


def test_a_long_wrong_column_is_shown_by_its_beginning(paper_text: str) -> None:
    text = paper_text.replace("drilled_length = [0.0]", f"drilled_length = {[0.0] * 1000}")
    with pytest.raises(InputError, match=r"must increase, got .{1,80}$"):
        parse_case(text, SOURCE)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("drilled_length,force\n0,1\n5\n", ":3: must have 2 values like the header, got 1"),
        ("drilled_length,force\n0,1\n5,nan\n", ":3: force: must be a finite number, got 'nan'"),
        ("drilled_length,force\n0,1\n5,2\n4,3\n", ": drilled_length: must increase, got "),
        ("drilled_length,force\n", ": drilled_length: must start at 0, got ()"),
        (
            "length,force\n0,1\n",
            ": must have a column 'drilled_length' (m) or 'drilled_length_ft' (ft) or 'measured_depth' (m) or ",
        ),
    ],
)
def test_a_wrong_schedule_file_is_named(tmp_path: Path, content: str, message: str) -> None:
    file = tmp_path / "schedule.csv"
    file.write_text(content)
    with pytest.raises(InputError) as caught:
        read_schedule(file)
    assert str(caught.value).startswith(f"{file}{message}")


def test_a_survey_file_without_a_station_is_named(tmp_path: Path) -> None:
    file = tmp_path / "survey.csv"
    file.write_text("measured_depth,inclination_deg\n")
    with pytest.raises(InputError) as caught:
        read_survey(file)
    assert str(caught.value) == f"{file}: measured_depth: must hold at least one station, got ()"


@pytest.mark.parametrize("name", ["bit_diameter", "active_weight_on_bit", "length"])
def test_a_case_made_in_python_is_checked_too(paper_case: Path, name: str) -> None:
    change: dict[str, Any] = {name: 0.0}
    with pytest.raises(ParameterError, match=rf"{name}: must be > 0, got 0\.0"):
        replace(load_case(paper_case), **change)

"""CSV files as people have them: every dialect reads back equal, and what is not plain is refused by name."""

import csv
import io
from collections.abc import Callable
from functools import partial
from math import radians
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.case.inputs import NAMES_OF_COLUMNS
from boreprop.case.sheet import read_sheet
from boreprop.case.tables import read_inputs, read_schedule, read_survey
from boreprop.core.survey import Survey
from boreprop.errors import InputError

HEADINGS = ("measured_depth", "inclination_deg")
CERTAIN = 1234567.25  # with its separators between thousands it can be read in one way only


def written(number: float, mark: str, between: str) -> str:
    """A number as people write it; `between` stands between thousands."""
    text = f"{number:,}" if between and "e" not in repr(number) else repr(number)
    return text.replace(",", "\0").replace(".", mark).replace("\0", between)


@st.composite
def dialects(draw: st.DrawFn) -> dict[str, str]:
    mark = draw(st.sampled_from(".,"))
    return {
        "separator": draw(st.sampled_from(",;\t")),
        "mark": mark,
        "between": draw(st.sampled_from(["", ",.".replace(mark, ""), " ", "'", "\u00a0"])),
        "encoding": draw(
            st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "cp1252"])
        ),
        "end": draw(st.sampled_from(["\n", "\r\n", "\r"])),
        "empty": draw(st.sampled_from(["", "cells", "line"])),
        "trailing": draw(st.sampled_from(["", "rows", "all"])),
        "quoted": draw(st.sampled_from(["", "all"])),
        "hint": draw(st.sampled_from(["", "sep="])),
    }


def csv_bytes(columns: dict[str, list[str]], dialect: dict[str, str]) -> bytes:
    """A table as a file in a dialect."""
    separator, empty = dialect["separator"], [""] * len(columns)
    rows = [list(columns), *(list(row) for row in zip(*columns.values(), strict=True))]
    if dialect["trailing"]:
        rows = [row + [""] * (k > 0 or dialect["trailing"] == "all") for k, row in enumerate(rows)]
    if dialect["empty"] == "cells":
        rows = [empty, rows[0], empty, *rows[1:], empty, empty]
    out = io.StringIO(newline="")
    write = partial(csv.writer, out, delimiter=separator, lineterminator=dialect["end"])
    (write(quoting=csv.QUOTE_ALL) if dialect["quoted"] else write()).writerows(rows)
    blank = dialect["end"] if dialect["empty"] == "line" else ""
    hint = f"sep={separator}{dialect['end']}" if dialect["hint"] else ""
    return (hint + blank + out.getvalue() + blank).encode(dialect["encoding"])


numbers = st.floats(allow_nan=False, allow_infinity=False) | st.integers(-10_000_000, 10_000_000).map(
    lambda k: k / 1000
)
remarks = st.text(st.sampled_from("abc °ü;,\t'\"\n12.5-"), max_size=6)


@given(
    table=st.lists(st.tuples(numbers, numbers, remarks), min_size=1, max_size=6),
    dialect=dialects(),
    at=st.integers(0, 2),
)
@settings(max_examples=200, deadline=None)
def test_a_table_in_any_dialect_reads_back_equal(
    table: list[tuple[float, float, str]], dialect: dict[str, str], at: int
) -> None:
    if dialect["between"] or dialect["separator"] == dialect["mark"]:
        table = [(CERTAIN, CERTAIN, "x"), *table]
    first, second = [row[0] for row in table], [row[1] for row in table]
    cells = [
        (heading, [written(number, dialect["mark"], dialect["between"]) for number in column])
        for heading, column in zip(HEADINGS, (first, second), strict=True)
    ]
    cells.insert(at, ("remark °", [remark.replace("\n", dialect["end"]) for *_, remark in table]))
    with TemporaryDirectory() as directory:
        file = Path(directory, "table.csv")
        file.write_bytes(csv_bytes(dict(cells), dialect))
        sheet = read_sheet(file, HEADINGS.__contains__)
        assert sheet.numbers(HEADINGS) == [first, second]


@pytest.mark.parametrize(
    "content",
    [
        b"measured_depth;inclination_deg\r\n2500,5;26,10\r\n2510,5;26,25\r\n",
        b"measured_depth\tinclination_deg\n2500.5\t26.1\n2510.5\t26.25\n",
        b"measured_depth,inclination_deg,latitude\n2500.5,26.1,40\xb0 51 N\n2510.5,26.25,\n",
        b"measured_depth,inclination_deg,\n,,\n2500.5,26.1,\n2510.5,26.25,,,\n,,\n",
        b'measured_depth,inclination_deg\n"2,500.5",26.1\n"2,510.5",26.25\n',
        b"sep=;\n measured_depth ;inclination_deg\n2.500,5;26,1\n2.510,5;26,25\n",
        "measured_depth,inclination_deg\n2500.5,26.1\n2510.5,26.25\n".encode("utf-16"),
    ],
)
def test_a_survey_is_read_however_it_is_written(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "survey.csv").write_bytes(content)
    assert read_survey(tmp_path / "survey.csv") == Survey((2500.5, 2510.5), (radians(26.1), radians(26.25)))


def test_other_units_are_converted(tmp_path: Path) -> None:
    file = tmp_path / "table.csv"
    file.write_text("measured_depth_ft,inclination_deg\n0,26\n10000,26\n")
    assert read_survey(file).measured_depth == pytest.approx((0.0, 3048.0), rel=1e-15)
    file.write_text("drilled_length_ft,force_lbf\n0,1000\n100,0\n")
    schedule = read_schedule(file)
    assert schedule.drilled_length == pytest.approx((0.0, 30.48), rel=1e-15)
    assert schedule.rss_force == pytest.approx((4448.2216152605, 0.0), rel=1e-15)
    file.write_text("drilled_length,force_klbf\n0,1\n")
    assert read_schedule(file).rss_force == pytest.approx((4448.2216152605,), rel=1e-15)
    file.write_text("drilled_length,force_kN,force_lbf\n0,2.5,1000\n")
    assert read_schedule(file).rss_force == (2500.0,)


@pytest.mark.parametrize(
    ("read", "content", "heading"),
    [
        (read_inputs, "drilled_length,rss_force,active_weight_on_bit_kip\n0,1,2\n", "active_weight_on_bit_kip"),
        (read_inputs, "drilled_length,rss_force,bit_tilt_limit_rad\n0,1,2\n", "bit_tilt_limit_rad"),
        (read_schedule, "drilled_length,force,toolface\n0,1,2\n", "toolface"),
        (read_survey, "measured_depth,inclination_deg,azimuth\n0,1,2\n", "azimuth"),
    ],
)
def test_a_column_that_may_be_left_out_is_not_overlooked_for_its_unit(
    tmp_path: Path, read: Callable[[Path], object], content: str, heading: str
) -> None:
    file = tmp_path / "table.csv"
    file.write_text(content)
    with pytest.raises(InputError, match=f"table.csv: must have the column .*, or none of it, got '{heading}'"):
        read(file)


@given(name=st.sampled_from(NAMES_OF_COLUMNS), end=st.from_regex(r"_[A-Za-z]{1,4}", fullmatch=True))
@settings(max_examples=25)
def test_an_input_with_any_ending_is_read_or_refused(name: str, end: str) -> None:
    with TemporaryDirectory() as directory:
        file = Path(directory, "table.csv")
        file.write_text(f"drilled_length,rate_of_penetration,rss_force,{name}{end}\n0,1,1e3,1\n")
        try:
            _, inputs = read_inputs(file)
        except InputError as error:
            said = str(error)
        else:
            assert inputs is not None
            said = f"read {[name for name, _ in inputs.inputs]} and rss_force, rss_toolface"
    assert f"got '{name}{end}'" in said or name in said.partition("read ")[2]


SURVEY = b"measured_depth,inclination_deg\n2500,26\n"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"PK\x03\x04" + bytes(range(256)), ": must be a CSV file, got a workbook: save its sheet as CSV"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", ": must be a CSV file, got a workbook: save its sheet as CSV"),
        (SURVEY + b"2510,-999.25\n", ":3: inclination_deg: must be >= -180, got -999.25"),
        (
            SURVEY + b"-999.25,26\n",
            ":3: measured_depth: must be a value, got -999.25, which stands for no value: leave",
        ),
        (
            SURVEY + b"\n-9999,26\n",
            ":4: measured_depth: must be a value, got -9999.0, which stands for no value: leave",
        ),
        (SURVEY + b"1e30,26\n", ":3: measured_depth: must be a value, got 1e+30, which stands for no value: leave"),
        (SURVEY + b"2510,\n", ":3: inclination_deg: must be a finite number, got ''"),
        (SURVEY + b"2510,NaN\n", ":3: inclination_deg: must be a finite number, got 'NaN'"),
        (SURVEY + b"2510,180.5\n", ":3: inclination_deg: must be <= 180, got 180.5"),
        (SURVEY + b"2_510,26\n", ":3: measured_depth: must be a finite number, got '2_510'"),
        (SURVEY + b'2510,"26\n', ": must be a CSV file with quotes in pairs, got: unexpected end of data in line 3"),
        (
            b"MD (ft),Inc\n8200,26\n",
            ": must have a column 'measured_depth' (m) or 'measured_depth_ft' (ft), got ['MD (ft)', 'Inc']",
        ),
        (b"measured_depth;Inc\n8200;26\n", ": must have a column 'inclination_deg' (degrees), got ['measured_depth', "),
        (
            b"measured_depth,measured_depth,inclination_deg\n1,2,3\n",
            ": must have a single column 'measured_depth', got 2",
        ),
        (
            b'measured_depth,inclination_deg\n"8,200","26,375"\n',
            ": must have numbers without separators between thousands, got '8,200': 8200 or 8.2?",
        ),
        (
            b"measured_depth;inclination_deg\n2500,5;26,1\n2510,5;\n",
            ":3: inclination_deg: must be a finite number, got ''",
        ),
        (b"measured_depth,inclination_deg\n2510,26,5\n", ":2: must have 2 values like the header, got 3"),
        (b"Well 15/9-F-12\n" + SURVEY, ": must have the names of its columns in its first row, got ['Well 15/9-F-12']"),
        (SURVEY + b"9" * 5000 + b",26\n", ":3: measured_depth: must be a finite number, got '9999"),
    ],
)
def test_what_is_no_survey_is_refused_by_file_line_and_value(tmp_path: Path, content: bytes, message: str) -> None:
    file = tmp_path / "survey.csv"
    file.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_survey(file)
    assert str(caught.value).startswith(f"{file}{message}")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 300 + len(str(file))


@given(
    st.binary(max_size=200)
    | st.text(st.sampled_from(";,\t\"'\n\r .0123456789e-+_measured_depthinclination"), max_size=120).map(str.encode)
)
@settings(max_examples=300, deadline=None)
def test_any_file_is_a_survey_or_a_one_line_error(content: bytes) -> None:
    with TemporaryDirectory() as directory:
        for beginning in (b"", SURVEY, SURVEY.replace(b",", b";")):
            file = Path(directory, "survey.csv")
            file.write_bytes(beginning + content)
            message = str(file)
            try:
                read_survey(file)
            except InputError as error:
                message = str(error)
            assert message.startswith(str(file))
            assert "\n" not in message

"""The survey file of the native FMU: read, and refused, as in Python."""

from math import degrees
from pathlib import Path

import pytest
from test_fmu_c_host import COMPILER

from boreprop.core.columns import read_columns
from boreprop.core.errors import TableError
from fmu_host import Instance
from native_fmu import refused

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")


def written(path: Path, content: bytes) -> str:
    path.write_bytes(content)
    return str(path)


@pytest.mark.parametrize(
    "content",
    [
        b"measured_depth,inclination_deg\n0,1\n4,2.5\n10,4\n",
        b"\xef\xbb\xbfmeasured_depth,inclination_deg\r\n0,1\r\n\r\n4,2.5\r\n10,4",
        b'name,inclination_deg,measured_depth\n"a, ""b""\n",1,0\nc,2.5,4\nd,+4e0,1.0e+1\n',
        b'\n inclination_deg ,"measured_depth"\n"1" , .0\n2.5," 4 "\n0.4e1,10.\n',
        b'"",\r\n , ,\r\nmeasured_depth,inclination_deg,remark\r\n,,\r\n0,1,\r\n"", ,\r\n4,2.5,x\r\n10,4,\r\n,,',
        b"measured_depth,inclination_deg\r0,1\r4,2.500000000000000000000000000000000000000000000000000001\r10,4\r",
    ],
)
def test_a_survey_file_is_read_as_in_python(one: Instance, tmp_path: Path, content: bytes) -> None:
    path = written(tmp_path / "vermessung ü.csv", content)
    assert read_columns(path, ("measured_depth", "inclination_deg")) == [(0.0, 4.0, 10.0), (1.0, 2.5, 4.0)]
    one.initialize(survey_file=path)
    row = one.row()
    assert degrees(row["bit_inclination"]) == pytest.approx(4.0, rel=1e-15)
    assert degrees(row["average_inclination[1]"]) == pytest.approx((4.0 + 4.0 - 3.66 * 0.25) / 2, rel=1e-12)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"depth,inclination\n1,2\n",
        b"measured_depth,inclination_deg\n2,0\n3\n",
        b"measured_depth,inclination_deg\n2,0\n\n3,1,2\n",
        b"measured_depth,inclination_deg\n2,steep\n",
        b"measured_depth,inclination_deg\n2,\n",
        b"measured_depth,inclination_deg\n2,nan\n",
        b"measured_depth,inclination_deg\n1e999,0\n",
        b'measured_depth,inclination_deg\n"1,5",0\n',
        b"measured_depth,inclination_deg\n0x10,0\n",
        b"measured_depth,inclination_deg\n,\n0,-999.25\n",
        b"measured_depth,inclination_deg\n0,180.00000001\n",
        b"measured_depth;inclination_deg\n0;1\n",
        b"measured_depth_ft,inclination_deg\n0,1\n",
        b"measured_depth,inclination_deg,\xb0\n0,1,2\n",
        b" ,,",
    ],
)
def test_a_bad_survey_file_is_refused_in_the_same_words(one: Instance, tmp_path: Path, content: bytes) -> None:
    path = written(tmp_path / "survey.csv", content)
    with pytest.raises(TableError) as expected:
        read_columns(path, ("measured_depth", "inclination_deg"))
    with refused(one, f"{expected.value} (survey_file)"):
        one.initialize(survey_file=path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"measured_depth,inclination_deg\n2,0\n1,0\n", "measured_depth: must increase, got (2.0, 1.0) (survey_file)"),
        (b"measured_depth,inclination_deg\n", "measured_depth: must hold at least one station, got () (survey_file)"),
        (bytes(range(256)), "must be a readable CSV file, got: bytes that are no UTF-8 text (survey_file)"),
        (b"measured_depth\0", "must be a readable CSV file, got: bytes that are no UTF-8 text (survey_file)"),
    ],
)
def test_a_survey_that_is_none_is_refused(one: Instance, tmp_path: Path, content: bytes, message: str) -> None:
    path = written(tmp_path / "survey.csv", content)
    with refused(one, f"{path}: {message}"):
        one.initialize(survey_file=path)


def test_a_file_that_cannot_be_read_is_refused(one: Instance, tmp_path: Path) -> None:
    for path, reason in ((tmp_path, "Is a directory"), (tmp_path / "missing", "No such file or directory")):
        with refused(one, f"{path}: must be a readable CSV file, got: {reason} (survey_file)"):
            one.initialize(survey_file=str(path))
        one.slave.reset()

"""The case of the native FMU, resources/case.txt: where it is found, and refused."""

import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from urllib.parse import quote

import pytest
from test_fmu_c_host import COMPILER

from boreprop.case.case import Case
from boreprop.core.system import BottomHoleAssembly
from boreprop_fmu.host.instance import read_description
from conftest import Pack
from flavours import LOGGED, NATIVE
from fmu_host import Instance, instance

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")

Start = Callable[[str | None], str]


@pytest.fixture
def folder(borehole: Path, tmp_path: Path) -> Path:
    """The FMU unpacked where the path needs escapes."""
    place = tmp_path / "Well #7 tü%41"
    with zipfile.ZipFile(borehole) as archive:
        archive.extractall(place)
    return place


@pytest.fixture
def start(one: Instance, capfd: pytest.CaptureFixture[str]) -> Start:
    """Instantiate at a URI: nothing, or the line that says why not."""

    def started(resources: str | None) -> str:
        slave = one.slave
        component, one.log[:] = slave.component, []
        uri = None if resources is None else resources.encode()
        made = slave.fmi2Instantiate(b"other", 1, slave.guid.encode(), uri, slave.callbacks, 0, 0)
        if made:
            slave.fmi2FreeInstance(made)
            assert one.log == []
            return ""
        [(level, category, line)] = one.log
        assert (level, category) == LOGGED["error"]
        assert component
        return line.replace("##", "#").replace("%%", "%")

    return started


def test_every_form_of_the_uri_of_a_folder_is_understood(start: Start, folder: Path) -> None:
    path = quote(str(folder / "resources"))
    assert all(escape in path for escape in ("%20", "%23", "%C3%BC", "%2541"))
    for uri in (f"file://{path}", f"file:{path}", f"file://localhost{path}", f"FILE://{path}/"):
        assert start(uri) == "", uri
    assert start(str(folder / "resources")) == ""  # from hosts that name it plainly


def test_a_folder_that_is_none_is_refused(start: Start, folder: Path) -> None:
    for uri in (None, "", "file:", "file:///a%4", "file:///a%zz", "file:///a%00b", "file:///%FF", "/" * 5000):
        assert start(uri).startswith("fmuResourceLocation: must be the URI of a folder, file:///…, got "), uri
    assert start("file:///nowhere") == "/nowhere/case.txt: must be a readable text file, got: No such file or directory"


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("guid ", "guid", "case.txt:1: must be 'guid' and a value, got 'guid"),
        ("guid ", "guid x", "case.txt:1: guid: must be a guid, got 'x"),
        ("quantities ", "quantities 0", "case.txt: quantities: must be "),
        ("stabilizers 2", "stabilizers 7", "case.txt:3: stabilizers: must be 1 to 6, got 7.0"),
        (
            "stabilizers 2",
            "stabilizers 1",
            "case.txt:17: must be 'rss_position' and a value, got 'stabilizer_position[2",
        ),
        ("stabilizers 2", "stabilizers 1.5", "case.txt:3: stabilizers: must be 1 to 6, got 1.5"),
        ("sections 0", "sections 25", "case.txt:4: sections: must be 0 to 24, got 25.0"),
        ("axial_load 0", "axial_load 2", "case.txt:5: axial_load: must be 0 to 1, got 2.0"),
        ("layered 0", "layered 2", "case.txt:7: layered: must be 0 to 1, got 2.0"),
        ("ground 0", "ground 9", "ground: must be as many numbers as layers have, got 9"),
        ("body_points 0", "body_points -1", "case.txt:6: body_points: must be 0 to 128, got -1.0"),
        ("sensors 0", "sensors 9", "case.txt:8: sensors: must be 0 to 8, got 9.0"),
        ("rss_position", "rss_place", "must be 'rss_position' and a value, got 'rss_place 0.6'"),
        ("space 0", "space 1", "case.txt:9: space: must be 0 to 0, got 1.0"),
        ("rss_force 0.0", "rss_force nan", "case.txt:10: rss_force: must be a finite number, got 'nan'"),
        ("rss_force 0.0", "rss_force 0,0", "case.txt:10: rss_force: must be a finite number, got '0,0'"),
        ("rss_force 0.0", "rss_force 1e999", "case.txt:10: rss_force: must be a finite number, got '1e999'"),
        ("rss_force 0.0\n", "", "case.txt:10: must be 'rss_force' and a value, got 'active_weight_on_bit "),
        ("bit_diameter ", "bit_diameter -", ": bit_diameter: must be > 0, got -0.2159"),
        ("stations ", "stations 99999999", ": stations: must be 1 to "),
        ("stations ", "stations 0*", ": stations: must be a finite number, got '0*"),
        ("measured_depth[2] ", "measured_depth[2] -", "measured_depth: must increase, got ("),
        (
            "inclination[1] ",
            "inclination[1] 0\ninclination[1] ",
            "must be 'inclination[2]' and a value, got 'inclination[1",
        ),
    ],
)
def test_a_line_that_is_not_as_packed_is_named(
    start: Start, folder: Path, before: str, after: str, message: str
) -> None:
    path = folder / "resources" / "case.txt"
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after, 1))
    assert message in start(str(path.parent))


def test_nothing_may_come_after_the_end_or_be_missing_there(start: Start, folder: Path) -> None:
    path = folder / "resources" / "case.txt"
    text = path.read_text()
    lines = text.splitlines()
    path.write_text(text + "rss_force 1.0\n")
    assert start(str(path.parent)) == f"{path}:{len(lines) + 1}: must be the end, got 'rss_force 1.0'"
    path.write_text("\n".join(lines[:-1]))
    name = lines[-1].split()[0]
    assert start(str(path.parent)) == f"{path}:{len(lines)}: must be '{name}' and a value, got ''"
    path.write_text("\r\n".join(lines))  # as an editor of Windows leaves it
    assert start(str(path.parent)) == ""


def test_the_case_of_another_fmu_is_refused(start: Start, case: Case, pack: Pack, tmp_path: Path) -> None:
    other = pack(replace(case, length=2 * case.length), NATIVE)
    with zipfile.ZipFile(other) as archive:
        archive.extractall(tmp_path)
    assert start(str(tmp_path / "resources")).startswith(f"fmuGUID: must be '{read_description(other).guid}', got '")


@pytest.mark.parametrize("n", [1, 3, 6])
def test_one_binary_serves_any_number_of_stabilizers(case: Case, pack: Pack, n: int) -> None:
    bha = BottomHoleAssembly(tuple(3.0 * i for i in range(1, n + 1)), (1e-3,) * (n - 1), 0.5, 1e3, 7e6)
    with instance(str(pack(replace(case, bha=bha), NATIVE))) as one:
        for variable in one.variables.values():
            if variable.start:
                assert one.get(variable.name) == float(variable.start), variable.name
        [row] = one.initialize().steps(1, 1.0)
        assert row["drilled_length"] == 1.0
        assert row["average_inclination[1]"] == pytest.approx(case.survey.inclination[-1], abs=0.05)

"""What an FMU says of itself and what it shows: checked against the standard's own schema, and by using it."""

import io
import os
import re
import struct
import subprocess
import sys
import zipfile
import zlib
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import fmpy
import pytest
from lxml import etree

from boreprop.case.case import Case
from boreprop.core.quantities import VARIABLES, scalar_names
from boreprop.core.system import BottomHoleAssembly
from flavours import Flavour, both_flavours, build_to_read

SCHEMA = Path(fmpy.__file__).parent / "schema" / "fmi2" / "fmi2ModelDescription.xsd"


@pytest.fixture(scope="module")
def archive(fmu: Path) -> dict[str, bytes]:
    return contents(fmu)


@pytest.fixture(scope="module")
def description(archive: dict[str, bytes]) -> Element:
    return fromstring(archive["modelDescription.xml"])


def contents(fmu: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(fmu) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@both_flavours
@pytest.mark.parametrize("n", [1, 2, 6])
def test_the_description_is_valid_against_the_schema_of_fmi_2(
    flavour: Flavour, case: Case, tmp_path: Path, n: int
) -> None:
    bha = BottomHoleAssembly(tuple(3.0 * i for i in range(1, n + 1)), (1e-3,) * (n - 1), 0.5, 1e3, 7e6)
    packed = contents(build_to_read(replace(case, bha=bha), tmp_path / "Borehole.fmu", flavour))
    schema = etree.XMLSchema(etree.parse(SCHEMA))
    schema.assertValid(etree.parse(io.BytesIO(packed["modelDescription.xml"])))


@both_flavours
def test_the_schema_is_one_that_can_fail(archive: dict[str, bytes]) -> None:
    schema = etree.XMLSchema(etree.parse(SCHEMA))
    wrong = archive["modelDescription.xml"].replace(b'causality="input"', b'causality="cause"')
    assert not schema.validate(etree.parse(io.BytesIO(wrong)))


@both_flavours
def test_every_real_says_how_large_it_usually_is_and_starts_within_a_thousand_times_that(description: Element) -> None:
    reals = description.findall("ModelVariables/ScalarVariable/Real")
    assert all(float(real.attrib["nominal"]) > 0 for real in reals)
    for real in reals:
        start, nominal = float(real.get("start", 0.0)), float(real.attrib["nominal"])
        assert abs(start) <= 1e3 * nominal
        assert start == 0 or abs(start) >= 1e-3 * nominal


@both_flavours
def test_angles_are_shown_in_degrees_and_curvature_in_degrees_per_30_m(description: Element) -> None:
    shown = {"rad": "deg", "rad/m": "deg/30m"}
    angular = [r for r in description.findall("ModelVariables/ScalarVariable/Real") if r.get("unit") in shown]
    assert len(angular) >= 6
    assert all(real.get("displayUnit") == shown[real.attrib["unit"]] for real in angular)


@both_flavours
def test_the_force_acts_at_once_on_the_hole_but_not_on_the_bit_axis(description: Element) -> None:
    names = [scalar.attrib["name"] for scalar in description.findall("ModelVariables/ScalarVariable")]
    depends = {
        names[int(unknown.attrib["index"]) - 1]: {names[int(i) - 1] for i in unknown.attrib["dependencies"].split()}
        for unknown in description.findall("ModelStructure/Outputs/Unknown")
    }
    assert all("rss_force" in depends[name] for name in ("borehole_inclination", "bit_tilt", "bit_lateral_force"))
    assert depends["bit_inclination"] == depends["drilled_length"] == set()


@both_flavours
def test_every_output_is_an_initial_unknown(description: Element) -> None:
    structure = [
        [unknown.get("index") for unknown in description.findall(f"ModelStructure/{part}/Unknown")]
        for part in ("Outputs", "InitialUnknowns")
    ]
    assert structure[0] == structure[1] != []


@both_flavours
def test_the_guid_names_code_and_case_and_nothing_else(flavour: Flavour, fmu: Path, case: Case, tmp_path: Path) -> None:
    def guid(which: Case) -> str:
        path = build_to_read(which, tmp_path / "other.fmu", flavour)
        return fromstring(contents(path)["modelDescription.xml"]).attrib["guid"]

    assert guid(case) == fromstring(contents(fmu)["modelDescription.xml"]).attrib["guid"]
    assert guid(replace(case, active_weight_on_bit=2 * case.active_weight_on_bit)) != guid(case)


@both_flavours
def test_the_clock_the_user_and_the_place_leave_no_trace(
    flavour: Flavour, case: Case, paper_case: Path, tmp_path: Path
) -> None:
    program = (
        "import sys, time; time.time = lambda: 2e9\n"
        "from pathlib import Path; from boreprop_fmu.pack.build import build_fmu; from boreprop import load_case\n"
        "build_fmu(load_case(Path(sys.argv[1])), Path('other name.fmu'), runtime=sys.argv[2], binaries=Path())"
    )
    environment = {"TZ": "Asia/Tokyo", "LC_ALL": "C", "PYTHONHASHSEED": "11", "USER": "somebody", "PYTHONUTF8": "0"}
    environment["PYTHONPATH"] = os.environ.get("PYTHONPATH", "")
    command = [sys.executable, "-X", "utf8=0", "-c", program, str(paper_case), flavour.runtime]
    subprocess.run(command, cwd=tmp_path, env=environment, check=True)
    expected = build_to_read(case, tmp_path / "Borehole.fmu", flavour)
    assert (tmp_path / "other name.fmu").read_bytes() == expected.read_bytes()


@both_flavours
def test_the_icon_is_a_small_png(archive: dict[str, bytes]) -> None:
    png = archive["model.png"]
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    assert len(png) < 10_000
    width, height = struct.unpack(">II", png[16:24])
    start = png.index(b"IDAT")
    pixels = zlib.decompress(png[start + 4 : start + 4 + struct.unpack(">I", png[start - 4 : start])[0]])
    assert len(pixels) == height * (1 + 3 * width)
    assert len(set(zip(*[iter(pixels)] * 3, strict=False))) > 4


class Page(HTMLParser):
    """First cells of table rows, and whether every tag that opens closes."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.cells: list[str] = []
        self.preformatted: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in ("meta", "img"):
            self.open.append(tag)
        if tag == "td":
            self.cells.append("")
        if tag == "pre":
            self.preformatted.append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open[-1:] == ["td"]:
            self.cells[-1] += data
        if self.open[-1:] == ["pre"]:
            self.preformatted[-1] += data


@pytest.fixture(scope="module")
def page(archive: dict[str, bytes]) -> Page:
    parser = Page()
    parser.feed(archive["documentation/index.html"].decode())
    assert parser.open == []
    return parser


@both_flavours
def test_the_documentation_lists_every_variable_with_its_symbol_and_meaning(page: Page) -> None:
    text = " ".join(page.cells)
    assert all(variable.meaning in text for variable in VARIABLES)
    assert all(variable.symbol in page.cells for variable in VARIABLES)
    assert set(re.findall(r"[a-z_]+(?:\[\d\])?", " ".join(page.cells[::6]))) == set(scalar_names(VARIABLES, 2))
    equations = page.preformatted[0]
    assert all(f"({number})" in equations for number in (5, 7, 8, 10, 16, 17, 18))


@both_flavours
def test_the_example_of_the_documentation_runs(fmu: Path, page: Page, tmp_path: Path) -> None:
    (tmp_path / "Borehole.fmu").write_bytes(fmu.read_bytes())
    done = subprocess.run(
        [sys.executable, "-c", page.preformatted[1]], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    time, length, _ = (float(value) for value in done.stdout.splitlines()[-1].strip("()").split(","))
    assert time == length == 30.0

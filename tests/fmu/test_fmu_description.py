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
from itertools import product
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import fmpy
import pytest
from lxml import etree

from boreprop.case.case import Case
from boreprop.case.parameters import parameters, with_parameters
from boreprop.core.drilling import Drilling
from boreprop.core.quantities import INPUTS, OUTPUTS, RELATIVE_TOLERANCE, VARIABLES, quantity_of, scalar_names
from boreprop.core.system import BottomHoleAssembly
from boreprop.errors import InputError
from flavours import PYTHON, Flavour, both_flavours, build_to_read
from forking import run_script
from places import ROOT

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


def dependencies(description: Element, part: str) -> dict[str, set[str]]:
    """What each unknown is said to depend on: "Outputs" while stepping, "InitialUnknowns" at the start."""
    names = [scalar.attrib["name"] for scalar in description.findall("ModelVariables/ScalarVariable")]
    unknowns = description.findall(f"ModelStructure/{part}/Unknown")
    for unknown in unknowns:
        kinds = unknown.attrib["dependenciesKind"].split()
        assert kinds == ["dependent"] * len(unknown.attrib["dependencies"].split())
    return {
        names[int(unknown.attrib["index"]) - 1]: {names[int(i) - 1] for i in unknown.attrib["dependencies"].split()}
        for unknown in unknowns
    }


def starting_outputs(case: Case, force: float) -> dict[str, float]:
    weight = case.active_weight_on_bit
    return Drilling(case.bha, case.bit, case.survey, active_weight_on_bit=weight, rss_force=force).outputs()


def followers(case: Case, force: float) -> dict[str, set[str]]:
    """Which outputs differ at the start where an input or a parameter does, by the name of that."""
    bent = replace(case.survey, inclination=tuple(x + 0.01 * x**2 for x in case.survey.inclination))
    other = {name: value + 1 if isinstance(value, int) else 1.01 * value for name, value in parameters(case).items()}
    changed = {name: (with_parameters(case, {name: value}), force) for name, value in other.items()}
    changed |= {"rss_force": (case, force + 100.0), "survey_file": (replace(case, survey=bent), force)}
    before = starting_outputs(case, force)
    return {
        name: {output for output, value in starting_outputs(*other).items() if value != before[output]}
        for name, other in changed.items()
    }


@both_flavours
def test_what_outputs_depend_on_at_the_start_is_what_differences_show(description: Element, case: Case) -> None:
    moved: dict[str, set[str]] = {}
    clearances, limits, forces = (2e-4, 0.2), (1.5, 1e-4), (100.0, 3e4)  # at the walls and the limit, or not
    for clearance, limit, force in product(clearances, limits, forces):
        values = {"stabilizer_clearance[1]": clearance, "bit_tilt_limit": limit}
        for name, outputs in followers(with_parameters(case, values), force).items():
            moved[name] = moved.get(name, set()) | outputs
    declared = dependencies(description, "InitialUnknowns")
    integers = {name for name in declared if quantity_of(name).kind == "Integer"}  # they may or may not switch
    for name, sources in declared.items():
        seen = {source for source, outputs in moved.items() if name in outputs}
        assert seen <= sources, name
        if name not in integers:
            assert {quantity_of(one).name for one in seen} == {quantity_of(one).name for one in sources}, name


@both_flavours
def test_while_stepping_outputs_depend_on_inputs_only_and_most_of_them_not_on_the_force(description: Element) -> None:
    stepping, start = dependencies(description, "Outputs"), dependencies(description, "InitialUnknowns")
    inputs = {quantity.name for quantity in INPUTS}
    assert stepping == {name: sources & inputs for name, sources in start.items()}
    assert list(stepping) == scalar_names(OUTPUTS, 2)
    # what a controller measures: a loop through these is not algebraic
    measured = ("drilled_length", "bit_inclination", "average_inclination[1]", "average_inclination[2]", "displacement")
    assert [stepping[name] for name in measured] == [set()] * len(measured)


@both_flavours
def test_the_tolerance_of_the_default_experiment_is_that_of_the_parameter(description: Element) -> None:
    experiment = description.find("DefaultExperiment")
    assert experiment is not None
    assert float(experiment.attrib["tolerance"]) == RELATIVE_TOLERANCE


@both_flavours
def test_it_says_who_made_it_under_which_license_and_carries_the_text(
    flavour: Flavour, description: Element, archive: dict[str, bytes]
) -> None:
    text = archive["documentation/licenses/license.txt"].decode()
    assert text == (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert description.attrib["license"] == "MIT"
    assert description.attrib["copyright"] in text
    assert description.attrib["author"] in description.attrib["copyright"]
    (other,) = [text for name, text in archive.items() if "/licenses/" in name and not name.endswith("/license.txt")]
    assert (b"NTNU" if flavour.runtime == "python" else b"Zig contributors") in other


@both_flavours
def test_a_date_comes_from_the_environment_only_and_is_no_part_of_the_guid(
    flavour: Flavour, case: Case, archive: dict[str, bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    dated = contents(build_to_read(case, tmp_path / "dated.fmu", flavour))["modelDescription.xml"]
    assert b'generationDateAndTime="2023-11-14T22:13:20Z"' in dated
    assert dated.replace(b' generationDateAndTime="2023-11-14T22:13:20Z"', b"") == archive["modelDescription.xml"]
    etree.XMLSchema(etree.parse(SCHEMA)).assertValid(etree.parse(io.BytesIO(dated)))
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    with pytest.raises(InputError, match="SOURCE_DATE_EPOCH: must be a whole number of seconds"):
        build_to_read(case, tmp_path / "never.fmu", flavour)


def test_what_the_host_must_have_is_what_the_binaries_ask_for(archive: dict[str, bytes]) -> None:
    text = archive["documentation/externalDependencies.txt"].decode()
    linux, windows = archive["binaries/linux64/Borehole.so"], archive["binaries/win64/Borehole.dll"]
    for library in (b"GLIBC_2.", b"GLIBCXX_3.4."):
        latest = max(int(number) for number in re.findall(re.escape(library) + rb"(\d+)", linux))
        assert f"{library.decode()}{latest}" in text
    libraries = set(re.findall(rb"\0((?:python|MSVCP|VCRUNTIME)\w+\.dll)\0", windows))
    assert len(libraries) == 4
    assert all(name.decode() in text for name in libraries)
    assert not re.search(rb"libpython\d", linux)  # so it must be there already
    assert "libpython" in text


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
def test_the_documentation_lists_every_variable_with_its_symbol_meaning_and_start(page: Page, case: Case) -> None:
    text, own = " ".join(page.cells), [variable for variable in VARIABLES if variable.count(2)]
    assert all(variable.meaning in text for variable in own)
    assert all(variable.symbol in page.cells for variable in own)
    assert str(case.bha.flexural_stiffness) in page.cells
    assert ", ".join(map(str, case.bha.stabilizer_positions)) in page.cells
    names = page.cells[page.cells.index(VARIABLES[0].name) :: 7]  # behind those of the table of what is left out
    assert set(re.findall(r"[a-z_]+(?:\[\d\])?", " ".join(names))) == set(scalar_names(VARIABLES, 2))
    equations = page.preformatted[0]
    assert all(f"({number})" in equations for number in (5, 7, 8, 10, 16, 17, 18))


@both_flavours
def test_the_documentation_allows_what_the_description_allows(page: Page, description: Element) -> None:
    [weight] = description.iterfind(".//ScalarVariable[@name='active_weight_on_bit']/Real")
    assert weight.attrib["min"] == "0.0"
    assert page.cells[page.cells.index("active_weight_on_bit") + 4] == "> 0, or 0 off bottom"


@both_flavours
def test_the_documentation_says_where_the_flavour_falls_short_of_the_standard(
    flavour: Flavour, archive: dict[str, bytes]
) -> None:
    text = archive["documentation/index.html"].decode()
    named = ("guid", "fmuResourceLocation", "fmi2FreeFMUstate", "SIGPIPE", "stepFinished", "--runtime native")
    assert all((name in text) == (flavour.runtime == "python") for name in named)


@both_flavours
def test_the_example_of_the_documentation_runs(flavour: Flavour, fmu: Path, page: Page, tmp_path: Path) -> None:
    (tmp_path / "Borehole.fmu").write_bytes(fmu.read_bytes())
    done = run_script(["-c", page.preformatted[1]], cwd=tmp_path)
    # pythonfmu 0.7.0 reads freed memory when the process ends, and where that lies badly glibc aborts it
    at_the_end = flavour == PYTHON and "corrupted double-linked list" in done.stderr
    assert done.returncode == 0 or at_the_end, done.stderr
    time, length, _ = (float(value) for value in done.stdout.splitlines()[-1].strip("()").split(","))
    assert time == length == 30.0

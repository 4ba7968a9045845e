"""The native FMU as a package: its description, sources and binaries."""

import subprocess
import zipfile
from collections import deque
from ctypes import CDLL
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import canonicalize, fromstring, tostring

import pytest
from test_fmu_c_host import COMPILER

from boreprop.case.case import Case
from boreprop.core.quantities import VARIABLES, scalar_names
from boreprop.core.system import BottomHoleAssembly
from boreprop.errors import InputError
from boreprop.kernel.compiler import host_platform
from boreprop_fmu.host.drive import drive
from boreprop_fmu.host.instance import open_instance, read_description
from boreprop_fmu.native.binaries import (
    NATIVE,
    PLATFORMS,
    binary_path,
    build_binaries,
    build_binary,
    digest,
    is_current,
)
from boreprop_fmu.pack.build import build_fmu
from conftest import Command, Pack
from flavours import PYTHON
from places import FMI_HEADERS

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")


def contents(fmu: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(fmu) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def stacked(n: int) -> BottomHoleAssembly:
    return BottomHoleAssembly(tuple(3.0 * i for i in range(1, n + 1)), (1e-3,) * (n - 1), 0.5, 1e3, 7e6)


def test_both_flavours_describe_themselves_alike(case: Case, pack: Pack, borehole: Path) -> None:
    roots = [fromstring(contents(path)["modelDescription.xml"]) for path in (pack(case, PYTHON), borehole)]
    with_derivatives = []
    for root in roots:
        del root.attrib["guid"]
        simulation = root.find("CoSimulation")
        assert simulation is not None
        names = ("canInterpolateInputs", "maxOutputDerivativeOrder", "providesDirectionalDerivative")
        with_derivatives.append([simulation.attrib.pop(name, None) for name in names])
        for files in simulation.findall("SourceFiles"):
            simulation.remove(files)
    assert with_derivatives == [["false", None, None], ["true", "1", "true"]]
    python, native = (canonicalize(tostring(root), strip_text=True) for root in roots)
    assert python == native


def test_the_table_is_in_the_order_that_the_c_code_counts_on() -> None:
    roles = [variable.role for variable in VARIABLES]
    assert roles == sorted(roles, key=("input", "output", "parameter").index)
    assert [variable for variable in VARIABLES if variable.kind == "String"] == [VARIABLES[-1]]
    assert VARIABLES[-1].name == "survey_file"
    whole = [variable for variable in VARIABLES if variable.kind == "Integer" and variable.role == "input"]
    assert {variable.size for variable in whole} == {"space"}


def unpacked(case: Case, folder: Path, name: str = "Borehole") -> Path:
    """The sources of its FMU."""
    fmu = build_fmu(case, folder / f"{name}.fmu", runtime="native", name=name, binaries=folder)
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder / name)
    return folder / name / "sources"


def test_the_sources_compile_without_a_warning_against_the_headers_of_an_importer(case: Case, tmp_path: Path) -> None:
    sources = unpacked(case, tmp_path)
    assert not list(sources.glob("fmi2*.h"))
    flags = ["-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", f"-I{FMI_HEADERS}"]
    subprocess.run([str(COMPILER), *flags, sources / "fmi2.c", "-lm", "-o", tmp_path / "Borehole.so"], check=True)


BOTH = """
#include <stdio.h>
const char *First_fmi2GetVersion(void), *Second_fmi2GetVersion(void);
int main(void) { printf("%s %s\\n", First_fmi2GetVersion(), Second_fmi2GetVersion()); }
"""


def test_two_fmus_link_into_one_program(case: Case, tmp_path: Path) -> None:
    (tmp_path / "both.c").write_text(BOTH)
    objects = []
    for name, which in (("First", case), ("Second", replace(case, bha=stacked(3)))):
        source = unpacked(which, tmp_path, name) / "fmi2.c"
        objects.append(tmp_path / f"{name}.o")
        subprocess.run([str(COMPILER), "-c", f"-I{NATIVE / 'importer'}", source, "-o", objects[-1]], check=True)
    subprocess.run([str(COMPILER), tmp_path / "both.c", *objects, "-lm", "-o", tmp_path / "both"], check=True)
    assert subprocess.run([tmp_path / "both"], check=True, capture_output=True, text=True).stdout == "2.0 2.0\n"


def test_a_shared_library_of_the_sources_has_the_plain_names(case: Case, tmp_path: Path) -> None:
    source, library = unpacked(case, tmp_path) / "fmi2.c", tmp_path / "plain.so"
    flags = ["-shared", "-fPIC", f"-I{NATIVE / 'importer'}", "-DFMI2_FUNCTION_PREFIX="]  # as the FMU's page has it
    subprocess.run([str(COMPILER), *flags, source, "-lm", "-o", library], check=True)
    assert CDLL(str(library)).fmi2GetVersion


def test_the_name_is_that_of_the_model_and_of_its_binaries(case: Case, binaries: Path, tmp_path: Path) -> None:
    fmu = build_fmu(case, tmp_path / "a.fmu", name="Well_7", binaries=binaries)
    description = read_description(fmu)
    assert description.coSimulation.modelIdentifier == "Well_7"
    assert drive(fmu, step=10.0, stop=20.0)["drilled_length"][-1] == 20.0
    with zipfile.ZipFile(fmu) as archive:
        page = archive.read("documentation/index.html").decode()
    assert "Well_7.so" in page
    assert "Well_7_fmi2DoStep" in page
    assert "Borehole." not in page


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"runtime": "java"}, "runtime: must be auto, native or python, got 'java'"),
        ({"name": "Well 7"}, "name: must be a letter, then letters, digits and _, at most 100, got 'Well 7'"),
        ({"name": "7"}, "name: must be a letter, "),
        ({"name": ""}, "name: must be a letter, "),
    ],
)
def test_a_flavour_and_a_name_that_cannot_be_are_refused(
    case: Case, tmp_path: Path, arguments: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        build_fmu(case, tmp_path / "Borehole.fmu", **arguments)
    assert list(tmp_path.iterdir()) == []


def is_native(fmu: Path) -> bool:
    return "resources/case.txt" in contents(fmu)


def test_it_is_native_where_there_is_a_binary_for_this_machine(case: Case, binaries: Path, tmp_path: Path) -> None:
    assert is_native(build_fmu(case, tmp_path / "a.fmu", binaries=binaries))
    assert not is_native(build_fmu(case, tmp_path / "b.fmu", binaries=tmp_path))


def test_a_binary_of_other_sources_is_refused(case: Case, binaries: Path, tmp_path: Path) -> None:
    path = binary_path(str(host_platform()), tmp_path)
    path.parent.mkdir()
    path.write_bytes(binary_path(str(host_platform()), binaries).read_bytes().replace(digest().encode(), b"0" * 16))
    with pytest.raises(InputError, match=r"got one of others; compile it again: python -m boreprop_fmu\.native"):
        build_fmu(case, tmp_path / "a.fmu", binaries=tmp_path)
    assert not (tmp_path / "a.fmu").exists()


def test_a_binary_that_is_asked_for_must_be_there(case: Case, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"got none; compile it: python -m boreprop_fmu\.native win64"):
        build_fmu(case, tmp_path / "a.fmu", platforms=["win64"], binaries=tmp_path)
    with pytest.raises(InputError, match=r"platform: must be one of linux64, .*, got 'win32'"):
        build_fmu(case, tmp_path / "a.fmu", platforms=["win32"], binaries=tmp_path)
    with pytest.raises(InputError, match="platforms: must be left out for the runtime python, got win64"):
        build_fmu(case, tmp_path / "a.fmu", runtime="python", platforms=["win64"])
    assert not list(tmp_path.iterdir())


def test_the_command_compiles_what_is_asked_for(
    command_here: Command, paper_case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("ziglang")
    monkeypatch.setattr(
        "boreprop_fmu.cli.build.BINARIES", tmp_path / "binaries"
    )  # others pack all that is in the usual one
    done = command_here("boreprop-fmu", "build", paper_case, "--platforms", "win64", "--output", "a.fmu")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith("MB, native: win64, C sources\n")
    assert [path for path in contents(tmp_path / "a.fmu") if path.startswith("binaries")] == [
        "binaries/win64/Borehole.dll"
    ]
    done = command_here("boreprop-fmu", "build", paper_case, "--platforms", "none", "--output", "b.fmu")
    assert done.stdout.endswith("MB, native: C sources\n")


def test_the_command_says_what_is_inside_and_what_is_not(binaries: Path, command: Any, paper_case: Path) -> None:
    done = command("boreprop-fmu", "build", paper_case, "--output", "Borehole.fmu", "--name", "Well")
    assert done.returncode == 0, done.stderr
    first, *more = done.stdout.splitlines()
    assert first.startswith("Borehole.fmu: 0.")
    assert " MB, native: " in first
    assert first.endswith(", C sources")
    inside = first.partition("native: ")[2].removesuffix(", C sources").split(", ")
    missing = more[0].removeprefix("not for ").partition(":")[0].split(", ") if more else []
    assert sorted(inside + missing) == sorted(PLATFORMS)


@pytest.mark.usefixtures("compiling_quickly")
def test_two_compilations_give_the_same_bytes(binaries: Path, tmp_path: Path) -> None:
    pytest.importorskip("ziglang")
    platform = str(host_platform())
    once, again = (build_binary(platform, tmp_path / name).read_bytes() for name in ("a", "b"))
    assert once == again


@pytest.mark.usefixtures("compiling_quickly")
def test_compiling_takes_away_what_is_of_other_sources(tmp_path: Path) -> None:
    stale = binary_path("win64", tmp_path)
    stale.parent.mkdir()
    stale.write_bytes(b"boreprop-fmu-sources-0123456789abcdef")
    made = list(build_binaries(folder=tmp_path))
    assert [path.stem for path in made] == ["Borehole", "BoreholeInSpace"]
    assert all(is_current(path.read_bytes()) for path in made)
    assert not stale.exists()


def test_a_folder_of_any_name_will_do(borehole: Path, command: Any, tmp_path: Path, monkeypatch: Any) -> None:
    (tmp_path / "tü %").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tü %"))
    done = command("boreprop-fmu", "run", borehole, "--output", "run.csv")
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(host_platform() != "linux64", reason="renames the binary for linux64")
def test_on_arm_the_binary_for_arm_is_run(borehole: Path, tmp_path: Path) -> None:
    moved = tmp_path / "Borehole.fmu"
    with zipfile.ZipFile(moved, "w") as archive:
        for name, content in contents(borehole).items():
            if not name.startswith("binaries") or "linux64" in name:
                archive.writestr(name.replace("linux64", "aarch64-linux"), content)
    with pytest.raises(InputError, match="must load on this machine, got: Cannot find shared library"):
        drive(moved, step=10.0)
    here = open_instance(moved, read_description(moved), deque(), start=0.0, stop=1.0, platform="aarch64-linux")
    with here as slave:
        slave.exitInitializationMode()
        slave.doStep(0.0, 1.0)
        [drilled] = slave.getReal([scalar_names(VARIABLES, 2).index("drilled_length")])
    assert drilled == 1.0

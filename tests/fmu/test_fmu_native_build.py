"""The native FMU as a package: its description, sources and binaries."""

import subprocess
import zipfile
from collections import deque
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import canonicalize, fromstring, tostring

import pytest
from fmpy.validation import validate_fmu
from test_fmu_c_host import COMPILER

from boreprop.case.case import Case
from boreprop.core.quantities import VARIABLES, scalar_names
from boreprop.core.system import BottomHoleAssembly
from boreprop.errors import InputError
from boreprop.kernel.compiler import host_platform
from boreprop_fmu.host.drive import drive
from boreprop_fmu.host.instance import open_instance, read_description
from boreprop_fmu.pack.build import build_fmu
from boreprop_fmu.pack.native import FMI_HEADERS
from conftest import Pack
from flavours import PYTHON

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")


def contents(fmu: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(fmu) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def stacked(n: int) -> BottomHoleAssembly:
    return BottomHoleAssembly(tuple(3.0 * i for i in range(1, n + 1)), (1e-3,) * (n - 1), 0.5, 1e3, 7e6)


def test_both_flavours_describe_themselves_alike(case: Case, pack: Pack, borehole: Path) -> None:
    roots = [fromstring(contents(path)["modelDescription.xml"]) for path in (pack(case, PYTHON), borehole)]
    interpolates = []
    for root in roots:
        del root.attrib["guid"]
        simulation = root.find("CoSimulation")
        assert simulation is not None
        interpolates.append(simulation.attrib.pop("canInterpolateInputs"))
        for files in simulation.findall("SourceFiles"):
            simulation.remove(files)
    assert interpolates == ["false", "true"]
    python, native = (canonicalize(tostring(root), strip_text=True) for root in roots)
    assert python == native


def test_the_table_is_in_the_order_that_the_c_code_counts_on() -> None:
    roles = [variable.role for variable in VARIABLES]
    assert roles == sorted(roles, key=("input", "output", "parameter").index)
    assert [variable.name for variable in VARIABLES if variable.kind == "String"] == ["survey_file"]
    assert not any(variable.kind == "Integer" and variable.role != "output" for variable in VARIABLES)


@pytest.mark.parametrize("n", [1, 2, 6])
def test_the_sources_are_valid_and_compile_without_a_warning(case: Case, tmp_path: Path, n: int) -> None:
    path = build_fmu(replace(case, bha=stacked(n)), tmp_path / "Borehole.fmu", runtime="native", platforms=())
    assert validate_fmu(str(path)) == []
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path)
    command = [
        str(COMPILER),
        "-Wall",
        "-Wextra",
        "-Werror",
        "-shared",
        "-fPIC",
        "-I",
        "sources",
        "sources/fmi2.c",
        "-lm",
    ]
    subprocess.run([*command, "-o", "Borehole.so"], cwd=tmp_path, check=True)


def test_the_headers_of_fmi_are_those_of_the_installed_package(borehole: Path) -> None:
    packed = contents(borehole)
    assert all(b"Modelica Association" in packed[f"sources/{name}"] for name in FMI_HEADERS)
    folder = Path(build_fmu.__code__.co_filename).parent
    assert not any(folder.rglob("fmi2Functions.h"))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"runtime": "java"}, "runtime: must be python or native, got 'java'"),
        ({"platforms": ["linux64"]}, "platforms: must be left out for the runtime python, got linux64"),
        ({"runtime": "native", "platforms": ["linux64", "amiga"]}, "platforms: must be among linux64, .*, got 'amiga'"),
        ({"compiler": "own"}, "compiler: must be left out for the runtime python, got 'own'"),
        ({"runtime": "native", "compiler": "gcc"}, "compiler: must be ziglang or own, got 'gcc'"),
        (
            {"runtime": "native", "compiler": "own", "platforms": ["win64"]},
            "platforms: must be left out for this machine's own compiler, got win64",
        ),
    ],
)
def test_a_flavour_that_there_is_not_is_refused(
    case: Case, tmp_path: Path, arguments: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        build_fmu(case, tmp_path / "Borehole.fmu", **arguments)
    assert list(tmp_path.iterdir()) == []


def test_the_command_says_what_is_inside(command: Any, paper_case: Path, tmp_path: Path) -> None:
    arguments = ["--output", "Borehole.fmu", "--runtime", "native", "--platforms", "none"]
    done = command("boreprop-fmu", "build", paper_case, *arguments)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("Borehole.fmu: 0.0")
    assert done.stdout.endswith(" MB, native: C sources\n")


def test_the_compiler_of_this_machine_may_be_asked_for(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CC", str(COMPILER))
    monkeypatch.setenv("CFLAGS", "-Dnext_character=compiled_here")
    build_fmu(case, tmp_path / "Borehole.fmu", runtime="native", compiler="own")
    binary = contents(tmp_path / "Borehole.fmu")[f"binaries/{host_platform()}/Borehole.so"]
    assert b"compiled_here" in binary


def test_a_compiler_that_fails_is_not_replaced_by_another(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("ziglang")
    (tmp_path / "taken").write_text("a file where zig wants a folder")
    monkeypatch.setenv("ZIG_GLOBAL_CACHE_DIR", str(tmp_path / "taken"))
    with pytest.raises(InputError, match=r"fmi2\.c: must compile with zig, got: "):
        build_fmu(case, tmp_path / "Borehole.fmu", runtime="native")
    assert [path.name for path in tmp_path.iterdir()] == ["taken"]


@pytest.mark.slow
def test_binaries_for_other_platforms_are_what_their_folders_say(case: Case, tmp_path: Path) -> None:
    pytest.importorskip("ziglang")
    done: list[float] = []
    machines = {"linux64": 0x3E, "aarch64-linux": 0xB7}  # e_machine of ELF
    fmu = tmp_path / "Borehole.fmu"
    build_fmu(case, fmu, runtime="native", platforms=list(machines), progress=done.append)
    for platform, machine in machines.items():
        binary = contents(fmu)[f"binaries/{platform}/Borehole.so"]
        assert (binary[:4], int.from_bytes(binary[18:20], "little")) == (b"\x7fELF", machine)
    assert done == [1, 2]


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
            archive.writestr(name.replace("linux64", "aarch64-linux"), content)
    with pytest.raises(InputError, match="must load on this machine, got: Cannot find shared library"):
        drive(moved, step=10.0)
    here = open_instance(moved, read_description(moved), deque(), start=0.0, stop=1.0, platform="aarch64-linux")
    with here as slave:
        slave.exitInitializationMode()
        slave.doStep(0.0, 1.0)
        [drilled] = slave.getReal([scalar_names(VARIABLES, 2).index("drilled_length")])
    assert drilled == 1.0

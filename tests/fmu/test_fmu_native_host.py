"""The native FMU in a host that is not Python: the paper's case, on this machine and on others, and the whole life."""

import os
import re
import shutil
import struct
import subprocess
import sys
import zipfile
from collections.abc import Callable, Mapping, Sequence
from itertools import accumulate
from pathlib import Path
from platform import machine
from tempfile import TemporaryFile
from xml.etree.ElementTree import fromstring

import numpy as np
import pytest
from test_fmu_c_host import COMPILER

from boreprop.case.case import Case
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.compiler import PLATFORMS, host_platform
from boreprop.run.simulate import simulate
from boreprop_fmu.native.binaries import build_binary
from boreprop_fmu.pack.build import build_fmu
from places import FMI_HEADERS, HOSTS
from reference_cases import CASES, reference

SOURCE = HOSTS / "native_host.c"
NAME = "fig7_psi_2deg"
STEP = 0.02  # ℓ₁ between the rows of the reference
COLUMNS = {
    "theta": "bit_inclination",
    "Theta": "borehole_inclination",
    "psi": "bit_tilt",
    "F_0": "bit_lateral_force",
    "F_1": "stabilizer_force[1]",
}
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wno-sign-conversion", "-Werror")
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g")
QEMU, ARM_SYSTEM = shutil.which("qemu-aarch64"), Path("/usr/aarch64-linux-gnu")
WINE = shutil.which("wine64") or shutil.which("wine") or shutil.which("wine64", path="/usr/lib/wine")

needs_compiler = pytest.mark.skipif(COMPILER is None or sys.platform == "win32", reason="no C compiler of a Unix")

Unpack = Callable[..., Path]
Rows = np.ndarray


@pytest.fixture(scope="module")
def paper() -> Case:
    """The reference case in SI units, with ℓ₁ = 1 m and F* = 1 N: then every number is the paper's."""
    p = CASES[NAME]
    return Case(
        bha=BottomHoleAssembly(tuple(accumulate(p["lambda"])), tuple(p["y_star"]), p["delta"], p["w"], 1 / 3),
        bit=BitRock(1.0, p["epsilon"], p["psi_star"]),
        bit_diameter=0.1,
        active_weight_on_bit=p["eta_pi"],
        length=p["length"],
        survey=Survey(tuple(xi - p["survey_xi"][0] for xi in p["survey_xi"]), tuple(p["survey_inc"])),
    )


@pytest.fixture(scope="module")
def unpack(paper: Case, tmp_path_factory: pytest.TempPathFactory) -> Unpack:
    """The folder of its FMU, with a binary for a platform; without one sources only."""

    def unpacked(*platforms: str) -> Path:
        folder = tmp_path_factory.mktemp("fmu")
        for platform in platforms:
            build_binary(platform, folder / "compiled")
        fmu = build_fmu(paper, folder / "a.fmu", runtime="native", binaries=folder / "compiled")
        with zipfile.ZipFile(fmu) as archive:
            archive.extractall(folder)
        return folder

    return unpacked


@pytest.fixture(scope="module")
def sources(unpack: Unpack) -> Path:
    """Its sources, and the description beside them."""
    return unpack() / "sources"


@pytest.fixture(scope="module")
def library(sources: Path) -> Path:
    """What the C compiler of this machine makes of them, told nothing."""
    return compiled(sources / "fmi2.c", sources / "Borehole.so", "-shared", "-fPIC", "-lm", f"-I{FMI_HEADERS}")


@pytest.fixture(scope="module")
def host(sources: Path) -> Path:
    return compiled(SOURCE, sources / "host", f"-I{FMI_HEADERS}", *WARNINGS, "-ldl")


def compiled(source: Path, output: Path, *flags: str) -> Path:
    subprocess.run([str(COMPILER), "-std=c99", source, "-o", output, *flags], check=True)
    return output


def zig(platform: str, *arguments: str | Path) -> None:
    command = [sys.executable, "-m", "ziglang", "cc", "-target", PLATFORMS[platform].target, "-O2", *arguments]
    subprocess.run(command, check=True, timeout=500)


def lead(
    folder: Path,
    command: Sequence[str | Path],
    library: Path,
    steps: int = 3000,
    root: str = "",
    environment: Mapping[str, str] = {},
) -> Rows:
    """Run the host, `command`, with the FMU of `folder`, whose path begins at the host's `root`: its rows."""
    description = fromstring((folder / "modelDescription.xml").read_bytes())
    reference_of = {v.attrib["name"]: v.attrib["valueReference"] for v in description.iter("ScalarVariable")}
    guid, references = description.attrib["guid"], [reference_of[name] for name in ("rss_force", *COLUMNS.values())]
    resources = f"file://{root}{folder / 'resources'}"
    with TemporaryFile("w+") as printed, TemporaryFile("w+") as said:  # wine's server would hold pipes open for long
        done = subprocess.run(
            [*command, library, guid, resources, str(steps), str(STEP), *references],
            env={**os.environ, **environment},
            stdout=printed,
            stderr=said,
            timeout=120,
        )
        printed.seek(0), said.seek(0)
        assert done.returncode == 0, said.read()
        return np.array([line.split() for line in printed], dtype=float)


@pytest.fixture(scope="module")
def rows(sources: Path, host: Path, library: Path) -> Rows:
    return lead(sources.parent, [host], library)


@needs_compiler
@pytest.mark.parametrize(
    ("column", "limit"), [("theta", 1e-5), ("F_0", 1e-5), ("F_1", 1e-5), ("psi", 5e-4), ("Theta", 5e-4)]
)
def test_the_papers_case_without_python_is_the_reference(rows: Rows, column: str, limit: float) -> None:
    expected = reference(NAME)[column]
    assert np.abs(rows[:, list(COLUMNS).index(column)] - expected).max() <= limit


@needs_compiler
def test_it_is_what_simulate_gives(rows: Rows, paper: Case) -> None:
    expected = simulate(paper, sample_interval=STEP)
    for column, name in enumerate(COLUMNS.values()):
        assert rows[:, column] == pytest.approx(np.array(expected[name]), rel=1e-9, abs=1e-11), name


@needs_compiler
def test_the_binary_in_it_gives_what_the_sources_in_it_give(rows: Rows, host: Path, unpack: Unpack) -> None:
    platform = host_platform()
    if platform is None:
        pytest.skip("no FMU has a binary for this machine")
    folder = unpack_or_skip(unpack, platform)
    binary = folder / "binaries" / platform / f"Borehole{PLATFORMS[platform].suffix}"
    assert lead(folder, [host], binary) == pytest.approx(rows, rel=1e-9, abs=1e-11)


@needs_compiler
@pytest.mark.skipif(machine() not in ("x86_64", "AMD64"), reason="no x87")
def test_a_processor_that_computes_with_more_digits_takes_its_own_states(rows: Rows, host: Path, sources: Path) -> None:
    flags = ("-shared", "-fPIC", "-O1", "-mfpmath=387", f"-I{FMI_HEADERS}", "-lm")
    try:
        library = compiled(sources / "fmi2.c", sources / "x87.so", *flags)
    except subprocess.CalledProcessError:
        pytest.skip("this compiler cannot be told to use the x87")
    assert lead(sources.parent, [host], library) == pytest.approx(rows, rel=1e-8, abs=1e-8)


def unpack_or_skip(unpack: Unpack, platform: str) -> Path:
    pytest.importorskip("ziglang")
    return unpack(platform)


@pytest.mark.slow
@pytest.mark.skipif(WINE is None, reason="no wine (apt-get install --no-install-recommends wine64)")
def test_on_windows_it_is_the_same(rows: Rows, unpack: Unpack, tmp_path: Path) -> None:
    folder, [own] = unpack_or_skip(unpack, "win64"), PLATFORMS["win64"].sources
    zig("win64", "-std=c99", f"-I{FMI_HEADERS}", "-c", SOURCE, "-o", tmp_path / "host.o")
    zig("win64", "-c", own, "-o", tmp_path / "own.o")
    links = ("-nostdlib", "-lucrtbase", "-lkernel32", "-s", "-e", "mainCRTStartup")
    zig("win64", tmp_path / "host.o", tmp_path / "own.o", "-o", tmp_path / "host.exe", *links)
    library = folder / "binaries" / "win64" / "Borehole.dll"
    quiet = {"WINEPREFIX": str(tmp_path / "wine"), "WINEDEBUG": "-all", "WINEDLLOVERRIDES": "mscoree,mshtml="}
    got = lead(folder, [str(WINE), tmp_path / "host.exe"], library, root="/Z:", environment=quiet)
    assert got == pytest.approx(rows, rel=1e-9, abs=1e-11)


@pytest.mark.slow
@pytest.mark.skipif(
    QEMU is None or not ARM_SYSTEM.exists(),
    reason="no qemu for Arm (apt-get install --no-install-recommends qemu-user libc6-arm64-cross)",
)
def test_on_arm_it_is_the_same(rows: Rows, unpack: Unpack, tmp_path: Path) -> None:
    folder = unpack_or_skip(unpack, "aarch64-linux")
    zig("aarch64-linux", "-std=c99", f"-I{FMI_HEADERS}", SOURCE, "-o", tmp_path / "host", "-ldl")
    library = folder / "binaries" / "aarch64-linux" / "Borehole.so"
    got = lead(folder, [str(QEMU), "-L", ARM_SYSTEM, tmp_path / "host"], library)
    assert got == pytest.approx(rows, rel=1e-9, abs=1e-11)


X86_64, ARM64 = 0x01000007, 0x0100000C


@pytest.mark.slow
@pytest.mark.usefixtures("compiling_quickly")
@pytest.mark.parametrize(("platform", "processors"), [("darwin64", [X86_64, ARM64]), ("aarch64-darwin", [ARM64])])
def test_for_a_mac_it_exports_fmi_to_either_processor(unpack: Unpack, platform: str, processors: list[int]) -> None:
    folder = unpack_or_skip(unpack, platform)
    header = (FMI_HEADERS / "fmi2Functions.h").read_text(encoding="utf-8")
    before, _, model_exchange = header.rpartition("Functions for FMI2 for Model Exchange")
    co_simulation = model_exchange[model_exchange.index("Functions for FMI2 for Co-Simulation") :]
    wanted = re.findall(r"FMI2_Export fmi2\w+TYPE +(fmi2\w+);", before + co_simulation)
    library = (folder / "binaries" / platform / "Borehole.dylib").read_bytes()
    for part, processor in zip(parts(library), processors, strict=True):
        exported = mach_exports(part, processor)
        assert {name for name in exported if not name.startswith("__")} == {f"_{name}" for name in wanted}


def parts(library: bytes) -> list[bytes]:
    """The libraries for one processor each that a universal one consists of, without a gap that could be smaller."""
    magic, count = struct.unpack_from(">2I", library)
    if magic != 0xCAFEBABE:
        return [library]
    found, end = [], 8 + 20 * count
    for k in range(count):
        *kind, offset, size, alignment = struct.unpack_from(">5I", library, 8 + 20 * k)
        assert alignment == 14, "the pages of Arm"
        assert offset == -(-end // 2**14) * 2**14
        assert kind == list(struct.unpack_from("<2I", library, offset + 4)), "as the part itself says"
        found.append(library[offset : offset + size])
        end = offset + size
    assert end == len(library)
    return found


def mach_exports(library: bytes, processor: int) -> set[str]:
    """Names of the symbols that a Mach-O library defines for others."""
    magic, machine, _, kind, commands = struct.unpack_from("<5I", library)
    assert (magic, machine, kind) == (0xFEEDFACF, processor, 6), "a 64-bit library"
    at, names = 32, set()
    for _ in range(commands):
        command, size = struct.unpack_from("<2I", library, at)
        if command == 2:  # LC_SYMTAB
            symbols, count, texts, _ = struct.unpack_from("<4I", library, at + 8)
            for k in range(count):
                name, flags, _, _, _ = struct.unpack_from("<IBBHQ", library, symbols + 16 * k)
                if flags & 0x01 and flags & 0x0E:  # external, defined
                    names.add(library[texts + name : library.index(b"\0", texts + name)].decode())
        at += size
    return names


@needs_compiler
@pytest.mark.slow
def test_valgrind_has_no_complaint(sources: Path, host: Path, library: Path) -> None:
    valgrind = shutil.which("valgrind")
    if valgrind is None:
        pytest.skip("no valgrind")
    checks = ["--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=all", "-q"]
    lead(sources.parent, [valgrind, *checks, host], library, steps=200)


@needs_compiler
@pytest.mark.slow
def test_sanitizers_have_no_complaint(sources: Path) -> None:
    try:
        sanitized = compiled(SOURCE, sources / "host_sanitized", f"-I{FMI_HEADERS}", *SANITIZERS, "-ldl")
    except subprocess.CalledProcessError:
        pytest.skip("this compiler has no sanitizers")
    library = compiled(
        sources / "fmi2.c", sources / "sanitized.so", "-shared", "-fPIC", *SANITIZERS, f"-I{FMI_HEADERS}", "-lm"
    )
    lead(sources.parent, [sanitized], library, steps=500)

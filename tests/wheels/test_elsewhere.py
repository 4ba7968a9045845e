"""The kernels in the wheels for other machines, in a host in C on an emulator: they drill as this machine does."""

import os
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import astuple
from pathlib import Path
from tempfile import TemporaryFile

import pytest

from boreprop.case.case import Case
from boreprop.core.options import Options
from boreprop.core.quantities import ACTING, scalar_names, values_of
from boreprop.kernel.compiler import PLATFORMS, library_path
from boreprop.kernel.generate import SYSTEM
from boreprop.run.engines import start
from places import HOSTS

QEMU, ARM_SYSTEM = shutil.which("qemu-aarch64"), Path("/usr/aarch64-linux-gnu")
WINE = shutil.which("wine64") or shutil.which("wine") or shutil.which("wine64", path="/usr/lib/wine")
SOURCE = HOSTS / "kernel_host.c"
LENGTH = 100.0  # m


def zig(platform: str, *arguments: str | Path) -> None:
    command = [sys.executable, "-m", "ziglang", "cc", "-target", PLATFORMS[platform].target, "-O2", *arguments]
    subprocess.run(command, check=True, timeout=500)


def kernel(archives: Path, platform: str, folder: Path) -> Path:
    """The kernel of a wheel, unpacked."""
    (wheel,) = archives.glob(f"*-{PLATFORMS[platform].tag}.whl")
    with zipfile.ZipFile(wheel) as archive:
        return Path(archive.extract(f"boreprop/kernel/{library_path(platform).name}", folder))


def drill(case: Case, command: Sequence[str | Path], environment: Mapping[str, str] = {}) -> list[float]:
    """The outputs where a case is after so many metres, as the host prints them."""
    options = Options()
    given = values_of("bha", case.bha) | values_of("bit", case.bit)
    given["relative_tolerance"] = options.relative_tolerance
    (force,) = case.schedule.rss_force
    given |= {"rss_force": force, "active_weight_on_bit": case.active_weight_on_bit}
    lists = (
        case.bha.structure,
        [given[name] for name in scalar_names(SYSTEM, case.bha.structure)],
        astuple(options),
        case.survey.measured_depth,
        case.survey.inclination,
        [0.0] * len(case.survey.inclination),
        [given.get(name, 0.0) for name in ACTING],
    )
    numbers = [LENGTH, *(number for values in lists for number in (len(values), *values))]
    with TemporaryFile("w+") as printed:  # wine's server would hold a pipe open for long
        words = [*command, *map(repr, map(float, numbers))]
        subprocess.run(words, env={**os.environ, **environment}, stdout=printed, timeout=120, check=True)
        printed.seek(0)
        return [float(line) for line in printed]


@pytest.fixture(scope="module")
def here(case: Case) -> list[float]:
    """The same from this machine, by the model in Python, which shares no code with the kernel."""
    drilling = start(case, "python", Options())
    drilling.advance(LENGTH, case.schedule.rss_force[0], case.active_weight_on_bit)
    return list(drilling.outputs().values())


@pytest.mark.skipif(WINE is None, reason="no wine (apt-get install --no-install-recommends wine64)")
def test_on_windows_it_drills_the_same(archives: Path, case: Case, here: list[float], tmp_path: Path) -> None:
    zig("win64", "-std=c99", "-c", SOURCE, "-o", tmp_path / "host.o")
    zig("win64", "-c", *PLATFORMS["win64"].sources, "-o", tmp_path / "own.o")
    links = ("-nostdlib", "-lucrtbase", "-lkernel32", "-s", "-e", "mainCRTStartup")
    zig("win64", tmp_path / "host.o", tmp_path / "own.o", "-o", tmp_path / "host.exe", *links)
    library = kernel(archives, "win64", tmp_path)
    quiet = {"WINEPREFIX": str(tmp_path / "wine"), "WINEDEBUG": "-all", "WINEDLLOVERRIDES": "mscoree,mshtml="}
    got = drill(case, [str(WINE), tmp_path / "host.exe", library], quiet)
    assert got == pytest.approx(here, rel=1e-9, abs=1e-11)


@pytest.mark.skipif(
    QEMU is None or not ARM_SYSTEM.exists(),
    reason="no qemu for Arm (apt-get install --no-install-recommends qemu-user libc6-arm64-cross)",
)
def test_on_arm_it_drills_the_same(archives: Path, case: Case, here: list[float], tmp_path: Path) -> None:
    zig("aarch64-linux", "-std=c99", SOURCE, "-o", tmp_path / "host", "-ldl")
    library = kernel(archives, "aarch64-linux", tmp_path)
    got = drill(case, [str(QEMU), "-L", ARM_SYSTEM, tmp_path / "host", library])
    assert got == pytest.approx(here, rel=1e-9, abs=1e-11)

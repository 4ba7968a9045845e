"""The native FMU under sanitizers: random lives of it, and the tests of its flavour.

$BOREPROP_FUZZ lives are led, 8 000 if it is not set; a million take some minutes:
BOREPROP_FUZZ=1000000 pytest tests/fmu/test_fmu_native_fuzz.py -k live
"""

import os
import re
import shlex
import subprocess
import sys
import zipfile
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from test_fmu_c_host import COMPILER

from boreprop.case.case import Case
from boreprop_fmu.pack.build import build_fmu
from places import FMI_HEADERS, HOSTS, TESTS

FOLDER = Path(__file__).parent
LIVES = int(os.environ.get("BOREPROP_FUZZ", "8000"))
SEED = 1
SANITIZERS = (
    "-fsanitize=address,undefined,float-cast-overflow",
    "-fno-sanitize-recover=all",
    "-g",
    "-O0",
)
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wno-sign-conversion", "-Werror")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux" or COMPILER is None, reason="no C compiler of Linux"),
]


@pytest.fixture(scope="module")
def asan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The library of the address sanitizer."""
    program = tmp_path_factory.mktemp("sanitizers") / "nothing"
    source = program.with_suffix(".c")
    source.write_text("int main(void) { return 0; }\n")
    if subprocess.run([str(COMPILER), *SANITIZERS, source, "-o", program], capture_output=True).returncode:
        pytest.skip("this compiler has no sanitizers")
    asked = [str(COMPILER), "-print-file-name=libasan.so"]
    return Path(subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip())


@pytest.fixture(scope="module")
def fuzzers(case: Case, asan: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Compile a fuzzer with the sources of FMUs, once; they are the same for all cases."""
    folder = unpacked(case, tmp_path_factory.mktemp("fuzzers"))

    @cache
    def compiled(name: str) -> Path:
        includes = [f"-I{folder / 'sources'}", f"-I{FMI_HEADERS}"]
        command = [str(COMPILER), "-std=c99", *SANITIZERS, *WARNINGS, *includes, str(HOSTS / f"{name}.c")]
        subprocess.run([*command, "-o", folder / name, "-lm"], check=True)
        return folder / name

    return compiled


def unpacked(case: Case, folder: Path) -> Path:
    """The folder of the case's FMU."""
    with zipfile.ZipFile(build_fmu(case, folder / "a.fmu", runtime="native", binaries=folder)) as archive:
        archive.extractall(folder)
    return folder


def fuzz(fuzzer: Path, case: Case, inputs: int, folder: Path) -> None:
    """Run a fuzzer on the case's FMU."""
    (folder / "spoilt").mkdir()
    done = subprocess.run([fuzzer, str(SEED), str(inputs), unpacked(case, folder)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-4000:]


@pytest.mark.parametrize("stabilizers", [2, 5])
def test_random_lives_of_an_instance_end_well(
    case: Case, stabilizers: int, fuzzers: Callable[[str], Path], tmp_path: Path
) -> None:
    positions = tuple(case.bha.stabilizer_positions[0] * i for i in range(1, stabilizers + 1))
    bha = replace(case.bha, stabilizer_positions=positions, stabilizer_clearances=(3e-3,) * (stabilizers - 1))
    if stabilizers > 2:
        instrument = {"sensor_positions": (5.0, 0.0), "sensor_intervals": (0.4, 0.0), "sensor_noises": (1e-3, 0.0)}
        bha = replace(bha, **instrument)  # type: ignore[arg-type]
    fuzz(fuzzers("fuzz_native"), replace(case, bha=bha), LIVES // 2, tmp_path)


def test_a_packed_case_that_was_spoilt_is_refused_or_can_be_lived_with(
    case: Case, fuzzers: Callable[[str], Path], tmp_path: Path
) -> None:
    fuzz(fuzzers("fuzz_case"), case, LIVES // 5, tmp_path)


def test_the_tests_of_the_native_flavour_pass_under_sanitizers(asan: Path) -> None:
    """Leaks apart, of which Python has some: those of the FMU the test above sees."""
    native = [f"native_{part}" for part in ("calls", "case", "ramps", "states", "survey")]
    files = ["test_fmu.py", "test_fmu_trust.py", *(f"test_fmu_{name}.py" for name in native)]
    others = "command or builds or leave or its_schedule"  # other processes, memory
    command = [sys.executable, "-m", "pytest", "-q", "-x", "--own-compiler", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [*command, "-k", f"native and not ({others})", *(FOLDER / name for name in files)],
        cwd=FOLDER,
        env={
            **{name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")},
            "CC": f"env -u LD_PRELOAD {COMPILER}",
            "CFLAGS": shlex.join(SANITIZERS),
            "LD_PRELOAD": str(asan),
            "ASAN_OPTIONS": "detect_leaks=0",
            "PYTHONPATH": os.pathsep.join([str(TESTS), str(HOSTS), os.environ.get("PYTHONPATH", "")]),
        },
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout
    [passed] = re.findall(r"(\d+) passed", done.stdout)
    assert int(passed) > 50, done.stdout

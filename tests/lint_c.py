"""The C of the project: formatted as .clang-format says, and without anything that .clang-tidy looks for.

python tests/lint_c.py [--fix]

With --fix the files are formatted first.
"""

import subprocess
import sys
import sysconfig
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from boreprop.case.paper import paper_case
from boreprop_fmu.pack.native import case_header
from places import ROOT

KERNEL, NATIVE = ROOT / "model" / "boreprop" / "kernel", ROOT / "fmu_build" / "boreprop_fmu" / "native"
HOSTS = ROOT / "tests" / "hosts"
FOLDERS = [KERNEL, NATIVE, HOSTS, ROOT / "benchmarks"]
# each with the headers that it includes; windows.c needs those of Windows
UNITS = [KERNEL / "library.c", NATIVE / "fmi2.c", *sorted(HOSTS.glob("*.c")), ROOT / "benchmarks" / "native_host.c"]
WARNINGS = ["all", "extra", "pedantic", "conversion", "shadow", "strict-prototypes", "missing-prototypes"]


def main() -> int:
    """The command."""
    files = sorted(path for folder in FOLDERS for path in folder.glob("*.[ch]"))
    style = ["-i"] if "--fix" in sys.argv[1:] else ["--dry-run", "-Werror"]
    failures = run("clang-format", *style, *files)
    with TemporaryDirectory() as folder:
        Path(folder, "case.h").write_bytes(case_header(paper_case(), guid=""))
        includes = [f"-I{path}" for path in (KERNEL, NATIVE, fmi_headers(), folder)]
        flags = ["-std=c99", *includes, *(f"-W{name}" for name in WARNINGS), '-DBOREPROP_SOURCES_DIGEST=""']
        for unit in UNITS:
            # the ways through a fuzzer are too many to follow; it is run with sanitizers instead
            checks = ["--checks=-clang-analyzer-*"] if unit.stem == "fuzz_native" else []
            failures += run("clang-tidy", "--quiet", *checks, unit, "--", *flags)
    return int(failures > 0)


def fmi_headers() -> Path:
    """The folder of the headers of FMI 2.0, which come with fmpy."""
    spec = find_spec("fmpy")
    assert spec
    assert spec.origin
    return Path(spec.origin).parent / "c-code"


def run(program: str, *words: str | Path) -> int:
    """Run a program of this environment; whether it failed."""
    done = subprocess.run(
        [Path(sysconfig.get_path("scripts"), program), *words], capture_output=True, text=True, check=False
    )
    if done.returncode:
        print(done.stdout + done.stderr)
    return int(done.returncode != 0)


if __name__ == "__main__":
    sys.exit(main())

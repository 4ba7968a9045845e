"""The C of the project: formatted as .clang-format says, and without anything that .clang-tidy looks for.

python tests/lint_c.py [--fix]

With --fix the files are formatted first.
"""

import subprocess
import sys
import sysconfig
from pathlib import Path

from places import FMI_HEADERS, HOSTS, ROOT

KERNEL, NATIVE = ROOT / "model" / "boreprop" / "kernel", ROOT / "fmu_build" / "boreprop_fmu" / "native"
FOLDERS = [KERNEL, NATIVE, NATIVE / "importer", HOSTS, ROOT / "benchmarks"]
# each with the headers that it includes; windows.c needs those of Windows
UNITS = [
    KERNEL / "library.c",
    KERNEL / "space.c",
    NATIVE / "fmi2.c",
    *sorted(HOSTS.glob("*.c")),
    ROOT / "benchmarks" / "native_host.c",
]
WARNINGS = ["all", "extra", "pedantic", "conversion", "shadow", "strict-prototypes", "missing-prototypes"]


def main() -> int:
    """The command."""
    files = sorted(path for folder in FOLDERS for path in folder.glob("*.[ch]"))
    style = ["-i"] if "--fix" in sys.argv[1:] else ["--dry-run", "-Werror"]
    failures = run("clang-format", *style, *files)
    includes = [f"-I{path}" for path in (KERNEL, NATIVE, FMI_HEADERS)]
    flags = ["-std=c99", *includes, *(f"-W{name}" for name in WARNINGS), '-DBOREPROP_SOURCES_DIGEST=""']
    for unit in UNITS:
        # the ways through a fuzzer are too many to follow; it is run with sanitizers instead
        checks = ["--checks=-clang-analyzer-*"] if unit.stem.startswith("fuzz_") else []
        failures += run("clang-tidy", "--quiet", *checks, unit, "--", *flags)
    return int(failures > 0)


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

"""Whole processes, start-up and writing included, by CPU time.

    python benchmarks/whole_process.py

The command `boreprop simulate` on the paper's case beside a bare RK4 script that does nothing else; `boreprop figures`
on the native engine beside the same on the Python engine, and what of it is importing.
"""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

HERE = Path(__file__).parent
PAIRS = 7
IMPORTS = "from pathlib import Path; from boreprop.report.figures import paper\n"
FIGURES = IMPORTS + "paper.make_figures(Path({folder!r}))"
IN_PYTHON = (
    "from functools import partial; from boreprop.report.figures import paper\n"
    "paper.simulate = partial(paper.simulate, engine='python')\n" + FIGURES
)


def seconds(*command: str | Path) -> float:
    """CPU time of a process and its children."""
    before = os.times()
    subprocess.run(command, check=True, capture_output=True)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def beside(*commands: tuple[str | Path, ...]) -> list[list[float]]:
    """CPU times of some commands, taken in turn; the first turn, which warms up, is left out."""
    turns = [[seconds(*command) for command in commands] for _ in range(PAIRS + 1)][1:]
    return [list(times) for times in zip(*turns, strict=True)]


def main() -> None:
    """Print medians and ratios, turn by turn."""
    boreprop = Path(sysconfig.get_path("scripts"), "boreprop")
    case = HERE.parent / "examples" / "paper_case.toml"
    with TemporaryDirectory() as folder:
        simulate = boreprop, "simulate", case, "--output", Path(folder, "run.csv")
        ours, rk4 = beside(simulate, (sys.executable, HERE / "rk4_two_stabilizers.py"))
        programs = [FIGURES.format(folder=folder), IN_PYTHON.format(folder=folder), IMPORTS]
        native, python, imports = beside(*((sys.executable, "-c", program) for program in programs))
    print(f"boreprop simulate {median(ours):.2f} s, RK4 script with h = 1/2000 {median(rk4):.2f} s", end=", ")
    print(f"ratio {median(a / b for a, b in zip(ours, rk4, strict=True)):.2f}; medians of {PAIRS} turns")
    print(f"the figures, native {median(native):.2f} s, Python {median(python):.2f} s", end=", ")
    ratio = median(a / b for a, b in zip(native, python, strict=True))
    print(f"ratio {ratio:.2f}; of either {median(imports):.2f} s are imports")


if __name__ == "__main__":
    main()

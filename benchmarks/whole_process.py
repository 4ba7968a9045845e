"""The whole process `boreprop simulate` on the paper's case, start-up and writing included, beside a bare RK4 script.

python benchmarks/whole_process.py
"""

import subprocess
import sys
import sysconfig
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

HERE = Path(__file__).parent
PAIRS = 7


def seconds(*command: str | Path) -> float:
    """Wall time of a process."""
    begin = perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return perf_counter() - begin


def main() -> None:
    """Print medians and their ratio, pair by pair."""
    boreprop = Path(sysconfig.get_path("scripts"), "boreprop")
    case = HERE.parent / "examples" / "paper_case.toml"
    with TemporaryDirectory() as folder:
        ours = boreprop, "simulate", case, "--output", Path(folder, "run.csv")
        rk4 = sys.executable, HERE / "rk4_two_stabilizers.py"
        pairs = [(seconds(*ours), seconds(*rk4)) for _ in range(PAIRS + 1)][1:]  # the first warms up
    mine, theirs = (median(times) for times in zip(*pairs, strict=True))
    print(f"boreprop simulate {mine:.2f} s, RK4 script with h = 1/2000 {theirs:.2f} s, medians of {PAIRS} pairs")
    print(f"ratio {median(a / b for a, b in pairs):.2f}")


if __name__ == "__main__":
    main()

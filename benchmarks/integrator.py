"""The integrator against fixed-step RK4, side by side in one run: error in Y, time, ratio.

    python benchmarks/integrator.py

RK4 is hard-coded for two stabilizers (rk4_two_stabilizers.py). Both are measured against the reference trajectories in
tests/reference. Times are the least of several runs taken in turn, ratios their median, pair by pair.
"""

import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np
from rich.console import Console
from rich.table import Table
from rk4_two_stabilizers import rk4

from boreprop.core.options import RELATIVE_TOLERANCE

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from reference_cases import CASES, at_the_bit, reference, start

PAIRS = 5
WANTED_ERROR = 1e-6
# relative tolerance of ours; RK4's steps per ℓ₁: the usual one, and the coarsest of these that reaches the wanted error
TOLERANCE = RELATIVE_TOLERANCE
GRIDS = {"fig7_psi_2deg": (2000, 16000), "fig8_clearance_2e-3": (2000, 1000)}


def ours(name: str) -> None:
    """Drill a reference case to its end."""
    start(name, TOLERANCE).advance(CASES[name]["length"])


def ours_error(name: str) -> float:
    """Largest error in Y over the rows of the reference."""
    model, rows = start(name, TOLERANCE), reference(name)
    errors: list[float] = []
    for row in rows:
        model.advance(float(row["xi"]))
        errors.append(abs(at_the_bit(model)["Y"] - row["Y"]))
    return max(errors)


def rk4_error(name: str, m: int) -> float:
    """Largest error in Y over the rows of the reference, with m steps per ℓ₁."""
    rows = reference(name)
    _, Y = rk4(CASES[name], m)
    return float(np.abs(np.array(Y)[np.rint(rows["xi"] * m).astype(int)] - rows["Y"]).max())


def seconds(function: Callable[..., object], *arguments: object) -> float:
    """CPU time of one call."""
    begin = process_time()
    function(*arguments)
    return process_time() - begin


def main() -> None:
    """Print a table."""
    table = Table("case", "method", "error in Y", "time (s)", "ours is faster by", title=f"{PAIRS} pairs")
    for name, grids in GRIDS.items():
        table.add_row(name, f"ours, tolerance {TOLERANCE:g}", f"{ours_error(name):.1e}", "", "")
        for m in grids:
            pairs = [(seconds(ours, name), seconds(rk4, CASES[name], m)) for _ in range(PAIRS)]
            mine, theirs = (min(times) for times in zip(*pairs, strict=True))
            ratio = median(b / a for a, b in pairs)
            table.add_row(
                "", f"RK4, h = 1/{m}", f"{rk4_error(name, m):.1e}", f"{mine:.4f} : {theirs:.3f}", f"{ratio:.1f}"
            )
    Console(width=110).print(table)


if __name__ == "__main__":
    main()

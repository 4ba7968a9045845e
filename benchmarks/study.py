"""What a study costs beside a bare loop of simulations, and what a second process gains; side by side in one run.

    python benchmarks/study.py [CASES]

Times of everything, the start of the processes and the Parquet file included; medians of pairs taken in turn. On a
machine that is busy with other things these pairs say little. So every simulation of a study is timed where it runs,
too: what the whole study takes beyond that is its cost, and how many simulations are under way on average is the gain
that idle cores would give.
"""

import os
import sys
from dataclasses import replace
from pathlib import Path
from resource import RUSAGE_CHILDREN, RUSAGE_SELF, getrusage
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter, process_time

import numpy as np

from boreprop.analysis.study.run import Study, grid, run, vary
from boreprop.case.case import Case
from boreprop.case.paper import LENGTH_SCALE, paper_case
from boreprop.run.simulate import simulate

CASES, PAIRS = 200, 5
LENGTH = 25 * LENGTH_SCALE  # m: some tenth of a second


def timed(case: Case) -> dict[str, float]:
    """Wall and CPU seconds of a simulation."""
    begin, cpu = perf_counter(), process_time()
    simulate(case)
    return {"wall": perf_counter() - begin, "cpu": process_time() - cpu}


def bare(study: Study) -> float:
    """Wall seconds of the simulations of a study and nothing else."""
    begin = perf_counter()
    for values in study.values.tolist():
        simulate(vary(study.case, dict(zip(study.names, values, strict=True))))
    return perf_counter() - begin


def whole(study: Study, workers: int) -> tuple[float, float, float]:
    """Wall seconds of a study with its file; its CPU seconds over those of its simulations; simulations under way."""
    begin, cpu = perf_counter(), cpu_time()
    with TemporaryDirectory() as folder:
        results = run(study, timed, output=Path(folder, "study.parquet"), workers=workers)
    wall, cpu = perf_counter() - begin, cpu_time() - cpu
    return wall, cpu / float(results["cpu"].sum()), float(results["wall"].sum()) / wall


def cpu_time() -> float:
    """Seconds that this process and those it started, which have ended, have computed."""
    usages = getrusage(RUSAGE_SELF), getrusage(RUSAGE_CHILDREN)
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def main() -> None:
    """Print each pair, and the medians."""
    cases = int(sys.argv[1]) if len(sys.argv) > 1 else CASES
    study = grid(replace(paper_case(), length=LENGTH), {"eta_pi": np.linspace(0.0095, 0.0105, cases)})
    pairs: list[tuple[float, ...]] = []
    for _ in range(PAIRS):
        loop, (one, cost, _), (two, _, under_way) = bare(study), whole(study, 1), whole(study, 2)
        pairs.append((one / loop, cost, one / two, under_way))
        print(
            f"{cases} cases: bare {1e3 * loop / cases:.0f} ms a case, study on one process {1e3 * one / cases:.0f},"
            f" on two {1e3 * two / cases:.0f}; load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
        )
    wall, cost, gain, under_way = (median(column) for column in zip(*pairs, strict=True))
    print(f"cost of a case, study over bare: × {wall:.3f}; CPU, study over its simulations: × {cost:.3f} (bar 1.10)")
    print(f"gain of a second process: × {gain:.2f}; simulations under way: {under_way:.2f} (bar 1.8)")


if __name__ == "__main__":
    main()

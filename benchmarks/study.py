"""What a case costs in a study beside its simulation alone, and what a second process gains; side by side in one run.

    python benchmarks/study.py [CASES]

First the bar: CPU time of a case in a study (native engine, one worker: parameters varied, simulated, summed up, kept)
over that of its simulation alone, the median of interleaved pairs. CPU time says this on a busy machine, too. Then wall
times of whole studies, the start of the processes and the Parquet file included, on one process, on two, and on two
threads: only where cores are idle do they say what a second one gains.
"""

import os
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter, thread_time

import numpy as np

from boreprop.analysis.study.compute import study
from boreprop.analysis.study.design import Study, grid, vary
from boreprop.analysis.study.figures import key_figures, outcome
from boreprop.analysis.study.table import Table
from boreprop.case.case import Case
from boreprop.case.paper import paper_case
from boreprop.run.simulate import simulate

CASES, PAIRS, ROUNDS = 1000, 300, 3
BAR = 1.5


def cases(count: int) -> Study:
    """Paper cases, as they come."""
    return grid(paper_case(), {"eta_pi": np.linspace(0.0095, 0.0105, count)})


def cpu(function: Callable[[], object]) -> float:
    """CPU seconds of a call."""
    begin = thread_time()
    function()
    return thread_time() - begin


def cost_of_a_case() -> tuple[float, float]:
    """CPU time of a case in a study over its simulation alone, and of that alone, s: medians."""
    all_of_them = cases(PAIRS)
    table = Table(all_of_them, key_figures, None)
    pairs = []
    for number, values in enumerate(all_of_them.values.tolist()):
        case: Case = vary(all_of_them.case, dict(zip(all_of_them.names, values, strict=True)))
        alone = cpu(lambda case=case: simulate(case, engine="native"))  # type: ignore[misc]

        def in_a_study(number: int = number, values: tuple[float, ...] = tuple(values)) -> None:
            table.add(number, outcome(key_figures, all_of_them.case, all_of_them.names, values))

        pairs.append((cpu(in_a_study) / alone, alone))
    ratios, times = zip(*pairs, strict=True)
    return median(ratios), median(times)


def whole(count: int, workers: int, threads: bool = False) -> float:
    """Wall seconds of a study with its file."""
    begin = perf_counter()
    with TemporaryDirectory() as folder:
        output = Path(folder, "study.parquet")
        if threads:
            with ThreadPoolExecutor(workers) as executor:
                study(cases(count), output=output, executor=executor)
        else:
            study(cases(count), output=output, workers=workers)
    return perf_counter() - begin


def main() -> None:
    """Print the cost, and the rounds."""
    ratio, alone = cost_of_a_case()
    print(f"a case in a study over its simulation alone ({1e3 * alone:.2f} ms): × {ratio:.2f} (bar {BAR})")
    count = int(sys.argv[1]) if len(sys.argv) > 1 else CASES
    for _ in range(ROUNDS):
        one, two, threads = whole(count, 1), whole(count, 2), whole(count, 2, threads=True)
        print(
            f"{count} cases: one process {1e3 * one / count:.1f} ms a case, two {1e3 * two / count:.1f}, two threads "
            f"{1e3 * threads / count:.1f}; load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
        )


if __name__ == "__main__":
    main()

"""What drawing costs, in the plane and in space: a long run into a file, and an FMU's run drawn while it is drilled or
sent by a loop, beside the same one bare.

python benchmarks/viewer_cost.py
"""

import os
import subprocess
import sys
import sysconfig
from dataclasses import replace
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np

LENGTH, INTERVAL = 3000.0, 0.1  # m: 30 001 rows
ROUNDS = 3
HOWS = ("bare", "record", "live")
CASES = Path(__file__).parents[1] / "examples"
# An FMU's run that is drilled as fast as it goes: bare, drawn by `record` while it is drilled, or sent from a loop to
# `live`. Prints rows per second to the end of all; bytes by which the process grows from a quarter of it on; and, of
# the thread of the loop, rows per second and microseconds a row spends in `send`. All seconds are of CPU time.
LIVE = """
import sys, psutil
from time import process_time, thread_time
from boreprop_fmu.host.drive import FmuRun
from boreprop_viz import live
from boreprop_viz.record import record

how, fmu, step, rrd = sys.argv[1], sys.argv[2], float(sys.argv[3]), sys.argv[4]
run, sizes, sending = FmuRun(fmu, step=step), [], 0.0
size = psutil.Process().memory_info
if how != "bare":  # imports and first uses
    record({"live": FmuRun(fmu, step=step, stop=1.0)}, save=rrd)
    with live(fmu, save=rrd) as view:
        for row in FmuRun(fmu, step=step, stop=1.0):
            view.send(**dict(zip(run.columns, row)))
begin, loop = process_time(), thread_time()
if how == "record":
    record({"live": run}, save=rrd, progress=lambda done: sizes.append((done, size().rss)))
elif how == "live":
    with live(fmu, save=rrd) as view:
        for row in run:
            values = dict(zip(run.columns, row))
            before = thread_time()
            view.send(**values)
            sending += thread_time() - before
        looped = thread_time() - loop
else:
    for row in run:
        dict(zip(run.columns, row))
seconds = process_time() - begin
if how != "live":
    looped = seconds
growth = sizes[-1][1] - next(size for done, size in sizes if done > len(run) / 4) if sizes else 0
print(len(run) / seconds, growth, len(run) / looped, 1e6 * sending / len(run))
"""


def main() -> None:
    """Print seconds and megabytes of the file, and the rows per second of the live runs, round by round."""
    from boreprop.case.file import load_case
    from boreprop.run.results import write_trajectory
    from boreprop.run.simulate import simulate
    from boreprop_fmu.pack.build import build_fmu

    with TemporaryDirectory() as name:
        folder = Path(name)
        for case_name in ("paper_case", "build_section", "spiral"):
            case = replace(load_case(CASES / f"{case_name}.toml"), length=LENGTH)
            write_trajectory(simulate(case, sample_interval=INTERVAL), folder / "run.csv")
            boreprop_view = Path(sysconfig.get_path("scripts"), "boreprop-view")
            begin, spent = perf_counter(), children_time()
            subprocess.run([boreprop_view, "run.csv", "--save", "run.rrd"], check=True, capture_output=True, cwd=folder)
            seconds, spent = perf_counter() - begin, children_time() - spent
            size = (folder / "run.rrd").stat().st_size / 1e6
            print(
                f"{case_name}, {LENGTH:g} m at {INTERVAL:g} m: {seconds:.1f} s (bar 10), {spent:.1f} s of CPU,"
                f" {size:.1f} MB (bar 60)"
            )

            fmu = build_fmu(replace(case, length=1000.0), folder / f"{case_name}.fmu")
            for step in (0.1, 0.01):
                rounds = [[drill(how, fmu, step, folder / "live.rrd") for how in HOWS] for _ in range(ROUNDS)]
                bare, drawn, sent = (np.array(one) for one in zip(*rounds, strict=True))  # shape (rounds, 4)
                alone = [median(1 / (1 / one[:, 0] - 1 / bare[:, 0])) for one in (drawn, sent)]
                print(
                    f"{case_name}, FMU, {1000 / step:.0f} rows: bare {median(bare[:, 0]):.0f} rows/s;"
                    f" record {median(drawn[:, 0]):.0f}, drawing alone {alone[0]:.0f} (bar 5000), grows by"
                    f" {drawn[:, 1].max() / 1e6:.0f} MB; live {median(sent[:, 0]):.0f}, drawing alone {alone[1]:.0f},"
                    f" its loop {median(sent[:, 2]):.0f}, send {median(sent[:, 3]):.1f} µs"
                )


def children_time() -> float:
    """CPU time of the processes that have been waited for, s."""
    spent = os.times()
    return spent.children_user + spent.children_system


def drill(how: str, fmu: Path, step: float, rrd: Path) -> list[float]:
    """What a process that runs an FMU prints, see `LIVE`."""
    command = [sys.executable, "-c", LIVE, how, str(fmu), str(step), str(rrd)]
    return [float(word) for word in subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()]


if __name__ == "__main__":
    main()

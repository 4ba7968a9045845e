"""What drawing costs: a long run into a file, and an FMU's run drawn while it is drilled beside the same one bare.

python benchmarks/viewer_cost.py
"""

import subprocess
import sys
import sysconfig
from dataclasses import replace
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

LENGTH, INTERVAL = 3000.0, 0.1  # m: 30 001 rows
PAIRS = 3
CASES = Path(__file__).parents[1] / "examples"
# rows per second of a run that is drilled as fast as it goes, and the growth of the process from a quarter of it on
LIVE = """
import sys, psutil
from time import perf_counter
from boreprop_fmu.host.drive import FmuRun
from boreprop_viz.record import record

fmu, step, rrd = sys.argv[1], float(sys.argv[2]), sys.argv[3]
run, sizes = FmuRun(fmu, step=step), []
size = psutil.Process().memory_info
if rrd:
    record({"live": FmuRun(fmu, step=step, stop=1.0)}, save=rrd)  # imports and first uses
    begin = perf_counter()
    record({"live": run}, save=rrd, progress=lambda done: sizes.append((done, size().rss)))
else:
    begin = perf_counter()
    for _ in run:
        pass
rate = run.row_count / (perf_counter() - begin)
print(rate, sizes[-1][1] - next(size for done, size in sizes if done > run.row_count / 4) if sizes else 0)
"""


def main() -> None:
    """Print seconds and megabytes of the file, and the samples per second of both live runs, pair by pair."""
    from boreprop.case.file import load_case
    from boreprop.run.results import write_trajectory
    from boreprop.run.simulate import simulate
    from boreprop_fmu.pack.build import build_fmu

    with TemporaryDirectory() as name:
        folder = Path(name)
        for case_name in ("paper_case", "build_section"):
            case = replace(load_case(CASES / f"{case_name}.toml"), length=LENGTH)
            write_trajectory(simulate(case, sample_interval=INTERVAL), folder / "run.csv")
            boreprop_view = Path(sysconfig.get_path("scripts"), "boreprop-view")
            begin = perf_counter()
            subprocess.run([boreprop_view, "run.csv", "--save", "run.rrd"], check=True, capture_output=True, cwd=folder)
            seconds, size = perf_counter() - begin, (folder / "run.rrd").stat().st_size / 1e6
            print(f"{case_name}, {LENGTH:g} m at {INTERVAL:g} m: {seconds:.1f} s (bar 10), {size:.1f} MB (bar 60)")

            fmu = build_fmu(replace(case, length=1000.0), folder / f"{case_name}.fmu")
            for step in (0.1, 0.01):
                pairs = [[live(fmu, step, rrd) for rrd in ("", str(folder / "live.rrd"))] for _ in range(PAIRS)]
                bare, drawn, alone = (
                    median(rates)
                    for rates in zip(*((a, b, 1 / (1 / b - 1 / a)) for (a, _), (b, _) in pairs), strict=True)
                )
                print(
                    f"{case_name}, FMU, {1000 / step:.0f} rows: bare {bare:.0f} rows/s, drawn {drawn:.0f}, drawing"
                    f" alone {alone:.0f} (bar 5000); grows by {max(grown for _, (_, grown) in pairs) / 1e6:.0f} MB"
                )


def live(fmu: Path, step: float, rrd: str) -> tuple[float, float]:
    """Samples per second and bytes of growth of a process that runs an FMU."""
    command = [sys.executable, "-c", LIVE, str(fmu), str(step), rrd]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    rate, growth = map(float, done.stdout.split())
    return rate, growth


if __name__ == "__main__":
    main()

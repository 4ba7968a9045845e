"""What the FMU of the paper's case costs through fmpy, beside two slaves that do nothing or next to it.

python benchmarks/fmu_cost.py
"""

import json
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

CASE = Path(__file__).parents[1] / "examples" / "paper_case.toml"
STEP = 3.66e-3  # s, at 1 m/s a thousandth of ℓ₁
STARTS, AGAIN, HELD, CHANGING, MANY = 5, 50, 20_000, 5_000, 1_000_000
SLAVE = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Real

class {name}(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.rss_force = self.y = 0.0
        self.register_variable(Real("rss_force", causality=Fmi2Causality.input))
        self.register_variable(Real("y", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        {body}
        return True
"""
BODIES = {"Empty": "pass", "Trivial": "self.y += step_size * (self.rss_force - self.y)"}
BARS = {
    "start": "≤ 3 × empty",
    "again": "≤ 3 × empty",
    "held": "≤ 30 on top of empty",
    "changing": "≤ 200 on top of empty",
    "growth": "≤ 1 MB",
}


def build(folder: Path) -> dict[str, Path]:
    """The three FMUs."""
    from boreprop.case.file import load_case
    from boreprop_fmu.pack.build import build_fmu

    fmus = {"Borehole": build_fmu(load_case(CASE), folder / "Borehole.fmu", runtime="python")}
    for name, body in BODIES.items():
        script = folder / f"{name.lower()}.py"
        script.write_text(SLAVE.format(name=name, body=body))
        command = [sys.executable, "-m", "pythonfmu", "build", "-f", str(script), "-d", str(folder)]
        subprocess.run(command, check=True, capture_output=True, cwd=folder)
        fmus[name] = folder / f"{name}.fmu"
    return fmus


def measure(fmu: str, what: str) -> dict[str, float]:
    """Times to start, ms; if `what` is "all" also µs a step with force held and changing, and growth of memory, MB."""
    with TemporaryDirectory() as directory:
        extract(fmu, directory)
        description = read_model_description(fmu)
        reference = {v.name: v.valueReference for v in description.modelVariables}
        begin = perf_counter()
        slave = FMU2Slave(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=directory,
            instanceName="cost",
        )
        slave.instantiate()
        initialize(slave)
        costs = {"start": 1e3 * (perf_counter() - begin)}
        begin = perf_counter()
        for _ in range(AGAIN):
            slave.fmi2FreeInstance(slave.component)
            slave.instantiate()
            initialize(slave)
        costs["again"] = 1e3 * (perf_counter() - begin) / AGAIN
        if what == "all":
            force = [reference["rss_force"]]
            costs["held"] = per_step(slave, HELD, STEP, nothing)
            costs["changing"] = per_step(slave, CHANGING, STEP, lambda k: slave.setReal(force, [float(k % 7)]))
            per_step(slave, HELD, STEP / 10, nothing)
            before = peak()
            per_step(slave, MANY, STEP / 10, nothing)
            costs["growth"] = peak() - before
        slave.fmi2FreeInstance(slave.component)
        slave.dll.finalizePythonInterpreter()  # at exit pythonfmu's library would drop its static state twice
        slave.freeLibrary()
    return costs


def initialize(slave: Any) -> None:
    """Into step mode at time 0."""
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()


def per_step(slave: Any, count: int, step: float, before_each: Callable[[int], None]) -> float:
    """Mean cost of a step from a new start on, µs."""
    slave.reset()
    initialize(slave)
    begin = perf_counter()
    for k in range(count):
        before_each(k)
        slave.doStep(k * step, step)
    return 1e6 * (perf_counter() - begin) / count


def nothing(_: int) -> None:
    """Leave the inputs as they are."""


def peak() -> float:
    """The most memory that this process ever had, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main() -> None:
    """Print the costs side by side."""
    from rich.console import Console
    from rich.table import Table

    def worker(fmu: Path, what: str) -> dict[str, float]:
        done = subprocess.run([sys.executable, __file__, fmu, what], check=True, capture_output=True, text=True)
        costs: dict[str, float] = json.loads(done.stdout)
        return costs

    with TemporaryDirectory() as folder:
        fmus = build(Path(folder))
        costs = {name: worker(fmu, "all") for name, fmu in fmus.items()}
        for name, fmu in fmus.items():
            starts = [worker(fmu, "start") for _ in range(STARTS)]
            costs[name] |= {key: median(start[key] for start in starts) for key in ("start", "again")}
    labels = {
        "start": "instantiate + initialize, ms",
        "again": "the same again in that process, ms",
        "held": "doStep of ℓ₁/1000, force held, µs",
        "changing": "setReal + doStep, force changing, µs",
        "growth": f"growth of memory over {MANY:,} steps, MB",
    }
    table = Table("", *fmus, "over empty", "bar")
    for key, label in labels.items():
        ours, empty = costs["Borehole"][key], costs["Empty"][key]
        over = f"× {ours / empty:.2f}" if "×" in BARS[key] else f"+ {ours - empty:.1f}"
        table.add_row(label, *(f"{costs[name][key]:.2f}" for name in fmus), over, BARS[key])
    Console(width=130).print(table)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(measure(*sys.argv[1:])))
    else:
        main()

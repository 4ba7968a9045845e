"""What the FMUs of the paper's case cost through fmpy, beside an empty slave and, if asked for, another version's FMUs.

python benchmarks/fmu_cost.py [CHECKOUT]    a checkout of the other version
"""

import json
import os
import resource
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

ROOT = Path(__file__).parents[1]
STEP = 3.66e-3  # s, at 1 m/s a thousandth of ℓ₁
ROUNDS, AGAIN, HELD, CHANGING = 5, 50, 20_000, 5_000
STEPS, RESETS, INSTANCES = 1_000_000, 1_000_000, 10_000  # over which memory must not grow
SLOW = 100  # a flavour on Python takes so many times fewer of them
EMPTY = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Real

class Empty(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.rss_force = 0.0
        self.register_variable(Real("rss_force", causality=Fmi2Causality.input))

    def do_step(self, current_time, step_size):
        return True
"""
LABELS = {
    "pack": "boreprop-fmu build, ms",
    "start": "instantiate + initialize, ms",
    "again": "the same again in that process, ms",
    "held": "doStep of ℓ₁/1000, force held, µs",
    "changing": "setReal + doStep, force changing, µs",
    "steps": f"growth of memory over {STEPS:,} steps, MB",
    "resets": f"over {RESETS:,} resets (Python: {RESETS // SLOW:,}), MB",
    "instances": f"over {INSTANCES:,} instances (Python: {INSTANCES // SLOW * 10:,}), MB",
}


def pack(checkout: Path, runtime: str, fmu: Path) -> float:
    """Pack an FMU by the command of a checkout; ms."""
    path = os.pathsep.join(str(checkout / folder) for folder in ("model", "fmu_build", "viz"))
    scripts = tomllib.loads((checkout / "pyproject.toml").read_text(encoding="utf-8"))["project"]["scripts"]
    module, _, function = scripts["boreprop-fmu"].partition(":")
    program = f"from {module} import {function} as main; main()"
    arguments = ["build", str(ROOT / "examples" / "paper_case.toml"), "--runtime", runtime, "--output", str(fmu)]
    begin = perf_counter()
    subprocess.run(
        [sys.executable, "-c", program, *arguments],
        check=True,
        capture_output=True,
        env={**os.environ, "PYTHONPATH": path},
    )
    return 1e3 * (perf_counter() - begin)


def pack_empty(fmu: Path) -> None:
    """An FMU of pythonfmu's that does nothing."""
    script = fmu.with_name("empty.py")
    script.write_text(EMPTY)
    command = [sys.executable, "-m", "pythonfmu", "build", "-f", str(script), "-d", str(fmu.parent)]
    subprocess.run(command, check=True, capture_output=True, cwd=fmu.parent)
    (fmu.parent / "Empty.fmu").rename(fmu)


def measure(fmu: str, what: str) -> dict[str, float]:
    """Times and growth of memory of one FMU; `what` is "times" or "memory"."""
    with TemporaryDirectory() as directory:
        extract(fmu, directory)
        description = read_model_description(fmu)
        begin = perf_counter()
        slave = FMU2Slave(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=directory,
            instanceName="cost",
        )
        slave.instantiate()
        initialize(slave)
        start = 1e3 * (perf_counter() - begin)
        on_python = hasattr(slave.dll, "finalizePythonInterpreter")
        if what == "times":
            force = [v.valueReference for v in description.modelVariables if v.name == "rss_force"]
            costs = {
                "start": start,
                "again": repeated(lambda: be_born_again(slave), AGAIN) / 1e3,
                "held": per_step(slave, HELD, STEP, nothing),
                "changing": per_step(slave, CHANGING, STEP, lambda k: slave.setReal(force, [float(k % 7)])),
            }
        else:
            costs = growth(slave, SLOW if on_python else 1)
        slave.fmi2FreeInstance(slave.component)
        if on_python:
            slave.dll.finalizePythonInterpreter()  # at exit pythonfmu's library would drop its static state twice
        slave.freeLibrary()
    return costs


def growth(slave: Any, fewer: int) -> dict[str, float]:
    """Growth of memory, MB, over steps, over resets and over instances."""

    def grown(action: Callable[[], object], count: int) -> float:
        repeated(action, count // 10)
        before = peak()
        repeated(action, count)
        return peak() - before

    return {
        "steps": grown(lambda: per_step(slave, STEPS // 10, STEP / 10, nothing), 10),
        "resets": grown(lambda: start_again(slave), RESETS // fewer),
        "instances": grown(lambda: be_born_again(slave), INSTANCES // max(fewer // 10, 1)),
    }


def initialize(slave: Any) -> None:
    """Into step mode at time 0."""
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()


def start_again(slave: Any) -> None:
    """Reset the instance."""
    slave.reset()
    initialize(slave)


def be_born_again(slave: Any) -> None:
    """Free the instance, and make another one."""
    slave.fmi2FreeInstance(slave.component)
    slave.instantiate()
    initialize(slave)


def repeated(action: Callable[[], object], count: int) -> float:
    """Mean time of an action, µs."""
    begin = perf_counter()
    for _ in range(count):
        action()
    return 1e6 * (perf_counter() - begin) / max(count, 1)


def per_step(slave: Any, count: int, step: float, before_each: Callable[[int], None]) -> float:
    """Mean cost of a step from a new start on, µs."""
    start_again(slave)
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


def worker(fmu: Path, what: str) -> dict[str, float]:
    """`measure` in a process of its own."""
    done = subprocess.run([sys.executable, __file__, fmu, what], check=True, capture_output=True, text=True)
    costs: dict[str, float] = json.loads(done.stdout)
    return costs


def main(*others: str) -> None:
    """Print the costs side by side."""
    from rich.console import Console
    from rich.table import Table

    checkouts = dict(zip(("", " there"), (ROOT, *map(Path, others)), strict=False))
    with TemporaryDirectory() as folder:
        fmus = {"empty": Path(folder, "empty.fmu")}
        pack_empty(fmus["empty"])
        rounds: dict[str, list[dict[str, float]]] = {"empty": []}
        for _ in range(ROUNDS):  # interleaved: a machine may be slower for a while
            for suffix, checkout in checkouts.items():
                for runtime in ("python", "native"):
                    name = runtime + suffix
                    fmus[name] = Path(folder, f"{name.replace(' ', '_')}.fmu")
                    rounds.setdefault(name, []).append({"pack": pack(checkout, runtime, fmus[name])})
            for name, fmu in fmus.items():
                rounds[name].append(worker(fmu, "times"))
        costs = {}
        for name, measured in rounds.items():
            of_key = {key: [one[key] for one in measured if key in one] for key in LABELS}
            costs[name] = {key: median(values) for key, values in of_key.items() if values} | worker(
                fmus[name], "memory"
            )
    table = Table("", *fmus)
    for key, label in LABELS.items():
        table.add_row(label, *(f"{costs[name][key]:.2f}" if key in costs[name] else "" for name in fmus))
    Console(width=130).print(table)


if __name__ == "__main__":
    if len(sys.argv) > 2:
        print(json.dumps(measure(*sys.argv[1:])))
    else:
        main(*sys.argv[1:])

"""The native kernel beside the Python core and JiTCDDE, its FMU in a C host, and a large study.

    python benchmarks/native.py [--full]

needs `pip install jitcdde` and a C compiler. All that is compared runs in turn, and ratios are medians, turn by turn.
Errors in Y are measured against the reference trajectory of the paper's rippling case. JiTCDDE's time is that of its
integration alone, without compiling (see jitcdde_two_stabilizers.py for how it is used); ours begins with the
parameters. The study is scaled up from a smaller one, or with --full done in full.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter, process_time

import numpy as np
from rich.console import Console
from rich.table import Table

from boreprop.analysis.study.compute import study
from boreprop.analysis.study.design import grid
from boreprop.analysis.study.figures import key_figures
from boreprop.case.case import Case
from boreprop.case.paper import LENGTH_SCALE, paper_case
from boreprop.core.drilling import Drilling
from boreprop.core.options import RELATIVE_TOLERANCE
from boreprop.kernel.binding import NativeDrilling

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from reference_cases import CASES, reference

NAME = "fig7_psi_2deg"  # paper_case() in the paper's numbers
TURNS = 25
HELD, CHANGING, START = 1.0, 5.0, 1000.0  # bars of the C host, µs
FULL_STUDY, PART_OF_STUDY, WORKERS, STUDY_BAR = 10_000, 500, 2, 120.0
OVER_JITCDDE, OVER_PYTHON = 10.0, 50.0

Engine = type[Drilling] | type[NativeDrilling]


def start(engine: Engine) -> Drilling | NativeDrilling:
    """The paper's rippling case before its first step."""
    case = paper_case()
    return engine(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)


def seconds(engine: Engine) -> float:
    """Time of one run over 60 ℓ₁, from the parameters on."""
    case = paper_case()
    begin = process_time()
    start(engine).advance(case.length, 0.0, case.active_weight_on_bit)
    return process_time() - begin


def error(engine: Engine) -> float:
    """Largest error in Y over the rows of the reference.

    Y is no output, but ⟨Θ⟩_1 is: Y(ξ) = Y(ξ−1) + ⟨Θ⟩_1(ξ), from the last ℓ₁ of the survey on, where Θ grows from 0.
    """
    case, rows = paper_case(), reference(NAME)
    drilling = start(engine)
    per_unit = round(1 / rows["xi"][1])
    Y = [case.survey.inclination[-1] * ((k / per_unit) ** 2 - 1) / 2 for k in range(per_unit)]
    for k, xi in enumerate(rows["xi"].tolist()):
        drilling.advance(xi * LENGTH_SCALE, 0.0, case.active_weight_on_bit)
        Y.append(Y[k] + drilling.outputs()["average_inclination[1]"])
    return float(np.abs(np.array(Y[per_unit:]) - rows["Y"]).max())


def engines() -> Table:
    """The rippling case by the native kernel, JiTCDDE and the Python core."""
    import jitcdde_two_stabilizers as opponent  # here: the workers of the study import this file, too

    case = CASES[NAME]
    dde = opponent.compiled(case)
    turns = [(seconds(NativeDrilling), opponent.seconds(dde, case), seconds(Drilling)) for _ in range(TURNS + 1)][
        1:
    ]  # the first warms up
    native, jit, python = (median(times) for times in zip(*turns, strict=True))
    table = Table("", "error in Y", "time (ms)", "native is faster by", "bar", title=f"{NAME}, 60 ℓ₁, {TURNS} turns")
    table.add_row(
        f"native kernel, tolerance {RELATIVE_TOLERANCE:g}", f"{error(NativeDrilling):.1e}", f"{1e3 * native:.2f}"
    )
    for k, name, wrong, time, bar in (
        (1, f"JiTCDDE, tolerance {opponent.TOLERANCE:g}", opponent.error(dde, reference(NAME)), jit, OVER_JITCDDE),
        (2, f"Python core, tolerance {RELATIVE_TOLERANCE:g}", error(Drilling), python, OVER_PYTHON),
    ):
        ratio = median(turn[k] / turn[0] for turn in turns)
        table.add_row(name, f"{wrong:.1e}", f"{1e3 * time:.2f}", f"{ratio:.1f}", f"≥ {bar:g}")
    return table


def host() -> Table:
    """What calls of the native FMU cost in a C host."""
    import fmpy

    from boreprop_fmu.pack.build import build_fmu

    compiler = shutil.which("cc") or shutil.which("gcc") or "cc"
    headers = Path(fmpy.__file__).parent / "c-code"
    with TemporaryDirectory() as directory:
        folder = Path(directory)
        fmu = build_fmu(paper_case(), folder / "Borehole.fmu", runtime="native")
        fmpy.extract(fmu, folder / "fmu")
        [library] = (folder / "fmu" / "binaries").rglob("Borehole.*")
        description = fmpy.read_model_description(fmu)
        reference_of = {variable.name: str(variable.valueReference) for variable in description.modelVariables}
        source = Path(__file__).with_name("native_host.c")
        subprocess.run([compiler, "-O2", "-I", headers, "-o", folder / "host", source, "-ldl"], check=True)
        command = [folder / "host", library, description.guid, (folder / "fmu" / "resources").as_uri()]
        command += [reference_of[name] for name in ("rss_force", "borehole_inclination", "drilled_length")]
        lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    cost = {what: float(ns) / 1e3 for what, ns in map(str.split, lines)}
    table = Table("", "µs", "bar", title="the native FMU in a C host, medians; steps of ℓ₁/1000")
    for what, label, bar in (
        ("held", "doStep, force held", f"≤ {HELD:g}"),
        ("read", "doStep and an output, force held", ""),
        ("changing", "a new force and doStep", f"≤ {CHANGING:g}"),
        ("both", "a new force, doStep and an output", ""),
        ("again", "instantiate and initialize", f"≤ {START:g}"),
        ("first", "load the library, instantiate, initialize", ""),
    ):
        table.add_row(label, f"{cost[what]:.3f}", bar)
    return table


def timed_figures(case: Case) -> dict[str, float]:
    """The key figures of a case, and the CPU seconds that they took."""
    begin = process_time()
    figures = key_figures(case)
    return figures | {"cpu": process_time() - begin}


def large_study(count: int) -> str:
    """A study of `count` paper cases of 60 ℓ₁ on two processes, their start and the Parquet file included."""
    cases = grid(paper_case(), {"eta_pi": np.linspace(0.0095, 0.0105, count)})
    arrivals: list[float] = []
    begin = perf_counter()
    with TemporaryDirectory() as folder:
        output = Path(folder, "study.parquet")
        results = study(
            cases, timed_figures, output=output, workers=WORKERS, on_result=lambda _: arrivals.append(perf_counter())
        )
    wall, first = perf_counter() - begin, arrivals[0] - begin
    text = f"study: {count:,} cases on {WORKERS} processes {wall:.1f} s, the first after {first:.1f} s"
    if count < FULL_STUDY:  # what comes after the first result grows with the number of cases
        text += f"; at this pace {FULL_STUDY:,} cases take {first + (wall - first) * FULL_STUDY / count:.0f} s"
    failed = int((results["error"] != "").sum())
    text += f" (bar {STUDY_BAR:g} s); {failed} failed; CPU {1e3 * float(results['cpu'].mean()):.1f} ms a case"
    return f"{text}; load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"


def main() -> None:
    """Print it all."""
    console = Console(width=110)
    console.print(engines())
    console.print(host())
    console.print(large_study(FULL_STUDY if "--full" in sys.argv[1:] else PART_OF_STUDY))


if __name__ == "__main__":
    main()

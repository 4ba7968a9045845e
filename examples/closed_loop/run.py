"""Run the closed loop: ``python run.py closed_loop.ssp --output closed_loop.csv``, on fmpy, libcosim or Ecos.

All three exchange values as Jacobi does: every FMU steps from the same communication point, with the outputs that the
others had there.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from enum import StrEnum
from importlib import import_module
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import numpy as np
import typer
from system import System

import boreprop_viz
from boreprop.case.case import Case
from boreprop.cli import console
from boreprop.cli.lazy import new_app
from boreprop.cli.options import positive
from boreprop.run.results import SUFFIXES, write_trajectory
from boreprop.run.trajectory import Trajectory

PLAN = Path(__file__).parents[1] / "build_section_plan.csv"

app = new_app("The closed loop of controller and borehole.")


class Importer(StrEnum):
    """What runs the FMUs."""

    fmpy = "fmpy"
    libcosim = "libcosim"
    ecos = "ecos"


@app.command()
def run(
    ssp: Annotated[Path, typer.Argument(metavar="SYSTEM.ssp", help="What make_ssp.py made.")],
    output: Annotated[Path, typer.Option(metavar="RUN.csv", help="The result file, .csv or .parquet.")],
    importer: Annotated[Importer, typer.Option(help="What runs the FMUs.")] = Importer.fmpy,
    half_weight_at: Annotated[
        float | None,
        typer.Option(parser=positive, metavar="M", help="Drilled length where the active weight on bit drops by half."),
    ] = None,
    view: Annotated[
        bool, typer.Option("--view", help="Show the run beside the plan in a new viewer as it goes.")
    ] = False,
    save: Annotated[
        Path | None, typer.Option(metavar="X.rrd", help="Record what --view shows, with a viewer or without.")
    ] = None,
) -> None:
    """Run the system over its default experiment; a row after each communication step."""
    console.check_output(output, SUFFIXES)
    with TemporaryDirectory() as directory:
        system = System(ssp, Path(directory))
        times = system.step * np.arange(system.count)  # at 1 m/s they are metres too
        weights = np.where(times < (half_weight_at or inf), 1.0, 0.5) * system.case.active_weight_on_bit
        names = ["time", *system.recorded]
        with viewed(system.case, view, save) as send, console.progress("drilling", system.count) as done:
            rows: list[list[float]] = []
            for row in import_module(f"on_{importer}").steps(system, weights.tolist()):
                rows.append([system.step * (len(rows) + 1), *row])
                send(**dict(zip(names, rows[-1], strict=True)))
                done(len(rows))
            run = Trajectory(dict(zip(names, np.array(rows).T, strict=True)), system.case)
            write_trajectory(run, output)
            print(f"{output}: {run.row_count} rows over {run['drilled_length'][-1]:g} m")


@contextmanager
def viewed(case: Case, view: bool, save: Path | None) -> Iterator[Callable[..., None]]:
    """Yield what takes the rows: the live view, or nothing if neither a viewer nor a recording is wanted."""
    if not view and save is None:
        yield lambda **_: None
        return
    with boreprop_viz.live(case, PLAN, name="closed loop", spawn=view, save=save) as live_view:
        yield live_view.send


if __name__ == "__main__":
    console.execute(app)

"""Run the closed loop: ``python run.py closed_loop.ssp --output closed_loop.csv``, on fmpy, libcosim or Ecos.

All three exchange values as Jacobi does: every FMU steps from the same communication point, with the outputs that the
others had there.
"""

from enum import StrEnum
from importlib import import_module
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import numpy as np
import typer
from system import System

from boreprop.cli import console
from boreprop.cli.lazy import new_app
from boreprop.cli.options import positive
from boreprop.run.results import SUFFIXES, write_trajectory
from boreprop.run.trajectory import Trajectory

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
) -> None:
    """Run the system over its default experiment; a row after each communication step."""
    console.check_output(output, SUFFIXES)
    with TemporaryDirectory() as directory:
        system = System(ssp, Path(directory))
        times = system.step * np.arange(system.count)  # at 1 m/s they are metres too
        weights = np.where(times < (half_weight_at or inf), 1.0, 0.5) * system.case.active_weight_on_bit
        with console.progress("drilling", system.count) as done:
            rows = []
            for row in import_module(f"on_{importer}").steps(system, weights.tolist()):
                rows.append(row)
                done(len(rows))
    columns = dict(zip(system.recorded, np.array(rows).T, strict=True))
    write_trajectory(Trajectory({"time": times + system.step, **columns}, system.case), output)
    print(f"{output}: {len(rows)} rows over {columns['drilled_length'][-1]:g} m")


if __name__ == "__main__":
    console.execute(app)

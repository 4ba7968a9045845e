"""The command `boreprop-fmu run`."""

from pathlib import Path
from typing import Annotated

import typer

from boreprop.case.packed import read_schedules_for
from boreprop.cli import console
from boreprop.cli.options import Tolerance, positive
from boreprop.cli.outputs import check_run_output
from boreprop.run.files import files_read
from boreprop.run.results import keeping_rows, write_trajectory

from ..host.drive import FmuRun


def run_command(
    fmu: Annotated[Path, typer.Argument(metavar="Borehole.fmu", help="An FMU with the variable names of boreprop.")],
    output: Annotated[Path, typer.Option(metavar="RUN.csv", help="The result file, .csv or .parquet.")],
    schedule: Annotated[
        Path | None,
        typer.Option(
            metavar="S.csv",
            help="Inputs over drilled length or measured depth, each constant up to the next entry. "
            "Default: those of the case packed in the FMU.",
        ),
    ] = None,
    step: Annotated[
        float | None,
        typer.Option(parser=positive, metavar="S", help="Communication step, s. Default: the FMU's own."),
    ] = None,
    stop: Annotated[
        float | None, typer.Option(parser=positive, metavar="T", help="Time at the end, s. Default: the FMU's own.")
    ] = None,
    tolerance: Tolerance = None,
) -> None:
    """Run an FMU and write the run to a file.

    To run an FMU is to run the code in it, with all your rights: run only those from people whom you trust.

    Its rows are at whole multiples of the communication step, from 0. If the FMU cannot go on to the end, the rows up
    to there are written, and the exit status is 3.
    """
    check_run_output(output, files_read(fmu, schedule))
    forces, inputs = (None, None) if schedule is None else read_schedules_for(fmu, schedule)
    fmu_run = FmuRun(fmu, forces, inputs, step=step, stop=stop, relative_tolerance=tolerance)
    try:
        with keeping_rows(output), console.progress("drilling", fmu_run.stop) as done:
            trajectory = fmu_run.trajectory(done)
    finally:
        if fmu_run.warning:
            console.warn(f"{fmu}: {fmu_run.warning}")
    write_trajectory(trajectory, output)
    print(f"{output}: {trajectory.row_count} rows over {trajectory['drilled_length'][-1]:g} m")

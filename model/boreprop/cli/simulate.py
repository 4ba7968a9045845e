"""The command `boreprop simulate`."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from ..case.file import load_case
from ..core.checks import check_number
from ..core.propagation import RELATIVE_TOLERANCE
from ..errors import InputError
from ..run import simulate as runs
from ..run.results import SUFFIXES, case_path, write_trajectory
from ..run.simulate import SAMPLE_INTERVAL
from ..run.trajectory import Stopped
from . import console
from .options import CaseFile, Engine, Tolerance, positive

MAX_ROWS = 10_000_000


def simulate(
    case_file: CaseFile,
    output: Annotated[Path, typer.Option(metavar="RUN.csv", help="The result file, .csv or .parquet.")],
    sample_interval: Annotated[
        float, typer.Option(parser=positive, metavar="M", help="Drilled length between rows, m.")
    ] = SAMPLE_INTERVAL,
    length: Annotated[
        float | None, typer.Option(parser=positive, metavar="M", help="Length to drill, m. Default: the case's.")
    ] = None,
    engine: Engine = "auto",
    tolerance: Tolerance = None,
) -> None:
    """Drill a case and write the run to a file.

    Rows are at k times the sample interval, k = 0, 1, … If the run cannot go on to its end, the rows so far are written
    all the same; the exit status is then 3.
    """
    console.check_output(output, SUFFIXES)
    if case_path(output).resolve() == case_file.resolve():
        raise InputError(f"{output}: must have another name, as its case would replace the case file, got {case_file}")
    case = load_case(case_file)
    if length is not None:
        case = replace(case, length=length)
    check_number("--sample-interval", sample_interval, at_least=case.length / MAX_ROWS)
    try:
        with console.progress("drilling", case.length) as drilled:
            run = runs.simulate(
                case,
                sample_interval=sample_interval,
                relative_tolerance=tolerance or RELATIVE_TOLERANCE,
                progress=drilled,
                engine=engine,
            )
    except Stopped as stopped:
        if stopped.trajectory is not None:
            write_trajectory(stopped.trajectory, output)
        raise
    write_trajectory(run, output)
    print(f"{output}: {run.rows} rows over {case.length:g} m, {run.engine} engine")

"""The command `boreprop simulate`."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from ..case.case import in_dimensions
from ..core.checks import check_number
from ..core.options import RELATIVE_TOLERANCE
from ..run.engines import ENGINES, chosen
from ..run.files import files_read
from ..run.results import keeping_rows, write_trajectory
from ..run.simulate import SAMPLE_INTERVAL, simulate
from . import console
from .cases import naming, open_case
from .fallback import warn_of_fallback
from .options import CaseFile, Tolerance, one_of, positive
from .outputs import check_run_output

MAX_ROWS = 10_000_000  # more would be a file of many gigabytes


def simulate_command(
    case_file: CaseFile,
    output: Annotated[Path, typer.Option(metavar="RUN.csv", help="The result file, .csv or .parquet.")],
    sample_interval: Annotated[
        float, typer.Option(parser=positive, metavar="M", help="Drilled length between rows, m.")
    ] = SAMPLE_INTERVAL,
    length: Annotated[
        float | None, typer.Option(parser=positive, metavar="M", help="Length to drill, m. Default: the case's.")
    ] = None,
    engine: Annotated[
        str,
        typer.Option(
            parser=one_of(*ENGINES),
            metavar="auto|native|python",
            help="The engine: native (compiled code), python (the same model in Python, many times slower), or auto "
            "(native if it is installed, else python).",
        ),
    ] = "auto",
    tolerance: Tolerance = None,
    dimensions: Annotated[
        int | None,
        typer.Option(
            min=2,
            max=3,
            metavar="2|3",
            help="3: drill in space, which a case does anyway that has an azimuth, a walk angle or a toolface other "
            "than 0 or 180.",
        ),
    ] = None,
) -> None:
    """Simulate a case and write the run to a file.

    Its rows are at whole multiples of the sample interval, from 0. If the run cannot go on to its end, the rows up to
    there are written, and the exit status is 3.
    """
    check_run_output(output, files_read(case_file))
    case = open_case(case_file, in_plane=False)
    if length is not None:
        case = replace(case, length=length)
    check_number("--sample-interval", sample_interval, at_least=case.length / MAX_ROWS)
    if dimensions is not None:
        case = in_dimensions(case, dimensions)
    if engine == "auto" and not case.in_space:
        warn_of_fallback()
    engine = chosen(engine, in_space=case.in_space)
    with naming(case_file), keeping_rows(output), console.progress("drilling", case.length) as drilled:
        trajectory = simulate(
            case,
            sample_interval=sample_interval,
            relative_tolerance=tolerance or RELATIVE_TOLERANCE,
            progress=drilled,
            engine=engine,
        )
    write_trajectory(trajectory, output)
    print(f"{output}: {trajectory.row_count} rows over {case.length:g} m ({trajectory.engine} engine)")

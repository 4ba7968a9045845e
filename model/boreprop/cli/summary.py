"""The command `boreprop summary`."""

from pathlib import Path
from typing import Annotated

import typer

from ..analysis.summary import summarize
from ..case.file import load_case
from ..errors import InputError
from ..report.tables.summary import lines
from ..run.results import read_trajectory
from .printing import print_table


def summary_command(
    run_file: Annotated[Path, typer.Argument(metavar="RUN.csv", help="A result file, .csv or .parquet.")],
    case_file: Annotated[
        Path | None,
        typer.Option("--case", metavar="CASE.toml", help="The case of the run. Default: the one stored with it."),
    ] = None,
) -> None:
    """Print a run in a dozen numbers, and whether it ripples."""
    trajectory = read_trajectory(run_file, load_case(case_file) if case_file else None)
    if trajectory.case is None:
        raise InputError(f"{run_file}: must come with its case, got none: give it with --case")
    if trajectory.row_count < 2:
        raise InputError(f"{run_file}: must have at least 2 rows, got {trajectory.row_count}")
    print_table(lines(summarize(trajectory)), (str(run_file), ""))

"""The command `boreprop summary`."""

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from ..analysis.summary import summarize
from ..case.file import load_case
from ..errors import InputError
from ..report.tables.summary import lines
from ..run.results import read_trajectory


def summary(
    run_file: Annotated[Path, typer.Argument(metavar="RUN.csv", help="A result file, .csv or .parquet.")],
    case_file: Annotated[
        Path | None, typer.Option("--case", metavar="CASE.toml", help="Its case, if it does not carry one.")
    ] = None,
) -> None:
    """Print a run in a dozen numbers."""
    run = read_trajectory(run_file, load_case(case_file) if case_file else None)
    if run.case is None:
        raise InputError(f"{run_file}: must carry its case, or be given one with --case, got neither")
    if run.rows < 2:
        raise InputError(f"{run_file}: must have at least 2 rows, got {run.rows}")
    table = Table(str(run_file), "")
    for line in lines(summarize(run)):
        table.add_row(*line)
    Console().print(table)

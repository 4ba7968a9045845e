"""The command `boreprop summary`."""

from pathlib import Path
from typing import Annotated

import typer

from ..analysis.plan import deviation_of, planned_hole, read_plan
from ..analysis.stations import list_stations
from ..analysis.summary import summarize
from ..case.file import load_case
from ..errors import InputError
from ..report.tables import stations as tables
from ..report.tables.summary import lines
from ..run.results import read_trajectory
from .options import positive
from .printing import print_table


def summary_command(
    run_file: Annotated[Path, typer.Argument(metavar="RUN.csv", help="A result file, .csv or .parquet.")],
    case_file: Annotated[
        Path | None,
        typer.Option("--case", metavar="CASE.toml", help="The case of the run. Default: the one stored with it."),
    ] = None,
    stations: Annotated[
        float | None,
        typer.Option(parser=positive, metavar="M", help="List the hole, too, at each M metres of measured depth."),
    ] = None,
    plan_file: Annotated[
        Path | None,
        typer.Option(
            "--plan",
            metavar="PLAN.csv",
            help="Say how far the hole is off this plan: columns measured_depth, inclination_deg.",
        ),
    ] = None,
) -> None:
    """Print a run in a dozen numbers, and whether it ripples."""
    trajectory = read_trajectory(run_file, load_case(case_file) if case_file else None)
    if trajectory.case is None:
        raise InputError(f"{run_file}: must come with its case, got none: give it with --case")
    if trajectory.row_count < 2:
        raise InputError(f"{run_file}: must have at least 2 rows, got {trajectory.row_count}")
    start = trajectory.case.survey.measured_depth[-1]
    plan = None if plan_file is None else planned_hole(read_plan(plan_file, start), start)
    summary = summarize(trajectory)
    over = summary.averaging_length
    off_plan = [] if plan is None else tables.plan_lines(trajectory, deviation_of(trajectory, plan, over))
    print_table([*lines(summary), *off_plan], (str(run_file), ""))
    if stations is not None:
        listed = list_stations(trajectory, stations, plan, averaged_over=over)
        print_table(tables.lines(listed), tables.headings(listed), caption=tables.caption(listed))

"""The command `boreprop summary`."""

from pathlib import Path
from typing import Annotated

import typer

from ..analysis.plan import read_plan
from ..analysis.plan_in_space import deviation_of, plan_of
from ..analysis.stations import list_stations
from ..analysis.summary import summarize
from ..report.tables import stations as tables
from ..report.tables.summary import lines
from ..run.completion import case_of
from .cases import RunCase, RunFile, open_run
from .options import AsJson, Units, positive
from .printing import plain, print_json, print_table


def summary_command(
    run_file: RunFile,
    case_file: RunCase = None,
    stations: Annotated[
        float | None,
        typer.Option(parser=positive, metavar="M", help="List the hole, too, at each M metres of measured depth."),
    ] = None,
    plan_file: Annotated[
        Path | None,
        typer.Option(
            "--plan",
            metavar="PLAN.csv",
            help="Say how far the hole is off this plan: columns measured_depth, inclination_deg and, for a run in "
            "space, azimuth_deg.",
        ),
    ] = None,
    as_json: AsJson = False,
    units: Units = "si",  # noqa: ARG001 - its callback has done it
) -> None:
    """Print a run in a dozen numbers, and whether it ripples."""
    trajectory = open_run(run_file, case_file)
    start = case_of(trajectory).survey.measured_depth[-1]
    plan = None if plan_file is None else plan_of(trajectory, read_plan(plan_file, start))
    summary = summarize(trajectory)
    over = summary.averaging_length
    off = None if plan is None else deviation_of(trajectory, plan, over)
    listed = None if stations is None else list_stations(trajectory, stations, plan, averaged_over=over)
    if as_json:
        off_plan = None if off is None else {name: column[-1] for name, column in plain(off).items()}
        print_json(plain(summary) | {"off_plan": off_plan, "stations": listed})
        return
    print_table([*lines(summary), *([] if off is None else tables.plan_lines(trajectory, off))], (str(run_file), ""))
    if listed is not None:
        print_table(tables.lines(listed), tables.headings(listed), caption=tables.caption(listed))

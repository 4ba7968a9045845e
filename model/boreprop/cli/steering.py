"""The command `boreprop steering`."""

from math import radians
from pathlib import Path
from typing import Annotated

import typer

from ..report.tables import steering_as_built as as_built
from ..report.tables.steering import SteeringSummary, headings, lines, piece_lines, summarize
from ..run.files import files_read
from . import console
from .cases import open_case
from .options import AsJson, CaseFile, Inclination, Units, positive
from .printing import print_json, print_table


def steering_command(
    case_file: CaseFile,
    output: Annotated[
        Path | None, typer.Option(metavar="STEERING.png", help="Draw build rate against force into this file.")
    ] = None,
    inclination_deg: Inclination = None,
    force_limit: Annotated[
        float | None,
        typer.Option(
            parser=positive,
            metavar="N",
            help="Largest force, N. Default: the largest of the case's schedule, or 30 kN if that has none.",
        ),
    ] = None,
    as_json: AsJson = False,
    units: Units = "si",  # noqa: ARG001 - its callback has done it
) -> None:
    """Print how fast a steady steering force turns the hole, and draw it."""
    if output is not None:
        console.check_output(output, (".png",), reads=files_read(case_file))
    case = open_case(case_file)
    inclination = None if inclination_deg is None else radians(inclination_deg)
    summary: SteeringSummary | as_built.SteeringAsBuilt
    if case.bha.structure.is_of_the_paper:
        summary = summarize(case, inclination, force_limit)
        about, table, heads = lines(summary), piece_lines(summary.curve), headings()
    else:
        summary = as_built.summarize_as_built(case, inclination, force_limit)
        about, table, heads = as_built.lines(summary), as_built.response_lines(summary), as_built.headings()
    if as_json:
        print_json(summary)
    else:
        print_table(about, (str(case_file), ""))
        print_table(table, heads)
    if output is not None:
        from ..report.figures.drawing import save  # imported here, since only a picture needs matplotlib
        from ..report.figures.steering import draw, draw_as_built

        save(draw(summary) if isinstance(summary, SteeringSummary) else draw_as_built(summary), output)
        if not as_json:
            print(f"{output}: build rate and bit tilt over the steering force")

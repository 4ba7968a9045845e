"""The command `boreprop compare`."""

from pathlib import Path
from typing import Annotated

import typer

from ..analysis.comparison import compare
from ..analysis.hole_in_space import is_in_space
from ..case.tables import read_survey
from ..errors import InputError
from ..report.tables.comparison import caption, headings, lines
from ..run.files import files_read
from . import console
from .cases import RunCase, RunFile, open_run
from .options import AsJson, Units
from .printing import plain, print_json, print_table


def compare_command(
    run_file: RunFile,
    survey_file: Annotated[
        Path,
        typer.Argument(
            metavar="SURVEY.csv",
            help="What was measured: columns measured_depth, inclination_deg and, for a run in space, azimuth_deg.",
        ),
    ],
    case_file: RunCase = None,
    output: Annotated[Path | None, typer.Option(metavar="PICTURE.png", help="Draw both into this file.")] = None,
    as_json: AsJson = False,
    units: Units = "si",  # noqa: ARG001 - its callback has done it
) -> None:
    """Print what a run predicts beside what a survey measured, and draw it."""
    if output is not None:
        console.check_output(output, (".png",), reads=files_read(run_file, survey_file, case_file))
    run, survey = open_run(run_file, case_file), read_survey(survey_file)
    if survey.turns and not is_in_space(run):
        what = "its azimuths are left out, since the run stays in a plane"
        console.warn(f"{survey_file}: {what}: drill it in space (hole.azimuth_deg) to compare them")
    try:
        found = compare(run, survey)
    except InputError as error:
        raise InputError(f"{survey_file}: {error}") from error
    if as_json:
        residuals = {"residual": found.residual, "azimuth_residual": found.azimuth_residual}
        print_json(plain(found) | residuals | {"root_mean_square": found.root_mean_square})
    else:
        print_table(lines(found), headings(found), title=f"{run_file} and {survey_file}", caption=caption(found))
    if output is not None:
        from ..report.figures.comparison import draw  # imported here, since only a picture needs matplotlib
        from ..report.figures.drawing import save

        save(draw(found), output)
        if not as_json:
            print(f"{output}: predicted and measured hole")

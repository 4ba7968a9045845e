"""The command `boreprop spiral`: what a vertical hole winds into."""

from math import radians
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from ..analysis.spiral.closed_form import HANDS, spiral
from ..analysis.spiral.transverse import transverse_growth
from ..analysis.spiral.walking import walk_chart
from ..errors import InputError
from ..report.tables.spiral import caption, heading, lines, ripple_line, title
from ..run.files import files_read
from ..units import UNITS
from . import console
from .cases import open_case
from .fallback import warn_of_fallback
from .options import AsJson, CaseFile, Units
from .printing import plain, print_json, print_table

WALKS = np.linspace(-radians(30.0), radians(30.0), 13)  # of a chart


def spiral_command(
    case_file: CaseFile,
    chart: Annotated[
        Path | None,
        typer.Option(metavar="CHART.png", help="Draw up to which ηΠ holes spiral, over the walk angle, to this file."),
    ] = None,
    ripple: Annotated[
        bool, typer.Option("--ripple", help="Drill a ripple in a plane, too, and say how fast it leaves the plane.")
    ] = False,
    as_json: AsJson = False,
    units: Units = "si",  # noqa: ARG001 - its callback has done it
) -> None:
    """Print the spiral into which a case drills a vertical hole, whether it lasts, and where it ends.

    The hole and the steering of the case have no part in it. If the bit walks ([bit] walk_angle_deg), the spirals to
    the right and to the left differ.
    """
    if chart is not None:
        console.check_output(chart, (".png",), reads=files_read(case_file))
    case = open_case(case_file, in_plane=False)
    if ripple and case.bit.walk_angle:
        walks = UNITS["rad"].text(case.bit.walk_angle, ".3g")
        raise InputError(
            f"--ripple: must be left out for a bit that walks, since it leaves any plane at once, got {walks}"
        )
    found = spiral(case)
    if ripple:
        warn_of_fallback()
    across = transverse_growth(case) if ripple else None
    other = spiral(case, HANDS[found.handedness == "right"]) if case.bit.walk_angle else None
    if as_json:
        print_json(plain(found) | {"other": other, "ripple": across})
    else:
        both = [found, other] if other else [found]
        print_table(lines(case, *both), (str(case_file), *map(heading, both)), title=title(case), caption=caption(case))
        if across:
            print(ripple_line(case, across))
    if chart is None:
        return
    from ..report.figures.drawing import save  # imported here, since only a picture needs matplotlib
    from ..report.figures.spiral import draw

    with console.progress("walk angles", 1.0) as done:
        limits = walk_chart(case, WALKS, done)
    save(draw(case, limits), chart)
    if not as_json:
        print(f"{chart}: up to which ηΠ holes spiral, over the walk angle of the bit")

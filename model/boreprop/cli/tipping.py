"""The commands `boreprop dogleg` and `boreprop hysteresis`."""

from math import radians
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from ..analysis import hysteresis as loops
from ..analysis.stability.contacts import first_that_touches
from ..analysis.tipping import critical_dogleg_or_why, dogleg_map, usual_map
from ..case.file import load_case
from ..core.propagation import RELATIVE_TOLERANCE
from ..errors import InputError
from ..report.tables.tipping import SIDES, left_out, lines, loop
from . import console
from .options import CaseFile, Tolerance, positive
from .ranges import parse_range


def dogleg(
    case_file: CaseFile,
    output: Annotated[Path | None, typer.Option(metavar="MAP.png", help="Draw a map into this file.")] = None,
    eta_pi: Annotated[
        str | None, typer.Option(metavar="A:B:N", help="The map's ηΠ: from, to, how many. Default: around the case's.")
    ] = None,
    clearance_mm: Annotated[
        str | None,
        typer.Option(metavar="A:B:N", help="Its clearances of the first stabilizer that can touch the wall, mm."),
    ] = None,
    limit_deg: Annotated[
        float, typer.Option(parser=positive, metavar="A", help="Largest turn that is tried, degrees.")
    ] = 10.0,
    tolerance: Tolerance = None,
) -> None:
    """Print the smallest kink in the existing hole that starts rippling.

    The hole is straight and turns over half the length of the BHA before the bit. With --output also a map of it over
    weight and clearance.
    """
    if output is not None:
        console.check_output(output, (".png",))
    across = parse_range("--eta-pi", eta_pi) if eta_pi else None
    up = parse_range("--clearance-mm", clearance_mm) / 1e3 if clearance_mm else None
    case, limit = load_case(case_file), radians(limit_deg)
    relative_tolerance = tolerance or RELATIVE_TOLERANCE
    found = {
        side: critical_dogleg_or_why(case, side=side, limit=limit, relative_tolerance=relative_tolerance)
        for side in SIDES
    }
    table = Table(str(case_file), "")
    for line in lines(case, found, limit):
        table.add_row(*line)
    Console().print(table)
    if output is not None:
        from ..report.figures.drawing import save  # here: matplotlib takes long to load
        from ..report.figures.tipping import draw_map

        usual = usual_map(case)
        across, up = usual[0] if across is None else across, usual[1] if up is None else up
        with console.progress("doglegs", len(across) * len(up)) as done:
            found_map = dogleg_map(case, across, up, limit=limit, relative_tolerance=relative_tolerance, progress=done)
        save(draw_map(case, found_map, limit), output)
        print(f"{output}: the smallest dogleg that tips it over, by weight and clearance{left_out(found_map)}")


def hysteresis(
    case_file: CaseFile,
    output: Annotated[Path, typer.Option(metavar="LOOP.png", help="The picture.")],
    eta_pi: Annotated[
        str | None, typer.Option(metavar="A:B:N", help="Change the weight: ηΠ from, to, how many.")
    ] = None,
    clearance_mm: Annotated[
        str | None,
        typer.Option(
            metavar="A:B:N", help="Change the clearance of the first stabilizer that can touch the wall instead, mm."
        ),
    ] = None,
    dogleg_deg: Annotated[
        float,
        typer.Option(
            parser=positive, metavar="A", help="Turn of straight holes over half the BHA before the bit, degrees."
        ),
    ] = 0.5,
    tolerance: Tolerance = None,
) -> None:
    """Draw where a ripple dies out, and where it comes back.

    An ongoing ripple meets more and more weight or clearance until it is gone; then straight holes with a dogleg meet
    less and less, until one ripples again.
    """
    console.check_output(output, (".png",))
    if (eta_pi is None) == (clearance_mm is None):
        raise InputError(f"must be given one of --eta-pi and --clearance-mm, got {'both' if eta_pi else 'neither'}")
    case = load_case(case_file)
    if eta_pi is not None:
        name, values = "eta_pi", parse_range("--eta-pi", eta_pi).tolist()
    else:
        name = f"stabilizer_clearance[{first_that_touches(case)}]"
        values = (parse_range("--clearance-mm", clearance_mm or "") / 1e3).tolist()
    with console.progress("values", 2 * len(values)) as done:
        found = loops.hysteresis(
            case, name, values, radians(dogleg_deg), relative_tolerance=tolerance or RELATIVE_TOLERANCE, progress=done
        )
    from ..report.figures.drawing import save  # here: matplotlib takes long to load
    from ..report.figures.tipping import draw_loop

    save(draw_loop(case, found), output)
    print(f"{output}: {loop(case, found)}")

"""The commands `boreprop dogleg` and `boreprop hysteresis`: what starts and what ends a ripple."""

from math import radians
from pathlib import Path
from typing import Annotated

import typer

from ..analysis.hysteresis import hysteresis
from ..analysis.stability.contacts import first_that_touches
from ..analysis.tipping import critical_dogleg_or_why, dogleg_map, usual_map
from ..arrays import Floats
from ..case.case import Case
from ..core.options import RELATIVE_TOLERANCE
from ..errors import InputError
from ..report.tables.hysteresis import loop
from ..report.tables.tipping import SIDES, left_out, lines
from ..run.files import files_read
from . import console
from .cases import open_case
from .fallback import warn_of_fallback
from .options import AsJson, CaseFile, ClearanceRange, EtaPiRange, Tolerance, Units, check_asked, turn
from .printing import print_json, print_table
from .ranges import parse_range


def dogleg_command(
    case_file: CaseFile,
    output: Annotated[
        Path | None, typer.Option(metavar="MAP.png", help="Draw a map over weight and clearance to this file.")
    ] = None,
    eta_pi: EtaPiRange = None,
    clearance_mm: ClearanceRange = None,
    limit_deg: Annotated[
        float, typer.Option(parser=turn, metavar="A", help="Largest turn that is tried, degrees.")
    ] = 10.0,
    tolerance: Tolerance = None,
    as_json: AsJson = False,
    units: Units = "si",  # noqa: ARG001 - its callback has done it
) -> None:
    """Print the smallest kink in the existing hole that starts rippling, and map it.

    The hole is straight, then turns over half the length of the BHA before the bit. A straight inclined hole may ripple
    by itself, if the BHA drops with a stabilizer on the wall. The map is over weight, as ηΠ, and clearance. Without
    --eta-pi or --clearance-mm, the values include those of the case.
    """
    if output is not None:
        console.check_output(output, (".png",), reads=files_read(case_file))
    across = parse_range("--eta-pi", eta_pi) if eta_pi else None
    up = parse_range("--clearance-mm", clearance_mm) / 1e3 if clearance_mm else None
    case, limit = open_case(case_file), radians(limit_deg)
    warn_of_fallback()
    error = tolerance or RELATIVE_TOLERANCE
    found = {side: critical_dogleg_or_why(case, side=side, limit=limit, relative_tolerance=error) for side in SIDES}
    if as_json:
        stopped = {side: {"stopped": why} for side, why in found.items() if isinstance(why, str)}
        print_json({SIDES[side]: dogleg for side, dogleg in (found | stopped).items()})
    else:
        print_table(lines(case, found, limit), (str(case_file), ""))
    if output is not None:
        text = _draw_map(case, output, across, up, limit, error)
        if not as_json:
            print(text)


def _draw_map(case: Case, output: Path, across: Floats | None, up: Floats | None, limit: float, error: float) -> str:
    """Draw the map; returns what there is to say of it."""
    from ..report.figures.drawing import save  # imported here, since only a picture needs matplotlib
    from ..report.figures.tipping import draw

    usual_across, usual_up = usual_map(case)
    across, up = usual_across if across is None else across, usual_up if up is None else up
    with console.progress("doglegs", len(across) * len(up)) as done:
        found = dogleg_map(case, across, up, limit=limit, relative_tolerance=error, progress=done)
    save(draw(case, found, limit), output)
    return f"{output}: the smallest kink that starts rippling, over weight and clearance{left_out(found)}"


def hysteresis_command(
    case_file: CaseFile,
    output: Annotated[Path | None, typer.Option(metavar="LOOP.png", help="The picture.")] = None,
    eta_pi: EtaPiRange = None,
    clearance_mm: ClearanceRange = None,
    dogleg_deg: Annotated[
        float,
        typer.Option(
            parser=turn,
            metavar="A",
            help="Turn, over half the BHA before the bit, of the otherwise straight holes on the way down, degrees.",
        ),
    ] = 0.5,
    tolerance: Tolerance = None,
    as_json: AsJson = False,
    units: Units = "si",  # noqa: ARG001 - its callback has done it
) -> None:
    """Draw where a ripple dies out on the way up, and returns on the way down.

    Either the weight goes up and down (--eta-pi) or the clearance (--clearance-mm).
    """
    check_asked(output, as_json, reads=files_read(case_file))
    if (eta_pi is None) == (clearance_mm is None):
        raise InputError(f"--eta-pi, --clearance-mm: exactly one must be given, got {'both' if eta_pi else 'neither'}")
    case = open_case(case_file)
    if eta_pi is not None:
        name, values = "eta_pi", parse_range("--eta-pi", eta_pi).tolist()
    else:
        name = f"stabilizer_clearance[{first_that_touches(case)}]"
        values = (parse_range("--clearance-mm", clearance_mm or "") / 1e3).tolist()
    error = tolerance or RELATIVE_TOLERANCE
    warn_of_fallback()
    with console.progress("values", 2 * len(values)) as done:
        found = hysteresis(case, name, values, radians(dogleg_deg), relative_tolerance=error, progress=done)
    if as_json:
        print_json(found)
    if output is not None:
        from ..report.figures.drawing import save  # imported here, since only a picture needs matplotlib
        from ..report.figures.hysteresis import draw

        save(draw(case, found), output)
        if not as_json:
            print(f"{output}: {loop(case, found)}")

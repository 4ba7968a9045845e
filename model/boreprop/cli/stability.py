"""The commands `boreprop roots` and `boreprop stability`."""

import json
from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from ..analysis.stability.chart import stability_chart, usual_grid
from ..analysis.stability.contacts import all_contacts, charted, contacts_met, steady_mode
from ..analysis.stability.roots import Roots, critical_eta_pi, find_roots, parse_contact
from ..case.case import Case
from ..case.file import load_case
from ..core.checks import check_number
from ..errors import InputError
from ..report.tables import stability as tables
from . import console
from .options import CaseFile, positive
from .ranges import parse_range

WIDE = 110  # characters: a line a mode


def roots(
    case_file: CaseFile,
    eta_pi: Annotated[float | None, typer.Option(parser=positive, metavar="X", help="ηΠ. Default: the case's.")] = None,
    contact: Annotated[
        str | None,
        typer.Option(metavar="1,2", help="One mode in full: the stabilizers that touch, '' for none."),
    ] = None,
    saturated: Annotated[bool, typer.Option("--saturated", help="With the bit tilt at its limit.")] = False,
    inclination_deg: Annotated[
        float | None, typer.Option(metavar="A", help="Inclination of the straight hole. Default: that at the end.")
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON: one mode, without --contact that with no contact.")
    ] = False,
    every: Annotated[bool, typer.Option("--all", help="With --json: a list of all modes.")] = False,
) -> None:
    """Print what becomes of small disturbances of a straight hole.

    A mode is which stabilizers touch the wall, and whether the bit tilt is at its limit. A line for each says whether
    it is stable, drifts or oscillates, how fast, and in which waves. With --contact or --json the rightmost roots of
    one mode.
    """
    if every and contact is not None:
        raise InputError(f"--all: must be without --contact, got --contact {contact!r}")
    touching = parse_contact(contact or "")
    if inclination_deg is not None:
        check_number("--inclination-deg", inclination_deg)
    case = load_case(case_file)
    inclination = case.survey.inclination[-1] if inclination_deg is None else radians(inclination_deg)
    at = case.eta_pi if eta_pi is None else eta_pi
    if not (every or (contact is None and not as_json)):
        one = find_roots(case.bha, case.bit, at, contact=touching, saturated=saturated, inclination=inclination)
        print(json.dumps(tables.as_plain(one))) if as_json else _print_roots(case, one)
        return
    found = [
        find_roots(case.bha, case.bit, at, contact=numbers, saturated=limit, inclination=inclination)
        for numbers in all_contacts(case.bha)
        for limit in ((True,) if saturated else (False, True))
    ]
    if as_json:
        print(json.dumps([tables.as_plain(one) for one in found]))
    else:
        _print_modes(case, found, at, inclination)


def _weight(case: Case, eta_pi: float) -> float:
    """The active weight on bit that makes an ηΠ, N."""
    return eta_pi * case.bha.force_scale / case.bit.lateral_steering_resistance


def _print_roots(case: Case, found: Roots) -> None:
    """The rightmost roots of one mode."""
    title = tables.title(found, _weight(case, found.eta_pi))
    table = Table(*tables.HEADINGS, title=title, caption=tables.caption(found))
    for line in tables.lines(found, case.length_scale):
        table.add_row(*line)
    Console().print(table)


def _print_modes(case: Case, found: list[Roots], eta_pi: float, inclination: float) -> None:
    """A line for each mode."""
    weight, forces = _weight(case, eta_pi), case.schedule.rss_force
    title = tables.modes_title(eta_pi, weight, inclination)
    table = Table(*tables.MODE_HEADINGS, title=title, caption=tables.NOT_MET)
    here = steady_mode(replace(case, active_weight_on_bit=weight), forces[0], inclination)
    met = contacts_met(case.bha, case.bit, inclination, forces)
    for roots in found:
        table.add_row(*tables.mode_line(roots, case.length_scale, here, met))
    Console(width=WIDE).print(table)


def stability(
    case_file: CaseFile,
    output: Annotated[Path, typer.Option(metavar="CHART.png", help="The picture.")],
    eta_pi: Annotated[str | None, typer.Option(metavar="A:B:N", help="N values of ηΠ from A to B.")] = None,
    lambda2: Annotated[
        str | None, typer.Option(metavar="A:B:N", help="N values of λ₂, stabilizer 1 to 2 over bit to 1, from A to B.")
    ] = None,
) -> None:
    """Draw where a straight hole is stable, drifts or oscillates.

    The chart is over ηΠ and λ₂, for the inclination at the end of the case's hole. There is a panel for each mode that
    matters: at most four ways in which stabilizers can touch, among them the one in which the case steadily drills,
    each with the bit tilt at its limit and not. The limits are printed.
    """
    console.check_output(output, (".png",))
    across = parse_range("--eta-pi", eta_pi) if eta_pi else None
    up = parse_range("--lambda2", lambda2) if lambda2 else None
    case = load_case(case_file)
    bha, bit, inclination, forces = case.bha, case.bit, case.survey.inclination[-1], case.schedule.rss_force
    here, _ = steady_mode(case, forces[0], inclination)
    contacts = charted(bha, bit, inclination, forces, here)
    limits = {contact: critical_eta_pi(bha, bit, contact=contact, inclination=inclination) for contact in contacts}
    largest = max(limit.eta_pi if limit else 0.0 for limit in limits.values())
    usual_across, usual_up = usual_grid(bha, case.eta_pi, largest)
    across, up = usual_across if across is None else across, usual_up if up is None else up
    from ..report.figures.drawing import save  # here: matplotlib takes long to load
    from ..report.figures.stability import draw

    with console.progress("chart", 1.0) as done:
        chart = stability_chart(bha, bit, across, up, inclination, done, contacts)
    save(draw(chart, case), output)
    weight = tables.weight(case.active_weight_on_bit)
    print(
        f"{output}: {len(across)} × {len(up)} points; {tables.stability_limit(contacts[0], limits[contacts[0]])}; "
        f"the case: ηΠ = {case.eta_pi:.4g} ({weight})"
    )
    for contact in contacts[1:]:
        print(f"{output}: {tables.stability_limit(contact, limits[contact])}")

"""The commands `boreprop roots` and `boreprop stability`: how a straight hole behaves in each mode."""

import json
from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Annotated

import typer

from ..analysis.lying import pressing_weight
from ..analysis.stability.chart import stability_chart, usual_grid
from ..analysis.stability.contacts import all_contacts, charted, contacts_met, steady_mode
from ..analysis.stability.roots import Roots, critical_eta_pi, find_roots, parse_contact
from ..case.case import Case
from ..errors import InputError
from ..report.tables import stability as tables
from ..run.files import files_read
from . import console
from .cases import open_case
from .options import AsJson, CaseFile, EtaPiRange, Inclination, Units, check_asked, positive
from .printing import print_json, print_table
from .ranges import parse_range

WIDE = 110  # characters, so that the line of a mode is not wrapped


def roots_command(
    case_file: CaseFile,
    eta_pi: Annotated[float | None, typer.Option(parser=positive, metavar="X", help="ηΠ. Default: the case's.")] = None,
    contact: Annotated[
        str | None,
        typer.Option(
            metavar="1,2", help="Print the roots of the mode in which these stabilizers touch the wall; '' for none."
        ),
    ] = None,
    saturated: Annotated[bool, typer.Option("--saturated", help="Take modes with the bit tilt at its limit.")] = False,
    inclination_deg: Inclination = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the roots of one mode as JSON. Default mode: no stabilizer touches.")
    ] = False,
    every: Annotated[bool, typer.Option("--all", help="With --json: print a list of all modes.")] = False,
    units: Units = "si",  # noqa: ARG001 - its callback has done it
) -> None:
    """Print whether each mode of a case is stable, drifts or oscillates.

    A mode is a set of stabilizers that touch the wall, with the bit tilt at its limit or not. The table says for each
    mode how fast a small disturbance grows or dies out, and in which waves. With --contact or --json, the rightmost
    roots of one mode are printed instead.
    """
    if every and contact is not None:
        raise InputError(f"--all: must not be given with --contact, got --contact {contact!r}")
    touching = parse_contact(contact or "")
    case = open_case(case_file)
    inclination = case.survey.inclination[-1] if inclination_deg is None else radians(inclination_deg)
    at = case.eta_pi if eta_pi is None else eta_pi
    if every or (contact is None and not as_json):
        modes = [
            find_roots(case, at, contact=numbers, saturated=limit, inclination=inclination)
            for numbers in all_contacts(case.bha)
            for limit in ((True,) if saturated else (False, True))
        ]
        if as_json:
            print(json.dumps([tables.as_plain(mode) for mode in modes]))
        else:
            _print_modes(case, modes, at, inclination)
        return
    mode = find_roots(case, at, contact=touching, saturated=saturated, inclination=inclination)
    if as_json:
        print(json.dumps(tables.as_plain(mode)))
    else:
        title, caption = tables.title(mode, _weight(case, at)), tables.caption(mode)
        print_table(tables.lines(mode, case.length_scale), tables.HEADINGS, title=title, caption=caption)


def _print_modes(case: Case, modes: list[Roots], eta_pi: float, inclination: float) -> None:
    """Print a table with a line for each mode."""
    weight, forces = _weight(case, eta_pi), case.schedule.rss_force
    here = steady_mode(replace(case, active_weight_on_bit=weight), forces[0], inclination)
    met = contacts_met(case.bha, case.bit, inclination, forces)
    lines = [tables.mode_line(mode, case.length_scale, here, met) for mode in modes]
    print_table(
        lines,
        tables.MODE_HEADINGS,
        title=tables.modes_title(eta_pi, weight, inclination),
        caption=tables.not_met(lines),
        width=WIDE,
    )


def _weight(case: Case, eta_pi: float) -> float:
    """The active weight on bit at some ηΠ, N."""
    return eta_pi * case.bha.force_scale / case.bit.lateral_steering_resistance


def stability_command(
    case_file: CaseFile,
    output: Annotated[Path | None, typer.Option(metavar="CHART.png", help="The picture.")] = None,
    eta_pi: EtaPiRange = None,
    lambda2: Annotated[
        str | None,
        typer.Option(
            metavar="START:STOP:COUNT",
            help="Values of λ₂, the distance from stabilizer 1 to 2 over that from the bit to 1.",
        ),
    ] = None,
    as_json: AsJson = False,
    units: Units = "si",  # noqa: ARG001 - its callback has done it
) -> None:
    """Draw the stability chart of a case over ηΠ and λ₂, and print its limits.

    The hole is straight, at the inclination of the end of the existing hole. At most four sets of touching stabilizers
    are shown, among them the set with which the case drills steadily. For each there are two panels, with the bit tilt
    not saturated and saturated.
    """
    check_asked(output, as_json, reads=files_read(case_file))
    across = parse_range("--eta-pi", eta_pi) if eta_pi else None
    up = parse_range("--lambda2", lambda2) if lambda2 else None
    case = open_case(case_file)
    bha, bit, inclination, forces = case.bha, case.bit, case.survey.inclination[-1], case.schedule.rss_force
    here, _ = steady_mode(case, forces[0], inclination)
    contacts = charted(bha, bit, inclination, forces, here, pressing_weight(case))
    limits = {contact: critical_eta_pi(case, contact=contact) for contact in contacts}
    largest = max(limit.eta_pi if limit else 0.0 for limit in limits.values())
    usual_across, usual_up = usual_grid(bha, case.eta_pi, largest)
    across, up = usual_across if across is None else across, usual_up if up is None else up
    with console.progress("chart", 1.0) as done:
        chart = stability_chart(case, across, up, contacts=contacts, progress=done)
    if as_json:
        print_json(tables.chart_as_plain(chart, limits))
    if output is None:
        return
    from ..report.figures.drawing import save  # imported here, since only a picture needs matplotlib
    from ..report.figures.stability import draw

    save(draw(chart, case), output)
    if as_json:
        return
    print(
        f"{output}: {len(across)} × {len(up)} points; {tables.stability_limit(contacts[0], limits[contacts[0]])}; "
        f"the case: ηΠ = {case.eta_pi:.4g} ({tables.weight(case.active_weight_on_bit)})"
    )
    for contact in contacts[1:]:
        print(f"{output}: {tables.stability_limit(contact, limits[contact])}")

"""The steering response of a BHA as it is built, with sections, axial load or body contact: force by force."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...analysis.lying import pressing_weight
from ...analysis.sag import Sag, steady_sag
from ...analysis.steering import SteadyResponse, responses_as_built, steady_response
from ...case.case import Case
from ...units import UNITS
from .sag import outside_the_hole
from .steering import USUAL_FORCE, at_force, force_text, per_build_length, rate, tilt, touching

FORCES = 21  # in the table, from limit to limit
FINER = 41  # between two of these, for the force that holds the inclination


@dataclass(frozen=True)
class SteeringAsBuilt:
    """What an engineer asks about the steering of a BHA as it is built.

    Parameters
    ----------
    inclination
        The inclination at which the weight of the BHA acts, rad.
    active_weight_on_bit, eta_pi
        The active weight on bit, N, and ηΠ.
    pressing_weight
        The weight on bit that presses the BHA along its axis, N; 0 without axial load.
    sections, body_points
        How many sections the beam has, 0 if it is uniform, and at how many points its body may touch the wall.
    responses
        The response to each of some forces, evenly spaced between the limits.
    free, highest, lowest
        The response without force, and of `responses` those with the highest and the lowest build rate.
    holding
        The responses that hold the inclination, the smallest force first.
    sag
        Where the axis of the BHA is farthest from that of the hole, and under which force, N; None if the wall bears
        the body of the BHA.
    """

    inclination: float
    active_weight_on_bit: float
    eta_pi: float
    pressing_weight: float
    sections: int
    body_points: int
    responses: tuple[SteadyResponse, ...]
    free: SteadyResponse
    highest: SteadyResponse
    lowest: SteadyResponse
    holding: tuple[SteadyResponse, ...]
    sag: tuple[Sag, float] | None


def summarize_as_built(
    case: Case, inclination: float | None = None, force_limit: float | None = None
) -> SteeringAsBuilt:
    """The steering of a case; parameters as in `steering.summarize`, errors as in `steady_response`."""
    if inclination is None:
        inclination = case.survey.inclination[-1]
    if force_limit is None:
        force_limit = max(map(abs, case.schedule.rss_force)) or USUAL_FORCE
    forces = np.linspace(-force_limit, force_limit, FORCES)
    responses = responses_as_built(case, forces.tolist(), inclination)
    sag = None
    if not case.bha.body_point_positions:
        sags = [(steady_sag(case, response, inclination), response.rss_force) for response in responses]
        sag = max(sags, key=lambda at: abs(at[0].offset))
    return SteeringAsBuilt(
        inclination=inclination,
        active_weight_on_bit=case.active_weight_on_bit,
        eta_pi=case.eta_pi,
        pressing_weight=pressing_weight(case),
        sections=len(case.bha.section_lengths),
        body_points=len(case.bha.body_point_positions),
        responses=responses,
        free=responses[FORCES // 2],
        highest=max(responses, key=lambda response: response.build_rate),
        lowest=min(responses, key=lambda response: response.build_rate),
        holding=_holding(case, responses, inclination),
        sag=sag,
    )


def _holding(case: Case, responses: tuple[SteadyResponse, ...], inclination: float) -> tuple[SteadyResponse, ...]:
    """The responses without curvature between those given; each piece of the curve between two forces is looked at."""
    found = []
    for before, after in pairwise(responses):
        if (before.build_rate > 0) == (after.build_rate > 0):
            continue
        forces = np.linspace(before.rss_force, after.rss_force, FINER)
        rates = [response.build_rate for response in responses_as_built(case, forces.tolist(), inclination)]
        if rates[0] > rates[-1]:
            forces, rates = forces[::-1], rates[::-1]
        found.append(steady_response(case, float(np.interp(0.0, rates, forces)), inclination))
    return tuple(sorted(found, key=lambda response: abs(response.rss_force)))


def lines(summary: SteeringAsBuilt) -> list[tuple[str, str]]:
    """The lines of a table, each a name and a value with its unit; warnings come last."""
    limit = force_text(summary.responses[-1].rss_force)
    holding = " or ".join(
        force_text(response.rss_force, "+") + " (tilt at its limit)" * bool(response.bit_tilt_saturation)
        for response in summary.holding
    )
    counted = [
        f"{summary.sections} section{'s' * (summary.sections > 1)}" * bool(summary.sections),
        f"{force_text(summary.pressing_weight)} along the BHA" * bool(summary.pressing_weight),
        f"contact of its body at up to {summary.body_points} points" * bool(summary.body_points),
    ]
    table = [
        ("inclination at which the weight acts", UNITS["rad"].text(summary.inclination)),
        ("active weight on bit", f"{force_text(summary.active_weight_on_bit)}, ηΠ = {summary.eta_pi:.3g}"),
        ("counted", ", ".join(filter(None, counted))),
        ("force limit", f"±{limit}"),
        ("build rate without force", f"{rate(summary.free.build_rate)}, on a wall: {touching(summary.free)}"),
        ("its largest force on the body", on_body(summary.free) if summary.body_points else ""),
        ("force that holds the inclination", holding or f"none up to ±{limit}"),
        ("highest build rate in the table", at_force(summary.highest)),
        ("lowest build rate in the table", at_force(summary.lowest)),
        ("left out", "whether waves grow under a force (simulate tells), and that gravity changes along the arc"),
    ]
    if summary.sag and (text := outside_the_hole(summary.sag[0])):
        table.append(("warning", f"{force_text(summary.sag[1], '+')}: {text}"))
    return [(what, amount) for what, amount in table if amount]


def headings() -> tuple[str, ...]:
    """The headings of the columns of `response_lines`, with their units."""
    return (
        f"force\n({UNITS['N'].shown})",
        f"build rate\n({UNITS['rad/m'].shown})",
        f"bit tilt\n({UNITS['rad'].shown})",
        "on a wall\n",
        "largest force on the body\n",
    )


def response_lines(summary: SteeringAsBuilt) -> list[tuple[str, ...]]:
    """The lines of a table with a line for each force, and a cell for each of `headings`."""
    return [
        (
            UNITS["N"].number(response.rss_force, "+z.2f"),
            f"{per_build_length(response.build_rate):+z.2f}",
            tilt(response) + " (limit)" * bool(response.bit_tilt_saturation),
            touching(response),
            on_body(response),
        )
        for response in summary.responses
    ]


def on_body(response: SteadyResponse) -> str:
    """The largest force on the body, and where it acts, as text."""
    if not response.body_contact_force:
        return "none"
    return f"{force_text(response.body_contact_force, '+')} at {UNITS['m'].text(response.body_contact_position)}"

"""Critical doglegs in words."""

from collections.abc import Mapping
from math import degrees, inf

from ...analysis.stability.roots import Verdict
from ...analysis.stability.straight import straight_drilling
from ...analysis.tipping import FINEST, CriticalDogleg, DoglegMap, with_dogleg
from ...case.case import Case
from ...units import UNITS
from .stability import contact_text

SIDES = {1: "up", -1: "down"}


def lines(case: Case, found: Mapping[int, CriticalDogleg | str], limit: float) -> list[tuple[str, str]]:
    """The lines of a table, one for each side.

    `found` has the critical dogleg of each side, or the reason why a run stopped; `limit` is the largest turn that was
    tried, rad.
    """
    return [
        (
            f"smallest kink that starts rippling, turning {SIDES[side]}",
            f"not known: {dogleg}" if isinstance(dogleg, str) else _amount(case, dogleg, limit),
        )
        for side, dogleg in found.items()
    ]


def _amount(case: Case, found: CriticalDogleg, limit: float) -> str:
    if found.angle == inf:
        return f"none up to {degrees(limit):.3g}°"
    exception = "" if found.monotonic else ", but not every larger one"
    straight = [turn for turn, ripples in found.tried if not ripples]
    if found.angle == 0.0 and 0.0 in straight:
        return f"any of {degrees(FINEST):g}° or more{exception}"
    if found.angle == 0.0 and straight:
        least, most = (f"{degrees(turn):.2g}°" for turn in (straight[0], straight[-1]))
        turns = least if least == most else f"{least} to {most}"
        return f"none needed: it ripples from {_straight(case)}, but not after a turn of {turns}"
    if found.angle == 0.0:
        return f"any: it ripples from {_straight(case)}"
    severity = UNITS["rad/m"].text(found.curvature, ".1f")
    return f"{degrees(found.angle):.2f}° over {UNITS['m'].text(case.bha.half_length, '.4g')} ({severity}){exception}"


def _straight(case: Case) -> str:
    """A straight hole that ripples by itself, in words: at which inclination, and why if its steady mode says so."""
    hole = with_dogleg(case, 0.0)
    inclination = round(degrees(hole.survey.inclination[-1]), 1)
    straight = straight_drilling(hole)
    rate = round(straight.response.build_rate, 9)  # of −1e-18 rad/m nobody would say that it drops
    turns = "drops" if rate < 0 else "builds" if rate > 0 else "drills on"
    why = f", since it {turns} with {contact_text(straight.contact)}, which oscillates"
    return (
        "a straight hole"
        + f" at {inclination:g}°" * bool(inclination)
        + why * (straight.verdict is Verdict.OSCILLATORY)
    )


def left_out(found: DoglegMap) -> str:
    """The end of a sentence that says how many points a map lacks; empty if it has all."""
    stopped = found.stopped[found.stopped != ""]
    return f"; {stopped.size} of {found.stopped.size} points left out (the first: {stopped[0]})" if stopped.size else ""

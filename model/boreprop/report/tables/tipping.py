"""Critical doglegs in words."""

from collections.abc import Mapping
from math import degrees, inf

from ...analysis.tipping import FINEST, CriticalDogleg, DoglegMap
from ...case.case import Case
from ...units import UNITS

SIDES = {1: "up", -1: "down"}


def lines(case: Case, found: Mapping[int, CriticalDogleg | str], limit: float) -> list[tuple[str, str]]:
    """The lines of a table, one for each side.

    `found` has the critical dogleg of each side, or the reason why a run stopped; `limit` is the largest turn that was
    tried, rad.
    """
    return [
        (
            f"smallest kink that starts rippling, turning {SIDES[side]}",
            f"not known: {dogleg}" if isinstance(dogleg, str) else _amount(dogleg, case.bha.half_length, limit),
        )
        for side, dogleg in found.items()
    ]


def _amount(found: CriticalDogleg, length: float, limit: float) -> str:
    if found.angle == inf:
        return f"none up to {degrees(limit):.3g}°"
    exception = "" if found.monotonic else ", but not every larger one"
    straight = [turn for turn, ripples in found.tried if not ripples]
    if found.angle == 0.0 and 0.0 in straight:
        return f"any of {degrees(FINEST):g}° or more{exception}"
    if found.angle == 0.0 and straight:
        least, most = (f"{degrees(turn):.2g}°" for turn in (straight[0], straight[-1]))
        turns = least if least == most else f"{least} to {most}"
        return f"none needed: it ripples from a straight hole, but not after a turn of {turns}"
    if found.angle == 0.0:
        return "any: it ripples from a straight hole"
    severity = UNITS["rad/m"].text(found.curvature, ".1f")
    return f"{degrees(found.angle):.2f}° over {UNITS['m'].text(length, '.4g')} ({severity}){exception}"


def left_out(found: DoglegMap) -> str:
    """The end of a sentence that says how many points a map lacks; empty if it has all."""
    stopped = found.stopped[found.stopped != ""]
    return f"; {stopped.size} of {found.stopped.size} points left out (the first: {stopped[0]})" if stopped.size else ""

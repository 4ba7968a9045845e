"""Where the body of a BHA may touch the wall: from the keys body_contact and body_contact_spacing of a case file."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate, pairwise
from math import inf, radians
from pathlib import Path
from typing import Any

import numpy as np

from ..core.quantities import MAX_POINTS
from ..errors import InputError, shown
from .case import Case

PARTS_OF_FIRST_SPAN = 50  # of the span above the bit or above a near-bit stabilizer: side force and curvature to 1 %
LONG_SPAN = 5.0  # m: a shorter span above the bit ends at a near-bit stabilizer
FURTHER_UP = 1.5  # m between points there: to 0.1 %
NEAREST = 1.0  # m from the bit, where the body does not touch before the tilt of the bit is at its limit
SAME = 1e-12  # m: clearances that differ by less differ by rounding
KEYS = ("body_contact", "body_contact_spacing", "body_point_positions")  # of [bha], one of which asks for contact


def place_points(document: dict[str, Any], source: Path) -> None:
    """Put the points of the body, and their clearances, into [bha] of a document that asks for body contact.

    Parameters
    ----------
    document
        The document that a case file is, with its sections lifted.
    source
        The case file.

    Raises
    ------
    InputError
        If two keys ask for contact, a section has no outer diameter or one that does not fit into the hole, or there
        would be more points than there is room for.
    """
    bha = document.get("bha")
    asked = [key for key in KEYS if isinstance(bha, dict) and bha.get(key, False) is not False]
    if not isinstance(bha, dict) or not asked or "body_point_clearances" in bha:
        return
    if len(asked) > 1:
        raise InputError(f"{source}: bha: must hold one of {', '.join(KEYS)}, got {' and '.join(asked)}")
    if bha.get("body_contact", True) is not True:
        raise InputError(f"{source}: bha.body_contact: must be true or false, got {shown(bha['body_contact'])}")
    try:
        stabilizers, hole = [float(s) for s in bha["stabilizer_positions"]], float(document["bit"]["diameter"])
        limit = radians(document["bit"]["tilt_limit_deg"])
        body = _Body(document.get("section"), stabilizers[-1], source)
    except (KeyError, TypeError, ValueError, IndexError):
        return  # what is missing or no number is reported with the other keys
    nearest = min(NEAREST, body.clearance(0.0, hole) / limit) if limit > 0 else NEAREST
    if "body_point_positions" in bha:
        positions = bha["body_point_positions"]
    else:
        spacing = _spacing(bha, source)
        positions = body.points(stabilizers, nearest, spacing)
    if len(positions) > MAX_POINTS:
        raise InputError(
            f"{source}: bha.body_contact_spacing: must give at most {MAX_POINTS} points, got {len(positions)}"
        )
    bha["body_point_positions"] = positions
    bha["body_point_clearances"] = [body.clearance(s, hole) for s in positions]
    if min(bha["body_point_clearances"], default=inf) <= 0:
        widest = max(body.diameters)
        raise InputError(f"{source}: bha.section: outer_diameter must be < bit.diameter = {hole:g}, got {widest:g}")


def keep_clearances(before: Case, after: Case) -> Case:
    """`after` with the clearances of its body that followed from the diameters of `before` following from its own.

    Parameters
    ----------
    before
        A case.
    after
        The same case with other parameters.

    Returns
    -------
    Case
        `after`, in which clearances that are given by hand stay: those that are not half of hole less body in
        `before`, and those that differ between the two.
    """
    followed, follow = _clearances(before), _clearances(after)
    kept = zip(before.bha.body_point_clearances, after.bha.body_point_clearances, followed, follow, strict=True)
    clearances = tuple(new if own == old and abs(old - was) <= SAME else own for old, own, was, new in kept)
    if clearances == after.bha.body_point_clearances:
        return after
    return replace(after, bha=replace(after.bha, body_point_clearances=clearances))


def _clearances(case: Case) -> list[float]:
    """Half of hole less body at the points of the body, m."""
    bha, ends = case.bha, list(accumulate(case.bha.section_lengths))
    diameters = bha.section_outer_diameters
    return [_clearance(ends, diameters, s, case.bit_diameter) if ends else 0.0 for s in bha.body_point_positions]


def _clearance(ends: Sequence[float], diameters: Sequence[float], s: float, hole: float) -> float:
    """Between body and wall on each side; at a step of the diameter that of the larger side."""
    k = min(int(np.searchsorted(ends, s - 1e-9)), len(ends) - 1)
    both = diameters[k : k + 2] if abs(ends[k] - s) <= 1e-9 else diameters[k : k + 1]
    return (hole - max(both)) / 2


def _spacing(bha: dict[str, Any], source: Path) -> float | None:
    spacing = bha.get("body_contact_spacing")
    if spacing is None or (type(spacing) in (int, float) and 0 < spacing < inf):
        return spacing
    raise InputError(f"{source}: bha.body_contact_spacing: must be a number > 0, got {shown(spacing)}")


class _Body:
    """The outer diameter along the beam."""

    def __init__(self, section: dict[str, list[Any]] | None, reach: float, source: Path) -> None:
        if section is None:
            raise InputError(f"{source}: bha: must have [[bha.section]] with outer_diameter for body contact, got none")
        self.ends = list(accumulate(map(float, section["length"])))
        self.diameters = [float(diameter) for diameter in section["outer_diameter"]]
        self.reach = reach
        for k, diameter in enumerate(self.diameters, 1):
            if diameter <= 0:
                raise InputError(
                    f"{source}: bha.section[{k}].outer_diameter: must be given for body contact, got nothing"
                )

    def clearance(self, s: float, hole: float) -> float:
        """Between body and wall on each side."""
        return _clearance(self.ends, self.diameters, s, hole)

    def points(self, stabilizers: Sequence[float], nearest: float, spacing: float | None) -> list[float]:
        """Where the body may touch: in each span at equal distances, and at each step of the diameter."""
        steps = [end for end, (a, b) in zip(self.ends, pairwise(self.diameters), strict=False) if a != b]
        found = {s for s in steps if nearest <= s < self.reach and s not in stabilizers}
        fine = True
        for start, end in pairwise([0.0, *stabilizers]):
            distance = spacing or ((end - start) / PARTS_OF_FIRST_SPAN if fine else FURTHER_UP)
            fine = fine and end - start < LONG_SPAN
            count = max(int(np.ceil((end - start) / distance - 1e-9)), 1)
            found |= {s for s in (start + (end - start) * k / count for k in range(1, count)) if s >= nearest}
        return sorted(found)

"""BHAs with a near-bit stabilizer whose fate is known, from `field/near_bit.json`, as cases."""

import json
from math import radians
from pathlib import Path
from typing import Any

from boreprop.case import Case, Schedule
from boreprop.core.assembly import BitRock, BottomHoleAssembly
from boreprop.core.hole import Survey

FATES: dict[str, list[dict[str, Any]]] = json.loads(
    (Path(__file__).parent / "field" / "near_bit.json").read_text(encoding="utf-8")
)


def near_bit_case(entry: dict[str, Any], length: float) -> Case:
    """The case of an entry: a straight hole that turns by 1.5° over its last 8 m, no force."""
    last = entry["pos"][-1]
    return Case(
        BottomHoleAssembly(tuple(entry["pos"]), tuple(entry["y"]), entry["rss"], 1500.0, entry["EI"]),
        BitRock(20.0, 1.0, radians(entry["psi"])),
        bit_diameter=0.2159,
        active_weight_on_bit=entry["W"],
        length=length,
        survey=Survey((0.0, last, last + 8.0), tuple(radians(entry["inc"] + turn) for turn in (0.0, 0.0, 1.5))),
        schedule=Schedule(),
    )

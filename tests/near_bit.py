"""The BHAs with a near-bit stabilizer in tests/field/near_bit.json, as cases: see what it says about itself."""

import json
from math import radians
from pathlib import Path
from typing import Any

from boreprop.case.case import Case
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly

FIELD = Path(__file__).parent / "field"
NEAR_BIT: dict[str, Any] = json.loads((FIELD / "near_bit.json").read_text(encoding="utf-8"))


def near_bit_case(entry: dict[str, Any], length: float = 1500.0) -> Case:
    """One of them, drilling on without a force from a hole that turns by 1.5° over its last 8 m."""
    inclination, end = entry["inc"], entry["pos"][-1]
    return Case(
        bha=BottomHoleAssembly(tuple(entry["pos"]), tuple(entry["y"]), entry["rss"], 1500.0, entry["EI"]),
        bit=BitRock(20.0, 1.0, radians(entry["psi"])),
        bit_diameter=0.2159,
        active_weight_on_bit=entry["W"],
        length=length,
        survey=Survey((0.0, end, end + 8.0), tuple(map(radians, (inclination, inclination, inclination + 1.5)))),
    )

"""The paper's case with other weights, tilt limits, walk angles and clearances, for tests of spirals."""

from dataclasses import replace
from math import radians

from boreprop.case.case import Case
from boreprop.case.paper import paper_case


def paper_spiral(
    eta_pi: float = 0.01, *, tilt_limit_deg: float = 2.0, walk_deg: float = 0.0, clearance: float = 1e-3
) -> Case:
    """The paper's case; the clearance is over ℓ₁."""
    case = paper_case()
    weight = eta_pi * case.bha.force_scale / case.bit.lateral_steering_resistance
    bit = replace(case.bit, tilt_limit=radians(tilt_limit_deg), walk_angle=radians(walk_deg))
    bha = replace(case.bha, stabilizer_clearances=(clearance * case.length_scale,))
    return replace(case, bha=bha, bit=bit, active_weight_on_bit=weight)

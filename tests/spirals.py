"""Cases for tests of spirals: the paper's with other numbers, and from holes that are disturbed across their plane."""

from dataclasses import replace
from math import pi, radians

import numpy as np

from boreprop.arrays import Floats
from boreprop.case.case import Case
from boreprop.case.paper import paper_case
from boreprop.core.survey import Survey


def paper_spiral(
    eta_pi: float = 0.01, *, tilt_limit_deg: float = 2.0, walk_deg: float = 0.0, clearance: float = 1e-3
) -> Case:
    """The paper's case; the clearance is over ℓ₁."""
    case = paper_case()
    weight = eta_pi * case.bha.force_scale / case.bit.lateral_steering_resistance
    bit = replace(case.bit, tilt_limit=radians(tilt_limit_deg), walk_angle=radians(walk_deg))
    bha = replace(case.bha, stabilizer_clearances=(clearance * case.length_scale,))
    return replace(case, bha=bha, bit=bit, active_weight_on_bit=weight)


def trihedron(inclination: Floats, azimuth: Floats) -> tuple[Floats, Floats, Floats]:
    """The high side, the right, and ahead, as north, east and down, shape (rows, 3) each."""
    sin, cos, zero = np.sin(inclination), np.cos(inclination), np.zeros_like(inclination)
    north, east = np.cos(azimuth), np.sin(azimuth)
    return (
        np.column_stack((cos * north, cos * east, -sin)),
        np.column_stack((-east, north, zero)),
        np.column_stack((sin * north, sin * east, cos)),
    )


def disturbed(case: Case, across_deg: float = 1e-2, inclination_deg: float = 0.0) -> Case:
    """A case from a hole with a dogleg of half a degree over ℓ₁ and, across it, a small wave."""
    l1, end = case.length_scale, case.bha.stabilizer_positions[-1]
    s = np.linspace(0.0, end, 41)
    up = np.radians(0.5 * np.maximum(s - end + l1, 0.0) / l1)
    right = radians(across_deg) * np.sin(2 * pi * s / (1.386 * l1))
    high_side, right_side, ahead = trihedron(np.full(41, radians(inclination_deg)), np.zeros(41))
    T = ahead + up[:, None] * high_side + right[:, None] * right_side
    inclination, azimuth = np.arctan2(np.hypot(T[:, 0], T[:, 1]), T[:, 2]), np.arctan2(T[:, 1], T[:, 0])
    return replace(case, survey=Survey(tuple(s.tolist()), tuple(inclination.tolist()), tuple(azimuth.tolist())))

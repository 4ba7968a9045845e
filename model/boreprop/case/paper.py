"""The case study of the paper, section VI."""

from math import radians

from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly
from .case import Case, Schedule

LENGTH_SCALE = 3.66  # ℓ₁, m
FLEXURAL_STIFFNESS = 7.2e6  # N·m²


def paper_case(tilt_limit: float = radians(2.0), clearance: float = 1e-3) -> Case:
    """The paper's drilling system at ηΠ = 0.01 in an almost vertical hole, without steering.

    The paper prints no ε and no existing hole; ε = 0.1 reproduces its stability limit ηΠ = 0.147, and the hole turns
    from vertical to 0.5° over the last ℓ₁.

    Parameters
    ----------
    tilt_limit
        ψ*, rad.
    clearance
        y* of the first stabilizer, over ℓ₁.
    """
    l1 = LENGTH_SCALE
    return Case(
        bha=BottomHoleAssembly(
            stabilizer_positions=(l1, 2 * l1),
            stabilizer_clearances=(clearance * l1,),
            rss_position=0.6,
            distributed_weight=1080.0,
            flexural_stiffness=FLEXURAL_STIFFNESS,
        ),
        bit=BitRock(lateral_steering_resistance=10.0, angular_steering_resistance=1.0, tilt_limit=tilt_limit),
        bit_diameter=0.2159,
        active_weight_on_bit=0.001 * 3 * FLEXURAL_STIFFNESS / l1**2,
        length=60 * l1,
        survey=Survey((0.0, l1, 2 * l1), (0.0, 0.0, radians(0.5))),
        schedule=Schedule(),
    )

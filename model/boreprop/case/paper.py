"""The case study of the paper, section VI."""

from math import radians

from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly
from .case import Case
from .inputs import Schedule

LENGTH_SCALE = 3.66  # ℓ₁, m
FLEXURAL_STIFFNESS = 7.2e6  # N·m²


def paper_case(tilt_limit: float = radians(2.0), clearance: float = 1e-3) -> Case:
    """The paper's drilling system (section VI) at ηΠ = 0.01 in an almost vertical hole, without steering: it ripples.

    The paper prints neither ε nor the existing hole. ε = 0.1 reproduces its stability limit ηΠ = 0.147. The existing
    hole is chosen here: vertical, then turning to 0.5° over the last ℓ₁ before the bit.

    Parameters
    ----------
    tilt_limit
        ψ*, the limit of the bit tilt, rad.
    clearance
        y*, the clearance of the first stabilizer over ℓ₁, dimensionless.

    Returns
    -------
    Case
        The case, 60 ℓ₁ long.

    Raises
    ------
    ParameterError
        If a value is out of range.

    Examples
    --------
    >>> from boreprop import paper_case
    >>> case = paper_case(clearance=2e-3)
    >>> case.bha.stabilizer_positions, case.bha.stabilizer_clearances
    ((3.66, 7.32), (0.00732,))
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

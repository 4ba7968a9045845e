"""How fast a planar ripple leaves its plane, against simulations in space by another program."""

from math import isnan

import pytest

from boreprop.analysis.spiral.transverse import transverse_growth
from boreprop.core.errors import ParameterError
from spirals import paper_spiral

GROWTH = {0.5: -0.054, 0.75: 0.006, 1.0: 0.139, 1.5: 0.257, 2.0: 0.311, 3.0: 0.377}  # ψ*, degrees → per ℓ₁, there
QUICK = (0.5, 2.0)
ROUGH = 0.007  # per ℓ₁: they were fitted to simulations


@pytest.mark.parametrize(
    "tilt_limit_deg", [pytest.param(limit, marks=() if limit in QUICK else pytest.mark.slow) for limit in GROWTH]
)
def test_the_growth_is_that_of_simulations(tilt_limit_deg: float) -> None:
    found = transverse_growth(paper_spiral(tilt_limit_deg=tilt_limit_deg))
    assert found.growth * 3.66 == pytest.approx(GROWTH[tilt_limit_deg], abs=ROUGH)


def test_a_hole_that_does_not_ripple_has_no_growth() -> None:
    assert isnan(transverse_growth(paper_spiral(tilt_limit_deg=0.1)).growth)


def test_a_bit_that_walks_leaves_the_plane_at_once() -> None:
    with pytest.raises(ParameterError, match=r"^bit_walk_angle: must be 0 for a ripple in a plane"):
        transverse_growth(paper_spiral(walk_deg=1.0))

"""The drilling system: what no dimensionless number can be made of."""

import pytest

from boreprop.core.errors import ParameterError
from boreprop.core.problems import DERIVED
from boreprop.core.system import BitRock, BottomHoleAssembly, scale

BHA = BottomHoleAssembly((3.0, 6.0), (1e-3,), 0.5, 1e3, 1e7)


def test_a_bit_that_turns_too_easily_for_a_double_is_refused() -> None:
    with pytest.raises(ParameterError) as refused:
        scale(BHA, BitRock(1.0, 1e-310, 0.02))
    assert str(refused.value) == f"{DERIVED['inverse_epsilon']}: must be a finite number, got inf"

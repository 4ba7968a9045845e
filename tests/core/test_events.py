"""Where a step meets a bound: the two searches that find it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boreprop.core.events import crossing, extremes


@given(st.floats(-2.0, 2.0), st.floats(0.1, 2.0), st.floats(0.3, 0.6))
def test_the_extreme_of_a_parabola_between_two_points_is_found(a: float, b: float, c: float) -> None:
    found = extremes([(x, a + b * (x - c) ** 2) for x in (0.0, 0.3, 0.6, 1.0)])
    assert found == pytest.approx([c] * len(found), abs=1e-9)
    assert found


def test_a_function_that_only_rises_has_no_extremes() -> None:
    assert extremes([(0.0, 0.0), (1.0, 1.0), (2.0, 3.0), (3.0, 7.0)]) == []


def test_a_crossing_is_found_to_rounding() -> None:
    assert crossing(lambda x: x**3 - 0.1, 0.0, 1.0, 0.9) == pytest.approx(0.1 ** (1 / 3), abs=1e-12)
    assert crossing(lambda x: 1e-9 * (np.exp(20 * x) - 2.0), 0.0, 1.0, 1e-9 * (np.exp(20) - 2)) == pytest.approx(
        np.log(2.0) / 20, abs=1e-5
    )

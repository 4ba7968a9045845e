"""Random drilling systems in space, a few of those of fuzz_space.py."""

import pytest

from boreprop.kernel.binding import available
from fuzz_space import ending, examine_all, plain

pytestmark = pytest.mark.skipif(not available(), reason="the kernel is not built")


@pytest.mark.parametrize("number", [(11, 228), (1001, 2923), (1001, 3413), (1001, 3945)])
def test_each_random_case_that_could_not_be_drilled_is_drilled(number: tuple[int, int]) -> None:
    """A tilt that reaches its limit under hardly any force; stabilizers centimetres apart, one of which comes free."""
    assert ending(*plain(*number)) == ("drilled", None)


def test_random_cases_in_space_do_not_fail() -> None:
    assert [found for found in examine_all(3, range(20, 41)) if found[2]] == []

"""Random drilling systems in space, a few of those of fuzz_space.py."""

from dataclasses import replace

import pytest

from boreprop.kernel.binding import available
from fuzz_space import draw, ending, examine_all, plain

pytestmark = pytest.mark.skipif(not available(), reason="the kernel is not built")


@pytest.mark.parametrize("number", [(11, 228), (1001, 2923), (1001, 3413), (1001, 3945)])
def test_each_random_case_that_could_not_be_drilled_is_drilled(number: tuple[int, int]) -> None:
    """A tilt that reaches its limit under hardly any force; stabilizers centimetres apart, one of which comes free."""
    assert ending(*plain(*number)) == ("drilled", None)


def test_contacts_are_searched_for_where_those_that_follow_an_event_have_no_answer() -> None:
    case, tolerance = draw(9004, 103)
    assert ending(replace(case, length=24.0), tolerance) == ("drilled", None)


def test_random_cases_in_space_do_not_fail() -> None:
    assert [found for found in examine_all(5, range(20, 41)) if found[2]] == []

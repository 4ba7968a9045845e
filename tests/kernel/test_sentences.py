"""The sentence that C makes of a problem is the one that Python makes, for every code."""

import ctypes
from dataclasses import astuple, replace
from math import frexp, inf, nan

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from boreprop.core.errors import CannotContinue, ParameterError, error_of
from boreprop.core.problems import CONSTRAINTS, DERIVED, OBSTACLES, SENTENCES, Problem
from boreprop.kernel import binding

pytestmark = pytest.mark.usefixtures("kernel")


def told_by_c(problem: Problem) -> str:
    code, quantity, *rest = astuple(problem)
    line = ctypes.create_string_buffer(512)
    there = binding.ProblemInC(binding.CODES.index(code), binding.QUANTITIES.index(quantity), *rest)
    assert repr(there.read()) == repr(problem)
    binding.library().boreprop_sentence(there, line)
    return line.value.decode()


# of a power of two the shortest decimal may be one that no rounding gives: C then writes a digit more
numbers = st.one_of(st.floats(), st.integers(-(10**18), 10**18).map(float)).filter(lambda x: abs(frexp(x)[0]) != 0.5)


@pytest.mark.parametrize("code", SENTENCES)
@example("stabilizer_position", 0, [nan, inf, -inf, 0.0])
@example("", 0, [1e15, 1e16, 12345678901234568.0, 1e-5])
@example("rss_force", 0, [-0.0, 1e22, 1e23, 9007199254740993.0])
@example(DERIVED["scaled_force"], 0, [5e-324, 1.7976931348623157e308, 0.0001, 262144.0])
@given(st.sampled_from(binding.QUANTITIES), st.integers(0, 9), st.lists(numbers, min_size=4, max_size=4))
def test_a_sentence_is_the_same_from_c_and_from_python(
    code: str, quantity: str, index: int, values: list[float]
) -> None:
    problem = Problem(code, quantity, index, *values)
    assert told_by_c(problem) == problem.sentence


@pytest.mark.parametrize("code", SENTENCES)
def test_an_error_has_the_sentence_of_its_problem(code: str) -> None:
    problem = Problem(code, "rss_position", 0, 5.0, limit=4.0, place=12.5)
    if code in ("not increasing", "too close"):
        problem = replace(problem, before=6.0)
    error = error_of(problem)
    assert str(error) == problem.sentence
    assert "\n" not in str(error)
    assert "{" not in str(error)
    if code in CONSTRAINTS:
        assert isinstance(error, ParameterError)
        assert str(error).startswith(f"rss_position: {error.constraint}, got ")
    else:
        assert isinstance(error, CannotContinue)
        assert (error.code, error.place) == (code, 12.5)
        assert str(error).endswith(error.helps)
        assert code in OBSTACLES

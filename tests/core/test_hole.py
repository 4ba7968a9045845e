"""The hole behind the bit: survey, history, delayed look-up."""

from itertools import accumulate, pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boreprop.core.errors import ParameterError
from boreprop.core.hole import Drilled, Hole
from boreprop.core.inputs import Inputs
from boreprop.core.survey import Survey

REACH = 4.0


@st.composite
def surveys(draw: st.DrawFn) -> Survey:
    count = draw(st.integers(1, 8))
    depths = tuple(accumulate(draw(st.floats(0.05, 3.0)) for _ in range(count)))
    return Survey(depths, tuple(draw(st.floats(-1.0, 2.0)) for _ in range(count)))


@given(surveys(), st.floats(0.0, REACH), st.floats(0.0, REACH))
def test_lateral_coordinate_is_the_integral_of_the_survey(survey: Survey, a: float, b: float) -> None:
    """The trapezoidal rule is exact between the stations, if they are among its points."""
    hole = Hole(survey, 1.0, REACH)
    stations = np.array(survey.measured_depth) - survey.measured_depth[-1]
    lower, upper = -max(a, b), -min(a, b)
    points = np.unique([lower, upper, *stations[(stations > lower) & (stations < upper)]])
    integral = np.trapezoid(np.interp(points, stations, survey.inclination), points)
    assert hole.Y(upper) - hole.Y(lower) == pytest.approx(integral, abs=1e-12)


@given(surveys(), st.floats(0.0, REACH))
def test_inclination_is_linear_between_stations_and_straight_above_the_first(survey: Survey, back: float) -> None:
    hole = Hole(survey, 1.0, REACH)
    depth = survey.measured_depth[-1] - back
    expected = np.interp(depth, survey.measured_depth, survey.inclination)
    assert hole.Theta(-back) == pytest.approx(expected, abs=1e-10)


@given(surveys())
def test_kinks_are_the_stations_where_the_slope_jumps(survey: Survey) -> None:
    hole = Hole(survey, 1.0, REACH)
    for xi, jump in hole.kinks:
        gap = 1e-6
        before, after = hole.Theta(xi) - hole.Theta(xi - gap), hole.Theta(xi + gap) - hole.Theta(xi)
        assert abs(after - before) / gap == pytest.approx(jump, rel=1e-3, abs=1e-6)


pieces = st.lists(
    st.tuples(st.floats(0.01, 0.5), st.tuples(*[st.floats(-1.0, 1.0)] * 5)), min_size=5, max_size=30
)  # fmt: skip


def drilled(parts: list[tuple[float, tuple[float, ...]]]) -> tuple[Hole, float]:
    """A hole with continuous Y made of random pieces, and where it ends."""
    hole, xi, Y = Hole(Survey((0.0,), (0.0,)), 1.0, REACH), 0.0, 0.0
    for width, rest in parts:
        hole.append(xi, width, (Y, *rest), Drilled((0.0,) * 6, Inputs(0.0, 1.0, 0.1, 0.02)))
        xi, Y = xi + width, Y + sum(rest)
    return hole, xi


@given(pieces, st.floats(0.0, 1.0), st.floats(0.01, 1.0))
def test_look_up_along_a_step_is_the_look_up_point_by_point(
    parts: list[tuple[float, tuple[float, ...]]], where: float, h: float
) -> None:
    hole, end = drilled(parts)
    points = [0.1, 0.3, 0.6, 1.0]
    start = where * max(end - h, 0.0)
    expected = [hole.Y(start + t * h) for t in points]
    assert hole.look_up(start, h, points) == pytest.approx(expected, abs=1e-12)


@given(pieces)
def test_forgetting_and_moving_the_origin_change_no_difference(parts: list[tuple[float, tuple[float, ...]]]) -> None:
    hole, end = drilled(parts)
    places = [end * k / 7 for k in range(3, 8)]
    before = [hole.Y(b) - hole.Y(a) for a, b in pairwise(places)]
    hole.forget(places[0])
    hole.shift(0.37)
    assert [hole.Y(b) - hole.Y(a) for a, b in pairwise(places)] == pytest.approx(before, abs=1e-12)


@given(pieces)
def test_forgetting_leaves_no_more_than_what_is_asked_for(parts: list[tuple[float, tuple[float, ...]]]) -> None:
    hole, end = drilled(parts)
    hole.forget(end)
    assert len(hole.starts) == 1


@pytest.mark.parametrize(
    ("depths", "inclinations", "message"),
    [
        ((), (), "measured_depth: must hold at least one station"),
        ((0.0, 2.0, 2.0), (0.0, 0.0, 0.0), r"measured_depth: must increase, got \(2.0, 2.0\)"),
        ((0.0, 1.0), (0.0,), "inclination: must hold one value per measured_depth, 2 in all"),
        ((0.0, 1.0), (0.0, float("nan")), r"inclination\[2\]: must be a finite number, got nan"),
    ],
)
def test_a_survey_that_makes_no_sense_is_refused(
    depths: tuple[float, ...], inclinations: tuple[float, ...], message: str
) -> None:
    with pytest.raises(ParameterError, match=message):
        Survey(depths, inclinations)

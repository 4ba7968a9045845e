"""The course of a case's inputs, against the entries of its schedules, looked up one by one."""

from bisect import bisect_right
from dataclasses import astuple, replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.inputs import InputSchedule, Profile, Schedule
from boreprop.case.paper import paper_case
from boreprop.core.quantities import ACTING, IN_SPACE_ONLY, ROCK
from boreprop.run.course import Course, acting, course_of
from boreprop.run.ground import on_rows
from boreprop.run.simulate import simulate


@st.composite
def profiles(draw: st.DrawFn) -> Profile:
    apart = draw(st.lists(st.integers(1, 40), max_size=6))
    lengths = tuple((np.cumsum([0, *apart]) / 4).tolist())
    values = draw(st.lists(st.floats(-1e5, 1e5), min_size=len(lengths), max_size=len(lengths)))
    return Profile(lengths, tuple(values), draw(st.booleans()))


def looked_up(profile: Profile, length: float) -> float:
    """The input at a length, after a jump there."""
    if profile.linear:
        return float(np.interp(length, profile.drilled_length, profile.values))
    return profile.values[bisect_right(profile.drilled_length, length) - 1]


@given(st.lists(profiles(), min_size=1, max_size=3), st.lists(st.floats(0.0, 70.0), max_size=10))
def test_every_input_is_what_its_own_entries_say(given_: list[Profile], lengths: list[float]) -> None:
    named = {f"input {i}": profile for i, profile in enumerate(given_)}
    course = Course.of(named)
    starts = {length for profile in given_ for length in profile.drilled_length}
    assert course.starts.tolist() == sorted(starts)
    at = np.array([*lengths, *starts])
    piece = (np.searchsorted(course.starts, at, side="right") - 1).astype(np.intc)
    expected = [[looked_up(profile, length) for profile in given_] for length in at.tolist()]
    found = np.column_stack([course.column(name, at, piece) for name in named])
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-7)


def scheduled(case: Case) -> Case:
    inputs = (("active_weight_on_bit", (2e3, 4e3)), ("rate_of_penetration", (0.01, 0.02)))
    schedule = Schedule((0.0, 2.0, 6.0), (0.0, 1e3, 1e3), "linear")
    return replace(case, schedule=schedule, inputs=InputSchedule((0.0, 4.0), inputs, "linear"))


def test_what_an_engine_is_given_does_not_hold_the_rate_of_penetration() -> None:
    course = course_of(scheduled(paper_case()))
    assert course.names == ("rss_force", "active_weight_on_bit", *ROCK, "rate_of_penetration")
    assert course.starts.tolist() == [0.0, 2.0, 4.0, 6.0]
    inputs, which = acting(course, np.array([0.0, 3.0]), np.array([0, 1], dtype=np.intc))
    given_ = inputs[which]
    ramps = ("rss_force", "active_weight_on_bit", *ROCK)
    assert ACTING == (*(name + end for name in ramps for end in ("", "_slope")), "weight_on_bit", *IN_SPACE_ONLY)
    assert given_[:, :4].tolist() == [[0.0, 500.0, 2e3, 500.0], [1e3, 0.0, 3500.0, 500.0]]
    rock = [number for value in astuple(paper_case().bit)[: len(ROCK)] for number in (value, 0.0)]
    assert given_[:, 4:].tolist() == [[*rock, *(0.0,) * (1 + len(IN_SPACE_ONLY))]] * 2


def test_a_run_has_a_column_for_each_input_that_its_case_schedules() -> None:
    run = simulate(scheduled(paper_case()), length=8.0, sample_interval=2.0)
    assert run["rss_force"].tolist() == [0.0, 1e3, 1e3, 1e3, 1e3]
    assert run["active_weight_on_bit"].tolist() == [2e3, 3e3, 4e3, 4e3, 4e3]
    assert run["rate_of_penetration"].tolist() == [0.01, 0.01, 0.02, 0.02, 0.02]  # always held


def test_rock_along_a_run_that_has_no_column_of_it_is_what_its_case_schedules() -> None:
    lengths = np.array([0.0, 1.0, 4.0, 7.0])
    schedule = InputSchedule((0.0, 4.0), (("bit_tilt_limit", (0.02, 0.01)),), "linear")
    case = replace(paper_case(), inputs=schedule)
    assert on_rows(case, {"drilled_length": lengths}, "bit_tilt_limit").tolist() == [0.02, 0.0175, 0.01, 0.01]

"""Flat names and a case: what is read from one is put into another."""

import pytest

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.inputs import Schedule
from boreprop.case.paper import paper_case
from boreprop.case.parameters import parameters, with_parameters
from boreprop.core.errors import ParameterError
from boreprop.errors import InputError
from places import EXAMPLES


@pytest.mark.parametrize("name", parameters(paper_case()))
def test_a_parameter_changes_and_no_other(name: str) -> None:
    before = parameters(paper_case())
    changed = with_parameters(paper_case(), {name: 0.99 * before[name] + (name == "rss_force")})
    after = parameters(changed)
    assert {key for key in before if before[key] != after[key]} == {name}


def test_a_force_takes_the_place_of_the_schedule_and_only_if_it_is_given(case: Case) -> None:
    assert with_parameters(case, {"rss_force": 5.0}).schedule == Schedule((0.0,), (5.0,))
    assert with_parameters(case, {}) == case


def test_what_is_no_parameter_or_out_of_range_is_refused(case: Case) -> None:
    with pytest.raises(InputError, match=r"must be one of rss_force, .*, got 'bit_tilt'"):
        with_parameters(case, {"bit_tilt": 0.0})
    with pytest.raises(ParameterError, match=r"stabilizer_clearance\[1\]: must be >= 0, got -1"):
        with_parameters(case, {"stabilizer_clearance[1]": -1.0})


def test_other_diameters_give_the_body_other_clearances() -> None:
    case = load_case(EXAMPLES / "pendulum.toml")
    wider = with_parameters(case, {"bit_diameter": 0.24, "section_outer_diameter[1]": 0.17})
    assert wider.bit_diameter == 0.24
    assert wider.bha.body_point_clearances == pytest.approx([(0.24 - 0.17) / 2] * 70)
    assert with_parameters(wider, {"bit_diameter": 0.2286, "section_outer_diameter[1]": 0.1778}) == case


def test_clearances_of_the_body_that_are_given_by_hand_stay() -> None:
    case = load_case(EXAMPLES / "pendulum.toml")
    by_hand = with_parameters(case, {"body_point_clearance[2]": 0.01})
    wider = with_parameters(by_hand, {"bit_diameter": 0.24, "body_point_clearance[3]": 0.02})
    first, second, third, fourth, *_ = wider.bha.body_point_clearances
    assert (second, third) == (0.01, 0.02)
    assert first == fourth == pytest.approx((0.24 - 0.1778) / 2)

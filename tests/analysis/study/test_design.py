"""What a study is made of: parameters that vary, grids, samples."""

from dataclasses import replace
from math import radians
from typing import Any

import numpy as np
import pytest
import scipy.stats

from boreprop.analysis.study.design import grid, sample, vary
from boreprop.case.paper import paper_case
from boreprop.case.parameters import parameters
from boreprop.core.system import eta_pi
from boreprop.errors import InputError, ParameterError
from studies import UNCERTAIN


@pytest.mark.parametrize("name", parameters(paper_case()))
def test_a_varied_parameter_changes_and_no_other(name: str) -> None:
    case = paper_case()
    before = parameters(case)
    value = 1.01 * before[name] + (name == "rss_force")
    assert parameters(vary(case, {name: value})) == {**before, name: value}


def test_eta_pi_is_reached_by_the_weight_with_the_other_values_in_place() -> None:
    case = vary(paper_case(), {"eta_pi": 0.05, "lateral_steering_resistance": 20.0, "stabilizer_position[1]": 3.0})
    assert eta_pi(case.bha, case.bit, case.active_weight_on_bit) == pytest.approx(0.05)
    assert case.bit.lateral_steering_resistance == 20.0


def test_angles_can_be_given_in_degrees() -> None:
    assert vary(paper_case(), {"bit_tilt_limit_deg": 1.5}).bit.tilt_limit == radians(1.5)
    sensed = replace(paper_case(), bha=replace(paper_case().bha, sensor_positions=(1.0, 2.0)))
    assert vary(sensed, {"sensor_bias[2]_deg": 0.5}).bha.sensor_biases == (0.0, radians(0.5))


def test_a_toolface_reference_is_one_of_those_there_are() -> None:
    in_space = replace(paper_case(), dimensions=3)
    assert vary(in_space, {"toolface_reference": 1}).schedule.toolface_reference == ("north",)
    with pytest.raises(ParameterError, match="toolface_reference: must be <= 2, got 3"):
        vary(in_space, {"toolface_reference": 3})


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["stabilizer_clearance[2]"], r"must be one of .*stabilizer_clearance\[1\].*, got 'stabilizer_clearance\[2\]'"),
        (["bit_tilt"], "must be one of .*, got 'bit_tilt'"),
        (["eta_pi", "active_weight_on_bit"], "active_weight_on_bit: must be varied under one name, got eta_pi, active"),
    ],
)
def test_names_that_cannot_be_varied_are_refused_before_anything_is_computed(names: list[str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        grid(paper_case(), {name: [1.0] for name in names})


@pytest.mark.parametrize("axis", [[], [[1.0]], 1.0, "0.1"])
def test_an_axis_must_be_a_list_of_numbers(axis: Any) -> None:
    with pytest.raises(ParameterError, match=r"eta_pi(: must be a list|\[1\]: must be a number)"):
        grid(paper_case(), {"eta_pi": axis})


def test_a_grid_has_an_axis() -> None:
    with pytest.raises(InputError, match="at least one axis"):
        grid(paper_case(), {})


def test_a_sample_follows_its_distributions() -> None:
    values = sample(paper_case(), UNCERTAIN, 2000, seed=1).values
    for column, distribution in zip(values.T, UNCERTAIN.values(), strict=True):
        assert scipy.stats.kstest(column, distribution.cdf).pvalue > 0.01
    assert abs(np.mean(np.prod(scipy.stats.zscore(values), axis=1))) < 0.06  # their correlation


def test_a_sample_follows_from_its_seed() -> None:
    first, again, other = (sample(paper_case(), UNCERTAIN, 20, seed).values for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    assert not np.isin(first, other).any()


def test_a_larger_sample_of_more_parameters_keeps_the_draws() -> None:
    small = sample(paper_case(), UNCERTAIN, 20, seed=1)
    more = {"rss_force": scipy.stats.norm(), **UNCERTAIN}
    assert np.array_equal(sample(paper_case(), more, 30, seed=1).values[:20, 1:], small.values)


def test_a_distribution_that_draws_no_numbers_is_refused() -> None:
    with pytest.raises(InputError, match="eta_pi: must be drawn from a distribution of finite numbers, got nan"):
        sample(paper_case(), {"eta_pi": scipy.stats.norm(1.0, -1.0)}, 5, seed=1)

"""The kinks ahead: the lattice of images of each jump in the hole."""

import json
from math import factorial, inf

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from boreprop.core import radau
from boreprop.core.kinks import Kinks, harm_of
from boreprop.core.options import Options

S = (1.0, 1.7, 2.9)
GAINS = [1.0, 1.0, 1.0]
ANY = (1.0, 1.0, 1.0, 1.0)  # harm
NOWHERE_NEAR = 1e-12

places = st.lists(st.floats(0.0, 50.0), min_size=1, max_size=6, unique=True)


def taken(kinks: Kinks, xi: float) -> int | None:
    return kinks.kink_here(xi, NOWHERE_NEAR)


@given(places)
def test_each_jump_comes_back_once_at_every_stabilizer(jumps: list[float]) -> None:
    kinks = Kinks(S)
    for xi in sorted(jumps):
        kinks.add_images(xi, 1, 0.1)
    met, at = [], kinks.next_kink(-1.0, inf, GAINS, ANY, 0.0)
    while at < inf:
        met.append(at)
        assert taken(kinks, at) == 2
        at = kinks.next_kink(at, inf, GAINS, ANY, 0.0)
    images = sorted({xi + s_i for xi in jumps for s_i in S})
    for image in images:
        assert min(abs(image - at) for at in met) <= 1e-9
    assert len(met) <= len(images)


def test_jumps_at_one_place_add_up() -> None:
    kinks = Kinks(S)
    kinks.add_images(2.0, 1, 3e-3)
    kinks.add_images(2.0, 1, 4e-3)
    assert [kink.xi for kink in kinks.ahead] == [2.0 + s_i for s_i in S]
    assert [kink.jump for kink in kinks.ahead] == pytest.approx([7e-3] * 3)


def test_the_lowest_derivative_of_those_at_one_place_counts() -> None:
    kinks = Kinks((1.0, 2.0))
    kinks.add_images(1.0, 3, 0.1)  # passes stabilizer 2 where
    kinks.add_images(2.0, 1, 0.1)  # this one passes stabilizer 1
    assert taken(kinks, 2.0) == 4
    assert taken(kinks, 3.0) == 2


def test_jumps_in_smoother_derivatives_are_not_kept() -> None:
    kinks = Kinks(S)
    kinks.add_images(0.0, 4, 1.0)
    assert kinks.ahead == []


def test_a_step_may_pass_over_a_jump_that_changes_it_by_less_than_the_tolerance() -> None:
    """By (2h)²/2 times the jump of Y' at a stabilizer, times the gain there, before the law changes."""
    kinks, harm = Kinks((1.0,)), harm_of(0.2, 0.1, False)
    kinks.add_images(0.0, 1, 1e-3)
    change = 5.0 * 1e-3 * 0.4**2 / 2
    assert kinks.next_kink(0.9, 0.4, [5.0], harm, 1.01 * change) == inf
    assert kinks.next_kink(0.9, 0.4, [5.0], harm, 0.99 * change) == 1.0


@given(places, st.floats(1e-3, 10.0))
def test_among_many_kinks_a_step_goes_as_far_as_any_of_half_the_length_or_less(jumps: list[float], h: float) -> None:
    """And it passes none that it must not."""
    kinks, options = Kinks(S), Options()
    kinks.many = True
    for xi in sorted(jumps):
        kinks.add_images(xi, 1, 1e-3)
    lengths = [h / 2**k for k in range(40)]
    length, way = kinks.reach(0.5, h, GAINS, options)
    harm = harm_of(length, options.theta_weight, True)
    assert kinks.next_kink(0.5, min(length, way), GAINS, harm, options.relative_tolerance) == inf
    for other in lengths:
        harm = harm_of(other, options.theta_weight, True)
        far = kinks.next_kink(0.5, 2 * other, GAINS, harm, options.relative_tolerance) - 0.5
        assert min(length, way) >= min(other, far) / 2


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("theta_weight", [0.0, 10.0])
def test_a_kink_harms_a_step_by_what_collocation_errs_over_it(order: int, theta_weight: float) -> None:
    """The largest error of a polynomial through the Radau nodes, and of its integral, by brute force."""
    h, largest = 0.3, 0.0
    nodes = np.delete(np.array(radau.POINTS), radau.AT_CHECK)
    t = np.linspace(0.0, 1.0, 801)
    for start in np.linspace(0.0, 1.0, 401):
        interpolation = Polynomial.fit(nodes, np.maximum(nodes - start, 0.0) ** order, len(nodes) - 1, domain=[-1, 1])
        wave, integral = np.maximum(t - start, 0.0) ** order, np.maximum(t - start, 0.0) ** (order + 1) / (order + 1)
        missed = np.abs(wave - interpolation(t)).max() * h**order * theta_weight
        largest = max(largest, missed, np.abs(integral - interpolation.integ(lbnd=0.0)(t)).max() * h ** (order + 1))
    exact = largest / factorial(order)
    assert harm_of(h, theta_weight, True)[order] == pytest.approx(min(exact, harm_of(h, 0.0, False)[order]), rel=0.02)


def test_saved_kinks_are_the_same_after_a_journey_through_json() -> None:
    kinks, other = Kinks(S), Kinks(S)
    kinks.add_images(0.0, 1, 0.1)
    kinks.add_images(0.4, 2, 0.2)
    other.restore(json.loads(json.dumps(kinks.save())))
    kinks.add_images(0.4, 2, 0.3)
    other.add_images(0.4, 2, 0.3)
    assert other.ahead == kinks.ahead

"""Crossings of the imaginary axis account for the unstable roots."""

import os
import subprocess
import sys
from dataclasses import replace
from itertools import accumulate
from math import radians

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from boreprop.analysis.stability.any_beam import AnyBeam
from boreprop.analysis.stability.characteristic import Crossings, zero_between
from boreprop.analysis.stability.chart import (
    respaced,
    unstable_roots,
)
from boreprop.analysis.stability.roots import NEUTRAL, Verdict, critical_eta_pi, find_roots, rightmost_roots
from boreprop.core.system import BitRock, BottomHoleAssembly, Scaled, scale
from pseudospectral import LinearMode
from stability import BIT, LONG, PAPER, contacts, drilling, inclinations
from systems import scaled_systems


@settings(deadline=None, max_examples=60)
@given(scaled_systems(), contacts, st.booleans(), inclinations, st.lists(st.floats(-2.5, 1.0), min_size=4, max_size=4))
def test_the_roots_counted_for_the_chart_are_those_that_are_found(
    scaled: Scaled, contact: list[int], saturated: bool, inclination: float, log_eta_pi: list[float]
) -> None:
    characteristic = AnyBeam.of_the_paper(scaled).characteristic(
        tuple(contact[: len(scaled.y_star)]), saturated, inclination
    )
    assume(not 0.0 < abs(characteristic.m_g) < 1e-6)  # so little weight that rounding decides
    grid = 10 ** np.sort(log_eta_pi)
    for at, total, real in zip(grid, *unstable_roots(characteristic, grid), strict=True):
        found = np.array(rightmost_roots(characteristic, float(at), 0.0))
        assume(not ((abs(found.real) > NEUTRAL / 1e3) & (abs(found.real) < 1e-6)).any())
        unstable = found[found.real > NEUTRAL]
        assert real == np.count_nonzero(unstable.imag == 0)
        assert total == real + 2 * np.count_nonzero(unstable.imag > 0)


@settings(deadline=None, max_examples=25)
@given(scaled_systems(min_n=2))
def test_a_system_in_contact_oscillates_below_its_critical_eta_pi_and_not_above(scaled: Scaled) -> None:
    bha = BottomHoleAssembly(scaled.s, scaled.y_star, scaled.Delta, 3 * scaled.w, 1.0)  # ℓ₁ = 1, F* = 3
    bit = BitRock(1.0, scaled.epsilon, scaled.psi_star)
    critical = critical_eta_pi(drilling(bha, bit))
    assert critical is not None
    every = range(1, len(scaled.s))
    for factor, oscillates in ((0.999, True), (1.001, False), (1.5, False), (5.0, False)):
        found = find_roots(drilling(bha, bit), factor * critical.eta_pi, contact=every)
        assert (found.verdict is Verdict.OSCILLATORY) == oscillates
    nearest = min(find_roots(drilling(bha, bit), critical.eta_pi, contact=every).roots, key=lambda root: abs(root.real))
    if nearest.imag:  # else it is the weight's
        assert nearest == pytest.approx(critical.frequency * 1j, abs=1e-8)


NEAR_BIT = BottomHoleAssembly((1.2, 5.10859, 14.60859), (1.5875e-3, 1.5875e-3), 0.6, 1830.0, 17.3e6)


@st.composite
def assemblies(draw: st.DrawFn) -> BottomHoleAssembly:
    """Any number of stabilizers up to 40 ℓ₁ from the bit, and such as have the first one right behind the bit."""
    if draw(st.booleans()):
        spans, first = st.floats(3.5, 9.5), draw(st.floats(0.8, 2.0))
        n = draw(st.integers(2, 4))
    else:
        spans, first = st.floats(-0.5, 1.1).map(lambda power: 3.66 * 10**power), 3.66
        n = draw(st.integers(1, 6))
    positions = tuple(accumulate([first, *(draw(spans) for _ in range(n - 1))]))
    assume(positions[-1] < 40 * first)
    stiffness, weight = 10 ** draw(st.floats(6.5, 7.6)), draw(st.floats(500.0, 3000.0))
    return BottomHoleAssembly(positions, (1e-3,) * (n - 1), first / 4, weight, stiffness)


@pytest.mark.parametrize("second", [5.10859, 5.1054, 5.1351, 7.0378])
def test_where_the_equation_for_the_crossings_is_nearly_zero_there_is_no_crossing_for_that(second: float) -> None:
    bha = replace(NEAR_BIT, stabilizer_positions=(1.2, second, second + 9.5))
    critical = critical_eta_pi(drilling(bha, BIT), inclination=radians(30.0))
    assert critical is not None
    assert critical.wavelength < 5.0  # not some hundred metres
    for factor, expected in ((0.999, True), (1.001, False), (2.0, False), (9.0, False)):
        found = find_roots(drilling(bha, BIT), factor * critical.eta_pi, contact=(1, 2), inclination=radians(30.0))
        assert (found.verdict is Verdict.OSCILLATORY) == expected


@settings(deadline=None, max_examples=25, derandomize=True)
@given(assemblies(), contacts, st.booleans(), inclinations, st.floats(0.01, 0.2))
def test_at_a_critical_eta_pi_a_pair_of_roots_leaves_the_right_half_plane_for_good(
    bha: BottomHoleAssembly, contact: list[int], saturated: bool, inclination: float, epsilon: float
) -> None:
    bit = BitRock(20.0, 20.0 * epsilon, 0.02)
    scaled, touching = scale(bha, bit), tuple(contact[: len(bha.stabilizer_clearances)])
    mode = LinearMode.of(scaled, touching, saturated, inclination)
    numbers = [i for i, touches in enumerate(touching, 1) if touches]
    critical = critical_eta_pi(drilling(bha, bit), contact=numbers, saturated=saturated, inclination=inclination)
    least = critical.eta_pi if critical else 0.02
    assume(mode.top(least) * scaled.s[-1] < 3e4)
    characteristic = AnyBeam.of_the_paper(scaled).characteristic(touching, saturated, inclination)
    assume(not 0.0 < abs(characteristic.m_g) < 1e-6)  # so little weight that rounding decides
    if critical:
        assert mode.unstable(0.9999 * least, mode.top(0.9999 * least)) >= 2
        assert abs(mode.determinant(np.array([1j * critical.frequency]), least))[0] < 1e-9
    for factor in (1.0001, 1.01, 2.0, 10.0):
        assert mode.unstable(factor * least, mode.top(factor * least)) <= 1


@settings(deadline=None, max_examples=40, derandomize=True)
@given(assemblies(), contacts, inclinations, st.floats(0.01, 0.2), st.floats(-2.0, 0.0))
def test_the_crossings_account_for_every_unstable_root(
    bha: BottomHoleAssembly, contact: list[int], inclination: float, epsilon: float, log_eta_pi: float
) -> None:
    scaled, eta_pi = scale(bha, BitRock(20.0, 20.0 * epsilon, 0.02)), 10**log_eta_pi
    touching = tuple(contact[: len(scaled.y_star)])
    mode = LinearMode.of(scaled, touching, False, inclination)
    characteristic = AnyBeam.of_the_paper(scaled).characteristic(touching, False, inclination)
    assume(mode.top(eta_pi) * scaled.s[-1] < 3e4)
    near_zero = mode.determinant(np.array([1e-9, 1e-5], complex), eta_pi).real
    assume(near_zero[0] * near_zero[1] > 0 or not characteristic.m_g)
    crossings = characteristic.crossings(eta_pi)
    assume(crossings.eta_pi.min(initial=1.0) / eta_pi > 1 + 1e-5)
    assert unstable_roots(characteristic, np.array([eta_pi]))[0][0] == mode.unstable(eta_pi, mode.top(eta_pi))


def test_zeros_are_found_to_rounding_where_secants_alone_creep() -> None:
    """The cube is so flat at one end that false position without halving would need thousands of steps."""
    cubes = np.array([1e-6, 1.0, 8.0, 1e6])
    roots, none = np.cbrt(cubes), np.zeros(4)
    for a, b in ((none, 20 * roots), (20 * roots, none), (roots, 2 * roots), (none, roots)):
        np.testing.assert_allclose(zero_between(lambda x: x**3 - cubes, a, b), roots, rtol=1e-15)


def test_two_crossings_that_are_about_to_vanish_are_both_found() -> None:
    """Where an edge of the chart turns back two crossings meet; they are found until they are next to each other."""

    def crossings(lambda2: float) -> Crossings:
        found = AnyBeam.of(respaced(PAPER.bha, lambda2), PAPER.bit).characteristic((1,)).crossings(0.03)
        return Crossings(*(column[found.omega < 5.8] for column in found))

    both, neither = 2.165, 2.175
    assert (len(crossings(both).eta_pi), len(crossings(neither).eta_pi)) == (2, 0)
    while neither - both > 1e-8:
        middle = (both + neither) / 2
        both, neither = (middle, neither) if len(crossings(middle).eta_pi) == 2 else (both, middle)
    assert np.ptp(crossings(both).omega) < 1e-2  # a sample to each 0.06
    assert sorted(crossings(both).direction) == [-1, 1]


def test_a_long_assembly_takes_little_memory() -> None:
    resource = pytest.importorskip("resource")  # not on Windows
    program = f"""
import resource
from dataclasses import replace
resource.setrlimit(resource.RLIMIT_AS, ({2**30}, {2**30}))
from boreprop import find_roots, paper_case
from boreprop.core.system import BitRock, BottomHoleAssembly
case = replace(paper_case(), bha={LONG!r}, bit={BIT!r})
for contact in ((), (2, 3), (1, 2, 3)):
    print(len(find_roots(case, 0.0146, contact=contact, inclination=0.5).roots))
"""
    assert resource
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # each thread claims memory that it does not use
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment, timeout=60)
    assert run.returncode == 0, run.stderr
    assert all(int(line) > 0 for line in run.stdout.split())


@pytest.mark.parametrize("contact", [(), (2, 3), (1, 2, 3)])
def test_the_roots_of_a_long_assembly_are_all_there(contact: tuple[int, ...]) -> None:
    found = np.array(find_roots(drilling(LONG, BIT), 0.0146, contact=contact, inclination=0.5).roots)
    touching = tuple(int(i in contact) for i in (1, 2, 3))
    mode = LinearMode.of(scale(LONG, BIT), touching, False, 0.5)
    for abscissa in (1e-7, -0.05):
        counted = mode.unstable(0.0146, 300.0, abscissa)
        assert np.where(found.imag > 0, 2, 1)[found.real > abscissa].sum() == counted

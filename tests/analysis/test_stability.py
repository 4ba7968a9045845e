"""Roots, verdicts, the critical ηΠ and the chart: against the paper's numbers, a discretisation and simulations."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from itertools import accumulate
from math import log, pi, radians
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from matplotlib.colors import to_rgb
from matplotlib.image import imread
from scipy.optimize import brentq

from boreprop.analysis.stability.characteristic import Characteristic, Crossings
from boreprop.analysis.stability.chart import (
    DRIFT,
    OSCILLATORY,
    VERDICTS,
    Chart,
    respaced,
    stability_chart,
    unstable_roots,
    usual_grid,
)
from boreprop.analysis.stability.contacts import all_contacts, can_touch, charted, contacts_met, steady_mode
from boreprop.analysis.stability.roots import NEUTRAL, Verdict, critical_eta_pi, find_roots, rightmost_roots, verdict
from boreprop.analysis.stability.zeros import Strip, find_zeros
from boreprop.arrays import Complexes
from boreprop.case.case import Case
from boreprop.case.paper import paper_case
from boreprop.core.errors import ParameterError
from boreprop.core.modes import Regime
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly, Scaled, scale
from boreprop.report.figures.stability import SHADES, boundaries, draw
from conftest import Command, assert_refused
from pseudospectral import LinearMode
from systems import begin, scaled_systems

PAPER = paper_case()


def drilling(bha: BottomHoleAssembly, bit: BitRock) -> Case:
    """A drilling system in a vertical hole."""
    return replace(PAPER, bha=bha, bit=bit, survey=Survey((0.0, 1.0), (0.0, 0.0)))


VERTICAL = drilling(PAPER.bha, PAPER.bit)

contacts = st.lists(st.integers(0, 1), min_size=5, max_size=5)
inclinations = st.one_of(st.sampled_from([0.0, pi / 2, pi]), st.floats(0.0, 3.0))


@pytest.mark.parametrize(
    ("eta_pi", "contact", "saturated", "expected", "meaning"),
    [
        (0.01, (), False, [-0.220693], "stable"),
        (0.01, (1,), False, [0.313087 + 18.174473j, 0.308927 + 24.320988j], "oscillatory"),
        (0.01, (), True, [0.002447], "drift"),
        (0.01, (1,), True, [0.000610], "drift"),
        (0.1, (1,), False, [0.167821 + 4.953061j], "oscillatory"),
    ],
)
def test_the_rightmost_roots_of_the_paper_s_case(
    eta_pi: float, contact: tuple[int, ...], saturated: bool, expected: list[complex], meaning: str
) -> None:
    found = find_roots(VERTICAL, eta_pi, contact=contact, saturated=saturated)
    assert found.roots[: len(expected)] == pytest.approx(expected, abs=1e-6)
    assert found.verdict == meaning


def test_the_critical_eta_pi_of_the_paper_s_case() -> None:
    critical = critical_eta_pi(VERTICAL)
    assert critical is not None
    assert critical.eta_pi == pytest.approx(0.146757, abs=1e-6)
    assert critical.frequency == pytest.approx(4.715348, abs=1e-6)
    assert critical.wavelength == pytest.approx(1.3325 * 3.66, abs=3e-4)


def test_the_critical_frequency_without_weight_and_angular_resistance_solves_tan_w_equals_w() -> None:
    bha = replace(PAPER.bha, distributed_weight=0.0)
    critical = critical_eta_pi(drilling(bha, replace(PAPER.bit, angular_steering_resistance=1e-9)))
    assert critical is not None
    assert critical.eta_pi == pytest.approx(0.19595014747, abs=1e-8)
    assert critical.frequency == pytest.approx(brentq(lambda w: np.tan(w) - w, 4.4, 4.6), abs=1e-7)


def test_without_contact_the_paper_s_case_never_oscillates() -> None:
    assert critical_eta_pi(VERTICAL, contact=()) is None
    assert critical_eta_pi(VERTICAL, saturated=True) is None


@settings(deadline=None, max_examples=40)
@given(scaled_systems(), contacts, st.booleans(), inclinations, st.floats(-1.0, 0.5))
def test_roots_are_the_eigenvalues_of_the_discretised_equations(
    scaled: Scaled, contact: list[int], saturated: bool, inclination: float, log_eta_pi: float
) -> None:
    touching, eta_pi = tuple(contact[: len(scaled.y_star)]), 10**log_eta_pi
    mode = LinearMode.of(scaled, touching, saturated, inclination)
    top, nodes = 20.0, int(40 + 14 * scaled.s[-1])
    found = np.array(rightmost_roots(Characteristic.of(scaled, touching, saturated, inclination), eta_pi))
    eigenvalues = mode.roots(eta_pi, nodes)
    assume(abs(eigenvalues.real + 0.5).min() > 1e-3)  # none on the edge
    assume(abs(abs(eigenvalues.imag) - top).min() > 1e-3)
    eigenvalues = eigenvalues[(eigenvalues.real > -0.5) & (abs(eigenvalues.imag) < top)]
    found = found[(found.real > -0.5) & (found.imag < top)]
    pairs = np.concatenate([found, found[found.imag > 0].conj()])
    assert len(eigenvalues) == len(pairs)
    if len(pairs):
        distance = abs(eigenvalues[:, None] - pairs)
        assert max(distance.min(axis=0).max(), distance.min(axis=1).max()) < 1e-5  # near multiple roots; else 1e-10


@settings(deadline=None, max_examples=60)
@given(scaled_systems(), contacts, st.booleans(), inclinations, st.floats(-2.0, 1.0))
def test_roots_are_polished(
    scaled: Scaled, contact: list[int], saturated: bool, inclination: float, log_eta_pi: float
) -> None:
    touching, eta_pi = tuple(contact[: len(scaled.y_star)]), 10**log_eta_pi
    mode = LinearMode.of(scaled, touching, saturated, inclination)
    found = np.array(rightmost_roots(Characteristic.of(scaled, touching, saturated, inclination), eta_pi))
    found = found[abs(found) > 1e-3]  # nearer to zero the average over 1/ν is not to be trusted
    apart = abs(found[:, None] - np.concatenate([found, found.conj()]))
    found = found[np.where(apart == 0, 1.0, apart).min(axis=1, initial=1.0) > 0.01]
    slope = (mode.determinant(found + 1e-5, eta_pi) - mode.determinant(found - 1e-5, eta_pi)) / 2e-5
    assert (abs(mode.determinant(found, eta_pi) / slope) < 1e-10).all()


def test_many_roots_of_a_stiff_system_are_all_found() -> None:
    found = np.array(find_roots(VERTICAL, 2e-3, contact=[1]).roots)
    line = -0.5 + 1j * np.arange(-15000.0, 15000.0, 0.01)
    phase = np.unwrap(np.angle(LinearMode.of(scale(PAPER.bha, PAPER.bit), (1,), False, 0.0).determinant(line, 2e-3)))
    # far out P ~ ν: half a turn on the way back round the right half plane
    assert round((pi - (phase[-1] - phase[0])) / (2 * pi)) == np.where(found.imag > 0, 2, 1).sum()
    assert len(found) > 150


def test_where_no_root_lies_right_of_the_abscissa_the_next_ones_are_given() -> None:
    characteristic = Characteristic.of(Scaled((1.0,), (), 0.2, 0.01, 0.1, 0.03), (), False)
    assert rightmost_roots(characteristic, 1e-3) == pytest.approx([-0.53831458 + 5.37098080j])
    assert rightmost_roots(characteristic, 1e-3, -1.5)[0] == pytest.approx(-0.53831458 + 5.37098080j)


def product(zeros: list[complex], nu: Complexes) -> tuple[Complexes, Complexes]:
    """Π (ν − z) and its slope."""
    value, slope = np.ones_like(nu), np.zeros_like(nu)
    for zero in zeros:
        value, slope = value * (nu - zero), slope * (nu - zero) + value
    return value, slope


@pytest.mark.parametrize(
    "zeros",
    [
        [],
        [0.3],
        [0.3, 0.3, -0.1 + 2j, -0.1 + 2j],
        [0.3, 0.3 + 1e-5, 0.1 + 1e-3j],
        [0.2 + 3j, 0.2 + 3.001j, 0.2 + 3.002j, 0.0],
    ],
    ids=["none", "one", "double", "near each other", "three near each other"],
)
def test_zeros_are_found_as_often_as_they_are_there(zeros: list[complex]) -> None:
    all_of_them = [-3.0, *zeros, *(z.conjugate() for z in map(complex, zeros) if z.imag)]
    found = find_zeros(
        lambda nu: product(all_of_them, nu),
        lambda x, y: product(all_of_them, x + 1j * y[:, None])[0],
        Strip(-0.5, 2.0, 6.0),
        margin=0.1,
        spacing=0.25,
    )
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(np.array(zeros, complex)), abs=1e-7)


def test_a_zero_that_cannot_be_found_is_missed_by_the_count() -> None:
    with pytest.raises(ArithmeticError, match="1 more zeros lie in"):
        find_zeros(
            lambda nu: (nu - 1.0, np.full_like(nu, 1e-3)),  # a slope that leads Newton's method astray
            lambda x, y: np.asarray(x + 1j * y[:, None] - 1.0, complex),
            Strip(-0.5, 2.0, 2.0),
            margin=0.1,
            spacing=0.25,
        )


@pytest.mark.parametrize(
    ("roots", "meaning"),
    [
        ((), "stable"),
        ((-0.1, -0.2 + 3j), "stable"),
        ((NEUTRAL / 2, -0.1), "stable"),
        ((0.1, -0.2 + 3j), "drift"),
        ((0.3, 0.1 + 3j), "oscillatory"),
    ],
)
def test_verdicts(roots: tuple[complex, ...], meaning: str) -> None:
    assert verdict(roots) == meaning


def simulated(
    scaled: Scaled, eta_pi: float, bend: float, F_rss: float, xi: np.ndarray
) -> tuple[np.ndarray, set[Regime]]:
    """Θ at each ξ in a vertical hole that bends by `bend` at its end, and the regimes on the way."""
    model = begin(scaled, Survey((-1.0, 0.0), (0.0, bend)), F_rss, eta_pi, 1e-10)
    inclinations, modes = [], set()
    for at in xi:
        model.advance(float(at))
        inclinations.append(model.inclination())
        modes.add(model.regime)
    return np.array(inclinations), modes


def fitted(signal: np.ndarray, step: float, order: int) -> complex:
    """ν of a signal that is a sum of `order` terms e^{νξ}, of the one with the largest Im ν (Prony)."""
    rows = np.lib.stride_tricks.sliding_window_view(signal, order + 1)
    recurrence = np.linalg.lstsq(rows[:, :-1], -rows[:, -1], rcond=None)[0]
    terms = np.log(np.roots([1.0, *recurrence[::-1]]) + 0j) / step
    return complex(terms[np.argmax(terms.imag)])


LOOSE = Scaled((1.0, 2.0), (1.0,), 0.16, 0.05, 0.1, 1.0)  # never touches, never saturates
TIGHT = replace(LOOSE, y_star=(0.0,))  # always touches


@pytest.mark.parametrize(
    ("scaled", "eta_pi", "order"),
    [(LOOSE, 0.17, 1), (LOOSE, 1.5, 1), (TIGHT, 0.1, 3), (TIGHT, 0.17, 3)],
    ids=["decays", "drifts", "oscillates and grows", "oscillates and decays"],
)
def test_small_disturbances_grow_and_oscillate_as_the_roots_say(scaled: Scaled, eta_pi: float, order: int) -> None:
    step = 0.25
    signal, modes = simulated(scaled, eta_pi, 1e-4, 0.0, np.arange(15.0, 30.0, step))
    contact = int(scaled is TIGHT)
    assert modes == {((contact,), 0)}
    roots = rightmost_roots(Characteristic.of(scaled, (contact,), False), eta_pi)
    expected = max(roots[:2], key=lambda root: root.imag)
    assert fitted(signal, step, order) == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("scaled", [LOOSE, TIGHT], ids=["no contact", "contact"])
def test_with_saturated_tilt_two_runs_part_as_the_rightmost_root_says(scaled: Scaled) -> None:
    step, xi = 0.5, np.arange(15.0, 30.0, 0.5)
    saturating = replace(scaled, psi_star=1e-6)
    signals = []
    for bend in (1e-3, 2e-3):
        signal, modes = simulated(saturating, 0.1, bend, 0.002, xi)
        assert len(modes) == 1
        assert modes.pop()[1] != 0
        signals.append(signal)
    expected = rightmost_roots(Characteristic.of(scaled, (int(scaled is TIGHT),), True), 0.1)[0]
    assert fitted(signals[1] - signals[0], step, 1) == pytest.approx(expected, abs=1e-3)


@settings(deadline=None, max_examples=60)
@given(scaled_systems(), contacts, st.booleans(), inclinations, st.lists(st.floats(-2.5, 1.0), min_size=4, max_size=4))
def test_the_roots_counted_for_the_chart_are_those_that_are_found(
    scaled: Scaled, contact: list[int], saturated: bool, inclination: float, log_eta_pi: list[float]
) -> None:
    characteristic = Characteristic.of(scaled, tuple(contact[: len(scaled.y_star)]), saturated, inclination)
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
LONG = BottomHoleAssembly((0.6193, 6.6906, 10.0877, 18.8639), (1e-3,) * 3, 0.3, 1500.0, 1e7)
BIT = BitRock(20.0, 1.0, radians(1.0))


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
    characteristic = Characteristic.of(scaled, touching, saturated, inclination)
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
    characteristic = Characteristic.of(scaled, touching, False, inclination)
    assume(mode.top(eta_pi) * scaled.s[-1] < 3e4)
    near_zero = mode.determinant(np.array([1e-9, 1e-5], complex), eta_pi).real
    assume(near_zero[0] * near_zero[1] > 0 or not characteristic.m_g)
    crossings = characteristic.crossings(eta_pi)
    assume(crossings.eta_pi.min(initial=1.0) / eta_pi > 1 + 1e-5)
    assert unstable_roots(characteristic, np.array([eta_pi]))[0][0] == mode.unstable(eta_pi, mode.top(eta_pi))


def test_two_crossings_that_are_about_to_vanish_are_both_found() -> None:
    """Where an edge of the chart turns back two crossings meet; they are found until they are next to each other."""
    scaled = scale(PAPER.bha, PAPER.bit)

    def crossings(lambda2: float) -> Crossings:
        found = Characteristic.of(respaced(scaled, lambda2), (1,), False).crossings(0.03)
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


@pytest.fixture(scope="module")
def chart() -> Chart:
    return stability_chart(VERTICAL, np.linspace(0.005, 0.6, 60), np.linspace(0.5, 2.4, 39))


def test_the_panels_of_the_chart_are_the_four_modes_with_the_verdicts_of_their_roots(chart: Chart) -> None:
    assert [(panel.contact, panel.saturated) for panel in chart.panels] == [
        ((1,), False),
        ((1,), True),
        ((), False),
        ((), True),
    ]
    rng = np.random.default_rng(1)
    for panel in chart.panels:
        assert panel.verdicts.shape == (39, 60)
        for _ in range(25):
            i, j = rng.integers(39), rng.integers(60)
            first, second = PAPER.bha.stabilizer_positions[0], PAPER.bha.stabilizer_positions[0] * chart.lambda2[i]
            moved = drilling(replace(PAPER.bha, stabilizer_positions=(first, first + second)), PAPER.bit)
            found = find_roots(moved, float(chart.eta_pi[j]), contact=panel.contact, saturated=panel.saturated)
            assert VERDICTS[panel.verdicts[i, j]] is found.verdict


def test_every_verdict_is_in_the_chart_of_the_paper_s_case(chart: Chart) -> None:
    assert {VERDICTS[code] for panel in chart.panels for code in np.unique(panel.verdicts)} == set(Verdict)
    oscillating = [(panel.verdicts == OSCILLATORY).any() for panel in chart.panels]
    assert oscillating == [True, False, False, False]


def test_stabilizers_beyond_the_second_keep_their_distance_from_it() -> None:
    scaled = Scaled((1.0, 1.8, 3.0), (0.0, 0.0), 0.2, 0.0, 0.1, 0.03)
    assert respaced(scaled, 0.5).s == pytest.approx((1.0, 1.5, 2.7))


def test_on_the_boundaries_of_the_chart_a_root_is_on_the_imaginary_axis(chart: Chart) -> None:
    for panel, least in zip(chart.panels, (100, 10, 10, 0), strict=True):
        points = np.concatenate([np.empty((0, 2)), *boundaries(chart, panel)])
        points = points[~np.isnan(points[:, 0])]
        assert len(points) >= least
        points = points[np.isin(points[:, 1], chart.lambda2)]  # between those the lines are straight
        for at, lambda2 in points[:: len(points) // 20 + 1]:
            scaled = respaced(scale(PAPER.bha, PAPER.bit), lambda2)
            contact = (int(bool(panel.contact)),)
            roots = rightmost_roots(Characteristic.of(scaled, contact, panel.saturated), float(at))
            assert min(abs(root.real) for root in roots) < 1e-3


def test_a_drift_of_the_chart_doubles_as_fast_as_its_root_says(chart: Chart) -> None:
    free_saturated = chart.panels[3]
    assert (free_saturated.verdicts == DRIFT).all()
    for i, j in ((0, 0), (20, 3), (38, 59)):
        first = PAPER.bha.length_scale
        bha = replace(PAPER.bha, stabilizer_positions=(first, first * (1 + chart.lambda2[i])))
        [root, *_] = find_roots(drilling(bha, PAPER.bit), float(chart.eta_pi[j]), saturated=True).roots
        assert free_saturated.doubling[i, j] == pytest.approx(log(2) / root.real * first, rel=0.2)
    for panel in chart.panels:
        assert (np.isnan(panel.doubling) == (panel.verdicts != DRIFT)).all()


THREE = BottomHoleAssembly((4.3, 12.5, 21.5), (1.6e-3, 3.2e-3), 0.75, 1964.0, 1.923e7)


def test_the_chart_of_three_stabilizers_has_all_their_modes() -> None:
    made = stability_chart(drilling(THREE, BIT), np.linspace(0.02, 0.4, 4), np.linspace(1.0, 2.0, 3), inclination=0.46)
    contacts = ((1, 2), (1,), (2,), ())
    assert [(panel.contact, panel.saturated) for panel in made.panels] == [
        (contact, saturated) for contact in contacts for saturated in (False, True)
    ]


def test_with_many_stabilizers_a_chart_has_four_contacts_and_the_one_that_holds_the_case() -> None:
    six = BottomHoleAssembly(tuple(np.arange(1.0, 7.0) * 5.0), (2e-3,) * 5, 0.7, 1500.0, 1e7)
    here, _ = steady_mode(drilled_by(six, BIT, 5e4), 0.0, 0.5)
    shown = charted(six, BIT, 0.5, first=here)
    assert len(shown) == 4
    assert shown[0] == (1, 2, 3, 4, 5)
    assert here in shown
    assert set(shown) <= {*contacts_met(six, BIT, 0.5), here, shown[0]}


@settings(deadline=None, max_examples=20, derandomize=True)
@given(st.floats(0.3, 20.0), st.sampled_from([0.0, 0.3, 1.0]), st.floats(-2e4, 2e4))
def test_a_blade_that_cannot_touch_adds_no_mode_to_a_chart(at: float, inclination: float, force: float) -> None:
    assume(abs(np.array(THREE.stabilizer_positions) - at).min() > 0.1)
    place = int(np.searchsorted(THREE.stabilizer_positions, at))
    idle = replace(
        THREE,
        stabilizer_positions=(*THREE.stabilizer_positions[:place], at, *THREE.stabilizer_positions[place:]),
        stabilizer_clearances=(*THREE.stabilizer_clearances[:place], 0.2, *THREE.stabilizer_clearances[place:]),
        rss_position=0.3,
    )

    def renumbered(contact: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(i + (i > place) for i in contact)

    without = replace(THREE, rss_position=0.3)
    assert can_touch(idle, BIT, inclination, [force]) == renumbered(can_touch(without, BIT, inclination, [force]))
    shown = charted(without, BIT, inclination, [force])
    assert charted(idle, BIT, inclination, [force]) == tuple(map(renumbered, shown))


def test_stabilizers_without_clearance_are_in_every_contact() -> None:
    assert all_contacts(replace(THREE, stabilizer_clearances=(0.0, 1e-3))) == ((1, 2), (1,))


def drilled_by(bha: BottomHoleAssembly, bit: BitRock, active_weight_on_bit: float) -> Case:
    return replace(PAPER, bha=bha, bit=bit, active_weight_on_bit=active_weight_on_bit)


def test_the_steady_mode_is_that_of_the_steady_response() -> None:
    assert steady_mode(drilled_by(THREE, BIT, 6e4), 0.0, 0.0) == ((), False)  # hangs straight
    easily_tilted = replace(BIT, tilt_limit=1e-6)
    contact, saturated = steady_mode(drilled_by(THREE, easily_tilted, 6e4), 2e4, radians(26.37))
    assert saturated
    assert contact in all_contacts(THREE)


def test_the_shades_of_the_chart_differ_in_lightness() -> None:
    lightness = sorted(np.dot(to_rgb(shade), (0.2126, 0.7152, 0.0722)) for shade in SHADES.values())
    assert min(np.diff(lightness)) > 0.1


def test_the_chart_s_picture_marks_the_case(chart: Chart) -> None:
    figure = draw(chart, PAPER)
    assert len(figure.axes) == 4
    for axes in figure.axes:
        assert axes.lines[-1].get_xydata() == pytest.approx(np.array([[0.01, 1.0]]), rel=1e-4)


def test_the_chart_s_picture_has_kilonewtons_and_metres_and_no_specks(chart: Chart) -> None:
    axes = draw(chart, PAPER).axes[0]
    across, up = axes.child_axes[0], draw(chart, PAPER).axes[1].child_axes[-1]
    assert across.get_xlabel() == "active weight on bit (kN)"
    assert up.get_ylabel() == "stabilizer 1 to 2 (m)"
    for line in boundaries(chart, chart.panels[0]):
        assert np.ptp(line, axis=0).max() > 0.05


def test_the_usual_grid_has_the_case_inside() -> None:
    far = replace(PAPER.bha, stabilizer_positions=(1.0, 9.0))
    for bha, at, lambda2 in ((PAPER.bha, 0.01, 1.0), (PAPER.bha, 3.0, 1.0), (far, 0.01, 8.0)):
        eta_pi, second = usual_grid(bha, at)
        assert eta_pi[0] < at < eta_pi[-1]
        assert second[0] < lambda2 < second[-1]
        assert (len(eta_pi), len(second)) == (300, 200)


def test_a_chart_over_lambda2_needs_two_stabilizers() -> None:
    single = BottomHoleAssembly((3.66,), (), 0.6, 1080.0, 7.2e6)
    with pytest.raises(ParameterError, match="must hold at least 2"):
        stability_chart(drilling(single, PAPER.bit), np.linspace(0.1, 1, 3), np.linspace(0.1, 1, 3))


def test_a_stabilizer_without_clearance_touches_in_every_mode() -> None:
    tight = replace(PAPER.bha, stabilizer_clearances=(0.0,))
    assert find_roots(drilling(tight, PAPER.bit), 0.1) == find_roots(VERTICAL, 0.1, contact=[1])


def test_more_roots_than_anybody_could_list_are_refused() -> None:
    with pytest.raises(ParameterError, match="abscissa: must be nearer to 0"):
        find_roots(drilling(LONG, BIT), 0.0146, contact=(1, 2, 3), abscissa=-1.0)


@pytest.mark.parametrize("wrong", [{"eta_pi": 0.0}, {"contact": [2]}, {"contact": [0]}, {"abscissa": 0.1}])
def test_values_out_of_range_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        find_roots(VERTICAL, **{"eta_pi": 0.1, **wrong})  # type: ignore[arg-type]


def test_roots_prints_json_rightmost_first(command: Command, paper_case: Path) -> None:
    arguments = ("--contact", "1", "--eta-pi", "0.01", "--inclination-deg", "0", "--json")
    result = command("boreprop", "roots", paper_case, *arguments)
    printed = json.loads(result.stdout)
    assert list(printed) == ["eta_pi", "mode", "roots", "verdict"]
    assert printed["eta_pi"] == 0.01
    assert printed["mode"] == {"contact": [1], "saturated": False}
    assert printed["roots"][0] == pytest.approx([0.313087, 18.174473], abs=1e-6)
    assert printed["verdict"] == "oscillatory"
    assert printed["roots"] == sorted(printed["roots"], key=lambda root: (-root[0], root[1]))
    assert all(imaginary >= 0 for _, imaginary in printed["roots"])


def test_roots_takes_eta_pi_and_the_inclination_from_the_case_and_no_contact(
    command: Command, paper_case: Path, case: Case
) -> None:
    printed = json.loads(command("boreprop", "roots", paper_case, "--saturated", "--json").stdout)
    found = find_roots(case, saturated=True)
    assert printed["roots"] == [[root.real, root.imag] for root in found.roots]
    assert printed["mode"] == {"contact": [], "saturated": True}


def test_roots_prints_a_line_for_each_mode(command: Command, paper_case: Path) -> None:
    result = command("boreprop", "roots", paper_case)
    lines = [line for line in result.stdout.splitlines() if "saturated" in line]
    assert len(lines) == 4
    for line, texts in zip(
        lines,
        [
            ("1 ", "not saturated", "oscillatory", "doubles in 8.1 m", "1.27 m", "drills so"),
            ("1 ", "saturated", "drift", "doubles in 4160 m"),
            ("none", "not saturated", "stable", "halves in 11.5 m"),
            ("none", "saturated", "drift", "doubles in 1040 m"),
        ],
        strict=True,
    ):
        assert all(text in line for text in texts)
    assert "1.612 kN" in result.stdout


def test_roots_prints_all_modes_as_json(command: Command, paper_case: Path) -> None:
    printed = json.loads(command("boreprop", "roots", paper_case, "--all", "--json").stdout)
    assert [(mode["mode"]["contact"], mode["mode"]["saturated"]) for mode in printed] == [
        ([1], False),
        ([1], True),
        ([], False),
        ([], True),
    ]
    one = json.loads(command("boreprop", "roots", paper_case, "--json").stdout)
    assert one == printed[2]


def test_roots_of_no_contact_asked_for_are_a_table(command: Command, paper_case: Path) -> None:
    result = command("boreprop", "roots", paper_case, "--contact", "")
    assert "no contact, bit tilt not saturated: stable" in result.stdout
    assert "-0.220685" in result.stdout


def test_roots_prints_a_table(command: Command, paper_case: Path) -> None:
    result = command("boreprop", "roots", paper_case, "--contact", "1")
    assert result.returncode == 0
    for text in ("oscillatory", "stabilizer 1 in contact", "0.313087", "18.174473", "1.27 m"):
        assert text in result.stdout


def test_stability_draws_a_picture_and_prints_the_critical_eta_pi(
    command: Command, paper_case: Path, tmp_path: Path
) -> None:
    ranges = ("--eta-pi", "0.02:0.3:8", "--lambda2", "0.5:2:6")
    result = command("boreprop", "stability", paper_case, "--output", "chart.png", *ranges)
    assert result.stderr == ""
    assert "8 × 6 points" in result.stdout
    assert "stabilizer 1 in contact: oscillatory up to ηΠ = 0.146757 (23.66 kN; waves of 4.88 m)" in result.stdout
    assert "no contact: never oscillatory" in result.stdout
    assert imread(tmp_path / "chart.png")[..., :3].std() > 0.05
    assert [path.name for path in tmp_path.iterdir()] == ["chart.png"]


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("roots", "--contact", "1,x"), ("--contact", "'1,x'")),
        (("roots", "--all", "--contact", "1"), ("--all", "--contact '1'")),
        (("roots", "--contact", "2"), ("contact", "1 to 1 here", "got 2")),
        (("roots", "--eta-pi", "1e-5"), ("eta_pi", "0.0001", "1e-05")),
        (("roots", "--inclination-deg", "nan"), ("--inclination-deg", "finite", "nan")),
        (("stability", "--output", "chart.pdf"), ("chart.pdf", ".png")),
        (("stability", "--output", "chart.png", "--eta-pi", "0:1:5"), ("--eta-pi", "START:STOP:COUNT", "'0:1:5'")),
        (("stability", "--output", "chart.png", "--lambda2", "1:2"), ("--lambda2", "START:STOP:COUNT", "'1:2'")),
    ],
)
def test_commands_refuse_what_they_cannot_use(
    command: Command, paper_case: Path, tmp_path: Path, arguments: tuple[str, ...], named: tuple[str, ...]
) -> None:
    assert_refused(command("boreprop", arguments[0], paper_case, *arguments[1:]), *named)
    assert not list(tmp_path.iterdir())

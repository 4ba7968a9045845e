"""Roots and critical ηΠ of modes: the equations discretised otherwise, simulations, the paper."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from boreprop.analysis.stability.any_beam import AnyBeam
from boreprop.analysis.stability.roots import NEUTRAL, critical_eta_pi, find_roots, rightmost_roots, verdict
from boreprop.core.errors import ParameterError
from boreprop.core.modes import Regime
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled, scale
from pseudospectral import LinearMode
from stability import BIT, LONG, PAPER, VERTICAL, contacts, drilling, inclinations
from systems import begin, scaled_systems


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
    found = np.array(
        rightmost_roots(AnyBeam.of_the_paper(scaled).characteristic(touching, saturated, inclination), eta_pi)
    )
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
    found = np.array(
        rightmost_roots(AnyBeam.of_the_paper(scaled).characteristic(touching, saturated, inclination), eta_pi)
    )
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
    characteristic = AnyBeam.of_the_paper(Scaled((1.0,), (), 0.2, 0.01, 0.1, 0.03)).characteristic(())
    assert rightmost_roots(characteristic, 1e-3) == pytest.approx([-0.53831458 + 5.37098080j])
    assert rightmost_roots(characteristic, 1e-3, -1.5)[0] == pytest.approx(-0.53831458 + 5.37098080j)


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
    roots = rightmost_roots(AnyBeam.of_the_paper(scaled).characteristic((contact,), False), eta_pi)
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
    expected = rightmost_roots(AnyBeam.of_the_paper(scaled).characteristic((int(scaled is TIGHT),), True), 0.1)[0]
    assert fitted(signals[1] - signals[0], step, 1) == pytest.approx(expected, abs=1e-3)


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

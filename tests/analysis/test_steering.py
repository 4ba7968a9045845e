"""Steering at constant curvature: the LCP (15), beams solved by hand."""

from bisect import bisect
from dataclasses import replace
from itertools import pairwise, product
from math import inf, pi, radians

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from boreprop.analysis.complementarity import lcp, residual
from boreprop.analysis.steering import (
    Line,
    Steady,
    build_rate_curve,
    holding_forces,
    largest_build_rate,
    reversal,
    steady_response,
)
from boreprop.case.case import Case
from boreprop.core.beam import Beam
from boreprop.core.errors import ParameterError
from boreprop.core.modes import Loads, Modes, Regime
from boreprop.core.quantities import MAX_STABILIZERS
from boreprop.core.system import BitRock, BottomHoleAssembly, Scaled
from boreprop.report.tables.steering import piece_lines
from steering_cases import DEGREES_PER_30_M, THREE, TWO, drilled, forces, saturating
from systems import scaled_systems


@st.composite
def steadies(draw: st.DrawFn) -> Steady:
    return Steady(draw(scaled_systems()), 10.0 ** draw(st.floats(-2.5, 1.0)), draw(st.floats(-pi, pi)))


@settings(max_examples=300, deadline=None)
@given(steadies(), forces)
def test_the_response_solves_the_model(steady: Steady, F: float) -> None:
    """(17), and the LCP (15) by its definition, in a hole Θ(−s) = −κ s made of its average inclinations."""
    scaled, beam = steady.scaled, Beam(steady.scaled)
    line = steady.line_at(F)
    kappa, psi = line.at(F)
    averages = [-kappa * (before + after) / 2 for before, after in pairwise((0.0, *scaled.s))]
    e = np.cumsum([lambda_ * (mean - psi) for lambda_, mean in zip(scaled.lambda_, averages, strict=True)]).tolist()
    at = Loads(e, F, steady.sine)
    forces = [row(at) for row in line.mode.F]
    assert beam.bit_moment(e[-1], forces, F, steady.sine) == pytest.approx(
        scaled.epsilon * steady.eta_pi * kappa, abs=1e-10
    )
    F_hat = 2 * (steady.eta_pi * psi - beam.bit_force(e[-1], forces, F, steady.sine))  # (12)
    z = [max(f, 0.0) for f in (*forces, F_hat)], [max(-f, 0.0) for f in (*forces, F_hat)]
    z_ordered = [*z[0][:-1], *z[1][:-1], z[0][-1], z[1][-1]]
    M, q = lcp(beam, scaled.y_star, scaled.psi_star, steady.eta_pi, at)
    assert residual(M, q, z_ordered) <= 1e-9


@settings(max_examples=60, deadline=None)
@given(steadies(), forces)
def test_no_other_mode_has_a_response(steady: Steady, F: float) -> None:
    """All modes tried: those that hold are one, or on a kink neighbours with the same response."""
    walls = [(-1, 0, 1) if y else (1,) for y in steady.scaled.y_star]
    candidates = [Line(steady, Regime(c, saturation)) for c in product(*walls) for saturation in (-1, 0, 1)]
    holding = [
        line
        for line in candidates
        if all(
            bound.lower - 1e-12 <= bound.scale * bound.row(line.loads(F)) <= bound.upper + 1e-12
            for bound in steady.bounds(line.regime)
        )
    ]
    assert holding
    for line in holding:
        assert line.at(F) == pytest.approx(steady.line_at(F).at(F), abs=1e-8)


@settings(max_examples=200, deadline=None)
@given(steadies(), forces)
def test_without_gravity_the_opposite_force_gives_the_opposite_response(steady: Steady, F: float) -> None:
    light = Steady(replace(steady.scaled, w=0.0), steady.eta_pi, 0.0)
    there, back = light.line_at(F).at(F), light.line_at(-F).at(-F)
    assert there == pytest.approx([-value for value in back], abs=1e-12)


@settings(max_examples=200, deadline=None)
@given(scaled_systems(), st.floats(0.01, 10.0), forces, st.floats(-3.0, 3.0))
def test_without_contact_saturation_and_gravity_the_response_is_proportional(
    scaled: Scaled, eta_pi: float, F: float, factor: float
) -> None:
    free = replace(scaled, w=0.0, y_star=(1e6,) * len(scaled.y_star), psi_star=1e6)
    steady = Steady(free, eta_pi, 0.0)
    expected = [factor * value for value in steady.line_at(F).at(F)]
    assert steady.line_at(factor * F).at(factor * F) == pytest.approx(expected, rel=1e-9, abs=1e-15)


@settings(max_examples=200, deadline=None)
@given(steadies(), st.floats(1e-4, 0.05), st.lists(st.floats(-1.0, 1.0), max_size=5))
def test_the_curve_is_continuous_and_is_the_response_to_each_force(
    steady: Steady, limit: float, parts: list[float]
) -> None:
    curve = list(steady.walk(-limit, limit))
    assert (curve[0][1], curve[-1][2]) == (-limit, limit)
    for (line, _, end), (next_line, begin, _) in pairwise(curve):
        assert begin == pytest.approx(end, abs=1e-12)
        assert line.at(end) == pytest.approx(next_line.at(end), abs=1e-9)
        assert line.regime != next_line.regime
    for F in [limit * part for part in parts]:
        line = next(line for line, _, end in curve if F <= end)
        assert line.at(F) == pytest.approx(steady.line_at(F).at(F), abs=1e-9)


@settings(max_examples=200, deadline=None)
@given(scaled_systems(), st.floats(-2.5, 1.5), st.data())
def test_the_response_to_a_force_changes_sign_at_the_reversal_only(
    scaled: Scaled, exponent: float, data: st.DataObject
) -> None:
    """Through zero, in any contact set; with the tilt saturated it is never positive."""
    steady = Steady(scaled, 10.0**exponent, 0.0)
    contact = steady.modes.touching(tuple(data.draw(st.sampled_from([0, 1])) for _ in scaled.y_star))
    zero = reversal(scaled, steady.modes[contact])
    assert zero > 0
    if min(scaled.Delta, 1 - scaled.Delta) > 1e-3 and abs(steady.eta_pi / zero - 1) > 1e-6:
        assert np.sign(Line(steady, Regime(contact, 0)).rate[0]) == np.sign(zero - steady.eta_pi)
    if zero < inf:
        at_zero = Line(Steady(scaled, zero, 0.0), Regime(contact, 0))
        assert at_zero.rate[0] == pytest.approx(0.0, abs=1e-10)
    assert Line(steady, Regime(contact, 1)).rate[0] <= 1e-12


def test_free_stabilizers_and_no_gravity_have_the_response_of_a_propped_cantilever() -> None:
    """κ = F (M_rss (ηΠ + 1/λ²) − F0_rss/λ) / (ηΠ (εηΠ + ε/λ² + 1/2)), from e_n = −ψλ − κλ²/2 by hand."""
    lambda_, Delta, epsilon, eta_pi, F = 2.7, 0.3, 0.07, 0.4, 1e-3
    M_rss = -Delta * (lambda_ - Delta) * (2 * lambda_ - Delta) / (2 * lambda_**2)
    F0_rss = -(2 * lambda_**3 - 3 * lambda_ * Delta**2 + Delta**3) / (2 * lambda_**3)
    numerator = M_rss * (eta_pi + 1 / lambda_**2) - F0_rss / lambda_
    kappa = F * numerator / (eta_pi * (epsilon * eta_pi + epsilon / lambda_**2 + 0.5))
    scaled = Scaled((1.0, lambda_), (10.0,), Delta, 0.0, epsilon, 1.0)
    assert Steady(scaled, eta_pi, 0.0).line_at(F).at(F)[0] == pytest.approx(kappa, rel=1e-12)


def test_the_reversal_of_free_stabilizers() -> None:
    for lambda_, Delta in product((1.3, 2.0, 5.0), (0.05, 0.164, 1.0)):
        scaled = replace(TWO, s=(1.0, lambda_), Delta=Delta)
        assert reversal(scaled, Modes(scaled)[(0,)]) == pytest.approx(2 / (Delta * (2 * lambda_ - Delta)))


def test_the_reversal_of_a_touching_stabilizer() -> None:
    """By the three-moment equations of a beam clamped at 0, held at 1, hinged at λ; EI = 1/3.

    Turned by 1 at the bit: m_0 = 4λ/(4λ−1) and the shear m_0 (1 + 1/(2λ)). Under a unit force at Δ = a, b = 1 − a:
    2 m_0 + m_1 = −ab(1+b) and m_0 + 2λ m_1 = −ab(1+a), and the bit bears b + m_1 − m_0.
    """
    for lambda_, a in product((1.3, 2.0, 5.0), (0.05, 0.164, 0.9)):
        b = 1 - a
        m_0, m_1 = np.linalg.solve(np.array([[2, 1], [1, 2 * lambda_]]), -a * b * np.array([1 + b, 1 + a]))
        turned = 4 * lambda_ / (4 * lambda_ - 1)
        expected = turned * (b + m_1 - m_0) / -m_0 - turned * (1 + 1 / (2 * lambda_))
        scaled = replace(TWO, s=(1.0, lambda_), Delta=a)
        for contact in ((1,), (-1,)):
            assert reversal(scaled, Modes(scaled)[contact]) == pytest.approx(expected)


def test_pads_at_the_bit_always_build() -> None:
    scaled = replace(THREE, Delta=0.0)
    assert {reversal(scaled, Modes(scaled)[contact]) for contact in product((0, 1), repeat=2)} == {inf}


@pytest.mark.parametrize("contact", [0, 1])
def test_a_simulated_push_to_the_high_side_drops_the_hole_above_the_reversal(contact: int) -> None:
    scaled = replace(TWO, w=0.0, y_star=(10.0,) if contact == 0 else (0.0,), psi_star=1.0)
    zero = reversal(scaled, Modes(scaled)[(contact,)])
    assert drilled(Modes(scaled), 1e-3, 0.95 * zero, 0.0, 100.0).curvature > 1e-6
    assert drilled(Modes(scaled), 1e-3, 1.05 * zero, 0.0, 100.0).curvature < -1e-6


def test_the_build_section_is_explained(build_section: Case) -> None:
    """What examples/README.md tells of the steering forces."""
    (holding,) = holding_forces(build_section, radians(53.43), 31e3)
    assert 2e3 <= holding.rss_force <= 2.5e3
    assert holding.stabilizer_contact == (1, 1)
    first = build_rate_curve(build_section, radians(53.43), 31e3)[0]
    assert first.start.stabilizer_contact == (1, 1)
    assert first.gain * 1e3 * DEGREES_PER_30_M == pytest.approx(0.19, abs=0.005)
    for inclination_deg in (26.37, 40.0, 53.43):
        built = steady_response(build_section, 12e3, radians(inclination_deg)).build_rate
        assert built * DEGREES_PER_30_M == pytest.approx(2.0, abs=0.2)


def test_the_largest_build_rate_is_where_the_tilt_saturates_if_the_limit_lies_beyond(case: Case) -> None:
    case = saturating(case)
    fastest, slowest = largest_build_rate(case, radians(60.0), 10e3)
    forces = np.linspace(-10e3, 10e3, 2001).tolist()
    rates = [steady_response(case, force, radians(60.0)).build_rate for force in forces]
    assert fastest.build_rate >= max(rates)
    assert slowest.build_rate <= min(rates)
    assert fastest.build_rate == pytest.approx(max(rates), rel=2e-3)
    assert slowest.build_rate == pytest.approx(min(rates), rel=2e-2)
    assert fastest.rss_force < 6e3
    assert fastest.bit_tilt == pytest.approx(-case.bit.tilt_limit)


def test_holding_forces_are_all_zeros_of_the_curve_the_smallest_first(case: Case) -> None:
    case = saturating(case)
    found = holding_forces(case, radians(60.0), 50e3)
    curve = build_rate_curve(case, radians(60.0), 50e3)
    changes = sum((piece.start.build_rate > 0) != (piece.end.build_rate > 0) for piece in curve)
    assert len(found) == changes == 3
    assert [abs(r.rss_force) for r in found] == sorted(abs(r.rss_force) for r in found)
    assert max(abs(r.build_rate) for r in found) < 1e-15


def test_no_force_within_a_small_limit_holds(build_section: Case) -> None:
    assert holding_forces(build_section, radians(53.43), 1e3) == ()


def test_without_gravity_no_force_is_needed(case: Case) -> None:
    assert steady_response(case, 0.0, 1.0, gravity=False).build_rate == 0.0
    assert steady_response(case, 5e3, 1.0, gravity=False) == steady_response(case, 5e3, 0.3, gravity=False)
    assert steady_response(case, 5e3, 1.0, gravity=False).build_rate_error == 0.0


def test_a_stabilizer_without_clearance_is_on_the_wall_that_bears_it(case: Case) -> None:
    tight = replace(case, bha=replace(case.bha, stabilizer_clearances=(0.0,)))
    for force, wall in ((-10e3, 1), (10e3, -1)):
        response = steady_response(tight, force, radians(40.0))
        assert response.stabilizer_contact == (wall,)
        assert np.sign(response.stabilizer_force[0]) == wall
    (line,) = piece_lines(build_rate_curve(tight, radians(40.0), 10e3))
    assert line[4] == "1 low/high"


@pytest.mark.parametrize(
    ("values", "named"),
    [((inf, 0.0), "rss_force"), ((0.0, inf), "inclination")],
)
def test_values_out_of_range_are_named(case: Case, values: tuple[float, float], named: str) -> None:
    with pytest.raises(ParameterError, match=named):
        steady_response(case, *values)


@settings(max_examples=100, deadline=None)
@given(scaled_systems(min_n=2), st.floats(-2.5, 1.0), st.floats(-pi, pi), st.floats(0.02, 0.98))
def test_a_blade_that_never_touches_changes_no_build_rate(
    case: Case, scaled: Scaled, exponent: float, inclination: float, place: float
) -> None:
    """Where it comes first it makes ℓ₁ shorter; so that the bit's moment, χ W ℓ₁² dθ/ds by (9), stays, χ changes."""
    l1 = 2.0
    positions, clearances = tuple(l1 * s for s in scaled.s), tuple(l1 * y for y in scaled.y_star)
    bha = BottomHoleAssembly(positions, clearances, 0.01 * l1, 1e3, 7.2e6)
    bit = BitRock(10.0, 10.0 * scaled.epsilon, scaled.psi_star)
    at = place * bha.stabilizer_positions[-1]
    assume(len(bha.stabilizer_positions) < MAX_STABILIZERS)
    assume(min(abs(at - position) for position in bha.stabilizer_positions) > 0.02)
    i = bisect(bha.stabilizer_positions, at)
    idle = replace(
        bha,
        stabilizer_positions=(*bha.stabilizer_positions[:i], at, *bha.stabilizer_positions[i:]),
        stabilizer_clearances=(*bha.stabilizer_clearances[:i], 1e3, *bha.stabilizer_clearances[i:]),
    )
    resistance = bit.angular_steering_resistance * (bha.length_scale / idle.length_scale) ** 2
    same_bit = replace(bit, angular_steering_resistance=resistance)
    weight = 10.0**exponent * bha.force_scale / bit.lateral_steering_resistance
    own_case, same_case = (
        replace(case, bha=b, bit=r, active_weight_on_bit=weight) for b, r in ((bha, bit), (idle, same_bit))
    )
    curves = [build_rate_curve(each, inclination, 30e3) for each in (own_case, same_case)]
    for own, same in zip(*curves, strict=True):
        assert same.start.build_rate == pytest.approx(own.start.build_rate, rel=1e-6, abs=1e-10)
        assert same.end.build_rate == pytest.approx(own.end.build_rate, rel=1e-6, abs=1e-10)
        assert same.end.rss_force == pytest.approx(own.end.rss_force, abs=1e-3)
        assert same.reversal_weight == pytest.approx(own.reversal_weight, rel=1e-6)


def test_a_case_of_numpy_numbers_steers_like_one_of_floats(case: Case) -> None:
    numbers = replace(case.bha, flexural_stiffness=np.float64(case.bha.flexural_stiffness))
    own, same = (steady_response(replace(case, bha=bha), 2e4, 0.5) for bha in (case.bha, numbers))
    assert same.stabilizer_contact == own.stabilizer_contact != (0,)
    assert same.build_rate == pytest.approx(own.build_rate, rel=1e-12)

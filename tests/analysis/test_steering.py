"""Steering at constant curvature: long simulations, the LCP (15), beams solved by hand, the command."""

import re
from bisect import bisect
from copy import copy
from dataclasses import replace
from itertools import pairwise, product
from math import degrees, inf, pi, radians, sin
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from matplotlib.image import imread

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
from boreprop.case.case import Case, Schedule
from boreprop.case.file import load_case
from boreprop.core.beam import Beam
from boreprop.core.errors import ParameterError
from boreprop.core.integrator import Integrator
from boreprop.core.modes import Loads, Mode, Modes, Regime, Row
from boreprop.core.options import Options
from boreprop.core.quantities import MAX_STABILIZERS
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly, Scaled, eta_pi, scale
from boreprop.report.figures.steering import draw
from boreprop.report.tables.steering import lines, piece_lines, summarize, warnings
from boreprop.run.simulate import simulate
from conftest import Command
from places import EXAMPLES
from reference_cases import CASES, at_the_bit, reference, start
from systems import scaled_systems

DEGREES_PER_30_M = degrees(30.0)
TWO = Scaled(s=(1.0, 2.0), y_star=(1e-3,), Delta=0.164, w=2.45e-3, epsilon=0.05, psi_star=0.03)
THREE = replace(TWO, s=(1.0, 1.9, 3.2), y_star=(1e-3, 2e-3))
FORCES = (-8e-3, -2e-3, 0.0, 5e-4, 2e-3, 8e-3)


@pytest.fixture(scope="module")
def build_section() -> Case:
    return load_case(EXAMPLES / "build_section.toml")


def saturating(case: Case) -> Case:
    """`case` at an ηΠ of about a half, where a small force brings the tilt to its limit."""
    return replace(case, bit=replace(case.bit, tilt_limit=radians(0.1)), active_weight_on_bit=90e3)


# long simulations


class End(NamedTuple):
    """Where a run has come to."""

    mean: float  # ⟨Θ⟩_1
    curvature: float
    values: dict[str, float]
    regime: Regime


def drilled(modes: Modes, F: float, eta_pi: float, inclination: float, length: float) -> End:
    """What a straight hole has become after `length`."""
    model = Integrator(modes, Survey((0.0,), (inclination,)), 1.0, F, eta_pi, Options(1e-11))
    h, Theta = 0.01, []
    for xi in (length - h, length + h, length):
        ahead = model.save()
        model.advance(xi)
        Theta.append(model.inclination())
        if xi > length:
            model.restore(ahead)
    mean = model.present.state(length)[1] - model.hole.Y(length - 1.0)
    return End(mean, (Theta[1] - Theta[0]) / (2 * h), at_the_bit(model), model.regime)


class FrozenGravity(Modes):
    """Modes on which the weight acts as in a hole of one inclination, whatever hole is drilled."""

    def __init__(self, scaled: Scaled, inclination: float) -> None:
        super().__init__(scaled)
        self.sine = sin(inclination)
        self.frozen: dict[tuple[int, ...], Mode] = {}

    def __getitem__(self, contact: tuple[int, ...]) -> Mode:
        if contact not in self.frozen:
            mode = self.frozen[contact] = copy(super().__getitem__(contact))
            mode.F, mode.delta = [self.freeze(row) for row in mode.F], [self.freeze(row) for row in mode.delta]
            mode.M, mode.F_0 = self.freeze(mode.M), self.freeze(mode.F_0)
            mode.bounds = [bound._replace(row=self.freeze(bound.row)) for bound in mode.bounds]
        return self.frozen[contact]

    def freeze(self, row: Row) -> Row:
        return replace(row, g=0.0, constant=row.constant + row.g * self.sine)


@pytest.mark.parametrize("F", FORCES)
@pytest.mark.parametrize("psi_star", [0.03, 0.002])
@pytest.mark.parametrize("scaled", [TWO, THREE, replace(THREE, y_star=(1.0, 1.0)), replace(THREE, y_star=(0.0, 2e-3))])
def test_a_long_run_under_frozen_gravity_ends_on_the_response(scaled: Scaled, psi_star: float, F: float) -> None:
    """There a constant curvature is exact: with contacts on each side and none, the tilt saturated and not."""
    inclination, scaled = 1.2, replace(scaled, psi_star=psi_star)
    end = drilled(FrozenGravity(scaled, inclination), F, 0.5, inclination, 300.0)
    line = Steady(scaled, 0.5, inclination).line_at(F)
    kappa, psi = line.at(F)
    assert end.regime == line.regime
    assert end.curvature == pytest.approx(kappa, rel=1e-6)
    assert end.values["psi"] == pytest.approx(psi, rel=1e-6)
    for i, row in enumerate(line.mode.F, 1):
        assert end.values[f"F_{i}"] == pytest.approx(row(line.loads(F)), rel=1e-6, abs=1e-12)


def test_those_runs_meet_every_kind_of_mode() -> None:
    lines = [
        Steady(replace(s, psi_star=p), 0.5, 1.2).line_at(F) for s in (TWO, THREE) for p in (0.03, 2e-3) for F in FORCES
    ]
    met = {(line.regime.contact[0], line.regime.saturation) for line in lines}
    assert met >= {(1, 0), (0, 0), (-1, 0), (1, 1), (0, -1)}


@pytest.mark.parametrize("scaled", [TWO, THREE, replace(THREE, psi_star=0.002)])
@pytest.mark.parametrize("F", [-4e-3, 4e-3])
@pytest.mark.parametrize("inclination", [0.3, 1.0])
def test_under_real_gravity_the_error_of_the_response_is_what_it_says(
    scaled: Scaled, F: float, inclination: float
) -> None:
    """To a twentieth of the error, itself below a hundredth: together within 1e-6 of the run's curvature."""
    end = drilled(Modes(scaled), F, 0.5, inclination, 30.0)
    line = Steady(scaled, 0.5, end.mean).line_at(F)
    kappa = line.at(F)[0]
    error = end.curvature - kappa
    assert error == pytest.approx(line.error_rate * kappa, rel=0.05)
    assert abs(error) < 1e-2 * abs(kappa)
    assert end.curvature == pytest.approx(kappa * (1 + line.error_rate), abs=1e-6)


@pytest.mark.parametrize("inclination_deg", [10.0, 53.43, 90.0, 120.0])
@pytest.mark.parametrize("saturated", [False, True])
def test_a_hole_under_its_holding_force_stays_straight(case: Case, saturated: bool, inclination_deg: float) -> None:
    """An exact equilibrium of the whole model: started on it, nothing moves."""
    case, inclination = saturating(case), radians(inclination_deg)
    found = holding_forces(case, inclination, 50e3)
    response = next(r for r in found if bool(r.bit_tilt_saturation) == saturated)
    assert response.build_rate == pytest.approx(0.0, abs=1e-15)
    F, pi_ = response.rss_force / case.bha.force_scale, eta_pi(case.bha, case.bit, case.active_weight_on_bit)
    straight = Survey((0.0,), (inclination,))
    model = Integrator(Modes(scale(case.bha, case.bit)), straight, 1.0, 0.0, pi_, Options(1e-10))
    state = model.save()
    theta = (inclination + response.bit_tilt, *state["step"].theta[1:])
    model.restore(state | {"step": state["step"]._replace(theta=theta)})
    model.drill(20.0, F, pi_)
    assert model.inclination() == pytest.approx(inclination, abs=1e-6)
    assert at_the_bit(model)["psi"] == pytest.approx(response.bit_tilt, abs=1e-6)


@pytest.mark.parametrize("name", ["fig7_psi_0.1deg", "fig8_clearance_1.5e-3", "fig8_clearance_2e-3"])
def test_reference_runs_that_die_out_end_on_the_response(name: str) -> None:
    rows, p = reference(name), CASES[name]
    mean = rows["Y"][-1] - np.interp(rows["xi"][-1] - 1.0, rows["xi"], rows["Y"])
    line = Steady(start(name).scaled, p["eta_pi"], mean).line_at(0.0)
    kappa, psi = line.at(0.0)
    assert (rows["Theta"][-1] - rows["Theta"][-3]) / (rows["xi"][-1] - rows["xi"][-3]) == pytest.approx(kappa, abs=1e-6)
    assert rows["psi"][-1] == pytest.approx(psi, abs=1e-6)


@pytest.mark.parametrize("length", [5.0, 12.0, 20.0])
def test_the_steered_reference_run_comes_close_to_each_response(length: float) -> None:
    """It has 5 to 8 ℓ₁ for each force, in which transients die out to a few thousandths."""
    rows, p = reference("steering_two_stabilizers"), CASES["steering_two_stabilizers"]
    rows = rows[rows["xi"] < length - 1e-9]
    F = [f for at, f in zip(p["force_breaks"], p["force_values"], strict=True) if at < length][-1]
    mean = rows["Y"][-1] - np.interp(rows["xi"][-1] - 1.0, rows["xi"], rows["Y"])
    line = Steady(start("steering_two_stabilizers").scaled, p["eta_pi"], mean).line_at(F)
    kappa, psi = line.at(F)
    curvature = (rows["Theta"][-1] - rows["Theta"][-3]) / (rows["xi"][-1] - rows["xi"][-3])
    assert curvature == pytest.approx(kappa, rel=6e-3)
    assert rows["psi"][-1] == pytest.approx(psi, rel=6e-3)
    assert rows["F_1"][-1] == pytest.approx(line.mode.F[0](line.loads(F)), rel=6e-3)


def test_a_simulated_case_builds_at_the_rate_in_si_units(build_section: Case) -> None:
    """Tilt and contact forces of the response have an error of their own as gravity changes, here up to 22 N."""
    case = replace(build_section, schedule=Schedule((0.0,), (12e3,)))
    run = simulate(case, sample_interval=0.05, length=250.0, relative_tolerance=1e-10)
    mean = float(run["average_inclination[1]"][-2])
    response = steady_response(case, 12e3, mean)
    rate = (run["borehole_inclination"][-1] - run["borehole_inclination"][-3]) / 0.1
    assert rate == pytest.approx(response.build_rate + response.build_rate_error, rel=2e-5)
    assert run["bit_tilt"][-2] == pytest.approx(response.bit_tilt, rel=1e-3)
    assert response.stabilizer_contact == tuple(run.stack("stabilizer_contact")[-2])
    assert response.stabilizer_force == pytest.approx(run.stack("stabilizer_force")[-2], abs=30.0)
    assert response.stabilizer_deflection == pytest.approx(run.stack("stabilizer_deflection")[-2], abs=1e-6)


# what the model says, by other ways


@st.composite
def steadies(draw: st.DrawFn) -> Steady:
    return Steady(draw(scaled_systems()), 10.0 ** draw(st.floats(-2.5, 1.0)), draw(st.floats(-pi, pi)))


forces = st.floats(-0.02, 0.02)


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
            for bound in line.regime.bounds(steady.modes, steady.eta_pi)
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


# forces and limits


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


# the table, the picture, the command


def test_the_table_warns_near_and_beyond_the_reversal_and_where_the_tilt_is_at_its_limit(case: Case) -> None:
    scaled = scale(case.bha, case.bit)
    zero = reversal(scaled, Modes(scaled)[(0,)])
    weight = zero * case.bha.force_scale / case.bit.lateral_steering_resistance
    for part, where in ((0.7, ""), (0.9, "close to"), (1.1, "above")):
        curve = build_rate_curve(replace(case, active_weight_on_bit=part * weight), radians(60.0), 5e3)
        told = f"ηΠ is {where} {zero:.3g} ({weight / 1e3:.2f} kN of active weight on bit)"
        assert [told in text for text in warnings(curve, part * zero)] == ([True] if where else [])
    case = saturating(case)
    curve = build_rate_curve(case, radians(60.0), 16e3)
    assert [text.partition(" kN")[0] for text in warnings(curve, 0.558)] == ["-16.00…+0.98", "+5.57…+16.00"]


def test_the_table_has_the_numbers_in_kilonewtons_and_degrees(build_section: Case) -> None:
    summary = summarize(build_section, radians(53.43), 31e3)
    told = dict(lines(summary))
    assert told["force that holds the inclination"] == f"{summary.holding[0].rss_force / 1e3:+.2f} kN"
    free = summary.free.build_rate * DEGREES_PER_30_M
    assert told["build rate without force"] == f"{free:+.2f} °/30 m, on a wall: 1 low, 2 low"
    pieces = piece_lines(summary.curve)
    assert pieces[1][0] == "+15.20…+18.29"
    assert [line[4] for line in pieces] == ["1 low, 2 low", "2 low", "1 high, 2 low"]
    weight_per_eta_pi = build_section.active_weight_on_bit / summary.eta_pi
    for line, piece in zip(pieces, summary.curve, strict=True):
        weight = piece.reversal_eta_pi * weight_per_eta_pi
        assert line[5] == f"{weight / 1e3:.4g} ({piece.reversal_eta_pi:.3g})"


def test_unless_told_the_table_is_for_the_end_of_the_hole(case: Case) -> None:
    curved = replace(case, survey=Survey((0.0, 30.0), (0.2, 0.6)))
    assert dict(lines(summarize(curved)))["inclination at which the weight acts"] == f"{degrees(0.6):.2f} °"
    assert dict(lines(summarize(curved, 0.4)))["inclination at which the weight acts"] == f"{degrees(0.4):.2f} °"


@pytest.mark.parametrize(
    ("forces", "limit"), [((0.0,), 30e3), ((0.0, -4e3, 3e3), 4e3), ((-50e3,), 50e3)], ids=["none", "small", "large"]
)
def test_unless_told_the_forces_are_those_of_the_schedule_or_thirty_kilonewtons(
    case: Case, forces: tuple[float, ...], limit: float
) -> None:
    near_bit = replace(case.bha, stabilizer_positions=(1.2, 7.32))
    schedule = Schedule(tuple(10.0 * k for k in range(len(forces))), forces)
    for bha in (case.bha, near_bit):
        curve = summarize(replace(case, bha=bha, schedule=schedule)).curve
        assert (curve[0].start.rss_force, curve[-1].end.rss_force) == pytest.approx((-limit, limit))


@pytest.mark.parametrize("inclination_deg", [0.0, 90.0, 180.0])
def test_where_gravity_leaves_nothing_out_the_table_prints_no_rounding(
    build_section: Case, inclination_deg: float
) -> None:
    told = dict(lines(summarize(build_section, radians(inclination_deg))))
    left_out = told["left out: gravity changes along the arc"]
    assert re.fullmatch(r"(less than 0\.01|up to \d+\.\d\d) °/30 m", left_out)
    assert "-0.00" not in " ".join(told.values())


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


def test_the_picture_is_of_the_curve_in_kilonewtons_and_degrees(build_section: Case) -> None:
    summary = summarize(build_section, radians(53.43), 31e3)
    rates, tilts = draw(summary).axes
    for panel, of, factor in ((rates, "build_rate", DEGREES_PER_30_M), (tilts, "bit_tilt", degrees(1.0))):
        drawn = [np.asarray(line.get_xydata()) for line in panel.lines]
        for piece in summary.curve:
            ends = [[end.rss_force / 1e3, factor * getattr(end, of)] for end in (piece.start, piece.end)]
            assert any(line.shape == (2, 2) and np.allclose(line, ends) for line in drawn)


def test_the_command_prints_the_table_and_draws_only_if_asked(command: Command, tmp_path: Path) -> None:
    case_file = EXAMPLES / "build_section.toml"
    result = command("boreprop", "steering", case_file, "--inclination-deg", "53.43")
    assert (result.returncode, result.stderr) == (0, "")
    assert "+2.15 kN" in result.stdout
    assert not list(tmp_path.iterdir())
    result = command("boreprop", "steering", case_file, "--force-limit", "20e3", "--output", "steering.png")
    assert (result.returncode, result.stderr) == (0, "")
    assert "±20.00 kN" in result.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["steering.png"]
    assert imread(tmp_path / "steering.png")[..., :3].std() > 0.05


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--output", "steering.pdf"), (".png", "'.pdf'")),
        (("--force-limit", "-5"), ("--force-limit", "> 0", "'-5'")),
        (("--inclination-deg", "nan"), ("--inclination-deg", "finite", "nan")),
    ],
)
def test_the_command_refuses_a_wrong_argument(
    command: Command, tmp_path: Path, arguments: tuple[str, str], named: tuple[str, ...]
) -> None:
    result = command("boreprop", "steering", EXAMPLES / "build_section.toml", *arguments)
    assert (result.returncode, result.stdout, len(result.stderr.splitlines())) == (2, "", 1)
    for name in named:
        assert name in result.stderr
    assert not list(tmp_path.iterdir())


def test_a_case_of_numpy_numbers_steers_like_one_of_floats(case: Case) -> None:
    numbers = replace(case.bha, flexural_stiffness=np.float64(case.bha.flexural_stiffness))
    own, same = (steady_response(replace(case, bha=bha), 2e4, 0.5) for bha in (case.bha, numbers))
    assert same.stabilizer_contact == own.stabilizer_contact != (0,)
    assert same.build_rate == pytest.approx(own.build_rate, rel=1e-12)

"""Steering at constant curvature: where long simulations end."""

from copy import copy
from dataclasses import replace
from math import radians, sin

import numpy as np
import pytest

from boreprop.analysis.steering import (
    Steady,
    holding_forces,
    steady_response,
)
from boreprop.case.case import Case
from boreprop.case.inputs import Schedule
from boreprop.core.integrator import Integrator
from boreprop.core.modes import Mode, Modes, Row
from boreprop.core.options import Options
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled, eta_pi, scale
from boreprop.run.simulate import simulate
from reference_cases import CASES, at_the_bit, reference, start
from steering_cases import THREE, TWO, drilled, saturating

FORCES = (-8e-3, -2e-3, 0.0, 5e-4, 2e-3, 8e-3)


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
    model.steer(F, pi_)
    model.advance(20.0)
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

"""Outputs of each engine along random runs against a finite-element beam and Lemke's solution of the LCP (15)."""

from math import radians

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from boreprop.analysis.complementarity import lcp
from boreprop.core.beam import Beam
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled
from element_beam import ElementBeam, well_spaced
from engine_runs import begin, columns, loads_of
from lemke import lemke
from systems import scaled_systems

SURVEY = Survey((0.0, 1.0), (0.5, 0.5 + radians(0.5)))
WEIGHTS, FORCES = st.floats(0.005, 2.0), st.floats(-3e-3, 3e-3)


def outputs_along(engine: str, scaled: Scaled, F_rss: float, eta_pi: float) -> list[dict[str, float | int]]:
    """The outputs at a few places."""
    got = columns(begin(engine, scaled, SURVEY, F_rss, eta_pi), np.array([0.0, 0.7, 3.0]), F_rss, eta_pi)
    return [dict(zip(got, row, strict=True)) for row in np.array(list(got.values())).T.tolist()]


@settings(max_examples=40)
@given(scaled_systems(), WEIGHTS, FORCES)
def test_contact_forces_and_tilt_solve_the_contact_problem(
    engine: str, scaled: Scaled, eta_pi: float, F_rss: float
) -> None:
    m = len(scaled.y_star)
    for outputs in outputs_along(engine, scaled, F_rss, eta_pi):
        M, q = lcp(Beam(scaled), scaled.y_star, scaled.psi_star, eta_pi, loads_of(scaled, outputs, F_rss))
        z = np.array(lemke(M, q))
        forces = [outputs[f"stabilizer_force[{i}]"] for i in range(1, m + 1)]
        assert forces == pytest.approx(z[:m] - z[m : 2 * m], abs=1e-8)
        assert outputs["bit_tilt"] == pytest.approx((np.array(M) @ z + q)[2 * m] - scaled.psi_star, abs=1e-8)


@settings(max_examples=40)
@given(scaled_systems(), WEIGHTS, FORCES)
def test_the_reactions_at_the_bit_and_the_deflections_are_those_of_a_finite_element_beam(
    engine: str, scaled: Scaled, eta_pi: float, F_rss: float
) -> None:
    middle = scaled.s[-1] / 2
    assume(well_spaced(scaled, middle))
    for outputs in outputs_along(engine, scaled, F_rss, eta_pi):
        at = loads_of(scaled, outputs, F_rss)
        forces = [float(outputs[f"stabilizer_force[{i}]"]) for i in range(1, len(scaled.s))]
        beam = ElementBeam(scaled, at, forces, middle)
        assert outputs["bit_lateral_force"] == pytest.approx(beam.bit_force, abs=1e-8)
        assert outputs["bit_moment"] == pytest.approx(-beam.bit_moment, abs=1e-8)
        for i, s_i in enumerate(scaled.s[:-1]):
            deflection = outputs[f"stabilizer_deflection[{i + 1}]"]
            assert deflection == pytest.approx(at.e[i] + beam.at(s_i), abs=1e-8)


@settings(max_examples=25)
@given(scaled_systems(), WEIGHTS, FORCES)
def test_the_drilled_inclination_is_that_of_the_bit_less_its_tilt(
    engine: str, scaled: Scaled, eta_pi: float, F_rss: float
) -> None:
    """Eq. (16); and the average over the first span is its integral, but for what the trapezoidal rule leaves."""
    run = begin(engine, scaled, SURVEY, F_rss, eta_pi, relative_tolerance=1e-9)
    got = columns(run, np.linspace(0.0, 2.0, 201), F_rss, eta_pi)
    Theta, average = got["borehole_inclination"], got["average_inclination[1]"]
    assert Theta == pytest.approx(got["bit_inclination"] - got["bit_tilt"], abs=1e-15)
    last = Theta[100:]
    trapezoid = (last.sum() - (last[0] + last[-1]) / 2) / 100
    assert average[-1] == pytest.approx(trapezoid, abs=np.abs(np.diff(Theta)).sum() / 100 + 1e-6)

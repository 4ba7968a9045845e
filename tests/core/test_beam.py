"""The beam's closed-form coefficients against a finite-element beam (cubic elements, exact at the nodes)."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from boreprop.core.beam import Beam, flexibility
from boreprop.core.modes import Loads
from boreprop.core.system import Scaled
from element_beam import EI, ElementBeam, well_spaced
from systems import loads, scaled_systems


@st.composite
def loaded_beams(draw: st.DrawFn) -> tuple[Scaled, Loads, list[float], float]:
    scaled = draw(scaled_systems())
    contact = [draw(st.floats(-0.02, 0.02)) for _ in scaled.y_star]
    return scaled, draw(loads(len(scaled.s))), contact, draw(st.floats(0.05, 0.95)) * scaled.s[-1]


@settings(max_examples=200, deadline=None)
@given(loaded_beams())
def test_deflection_moment_and_force_are_those_of_a_finite_element_beam(
    beam: tuple[Scaled, Loads, list[float], float],
) -> None:
    scaled, at, contact, extra = beam
    assume(well_spaced(scaled, extra))
    model, elements = Beam(scaled), ElementBeam(scaled, at, contact, extra)
    tolerance = 1e-9
    shape = model.shape(extra, at.e[-1], contact, at.F_rss, at.sin_Theta_1)
    assert shape == pytest.approx(elements.at(extra), abs=tolerance)
    q = model.q_tilde(at.e, at.F_rss, at.sin_Theta_1)
    for i, s_i in enumerate(scaled.s[:-1]):
        delta = q[i] + sum(k * F for k, F in zip(model.K_inv[i], contact, strict=True))
        assert delta == pytest.approx(at.e[i] + elements.at(s_i), abs=tolerance)
    assert model.bit_force(at.e[-1], contact, at.F_rss, at.sin_Theta_1) == pytest.approx(
        elements.bit_force, abs=tolerance
    )
    assert model.bit_moment(at.e[-1], contact, at.F_rss, at.sin_Theta_1) == pytest.approx(
        elements.bit_moment, abs=tolerance
    )


@given(scaled_systems(min_n=2))
def test_flexibility_is_symmetric_and_positive_definite(scaled: Scaled) -> None:
    K_inv = np.array(Beam(scaled).K_inv)
    assert np.array_equal(K_inv, K_inv.T)
    assert np.linalg.eigvalsh(K_inv).min() > 0


def test_flexibility_of_a_cantilever_propped_at_its_end() -> None:
    # a unit force in the middle of a propped cantilever of length 2: 7 P L³ / (768 EI), from tables of beams
    assert flexibility(1.0, 1.0, 2.0) == pytest.approx(7 * 2**3 / (768 * EI))


def test_a_force_pushes_the_beam_its_own_way() -> None:
    beam = Beam(Scaled((1.0, 2.0), (1e-3,), 0.2, 0.0, 0.1, 0.03))
    assert beam.shape(0.5, 0.0, [0.0], 1e-3, 0.0) > 0

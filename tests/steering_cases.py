"""Cases that are steered in several test files."""

from dataclasses import replace
from math import degrees, radians
from typing import NamedTuple

import pytest
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.core.integrator import Integrator
from boreprop.core.modes import Modes, Regime
from boreprop.core.options import Options
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled
from places import EXAMPLES
from reference_cases import at_the_bit

DEGREES_PER_30_M = degrees(30.0)
TWO = Scaled(s=(1.0, 2.0), y_star=(1e-3,), Delta=0.164, w=2.45e-3, epsilon=0.05, psi_star=0.03)
THREE = replace(TWO, s=(1.0, 1.9, 3.2), y_star=(1e-3, 2e-3))


@pytest.fixture(scope="module")
def build_section() -> Case:
    return load_case(EXAMPLES / "build_section.toml")


def saturating(case: Case) -> Case:
    """`case` at an ηΠ of about a half, where a small force brings the tilt to its limit."""
    return replace(case, bit=replace(case.bit, tilt_limit=radians(0.1)), active_weight_on_bit=90e3)


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


forces = st.floats(-0.02, 0.02)

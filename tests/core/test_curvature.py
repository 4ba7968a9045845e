"""The curvature of a run against the run's own inclination, one ℓ₁ back."""

from itertools import accumulate

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.inputs import Schedule
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.run.simulate import simulate
from systems import scaled_systems

FORCE_SCALE = 1e6  # N


@st.composite
def cases(draw: st.DrawFn) -> tuple[Case, int]:
    """A case of 4 ℓ₁, and its number of rows in each ℓ₁: crooked holes, forces that change on rows and between them."""
    scaled, l1, rows = draw(scaled_systems()), draw(st.floats(0.8, 8.0)), draw(st.integers(1, 12))
    in_rows = st.one_of(st.integers(0, 4 * rows).map(float), st.floats(0.0, 4.0 * rows))
    changes = sorted({0.0, *(l1 * at / rows for at in draw(st.lists(in_rows, max_size=4)))})
    stations = [0.0, *accumulate(draw(st.lists(st.floats(0.05, 2.0), max_size=5)))]
    inclination = draw(st.floats(0.0, 1.5))
    case = Case(
        bha=BottomHoleAssembly(
            stabilizer_positions=tuple(l1 * s for s in scaled.s),
            stabilizer_clearances=tuple(l1 * y for y in scaled.y_star),
            rss_position=l1 * scaled.Delta,
            distributed_weight=scaled.w * FORCE_SCALE / l1,
            flexural_stiffness=FORCE_SCALE * l1**2 / 3,
        ),
        bit=BitRock(10.0, 10.0 * scaled.epsilon, scaled.psi_star),
        bit_diameter=0.2,
        active_weight_on_bit=draw(st.floats(5e-3, 0.3)) * FORCE_SCALE / 10.0,
        survey=Survey(
            tuple(l1 * depth for depth in stations),
            tuple(inclination + draw(st.floats(-0.03, 0.03)) for _ in stations),
        ),
        schedule=Schedule(tuple(changes), tuple(draw(st.floats(-1e4, 1e4)) for _ in changes)),
        length=4 * l1,
    )
    return case, rows


@settings(max_examples=60, deadline=None)
@given(cases(), st.sampled_from([1e-9, 1e-7, 1e-5]))
def test_the_curvature_is_that_of_the_rows_though_forces_jump_and_kinks_come_back(
    engine: str, drawn: tuple[Case, int], tolerance: float
) -> None:
    (case, rows), l1, survey = drawn, drawn[0].bha.length_scale, drawn[0].survey
    run = simulate(case, sample_interval=l1 / rows, relative_tolerance=tolerance, engine=engine)
    Theta, turned = run["borehole_inclination"], run["borehole_curvature"] * l1
    depths = survey.measured_depth[-1] + run["drilled_length"][:rows] - l1
    surveyed = np.interp(depths, survey.measured_depth, survey.inclination)
    assert turned == pytest.approx(Theta - [*surveyed, *Theta[:-rows]], abs=1e-9)

"""Roots and critical ηΠ of BHAs in sections and under an axial load."""

from dataclasses import replace

import numpy as np
import pytest

from beams_as_built import in_sections
from boreprop import paper_case
from boreprop.analysis.stability.roots import critical_eta_pi, find_roots
from boreprop.case.case import Case
from boreprop.core.errors import ParameterError
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.run.simulate import simulate

pytestmark = pytest.mark.usefixtures("kernel")
PAPER = paper_case()


@pytest.mark.parametrize("contact", [(), (1,)])
@pytest.mark.parametrize("saturated", [False, True])
def test_a_uniform_beam_in_sections_has_the_roots_of_the_paper(contact: tuple[int, ...], saturated: bool) -> None:
    EI = PAPER.bha.flexural_stiffness
    cases = PAPER, in_sections(PAPER, (1.0, 2.5, 4.0), (EI,) * 3)
    paper, built = (
        find_roots(case, 0.05, contact=contact, saturated=saturated, inclination=0.6).roots for case in cases
    )
    np.testing.assert_allclose(built, paper, rtol=1e-8, atol=1e-10)


@pytest.mark.parametrize(("kN", "critical"), [(0.0, 0.146757), (60.0, 0.149181), (120.0, 0.151603)])
def test_the_weight_on_bit_raises_the_critical_eta_pi(kN: float, critical: float) -> None:
    """In the paper's vertical hole. The numbers are from beams of finite elements."""
    case = replace(PAPER, bha=replace(PAPER.bha, axial_load=kN > 0), weight_on_bit=kN * 1e3)
    found = critical_eta_pi(case, contact=(1,), inclination=0.0)
    assert found
    assert found.eta_pi == pytest.approx(critical, abs=2e-6)


def growing() -> Case:
    """A case in sections and under an axial load, whose stabilizer is held, in a vertical hole."""
    bha = BottomHoleAssembly((3.0, 7.0), (0.0,), 0.5, 900.0, 1e7, axial_load=True)
    case = Case(
        bha=bha,
        bit=BitRock(10.0, 1.0, 0.03),
        bit_diameter=0.2,
        active_weight_on_bit=1e4,
        weight_on_bit=1.5e5,
        length=90.0,
        survey=Survey((0.0, 7.0, 8.0), (0.0, 0.0, 1e-6)),
    )
    return in_sections(case, (1.2, 3.0, 3.0), (1e7, 4e6, 1.5e7))


def test_small_disturbances_grow_as_the_rightmost_roots_say() -> None:
    """Along a sum of five terms e^{νξ} six rows at equal distances depend on each other linearly (Prony)."""
    case, spacing, terms = growing(), 0.3, 5
    run = simulate(case, sample_interval=spacing, relative_tolerance=1e-10)
    x = run["bit_inclination"][run["drilled_length"] > 45.0]
    rows = np.lib.stride_tricks.sliding_window_view(x, terms + 1)
    rule = np.linalg.lstsq(rows[:, :terms], rows[:, terms], rcond=None)[0]
    factors = np.roots([1.0, *-rule[::-1]])
    roots = np.array(find_roots(case, contact=(1,), inclination=0.0).roots[:2])
    for factor in np.exp(roots * spacing / case.bha.length_scale):
        assert np.abs(factors - factor).min() <= 2e-4
    assert roots[0].real > 0.2


def test_a_body_that_may_touch_the_wall_has_no_roots() -> None:
    bha = replace(
        PAPER.bha,
        section_lengths=(8.0,),
        section_flexural_stiffnesses=(7e6,),
        section_distributed_weights=(1e3,),
        section_outer_diameters=(0.17,),
        body_point_positions=(2.0,),
        body_point_clearances=(0.02,),
    )
    with pytest.raises(ParameterError, match=r"^bha.body_contact: must be left out for roots, stability and spiral"):
        find_roots(replace(PAPER, bha=bha))

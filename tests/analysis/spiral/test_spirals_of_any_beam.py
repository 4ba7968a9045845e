"""Spirals of BHAs in sections and under an axial load."""

from dataclasses import replace

import pytest

from beams_as_built import in_sections
from boreprop.analysis.ellipse import Shape
from boreprop.analysis.rippling import find_rippling
from boreprop.analysis.spiral.closed_form import Search, spiral
from boreprop.analysis.spiral.transverse import transverse_growth
from boreprop.case.case import Case
from boreprop.core.errors import ParameterError
from boreprop.run.simulate import simulate
from spirals import disturbed, paper_spiral

pytestmark = pytest.mark.usefixtures("kernel")
PAPER = paper_spiral()
EI = PAPER.bha.flexural_stiffness


def loaded(case: Case, weight_on_bit: float) -> Case:
    return replace(case, bha=replace(case.bha, axial_load=True), weight_on_bit=weight_on_bit)


def built() -> Case:
    return loaded(in_sections(PAPER, (1.2, 3.0, 4.0), (EI, 0.6 * EI, 1.3 * EI)), 6e4)


def test_a_uniform_beam_in_sections_has_the_coefficients_of_the_paper() -> None:
    three = replace(
        PAPER, bha=replace(PAPER.bha, stabilizer_positions=(3.66, 5.0, 7.32), stabilizer_clearances=(1e-3,) * 2)
    )
    for case in (PAPER, three):
        paper, built = (
            Search(each, 0.1).turning.beam for each in (case, in_sections(case, (1.0, 2.5, 4.0), (EI,) * 3))
        )
        for name, value in vars(paper).items():
            assert getattr(built, name) == pytest.approx(value, rel=1e-8, abs=1e-12), name


@pytest.mark.parametrize(("kN", "critical"), [(60.0, 0.149181), (120.0, 0.151603)])
def test_small_spirals_under_an_axial_load_grow_up_to_what_finite_elements_say(kN: float, critical: float) -> None:
    found = Search(loaded(PAPER, kN * 1e3), 0.0).critical()
    assert found
    assert found.eta_pi == pytest.approx(critical, abs=2e-6)


def test_a_hole_winds_into_the_spiral_of_the_closed_form() -> None:
    case = built()
    search = Search(case, 0.0)
    x = search.at(case.eta_pi).own
    assert x is not None
    found = find_rippling(simulate(disturbed(case), length=70.0 * case.length_scale, dimensions=3))
    assert found.ellipse is not None
    assert found.ellipse.shape is Shape.RIGHT
    assert found.wavelength == pytest.approx(search.winding(x).pitch, rel=3e-4)
    assert [found.ellipse.major, found.ellipse.minor] == pytest.approx([search.winding(x).radius] * 2, rel=2e-3)


def test_a_ripple_of_a_beam_in_sections_leaves_its_plane_as_that_of_the_paper() -> None:
    """Where one of the two fails, so does the other: their runs and coefficients differ by rounding."""
    paper, built = (transverse_growth(case) for case in (PAPER, in_sections(PAPER, (3.0, 5.0), (EI, EI))))
    assert built.growth == pytest.approx(paper.growth, rel=1e-3)


@pytest.mark.parametrize(
    ("case", "message"),
    [
        (loaded(PAPER, 5e6), r"^weight_on_bit: must be less for a spiral, since the BHA buckles"),
        (
            replace(PAPER, bha=replace(PAPER.bha, end_deflection=-0.01)),
            r"^bha.end_deflection: must be 0 for a spiral, since a vertical hole has no low side",
        ),
        (
            replace(built(), bha=replace(built().bha, body_point_positions=(2.0,), body_point_clearances=(0.02,))),
            r"^bha.body_contact: must be left out for roots, stability and spiral",
        ),
    ],
)
def test_what_has_no_spiral_of_discs_is_refused(case: Case, message: str) -> None:
    for compute in (spiral, transverse_growth):
        with pytest.raises(ParameterError, match=message):
            compute(case)

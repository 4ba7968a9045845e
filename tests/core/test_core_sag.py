"""Where a drilled BHA is farthest from the axis of its hole, against finite elements; how often it is told."""

import pytest

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.core.drilling import Drilling
from boreprop.core.sag import Body, Watch, places, present_sag
from element_beam import ElementBeam
from places import EXAMPLES


@pytest.fixture(scope="module")
def section() -> Case:
    return load_case(EXAMPLES / "build_section.toml")


def drilled(case: Case, length: float) -> Drilling:
    drilling = Drilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    drilling.advance(length, 9e3, case.active_weight_on_bit)
    return drilling


@pytest.mark.parametrize("length", [0.0, 7.0, 60.0])
def test_the_sag_is_that_of_finite_elements_in_the_drilled_hole(section: Case, length: float) -> None:
    drilling = drilled(section, length)
    p, l1 = drilling.integrator, section.length_scale
    sag = present_sag(drilling, Body(p.modes.beam, places(p.modes.beam.lambda_)), 0.15)
    outputs, loads, s = drilling.outputs(), p.loads(), sag.position / l1
    contact = [outputs[f"stabilizer_force[{i}]"] / section.bha.force_scale for i in (1, 2)]
    theta, Y = p.state()
    e = Y - p.origin - p.hole.Y(p.xi - s) - s * theta
    assert sag.offset / l1 == pytest.approx(e + ElementBeam(p.scaled, loads, contact, s).at(s), rel=1e-8)
    assert (sag.hole_radius, sag.drilled_length) == (0.15, length)


def test_one_that_leaves_is_told_once_and_one_inside_is_not(section: Case) -> None:
    weight, wide, narrow = section.active_weight_on_bit, Watch(0.15), Watch(0.001)
    drilling, told = drilled(section, 0.0), []
    for k in range(1, 61):
        drilling.advance(0.5 * k, 9e3, weight)
        told.append((wide.look(drilling), narrow.look(drilling)))
    assert {said for said, _ in told} == {""}
    assert [bool(said) for _, said in told] == [True] + [False] * 59

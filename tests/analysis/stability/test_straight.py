"""Whether a case drills straight on, by counting roots: against the roots themselves."""

from dataclasses import replace

import pytest

from boreprop.analysis.stability.roots import Verdict, critical_eta_pi, find_roots
from boreprop.analysis.stability.straight import straight_drilling
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.inputs import Schedule
from places import EXAMPLES
from steering_cases import saturating


@pytest.mark.parametrize("name", ["paper_case", "build_section"])
def test_the_verdict_is_that_of_the_roots_of_the_mode_in_which_the_case_drills(name: str) -> None:
    case = load_case(EXAMPLES / f"{name}.toml")
    found: set[Verdict | None] = set()
    for times in (0.1, 0.3, 1.0, 2.0, 5.0, 20.0):
        heavier = replace(case, active_weight_on_bit=times * case.active_weight_on_bit)
        straight = straight_drilling(heavier)
        roots = find_roots(heavier, contact=straight.contact, saturated=straight.saturated)
        assert straight.verdict is roots.verdict
        assert straight.critical == critical_eta_pi(heavier, contact=straight.contact, saturated=straight.saturated)
        found.add(straight.verdict)
    assert {Verdict.STABLE, Verdict.OSCILLATORY} <= found


def test_under_a_large_force_it_is_the_mode_with_the_tilt_at_its_limit(build_section: Case) -> None:
    pushed = replace(saturating(build_section), schedule=Schedule((0.0,), (16e3,)))
    straight = straight_drilling(pushed)
    assert straight.saturated
    assert straight.verdict is find_roots(pushed, contact=straight.contact, saturated=True).verdict


def test_with_too_many_roots_there_is_no_verdict(case: Case) -> None:
    assert straight_drilling(replace(case, active_weight_on_bit=1.0)).verdict is None

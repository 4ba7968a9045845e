"""A number in another unit is noticed: by how far it is from any bottom-hole assembly."""

from dataclasses import replace
from math import pi
from pathlib import Path

import pytest

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.formations import Formation
from boreprop.case.inputs import Schedule
from boreprop.case.tables import BY_KEY
from boreprop.case.usual import USUAL, unusual
from boreprop.core.survey import Survey
from boreprop.core.system import eta_pi
from places import EXAMPLES

INCH = 0.0254


@pytest.mark.parametrize("name", ["paper_case.toml", "build_section.toml"])
def test_the_examples_are_usual(name: str) -> None:
    assert unusual(load_case(EXAMPLES / name)) == []


@pytest.mark.parametrize(("outer", "inner"), [(3.125, 1.25), (6.75, 2.8125), (8.0, 2.8125), (11.0, 3.0)])
def test_drill_collars_are_usual_in_newtons_and_metres_only(case: Case, outer: float, inner: float) -> None:
    area = pi / 4 * (outer**2 - inner**2) * INCH**2
    stiffness, weight = 206e9 * pi / 64 * (outer**4 - inner**4) * INCH**4, 0.85 * 7850 * 9.81 * area
    collar = replace(case, bha=replace(case.bha, flexural_stiffness=stiffness, distributed_weight=weight))
    assert unusual(collar) == []
    for other in (stiffness / 1e3, stiffness * 1e3):  # kN m², N m mm
        changed = unusual(replace(collar, bha=replace(collar.bha, flexural_stiffness=other)))
        assert f"bha.flexural_stiffness: is usually 100000 to 2e+08 N·m², got {other:g}" in changed
    kilonewtons = unusual(replace(collar, bha=replace(collar.bha, distributed_weight=weight / 1e3)))
    assert kilonewtons == [f"bha.distributed_weight: is usually 100 to 6000 N/m, got {weight / 1e3:g}"]


def test_each_unusual_value_is_named_with_its_usual_range(case: Case) -> None:
    for changed, phrase in [
        (replace(case, schedule=Schedule((0.0, 5.0), (0.0, -8.0))), "rss.force: is usually 100 to 100000 N, got 8"),
        (
            replace(case, bit=replace(case.bit, tilt_limit=0.0005)),
            "bit.tilt_limit_deg: is usually 0.05 to 5 °, got 0.02",
        ),
        (replace(case, active_weight_on_bit=60.0), "drilling.active_weight_on_bit: is usually 300 to 500000 N, got 60"),
        (replace(case, bit_diameter=1.2), "bit.diameter: is usually 0.05 to 1 m, got 1.2"),
        (
            replace(case, survey=Survey((0.0, 7.0), (0.0, 0.0))),
            "hole.measured_depth: spans 7 m, less than the 7.32 m of",
        ),
    ]:
        [found] = unusual(changed)
        assert found.startswith(phrase)
    hard = replace(case, bit=replace(case.bit, lateral_steering_resistance=2e6))
    value = eta_pi(hard.bha, hard.bit, hard.active_weight_on_bit)
    assert unusual(hard) == [f"ηΠ: is usually 1e-05 to 100, got {value:g}"]


def test_formations_by_a_depth_that_the_bit_never_gets_to_are_noticed(case: Case) -> None:
    hard = Formation(None, lateral_steering_resistance=60.0, true_vertical_depth=2255.0)
    [found] = unusual(replace(case, formations=(hard,)))
    assert found.startswith("formation.true_vertical_depth: 2255 m is deeper than a bit that starts at 0 m gets in")
    assert unusual(replace(case, formations=(hard,), true_vertical_depth=2250.0)) == []
    assert unusual(replace(case, formations=(replace(hard, true_vertical_depth=5.0),))) == []


def test_a_weightless_assembly_without_force_is_meant_so(case: Case) -> None:
    weightless = replace(case, bha=replace(case.bha, distributed_weight=0.0), schedule=Schedule())
    assert unusual(weightless) == []


def test_every_range_is_of_a_key_of_the_case_file(paper_case: Path) -> None:
    assert set(USUAL) - set(BY_KEY) == {"ηΠ"}
    assert unusual(load_case(paper_case)) == []

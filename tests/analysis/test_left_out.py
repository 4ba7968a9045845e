"""The table in docs/model.md of how much what is not well known matters."""

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from boreprop.analysis.steering import steady_response
from boreprop.case.case import Case
from boreprop.case.file import load_case
from places import EXAMPLES, ROOT

PAGE = (ROOT / "docs" / "model.md").read_text()
FORCE = 20e3
CHANGES: dict[str, Callable[[Case], Case]] = {
    "active weight on bit 30 kN": lambda case: replace(case, active_weight_on_bit=30e3),
    "active weight on bit 90 kN": lambda case: replace(case, active_weight_on_bit=90e3),
    "η halved": lambda case: replace(
        case, bit=replace(case.bit, lateral_steering_resistance=case.bit.lateral_steering_resistance / 2)
    ),
    "χ doubled": lambda case: replace(
        case, bit=replace(case.bit, angular_steering_resistance=2 * case.bit.angular_steering_resistance)
    ),
    "stiffness EI a tenth less": lambda case: replace(
        case, bha=replace(case.bha, flexural_stiffness=0.9 * case.bha.flexural_stiffness)
    ),
    "weight of the BHA a tenth more": lambda case: replace(
        case, bha=replace(case.bha, distributed_weight=1.1 * case.bha.distributed_weight)
    ),
    "first stabilizer 1 mm more under gauge on each side": lambda case: replace(
        case,
        bha=replace(
            case.bha,
            stabilizer_clearances=(case.bha.stabilizer_clearances[0] + 1e-3, *case.bha.stabilizer_clearances[1:]),
        ),
    ),
}


def build_rate(case: Case) -> float:
    """Build rate under the force, °/30 m."""
    return float(np.degrees(30.0 * steady_response(case, FORCE, case.survey.inclination[-1]).build_rate))


@pytest.mark.parametrize("change", CHANGES)
def test_the_page_says_what_the_product_computes(change: str) -> None:
    case = load_case(EXAMPLES / "build_section.toml")
    assert f"{build_rate(case):.2f} °/30 m" in PAGE
    [percent] = re.findall(rf"^\| {re.escape(change)} \| (\S+) % \|$", PAGE, re.MULTILINE)
    found = 100 * (build_rate(CHANGES[change](case)) / build_rate(case) - 1)
    assert found == pytest.approx(float(percent.replace("−", "-")), abs=0.5)


def test_every_line_of_the_page_is_tested() -> None:
    table = PAGE.partition("| instead of what the case says | build rate |")[2]
    assert re.findall(r"^\| ([^|]+) \| \S+ % \|$", table, re.MULTILINE) == list(CHANGES)

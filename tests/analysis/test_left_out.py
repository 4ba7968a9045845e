"""The tables of how much it matters what is not known, or what the model leaves out: in docs/limits.md and FMUs."""

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from boreprop.analysis.steering import steady_response
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop_fmu.pack.documentation import LEFT_OUT, page
from built_beam import Built
from places import EXAMPLES, ROOT

PAGE = (ROOT / "docs" / "limits.md").read_text()
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


BUILT: dict[str, Callable[[Case], Built]] = {
    "EI 60 % from 1 m to 4 m behind the bit, a flexible collar": lambda case: Built(
        case, stiffness=lambda s: 0.6 if 1.0 < s < 4.0 else 1.0
    ),
    "weight on bit of 120 kN in the stiffness of the beam": lambda case: Built(case, weight_on_bit=120e3),
    "last stabilizer 1.6 mm below the centre of the hole": lambda case: Built(case, drop=1.6e-3),
}


@pytest.fixture(scope="module")
def section() -> Case:
    return load_case(EXAMPLES / "build_section.toml")


def build_rate(case: Case) -> float:
    """Build rate under the force, °/30 m."""
    return float(np.degrees(30.0 * steady_response(case, FORCE, case.survey.inclination[-1]).build_rate))


def percent(change: str) -> tuple[float, float]:
    """What the page says of a change, and half a unit of its last digit."""
    [number] = re.findall(rf"^\| {re.escape(change)} \| (\S+) % \|$", PAGE, re.MULTILINE)
    return float(number.replace("−", "-")), 0.5 / 10 ** len(number.partition(".")[2])


@pytest.mark.parametrize("change", CHANGES)
def test_the_page_says_what_the_product_computes(section: Case, change: str) -> None:
    assert f"{build_rate(section):.2f} °/30 m" in PAGE
    found = 100 * (build_rate(CHANGES[change](section)) / build_rate(section) - 1)
    said, rounding = percent(change)
    assert found == pytest.approx(said, abs=rounding)


@pytest.mark.parametrize("change", BUILT)
def test_and_of_the_rest_what_finite_elements_give(section: Case, change: str) -> None:
    inclination = section.survey.inclination[-1]
    assert Built(section).build_rate(FORCE, inclination) == pytest.approx(build_rate(section), rel=1e-9)
    found = 100 * (BUILT[change](section).build_rate(FORCE, inclination) / build_rate(section) - 1)
    said, rounding = percent(change)
    assert found == pytest.approx(said, abs=rounding)


def test_every_line_of_the_page_is_tested() -> None:
    tables = PAGE.partition("| instead of what the case says | build rate |")[2]
    assert re.findall(r"^\| ([^|]+) \| \S+ % \|$", tables, re.MULTILINE) == [*CHANGES, *BUILT]


def test_the_page_of_an_fmu_says_the_same(section: Case) -> None:
    assert set(BUILT) < set(LEFT_OUT)
    for change, said in LEFT_OUT.items():
        assert f"| {change} | {said} |" in PAGE
        assert f"<tr><td>{change}</td><td>{said}</td></tr>" in page(section, "Borehole", "native", {})

"""The table of quantities: complete, without a second name for anything, and true of the model."""

from dataclasses import fields
from math import inf
from typing import Any

import pytest

from boreprop.case.case import Case
from boreprop.case.inputs import Schedule
from boreprop.core.checks import check_quantity
from boreprop.core.drilling import Drilling
from boreprop.core.errors import ParameterError
from boreprop.core.quantities import (
    INPUTS,
    OUTPUTS,
    PARAMETERS,
    QUANTITIES,
    Quantity,
    fields_of,
    scalar_names,
    values_of,
)
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.units import UNITS

PARTS = {"": Case, "bha": BottomHoleAssembly, "bit": BitRock, "survey": Survey, "schedule": Schedule}


@pytest.mark.parametrize("of", ["name", "key", "field"])
def test_nothing_is_described_twice(of: str) -> None:
    found = [getattr(quantity, of) for quantity in QUANTITIES if getattr(quantity, of)]
    assert len(found) == len(set(found))


@pytest.mark.parametrize(("part", "made"), PARTS.items())
def test_every_field_of_a_case_is_in_the_table(part: str, made: type) -> None:
    ours = {quantity.attribute for quantity in QUANTITIES if quantity.field and quantity.part == part}
    assert ours == {field.name for field in fields(made)} - {
        *PARTS,
        "inputs",
        "formations",
        "wear",
        "toolface_reference",
    }  # which hold inputs by their names


def test_every_quantity_has_a_unit_that_can_be_shown() -> None:
    assert {quantity.unit for quantity in QUANTITIES} <= set(UNITS)


def test_the_model_gives_the_outputs_of_the_table_in_its_order(case: Case) -> None:
    drilling = Drilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    assert list(drilling.outputs()) == scalar_names(OUTPUTS, 2)


@pytest.mark.parametrize(
    ("name", "small", "large"),
    [
        ("rss_force", {"rss_force": 1e3}, {"rss_force": 1e6}),
        ("active_weight_on_bit", {}, {"active_weight_on_bit": 10.0}),
    ],
)
def test_outputs_follow_at_once_the_inputs_that_the_table_names_and_no_others(
    case: Case, name: str, small: dict[str, float], large: dict[str, float]
) -> None:
    straight = Survey((0.0,), (0.1,))
    inputs: dict[str, Any] = {
        "rss_force": 1e3,
        "active_weight_on_bit": 1e5,
    }  # else the tilt is at its limit
    before, after = (Drilling(case.bha, case.bit, straight, **inputs | other).outputs() for other in (small, large))
    changed = {scalar.partition("[")[0] for scalar, value in after.items() if value != before[scalar]}
    assert changed == {quantity.name for quantity in OUTPUTS if name in quantity.follows and quantity.count(2)}


@pytest.mark.parametrize("quantity", [q for q in INPUTS + PARAMETERS if q.kind == "Real"], ids=lambda q: q.name)
def test_a_range_is_open_where_it_says_above_and_closed_where_it_says_at_least(quantity: Quantity) -> None:
    def accepted(value: float) -> bool:
        try:
            check_quantity(quantity.name, value)
        except ParameterError:
            return False
        return True

    for bound, inside in ((quantity.above, False), (quantity.at_least, True), (quantity.at_most, True)):
        if abs(bound) < inf:
            assert accepted(bound) is inside
    assert not accepted(inf)


def test_the_fields_of_a_part_are_found_under_flat_names_and_put_together_again(case: Case) -> None:
    values = values_of("bha", case.bha)
    assert list(values)[:3] == ["stabilizer_position[1]", "stabilizer_position[2]", "stabilizer_clearance[1]"]
    assert BottomHoleAssembly(**fields_of("bha", values, 2)) == case.bha

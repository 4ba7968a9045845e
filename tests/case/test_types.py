"""Parts of a case made in Python: lists and arrays become tuples, other types are refused in one line."""

from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest

import boreprop
from boreprop import BitRock, Formation, InputSchedule, Schedule, Wear, paper_case
from boreprop.core.errors import ParameterError
from boreprop.core.quantities import QUANTITIES

API: Any = boreprop  # for values that types forbid
NEW: Any = replace
CASE = paper_case()
PARTS = (
    CASE,
    CASE.bha,
    BitRock(10.0, 1.0, 0.02),
    CASE.survey,
    Schedule((0.0, 5.0), (1e3, 2e3), "linear", (1.0, 2.0), ("north", "frame")),
    InputSchedule((0.0, 5.0), (("active_weight_on_bit", (2e3, 3e3)),)),
    Formation(5.0, 20.0),
    Wear(1.0, 100.0),
)
FIELDS = [(part, field.name) for part in PARTS for field in fields(part)]
WRONG = ("north", ("north",), [["north"]], 1j, object(), {"north": "north"}, (None, None), Wear)


@pytest.mark.parametrize(("part", "name"), FIELDS, ids=[f"{type(part).__name__}.{name}" for part, name in FIELDS])
def test_a_field_of_another_type_is_refused_by_its_name(part: Any, name: str) -> None:
    known = (name, *(quantity.name for quantity in QUANTITIES if quantity.attribute == name))
    for value in WRONG:
        with pytest.raises(ParameterError) as caught:
            NEW(part, **{name: value})
        assert "\n" not in str(caught.value)
        assert str(caught.value).startswith(known), value


@pytest.mark.parametrize("make", [list, np.array], ids=["lists", "arrays"])
def test_lists_and_arrays_become_tuples(make: Any) -> None:
    for part in PARTS:
        columns = {
            field.name: make(value)
            for field in fields(part)
            if isinstance(value := getattr(part, field.name), tuple) and field.name != "inputs"
        }
        again = NEW(part, **columns)
        assert again == part
        assert repr(again) == repr(part)
    assert NEW(PARTS[5], inputs={"active_weight_on_bit": make([2e3, 3e3])}) == PARTS[5]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: API.Schedule(toolface_reference="north"), r"toolface_reference: must be a list, such as \['north'\]"),
        (lambda: API.Survey((0.0, 9.0), (0.1, 0.2), 0.7), r"azimuth: must be a list, such as \[0.7\], got 0.7$"),
        (lambda: API.Survey((0.0, 9.0), (0.1, "2°")), r"inclination\[2\]: must be a number, got '2°'$"),
        (
            lambda: NEW(CASE, survey=((0.0,), (0.0,))),
            r"survey: must be of the type Survey, got \(\(0.0,\), \(0.0,\)\)$",
        ),
        (lambda: NEW(CASE.bha, axial_load="no"), r"axial_load: must be True or False, got 'no'$"),
        (lambda: API.Schedule.by_depth(0.0, (1e3,), 0.0), r"measured_depth: must be a list, such as \[0.0\], got 0.0"),
        (lambda: API.Case(*[None] * 6), r"bha: must be of the type BottomHoleAssembly, got None$"),
    ],
)
def test_what_is_wrong_is_told_with_what_would_be_right(call: Callable[[], object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        call()

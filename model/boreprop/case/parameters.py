"""The mapping between scalar names such as ``stabilizer_position[2]`` and the fields of a `Case`."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..core.checks import check_quantity
from ..core.quantities import INPUTS, PARAMETERS, TOOLFACE_REFERENCES, fields_of, quantity_of, scalar_names, values_of
from ..errors import InputError
from .body import keep_clearances
from .case import Case
from .inputs import Schedule
from .schedules import SIDES

HOLE = "bit_diameter"
PARTS = ("bha", "bit")  # the fields of a case that are dataclasses of parameters


def parameters(case: Case) -> dict[str, float]:
    """The inputs and parameters of a case by the scalar names of the table of quantities, SI units, in its order.

    "rss_force" is the first force of the schedule. Quantities that a case does not have, such as the rate of
    penetration, are left out.
    """
    values = values_of("", case) | values_of("schedule", case.schedule)
    for part in PARTS:
        values |= values_of(part, getattr(case, part))
    if case.in_space:
        values |= {name: profile.values[0] for name, profile in case.schedule.sides().items()}
    names = scalar_names(INPUTS + PARAMETERS, case.structure)
    return {name: values[name] for name in names if name in values}


def diameters(case: Case) -> dict[str, float]:
    """The diameters of hole and sections by scalar name, m, where clearances of the body follow from them."""
    if not case.bha.body_point_positions:
        return {}
    body = {f"section_outer_diameter[{i}]": value for i, value in enumerate(case.bha.section_outer_diameters, 1)}
    return {HOLE: case.bit_diameter} | body


def with_parameters(case: Case, values: Mapping[str, float]) -> Case:
    """`case` with other values of some inputs and parameters.

    Parameters
    ----------
    case
        The case to start from.
    values
        Scalar name, see `parameters` and `diameters` → value in SI units. An input replaces its schedule by a constant
        value. Other diameters give the body other clearances, unless these are given by hand; its stiffness and weight
        are parameters of their own.

    Raises
    ------
    InputError
        If a name is not among those of `parameters` and `diameters`.
    ParameterError
        If a value is out of range.
    """
    own = parameters(case) | diameters(case)
    for name in values:
        if name not in own:
            raise InputError(f"a parameter must be one of {', '.join(own)}, got {name!r}")
    structure, wanted = case.structure, own | dict(values)
    changed = {quantity_of(name).part for name in values}
    parts: dict[str, Any] = {
        part: replace(getattr(case, part), **fields_of(part, wanted, structure)) for part in PARTS if part in changed
    }
    if {"rss_force", *SIDES} & values.keys():
        sides: dict[str, Any] = {}
        if case.in_space:
            check_quantity("toolface_reference", wanted["toolface_reference"])
            reference = TOOLFACE_REFERENCES[int(wanted["toolface_reference"])]
            sides = {"rss_toolface": (wanted["rss_toolface"],), "toolface_reference": (reference,)}
        parts["schedule"] = Schedule((0.0,), (wanted["rss_force"],), **sides)
    inputs, formations = case.inputs, case.formations
    for name in values:
        inputs = inputs and inputs.without(name)
        formations = tuple(left for formation in formations if (left := formation.without(name)))
    made = replace(case, **parts, inputs=inputs, formations=formations, **fields_of("", wanted, structure))
    if structure.body_points:
        body = tuple(wanted[name] for name in diameters(case) if name != HOLE)
        made = replace(made, bit_diameter=wanted[HOLE], bha=replace(made.bha, section_outer_diameters=body))
    return keep_clearances(case, made) if structure.body_points else made

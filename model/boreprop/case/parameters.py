"""The mapping between scalar names such as ``stabilizer_position[2]`` and the fields of a `Case`."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..core.quantities import INPUTS, PARAMETERS, fields_of, quantity_of, scalar_names, values_of
from ..errors import InputError
from .case import Case, Schedule

PARTS = ("bha", "bit")  # the fields of a case that are dataclasses of parameters


def parameters(case: Case) -> dict[str, float]:
    """The inputs and parameters of a case by the scalar names of the table of quantities, SI units, in its order.

    "rss_force" is the first force of the schedule. Quantities that a case does not have, such as the rate of
    penetration, are left out.
    """
    values = values_of("", case) | values_of("schedule", case.schedule)
    for part in PARTS:
        values |= values_of(part, getattr(case, part))
    names = scalar_names(INPUTS + PARAMETERS, case.bha.structure)
    return {name: values[name] for name in names if name in values}


def with_parameters(case: Case, values: Mapping[str, float]) -> Case:
    """`case` with other values of some inputs and parameters.

    Parameters
    ----------
    case
        The case to start from.
    values
        Scalar name, see `parameters` → value in SI units. An input replaces its schedule by a constant value.

    Raises
    ------
    InputError
        If a name is not among those of `parameters`.
    ParameterError
        If a value is out of range.
    """
    own = parameters(case)
    for name in values:
        if name not in own:
            raise InputError(f"a parameter must be one of {', '.join(own)}, got {name!r}")
    structure, wanted = case.bha.structure, own | dict(values)
    changed = {quantity_of(name).part for name in values}
    parts: dict[str, Any] = {
        part: replace(getattr(case, part), **fields_of(part, wanted, structure)) for part in PARTS if part in changed
    }
    if "schedule" in changed:
        parts["schedule"] = Schedule((0.0,), (wanted["rss_force"],))
    for name in values:
        if case.inputs is not None and name in dict(case.inputs.inputs):
            parts["inputs"] = case.inputs.without(name)
    return replace(case, **parts, **fields_of("", wanted, structure))

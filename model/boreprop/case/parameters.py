"""Flat names ↔ a case: the one mapping between ``stabilizer_position[2]`` and the `Case` that has it."""

from collections.abc import Mapping
from dataclasses import replace

from ..core.quantities import INPUTS, PARAMETERS, fields_of, scalar_names, values_of
from ..errors import InputError
from .case import Case, Schedule

PARTS = ("bha", "bit")  # of a case, which have parameters


def parameters(case: Case) -> dict[str, float]:
    """The inputs and parameters of a case by the scalar names of the table of quantities, SI units, in its order.

    The force is the first one of the schedule. What no case has (the rate of penetration) is not among them.
    """
    values = values_of("", case) | values_of("schedule", case.schedule)
    for part in PARTS:
        values |= values_of(part, getattr(case, part))
    names = scalar_names(INPUTS + PARAMETERS, len(case.bha.stabilizer_positions))
    return {name: values[name] for name in names if name in values}


def with_parameters(case: Case, values: Mapping[str, float]) -> Case:
    """`case` with other values of some inputs and parameters.

    Parameters
    ----------
    case
        What all else is taken from.
    values
        Names of `parameters` → values, SI units. A "rss_force" acts from the start to the end, instead of the schedule.

    Raises
    ------
    InputError
        If there is no parameter of a name.
    ParameterError
        If a value is out of range.
    """
    own = parameters(case)
    for name in values:
        if name not in own:
            raise InputError(f"a parameter must be one of {', '.join(own)}, got {name!r}")
    n, wanted = len(case.bha.stabilizer_positions), own | dict(values)
    parts = {part: replace(getattr(case, part), **fields_of(part, wanted, n)) for part in PARTS}
    schedule = Schedule((0.0,), (wanted["rss_force"],)) if "rss_force" in values else case.schedule
    return replace(case, **parts, **fields_of("", wanted, n), schedule=schedule)

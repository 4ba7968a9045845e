"""Makes schedules from the columns of a table, which stands in a case file or in a CSV file of its own."""

from collections.abc import Mapping

from ..core.checks import check_number, check_quantity
from ..core.errors import ParameterError
from ..core.quantities import CLEARANCES, IN_SPACE_ONLY, INPUTS
from .case import InputSchedule, Schedule, from_bit

Column = tuple[float, ...]
Columns = Mapping[str, Column]

LENGTHS = ("drilled_length", "measured_depth")
"""The columns of which a schedule has one: where its entries begin."""

NAMES_OF_COLUMNS = (*(quantity.name for quantity in INPUTS if quantity.name not in IN_SPACE_ONLY), *CLEARANCES)
"""What the other columns may give: inputs, and clearances."""


def force_schedule(columns: Columns, bit_depth: float | None, interpolation: str, full_force: float | None) -> Schedule:
    """The schedule of the steering force.

    Parameters
    ----------
    columns
        One of `LENGTHS`, m, and either "force", N, or "duty" (0 to 1) and "toolface_deg" (0 or 180).
    bit_depth
        Measured depth of the bit at the start of the run, m; None if it is not known.
    interpolation
        "held" or "linear".
    full_force
        The force at a duty of 1, N; None with the column "force".

    Raises
    ------
    ParameterError
        If something of this breaks its constraint.
    """
    force = columns["force"] if full_force is None else steered(full_force, columns["duty"], columns["toolface_deg"])
    lengths, [force] = _over_length(columns, {"rss_force": force}, bit_depth, interpolation)
    return Schedule(lengths, force, interpolation)


def input_schedule(
    columns: Columns, bit_depth: float | None, interpolation: str
) -> tuple[Schedule | None, InputSchedule | None]:
    """The schedule of the steering force, if its column is there, and that of the other inputs.

    `columns` has one of `LENGTHS`, and some of the `NAMES_OF_COLUMNS`; the rest is as in `force_schedule`.
    """
    given = {name: values for name, values in columns.items() if name in NAMES_OF_COLUMNS}
    lengths, entries = _over_length(columns, given, bit_depth, interpolation)
    inputs = dict(zip(given, entries, strict=True))
    force = inputs.pop("rss_force", None)
    return (
        None if force is None else Schedule(lengths, force, interpolation),
        InputSchedule(lengths, tuple(inputs.items()), interpolation) if inputs else None,
    )


def steered(full_force: float, duty: Column, toolface_deg: Column) -> Column:
    """The steering force, N, of a tool that pushes for a share `duty` of the time to the side `toolface_deg`.

    Raises
    ------
    ParameterError
        If the force is negative, a duty is not a share, a toolface is another than 0 (up) or 180 (down), or the counts
        differ.
    """
    check_number("full_force", full_force, at_least=0.0)
    check_quantity("duty", duty)
    if len(duty) != len(toolface_deg):
        raise ParameterError("toolface", f"must hold one value per duty, {len(duty)} in all", toolface_deg)
    for index, angle in enumerate(toolface_deg, 1):
        if angle % 180.0 != 0.0:
            constraint = "must be 0 or 180, since the hole lies in a plane (others need a later version)"
            raise ParameterError(f"toolface[{index}]", constraint, angle)
    return tuple(
        full_force * share * (1.0 if angle % 360.0 == 0.0 else -1.0)
        for share, angle in zip(duty, toolface_deg, strict=True)
    )


def _over_length(
    columns: Columns, given: Columns, bit_depth: float | None, interpolation: str
) -> tuple[Column, list[Column]]:
    """Entries over the drilled length: the lengths, and each of the columns `given`."""
    if "drilled_length" in columns:
        return columns["drilled_length"], list(given.values())
    if bit_depth is None:
        constraint = "must come with the depth of the bit, of which nothing is known here (use drilled_length)"
        raise ParameterError("measured_depth", constraint, columns["measured_depth"])
    return from_bit(columns["measured_depth"], given, bit_depth, interpolation)

"""Makes schedules from the columns of a table, which stands in a case file or in a CSV file of its own."""

from collections.abc import Mapping, Sequence
from math import radians

from ..core.checks import check_number, check_quantity
from ..core.errors import ParameterError
from ..core.quantities import TOOLFACE_REFERENCES
from .inputs import NAMES_OF_COLUMNS, InputSchedule, Schedule, from_bit, signed

Column = tuple[float, ...]
Columns = Mapping[str, Column]

LENGTHS = ("drilled_length", "measured_depth")
"""The columns of which a schedule has one: where its entries begin."""

SIDES = ("rss_toolface", "toolface_reference")
"""The columns that say to which side the force pushes; the second one by number, as the input of that name."""


def force_schedule(
    columns: Columns,
    bit_depth: float | None,
    interpolation: str,
    full_force: float | None,
    reference: str | Sequence[str] = (),
) -> Schedule:
    """The schedule of the steering force.

    Parameters
    ----------
    columns
        One of `LENGTHS`, m, either "force", N, or "duty" (0 to 1), and "toolface_deg", which may be missing beside a
        force.
    bit_depth
        Measured depth of the bit at the start of the run, m; None if it is not known.
    interpolation
        "held" or "linear".
    full_force
        The force at a duty of 1, N; None with the column "force".
    reference
        From where the toolface counts, one of `TOOLFACE_REFERENCES`, or one an entry; none: from the high side.

    Raises
    ------
    ParameterError
        If something of this breaks its constraint.
    """
    force = columns["force"] if full_force is None else steered(full_force, columns["duty"], columns["toolface_deg"])
    toolface = tuple(map(radians, columns.get("toolface_deg", ())))
    references = (reference,) * len(force) if isinstance(reference, str) else tuple(reference)
    return _steering(columns, force, toolface, references, bit_depth, interpolation)


def _steering(
    columns: Columns,
    force: Column,
    toolface: Column,
    references: tuple[str, ...],
    bit_depth: float | None,
    interpolation: str,
) -> Schedule:
    """The schedule of a force to sides; that of one that only pushes up or down is signed before it is interpolated."""
    up_or_down = signed(force, toolface, references)
    if up_or_down is not None:
        lengths, [force] = _over_length(columns, {"rss_force": up_or_down}, bit_depth, interpolation)
        return Schedule(lengths, force, interpolation)
    lengths, [force] = _over_length(columns, {"rss_force": force}, bit_depth, interpolation)
    given = {"rss_toolface": toolface} if toolface else {}
    if references:
        given["toolface_reference"] = tuple(map(_number_of, references))
    _, held = _over_length(columns, given, bit_depth, "held")
    sides = dict(zip(given, held, strict=True))
    names = tuple(TOOLFACE_REFERENCES[int(number)] for number in sides.get("toolface_reference", ()))
    return Schedule(lengths, force, interpolation, sides.get("rss_toolface", ()), names)


def _number_of(reference: str) -> float:
    """The number of a reference of the toolface."""
    if reference not in TOOLFACE_REFERENCES:
        constraint = f"must be {', '.join(TOOLFACE_REFERENCES[:-1])} or {TOOLFACE_REFERENCES[-1]}"
        raise ParameterError("toolface_reference", constraint, reference)
    return float(TOOLFACE_REFERENCES.index(reference))


def input_schedule(
    columns: Columns, bit_depth: float | None, interpolation: str
) -> tuple[Schedule | None, InputSchedule | None]:
    """The schedule of the steering force, if its column is there, and that of the other inputs.

    `columns` has one of `LENGTHS`, and some of the `NAMES_OF_COLUMNS`; the rest is as in `force_schedule`. The `SIDES`
    go with the force.
    """
    given = {name: values for name, values in columns.items() if name in NAMES_OF_COLUMNS}
    sides = {name: given.pop(name) for name in SIDES if name in given}
    force, schedule = given.pop("rss_force", None), None
    if sides and force is None:
        name, values = next(iter(sides.items()))
        raise ParameterError(name, "must come with rss_force, the force to that side", values)
    if force is not None:
        references = sides.get("toolface_reference", ())
        check_quantity("toolface_reference", references)
        names = tuple(TOOLFACE_REFERENCES[int(number)] for number in references)
        toolface = sides.get("rss_toolface", ())
        schedule = _steering(columns, force, toolface, names, bit_depth, interpolation)
    lengths, entries = _over_length(columns, given, bit_depth, interpolation)
    inputs = zip(given, entries, strict=True)
    return schedule, InputSchedule(lengths, tuple(inputs), interpolation) if given else None


def steered(full_force: float, duty: Column, toolface_deg: Column) -> Column:
    """The steering force, N, of a tool that pushes for a share `duty` of the time to the side `toolface_deg`.

    Raises
    ------
    ParameterError
        If the force is negative, a duty is not a share, or the counts differ.
    """
    check_number("full_force", full_force, at_least=0.0)
    check_quantity("duty", duty)
    if len(duty) != len(toolface_deg):
        raise ParameterError("rss_toolface", f"must hold one value per duty, {len(duty)} in all", toolface_deg)
    return tuple(full_force * share for share in duty)


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

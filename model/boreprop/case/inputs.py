"""Schedules: what acts on the bit over the drilled length."""

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import cos, sin
from typing import Any, NamedTuple

from ..core.checks import (
    check_increasing,
    check_number,
    check_part,
    check_quantity,
    check_value,
    checked_float,
    numbers,
    take_fields,
)
from ..core.errors import ParameterError
from ..core.quantities import CLEARANCES, INPUTS, TOOLFACE_REFERENCES, quantity_of

CLOSE = 0.005  # m: depths are given to the centimetre, so a first entry this little beyond the bit is at it
INTERPOLATIONS = ("held", "linear")
NAMES_OF_COLUMNS = (*(quantity.name for quantity in INPUTS), *CLEARANCES)
"""What a schedule may give: inputs, and clearances."""
RATE = "rate_of_penetration"
UP_OR_DOWN = 1e-12  # sine of a toolface: degrees in radians are not exact


class Profile(NamedTuple):
    """One input over the drilled length: its entries, and whether it is linear or constant from each to the next."""

    drilled_length: tuple[float, ...]
    values: tuple[float, ...]
    linear: bool = False


@dataclass(frozen=True)
class Schedule:
    """The force of the steering pads over the drilled length, constant or linear from each entry to the next.

    Parameters
    ----------
    drilled_length
        Lengths from the start of the run at which an entry begins, m, shape (k,). The first is 0, and they increase.
    rss_force
        The force at each of these lengths, N, shape (k,); the last one acts to the end of the run. A positive force
        builds inclination.
    interpolation
        "held": each force acts up to the next length; "linear": it changes evenly to the next one.
    rss_toolface
        Side to which the pads push from each of these lengths on, rad, shape (k,), looking down the hole: 0 up or
        north, π/2 to the right. Empty: up, and a negative force pushes down; so become 0 and π against gravity.
    toolface_reference
        From where each toolface counts, one of `TOOLFACE_REFERENCES`, shape (k,). Empty: from the high side.

    Raises
    ------
    ParameterError
        If a value is not finite, the lengths do not start at 0 or do not increase, the shapes differ, or there is no
        such interpolation or reference.

    Examples
    --------
    >>> from boreprop import Schedule
    >>> Schedule(drilled_length=(0.0, 50.0), rss_force=(0.0, 8e3)).rss_force[1]
    8000.0
    """

    drilled_length: tuple[float, ...] = (0.0,)
    rss_force: tuple[float, ...] = (0.0,)
    interpolation: str = "held"
    rss_toolface: tuple[float, ...] = ()
    toolface_reference: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        take_fields("schedule", self)
        _check_entries(self.drilled_length, {"rss_force": self.rss_force}, self.interpolation)
        for index, reference in enumerate(self.toolface_reference, 1):
            if reference not in TOOLFACE_REFERENCES:
                constraint = f"must be {', '.join(TOOLFACE_REFERENCES[:-1])} or {TOOLFACE_REFERENCES[-1]}"
                raise ParameterError(f"toolface_reference[{index}]", constraint, reference)
        up_or_down = signed(self.rss_force, self.rss_toolface, self.toolface_reference)
        if up_or_down is not None:
            for name, value in (("rss_force", up_or_down), ("rss_toolface", ()), ("toolface_reference", ())):
                object.__setattr__(self, name, value)
        if self.steers_in_space:
            count = len(self.drilled_length)
            columns: dict[str, tuple[Any, ...]] = {
                "rss_toolface": self.rss_toolface or (0.0,) * count,
                "toolface_reference": self.toolface_reference or TOOLFACE_REFERENCES[:1] * count,
            }
            _check_entries(self.drilled_length, columns, self.interpolation)
            for name, values in columns.items():
                object.__setattr__(self, name, values)
        check_part("schedule", self)

    @property
    def steers_in_space(self) -> bool:
        """Whether the pads push to other sides than up and down."""
        return bool(self.rss_toolface or self.toolface_reference)

    def profile(self) -> Profile:
        """The force over the drilled length."""
        return Profile(self.drilled_length, self.rss_force, self.interpolation == "linear")

    def sides(self) -> dict[str, Profile]:
        """Toolface and its reference over the drilled length, as an engine in space takes them."""
        if not self.steers_in_space:
            return {name: Profile((0.0,), (0.0,)) for name in ("rss_toolface", "toolface_reference")}
        references = tuple(float(TOOLFACE_REFERENCES.index(name)) for name in self.toolface_reference)
        return {
            "rss_toolface": Profile(self.drilled_length, self.rss_toolface),
            "toolface_reference": Profile(self.drilled_length, references),
        }

    @classmethod
    def by_depth(
        cls,
        measured_depth: tuple[float, ...],
        rss_force: tuple[float, ...],
        bit_depth: float,
        interpolation: str = "held",
    ) -> "Schedule":
        """A schedule whose entries begin at measured depths.

        Parameters
        ----------
        measured_depth
            Depths at which an entry begins, m, increasing, shape (k,). The first one is not beyond the bit; what lies
            above the bit is left out.
        rss_force
            The force at each of these depths, N, shape (k,).
        bit_depth
            Measured depth of the bit at the start of the run, m: that of the last station of a `Survey`.
        interpolation
            See `Schedule`.

        Returns
        -------
        Schedule
            The same forces over the drilled length.

        Raises
        ------
        ParameterError
            If the first entry lies beyond the bit, for then no force is given at the start; or as for any schedule.

        Examples
        --------
        >>> from boreprop import Schedule
        >>> schedule = Schedule.by_depth((2500.0, 2590.0, 2600.0), (0.0, 8e3, 4e3), bit_depth=2594.0)
        >>> schedule.drilled_length, schedule.rss_force
        ((0.0, 6.0), (8000.0, 4000.0))
        """
        depths, forces = numbers("measured_depth", measured_depth), {"rss_force": numbers("rss_force", rss_force)}
        drilled_length, [force] = from_bit(depths, forces, checked_float("bit_depth", bit_depth), interpolation)
        return cls(drilled_length, force, interpolation)


@dataclass(frozen=True)
class InputSchedule:
    """Other inputs than the force over the drilled length, constant or linear from each entry to the next.

    Parameters
    ----------
    drilled_length
        Lengths from the start of the run at which an entry begins, m, shape (k,). The first is 0, and they increase.
    inputs
        Name of each input in the table of quantities, or of a clearance, and its value at each of these lengths, in SI
        units, shape (k,).
    interpolation
        "held" or "linear". Clearances, the whole weight on bit and the rate of penetration are always constant from
        each entry to the next.

    Raises
    ------
    ParameterError
        If a name is of no input, a value is out of range, the lengths do not start at 0 or do not increase, the shapes
        differ, there is no such interpolation, a rate of penetration is 0, with which no next entry would be reached,
        or all of the weight is less than the active weight up to the next entry.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from boreprop import InputSchedule, paper_case, simulate
    >>> weights = (("active_weight_on_bit", (2e3, 3e3)),)
    >>> case = replace(paper_case(), inputs=InputSchedule((0.0, 10.0), weights, "linear"))
    >>> simulate(case, length=20.0, sample_interval=5.0)["active_weight_on_bit"].tolist()
    [2000.0, 2500.0, 3000.0, 3000.0, 3000.0]
    """

    drilled_length: tuple[float, ...]
    inputs: tuple[tuple[str, tuple[float, ...]], ...]
    interpolation: str = "held"

    def __post_init__(self) -> None:
        object.__setattr__(self, "drilled_length", numbers("drilled_length", self.drilled_length))
        object.__setattr__(self, "inputs", tuple(_columns(self.inputs)))
        _check_entries(self.drilled_length, dict(self.inputs), self.interpolation)
        for name, values in self.inputs:
            for index, value in enumerate(values, 1):
                check_value(name, value, index)
            if name == RATE:
                for index, value in enumerate(values, 1):
                    check_number(name, value, index=index, above=0.0)
        self._check_weights()

    def _check_weights(self) -> None:
        """Raise `ParameterError` unless all of the weight, which is held, is as much as drills up to the next entry."""
        columns, reach = dict(self.inputs), 2 if self.interpolation == "linear" else 1
        active = columns.get("active_weight_on_bit", ())
        for k, weight in enumerate(columns.get("weight_on_bit", ())):
            if weight and active:
                check_number("weight_on_bit", weight, index=k + 1, at_least=max(active[k : k + reach]))

    def profiles(self) -> dict[str, Profile]:
        """Each input over the drilled length."""
        linear = self.interpolation == "linear"
        return {
            name: Profile(self.drilled_length, values, linear and quantity_of(name).slope)
            for name, values in self.inputs
        }

    def without(self, name: str) -> "InputSchedule | None":
        """The same without one of the inputs; None if it is the only one."""
        left = tuple((other, values) for other, values in self.inputs if other != name)
        return replace(self, inputs=left) if left else None


def _columns(inputs: Any) -> Iterator[tuple[str, tuple[float, ...]]]:
    """Pairs of the name of an input and its values; `ParameterError` if they are something else."""
    try:
        columns = dict(inputs)
    except (TypeError, ValueError):
        raise ParameterError("inputs", "must be pairs of a name and its values", inputs) from None
    for name, values in columns.items():
        if name not in NAMES_OF_COLUMNS:
            raise ParameterError("inputs", f"must be some of {', '.join(NAMES_OF_COLUMNS)}", name)
        yield name, numbers(name, values)


def signed(
    force: tuple[float, ...], toolface: tuple[float, ...], reference: tuple[str, ...]
) -> tuple[float, ...] | None:
    """The force where it pushes up and down only, negative down; None where it pushes to other sides.

    Raises `ParameterError` if a toolface is beyond a whole turn.
    """
    check_quantity("rss_toolface", toolface)
    if set(reference) - {"gravity"} or len(toolface) not in (0, len(force)):
        return None
    if any(abs(sin(angle)) > UP_OR_DOWN for angle in toolface):
        return None
    return tuple(f * (1.0 if cos(angle) > 0.0 else -1.0) for f, angle in zip(force, toolface, strict=False)) or force


def _check_entries(lengths: tuple[float, ...], columns: Mapping[str, tuple[Any, ...]], interpolation: str) -> None:
    """Raise `ParameterError` unless columns have an entry for each length, and these increase from 0."""
    if not lengths or lengths[0] != 0.0:
        raise ParameterError("drilled_length", "must start at 0", lengths)
    check_increasing("drilled_length", lengths)
    for name, values in columns.items():
        if len(values) != len(lengths):
            raise ParameterError(name, f"must hold one value per drilled_length, {len(lengths)} in all", values)
    if interpolation not in INTERPOLATIONS:
        raise ParameterError("interpolation", f"must be {' or '.join(INTERPOLATIONS)}", interpolation)


def from_bit(
    measured_depth: tuple[float, ...], columns: Mapping[str, tuple[float, ...]], bit_depth: float, interpolation: str
) -> tuple[tuple[float, ...], list[tuple[float, ...]]]:
    """Entries at measured depths as such at drilled lengths, see `Schedule.by_depth`: the lengths, and each column."""
    check_increasing("measured_depth", measured_depth)
    if not measured_depth or measured_depth[0] > bit_depth + CLOSE:
        constraint = f"must start at {bit_depth:.9g} or before, where the bit starts"
        raise ParameterError("measured_depth", constraint, measured_depth)
    for name, values in columns.items():
        if len(values) != len(measured_depth):
            constraint = f"must hold one value per measured_depth, {len(measured_depth)} in all"
            raise ParameterError(name, constraint, values)
    first = max(bisect_right(measured_depth, bit_depth) - 1, 0)
    later = tuple(depth - bit_depth for depth in measured_depth[first + 1 :])
    share = 0.0  # of the way from the entry before the bit to the next one
    if interpolation == "linear" and later and measured_depth[first] < bit_depth:
        share = (bit_depth - measured_depth[first]) / (measured_depth[first + 1] - measured_depth[first])
    starts = [
        values[first] + share * (values[first + 1] - values[first]) if share else values[first]
        for values in columns.values()
    ]
    return (0.0, *later), [(at, *values[first + 1 :]) for at, values in zip(starts, columns.values(), strict=True)]

"""A case: the drilling system, the existing hole, the active weight on bit, the steering force and the length."""

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import repeat
from operator import attrgetter
from typing import NamedTuple

from ..core.checks import check_increasing, check_number, check_part, check_quantity, check_value, checked_float
from ..core.errors import ParameterError
from ..core.ground import Ground, Wear
from ..core.quantities import BY_NAME, CLEARANCES, INPUTS, ROCK, Structure, quantity_of
from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly, eta_pi
from .formations import DEPTHS, Formation
from .sensors import with_clearances

CLOSE = 0.005  # m: depths are given to the centimetre, so a first entry this little beyond the bit is at it


INTERPOLATIONS = ("held", "linear")
RATE = "rate_of_penetration"


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

    Raises
    ------
    ParameterError
        If a value is not finite, the lengths do not start at 0 or do not increase, the two shapes differ, or there is
        no such interpolation.

    Examples
    --------
    >>> from boreprop import Schedule
    >>> Schedule(drilled_length=(0.0, 50.0), rss_force=(0.0, 8e3)).rss_force[1]
    8000.0
    """

    drilled_length: tuple[float, ...] = (0.0,)
    rss_force: tuple[float, ...] = (0.0,)
    interpolation: str = "held"

    def __post_init__(self) -> None:
        for name in ("drilled_length", "rss_force"):
            object.__setattr__(self, name, tuple(map(checked_float, repeat(name), getattr(self, name))))
        _check_entries(self.drilled_length, {"rss_force": self.rss_force}, self.interpolation)
        check_part("schedule", self)

    def profile(self) -> Profile:
        """The force over the drilled length."""
        return Profile(self.drilled_length, self.rss_force, self.interpolation == "linear")

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
        drilled_length, [force] = from_bit(measured_depth, {"rss_force": rss_force}, bit_depth, interpolation)
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
        "held" or "linear". Bit and rock, clearances, the whole weight on bit and the rate of penetration are always
        constant from each entry to the next.

    Raises
    ------
    ParameterError
        If a value is out of range, the lengths do not start at 0 or do not increase, the shapes differ, there is no
        such interpolation, or a rate of penetration is 0, with which no next entry would be reached.

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
        _check_entries(self.drilled_length, dict(self.inputs), self.interpolation)
        for name, values in self.inputs:
            for index, value in enumerate(values, 1):
                check_value(name, value, index)
            if name == RATE:
                for index, value in enumerate(values, 1):
                    check_number(name, value, index=index, above=0.0)

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


def _check_entries(lengths: tuple[float, ...], columns: Mapping[str, tuple[float, ...]], interpolation: str) -> None:
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


@dataclass(frozen=True)
class Case:
    """What is drilled: the drilling system, the existing hole, active weight on bit, steering force and length.

    Parameters
    ----------
    bha
        The bottom-hole assembly.
    bit
        The law of bit and rock.
    bit_diameter
        Diameter of the hole, m. It is used for drawing only and does not enter the physics.
    active_weight_on_bit
        The part of the weight on bit that drills, Π F* in the paper, N.
    length
        Length to drill, m.
    survey
        The existing hole. Its last station is the bit at the start of the run.
    schedule
        The steering force over the drilled length; without it there is none.
    inputs
        Other inputs over the drilled length; None: they are constant. Those in it take the place of the weights and of
        the properties of `bit`, which are then those at the start.
    weight_on_bit
        All of the weight on bit, N, which presses a BHA with `axial_load`; 0: it is the active weight on bit.
    formations
        Bit and rock from increasing depths on, all measured or all true vertical ones, in place of `bit`, which is then
        the one at the start.
    true_vertical_depth
        That of the bit at the start, m, from which those of formations count.
    wear
        How the bit becomes blunt; None: it stays sharp.

    Raises
    ------
    ParameterError
        If the diameter, the weight or the length is not finite and positive, the diameter is beyond 1.5 m, the depths
        of formations do not increase or are of both kinds, or they give what `inputs` gives.

    Examples
    --------
    >>> from boreprop import paper_case
    >>> case = paper_case()
    >>> round(case.eta_pi, 4), case.length_scale
    (0.01, 3.66)
    """

    bha: BottomHoleAssembly
    bit: BitRock
    bit_diameter: float
    active_weight_on_bit: float
    length: float
    survey: Survey
    schedule: Schedule = Schedule()
    inputs: InputSchedule | None = None
    weight_on_bit: float = 0.0
    formations: tuple[Formation, ...] = ()
    true_vertical_depth: float = 0.0
    wear: Wear | None = None

    def __post_init__(self) -> None:
        if self.in_layers and not all(formation.measured_depth is None for formation in self.formations):
            depths = tuple(formation.depth for formation in self.formations)
            raise ParameterError("true_vertical_depth", "must be given of all formations, or of none", depths)
        name = DEPTHS[self.in_layers]
        check_increasing(name, tuple(formation.depth for formation in self.formations))
        check_quantity("bit_true_vertical_depth", self.true_vertical_depth)
        self._take_first_inputs()
        check_part("", self)
        object.__setattr__(self, "bha", with_clearances(self.bha, self.bit_diameter))
        if self.weight_on_bit:
            check_number("weight_on_bit", self.weight_on_bit, at_least=self.active_weight_on_bit)

    def _take_first_inputs(self) -> None:
        """Let weights, bit and clearances be those at the start where they are scheduled."""
        scheduled, bit = dict(self.inputs.inputs) if self.inputs else {}, {}
        clearances = list(self.bha.stabilizer_clearances)
        for name, values in scheduled.items():
            quantity = quantity_of(name)
            if quantity.part == "bit":
                bit[quantity.attribute] = values[0]
            elif name in CLEARANCES:
                i = CLEARANCES.index(name)
                if i >= len(clearances):
                    raise ParameterError(name, f"must be of one of the {len(clearances)} non-ideal stabilizers", values)
                clearances[i] = values[0]
            elif quantity.field and not quantity.part:
                object.__setattr__(self, quantity.attribute, values[0])
        start = self._depth + CLOSE
        for formation in self.formations:
            for name, value in formation.values.items():
                if name in scheduled:
                    raise ParameterError(name, "must be given by formations or a schedule, not by both", value)
                if formation.depth <= start:
                    bit[BY_NAME[name].attribute] = value
        if bit:
            object.__setattr__(self, "bit", replace(self.bit, **bit))
        if tuple(clearances) != self.bha.stabilizer_clearances:
            object.__setattr__(self, "bha", replace(self.bha, stabilizer_clearances=tuple(clearances)))

    @cached_property
    def in_layers(self) -> bool:
        """Whether formations begin at true vertical depths."""
        return any(formation.true_vertical_depth is not None for formation in self.formations)

    @property
    def _depth(self) -> float:
        """Depth of the bit at the start, m, of the kind by which formations begin."""
        return self.true_vertical_depth if self.in_layers else self.survey.measured_depth[-1]

    @property
    def structure(self) -> Structure:
        """How the drilling system is made up, and whether rock comes in layers."""
        return self.bha.structure._replace(layered=int(self.in_layers))

    @cached_property
    def ground(self) -> Ground | None:
        """Layers and wear as an engine takes them; None if there are neither."""
        if not self.in_layers:
            return Ground(self.bit, wear=self.wear) if self.wear else None
        start = self._depth
        tops = tuple(formation.depth - start for formation in self.formations)
        tops = tuple(0.0 if 0.0 < top <= CLOSE else top for top in tops)
        rock = [(0.0,) * len(ROCK)]
        for formation in self.formations:
            rock.append(tuple(formation.values.get(name, above) for name, above in zip(ROCK, rock[-1], strict=True)))
        return Ground(self.bit, tops, tuple(rock), self.wear)

    def _in_formations(self) -> dict[str, Profile]:
        """What bit and rock are like over the drilled length, by name, as far as formations say it."""
        found: dict[str, Profile] = {}
        start = self._depth
        if self.in_layers:  # where they are met shows along the way
            return found
        for name in {name: 0 for formation in self.formations for name in formation.values}:
            entries = {0.0: float(attrgetter(BY_NAME[name].field)(self))}
            for formation in self.formations:
                ahead = formation.depth - start
                if ahead > CLOSE and name in formation.values:
                    entries[ahead] = formation.values[name]
            found[name] = Profile(tuple(entries), tuple(entries.values()))
        return found

    def profiles(self) -> dict[str, Profile]:
        """Each input that the case gives over the drilled length, by name."""
        constant = {
            quantity.name: Profile((0.0,), (attrgetter(quantity.field)(self),))
            for quantity in INPUTS
            if quantity.field and quantity.part != "schedule" and quantity.count(self.bha.structure)
        }
        scheduled = self.inputs.profiles() if self.inputs else {}
        return {"rss_force": self.schedule.profile()} | constant | self._in_formations() | scheduled

    @property
    def length_scale(self) -> float:
        """ℓ₁, m: the distance from the bit to the first stabilizer."""
        return self.bha.length_scale

    @property
    def eta_pi(self) -> float:
        """ηΠ: the stiffness of the rock over that of the BHA, dimensionless, eq. (9)."""
        return eta_pi(self.bha, self.bit, self.active_weight_on_bit)

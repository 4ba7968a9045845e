"""A case: the drilling system, the existing hole, the active weight on bit, the steering force and the length."""

from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter

from ..core.checks import check_increasing, check_number, check_part, check_quantity, take_fields
from ..core.errors import ParameterError
from ..core.ground import Ground, Wear
from ..core.quantities import BY_NAME, CLEARANCES, INPUTS, ROCK, Structure, quantity_of
from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly, check_in_plane, eta_pi
from .formations import DEPTHS, Formation
from .inputs import CLOSE, InputSchedule, Profile, Schedule
from .sensors import with_clearances


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
    dimensions
        3: it is drilled in space in any case, see `in_space`.

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
    schedule: Schedule = Schedule()  # noqa: RUF009 - frozen
    inputs: InputSchedule | None = None
    weight_on_bit: float = 0.0
    formations: tuple[Formation, ...] = ()
    true_vertical_depth: float = 0.0
    wear: Wear | None = None
    dimensions: int = 2

    def __post_init__(self) -> None:
        take_fields("", self)
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

    @cached_property
    def in_space(self) -> bool:
        """Whether it is drilled in space: it has an azimuth, a side to steer to, a walk angle, or three dimensions."""
        walks = self.inputs is not None and any(map(any, (v for k, v in self.inputs.inputs if k == "bit_walk_angle")))
        return (
            self.dimensions == 3
            or bool(self.survey.azimuth)
            or self.bit.walk_angle != 0.0
            or self.schedule.steers_in_space
            or walks
        )

    @cached_property
    def structure(self) -> Structure:
        """How the drilling system is made up, whether rock comes in layers, and whether it is drilled in space."""
        return self.bha.structure._replace(layered=int(self.in_layers), space=int(self.in_space))

    @cached_property
    def ground(self) -> Ground | None:
        """Layers and wear as an engine takes them; None if there are neither."""
        if not self.in_layers:
            return Ground(self.bit, wear=self.wear) if self.wear else None
        start = self._depth
        tops = tuple(formation.depth - start for formation in self.formations)
        near = max((top for top in tops if 0.0 < top <= CLOSE), default=0.0)  # the bit is at it, as if it were deeper
        tops = tuple(top - near if top <= near else top for top in tops)
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
            if quantity.field and quantity.part != "schedule" and quantity.count(self.structure)
        } | (self.schedule.sides() if self.in_space else {})
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


def in_dimensions(case: Case, dimensions: int) -> Case:
    """The case as it is drilled in so many dimensions.

    Raises
    ------
    ParameterError
        If they are neither 2 nor 3, or the case leaves the plane.
    """
    made = replace(case, dimensions=dimensions)
    if dimensions == 2 and made.in_space:
        constraint = "must be 3 for a case with an azimuth, a walk angle or a toolface other than 0 or 180"
        raise ParameterError("dimensions", constraint, dimensions)
    return made


def check_plane(case: Case) -> None:
    """Raise `ParameterError` if a case leaves its vertical plane; a constant azimuth only says where that is."""
    if case.survey.turns:
        constraint = "must be the same at all stations for what drills in a plane; boreprop simulate takes others"
        raise ParameterError("azimuth", constraint, case.survey.azimuth)
    if case.schedule.steers_in_space:
        constraint = "must be 0 or 180 for what drills in a plane; boreprop simulate takes others"
        raise ParameterError("rss_toolface", constraint, case.schedule.rss_toolface)
    check_in_plane(case.bit)

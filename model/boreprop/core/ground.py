"""What the bit meets along the way: layers of rock by true vertical depth, and the wear of the bit."""

from array import array
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from math import inf
from typing import Any, NamedTuple

from .checks import check_increasing, check_number, take_fields
from .errors import CannotContinue, ParameterError
from .events import crossing, extremes
from .problems import Problem
from .quantities import ROCK, fields_of, values_of
from .step import Step
from .system import BitRock

STAY = 0.01  # m: a bit that has met a layer drills so far in it at least. Along a boundary between rocks of which each
# turns it into the other it would else go to and fro without end
ROUNDING = 1e-12  # relative: a length so little before that of a change is at it
LEAST_SHARE = 1e-3  # of the weight that wear flats bear is left as active weight, at least
LOOKS = 4  # of a step, at whose ends the depth is looked at: between them it is smooth


@dataclass(frozen=True)
class Wear:
    """How a bit becomes blunt: the weight G that its wear flats bear grows with the drilled length, eq. (3).

    The active weight on bit is what is given for a sharp bit, less G.

    Parameters
    ----------
    weight_per_metre
        Growth of G per metre drilled, N/m.
    largest_weight
        At which G stays, N.

    Raises
    ------
    ParameterError
        If one of them is not finite and positive.
    """

    weight_per_metre: float
    largest_weight: float

    def __post_init__(self) -> None:
        take_fields("wear", self)
        check_number("weight_per_metre", self.weight_per_metre, above=0.0)
        check_number("largest_weight", self.largest_weight, above=0.0)

    @property
    def length(self) -> float:
        """Drilled length at which G is the largest, m."""
        return self.largest_weight / self.weight_per_metre


@dataclass(frozen=True)
class Ground:
    """Layers of rock by depth, and wear.

    Parameters
    ----------
    bit
        Bit and rock that are given unless somebody gives others: only for these values the layers stand in.
    tops
        Depth below the bit at the start at which each layer begins, m, increasing; the first layer has no top.
    rock
        η, χ and ψ* in each layer, beginning with that above all tops, shape (tops + 1, 3); 0 where what is given holds.
    wear
        How the bit becomes blunt; None: it stays sharp.

    Raises
    ------
    ParameterError
        If the tops do not increase, or the shapes differ.
    """

    bit: BitRock
    tops: tuple[float, ...] = ()
    rock: tuple[tuple[float, ...], ...] = ((0.0,) * len(ROCK),)
    wear: Wear | None = None

    def __post_init__(self) -> None:
        check_increasing("true_vertical_depth", self.tops)
        if len(self.rock) != len(self.tops) + 1 or any(len(row) != len(ROCK) for row in self.rock):
            raise ParameterError("rock", f"must hold {len(self.tops) + 1} times {', '.join(ROCK)}", self.rock)

    @cached_property
    def numbers(self) -> "array[float]":
        """All of it, in the order in which the kernel takes it: the rock, layer by layer, comes last."""
        given = values_of("bit", self.bit)
        wear = (self.wear.weight_per_metre, self.wear.largest_weight) if self.wear else (0.0, 0.0)
        return array("d", [*(given[name] for name in ROCK), *wear, *self.tops, *chain.from_iterable(self.rock)])

    @property
    def first_layer(self) -> int:
        """The layer in which the bit starts."""
        return bisect_right(self.tops, 0.0)

    def bounds(self, layer: int) -> tuple[float, float]:
        """Depths below the start between which a layer lies, m."""
        return (
            self.tops[layer - 1] if layer else -inf,
            self.tops[layer] if layer < len(self.tops) else inf,
        )

    def bit_in(
        self, layer: int, given: BitRock, slopes: Sequence[float] = (0.0,) * len(ROCK), way: float = 0.0
    ) -> BitRock:
        """Bit and rock in a layer, a length `way` ahead of where some are given with slopes per metre.

        For a property that changes along the way no layer stands in.
        """
        own, values = values_of("bit", self.bit), values_of("bit", given)
        changed = {
            name: value if value and values[name] == own[name] and not slope else values[name] + slope * way
            for name, value, slope in zip(ROCK, self.rock[layer], slopes, strict=True)
        }
        return BitRock(**fields_of("bit", values | changed, 1))

    def active(self, length: float, end: float, weight: float, slope: float) -> tuple[float, float, float]:
        """The active weight on bit, N, its change per metre, and up to which drilled length it goes on so.

        `weight` and `slope` are those of a sharp bit where `length` is drilled; `CannotContinue` if before `end` the
        wear flats bear all of it.
        """
        if self.wear is None:
            return weight, slope, inf
        until = self.wear.length if length < self.wear.length * (1 - ROUNDING) else inf
        blunt = self.wear.weight_per_metre * length if until < inf else self.wear.largest_weight
        weight, slope = weight - blunt, slope - (self.wear.weight_per_metre if until < inf else 0.0)
        least, way = LEAST_SHARE * blunt, min(end, until) - length
        if not weight > least or not weight + slope * way > least:
            place = length if weight <= least else length - weight / slope
            raise CannotContinue(Problem("worn out", limit=blunt, place=place))
        return weight, slope, until


def ground_of(fields: dict[str, Any]) -> Ground:
    """A ground from its fields as `dataclasses.asdict` gives them, also after a journey through JSON."""
    wear = fields["wear"]
    rock = tuple(tuple(row) for row in fields["rock"])
    return Ground(BitRock(**fields["bit"]), tuple(fields["tops"]), rock, wear and Wear(**wear))


def check_step(ground: Ground | None) -> None:
    """Raise `ParameterError` if a run may not take a step of the integrator alone, which passes layers by."""
    if ground is not None:
        raise ParameterError("ground", "must be None for single steps of the integrator", ground)


class Exit(NamedTuple):
    """Where the bit leaves a layer: at `xi`, on `side` 1 below, −1 above."""

    xi: float
    side: int


def first_exit(step: Step, depth: float, bounds: tuple[float, float], begin: float) -> Exit | None:
    """Where the bit first is outside of its layer along a step, from `begin` on; None if nowhere.

    The step starts at `depth`, and the layer lies between the `bounds`, in the unit of the step.
    """
    way, (top, bottom) = step.end - step.xi, (bound - depth for bound in bounds)
    if begin > step.end or (-way > top and way < bottom):  # a path is no deeper than long
        return None

    def below(xi: float) -> float:
        return step.displacement(xi)[1]

    samples = [(xi, below(xi)) for xi in (begin + k / LOOKS * (step.end - begin) for k in range(LOOKS))]
    samples.append((step.end, below(step.end)))
    if step.end > begin:
        samples += [(xi, below(xi)) for xi in extremes(samples)]
        samples.sort()
    before = begin
    for at, value in samples:
        if value > bottom or value < top:
            side, limit = (1, bottom) if value > bottom else (-1, top)
            return Exit(at if at == begin else _passing(step, limit, side, before, at), side)
        before = at
    return None


def _passing(step: Step, limit: float, side: int, before: float, after: float) -> float:
    """Where the bit passes a depth below the start of a step on `side`, beyond which it is at `after`."""

    def beyond(xi: float) -> float:
        return side * (step.displacement(xi)[1] - limit)

    return crossing(beyond, before, after, beyond(after))

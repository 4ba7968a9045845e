"""The questions of `boreprop new`: what an engineer knows of an assembly, a bit and a hole."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf

from ..case.template import SECTION, Answer, sections
from ..core.quantities import MAX_SECTIONS, MAX_STABILIZERS
from ..core.system import LEAST_SPAN
from ..errors import InputError, shown
from ..units import read_amounts

Answers = Mapping[str, Answer]

OUTER = (0.03, 0.5)  # m, of a collar
LENGTHS = (0.05, 200.0)  # m, of a section
LEAST_FORCE = 100.0  # N: a smaller one is a number of kN or klbf without its unit
COLLARS = (
    (0.145, "3 1/2 in", "1 1/2 in"),
    (0.18, "4 3/4 in", "2 1/4 in"),
    (0.25, "6 3/4 in", "2 13/16 in"),
    (0.4, "8 1/4 in", "2 13/16 in"),
    (inf, "9 1/2 in", "3 in"),
)
"""Up to which hole, m, a collar of which outer and inner diameter is usual."""


@dataclass(frozen=True)
class Question:
    """A question, which an option of the same name answers.

    Parameters
    ----------
    name
        The name of its `Answer`; that of the option has hyphens.
    asks
        What is asked, without the unit.
    unit
        The unit of the answer's values, and of a number without a unit.
    usual
        The answer that is offered; it may depend on earlier answers.
    at_least, at_most
        The accepted range of each value, in `unit`.
    broken
        The constraint that the values break given the earlier answers, in words; empty if they break none. None: no
        values do.
    several
        Whether the answer may hold several values.
    needed
        Whether earlier answers leave anything to ask. None: they always do.
    """

    name: str
    asks: str
    unit: str
    usual: str | Callable[[Answers], str]
    at_least: float
    at_most: float
    broken: Callable[[tuple[float, ...], Answers], str] | None = None
    several: bool = False
    needed: Callable[[Answers], bool] | None = None

    @property
    def option(self) -> str:
        """The option that answers it."""
        return f"--{self.name.replace('_', '-')}"

    @property
    def in_words(self) -> str:
        """The question with the unit of a number that has none."""
        return f"{self.asks} ({self.unit or 'a share or %'})"

    def offered(self, before: Answers) -> str:
        """The usual answer after the answers `before`."""
        return self.usual if isinstance(self.usual, str) else self.usual(before)

    def read(self, text: str) -> Answer:
        """The answer that a text gives; `InputError`, which names the option, if it gives none in the range."""
        try:
            values = read_amounts(text, self.unit)
        except ValueError:
            values = ()
        if not values or (len(values) > 1 and not self.several):
            numbers = "numbers between commas" if self.several else "a number"
            raise self.error(f"must be {numbers} with or without a unit, such as {self.offered({})}", text)
        if not all(self.at_least <= value <= self.at_most for value in values):
            bare = f"a number without a unit is in {self.unit}" if self.unit else "of 1, or with %"
            raise self.error(f"must be {self.at_least:g} to {self.at_most:g} {self.unit} ({bare})", text)
        return Answer(values, " ".join(text.split()))

    def check(self, answer: Answer, before: Answers) -> Answer:
        """The same answer; `InputError`, which names the option, if it does not go with the answers before it."""
        constraint = self.broken(answer.values, before) if self.broken else ""
        if constraint:
            raise self.error(constraint, answer.text)
        return answer

    def error(self, constraint: str, text: str) -> InputError:
        """The error of an answer, or of none at all, that breaks a constraint."""
        return InputError(f"{self.option}: {constraint}, got {shown(text) if text else 'nothing'}")


def _collar(part: int) -> Callable[[Answers], str]:
    """The usual outer (1) or inner (2) diameter of a collar for the hole."""

    def usual(before: Answers) -> str:
        size = before["hole_size"].value if "hole_size" in before else 0.2159
        return next(str(collar[part]) for collar in COLLARS if size <= collar[0])

    return usual


def _below(other: str, what: str) -> Callable[[tuple[float, ...], Answers], str]:
    """A rule: less than the answer to another question."""
    return lambda values, before: (
        "" if values[0] < before[other].value else f"must be less than the {what} of {before[other].text}"
    )


def _positions(values: tuple[float, ...], before: Answers) -> str:
    if len(values) > MAX_STABILIZERS:
        return f"must be 1 to {MAX_STABILIZERS} positions"
    if sections(before) and values[-1] > sum(length for length, _, _ in sections(before)) * (1 + 1e-9):
        return f"must not lie beyond the sections, which reach to {sum(s[0] for s in sections(before)):.6g} m together"
    apart = all(above - below >= LEAST_SPAN * (1 - 1e-9) for below, above in pairwise(values))
    return "" if apart else f"must increase by at least {LEAST_SPAN:g} m, from the bit up"


def _under_gauge(values: tuple[float, ...], before: Answers) -> str:
    count = len(before["stabilizers"].values) - 1
    if len(values) not in (1, max(count, 1)):
        return f"must be one amount, or one for each stabilizer but the last, here {count}"
    outer = max(outer for _, outer, _ in sections(before)) if sections(before) else before["collar_outer"].value
    room = before["hole_size"].value - outer
    return "" if max(values) < room else f"must leave a blade larger than the collar, so less than {room:.4g} m"


def _pads(values: tuple[float, ...], before: Answers) -> str:
    first = before["stabilizers"].values[0]
    return "" if values[0] <= first else f"must be below the first stabilizer, at {first:g} m"


def _force(values: tuple[float, ...], _: Answers) -> str:
    return "" if values[0] == 0.0 or abs(values[0]) >= LEAST_FORCE else f"must be 0 or at least {LEAST_FORCE:g} N"


def _one_collar(before: Answers) -> bool:
    return "sections" not in before


def _several_stabilizers(before: Answers) -> bool:
    return len(before["stabilizers"].values) > 1


QUESTIONS = (
    Question("hole_size", "Diameter of the hole", "m", "8.5 in", 0.05, 1.2),
    Question(
        "collar_outer",
        "Outer diameter of the collars",
        "m",
        _collar(1),
        *OUTER,
        _below("hole_size", "hole"),
        needed=_one_collar,
    ),
    Question(
        "collar_inner",
        "Inner diameter of the collars",
        "m",
        _collar(2),
        0.0,
        0.4,
        _below("collar_outer", "outer diameter"),
        needed=_one_collar,
    ),
    Question("mud_weight", "Density of the mud", "kg/m³", "10 ppg", 500.0, 2600.0),
    Question(
        "stabilizers",
        "Positions of the stabilizers from the bit up",
        "m",
        "4.3, 12.5, 21.5 m",
        0.1,
        200.0,
        _positions,
        several=True,
    ),
    Question(
        "under_gauge",
        "What the blades lack on diameter: one amount, or one for each stabilizer but the last",
        "m",
        "1/8 in",
        0.0,
        0.2,
        _under_gauge,
        several=True,
        needed=_several_stabilizers,
    ),
    Question("rss_position", "Position of the steering pads from the bit", "m", "0.75 m", 0.0, 50.0, _pads),
    Question("rss_force", "Force of the steering pads, positive builds", "N", "10 kN", -3e5, 3e5, _force),
    Question("steerability", "Steerability of the bit: lateral over axial drillability", "", "0.05", 1e-3, 1.0),
    Question("gauge_length", "Length of the bit's gauge", "m", "2 in", 5e-3, 1.0),
    Question("gauge_relief", "What the bit's gauge lacks on diameter", "m", "1/32 in", 1e-5, 0.05),
    Question("weight_on_bit", "Weight on bit, all of it", "N", "100 kN", 1e3, 1e6),
    Question("bluntness", "Share of the weight on bit that does not drill", "", "40 %", 0.0, 0.95),
    Question("inclination", "Inclination of the existing hole", "°", "30 °", -180.0, 180.0),
    Question("measured_depth", "Measured depth of the bit", "m", "2000 m", 0.0, 2e4),
    Question("length", "Length to drill", "m", "200 m", 0.01, 2e4),
)
"""All questions, in the order in which they are asked."""


def read_sections(texts: Sequence[str], hole_size: Answer | None) -> Answer:
    """The answers to --section, one after the other; `InputError` if one is wrong or does not fit into the hole."""
    if len(texts) > MAX_SECTIONS:
        raise InputError(f"--section: must be given at most {MAX_SECTIONS} times, got {len(texts)}")
    values: tuple[float, ...] = ()
    for text in texts:
        try:
            read = read_amounts(text, "m")
        except ValueError:
            read = ()
        if len(read) != SECTION:
            constraint = "must be length, outer and inner diameter between commas, such as 9 m, 6 3/4 in, 2 13/16 in"
            raise InputError(f"--section: {constraint}, got {shown(text)}")
        length, outer, inner = read
        hole = hole_size.value if hole_size else inf
        if not (LENGTHS[0] <= length <= LENGTHS[1] and OUTER[0] <= outer <= OUTER[1]):
            constraint = f"must have a length of {LENGTHS[0]:g} to {LENGTHS[1]:g} m and an outer diameter of "
            constraint += f"{OUTER[0]:g} to {OUTER[1]:g} m (numbers without a unit have that of the next, or are in m)"
            raise InputError(f"--section: {constraint}, got {shown(text)}")
        if not 0 <= inner < outer < hole:
            constraint = "must have an inner diameter below the outer one, and that below the diameter of the hole"
            raise InputError(f"--section: {constraint}, got {shown(text)}")
        values += read
    return Answer(values, "; ".join(" ".join(text.replace(";", ",").split()) for text in texts))

"""The texts beside the pictures: whether the holes ripple, moment by moment, and the cases side by side."""

import re
from bisect import bisect
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
import rerun as rr

from boreprop.analysis.stability.contacts import can_touch
from boreprop.analysis.stability.roots import CriticalEtaPi, critical_eta_pi
from boreprop.analysis.stability.roots import Verdict as RootsVerdict
from boreprop.analysis.stability.straight import straight_drilling
from boreprop.case.case import Case
from boreprop.core.system import eta_pi
from boreprop.errors import BorepropError
from boreprop.report.tables.steering import touching
from boreprop.units import SMALL_LENGTH, UNITS

from .scales import Scales
from .source import Source
from .track import lengths_index, times_index
from .verdict import Saying, Verdict

VERDICT, CARD = "verdict", "case"
UNTIL_ITS_END = "as far as recorded: "  # of a run that is being drilled, or of which the end never came
BY_THE_ROOTS = {
    RootsVerdict.STABLE: "stable",
    RootsVerdict.DRIFT: "unstable, drifts",
    RootsVerdict.OSCILLATORY: "unstable, oscillates",
    None: "not known",
}


class Card:
    """Logs the table of the cases, and a text which at each moment says of each run what holds there.

    The runs are drawn one after the other, so the moments of the earlier ones are logged again after each.
    """

    def __init__(self, rec: rr.RecordingStream, scales: Scales, sources: Sequence[Source]) -> None:
        self.rec, self.start = rec, scales.start
        self.along = "drilled length" if self.start is None else "measured depth"
        self.names = [source.name for source in sources]
        self.sayings: list[list[Saying]] = [[] for _ in sources]
        self.going_on = [source.live for source in sources]
        facts = case_facts if scales.space is None else case_facts_in_space
        cases = table(self.names, [facts(source.case) for source in sources])
        rec.log(CARD, rr.TextDocument(cases, media_type=rr.MediaType.MARKDOWN), static=True)

    def say(self, run: int, sayings: Sequence[Saying]) -> None:
        """Log what there is to say of a run from some moments on."""
        self.sayings[run] += sayings
        self._log(sayings)

    @contextmanager
    def ending(self, run: int, verdict: Verdict, stopped: str | None) -> Iterator[None]:
        """When the block ends, log how the run ended, and all moments of all runs again.

        `stopped` is the reason why the run ended early; None if it did not, or if only the block can tell.
        """
        how, why = ("stopped", stopped) if stopped else ("", "")
        try:
            yield
        except BorepropError as error:
            how, why = "stopped", str(error)
            raise
        except BaseException:
            how = "interrupted"
            raise
        finally:
            self.sayings[run] += verdict.end(how, why)
            self.going_on[run] = False
            self._log([saying for said in self.sayings for saying in said])

    def _log(self, sayings: Sequence[Saying]) -> None:
        """Log the text at the moments of some sayings, on each timeline."""
        lengths = sorted({saying.length for saying in sayings})
        times = sorted({saying.time for saying in sayings if saying.time is not None})
        by_length = [[saying.length for saying in said] for said in self.sayings]
        by_time = [[np.inf if saying.time is None else saying.time for saying in said] for said in self.sayings]
        self._send(lengths_index(self.start, np.array(lengths)), [self._text(by_length, at) for at in lengths])
        self._send([times_index(np.array(times))], [self._text(by_time, at) for at in times])

    def _send(self, index: Sequence[rr.TimeColumn], texts: list[str]) -> None:
        if texts:
            media_type = [rr.MediaType.MARKDOWN] * len(texts)
            self.rec.send_columns(VERDICT, index, rr.TextDocument.columns(text=texts, media_type=media_type))

    def _text(self, moments: list[list[float]], at: float) -> str:
        """The text at a moment; `moments` are those of the sayings of each run on the same timeline."""
        latest = [bisect(of_run, at) - 1 for of_run in moments]
        words = [said[last].words if last >= 0 else "" for said, last in zip(self.sayings, latest, strict=True)]
        marks = [UNTIL_ITS_END if live and word else "" for live, word in zip(self.going_on, words, strict=True)]
        said = zip(map(plain, self.names), marks, map(plain, words), strict=True)
        lines = [f"- **{name}** {mark}{word}" for name, mark, word in said]
        return "\n".join([f"Does the hole ripple? In {self.along}:", "", *lines])


def plain(text: str) -> str:
    """Text in Markdown that shows what it is, whatever is in it."""
    return re.sub(r"([\\`*_{}\[\]<>#|~&!])", r"\\\1", " ".join(text.split()))


def table(names: Sequence[str], facts: Sequence[dict[str, str]]) -> str:
    """The facts about some cases side by side; those that differ come first."""
    rows = [[what, *(fact[what] for fact in facts)] for what in facts[0]]
    rows.sort(key=lambda row: len(set(row[1:])) == 1)
    heading = [["", *map(plain, names)], ["---"] * (len(names) + 1)]
    return "\n".join(f"| {' | '.join(row)} |" for row in heading + rows)


def case_facts(case: Case) -> dict[str, str]:
    """The facts about a case: name → value in the units people use."""
    modal = not case.bha.body_point_positions  # else it has no modes whose roots could be found
    straight = straight_drilling(case)
    return {
        **_weight(case),
        "drilling straight, contact": touching(straight.response) + ", tilt at its limit" * straight.saturated,
        "drilling straight, roots": BY_THE_ROOTS[straight.verdict],
        "its critical ηΠ": _limit(straight.critical) if modal else BY_THE_ROOTS[None],
        "critical ηΠ, all touching": _limit_of_all(case) if modal else BY_THE_ROOTS[None],
        **_assembly(case),
    }


def case_facts_in_space(case: Case) -> dict[str, str]:
    """The facts about a case in space, for which those on drilling straight in a plane do not hold."""
    return {**_weight(case), "walk angle ϖ": UNITS["rad"].text(case.bit.walk_angle), **_assembly(case)}


def _weight(case: Case) -> dict[str, str]:
    return {
        "active weight on bit": UNITS["N"].text(case.active_weight_on_bit),
        "**ηΠ**": f"**{eta_pi(case.bha, case.bit, case.active_weight_on_bit):.4g}**",
    }


def _assembly(case: Case) -> dict[str, str]:
    bha, bit = case.bha, case.bit
    return {
        "stabilizers": f"{', '.join(f'{s:.4g}' for s in bha.stabilizer_positions)} m",
        "clearances": f"{', '.join(map(SMALL_LENGTH.number, bha.stabilizer_clearances)) or '–'} {SMALL_LENGTH.shown}",
        "beam": _beam(case),
        "weight": UNITS["N/m"].text(bha.distributed_weight),
        "stiffness EI": UNITS["N.m2"].text(bha.flexural_stiffness, ".0f"),
        "η, χ": f"{bit.lateral_steering_resistance:g}, {bit.angular_steering_resistance:g}",
        "tilt limit ψ*": UNITS["rad"].text(bit.tilt_limit),
        "pads, hole": f"{UNITS['m'].text(bha.rss_position, '.3g')}, {SMALL_LENGTH.text(case.bit_diameter, '.4g')}",
    }


def _beam(case: Case) -> str:
    """What the beam is made of, and what loads it besides its weight."""
    bha = case.bha
    sections = len(bha.section_lengths)
    parts = [f"{sections} section{'s' * (sections > 1)}, weight and EI at the bit" if sections else "uniform"]
    if bha.axial_load:
        parts.append(f"{UNITS['N'].text(case.weight_on_bit or case.active_weight_on_bit)} along it")
    if bha.body_point_positions:
        parts.append(f"on the wall at up to {len(bha.body_point_positions)} points")
    return "; ".join(parts)


def _limit_of_all(case: Case) -> str:
    """The critical ηΠ with all stabilizers touching that can touch."""
    contact = can_touch(case.bha, case.bit, case.survey.inclination[-1], case.schedule.rss_force)
    return _limit(critical_eta_pi(case, contact=contact))


def _limit(critical: CriticalEtaPi | None) -> str:
    """A critical ηΠ, and the active weight on bit there."""
    return "none" if critical is None else f"{critical.eta_pi:.4g} = {UNITS['N'].text(critical.active_weight_on_bit)}"

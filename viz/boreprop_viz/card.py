"""The text beside the pictures: the cases, and whether their holes ripple."""

from collections.abc import Sequence

import rerun as rr

from boreprop.analysis.rippling import Rippling, State
from boreprop.analysis.stability.contacts import can_touch
from boreprop.analysis.stability.roots import critical_eta_pi
from boreprop.case.case import Case
from boreprop.core.system import eta_pi
from boreprop.report.tables.summary import whether_it_ripples
from boreprop.units import SMALL_LENGTH, UNITS

from .source import Source

CARD = "case"


def log_card(rec: rr.RecordingStream, sources: Sequence[Source], findings: Sequence[str]) -> None:
    """Log whether the hole of each run ripples, in words, and a table of the cases side by side."""
    names = [source.name for source in sources]
    facts = [case_facts(source.case) for source in sources]
    lines = ["Does the hole ripple?", ""]
    lines += [f"- **{name}** {finding}" for name, finding in zip(names, findings, strict=True)]
    lines += ["", f"| | {' | '.join(names)} |", "|---" * (len(names) + 1) + "|"]
    lines += [f"| {what} | {' | '.join(fact[what] for fact in facts)} |" for what in facts[0]]
    rec.log(CARD, rr.TextDocument("\n".join(lines), media_type=rr.MediaType.MARKDOWN), static=True)


def case_facts(case: Case) -> dict[str, str]:
    """The facts about a case: name → value in the units people use."""
    bha, bit = case.bha, case.bit
    inclination = case.survey.inclination[-1]
    contact = can_touch(bha, bit, inclination, case.schedule.rss_force)
    critical = critical_eta_pi(case, contact=contact)
    return {
        "stabilizers": f"{', '.join(f'{s:.4g}' for s in bha.stabilizer_positions)} m",
        "clearances": f"{', '.join(map(SMALL_LENGTH.number, bha.stabilizer_clearances)) or '–'} {SMALL_LENGTH.shown}",
        "weight": UNITS["N/m"].text(bha.distributed_weight),
        "stiffness EI": UNITS["N.m2"].text(bha.flexural_stiffness, ".0f"),
        "η, χ": f"{bit.lateral_steering_resistance:g}, {bit.angular_steering_resistance:g}",
        "tilt limit ψ*": UNITS["rad"].text(bit.tilt_limit),
        "pads, hole": f"{UNITS['m'].text(bha.rss_position, '.3g')}, {SMALL_LENGTH.text(case.bit_diameter, '.4g')}",
        "weight on bit": UNITS["N"].text(case.active_weight_on_bit),
        "critical weight": "none" if critical is None else UNITS["N"].text(critical.active_weight_on_bit),
        "**ηΠ**": f"**{eta_pi(bha, bit, case.active_weight_on_bit):.4g}**",
        "critical ηΠ": "none" if critical is None else f"{critical.eta_pi:.4g}",
    }


def in_words(wave: Rippling) -> str:
    """Whether a run ends rippling, and with what wave."""
    size = f", ±{UNITS['rad'].text(wave.amplitude)}" if wave.state is not State.NONE else ""
    return whether_it_ripples(wave) + size

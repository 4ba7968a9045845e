"""The text beside the pictures: the cases, and whether their holes ripple."""

from collections.abc import Sequence
from math import degrees

import rerun as rr

from boreprop.analysis.rippling import Rippling, State
from boreprop.analysis.stability.contacts import can_touch
from boreprop.analysis.stability.roots import critical_eta_pi
from boreprop.case.case import Case
from boreprop.core.system import eta_pi

from .source import Source

CARD = "case"


def log_card(rec: rr.RecordingStream, sources: Sequence[Source], findings: Sequence[str]) -> None:
    """Log whether the hole of each run ripples, in words, and a table of the cases side by side."""
    names = [source.name for source in sources]
    facts = [case_facts(source.case) for source in sources]
    lines = [f"- **{name}** {finding}" for name, finding in zip(names, findings, strict=True)]
    lines += ["", f"| | {' | '.join(names)} |", "|---" * (len(names) + 1) + "|"]
    lines += [f"| {what} | {' | '.join(fact[what] for fact in facts)} |" for what in facts[0]]
    rec.log(CARD, rr.TextDocument("\n".join(lines), media_type=rr.MediaType.MARKDOWN), static=True)


def case_facts(case: Case) -> dict[str, str]:
    """The facts about a case: name → value in the units people use."""
    bha, bit = case.bha, case.bit
    inclination = case.survey.inclination[-1]
    contact = can_touch(bha, bit, inclination, case.schedule.rss_force)
    critical = critical_eta_pi(case, contact=contact)
    clearances = [f"{1000 * clearance:.3g}" for clearance in bha.stabilizer_clearances]
    return {
        "stabilizers": f"{', '.join(f'{s:.4g}' for s in bha.stabilizer_positions)} m",
        "clearances": f"{', '.join(clearances) or '–'} mm",
        "weight": f"{bha.distributed_weight / 1000:.3g} kN/m",
        "stiffness EI": f"{bha.flexural_stiffness / 1e6:.3g} MN m²",
        "η, χ": f"{bit.lateral_steering_resistance:g}, {bit.angular_steering_resistance:g}",
        "tilt limit ψ*": f"{degrees(bit.tilt_limit):.3g}°",
        "pads, hole": f"{bha.rss_position:.3g} m, {1000 * case.bit_diameter:.4g} mm",
        "weight on bit": f"{case.active_weight_on_bit / 1000:.3g} kN",
        "critical weight": "none" if critical is None else f"{critical.active_weight_on_bit / 1000:.3g} kN",
        "**ηΠ**": f"**{eta_pi(bha, bit, case.active_weight_on_bit):.4g}**",
        "critical ηΠ": "none" if critical is None else f"{critical.eta_pi:.4g}",
    }


def in_words(wave: Rippling) -> str:
    """A line that says whether a run ripples, and with what wave."""
    waves = f"waves of {wave.wavelength:.2f} m, ±{degrees(wave.amplitude):.2g}°"
    return {
        State.NONE: "does not ripple",
        State.DYING: f"does not ripple: {waves}, die out over {wave.fading_length:.3g} m",
        State.LASTING: f"ripples: {waves}",
        State.GROWING: f"ripples: {waves}, growing",
        State.STEERED: f"does not ripple as far as can be told: {waves}, but force or weight change too often",
    }[wave.state]

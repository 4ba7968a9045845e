"""The roots of modes in tables and titles."""

from collections.abc import Container, Iterable, Mapping
from math import degrees, log, pi

from ...analysis.stability.chart import VERDICTS, Chart
from ...analysis.stability.roots import NEUTRAL, CriticalEtaPi, Roots, Verdict
from ...units import BUILD_LENGTH, UNITS

HEADINGS = ("growth, per ℓ₁", "frequency, per ℓ₁", "what it does", "wavelength")
MODE_HEADINGS = ("in contact", "bit tilt", "verdict", "what it does", "wavelength", "the case")
NOT_MET = "not met"
MOST_LINES = 20  # roots in a table: they fit on a screen


def as_plain(found: Roots) -> dict[str, object]:
    """The roots of a mode as a document for JSON: real and imaginary parts, the rightmost first."""
    return {
        "eta_pi": found.eta_pi,
        "mode": {"contact": found.contact, "saturated": found.saturated},
        "roots": [[root.real, root.imag] for root in found.roots],
        "verdict": found.verdict,
    }


def chart_as_plain(chart: Chart, limits: Mapping[tuple[int, ...], CriticalEtaPi | None]) -> dict[str, object]:
    """A chart as a document for JSON: for each mode its limit, and its verdicts over λ₂, then ηΠ."""
    return {
        "eta_pi": chart.eta_pi,
        "lambda2": chart.lambda2,
        "inclination": chart.inclination,
        "limits": [{"contact": contact, "critical": limit} for contact, limit in limits.items()],
        "panels": [
            {
                "contact": panel.contact,
                "saturated": panel.saturated,
                "verdicts": [[VERDICTS[code] for code in row] for row in panel.verdicts],
            }
            for panel in chart.panels
        ],
    }


def title(found: Roots, active_weight_on_bit: float) -> str:
    """The title of a table of roots: the weight, given in N, the mode and the verdict."""
    tilt = "bit tilt saturated" if found.saturated else "bit tilt not saturated"
    at = f"ηΠ = {found.eta_pi:.4g} ({weight(active_weight_on_bit)})"
    return f"{at}, {contact_text(found.contact)}, {tilt}: {found.verdict}"


def modes_title(eta_pi: float, active_weight_on_bit: float, inclination: float) -> str:
    """The title of a table of modes: the weight, given in N, and the inclination, given in rad."""
    return (
        f"ηΠ = {eta_pi:.4g} ({weight(active_weight_on_bit)}), straight hole at {degrees(inclination):.4g}° inclination"
    )


def mode_line(
    found: Roots, length_scale: float, here: tuple[tuple[int, ...], bool], met: Container[tuple[int, ...]]
) -> tuple[str, ...]:
    """The line of a mode, under `MODE_HEADINGS`: its verdict and the root that decides it.

    `here` is the mode in which the case drills steadily, or would if no waves grew; `met` are the contacts that occur.
    """
    pairs = [root for root in found.roots if root.imag]
    root = pairs[0] if found.verdict is Verdict.OSCILLATORY else found.roots[0]
    if (found.contact, found.saturated) == here:
        place = "would drill so" if found.verdict is Verdict.OSCILLATORY else "drills so"
    else:
        place = "" if found.contact in met else NOT_MET
    return (
        ", ".join(map(str, found.contact)) or "none",
        "saturated" if found.saturated else "not saturated",
        found.verdict,
        change(root, length_scale),
        wavelength(root, length_scale),
        place,
    )


def not_met(lines: Iterable[tuple[str, ...]]) -> str | None:
    """What "not met" means under `MODE_HEADINGS`; None if no line has it."""
    if not any(line[-1] == NOT_MET for line in lines):
        return None
    over = UNITS["m"].text(BUILD_LENGTH, ".3g")
    return f"{NOT_MET}: these contacts do not occur in holes that turn by up to 10° over {over}"


def contact_text(contact: tuple[int, ...]) -> str:
    """Which stabilizers touch, in words."""
    numbers = ", ".join(map(str, contact))
    return f"stabilizer{'s' * (len(contact) > 1)} {numbers} in contact" if contact else "no contact"


def lines(found: Roots, length_scale: float) -> list[tuple[str, str, str, str]]:
    """A line for each of the rightmost roots, under `HEADINGS`; `length_scale` is ℓ₁, m."""
    return [
        (f"{root.real:.6f}", f"{root.imag:.6f}", change(root, length_scale), wavelength(root, length_scale))
        for root in found.roots[:MOST_LINES]
    ]


def change(root: complex, length_scale: float) -> str:
    """The drilled length over which a disturbance doubles or halves, in words."""
    if abs(root.real) < NEUTRAL:
        return "stays"
    return f"{'doubles' if root.real > 0 else 'halves'} in {metres(log(2) / abs(root.real) * length_scale)}"


def wavelength(root: complex, length_scale: float) -> str:
    """The wavelength of a pair of roots, as text; empty for a real root."""
    return metres(2 * pi / root.imag * length_scale) if root.imag else ""


def metres(length: float) -> str:
    """A length, m, as text of three digits."""
    unit = UNITS["m"]
    return f"{float(unit.number(length, '.3g')):.15g} {unit.shown}"


def caption(found: Roots) -> str | None:
    """A caption that says how many roots are not shown; None if all are."""
    more = len(found.roots) - MOST_LINES
    return f"{more} more with a growth above {found.roots[-1].real:.2g} per ℓ₁" if more > 0 else None


def stability_limit(contact: tuple[int, ...], critical: CriticalEtaPi | None) -> str:
    """In words: up to which ηΠ a straight hole oscillates with these contacts and the bit tilt not saturated."""
    if critical is None:
        return f"{contact_text(contact)}: never oscillatory"
    return (
        f"{contact_text(contact)}: oscillatory up to ηΠ = {critical.eta_pi:.6g} "
        f"({weight(critical.active_weight_on_bit)}; waves of {metres(critical.wavelength)})"
    )


def weight(active_weight_on_bit: float) -> str:
    """An active weight on bit, N, as text."""
    return UNITS["N"].text(active_weight_on_bit, ".4g")

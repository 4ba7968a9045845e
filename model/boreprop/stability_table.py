"""The roots of a mode for a person to read."""

from math import log, pi

from .analysis.stability import CriticalEtaPi, Roots

HEADINGS = ("growth, per ℓ₁", "frequency, per ℓ₁", "what it does", "wavelength")
MOST_ROWS = 20


def title(found: Roots) -> str:
    """Which mode, and the verdict."""
    tilt = "bit tilt saturated" if found.saturated else "bit tilt not saturated"
    return f"ηΠ = {found.eta_pi:.4g}, {contact_text(found.contact)}, {tilt}: {found.verdict}"


def contact_text(contact: tuple[int, ...]) -> str:
    """Which stabilizers touch."""
    numbers = ", ".join(map(str, contact))
    return f"stabilizer{'s' * (len(contact) > 1)} {numbers} in contact" if contact else "no contact"


def rows(found: Roots, length_scale: float) -> list[tuple[str, str, str, str]]:
    """A line for each of the rightmost roots, under `HEADINGS`; `length_scale` is ℓ₁, m."""
    lines = []
    for root in found.roots[:MOST_ROWS]:
        if root.real:
            over = f"{log(2) / abs(root.real) * length_scale:.3g} m"
            change = f"doubles in {over}" if root.real > 0 else f"halves in {over}"
        else:
            change = "stays"
        wavelength = f"{2 * pi / root.imag * length_scale:.3g} m" if root.imag else ""
        lines.append((f"{root.real:.6f}", f"{root.imag:.6f}", change, wavelength))
    return lines


def caption(found: Roots) -> str | None:
    """How many roots are not shown."""
    more = len(found.roots) - MOST_ROWS
    return f"{more} more with a growth above {found.roots[-1].real:.2g} per ℓ₁" if more > 0 else None


def stability_limit(critical: CriticalEtaPi | None) -> str:
    """Up to where a drilling system with all its stabilizers in contact oscillates."""
    if critical is None:
        return "in contact never oscillatory"
    return f"in contact oscillatory up to ηΠ = {critical.eta_pi:.6g} (waves of {critical.wavelength:.3g} m)"

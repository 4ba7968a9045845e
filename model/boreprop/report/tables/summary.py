"""The summary of a run in a table."""

from ...analysis.rippling import Rippling, State, Stretch
from ...analysis.summary import Summary
from ...units import BUILD_LENGTH, SMALL_LENGTH, UNITS
from .sag import outside_the_hole


def lines(summary: Summary) -> list[tuple[str, str]]:
    """The lines of a table, each a name and a value in the units people use."""
    mean = f"mean over {summary.averaging_length:.3g} m"
    stabilizers = enumerate(zip(summary.largest_contact_force, summary.contact_share, strict=True), 1)
    table = [
        ("drilled length", UNITS["m"].text(summary.drilled_length)),
        ("stopped", summary.stopped),
        (f"inclination at the start, {mean}", UNITS["rad"].text(summary.start_inclination)),
        (f"inclination at the end, {mean}", UNITS["rad"].text(summary.end_inclination)),
        ("build rate, mean", UNITS["rad/m"].text(summary.build_rate)),
        (f"build rate, largest over {BUILD_LENGTH:g} m", UNITS["rad/m"].text(summary.largest_build_rate)),
        *(
            line
            for i, (force, share) in stabilizers
            for line in (
                (f"stabilizer {i}: largest contact force", UNITS["N"].text(force)),
                (f"stabilizer {i}: in contact", f"{share:.0%} of the length"),
            )
        ),
        ("bit tilt saturated", f"{summary.saturation_share:.0%} of the length"),
        *_wave_lines(summary.rippling),
        ("waves that would not show", summary.hidden_waves),
        ("warning", outside_the_hole(summary.sag) if summary.sag else ""),
    ]
    return [(what, amount) for what, amount in table if amount]


def _wave_lines(wave: Rippling) -> list[tuple[str, str]]:
    if wave.state is State.NONE:
        return [("rippling", "no")]
    return [
        ("rippling", whether_it_ripples(wave)),
        ("ripple of the inclination", f"±{UNITS['rad'].text(wave.amplitude, '.3g')}"),
        ("ripple of the hole axis", f"±{SMALL_LENGTH.text(wave.axis_amplitude)}"),
        ("ripple, from wave to wave", f"length ±{wave.spread:.2f} m"),
        ("ripple, from stand to stand", f"amplitude {100 * wave.growth_over(BUILD_LENGTH):+.1f} %/{BUILD_LENGTH:g} m"),
        ("ripple, at least half as large since", f"{wave.since:.0f} m"),
        ("modes of a wave", "\n".join(map(_words, wave.modes))),
    ]


def whether_it_ripples(wave: Rippling) -> str:
    """Whether a run ends rippling, and with what wave, in words."""
    length = f"{wave.wavelength:.2f} m long"
    return {
        State.NONE: "no",
        State.DYING: f"no, dying out over {wave.fading_length:.3g} m: waves {length}",
        State.LASTING: f"yes: {length}",
        State.GROWING: f"yes, growing: {length}",
        State.STEERED: f"no, but force or weight change too often to tell: waves {length}",
    }[wave.state]


def _words(stretch: Stretch) -> str:
    touching = [f"{i} {'lower' if wall > 0 else 'upper'}" for i, wall in enumerate(stretch.contact, 1) if wall]
    limit = [f"{'+' if stretch.saturation > 0 else '−'}ψ*"] if stretch.saturation else []
    return f"{' '.join(touching + limit) or 'free'} {stretch.share:.0%}"

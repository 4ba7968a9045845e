"""The summary of a run in a table."""

from math import degrees, isnan, pi

from ...analysis.ellipse import Ellipse, Shape
from ...analysis.rippling import Rippling, Stretch
from ...analysis.search import State
from ...analysis.summary import BodyContact, Summary
from ...units import BUILD_LENGTH, UNITS, small_length
from .sag import outside_the_hole

ROUND = 0.95  # minor over major axis: of an ellipse that is as round as this it is not said where the longer one is
SHAPES = {
    Shape.PLANE: ", in a plane",
    Shape.RIGHT: ", a spiral to the right",
    Shape.LEFT: ", a spiral to the left",
    Shape.UNCLEAR: ", neither in a plane nor to one side",
}


def lines(summary: Summary) -> list[tuple[str, str]]:
    """The lines of a table, each a name and a value in the units people use."""
    mean = f"mean over {length_text(summary.averaging_length, '.3g')}"
    stabilizers = enumerate(zip(summary.largest_contact_force, summary.contact_share, strict=True), 1)
    table = [
        ("drilled length", UNITS["m"].text(summary.drilled_length)),
        ("stopped", summary.stopped),
        (f"inclination at the start, {mean}", UNITS["rad"].text(summary.start_inclination)),
        (f"inclination at the end, {mean}", UNITS["rad"].text(summary.end_inclination)),
        *(
            (f"azimuth at the {where}", azimuth_text(azimuth))
            for where, azimuth in (("start", summary.start_azimuth), ("end", summary.end_azimuth))
            if azimuth is not None
        ),
        ("build rate, mean", UNITS["rad/m"].text(summary.build_rate)),
        (
            f"build rate, largest over {length_text(BUILD_LENGTH, '.3g')}",
            UNITS["rad/m"].text(summary.largest_build_rate),
        ),
        *_dogleg_lines(summary),
        *(
            line
            for i, (force, share) in stabilizers
            for line in (
                (f"stabilizer {i}: largest contact force", UNITS["N"].text(force)),
                (f"stabilizer {i}: in contact", f"{share:.0%} of the length"),
            )
        ),
        *_body_lines(summary.body_contact),
        ("bit tilt saturated", f"{summary.saturation_share:.0%} of the length"),
        *_wave_lines(summary.rippling),
        ("waves that would not show", summary.hidden_waves),
        ("warning", outside_the_hole(summary.sag) if summary.sag else ""),
    ]
    return [(what, amount) for what, amount in table if amount]


def _dogleg_lines(summary: Summary) -> list[tuple[str, str]]:
    if summary.dogleg_severity is None or summary.largest_dogleg_severity is None:
        return []
    mean, largest = (
        UNITS["rad/m"].text(severity, ".2f") for severity in (summary.dogleg_severity, summary.largest_dogleg_severity)
    )
    turn = UNITS["rad"].text(summary.dogleg_severity * summary.drilled_length, ".1f")
    return [
        ("dogleg severity, mean", f"{mean}, {turn} in all"),
        (f"dogleg severity, largest over {length_text(BUILD_LENGTH, '.3g')}", largest),
    ]


def _body_lines(body: BodyContact | None) -> list[tuple[str, str]]:
    if body is None:
        return []
    touching = ("body: in contact", f"{body.share:.0%} of the length")
    if not body.largest_force:
        return [touching]
    at = f"{length_text(body.position, '.1f')} behind the bit, after {length_text(body.drilled_length, '.1f')}"
    return [("body: largest contact force", f"{UNITS['N'].text(body.largest_force)}, {at}"), touching]


def _wave_lines(wave: Rippling) -> list[tuple[str, str]]:
    if wave.state is State.NONE:
        return [("rippling", "no")]
    return [
        ("rippling", whether_it_ripples(wave)),
        (
            f"ripple of the {'direction' if wave.ellipse else 'inclination'}",
            f"±{UNITS['rad'].text(wave.amplitude, '.3g')}",
        ),
        ("ripple of the hole axis", _axis(wave)),
        *([] if isnan(wave.spread) else [("ripple, from wave to wave", f"length ±{length_text(wave.spread, '.2f')}")]),
        (
            "ripple, from stand to stand",
            f"amplitude {100 * wave.growth_over(BUILD_LENGTH):+.1f} %/{length_text(BUILD_LENGTH, '.3g')}",
        ),
        ("ripple, at least half as large since", length_text(wave.since, ".0f")),
        ("spiral since", _winding(wave.ellipse)),
        ("modes of a wave", "\n".join(map(_words, wave.modes))),
    ]


def _winding(ellipse: Ellipse | None) -> str:
    """Since when a hole has wound; empty if it does not wind."""
    return "" if ellipse is None or isnan(ellipse.since) else length_text(ellipse.since, ".0f")


def _axis(wave: Rippling) -> str:
    """How far the axis of the hole swings."""
    if wave.ellipse is None or wave.ellipse.shape is Shape.PLANE:
        side = "" if wave.ellipse is None else f", {_side(wave.ellipse)}"
        return f"±{small_length().text(wave.axis_amplitude)}{side}"
    major, minor = (small_length().text(axis) for axis in (wave.ellipse.major, wave.ellipse.minor))
    round_enough = wave.ellipse.minor > ROUND * wave.ellipse.major
    return f"±{major} by ±{minor}" + f", the longer one {_side(wave.ellipse)}" * (not round_enough)


def _side(ellipse: Ellipse) -> str:
    """Where the longer axis of an ellipse is."""
    if ellipse.from_north:
        return f"at azimuth {round(degrees(ellipse.direction)) % 180}°"
    if ellipse.direction > pi / 2:
        return f"{degrees(pi - ellipse.direction):.0f}° left of the high side"
    return f"{degrees(ellipse.direction):.0f}° right of the high side"


def whether_it_ripples(wave: Rippling) -> str:
    """Whether a run ends rippling, and with what wave, in words."""
    length = f"{length_text(wave.wavelength, '.2f')} long{SHAPES[wave.ellipse.shape] if wave.ellipse else ''}"
    return {
        State.NONE: "no",
        State.DYING: f"no, dying out over {length_text(wave.fading_length, '.3g')}: waves {length}",
        State.LASTING: f"yes: {length}",
        State.GROWING: f"yes, growing: {length}",
        State.STEERED: f"no, but force or weight change too often to tell: waves {length}",
    }[wave.state]


def azimuth_text(azimuth: float) -> str:
    """An azimuth, rad, as text."""
    return "none, it is nearly vertical" if isnan(azimuth) else UNITS["rad"].text(azimuth, ".1f")


def length_text(length: float, digits: str) -> str:
    """A length, m, as text."""
    return UNITS["m"].text(length, digits)


def _words(stretch: Stretch) -> str:
    touching = [f"{i} {'lower' if wall > 0 else 'upper'}" for i, wall in enumerate(stretch.contact, 1) if wall]
    limit = [f"{'+' if stretch.saturation > 0 else '−'}ψ*"] if stretch.saturation else []
    return f"{' '.join(touching + limit) or 'free'} {stretch.share:.0%}"

"""The steering response of a case in two tables, in the units people use."""

from dataclasses import dataclass
from itertools import groupby
from math import isfinite

from ...analysis.sag import Sag, steady_sag
from ...analysis.stability.roots import Verdict
from ...analysis.stability.straight import mode_verdict
from ...analysis.steering import (
    Piece,
    SteadyResponse,
    build_rate_curve,
    holding_forces,
    largest_build_rate,
    steady_response,
)
from ...case.case import Case
from ...units import UNITS
from .sag import outside_the_hole

USUAL_FORCE = 30e3  # N: about the force of the pads of a large tool
READABLE = 0.01  # ° per `BUILD_LENGTH`: surveys do not resolve less
NEAR_REVERSAL = 0.8  # of the ηΠ at which the response is zero: from there on it is below a fifth, and a warning is due
WALLS = {1: "low", -1: "high"}


@dataclass(frozen=True)
class SteeringSummary:
    """What an engineer asks about the steering of a case.

    Parameters
    ----------
    inclination
        The inclination at which the weight of the BHA acts, ⟨Θ⟩_1 of the equations, rad.
    active_weight_on_bit
        The active weight on bit, N.
    eta_pi
        ηΠ.
    curve, without_gravity
        The response to every force up to the limit, with and without gravity, see `build_rate_curve`.
    oscillating
        For each piece of the curve with gravity, whether small waves grow in its mode.
    free, highest, lowest
        The response without force, and those with the highest and the lowest build rate.
    holding
        The responses that hold the inclination, the smallest force first.
    sag
        Where the axis of the BHA is farthest from that of the hole, and under which force, N: without force if it
        leaves the hole even then, otherwise at one of the ends of the pieces of the curve.
    """

    inclination: float
    active_weight_on_bit: float
    eta_pi: float
    curve: tuple[Piece, ...]
    without_gravity: tuple[Piece, ...]
    oscillating: tuple[bool, ...]
    free: SteadyResponse
    highest: SteadyResponse
    lowest: SteadyResponse
    holding: tuple[SteadyResponse, ...]
    sag: tuple[Sag, float]


def summarize(case: Case, inclination: float | None = None, force_limit: float | None = None) -> SteeringSummary:
    """The steering of a case.

    Parameters
    ----------
    case
        What is drilled.
    inclination
        The inclination at which the weight of the BHA acts, rad; without it, that at the end of the existing hole,
        which does not depend on the position of the first stabilizer.
    force_limit
        Largest force to either side, N; without it, the largest force of the case's schedule, or 30 kN if there is
        none.

    Raises
    ------
    ParameterError
        If a value is out of range.
    """
    if inclination is None:
        inclination = case.survey.inclination[-1]
    if force_limit is None:
        force_limit = max(map(abs, case.schedule.rss_force)) or USUAL_FORCE
    highest, lowest = largest_build_rate(case, inclination, force_limit)
    curve = build_rate_curve(case, inclination, force_limit)
    free = steady_response(case, 0.0, inclination)
    ends = [response for piece in curve for response in (piece.start, piece.end)]
    sags = [(steady_sag(case, response, inclination), response.rss_force) for response in (free, *ends)]
    return SteeringSummary(
        inclination=inclination,
        active_weight_on_bit=case.active_weight_on_bit,
        eta_pi=case.eta_pi,
        curve=curve,
        without_gravity=build_rate_curve(case, inclination, force_limit, gravity=False),
        oscillating=tuple(_oscillates(case, piece.start, inclination) for piece in curve),
        free=free,
        highest=highest,
        lowest=lowest,
        holding=holding_forces(case, inclination, force_limit),
        sag=sags[0] if sags[0][0].outside else max(sags, key=lambda at: abs(at[0].offset)),
    )


def lines(summary: SteeringSummary) -> list[tuple[str, str]]:
    """The lines of a table, each a name and a value with its unit; warnings come last."""
    limit = force_text(summary.curve[-1].end.rss_force)
    sag, force = summary.sag
    holding = " or ".join(
        force_text(response.rss_force, "+") + " (tilt at its limit)" * bool(response.bit_tilt_saturation)
        for response in summary.holding
    )
    error = per_build_length(
        max(abs(end.build_rate_error) for piece in summary.curve for end in (piece.start, piece.end))
    )
    left_out = f"less than {READABLE:g}" if error < READABLE else f"up to {error:.2f}"
    return [
        ("inclination at which the weight acts", UNITS["rad"].text(summary.inclination)),
        ("active weight on bit", f"{force_text(summary.active_weight_on_bit)}, ηΠ = {summary.eta_pi:.3g}"),
        ("force limit", f"±{limit}"),
        ("build rate without force", f"{rate(summary.free.build_rate)}, on a wall: {touching(summary.free)}"),
        ("force that holds the inclination", holding or f"none up to ±{limit}"),
        ("highest build rate", at_force(summary.highest)),
        ("lowest build rate", at_force(summary.lowest)),
        ("left out: gravity changes along the arc", f"{left_out} {UNITS['rad/m'].shown}"),
        *(("warning", text) for text in warnings(summary.curve, summary.eta_pi)),
        *(("warning", text) for text in wave_warnings(summary.curve, summary.oscillating)),
        *(("warning", f"{force_text(force, '+')}: {text}") for text in [outside_the_hole(sag)] if text),
    ]


def headings() -> tuple[str, ...]:
    """The headings of the columns of `piece_lines`, with their units."""
    return (
        f"force\n({UNITS['N'].shown})",
        f"build rate\n({UNITS['rad/m'].shown})",
        f"per {UNITS['N'].shown}\n",
        f"bit tilt\n({UNITS['rad'].shown})",
        "on a wall\n",
        f"reverses at\n{UNITS['N'].shown} (ηΠ)",
    )


def piece_lines(curve: tuple[Piece, ...]) -> list[tuple[str, ...]]:
    """The lines of a table with a line for each piece of the curve, and a cell for each of `headings`."""
    return [
        (
            forces(piece.start, piece.end),
            f"{per_build_length(piece.start.build_rate):+z.2f} to {per_build_length(piece.end.build_rate):+z.2f}",
            f"{per_build_length(piece.gain / UNITS['N'].factor):+z.3f}",
            (
                f"{tilt(piece.start)} (limit)"
                if piece.start.bit_tilt_saturation
                else f"{tilt(piece.start)} to {tilt(piece.end)}"
            ),
            touching(piece.start, piece.end),
            (
                "–"
                if piece.start.bit_tilt_saturation
                else f"{UNITS['N'].number(piece.reversal_weight, '.4g')} ({piece.reversal_eta_pi:.3g})"
                if isfinite(piece.reversal_eta_pi)
                else "never"
            ),
        )
        for piece in curve
    ]


def warnings(curve: tuple[Piece, ...], eta_pi: float) -> list[str]:
    """Warnings of forces at which more force builds less, or nearly does."""
    stretches = [(text, list(pieces)) for text, pieces in groupby(curve, lambda piece: _warning(piece, eta_pi))]
    return [
        f"{forces(pieces[0].start, pieces[-1].end)} {UNITS['N'].shown}: {text}" for text, pieces in stretches if text
    ]


def wave_warnings(curve: tuple[Piece, ...], oscillating: tuple[bool, ...]) -> list[str]:
    """Warnings of forces under which the hole may ripple instead of turning steadily."""
    stretches = groupby(zip(curve, oscillating, strict=True), lambda part: part[1])
    return [
        f"{forces(parts[0].start, parts[-1].end)} {UNITS['N'].shown}: waves grow there, and a hole that ripples turns "
        "at another rate, usually a lower one"
        for grow, parts in ((grow, [piece for piece, _ in group]) for grow, group in stretches)
        if grow
    ]


def _oscillates(case: Case, response: SteadyResponse, inclination: float) -> bool:
    """Whether small waves grow in the mode of a response."""
    contact = tuple(i for i, wall in enumerate(response.stabilizer_contact, 1) if wall)
    saturated = bool(response.bit_tilt_saturation)
    return mode_verdict(case, contact, saturated, inclination) is Verdict.OSCILLATORY


def _warning(piece: Piece, eta_pi: float) -> str:
    if piece.start.bit_tilt_saturation:
        return "with the bit tilt at its limit, more force to the high side builds less" if piece.gain < 0 else ""
    if eta_pi < NEAR_REVERSAL * piece.reversal_eta_pi:
        return ""
    where = "above" if eta_pi > piece.reversal_eta_pi else "close to"
    reversal = f"{piece.reversal_eta_pi:.3g} ({force_text(piece.reversal_weight)} of active weight on bit)"
    return f"ηΠ is {where} {reversal}, beyond which a push to the high side drops the hole"


def forces(start: SteadyResponse, end: SteadyResponse) -> str:
    """The range of forces between two responses, as text without the unit."""
    return " to ".join(UNITS["N"].number(response.rss_force, "+z.2f") for response in (start, end))


def tilt(response: SteadyResponse) -> str:
    """The bit tilt of a response, in degrees."""
    return UNITS["rad"].number(response.bit_tilt, "+z.2f")


def touching(*responses: SteadyResponse) -> str:
    """Which stabilizers touch which wall; both walls, if a stabilizer without clearance goes from one to the other."""
    contacts = zip(*(response.stabilizer_contact for response in responses), strict=True)
    walls = [list(dict.fromkeys(WALLS[contact] for contact in at if contact)) for at in contacts]
    return ", ".join(f"{i} {'/'.join(touched)}" for i, touched in enumerate(walls, 1) if touched) or "none"


def per_build_length(build_rate: float) -> float:
    """A build rate, rad/m, in the unit in which it is shown."""
    return UNITS["rad/m"].factor * build_rate


def rate(build_rate: float) -> str:
    """A build rate, rad/m, as text with its sign and unit."""
    return UNITS["rad/m"].text(build_rate, "+z.2f")


def at_force(response: SteadyResponse) -> str:
    """The build rate of a response, and its force, as text."""
    return f"{rate(response.build_rate)} at {force_text(response.rss_force, '+')}"


def force_text(force: float, sign: str = "") -> str:
    """A force, N, as text."""
    return UNITS["N"].text(force, f"{sign}z.2f")

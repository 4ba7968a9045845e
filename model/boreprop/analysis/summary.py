"""Sums up a run in about a dozen numbers."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from math import ceil, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..core.survey import Survey
from ..core.system import BottomHoleAssembly
from ..errors import MissingColumn
from ..run.completion import case_of
from ..run.trajectory import Trajectory
from ..units import BUILD_LENGTH
from .hole import bit_positions, hole_of
from .hole_in_space import angle_between, azimuth_of, chord_direction, hole_in_space, inclination_of, is_in_space
from .rippling import Rippling, find_rippling, visible_waves
from .sag import Sag, largest_sag
from .search import State

SHORT_WAVE, LONG_WAVE = 0.25, 1.8  # half lengths of the BHA: the usual wavelengths of ripples lie in between
NO_AZIMUTH = 0.0174533  # rad, a degree: the mean azimuth of a hole closer to the vertical says little


@dataclass(frozen=True)
class BodyContact:
    """How the body of a BHA, between the stabilizers, touches the wall in a run.

    Parameters
    ----------
    share
        Share of the drilled length over which it does.
    largest_force
        Largest magnitude of the force on any point of the body, N; 0 if it never touches.
    position
        Where that acts, m from the bit.
    drilled_length
        At which drilled length of the bit, m.
    """

    share: float
    largest_force: float
    position: float
    drilled_length: float


@dataclass(frozen=True)
class Summary:
    """What an engineer asks of a run first. Inclinations are means over the `averaging_length` behind the bit.

    Parameters
    ----------
    drilled_length
        The length that was drilled, m.
    averaging_length
        The length of hole over which each inclination and azimuth is averaged, m.
    start_inclination, end_inclination
        Mean inclination at the first and at the last row, rad.
    start_azimuth, end_azimuth
        Of a run in space, the mean azimuth there, rad, from north over east; None in the plane, nan in a hole that is
        within `NO_AZIMUTH` of the vertical.
    dogleg_severity
        Of a run in space, the angle by which the mean direction turns, added up every 30 m as by the method of minimum
        curvature, over the drilled length, rad/m; None in the plane, where build rates say it.
    largest_dogleg_severity
        Likewise, the largest over any 30 m, rad/m; nan in a shorter run.
    build_rate
        Mean build rate over the whole run, rad/m; positive builds inclination.
    largest_build_rate
        Of the build rates over any 30 m, the one of largest magnitude, rad/m; nan in a shorter run.
    largest_contact_force
        Largest magnitude of the contact force of each non-ideal stabilizer, N, shape (n − 1,).
    contact_share
        Share of the drilled length over which each non-ideal stabilizer touches a wall, shape (n − 1,).
    saturation_share
        Share of the drilled length over which the bit tilt is at its limit.
    rippling
        Whether the run ends rippling, and with what wave.
    hidden_waves
        Which waves that this BHA may make cannot be seen in the rows of the run, and what to do; empty if none.
    stopped
        The reason why the run ended early; None if it reached its end.
    sag
        Where the axis of the BHA is farthest from that of the hole; None if the run does not say, or the wall bears the
        body of the BHA.
    body_contact
        How the body of the BHA touches the wall; None if it cannot, or the run does not say.
    """

    drilled_length: float
    averaging_length: float
    start_inclination: float
    end_inclination: float
    build_rate: float
    largest_build_rate: float
    largest_contact_force: Floats
    contact_share: Floats
    saturation_share: float
    rippling: Rippling
    hidden_waves: str = ""
    stopped: str | None = None
    sag: Sag | None = None
    body_contact: BodyContact | None = None
    start_azimuth: float | None = None
    end_azimuth: float | None = None
    dogleg_severity: float | None = None
    largest_dogleg_severity: float | None = None


def summarize(trajectory: Trajectory) -> Summary:
    """Sum up a run: inclinations, build rates, contacts, saturation and rippling.

    Parameters
    ----------
    trajectory
        A run of at least two rows, with its case.

    Returns
    -------
    Summary
        The figures, in SI units.

    Raises
    ------
    InputError
        If the run lacks its case or a column.

    Examples
    --------
    >>> from boreprop import paper_case, simulate, summarize
    >>> summary = summarize(simulate(paper_case(), sample_interval=0.25))
    >>> summary.rippling.ripples, round(summary.saturation_share, 2)
    (True, 0.81)
    """
    hidden = hidden_waves(trajectory["drilled_length"], case_of(trajectory).bha)
    sag = None
    if not case_of(trajectory).bha.body_point_positions and not is_in_space(trajectory):
        with suppress(MissingColumn):  # the other figures need fewer columns
            sag = largest_sag(trajectory)
    return replace(sum_up(trajectory, find_rippling(trajectory)), hidden_waves=hidden, sag=sag)


def sum_up(trajectory: Trajectory, rippling: Rippling) -> Summary:
    """`summarize` a run without hidden waves and sag, once `find_rippling` or `last_wave` has found the rippling."""
    case = case_of(trajectory)
    length = trajectory["drilled_length"]
    over = averaging_length(case.bha, rippling)
    inclination = mean_inclination(trajectory, case.survey, over)
    weights = np.convolve(np.diff(length), (0.5, 0.5))  # half of what is drilled before a row and after it

    def share(happens: NDArray[np.bool_]) -> float:
        return float(weights[happens].sum() / weights.sum())

    later = _later(length)
    rates = (np.interp(later, length, inclination) - inclination[: len(later)]) / BUILD_LENGTH
    drilled = float(length[-1] - length[0])
    return Summary(
        drilled_length=drilled,
        averaging_length=over,
        start_inclination=float(inclination[0]),
        end_inclination=float(inclination[-1]),
        build_rate=float(inclination[-1] - inclination[0]) / drilled,
        largest_build_rate=float(rates[np.argmax(np.abs(rates))]) if len(rates) else float("nan"),
        largest_contact_force=np.abs(trajectory.stack("stabilizer_force")).max(axis=0),
        contact_share=np.array([share(contact != 0) for contact in trajectory.stack("stabilizer_contact").T]),
        saturation_share=share(trajectory["bit_tilt_saturation"] != 0),
        rippling=rippling,
        stopped=trajectory.stopped,
        body_contact=_body_contact(trajectory, share),
        **(_turning(trajectory, over) if is_in_space(trajectory) else {}),
    )


def _later(length: Floats) -> Floats:
    """The lengths 30 m after those of the first rows, as far as the run has them, m."""
    later = length + BUILD_LENGTH
    return later[: int(np.searchsorted(later, length[-1], side="right"))]


def _turning(run: Trajectory, over: float) -> dict[str, Any]:
    """The azimuths and dogleg severities of a run in space."""
    hole, length = hole_in_space(run, case_of(run).survey, over), run["drilled_length"]

    def directions(at: Floats) -> Floats:
        return chord_direction(hole, at, over)

    start, end = length[0], length[-1]
    each = directions(np.append(np.arange(start, end, BUILD_LENGTH), end))
    azimuth = np.where(np.sin(inclination_of(each)) > np.sin(NO_AZIMUTH), azimuth_of(each), np.nan)
    later = _later(length)
    turned = angle_between(directions(length[: len(later)]), directions(later))
    return {
        "start_azimuth": float(azimuth[0]),
        "end_azimuth": float(azimuth[-1]),
        "dogleg_severity": float(angle_between(each[:-1], each[1:]).sum() / (end - start)),
        "largest_dogleg_severity": float(turned.max() / BUILD_LENGTH) if len(turned) else float("nan"),
    }


def _body_contact(run: Trajectory, share: Callable[[NDArray[np.bool_]], float]) -> BodyContact | None:
    """How the body touches the wall, with the share of the length over which something happens."""
    if "body_contact_force" not in run or "body_contact_position" not in run:
        return None
    force = np.abs(run["body_contact_force"])
    most = int(np.argmax(force))
    position, length = float(run["body_contact_position"][most]), float(run["drilled_length"][most])
    return BodyContact(share(force > 0.0), float(force[most]), position, length)


def averaging_length(bha: BottomHoleAssembly, wave: Rippling) -> float:
    """The length of hole over which a summary averages inclinations, m.

    It is half the length of the BHA, whichever stabilizers touch the wall; where a wave lasts, the smallest whole
    number of wavelengths that is at least as long.
    """
    if wave.state in (State.NONE, State.DYING):
        return bha.half_length
    return wave.wavelength * ceil(bha.half_length / wave.wavelength)


def hidden_waves(length: Floats, bha: BottomHoleAssembly) -> str:
    """The waves that rows too far apart, or a run too short, hide; empty if none of those that this BHA may make."""
    shortest, longest = visible_waves(length)
    hidden = []
    if shortest > SHORT_WAVE * bha.half_length:
        hidden.append(f"under {shortest:.2g} m: take rows closer together (--sample-interval)")
    if longest < LONG_WAVE * bha.half_length:
        hidden.append(f"over {longest:.3g} m: drill further (--length)")
    return ", ".join(hidden)


def mean_inclination(run: Trajectory, survey: Survey, over: float) -> Floats:
    """The inclination at each row of a run of the chord to the hole `over` metres behind, rad, shape (rows,).

    The run starts at the end of the survey; above the first station of the survey the hole is straight. In space
    inclinations have no sign.
    """
    if is_in_space(run):
        return inclination_of(chord_direction(hole_in_space(run, survey, over), run["drilled_length"], over))
    behind = hole_of(run, survey, over).at(run["drilled_length"] - over)
    inclination: Floats = np.arctan2(*(bit_positions(run) - behind).T)
    turns = np.abs(inclination[1:] - inclination[:-1])
    return np.unwrap(inclination) if turns.max(initial=0.0) > pi else inclination  # unwrap only a hole past vertical

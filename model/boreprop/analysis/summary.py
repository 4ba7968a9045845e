"""A run in a dozen numbers."""

from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..core.survey import Survey
from ..core.system import BottomHoleAssembly
from ..run.completion import case_of
from ..run.trajectory import Trajectory
from ..units import BUILD_LENGTH
from .rippling import Rippling, State, find_rippling, visible_waves

SHORT_WAVE, LONG_WAVE = 0.25, 1.8  # half BHAs: what ripples are between
CHORD = np.linspace(-1.0, 0.0, 200)  # points of the existing hole under a chord: millimetres of any bend are not seen


@dataclass(frozen=True)
class Summary:
    """What an engineer asks of a run first. Inclinations are means over the `averaging_length` behind the bit.

    Parameters
    ----------
    drilled_length
        m.
    averaging_length
        Length of hole that inclinations are means over, m.
    start_inclination, end_inclination
        rad.
    build_rate, largest_build_rate
        Over the whole run, and the largest in size over any 30 m (nan in a shorter run), rad/m; positive builds.
    largest_contact_force
        For each non-ideal stabilizer, in size, N, shape (n − 1,).
    contact_share
        Share of the length each non-ideal stabilizer touches a wall, shape (n − 1,).
    saturation_share
        Share of the length the bit tilt is at its limit.
    rippling
        Whether it ends rippling, with what wave.
    hidden_waves
        Why waves that this BHA may make would not show, "" if they would.
    stopped
        Why the run ended before its end, if it did.
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
    hidden_waves: str
    stopped: str | None = None


def summarize(trajectory: Trajectory) -> Summary:
    """Sum up a run.

    Parameters
    ----------
    trajectory
        With its case, of at least two rows.

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
    case_of(trajectory)
    return sum_up(trajectory, find_rippling(trajectory))


def sum_up(trajectory: Trajectory, rippling: Rippling) -> Summary:
    """`summarize` a run whose rippling is known."""
    case = case_of(trajectory)
    length = trajectory["drilled_length"]
    over = averaging_length(case.bha, rippling)
    inclination = mean_inclination(trajectory, case.survey, over)
    steps = np.diff(length)
    weights = np.append(steps, 0.0) + np.append(0.0, steps)

    def share(happens: NDArray[np.bool_]) -> float:
        return float(weights[happens].sum() / weights.sum())

    later = length + BUILD_LENGTH
    drilled_by_then = slice(int(np.searchsorted(later, length[-1], side="right")))
    rates = (np.interp(later[drilled_by_then], length, inclination) - inclination[drilled_by_then]) / BUILD_LENGTH
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
        hidden_waves=hidden_waves(length, case.bha),
        stopped=trajectory.stopped,
    )


def averaging_length(bha: BottomHoleAssembly, wave: Rippling) -> float:
    """The length of hole that a summary averages inclinations over, m.

    Half the BHA, whichever of its blades touch; where a wave lasts, the next whole number of wavelengths.
    """
    if wave.state in (State.NONE, State.DYING):
        return bha.half_length
    return wave.wavelength * ceil(bha.half_length / wave.wavelength)


def hidden_waves(length: Floats, bha: BottomHoleAssembly) -> str:
    """Which waves the rows of a run are too far apart, or the run is too short, to show; "" if none that matter."""
    shortest, longest = visible_waves(length)
    hidden = []
    if shortest > SHORT_WAVE * bha.half_length:
        hidden.append(f"under {shortest:.2g} m: take rows closer together")
    if longest < LONG_WAVE * bha.half_length:
        hidden.append(f"over {longest:.3g} m: drill further")
    return ", ".join(hidden)


def mean_inclination(run: Trajectory, survey: Survey, over: float) -> Floats:
    """The inclination of the chord over the last `over`, m, of the hole at each row of a run, rad, shape (rows,).

    The run starts at the end of the survey, above which the hole goes on straight.
    """
    before = over * CHORD
    stations = np.array(survey.measured_depth) - survey.measured_depth[-1]
    turns = np.interp(before[1:] + before[-2] / 2, stations, survey.inclination)
    existing = np.cumsum(np.exp(1j * turns)) * (over / (len(before) - 1))  # down + i sideways
    length, drilled = run["drilled_length"], run["true_vertical_depth"] + 1j * run["displacement"]
    at = np.concatenate((before, length))
    axis = np.concatenate(([0.0], existing, existing[-1] + drilled))
    chord = axis[-len(length) :] - np.interp(length - over, at, axis)
    inclination: Floats = np.arctan2(chord.imag, chord.real)
    turns = np.abs(inclination[1:] - inclination[:-1])
    return np.unwrap(inclination) if turns.max(initial=0.0) > pi else inclination  # seldom: a hole past straight up

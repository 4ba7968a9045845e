"""Finds whether a hole ripples, and with what wave, from its inclination over the drilled length.

A hole ripples if, at the end of the run and while force and weight are constant, its inclination swings in waves that
sustain themselves. There must be at least five waves, no longer than three BHAs, of ±0.001° or more, that lose no more
than 3 % of their size from wave to wave. They need not be equal: chaotic ripples count.

As long as no contact and no saturation changes, the equations are linear, and a wave grows or dies but cannot last. So
every wave of a ripple changes the mode of the BHA. A wave that changes no mode and falls, however slowly, is dying out.

The finding holds for the inclination at which the run ends: as the inclination changes, gravity changes ripples and may
end them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import groupby
from math import exp, inf, log, nan
from statistics import median
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..core.system import BottomHoleAssembly
from ..errors import InputError
from ..run.ground import STEADY
from ..run.trajectory import Trajectory
from .waves import (
    FEWEST_ROWS,
    FEWEST_WAVES,
    LastWaves,
    large_since,
    likeness,
    mean_over,
    slope,
    wavelength_in_rows,
    without_even_trend,
)

LONGEST = 6.0  # half lengths of the BHA: the longest wave that is searched for
SHORTER = 4.0  # each window is shorter than the last by this factor, so that small short waves on long ones are found
SMALLEST_AMPLITUDE = np.radians(0.001)  # far above the error that the integrator leaves in a straight hole, 1e-10°
ALIKE = 0.5  # the autocorrelation at one wavelength from which a signal counts as a wave
ALIKE_SWITCHING = 0.2  # the same if each wave changes the mode, which noise does not: chaotic ripples have 0.25 to 0.6
NOISE = 4.5  # standard deviations, 1/√rows, of the autocorrelation of white noise: noise reaches this at no lag tried
STILL_ALIKE = 0.8  # times ALIKE: the autocorrelation that the last waves must have, or the wave has ended
AT_THE_END = 4  # waves at the end that decide whether a wave is still there, its size and whether it changes modes
MOST_WAVES = 10  # waves at the end from which the growth is determined, …
MOST_OF_LONGEST = 2.0  # … or as many as fit into this many of the longest waves, if more: ripples beat
FALLING = 0.03  # loss of size per wave: a wave that falls faster, to half within 23 waves, is dying
FALLING_IN_ONE_MODE = 1e-4  # the same for a wave that changes no mode, whose exponential decay is this well determined
HALF = 0.5  # of its size at the end: a wave counts as present since it has had this size
PHASES = 64  # points of a wave at which its mode is determined


class Stretch(NamedTuple):
    """A part of a wave in one mode.

    It has the contact of each non-ideal stabilizer, the saturation of the bit tilt, and its share of the wavelength.
    """

    contact: tuple[int, ...]
    saturation: int
    share: float


class State(StrEnum):
    """What becomes of a wave at the end of a run."""

    NONE = "none"  # there is no wave
    DYING = "dying"
    LASTING = "lasting"
    GROWING = "growing"
    STEERED = "steered"  # there is a wave, but force or weight change too often to say whether it would last


@dataclass(frozen=True)
class Rippling:
    """The wave with which a run ends. Fields are nan or empty if there is no wave or if they were not computed.

    Parameters
    ----------
    state
        What becomes of the wave.
    wavelength
        Length of a wave along the hole, m.
    amplitude
        Half the height, from crest to trough, of the mean of the last waves of the inclination, rad.
    growth
        Change of the logarithm of the amplitude per drilled length, 1/m.
    since
        The drilled length from which on the wave has had at least half the size that it has at the end, m.
    spread
        Standard deviation of the last wavelengths, m.
    inclination_drift
        Slope of the least-squares line through the trend about which the inclination swings, rad/m.
    switching
        Whether a contact or the saturation changes in each of the last waves; None if the run does not say.
    axis_amplitude
        Half the height, from crest to trough, of the mean of the last waves of the hole axis, m.
    modes
        The modes that one wave goes through, beginning where the inclination rises through its trend: the wall that
        each stabilizer touches (1 lower, −1 upper, 0 none) and the saturation of the bit tilt (1, −1, 0). At each phase
        it is the mode of most of the last waves.
    """

    state: State = State.NONE
    wavelength: float = nan
    amplitude: float = nan
    growth: float = nan
    since: float = nan
    spread: float = nan
    inclination_drift: float = nan
    switching: bool | None = None
    axis_amplitude: float = nan
    modes: tuple[Stretch, ...] = ()

    @property
    def ripples(self) -> bool:
        """Whether the wave lasts or grows."""
        return self.state in (State.LASTING, State.GROWING)

    @property
    def fading_length(self) -> float:
        """The drilled length over which a dying wave falls to a tenth of its size, m; inf if the wave is not dying."""
        return log(10.0) / -self.growth if self.growth < 0 else inf

    def growth_over(self, length: float) -> float:
        """The relative change of the amplitude over a drilled length, m: 0.1 is growth by a tenth."""
        return exp(min(self.growth * length, 700.0)) - 1.0  # of 710 the exponential would overflow


@dataclass(frozen=True)
class _Rows:
    """Some rows of a run: drilled length, m, inclination, rad, and modes, whole numbers, shape (rows, k)."""

    length: Floats
    inclination: Floats
    modes: NDArray[np.int_] | None

    def where(self, kept: NDArray[np.bool_] | slice) -> "_Rows":
        """The rows that a mask or a slice selects."""
        return _Rows(self.length[kept], self.inclination[kept], None if self.modes is None else self.modes[kept])


class _Found(NamedTuple):
    """A wave that was found, the last of its waves, and the rows that end with them; the defaults if there is none."""

    rippling: Rippling = Rippling()
    waves: LastWaves | None = None
    rows: _Rows | None = None


_NOTHING = _Found()


def longest_wave(bha: BottomHoleAssembly) -> float:
    """The longest wave that is searched for in the hole of a BHA, m."""
    return LONGEST * bha.half_length


def visible_waves(drilled_length: Floats) -> tuple[float, float]:
    """The shortest and the longest wave that can be found in the rows of a run, m."""
    span = float(drilled_length[-1] - drilled_length[0])
    moves = int(np.count_nonzero(np.diff(drilled_length)))
    return FEWEST_ROWS * span / max(moves, 1), span / FEWEST_WAVES


def find_rippling(
    run: Trajectory | Floats,
    inclination: Floats | None = None,
    longest: float | None = None,
    *,
    modes: NDArray[np.int_] | None = None,
    inputs: Sequence[Floats] = (),
) -> Rippling:
    """Find whether a run ends rippling, and with what wave.

    If there are several waves that last, it is the one with the largest amplitude. A wave must be at least eight rows
    long and repeat five times to be found. The module's docstring defines a ripple.

    Parameters
    ----------
    run
        A run; force and weight are taken to be constant if it lacks their columns. Instead, for a hole without a run,
        the drilled length, m, not decreasing, shape (rows,); then the other parameters give the rest, and nothing is
        found about the axis and the modes.
    inclination
        Inclination of the borehole, rad, shape (rows,). Only without a run, where it is needed.
    longest
        The longest wave that is searched for, m. None: the `longest_wave` of the run's case, without a case any wave.
    modes
        Contact of each stabilizer and saturation of the bit tilt, whole numbers, shape (rows, k). Only without a run.
        If they are not given, a wave that dies out very slowly counts as lasting.
    inputs
        Steering force and active weight on bit, shape (rows,) each. Only without a run. If they are not given, they are
        taken to be constant.

    Returns
    -------
    Rippling
        The wave, in SI units; its state is `State.NONE` if there is none.

    Raises
    ------
    InputError
        If the run lacks a column of inclination, position, contact or saturation, or two arrays do not fit together.

    Examples
    --------
    >>> from boreprop import find_rippling, paper_case, simulate
    >>> wave = find_rippling(simulate(paper_case(), sample_interval=0.25))
    >>> wave.state, round(wave.wavelength, 2)
    (<State.LASTING: 'lasting'>, 5.07)
    """
    if isinstance(run, Trajectory):
        return _with_details(run, _wave_of(run, longest))
    if inclination is None:
        raise InputError("inclination: must be given with the drilled length, got None")
    if np.shape(run) != np.shape(inclination):
        shapes = f"{np.shape(inclination)} for {np.shape(run)}"
        raise InputError(f"inclination: must have a value for each drilled length, got the shapes {shapes}")
    return _with_course(_find(run, inclination, inf if longest is None else longest, modes, inputs))


def last_wave(run: Trajectory) -> Rippling:
    """`find_rippling` of a run without the fields since, spread, inclination_drift, axis_amplitude and modes.

    Studies do not report these, and they take longest to compute.
    """
    return _wave_of(run, None).rippling


def _wave_of(run: Trajectory, longest: float | None) -> _Found:
    """The wave with which a run ends, with its last waves and their rows."""
    if longest is None:
        longest = longest_wave(run.case.bha) if run.case else inf
    inputs = [run[name] for name in STEADY if name in run.columns]
    return _find(run["drilled_length"], run["borehole_inclination"], longest, modes_of(run), inputs)


def _with_details(run: Trajectory, found: _Found) -> Rippling:
    """The wave that was found, with the fields since, spread, axis_amplitude and modes."""
    length = run["drilled_length"]
    position = np.column_stack((run["displacement"], run["true_vertical_depth"]))
    if found.waves is None:
        return found.rippling
    starts = found.waves.starts()
    return replace(
        _with_course(found),
        spread=float(np.std(np.diff(starts))) if len(starts) > 1 else nan,
        axis_amplitude=_axis_amplitude(length, position, found.waves),
        modes=_modes(length, modes_of(run), starts) if len(starts) > 1 else (),
    )


def modes_of(run: Trajectory) -> NDArray[np.int_]:
    """Contact of each non-ideal stabilizer and saturation of the bit tilt, whole numbers, shape (rows, n)."""
    return np.column_stack((run.stack("stabilizer_contact"), run["bit_tilt_saturation"])).astype(int)


def _find(
    length: Floats,
    inclination: Floats,
    longest: float,
    modes: NDArray[np.int_] | None,
    inputs: Sequence[Floats],
) -> _Found:
    """The wave at the end of a run, see `find_rippling`."""
    changed = np.zeros(max(len(length) - 1, 0), dtype=bool)
    for values in inputs:
        changed |= values[1:] != values[:-1]
    moved = np.ones(len(length), dtype=bool)  # of several rows at one length, only the last one is used
    np.greater(length[1:], length[:-1], out=moved[:-1])
    steady = int(np.count_nonzero(moved[: int(np.flatnonzero(changed)[-1]) + 1])) if changed.any() else 0
    rows = _Rows(length, inclination, modes) if moved.all() else _Rows(length, inclination, modes).where(moved)
    found = _search(rows.where(slice(steady, None)), longest)
    if found.waves or not steady:
        return found
    found = _search(rows, longest)
    rippling = replace(found.rippling, state=State.STEERED)
    return found._replace(rippling=rippling) if found.rippling.ripples else _NOTHING


def _search(rows: _Rows, longest: float) -> _Found:
    """The wave in windows at the end of some rows: the first holds five of the longest waves, the last few rows."""
    found, fewest = [_NOTHING], int(FEWEST_WAVES * FEWEST_ROWS)
    if len(rows.length) < fewest:
        return _NOTHING
    spacing = (rows.length[-1] - rows.length[0]) / (len(rows.length) - 1)
    count = int(min(len(rows.length), FEWEST_WAVES * longest / spacing + 1))
    followed = MOST_OF_LONGEST * count * spacing / FEWEST_WAVES
    while count >= fewest:
        found.append(_wave(rows, spacing, count, followed))
        count = int(count / SHORTER)
    return max(found, key=_weight)


def _with_course(found: _Found) -> Rippling:
    """The wave that was found, with the fields since and inclination_drift."""
    if found.waves is None or found.rows is None:
        return found.rippling
    few = 1 if found.rippling.state is State.GROWING else AT_THE_END  # waves: of several that grow one is too small
    least = HALF * float(found.waves.sizes[-few:].min())
    return replace(
        found.rippling,
        since=large_since(found.rows.length, found.rows.inclination, found.waves.wavelength, least),
        inclination_drift=slope(found.waves.x, found.waves.trend),
    )


def _weight(found: _Found) -> tuple[bool, bool, float]:
    """A sort key: a wave that lasts comes before one that dies, and a large one before a small one."""
    there = found.waves is not None
    return found.rippling.ripples, there, found.rippling.amplitude if there else 0.0


def _wave(rows: _Rows, spacing: float, count: int, followed: float) -> _Found:
    """The wave in the last `count` rows, followed back over `followed` m, or over ten waves if that is more."""
    length, inclination = rows.length, rows.inclination
    grid = length[-1] - spacing * np.arange(count)[::-1]
    signal = without_even_trend(np.interp(grid, length, inclination))
    if np.abs(signal).max() < SMALLEST_AMPLITUDE:
        return _NOTHING
    period, alike = wavelength_in_rows(signal)
    enough = max(ALIKE, NOISE / np.sqrt(count - period)) if alike else inf
    if alike < enough and (rows.modes is None or alike < ALIKE_SWITCHING):
        return _NOTHING
    wavelength = float(period * spacing)
    waves = LastWaves.of(length, inclination, wavelength, max(MOST_WAVES, int(followed / wavelength)))
    if waves.count < FEWEST_WAVES - 1 or waves.sizes[-1] <= 0:
        return _NOTHING
    irregular = max(likeness(waves.deviation, period), ALIKE_SWITCHING)
    amplitude = waves.height() / 2 / irregular**0.5  # the mean of waves that differ is lower than each of them
    if amplitude < SMALLEST_AMPLITUDE:
        return _NOTHING
    switching = _switching(rows, waves)
    if not switching and (alike < enough or not _still_there(waves, period)):
        return _NOTHING
    growth, error = waves.growth()
    limit = FALLING_IN_ONE_MODE if switching is False else FALLING
    rippling = Rippling(
        State.DYING if growth + error < -limit else State.GROWING if growth - error > limit else State.LASTING,
        wavelength,
        amplitude,
        growth / wavelength,
        switching=switching,
    )
    return _Found(rippling, waves, rows)


def _switching(rows: _Rows, waves: LastWaves) -> bool | None:
    """Whether a contact or the saturation changes in each of the last waves; None without modes."""
    if rows.modes is None:
        return None
    late = int(np.searchsorted(waves.wave[1:], waves.count - AT_THE_END))
    first = int(np.searchsorted(rows.length, waves.x[late]))
    modes = rows.modes[first : first + len(waves.x) - late]
    changes = np.bincount(waves.wave[late + 1 :], (modes[1:] != modes[:-1]).any(axis=1), waves.count)
    return bool(median(changes[-AT_THE_END:].tolist()) >= 1)


def _still_there(waves: LastWaves, period: float) -> bool:
    """Whether the last four waves, taken alone, still count as a wave."""
    late = waves.deviation[waves.place >= waves.count - AT_THE_END]
    enough = STILL_ALIKE * max(ALIKE, NOISE / max(len(late) - period, 1.0) ** 0.5)
    return bool(likeness(late, period) >= enough)


def _axis_amplitude(length: Floats, position: Floats, waves: LastWaves) -> float:
    """Half the height of the waves of the axis, measured across its mean over one wavelength, m."""
    moved = np.append(np.diff(length) > 0, True)
    x, (sideways, down) = length[moved], position[moved].T
    inside, trend = mean_over(x, sideways + 1j * down, waves.wavelength)
    if len(trend) < 2:
        return nan
    away, forward = (sideways + 1j * down)[inside] - trend, np.gradient(trend)
    across = np.imag(forward * np.conj(away)) / np.abs(forward)
    return waves.height(np.interp(waves.x, x[inside], across)) / 2


def _modes(length: Floats, modes: NDArray[np.int_], starts: Floats) -> tuple[Stretch, ...]:
    """The modes that one wave goes through: at each phase the mode of most of the rows nearest to it, one of each wave.

    `starts` are the lengths at which the waves begin, and the end of the last one, m.
    """
    rows = (length >= starts[0]) & (length < starts[-1])
    phase = np.interp(length[rows], starts, np.arange(len(starts))) % 1.0
    kinds, kind = np.unique(modes[rows], axis=0, return_inverse=True)
    away = np.abs((phase - np.arange(PHASES)[:, None] / PHASES + 0.5) % 1.0 - 0.5)
    waves = len(starts) - 1
    nearest = np.argpartition(away, waves - 1, axis=1)[:, :waves]
    votes = [int(np.bincount(kind.ravel()[near]).argmax()) for near in nearest]
    stretches = [(k, len(list(group))) for k, group in groupby(votes)]
    if len(stretches) > 1 and stretches[0][0] == stretches[-1][0]:
        k, rest = stretches.pop()
        stretches[0] = k, stretches[0][1] + rest
    return tuple(Stretch((*map(int, kinds[k][:-1]),), int(kinds[k][-1]), count / PHASES) for k, count in stretches)

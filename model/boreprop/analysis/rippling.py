"""Finds whether a hole ripples, and with what wave, from its inclination over the drilled length.

A hole ripples if, at the end of the run and while force and weight are constant, its inclination swings in waves that
sustain themselves. There must be at least five waves, no longer than three BHAs, of ±0.001° or more, that lose no more
than 3 % of their size from wave to wave. They need not be equal: chaotic ripples count.

As long as no contact and no saturation changes, the equations are linear, and a wave grows or dies but cannot last. So
every wave of a ripple changes the mode of the BHA. A wave that changes no mode and falls, however slowly, is dying out.

The finding holds for the inclination at which the run ends: as the inclination changes, gravity changes ripples and may
end them.

In space the direction of the hole swings, to two sides, and a wave may wind: then the wavelength is the pitch, and the
amplitude that to the side where it is largest. What a planar hole does by the walls that stabilizers touch, it does by
their sides, too: a wave in which the force of a wall goes round changes modes.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from math import exp, inf, log, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Complexes, Floats
from ..core.system import BottomHoleAssembly
from ..errors import InputError
from ..run.ground import STEADY
from ..run.trajectory import Trajectory
from .ellipse import Ellipse, ellipse_of, sideways
from .hole_in_space import is_in_space, positions_in_space
from .search import AT_THE_END, Found, State, search
from .space import direction_of, sides_of
from .waves import FEWEST_ROWS, FEWEST_WAVES, LastWaves, large_since, mean_over, slope

LONGEST = 6.0  # half lengths of the BHA: the longest wave that is searched for
HALF = 0.5  # of its size at the end: a wave counts as present since it has had this size
PHASES = 64  # points of a wave at which its mode is determined


class Stretch(NamedTuple):
    """A part of a wave in one mode.

    It has the contact of each non-ideal stabilizer, the saturation of the bit tilt, and its share of the wavelength.
    """

    contact: tuple[int, ...]
    saturation: int
    share: float


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
        it is the mode of most of the last waves. In space it is empty.
    ellipse
        In space, the ellipse in which the hole goes through its last waves; None in a plane.
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
    ellipse: Ellipse | None = None

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
    return _with_course(search(run, inclination, inf if longest is None else longest, modes, inputs))


def last_wave(run: Trajectory) -> Rippling:
    """`find_rippling` of a run without the fields since, spread, inclination_drift, axis_amplitude and modes.

    Studies do not report these, and they take longest to compute.
    """
    return _plain(_wave_of(run, None))


def _plain(found: Found) -> Rippling:
    """The wave that was found, without its details."""
    return Rippling(found.state, found.wavelength, found.amplitude, found.growth, switching=found.switching)


def _wave_of(run: Trajectory, longest: float | None) -> Found:
    """The wave with which a run ends, with its last waves and their rows."""
    if longest is None:
        longest = longest_wave(run.case.bha) if run.case else inf
    inputs = [run[name] for name in (*STEADY, "rss_toolface") if name in run.columns]
    if is_in_space(run):
        sides = sides_of(run) if "bit_tilt_saturation" in run else None  # a measured hole has none
        return search(run["drilled_length"], direction_of(run), longest, sides, inputs)
    return search(run["drilled_length"], run["borehole_inclination"], longest, modes_of(run), inputs)


def _with_details(run: Trajectory, found: Found) -> Rippling:
    """The wave that was found, with the fields since, spread, axis_amplitude and modes; in space with its ellipse."""
    if is_in_space(run):
        return _with_ellipse(run, found)
    length = run["drilled_length"]
    position = np.column_stack((run["displacement"], run["true_vertical_depth"]))
    if found.waves is None:
        return _plain(found)
    starts = found.waves.starts()
    return replace(
        _with_course(found),
        spread=float(np.std(np.diff(starts))) if len(starts) > 1 else nan,
        axis_amplitude=_axis_amplitude(length, position, found.waves),
        modes=_modes(length, modes_of(run), starts) if len(starts) > 1 else (),
    )


def _with_ellipse(run: Trajectory, found: Found) -> Rippling:
    """The wave that was found in space, with all fields but modes."""
    if found.waves is None:
        return _plain(found)
    length = run["drilled_length"]
    moved = np.append(np.diff(length) > 0, True)
    starts = found.waves.along(found.waves.axis).starts()
    hole = sideways(length[moved], positions_in_space(run)[moved], found.wavelength)
    inside, inclination = mean_over(length[moved], run["borehole_inclination"][moved], found.wavelength)
    late = length[moved][inside] >= found.waves.x[0]
    ellipse = ellipse_of(hole, found.wavelength) if hole else None
    return replace(
        _with_course(found),
        wavelength=ellipse.pitch if ellipse and ellipse.pitch > 0 else found.wavelength,
        spread=float(np.std(np.diff(starts))) if len(starts) > 1 else nan,
        inclination_drift=slope(length[moved][inside][late], inclination[late]),
        axis_amplitude=_height(found.waves, hole.length, hole.away) / 2 if hole else nan,
        ellipse=ellipse,
    )


def _height(waves: LastWaves, x: Floats, away: Complexes) -> float:
    """The height of the mean of the last waves of the axis, to the side to which it is largest, m."""
    axis = replace(waves, deviation=np.interp(waves.x, x, away))
    return axis.along(axis.axis).height()


def modes_of(run: Trajectory) -> NDArray[np.int_]:
    """Contact of each non-ideal stabilizer and saturation of the bit tilt, whole numbers, shape (rows, n)."""
    return np.column_stack((run.stack("stabilizer_contact"), run["bit_tilt_saturation"])).astype(int)


def _with_course(found: Found) -> Rippling:
    """The wave that was found, with the fields since and inclination_drift, which in space is nan."""
    if found.waves is None or found.length is None or found.direction is None:
        return _plain(found)
    few = 1 if found.state is State.GROWING else AT_THE_END  # waves: of several that grow one is too small
    least = HALF * float(found.waves.sizes[-few:].min())
    return replace(
        _plain(found),
        since=large_since(found.length, found.direction, found.wavelength, least),
        inclination_drift=nan if np.iscomplexobj(found.direction) else slope(found.waves.x, found.waves.trend),
    )


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
    met = [tuple(mode) for mode in modes[rows].tolist()]
    kinds = sorted(set(met))
    kind = np.array([kinds.index(mode) for mode in met])
    away = np.abs((phase - np.arange(PHASES)[:, None] / PHASES + 0.5) % 1.0 - 0.5)
    waves = len(starts) - 1
    nearest = np.argpartition(away, waves - 1, axis=1)[:, :waves]
    votes = [int(np.bincount(kind[near]).argmax()) for near in nearest]
    stretches = [(k, len(list(group))) for k, group in groupby(votes)]
    if len(stretches) > 1 and stretches[0][0] == stretches[-1][0]:
        k, rest = stretches.pop()
        stretches[0] = k, stretches[0][1] + rest
    return tuple(Stretch(kinds[k][:-1], kinds[k][-1], count / PHASES) for k, count in stretches)

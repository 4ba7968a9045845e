"""Is a hole rippling, and with what wave: from the inclination or the position of its axis over the drilled length."""

from dataclasses import dataclass, replace
from itertools import groupby
from math import nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..results import Trajectory

POINTS = 64  # samples per ℓ₁ that the signal is resampled to
PHASES = 64  # samples of a wave
TREND = 1.0  # ℓ₁: width of the Gaussian mean that is the trend; of a wave of 1.4 ℓ₁ it keeps e⁻¹⁰
REACH = 3.0  # widths: what the mean sees to each side
WINDOW = 12.0  # ℓ₁ at the end of the run that are looked at: some nine waves
SHORTEST, LONGEST = 0.25, 3.0  # ℓ₁: waves that are looked for
SAME_PEAK = 0.9  # of the highest peak of the autocorrelation: a peak as high, at a shorter lag, is the wavelength
FUNDAMENTAL = 0.25  # wavelengths: Gaussian that leaves a wave two zeros; of its third harmonic it keeps e⁻¹¹
FEWEST_WAVES = 4
SMALLEST_AMPLITUDE = np.radians(0.01)
LARGEST_SPREAD = 0.1  # of the wavelengths, over their mean
LEAST_ALIKE = 0.7  # share of the mean square that is the mean wave, as large as it is each time
LEAST_KEPT = 0.9  # of its size, from one wave to the next
AXIS_POINTS = 40  # samples per ℓ₁ of the axis
AXIS_REACH = 4.0  # ℓ₁ of hole that the trend of the axis needs to each side


class Stretch(NamedTuple):
    """A part of a wave in one mode: contact of each non-ideal stabilizer, saturation of the tilt, share of the wave."""

    contact: tuple[int, ...]
    tilt: int
    share: float


@dataclass(frozen=True)
class Rippling:
    """Whether a run ends rippling, and its wave; nan and empty if it does not ripple or nobody looked.

    Parameters
    ----------
    ripples
        True if the inclination ends in waves of equal length and shape that do not die out.
    wavelength
        Mean of the last waves, m.
    amplitude
        Half the difference between highest and lowest inclination of the last waves, their trend removed, rad.
    spread
        Standard deviation of the last wavelengths, m.
    amplitude_drift, inclination_drift
        Change of the amplitude and of the trend of the inclination along the last waves, rad/m.
    axis_amplitude
        Half the width of the wave of the hole axis, its trend removed, m.
    modes
        The modes of one wave in turn, from where the inclination rises through its trend: which stabilizer touches
        which wall (1 lower, −1 upper, 0 free), and at which limit the tilt is. What most of the last waves agree on.
    """

    ripples: bool
    wavelength: float = nan
    amplitude: float = nan
    spread: float = nan
    amplitude_drift: float = nan
    inclination_drift: float = nan
    axis_amplitude: float = nan
    modes: tuple[Stretch, ...] = ()


def find_rippling(
    drilled_length: NDArray[np.float64], inclination: NDArray[np.float64], length_scale: float
) -> Rippling:
    """Look for a self-sustained wave at the end of a run.

    The inclination less its trend is cut into waves as long as its autocorrelation says. They must be of equal length
    and of one shape, and keep their size. Of that shape nothing is asked: it may cross its trend more than twice.

    Parameters
    ----------
    drilled_length
        m, increasing, shape (rows,).
    inclination
        Of the borehole, rad, shape (rows,).
    length_scale
        ℓ₁, m; rippling has a wavelength of that order.
    """
    return _find(drilled_length, inclination, length_scale)[0]


def examine_rippling(run: Trajectory, length_scale: float) -> Rippling:
    """`find_rippling` of a whole run, with the wave of its axis and the modes of a wave; `length_scale` is ℓ₁, m.

    Raises
    ------
    InputError
        If the run lacks a column of inclination, position, contact or saturation.
    """
    length = run["drilled_length"]
    found, starts = _find(length, run["borehole_inclination"], length_scale)
    if not found.ripples:
        return found
    position = np.column_stack((run["displacement"], run["true_vertical_depth"]))
    at, axis = axis_ripple(length, position, length_scale)
    whole = starts[(starts >= at[0]) & (starts <= at[-1])]
    modes = np.column_stack((run.stack("stabilizer_contact"), run["bit_tilt_saturation"])).astype(int)
    return replace(
        found,
        axis_amplitude=_height(at, axis, whole) / 2,
        modes=_modes(length, modes, starts),
    )


def _find(
    drilled_length: NDArray[np.float64], inclination: NDArray[np.float64], length_scale: float
) -> tuple[Rippling, NDArray[np.float64]]:
    """See `find_rippling`; also where the last waves start and the last one ends, m."""
    nothing = Rippling(False), np.empty(0)
    xi = drilled_length / length_scale
    one_sided = int(REACH * TREND * POINTS)  # at the ends the mean sees one side only
    samples = int(min(xi[-1] - xi[0], WINDOW + 2 * REACH * TREND) * POINTS)
    if samples < 3 * one_sided:
        return nothing
    grid = xi[-1] - np.arange(samples)[::-1] / POINTS
    signal = np.interp(grid, xi, inclination)
    trend = gaussian_filter1d(signal, TREND * POINTS, truncate=REACH)
    within = slice(one_sided, samples - one_sided)
    wave = (signal - trend)[within]
    if np.ptp(wave) / 2 < SMALLEST_AMPLITUDE:
        return nothing
    fundamental = gaussian_filter1d(signal - trend, FUNDAMENTAL * _period(wave))[within]
    grid, trend = grid[within], trend[within]
    upward = np.flatnonzero((fundamental[:-1] < 0) & (fundamental[1:] >= 0))
    starts = grid[upward] - fundamental[upward] / (fundamental[upward + 1] - fundamental[upward]) / POINTS
    lengths = np.diff(starts)
    if len(lengths) < FEWEST_WAVES or np.std(lengths) > LARGEST_SPREAD * np.mean(lengths):
        return nothing
    waves = _cut(grid, wave, starts)
    mean = waves.mean(axis=0)
    sizes = waves @ mean / (mean @ mean)  # of each wave, one on average
    early, late = (np.mean(half) for half in np.array_split(sizes, 2))
    alike = 1 - np.sum((waves - np.outer(sizes, mean)) ** 2) / np.sum(waves**2)
    amplitude = _height(xi, inclination - np.interp(xi, grid, trend), starts) / 2
    if amplitude < SMALLEST_AMPLITUDE or alike < LEAST_ALIKE or late < LEAST_KEPT ** (len(sizes) / 2) * early:
        return nothing
    middles = (starts[:-1] + starts[1:]) / 2
    found = Rippling(
        True,
        wavelength=float(np.mean(lengths)) * length_scale,
        amplitude=float(amplitude),
        spread=float(np.std(lengths)) * length_scale,
        amplitude_drift=_slope(middles, np.ptp(mean) / 2 * sizes) / length_scale,
        inclination_drift=_slope(grid, trend) / length_scale,
    )
    return found, starts * length_scale


def _period(wave: NDArray[np.float64]) -> float:
    """Samples between the repeats of `wave`: the first high peak of its autocorrelation."""
    lags = np.arange(int(SHORTEST * POINTS), int(LONGEST * POINTS) + 1)
    alike = np.array([np.mean(wave[lag:] * wave[:-lag]) for lag in lags])
    peaks = np.flatnonzero((alike[1:-1] >= alike[:-2]) & (alike[1:-1] > alike[2:])) + 1
    high = peaks[alike[peaks] >= SAME_PEAK * alike[peaks].max(initial=0.0)]
    return float(lags[high[0] if len(high) else -1])


def _cut(at: NDArray[np.float64], values: NDArray[np.float64], starts: NDArray[np.float64]) -> NDArray[np.float64]:
    """The waves of `values` between `starts`, shape (len(starts) − 1, PHASES)."""
    phases = np.arange(PHASES) / PHASES
    return np.interp(starts[:-1, None] + np.diff(starts)[:, None] * phases, at, values)


def _height(at: NDArray[np.float64], values: NDArray[np.float64], starts: NDArray[np.float64]) -> float:
    """Between the highest and the lowest of the rows of the waves; nan without any.

    Rows as they are: a wave may have steps, whose edges resampling would round.
    """
    within = values[(at >= starts[0]) & (at <= starts[-1])] if len(starts) else starts
    return float(np.ptp(within)) if len(within) else nan


def _slope(x: NDArray[np.float64], y: NDArray[np.float64]) -> float:
    """Of the straight line that fits best."""
    return float(np.polynomial.Polynomial.fit(x, y, 1).deriv()(x[0]))


def _modes(length: NDArray[np.float64], modes: NDArray[np.int_], starts: NDArray[np.float64]) -> tuple[Stretch, ...]:
    """The modes of a wave in turn: at each phase the one that most of the rows nearest in phase, one a wave, are in."""
    rows = (length >= starts[0]) & (length < starts[-1])
    phase = np.interp(length[rows], starts, np.arange(len(starts))) % 1.0
    kinds, kind = np.unique(modes[rows], axis=0, return_inverse=True)
    away = np.abs((phase - np.arange(PHASES)[:, None] / PHASES + 0.5) % 1.0 - 0.5)
    nearest = np.argsort(away, axis=1)[:, : len(starts) - 1]
    votes = [int(np.bincount(kind.ravel()[near]).argmax()) for near in nearest]
    stretches = [(k, len(list(group))) for k, group in groupby(votes)]
    if len(stretches) > 1 and stretches[0][0] == stretches[-1][0]:
        k, rest = stretches.pop()
        stretches[0] = k, stretches[0][1] + rest
    return tuple(Stretch((*map(int, kinds[k][:-1]),), int(kinds[k][-1]), count / PHASES) for k, count in stretches)


def axis_ripple(
    length: NDArray[np.float64], position: NDArray[np.float64], length_scale: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How far the axis of a hole lies from its smooth trend, to the high side.

    The trend is a mean over the neighbourhood whose weights, a Gaussian of ℓ₁ times a parabola, leave straight and
    evenly curved holes as they are; of a wave of 1.4 ℓ₁ it keeps less than 10⁻³.

    Parameters
    ----------
    length
        m, increasing, shape (N,).
    position
        Of the axis in the vertical plane, horizontal and down, m, shape (N, 2).
    length_scale
        ℓ₁, m.

    Returns
    -------
    length, ripple
        At whole multiples of a fortieth of ℓ₁, as far as the hole goes on for `AXIS_REACH` ℓ₁ to both sides, m, shape
        (k,), perhaps empty.
    """
    spacing = length_scale / AXIS_POINTS
    first, last = np.ceil(length[0] / spacing), np.floor(length[-1] / spacing)
    at = spacing * np.arange(first, last + 1)
    u = np.arange(-AXIS_REACH * AXIS_POINTS, AXIS_REACH * AXIS_POINTS + 1) / AXIS_POINTS
    if len(at) < len(u):
        return np.empty(0), np.empty(0)
    gaussian = np.exp(-(u**2) / 2)
    weights = gaussian * (np.sum(gaussian * u**4) - np.sum(gaussian * u**2) * u**2)  # so the sum of u² weights is zero
    weights /= weights.sum()
    axis = np.column_stack([np.interp(at, length, coordinate) for coordinate in position.T])
    trend = np.column_stack([np.convolve(coordinate, weights, mode="valid") for coordinate in axis.T])
    within = slice(len(u) // 2, len(at) - len(u) // 2)
    away = axis[within] - trend
    forward = np.gradient(trend, axis=0) if len(trend) > 1 else axis[[-1]] - axis[[0]]
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    return at[within], away[:, 0] * forward[:, 1] - away[:, 1] * forward[:, 0]

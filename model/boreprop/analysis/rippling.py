"""Is a hole rippling, and with what wave: from the inclination or the position of its axis over the drilled length."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

POINTS = 64  # samples per ℓ₁ that the signal is resampled to
TREND = 1.0  # ℓ₁: width of the Gaussian mean that is the trend; of a wave of 1.4 ℓ₁ it keeps e⁻¹⁰
REACH = 3.0  # widths: what the mean sees to each side
WINDOW = 12.0  # ℓ₁ at the end of the run that are looked at: some nine waves
FEWEST_WAVES = 4
SMALLEST_AMPLITUDE = np.radians(0.01)
LARGEST_SPREAD = 0.1  # of the wavelengths, over their mean
LEAST_KEPT = 0.5  # of the amplitude, from the first half of the window to the second
AXIS_POINTS = 40  # samples per ℓ₁ of the axis
AXIS_REACH = 4.0  # ℓ₁ of hole that the trend of the axis needs to each side


@dataclass(frozen=True)
class Rippling:
    """Whether a run ends rippling, and its wave.

    Parameters
    ----------
    ripples
        True if the inclination ends in waves of equal length that do not die out.
    wavelength
        m; nan if it does not ripple.
    amplitude
        Half the difference between highest and lowest inclination of the wave, its trend removed, rad; nan if it does
        not ripple.
    """

    ripples: bool
    wavelength: float = float("nan")
    amplitude: float = float("nan")


def find_rippling(
    drilled_length: NDArray[np.float64], inclination: NDArray[np.float64], length_scale: float
) -> Rippling:
    """Look for a self-sustained wave at the end of a run.

    The inclination less its trend must cross zero at equal distances, in waves that keep their height.

    Parameters
    ----------
    drilled_length
        m, increasing, shape (rows,).
    inclination
        Of the borehole, rad, shape (rows,).
    length_scale
        ℓ₁, m; rippling has a wavelength of that order.
    """
    xi = drilled_length / length_scale
    grid = np.arange(xi[0], xi[-1], 1 / POINTS)
    one_sided = int(REACH * TREND * POINTS)  # at the ends the mean sees one side only
    if len(grid) < 3 * one_sided:
        return Rippling(False)
    signal = np.interp(grid, xi, inclination)
    wave = signal - gaussian_filter1d(signal, TREND * POINTS, truncate=REACH)
    last = slice(max(len(grid) - one_sided - int(WINDOW * POINTS), one_sided), len(grid) - one_sided)
    wave, grid = wave[last], grid[last]
    upward = np.flatnonzero((wave[:-1] < 0) & (wave[1:] >= 0))
    crossings = grid[upward] + (0 - wave[upward]) / (wave[upward + 1] - wave[upward]) / POINTS
    lengths = np.diff(crossings)
    early, late = (np.ptp(half) / 2 for half in np.array_split(wave, 2))
    ripples = (
        len(lengths) >= FEWEST_WAVES
        and np.std(lengths) <= LARGEST_SPREAD * np.mean(lengths)
        and late >= max(SMALLEST_AMPLITUDE, LEAST_KEPT * early)
    )
    return Rippling(True, float(np.mean(lengths)) * length_scale, float(late)) if ripples else Rippling(False)


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

"""Waves at the end of a signal: how long they are, how alike, how large, and how their size changes.

Nothing here knows what the signal is. Signals come as rows; where a function takes `x`, it may have any spacing.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats

FEWEST_ROWS = 8  # of a wave: with fewer its steepest part lies between two rows
FEWEST_WAVES = 5.0  # where waves are looked for: four whole ones, and a half at each end for their trend
DEGREE = 3  # of the polynomial that is the trend while the wavelength is not known: it leaves five waves as they are
SHALLOW = 0.8  # of a peak: an autocorrelation that has not fallen below it on the way there is a trend with noise
AS_HIGH = 0.8  # of the highest peak: a peak as high at a shorter lag is the wavelength, the others its multiples
FLANK = 0.15  # of a lag: how far from the top of a peak noise may make another one
DRIFT = 0.1  # of a wavelength: how far a peak may lie from the multiple of the wavelength at which it is looked for
ALMOST = 0.02  # of a wave: what may be missing of the last one, whose ends no rows need lie on
LAST_LAG = 0.6  # of the rows: beyond it too few overlap
KEPT = 64  # bases of polynomials, one for each number of rows: the cases of a study have the same few

Integers = NDArray[np.intp]


def without_trend(x: Floats, signal: Floats) -> Floats:
    """A signal less the polynomial of degree `DEGREE` in x that fits it best, shape (rows,)."""
    return _less(_polynomials(2 * (x - x[0]) / (x[-1] - x[0]) - 1), signal)


def without_even_trend(signal: Floats) -> Floats:
    """The same of a signal whose rows are evenly spaced."""
    return _less(_even_polynomials(len(signal)), signal)


def _less(basis: Floats, signal: Floats) -> Floats:
    """A signal less its part in an orthonormal basis, shape (rows, k)."""
    trend: Floats = basis @ (basis.T @ signal)
    return signal - trend


def _polynomials(x: Floats) -> Floats:
    """An orthonormal basis of the polynomials of degree `DEGREE` over x, from −1 to 1: shape (rows, DEGREE + 1)."""
    return np.linalg.qr(np.polynomial.legendre.legvander(x, DEGREE)).Q


@lru_cache(KEPT)
def _even_polynomials(rows: int) -> Floats:
    return _polynomials(np.linspace(-1.0, 1.0, rows))


def slope(x: Floats, y: Floats) -> float:
    """The slope of the least-squares line through points, shape (rows,) each."""
    away = x - x.mean()
    return float(away @ y / (away @ away))


def autocorrelation(signal: Floats, lags: int) -> Floats:
    """Correlation of a signal with itself `lag` rows ago, for lag = 0, 1, …, `lags` − 1, fewer than the rows.

    The signal is evenly spaced, shape (rows,). Each lag is taken over the rows that overlap: a wave that grows or dies
    has 1 at its wavelength, like one that lasts.
    """
    rows = len(signal)
    padded = 2 ** (rows + lags - 1).bit_length()  # scipy.fft takes as long, and half a second more to import
    spectrum = np.fft.rfft(signal, padded)
    products = np.fft.irfft(spectrum.real**2 + spectrum.imag**2, padded)[:lags]
    energy = np.concatenate(([0.0], np.cumsum(signal**2)))
    lag = np.arange(lags)
    scale = np.sqrt((energy[rows] - energy[lag]) * energy[rows - lag])
    alike: Floats = np.divide(products, scale, out=np.zeros(lags), where=scale > 0)
    return alike


def likeness(signal: Floats, lag: float) -> float:
    """How alike a signal and itself `lag` rows ago are: the `autocorrelation` there, 1 for a wave of that length.

    The highest at the three whole numbers of rows about `lag`.
    """
    near = round(lag)
    if len(signal) <= near + 2:
        return 0.0
    return max(_correlation(signal[rows:], signal[:-rows]) for rows in (near - 1, near, near + 1))


def _correlation(late: Floats, early: Floats) -> float:
    """Of two signals about zero, shape (rows,) each; 0 if one is nothing but zero."""
    scale = float((late @ late) * (early @ early)) ** 0.5
    return float(late @ early) / scale if scale else 0.0


def wavelength_in_rows(signal: Floats) -> tuple[float, float]:
    """The wavelength of a signal without trend, in rows, and the autocorrelation there; (nan, 0) if nothing comes back.

    It is the shortest lag of a high peak of the autocorrelation, of at least `FEWEST_ROWS` and at most a
    `FEWEST_WAVES`-th of the rows; the peaks at two, four, … times that lag tell it ever better.
    """
    rows = len(signal)
    longest = int(rows / FEWEST_WAVES)
    alike = autocorrelation(signal, min(int((LAST_LAG + DRIFT) * rows) + 3, rows))
    before, here, after = (alike[FEWEST_ROWS - 1 + k : longest + 1 + k] for k in (-1, 0, 1))
    peaks = FEWEST_ROWS - 1 + np.flatnonzero((here > 0) & (here >= before) & (here > after))
    peaks = peaks[np.minimum.accumulate(alike[: longest + 1])[peaks] < SHALLOW * alike[peaks]]
    if not len(peaks):
        return np.nan, 0.0
    first = int(peaks[alike[peaks] >= AS_HIGH * alike[peaks].max()][0])
    low, high = int((1 - FLANK) * first), min(int((1 + FLANK) * first), longest) + 1
    top = low + int(np.argmax(alike[low : high + 1]))
    length, times = _summit(alike, top), 2
    while times * length < LAST_LAG * rows:
        at, reach = round(times * length), max(int(DRIFT * length), 1)
        nearby = alike[at - reach : at + reach + 1]
        highest = int(np.argmax(nearby))
        if highest in (0, len(nearby) - 1) or nearby[highest] < alike[top] / 2:
            break
        length = _summit(alike, at - reach + highest) / times
        times *= 2
    return length, float(alike[top])


def _summit(values: Floats, top: int) -> float:
    """Where the parabola through the highest of some values and its neighbours is highest."""
    before, here, after = values[top - 1 : top + 2].tolist()
    bend = before - 2 * here + after
    return top + min(max((before - after) / (2 * bend), -0.5), 0.5) if bend < 0 else top


def mean_over(x: Floats, y: NDArray[Any], width: float) -> tuple[slice, NDArray[Any]]:
    """The mean of `y`, real or complex, over `width` around each x: which x have as much on both sides, and the means.

    Over one wavelength it keeps nothing of a wave and of its harmonics. x increases, shape (rows,).
    """
    if not len(x):
        return slice(0), y
    integral = np.zeros_like(y)
    np.cumsum((y[1:] + y[:-1]) * (x[1:] - x[:-1]), out=integral[1:])
    half = width / 2
    first = int(np.searchsorted(x, x[0] + half))
    inside = slice(first, max(first, int(np.searchsorted(x, x[-1] - half, side="right"))))
    at = x[inside]
    return inside, (np.interp(at + half, x, integral) - np.interp(at - half, x, integral)) / (2 * width)


def large_since(x: Floats, y: Floats, wavelength: float, least: float) -> float:
    """The x from which on the root mean square of a wave, over each wavelength, has been at least `least`."""
    inside, trend = mean_over(x, y, wavelength)
    at = x[inside]
    inside, square = mean_over(at, (y[inside] - trend) ** 2, wavelength)
    small = np.flatnonzero(square < least**2)
    return float(at[inside][small[-1]] + wavelength / 2 if len(small) else x[0])


@dataclass(frozen=True)
class LastWaves:
    """The last whole waves of a signal, less its mean over one wavelength.

    Parameters
    ----------
    wavelength
        In the unit of x.
    x, deviation, trend
        The rows of these waves: their place, the signal less its trend, and the trend, shape (rows,) each.
    count
        How many waves there are.
    """

    wavelength: float
    x: Floats
    deviation: Floats
    trend: Floats
    count: int

    @classmethod
    def of(cls, x: Floats, y: Floats, wavelength: float, most: int) -> "LastWaves":
        """Of a signal that increases in x; at most `most` of them, and perhaps none."""
        first = int(np.searchsorted(x, x[-1] - (most + 1 + ALMOST) * wavelength)) - 1
        x, y = x[max(first, 0) :], y[max(first, 0) :]
        inside, trend = mean_over(x, y, wavelength)
        if not len(trend):
            return cls(wavelength, trend, trend, trend, 0)
        at, deviation = x[inside], y[inside] - trend
        count = int((at[-1] - at[0]) / wavelength + ALMOST)
        whole = slice(int(np.searchsorted(at, at[-1] - count * wavelength)), None)
        return cls(wavelength, at[whole], deviation[whole], trend[whole], count)

    @cached_property
    def place(self) -> Floats:
        """Of each row, in waves from the start of the first one."""
        place: Floats = self.count - (self.x[-1] - self.x) / self.wavelength
        return place

    @cached_property
    def wave(self) -> Integers:
        """The wave that each row is of, from 0."""
        return np.minimum(self.place.astype(np.intp), self.count - 1)

    @cached_property
    def sizes(self) -> Floats:
        """The root mean square of each wave, shape (count,)."""
        rows = np.maximum(np.bincount(self.wave, minlength=self.count), 1)
        return np.sqrt(np.bincount(self.wave, self.deviation**2, self.count) / rows)

    def growth(self) -> tuple[float, float]:
        """Change of the logarithm of the size from wave to wave, by least squares, and twice its standard error."""
        middle = np.arange(self.count) - (self.count - 1) / 2
        square = float(middle @ middle)
        logarithm = np.log(np.maximum(self.sizes, 1e-6 * self.sizes.max()))
        rate = float(middle @ logarithm) / square
        residual = logarithm - logarithm.mean() - rate * middle
        return rate, 2 * float(residual @ residual / self.count / (square * (1 - 2 / self.count))) ** 0.5

    def height(self, deviation: Floats | None = None) -> float:
        """Between the highest and the lowest of the mean wave, of the deviation or of other values at the same rows.

        The rows of all waves in order of phase, each the mean of as many neighbours as half the waves: a wave may have
        steps, whose edges a mean over more of it would round.
        """
        values = self.deviation if deviation is None else deviation
        folded = values[np.argsort(self.place - self.wave, kind="stable")]
        neighbours = max(self.count // 2, 1)
        total = np.concatenate(([0.0], np.cumsum(np.concatenate((folded, folded[:neighbours])))))
        means = total[neighbours:] - total[:-neighbours]
        return float(means.max() - means.min()) / neighbours

    def starts(self) -> Floats:
        """Where the waves rise through zero without their harmonics, in the unit of x: one more than there are lengths.

        Of their trend only the polynomial is taken off: it keeps nothing of waves of two lengths in turn.

        A mean over half a wavelength keeps nothing of the even harmonics, one over a third of it nothing of each third.
        """
        x, smooth = self.x, self.deviation + without_trend(self.x, self.trend)
        for part in (2, 3):
            inside, smooth = mean_over(x, smooth, self.wavelength / part)
            x = x[inside]
        up = np.flatnonzero((smooth[:-1] < 0) & (smooth[1:] >= 0))
        starts: Floats = x[up] - smooth[up] / (smooth[up + 1] - smooth[up]) * (x[up + 1] - x[up])
        return starts

"""Waves at the end of a signal: their length, their similarity, their size and its growth.

A signal is an array of rows, real, or complex: the parts of a vector to two sides. Where a function takes `x`, the rows
may have any spacing; otherwise they are evenly spaced.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats

FEWEST_ROWS = 8  # rows in a wave: with fewer its steepest part lies between two rows
FEWEST_WAVES = 5.0  # waves in a window: four whole ones, and half a one at each end to determine their trend
DEGREE = 3  # of the polynomial taken as the trend before the wavelength is known: it hardly changes five waves
SHALLOW = 0.8  # of a peak's height: an autocorrelation that stays above it up to the peak is that of a noisy trend
AS_HIGH = 0.8  # of the highest peak: the first peak as high as this is at the wavelength, later ones at its multiples
FLANK = 0.15  # of a lag: noise may split the top of a peak into several within this distance
DRIFT = 0.1  # of a wavelength: a peak is searched for this far to both sides of a multiple of the wavelength
ALMOST = 0.02  # of a wave that may be missing from the last one, since its ends need not fall on rows
MOST_PLACES = 4.0  # for each row, where uneven rows are made even: most of them may be close together in one place
LAST_LAG = 0.6  # of the rows: at larger lags too few rows overlap
LEAST_SIZE = 1e-6  # of the largest wave: a smaller one counts as this, so that its logarithm is finite
KEPT = 64  # bases of polynomials kept, one for each number of rows: the cases of a study share a few of them

Integers = NDArray[np.intp]
Signal = NDArray[Any]


def without_trend(x: Floats, signal: Signal) -> Signal:
    """A signal less its least-squares polynomial of degree `DEGREE` in x, shape (rows,)."""
    return _without(_polynomials(2 * (x - x[0]) / (x[-1] - x[0]) - 1), signal)


def without_even_trend(signal: Signal) -> Signal:
    """A signal of evenly spaced rows less its least-squares polynomial of degree `DEGREE`, shape (rows,)."""
    return _without(_even_polynomials(len(signal)), signal)


def _without(basis: Floats, signal: Signal) -> Signal:
    """A signal less its projection on an orthonormal basis, shape (rows, k).

    It is that of the two parts of a complex signal: BLAS takes a product of as few complex numbers to several threads,
    whose start takes some hundred times as long.
    """
    parts = np.ascontiguousarray(signal).view(float).reshape(len(signal), -1)
    trend: Signal = (basis @ (basis.T @ parts)).view(signal.dtype).ravel()
    return signal - trend


def _polynomials(x: Floats) -> Floats:
    """An orthonormal basis of the polynomials up to degree `DEGREE`, shape (rows, DEGREE + 1); x is from −1 to 1."""
    return np.linalg.qr(np.polynomial.legendre.legvander(x, DEGREE)).Q


@lru_cache(KEPT)
def _even_polynomials(rows: int) -> Floats:
    return _polynomials(np.linspace(-1.0, 1.0, rows))


def even_rows(x: Floats) -> Floats:
    """Evenly spaced places from the first of increasing rows on, as far apart as most of these are.

    Rows that are even themselves stay what they are, whatever the last one, which need not be a step from the others.
    """
    span = x[-1] - x[0]
    spacing = max(float(np.median(np.diff(x))), span / (MOST_PLACES * len(x)))
    places: Floats = x[0] + spacing * np.arange(int(span / spacing + ALMOST) + 1)
    return places


def slope(x: Floats, y: Floats) -> float:
    """Slope of the least-squares line through the points (x, y), shape (rows,) each."""
    away = x - x.mean()
    return float(away @ y / (away @ away))


def autocorrelation(signal: Signal, lags: int) -> Floats:
    """Correlation of a signal, shape (rows,), with itself shifted by 0, 1, …, `lags` − 1 rows, shape (lags,).

    There are fewer lags than rows. Each correlation is normalized over the rows that overlap, so a wave that grows or
    dies has 1 at its wavelength, like one that lasts. That of a complex signal is the real part.
    """
    rows = len(signal)
    padded = 2 ** (rows + lags - 1).bit_length()  # numpy's FFT: scipy's is no faster and takes longer to import
    transform, inverse = (np.fft.fft, np.fft.ifft) if np.iscomplexobj(signal) else (np.fft.rfft, np.fft.irfft)
    spectrum = transform(signal, padded)
    products = inverse(spectrum.real**2 + spectrum.imag**2, padded)[:lags].real
    energy = np.concatenate(([0.0], np.cumsum(np.abs(signal) ** 2)))
    scale = np.sqrt((energy[-1] - energy[:lags]) * energy[: rows - lags : -1])
    alike: Floats = np.divide(products, scale, out=np.zeros(lags), where=scale > 0)
    return alike


def likeness(signal: Signal, lag: float) -> float:
    """The autocorrelation of a signal near a lag, in rows: 1 for a wave of that length.

    It is the highest of those at the three whole numbers nearest to `lag`.
    """
    near = round(lag)
    if len(signal) <= near + 2:
        return 0.0
    return max(_correlation(signal[rows:], signal[:-rows]) for rows in (near - 1, near, near + 1))


def _correlation(late: Signal, early: Signal) -> float:
    """The correlation of two signals of mean zero, shape (rows,) each; 0 if one of them is zero everywhere."""
    scale = (_product(late, late) * _product(early, early)) ** 0.5
    return _product(late, early) / scale if scale else 0.0


def _product(a: Signal, b: Signal) -> float:
    """The scalar product of two signals; of complex ones the real part."""
    return float(a @ b) if a.dtype.kind == "f" else float(a.real @ b.real + a.imag @ b.imag)


def wavelength_in_rows(signal: Signal) -> tuple[float, float]:
    """The wavelength of a signal without trend, in rows, and the autocorrelation there; (nan, 0) if there is no wave.

    The wavelength is the shortest lag at which the autocorrelation has a high peak, from `FEWEST_ROWS` to the number of
    rows over `FEWEST_WAVES`. The peaks at two, four, … times that lag then determine it ever more precisely.
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
    """The index, not whole, of the vertex of the parabola through the value at `top` and its two neighbours."""
    before, here, after = values[top - 1 : top + 2].tolist()
    bend = before - 2 * here + after
    return top + min(max((before - after) / (2 * bend), -0.5), 0.5) if bend < 0 else top


def mean_over(x: Floats, y: Signal, width: float) -> tuple[slice, Signal]:
    """The mean of `y`, real or complex, over the interval of a given width around each x.

    x increases, shape (rows,). Returned are the slice of those x whose whole interval has data, and the means there. A
    mean over one wavelength removes a wave and all its harmonics.
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


def large_since(x: Floats, y: Signal, wavelength: float, least: float) -> float:
    """The x from which on the root mean square of a wave over one wavelength is at least `least`."""
    at, square = _square(x, y, wavelength)
    small = np.flatnonzero(square < least**2)
    return float(at[small[-1]] + wavelength / 2 if len(small) else x[0])


def large_until(x: Floats, y: Signal, wavelength: float, least: float) -> float:
    """The x up to which, last of all, the root mean square of a wave over one wavelength is at least `least`."""
    at, square = _square(x, y, wavelength)
    large = np.flatnonzero(square >= least**2)
    if not len(large):
        return float(x[0])
    return float(at[large[-1]] - wavelength / 2 if large[-1] < len(at) - 1 else x[-1])


def _square(x: Floats, y: Signal, wavelength: float) -> tuple[Floats, Floats]:
    """Where there are data for it, the mean square of a wave about its trend, over one wavelength."""
    inside, trend = mean_over(x, y, wavelength)
    at = x[inside]
    inside, square = mean_over(at, np.abs(y[inside] - trend) ** 2, wavelength)
    return at[inside], square


@dataclass(frozen=True)
class LastWaves:
    """The last whole waves of a signal, about a trend that is its mean over one wavelength.

    Parameters
    ----------
    wavelength
        The wavelength, in the unit of x.
    x, deviation, trend
        At the rows of these waves: x, the signal less its trend, and the trend, shape (rows,) each.
    count
        The number of waves.
    """

    wavelength: float
    x: Floats
    deviation: Signal
    trend: Signal
    count: int

    @classmethod
    def of(cls, x: Floats, y: Signal, wavelength: float, most: int) -> "LastWaves":
        """The last waves of a signal y over increasing x: at most `most`, perhaps none."""
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
        """The position of each row, in wavelengths from the start of the first wave, shape (rows,)."""
        place: Floats = self.count - (self.x[-1] - self.x) / self.wavelength
        return place

    @cached_property
    def wave(self) -> Integers:
        """The number of the wave to which each row belongs, from 0, shape (rows,)."""
        return np.minimum(self.place.astype(np.intp), self.count - 1)

    @cached_property
    def sizes(self) -> Floats:
        """The root mean square of each wave, shape (count,)."""
        rows = np.maximum(np.bincount(self.wave, minlength=self.count), 1)
        return np.sqrt(np.bincount(self.wave, np.abs(self.deviation) ** 2, self.count) / rows)

    @cached_property
    def axis(self) -> complex:
        """The direction in which a complex signal swings most, of magnitude 1; 1 for a real one."""
        if not np.iscomplexobj(self.deviation):
            return 1.0
        return complex(np.exp(0.5j * np.angle(np.sum(self.deviation**2))))

    def along(self, axis: complex) -> "LastWaves":
        """The waves of the part of a complex signal in a direction, of magnitude 1; a real one as it is."""
        if not np.iscomplexobj(self.deviation):
            return self
        deviation, trend = ((part * np.conj(axis)).real for part in (self.deviation, self.trend))
        return LastWaves(self.wavelength, self.x, deviation, trend, self.count)

    def growth(self) -> tuple[float, float]:
        """The growth per wave of the logarithm of the size, by least squares, and twice its standard error."""
        middle = np.arange(self.count) - (self.count - 1) / 2
        square = float(middle @ middle)
        logarithm = np.log(np.maximum(self.sizes, LEAST_SIZE * self.sizes.max()))
        rate = float(middle @ logarithm) / square
        residual = logarithm - logarithm.mean() - rate * middle
        return rate, 2 * float(residual @ residual / self.count / (square * (1 - 2 / self.count))) ** 0.5

    def height(self, deviation: Floats | None = None) -> float:
        """The height from trough to crest of the mean wave, of the deviation or of other values at the same rows.

        The mean wave is made of the rows of all waves in order of phase, each replaced by the mean of as many
        neighbours as half the number of waves. A wave may have steps, whose edges more neighbours would round.
        """
        values = self.deviation if deviation is None else deviation
        folded = values[np.argsort(self.place - self.wave, kind="stable")]
        neighbours = max(self.count // 2, 1)
        total = np.concatenate(([0.0], np.cumsum(np.concatenate((folded, folded[:neighbours])))))
        means = total[neighbours:] - total[:-neighbours]
        return float(means.max() - means.min()) / neighbours

    def starts(self) -> Floats:
        """The x at which the waves, freed of their harmonics, rise through zero.

        A mean over half a wavelength removes the even harmonics, one over a third of it every third harmonic. Of the
        trend only its polynomial part is removed: the full trend would also remove the difference between waves of two
        alternating lengths.
        """
        x, smooth = self.x, self.deviation + without_trend(self.x, self.trend)
        for part in (2, 3):
            inside, smooth = mean_over(x, smooth, self.wavelength / part)
            x = x[inside]
        up = np.flatnonzero((smooth[:-1] < 0) & (smooth[1:] >= 0))
        starts: Floats = x[up] - smooth[up] / (smooth[up + 1] - smooth[up]) * (x[up + 1] - x[up])
        return starts

"""Finds all zeros of an analytic function in a strip, and proves by the argument principle that none is missing.

The function must be real on the real axis. Its zeros are then real or come in conjugate pairs, so only the upper half
plane is searched.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import inf, pi
from typing import Any, NamedTuple

import numpy as np

from ...arrays import Complexes, Floats

SAME = 1e-7  # zeros closer than this are the same zero: Newton's method finds a double zero only to about 1e-8
GRIDS = 4  # grids tried in turn, each twice as fine as the last
SEARCHES = 4  # searches beside the zeros found, before the next grid
BLOCK = 2**17  # points of a grid or contour evaluated at a time, which limits memory to some megabytes
NEWTON_STEPS = 60  # at most, for each start
CONVERGED = 1e-13  # a step of Newton's method this small ends it: the next would be rounding
BESIDE = 1e-3 * (1 + 1j)  # from a zero that was found to the start for another one near it
LARGEST_CHANGE = 0.5  # of the function along a piece of a contour, over its value: so its argument cannot jump by π

Function = Callable[[Complexes], tuple[Complexes, Complexes]]
"""Returns the function and its derivative, for arrays of any shape."""
OnGrid = Callable[[Floats, Floats], Complexes]
"""Returns the function at x + iy, shape (len(y), len(x)); it may have further zeros."""


Right = Callable[[float], float]
"""Returns a bound on Re ν of the zeros whose Im ν is above the argument."""


class Strip(NamedTuple):
    """The strip left < Re ν < right, |Im ν| < top."""

    left: float
    right: float
    top: float


def find_zeros(
    function: Function,
    on_grid: OnGrid,
    strip: Strip,
    margin: float,
    spacing: float,
    right: Right | None = None,
    smooth: float = inf,
) -> Complexes:
    """Find all zeros in a strip.

    The modulus of an analytic function has minima only at zeros, so Newton's method starts from the minima on a grid.
    The argument principle then tells how many zeros are missing. These are searched for beside those found, then on a
    finer grid. Grid and contour are evaluated in pieces, so memory is needed for the zeros only.

    Parameters
    ----------
    function, on_grid
        The function.
    strip
        The strip. No zero may lie on its upper and right edges.
    margin
        The left edge of the contour may be moved this far to the left to keep clear of zeros.
    spacing
        Spacing of the first grid.
    right
        A bound on Re ν of the zeros above a given Im ν, where that is less than the right edge of the strip.
    smooth
        The abscissa > 0 right of which the function changes more slowly. The spacing of the grid is doubled right of
        twice this abscissa, doubled again right of four times, and so on.

    Returns
    -------
    zeros
        The zeros, real or in the upper half plane; a multiple zero is repeated. Some may lie in the margin.

    Raises
    ------
    ArithmeticError
        If zeros are missing in the end.
    """
    wide = strip._replace(left=strip.left - margin)
    for k in range(GRIDS):
        starts = minima(on_grid, wide, spacing / 2**k, right or (lambda _: strip.right), smooth)
        zeros = distinct(np.concatenate([newton(function, piece) for piece in starts]))
        for _ in range(SEARCHES):
            counted = strip._replace(left=clear_abscissa(zeros, wide.left, strip.left))
            found, expected = number(zeros, counted.left), count(function, counted, spacing)
            if found == expected:
                return zeros[zeros.real > counted.left]
            if found > expected:
                break
            zeros = np.concatenate([zeros, beside(function, zeros)])
    raise ArithmeticError(f"{found} were found, but by the argument principle there are {expected}")


def number(zeros: Complexes, left: float) -> int:
    """The number of zeros right of `left`, counting both of each pair."""
    return int(np.where(zeros.imag > 0, 2, 1)[zeros.real > left].sum())


def clear_abscissa(zeros: Complexes, lowest: float, highest: float) -> float:
    """The middle of the widest gap, between two bounds, in the real parts of the zeros."""
    within = zeros.real[(zeros.real > lowest) & (zeros.real < highest)]
    marks = np.sort(np.concatenate([[lowest, highest], within]))
    widest = np.argmax(np.diff(marks))
    return float(marks[widest] + marks[widest + 1]) / 2


def count(function: Function, strip: Strip, spacing: float) -> int:
    """The number of zeros in a strip by the argument principle, on a contour sampled at `spacing` and as needed.

    Raises
    ------
    ArithmeticError
        If a zero lies on the contour.
    """
    left, right, top = strip
    corners = [complex(right), right + 1j * top, left + 1j * top, complex(left)]
    turn = 0.0
    for a, b in pairwise(corners):
        samples = int(abs(b - a) / spacing) + 1
        for first in range(0, samples, BLOCK):
            part = np.arange(first, min(first + BLOCK, samples) + 1) / samples
            turn += turning(function, np.asarray(a + (b - a) * part, complex))
    return round(turn / pi)


def turning(function: Function, at: Complexes) -> float:
    """The growth of the argument of a function along a line through the samples `at`; more samples are added as needed.

    Raises
    ------
    ArithmeticError
        If a zero lies on the line.
    """
    value, slope = function(at)
    while True:
        length, size = abs(np.diff(at)), abs(value)
        change = length * np.maximum(abs(slope[:-1]), abs(slope[1:]))
        coarse = np.flatnonzero(change > LARGEST_CHANGE * np.minimum(size[:-1], size[1:]))
        if not len(coarse):
            return float(np.angle(value[1:] / value[:-1]).sum())
        if length[coarse].min() < SAME**2:
            raise ArithmeticError(f"one lies on the edge of the region searched, between {at[0]:.6g} and {at[-1]:.6g}")
        between = (at[coarse] + at[coarse + 1]) / 2
        new_value, new_slope = function(between)
        at = np.insert(at, coarse + 1, between)
        value = np.insert(value, coarse + 1, new_value)
        slope = np.insert(slope, coarse + 1, new_slope)


def minima(on_grid: OnGrid, strip: Strip, spacing: float, right: Right, smooth: float) -> Iterator[Complexes]:
    """The points of a grid over the upper half of a strip at which the modulus is least among nine, piece by piece."""
    left, end = strip.left, min(2 * smooth, strip.right)
    while left < strip.right:
        y = 0.0
        while y < strip.top and left < right(y):
            x = np.arange(left - 2 * spacing, min(end, right(y)) + 2 * spacing, spacing)
            above = spacing * np.arange(-1.5, BLOCK // len(x) + 2)  # symmetric about the real axis for y = 0
            yield least_among_nine(x, y + above[above < strip.top - y + 3 * spacing], on_grid)
            y += above[-1] - spacing / 2
        left, end, spacing = end, min(2 * end, strip.right), 2 * spacing


def least_among_nine(x: Floats, y: Floats, on_grid: OnGrid) -> Complexes:
    """The inner points of a grid at which the modulus is least among their neighbours."""
    size = abs(on_grid(x, y))
    inner = size[1:-1, 1:-1]
    least = np.ones_like(inner, bool)
    for i, j in np.ndindex(3, 3):
        least &= inner <= size[i : i + inner.shape[0], j : j + inner.shape[1]]
    row, column = np.nonzero(least)
    found: Complexes = x[column + 1] + 1j * y[row + 1]
    return found


def beside(function: Function, zeros: Complexes) -> Complexes:
    """Further zeros near the given ones: each of these is divided out in turn, and Newton's method starts beside it.

    A multiple zero is found again.
    """
    found = newton(function, zeros + BESIDE, zeros)
    multiple = found[abs(found - zeros) < SAME]
    others = distinct(found)
    far = neighbours(zeros).query(plane(others))[0] > SAME
    return np.concatenate([multiple, others[far]])


def distinct(points: Complexes) -> Complexes:
    """`points` without nan, and without repetitions of the same zero."""
    points = points[~np.isnan(points)]
    return np.delete(points, neighbours(points).query_pairs(SAME, output_type="ndarray")[:, 1])


def neighbours(points: Complexes) -> Any:
    """The tree in which the neighbours of points of the complex plane are found."""
    from scipy.spatial import KDTree  # imported here, as it takes long to load and a critical ηΠ needs no zeros

    return KDTree(plane(points))


def plane(points: Complexes) -> Floats:
    """Complex numbers as points of the plane, shape (k, 2)."""
    return np.column_stack([points.real, points.imag])


def newton(function: Function, starts: Complexes, divided_out: Complexes | None = None) -> Complexes:
    """The limits of Newton's method, real or in the upper half plane; nan where it does not converge.

    With `divided_out`, a zero for each start, that zero and its conjugate are divided out of the function.
    """
    zeros, moved = starts.copy(), np.full(len(starts), np.inf)
    active = np.arange(len(zeros))
    with np.errstate(all="ignore"):  # a start may diverge
        for _ in range(NEWTON_STEPS):
            at = zeros[active]
            value, slope = function(at)
            if divided_out is not None:
                zero = divided_out[active]
                slope = slope - value / (at - zero) - np.where(zero.imag > 0, value / (at - zero.conj()), 0)
            step = value / slope
            zeros[active] = at - step
            moved[active] = abs(step)
            active = active[moved[active] > CONVERGED * (1 + abs(at))]
            if not len(active):
                break
    zeros[~(moved < SAME)] = np.nan
    return np.where(abs(zeros.imag) < SAME, zeros.real, zeros.real + 1j * abs(zeros.imag))

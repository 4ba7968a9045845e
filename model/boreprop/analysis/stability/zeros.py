"""All zeros of an analytic function in a half strip, with a proof that none is missing.

For functions that are real on the real axis: zeros are real or come in pairs, and the upper half plane is enough.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import inf, pi
from typing import NamedTuple

import numpy as np
from scipy.spatial import KDTree

from ...arrays import Complexes, Floats

SAME = 1e-7  # zeros closer than this are one
GRIDS = 4  # tried in turn, each twice as fine as the one before
SEARCHES = 4  # beside the zeros that are known
BLOCK = 2**17  # points of a grid or a contour at a time
NEWTON_STEPS = 60
CONVERGED = 1e-13  # step of Newton's method after which another would find rounding only
BESIDE = 1e-3 * (1 + 1j)  # from a known zero to the start for the next
STEADY = 0.5  # largest change of the function along a piece of a contour, over its value

Function = Callable[[Complexes], tuple[Complexes, Complexes]]
"""A function and its derivative, on arrays of any shape."""
OnGrid = Callable[[Floats, Floats], Complexes]
"""The function at x + iy, shape (len(y), len(x)); extra zeros do no harm."""


Right = Callable[[float], float]
"""A bound on Re ν of the zeros with Im ν above the argument."""


class Strip(NamedTuple):
    """left < Re ν < right, |Im ν| < top."""

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
    """All zeros in a strip.

    On a grid the modulus has minima next to zeros only. Newton's method polishes them, and the argument principle tells
    how many are missing: those are looked for beside the ones found, then on a finer grid. The grid and the contour are
    gone through in pieces: only the zeros themselves need memory.

    Parameters
    ----------
    function, on_grid
        The function.
    strip
        With no zero on its upper and right edges.
    margin
        How far beyond the left edge of the strip the count may go, to keep clear of zeros.
    spacing
        Of the first grid.
    right
        A bound on Re ν of the zeros above a given Im ν, if that is less than the strip's further up.
    smooth
        The abscissa > 0 right of which the function changes more slowly: the grid is twice as coarse right of its
        double, and so on.

    Returns
    -------
    zeros
        Real or in the upper half plane, perhaps some of the margin too, a multiple zero as often as it is one.

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
            missing = count(function, counted, spacing) - number(zeros, counted.left)
            if missing == 0:
                return zeros[zeros.real > counted.left]
            if missing < 0:
                break
            zeros = np.concatenate([zeros, beside(function, zeros)])
    raise ArithmeticError(f"{missing} zeros more were counted in {counted} than found")


def number(zeros: Complexes, left: float) -> int:
    """How many zeros lie right of `left`, both of each pair."""
    return int(np.where(zeros.imag > 0, 2, 1)[zeros.real > left].sum())


def clear_abscissa(zeros: Complexes, lowest: float, highest: float) -> float:
    """The middle of the widest gap between real parts."""
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
    """By how much the argument of a function grows along a line through the samples `at`, and more as needed.

    Raises
    ------
    ArithmeticError
        If a zero lies on the line.
    """
    value, slope = function(at)
    while True:
        length, size = abs(np.diff(at)), abs(value)
        change = length * np.maximum(abs(slope[:-1]), abs(slope[1:]))
        coarse = np.flatnonzero(change > STEADY * np.minimum(size[:-1], size[1:]))
        if not len(coarse):
            return float(np.angle(value[1:] / value[:-1]).sum())
        if length[coarse].min() < SAME**2:
            raise ArithmeticError(f"a zero lies on the edge of the region, between {at[0]} and {at[-1]}")
        between = (at[coarse] + at[coarse + 1]) / 2
        new_value, new_slope = function(between)
        at = np.insert(at, coarse + 1, between)
        value = np.insert(value, coarse + 1, new_value)
        slope = np.insert(slope, coarse + 1, new_slope)


def minima(on_grid: OnGrid, strip: Strip, spacing: float, right: Right, smooth: float) -> Iterator[Complexes]:
    """The points of a grid over the upper half of a strip at which the modulus is least among nine, in pieces."""
    left, end = strip.left, min(2 * smooth, strip.right)
    while left < strip.right:
        y = 0.0
        while y < strip.top and left < right(y):
            x = np.arange(left - 2 * spacing, min(end, right(y)) + 2 * spacing, spacing)
            rows = spacing * np.arange(-1.5, BLOCK // len(x) + 2)  # about y, and so symmetric about the real axis
            yield least_among_nine(x, y + rows[rows < strip.top - y + 3 * spacing], on_grid)
            y += rows[-1] - spacing / 2
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


def beside(function: Function, known: Complexes) -> Complexes:
    """Zeros beside the `known` ones: each is divided out in turn, and Newton's method goes on from there.

    A multiple zero is found again.
    """
    found = newton(function, known + BESIDE, known)
    multiple = found[abs(found - known) < SAME]
    others = distinct(found)
    far = KDTree(plane(known)).query(plane(others))[0] > SAME
    return np.concatenate([multiple, others[far]])


def distinct(points: Complexes) -> Complexes:
    """`points` without nan, and one of those that are the same zero."""
    points = points[~np.isnan(points)]
    return np.delete(points, KDTree(plane(points)).query_pairs(SAME, output_type="ndarray")[:, 1])


def plane(points: Complexes) -> Floats:
    """Complex numbers as points of the plane, shape (k, 2)."""
    return np.column_stack([points.real, points.imag])


def newton(function: Function, starts: Complexes, divided_out: Complexes | None = None) -> Complexes:
    """Where Newton's method ends, real or in the upper half plane; nan where it does not converge.

    With `divided_out`, one known zero for each start, that zero and its conjugate are divided out of the function.
    """
    zeros, moved = starts.copy(), np.full(len(starts), np.inf)
    active = np.arange(len(zeros))
    with np.errstate(all="ignore"):  # a start that runs away
        for _ in range(NEWTON_STEPS):
            at = zeros[active]
            value, slope = function(at)
            if divided_out is not None:
                known = divided_out[active]
                slope = slope - value / (at - known) - np.where(known.imag > 0, value / (at - known.conj()), 0)
            step = value / slope
            zeros[active] = at - step
            moved[active] = abs(step)
            active = active[moved[active] > CONVERGED * (1 + abs(at))]
            if not len(active):
                break
    zeros[~(moved < SAME)] = np.nan
    return np.where(abs(zeros.imag) < SAME, zeros.real, zeros.real + 1j * abs(zeros.imag))

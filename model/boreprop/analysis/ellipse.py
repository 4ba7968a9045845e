"""Finds whether the waves of a hole in space lie in a plane or wind, and in what ellipse.

The axis of the hole is looked at from behind, along its own trend, in a frame that does not twist. There, each wave is
an ellipse: the sum of a circle drawn clockwise, right-handed, and one drawn the other way. If one of the two is larger,
the hole winds to its side. If they are as large as each other, the ellipse is a line, and the wave is a planar ripple.
"""

from dataclasses import dataclass
from enum import StrEnum
from math import atan2, expm1, inf, nan, pi, sqrt
from typing import NamedTuple

import numpy as np

from ..arrays import Complexes, Floats
from .hole_in_space import NEARLY_VERTICAL, inclination_of, sides
from .search import AT_THE_END
from .space import untwisted
from .waves import even_rows, mean_over, slope

NARROW = 0.1  # minor over major axis: a narrower ellipse counts as a line
WIDE = 0.2  # the same: where all of the last waves are wider, and wind to one side, that is certain
HARMONICS = 16  # of a wave that are looked at: what repeats may be a pattern of several turns
CERTAIN = 4.0  # standard errors by which the hole must wind to one side: with 3 noise makes one plane in 800 wind
FOLLOWED = 20  # waves at the end: in none may it wind to the other side, and from their differences comes the error
SLOW = 0.02  # of a turn in a wave: a phase that drifts faster than this comes from irregular waves
HALF = 0.5  # of their size at the end: smaller waves count as something else


class Shape(StrEnum):
    """How a hole in space goes through its last waves."""

    PLANE = "plane"
    RIGHT = "right"  # it winds clockwise, looking down the hole
    LEFT = "left"
    UNCLEAR = "unclear"  # neither in a plane nor, for certain, to one side


@dataclass(frozen=True)
class Ellipse:
    """The ellipse in which the axis of a hole goes through its last four waves, seen along the hole.

    Parameters
    ----------
    shape
        Whether it winds, and to which side.
    major, minor
        Semi-axes, m: those of the ellipse with the same second moments, in the mean over the waves.
    direction
        Of the major axis, rad, from 0 to π, looking down the hole: from the high side to the right; from north over
        east if `from_north`.
    from_north
        Whether the hole is nearly vertical, within 3°.
    since
        The drilled length from which on it has wound to this side in an ellipse that is not a line, m; nan if it does
        not wind to one side.
    pitch
        Drilled length of a turn about the trend, m; nan likewise.
    """

    shape: Shape
    major: float
    minor: float
    direction: float
    from_north: bool
    since: float
    pitch: float


class Sideways(NamedTuple):
    """How far a hole is off its own trend, seen along the trend, in a frame that does not twist.

    `length`, m, shape (rows,), and `away`, the parts to both sides, m, complex, shape (rows,); `frame` as `untwisted`
    gives it, and the direction of the trend, `forward`, shape (rows, 3) each.
    """

    length: Floats
    away: Complexes
    frame: Complexes
    forward: Floats


def sideways(length: Floats, position: Floats, wavelength: float) -> Sideways | None:
    """How far a hole is off its mean over a wavelength, m; None if there are too few rows.

    The length increases, m, shape (rows,); the position is to north, east and down, m, shape (rows, 3).
    """
    even = even_rows(length)
    position = np.column_stack([np.interp(even, length, coordinate) for coordinate in position.T])
    means = [mean_over(even, coordinate, wavelength) for coordinate in position.T]
    inside, trend = means[0][0], np.column_stack([mean for _, mean in means])
    if len(trend) < 2:
        return None
    forward = np.gradient(trend, axis=0)
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    frame = untwisted(forward)
    away = np.sum((position[inside] - trend) * frame, axis=1)
    return Sideways(even[inside], away, frame, forward)


def ellipse_of(hole: Sideways, wavelength: float) -> Ellipse | None:
    """The ellipse of the last waves of a hole, which are so long, m; None if there are too few."""
    spacing = (hole.length[-1] - hole.length[0]) / (len(hole.length) - 1)
    within, offset = mean_over(hole.length, hole.away, wavelength)
    x = hole.length[within]
    if not len(x):
        return None
    away = hole.away - np.interp(hole.length, x, offset)  # where the hole turns, its trend is off the chord of a wave
    right, left, line = np.zeros(len(x)), np.zeros(len(x)), np.zeros(len(x), complex)
    circles: list[tuple[Complexes, Complexes]] = []
    for k in range(1, min(HARMONICS, int(wavelength / spacing / 2)) + 1):
        turn = np.exp(2j * pi * k / wavelength * hole.length)
        clockwise, other = (mean_over(hole.length, away * way, wavelength)[1] for way in (turn.conj(), turn))
        circles.append((clockwise, other))
        right, left, line = right + abs(clockwise) ** 2, left + abs(other) ** 2, line + clockwise * other
    waves = x[-1] - wavelength * np.arange(FOLLOWED)[::-1]
    waves = waves[waves >= x[0]]
    major, minor = (np.sqrt(np.maximum(right + left + sign * 2 * abs(line), 0.0)) for sign in (1, -1))
    axes = [np.interp(waves, x, axis)[-AT_THE_END:].mean() for axis in (major, minor)]
    right, left = np.sqrt(right), np.sqrt(left)
    winding = np.divide(right - left, right + left, out=np.zeros_like(right), where=right + left > 0)
    small = np.flatnonzero(np.interp(waves, x, major) < HALF * axes[0])
    first = min(int(small[-1]) + 1 if len(small) else 0, max(len(waves) - AT_THE_END, 0))
    last = np.interp(waves[first:], x, winding)
    shape, winds = _shape(axes[1] / axes[0], last), float(last[-AT_THE_END:].mean())
    since, pitch = nan, nan
    if shape in (Shape.RIGHT, Shape.LEFT):
        circle, both = (circles[0][0], right) if shape is Shape.RIGHT else (circles[0][1].conj(), left)
        pitch = _pitch(x[x >= waves[first]], circle[x >= waves[first]], both[x >= waves[first]], wavelength)
        less = np.flatnonzero(winding * np.sign(winds) < min(NARROW, abs(winds) / 2))
        since = float(x[less[-1]] if len(less) else x[0])
    mean_line = np.sum(line[np.searchsorted(x, waves[-AT_THE_END:][0]) :])
    direction, end = np.exp(0.5j * np.angle(mean_line)), within.stop - 1
    side, from_north = _side((np.conj(direction) * hole.frame[end]).real, hole.forward[end])
    return Ellipse(shape, float(axes[0]), float(axes[1]), side, from_north, since, pitch)


def _pitch(x: Floats, circle: Complexes, size: Floats, wavelength: float) -> float:
    """The drilled length of a turn, m, by how the phase of the circle drifts, of which all that winds has the size."""
    if len(x) < 2 or np.mean(abs(circle) ** 2) < np.mean(size**2) / 2:
        return wavelength  # most of it is a pattern of several turns
    drift = slope(x, np.unwrap(np.angle(circle))) * wavelength / (2 * pi)
    return wavelength / (1 + drift) if abs(drift) < SLOW else wavelength


def _shape(narrow: float, winding: Floats) -> Shape:
    """The shape of waves, from minor over major axis of the last four and by how much each of the last ones winds."""
    if narrow < NARROW:
        return Shape.PLANE
    late, changes = winding[-AT_THE_END:], np.diff(winding)
    error = np.sqrt(np.mean(changes**2) / 2 / len(late)) if len(changes) else inf
    other = -min(winding * np.sign(late.mean()))  # by how much it winds to the other side, at most
    certain = abs(late.mean()) >= errors_from(len(changes)) * error or (min(abs(late)) > WIDE and other < 0.0)
    if abs(late.mean()) < NARROW / 2 or not certain or other > NARROW:
        return Shape.UNCLEAR
    return Shape.RIGHT if late.mean() > 0 else Shape.LEFT


def errors_from(count: int) -> float:
    """As many standard errors, themselves from so many values, as are as certain as `CERTAIN` from many.

    A quantile of Student's distribution by the formula of Wallace (1959), right to 10 % from three values on.
    """
    if not count:
        return inf
    normal = CERTAIN * (8 * count + 3) / (8 * count + 1)
    return sqrt(count * expm1(normal**2 / count))


def _side(across: Floats, forward: Floats) -> tuple[float, bool]:
    """The side to which a vector across the hole is, from 0 to π, and whether it counts from north."""
    if inclination_of(forward) < NEARLY_VERTICAL:
        return atan2(across[1], across[0]) % pi, True
    high, right = sides(forward)
    return atan2(across @ right, across @ high) % pi, False

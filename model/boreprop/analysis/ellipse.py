"""Finds whether the waves of a hole in space lie in a plane or wind, and in what ellipse.

The axis of the hole is looked at from behind, along its own trend, in a frame that does not twist. There, each wave is
an ellipse: the sum of a circle drawn clockwise, right-handed, and one drawn the other way. If one of the two is larger,
the hole winds to its side. If they are as large as each other, the ellipse is a line, and the wave is a planar ripple.
"""

from dataclasses import dataclass
from enum import StrEnum
from math import atan2, hypot, inf, nan, pi, radians

import numpy as np

from ..arrays import Floats
from .search import AT_THE_END
from .space import untwisted
from .waves import mean_over

NARROW = 0.1  # minor over major axis: a narrower ellipse counts as a line
CERTAIN = 3.0  # standard errors by which the hole must wind to one side
SCATTER_OF = 8  # waves at the end from whose differences the standard error is determined
HALF = 0.5  # of what it is at the end: a hole counts as winding since it has wound by this
NEARLY_VERTICAL = radians(3.0)  # up to here the high side says little, and directions count from north


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
        Semi-axes, m: the mean over the waves.
    direction
        Of the major axis, rad, from 0 to π, looking down the hole: from the high side to the right; from north over
        east if `from_north`.
    from_north
        Whether the hole is nearly vertical, within 3°.
    since
        The drilled length from which on it has wound, minor over major axis, at least half as much as at the end, m;
        nan if it does not wind to one side.
    """

    shape: Shape
    major: float
    minor: float
    direction: float
    from_north: bool
    since: float


def ellipse_of(length: Floats, position: Floats, wavelength: float) -> Ellipse | None:
    """The ellipse of the last waves of a hole; None if the rows are too few.

    Parameters
    ----------
    length
        Drilled length, m, increasing, shape (rows,).
    position
        Of the hole's axis, to north, east and down, m, shape (rows, 3).
    wavelength
        Of the waves, m.
    """
    means = [mean_over(length, coordinate, wavelength) for coordinate in position.T]
    inside, trend = means[0][0], np.column_stack([mean for _, mean in means])
    if len(trend) < 2:
        return None
    forward = np.gradient(trend, axis=0)
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    frame = untwisted(forward)
    x, away = length[inside], np.sum((position[inside] - trend) * frame, axis=1)
    turn = np.exp(2j * pi / wavelength * x)
    within, right = mean_over(x, away * turn.conj(), wavelength)
    _, left = mean_over(x, away * turn, wavelength)
    if not len(right):
        return None
    x = x[within]
    waves = x[-1] - wavelength * np.arange(SCATTER_OF)[::-1]
    waves = waves[waves >= x[0]]
    long, short = abs(right) + abs(left), abs(right) - abs(left)
    axes = np.array([np.interp(waves, x, axis)[-AT_THE_END:].mean() for axis in (long, abs(short))])
    winding = np.divide(short, long, out=np.zeros_like(long), where=long > 0)
    winds, shape = _shape(np.interp(waves, x, winding))
    since = nan
    if shape in (Shape.RIGHT, Shape.LEFT):
        less = np.flatnonzero(winding * np.sign(winds) < HALF * abs(winds))
        since = float(x[less[-1]] if len(less) else x[0])
    last = slice(np.searchsorted(x, waves[-AT_THE_END:][0]), None)
    direction = np.exp(0.5j * np.angle(np.sum(right[last] * left[last])))
    end = within.stop - 1
    side, from_north = _side((np.conj(direction) * frame[end]).real, forward[end])
    return Ellipse(shape, float(axes[0]), float(axes[1]), side, from_north, since)


def _shape(winding: Floats) -> tuple[float, Shape]:
    """By how much the last waves wind, and in words; from minor over major axis of waves, positive to the right."""
    late = winding[-AT_THE_END:]
    mean = float(late.mean())
    if np.abs(late).mean() < NARROW:
        return mean, Shape.PLANE
    error = float(np.sqrt(np.mean(np.diff(winding) ** 2) / 2 / len(late))) if len(winding) > 1 else inf
    if abs(mean) < CERTAIN * error:
        return mean, Shape.UNCLEAR
    return mean, Shape.RIGHT if mean > 0 else Shape.LEFT


def _side(across: Floats, forward: Floats) -> tuple[float, bool]:
    """The side to which a vector across the hole is, from 0 to π, and whether it counts from north."""
    north, east, down = forward.tolist()
    sideways = hypot(north, east)
    if atan2(sideways, down) < NEARLY_VERTICAL:
        return atan2(across[1], across[0]) % pi, True
    high = np.array([north * down, east * down, -(sideways**2)]) / sideways
    return atan2(across @ np.cross(forward, high), across @ high) % pi, False

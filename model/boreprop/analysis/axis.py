"""The ripple of a hole's axis: how far it lies from its own smooth trend."""

import numpy as np
from numpy.typing import NDArray

AXIS_POINTS = 40  # samples of the axis in one width of the Gaussian
AXIS_REACH = 4.0  # widths at which the Gaussian is cut off: it has fallen to e⁻⁸ there


def axis_ripple(
    length: NDArray[np.float64], position: NDArray[np.float64], width: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How far the axis of a hole lies from its smooth trend, to the high side.

    The trend is a weighted mean over the neighbourhood. The weights are a Gaussian times a parabola, chosen so that the
    trend of a straight or evenly curved hole is the hole itself. A wave of 1.4 widths leaves less than 10⁻³ of its
    amplitude in the trend, a wave of 1.8 widths less than 2 %.

    Parameters
    ----------
    length
        Lengths along the hole, m, increasing, shape (N,).
    position
        Positions of the axis in the vertical plane, horizontal and down, m, shape (N, 2).
    width
        Standard deviation of the Gaussian, m: `BottomHoleAssembly.half_length` suits all ripples of a BHA.

    Returns
    -------
    length, ripple
        Lengths at whole multiples of a fortieth of the width, and the ripple there, m, shape (k,) each. They are those
        from which the hole goes on for `AXIS_REACH` widths to both sides; there may be none.
    """
    at, away, forward = axis_away(length, position, width)
    return at, away[:, 0] * forward[:, 1] - away[:, 1] * forward[:, 0]


def axis_away(
    length: NDArray[np.float64], position: NDArray[np.float64], width: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """How far the axis of a hole lies from its smooth trend, as a vector, in any number d of dimensions.

    Parameters
    ----------
    length, width
        As in `axis_ripple`.
    position
        Positions of the axis, m, shape (N, d).

    Returns
    -------
    length, away, forward
        Lengths as in `axis_ripple`, (k,), the way from the trend to the axis there, m, (k, d), and the direction of the
        trend, a unit vector, (k, d).
    """
    spacing = width / AXIS_POINTS
    first, last = np.ceil(length[0] / spacing), np.floor(length[-1] / spacing)
    at = spacing * np.arange(first, last + 1)
    u = np.arange(-AXIS_REACH * AXIS_POINTS, AXIS_REACH * AXIS_POINTS + 1) / AXIS_POINTS
    if len(at) < len(u):
        return np.empty(0), np.empty((0, position.shape[1])), np.empty((0, position.shape[1]))
    gaussian = np.exp(-(u**2) / 2)
    weights = gaussian * (np.sum(gaussian * u**4) - np.sum(gaussian * u**2) * u**2)  # now Σ weights·u² = 0
    weights /= weights.sum()
    axis = np.column_stack([np.interp(at, length, coordinate) for coordinate in position.T])
    trend = np.column_stack([np.convolve(coordinate, weights, mode="valid") for coordinate in axis.T])
    within = slice(len(u) // 2, len(at) - len(u) // 2)
    away = axis[within] - trend
    forward = np.gradient(trend, axis=0) if len(trend) > 1 else axis[[-1]] - axis[[0]]
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    return at[within], away, forward

"""The course of a hole in space: its direction in a frame that does not twist, and to which sides forces are."""

from math import pi

import numpy as np
from numpy.typing import NDArray

from ..arrays import Complexes, Floats
from ..run.trajectory import Trajectory
from .hole_in_space import directions


def direction_of(run: Trajectory) -> Complexes:
    """The direction of the hole of a run in space, rad, see `developed`, shape (rows,)."""
    return developed(directions(run["borehole_inclination"], run["borehole_azimuth"]))


def sides_of(run: Trajectory) -> NDArray[np.int_]:
    """To which side each non-ideal stabilizer is pushed and the saturated bit is tilted, shape (rows, n).

    Up, right, down and left are 1 to 4; 0 is no contact and no saturation.
    """
    vectors = [("stabilizer_contact", "stabilizer_force", f"[{i}]") for i in range(1, run.n)]
    vectors.append(("bit_tilt_saturation", "bit_tilt", ""))
    quarters = []
    for there, vector, i in vectors:
        side = np.arctan2(run[f"{vector}_right{i}"], run[f"{vector}_high{i}"]) / (pi / 2)
        quarters.append(np.where(run[there + i] != 0, np.round(side) % 4 + 1, 0))
    return np.column_stack(quarters).astype(int)


def untwisted(tangent: Floats) -> Complexes:
    """A frame along a curve that does not twist: e₂ + ie₃, shape (rows, 3).

    The tangents of the curve are to north, east and down, shape (rows, 3). e₃ is to the right of e₂, looking along the
    curve. A vector of the frame's plane has, as a scalar product with it, its parts to e₂ and e₃, as a complex number.
    """
    sideways = tangent[:, :2] @ np.array([1.0, 1.0j])
    towards = np.column_stack((tangent[:, :2] / (1.0 + tangent[:, 2:]), np.ones(len(tangent))))
    frame = np.array([1.0, 1.0j, 0.0]) - sideways[:, None] * towards  # north and east, tilted with the curve
    before, after = tangent[:-1], tangent[1:]
    carried = frame[:-1].real
    cosine = np.sum(before * after, axis=1, keepdims=True)
    carried = carried - np.sum(carried * after, axis=1, keepdims=True) / (1.0 + cosine) * (before + after)
    twist = np.concatenate(([0.0], np.cumsum(np.angle(np.sum(carried * frame[1:], axis=1)))))
    untwisted: Complexes = frame * np.exp(-1j * twist)[:, None]
    return untwisted


def developed(tangent: Floats) -> Complexes:
    """The turns of a curve, rad, added up in its untwisted frame: parts to e₂ and e₃, shape (rows,), from 0.

    On a planar curve it is the inclination, but for a constant and the side to which it is.
    """
    frame = untwisted(tangent)[:-1]
    before, after = tangent[:-1], tangent[1:]
    cosine = np.sum(before * after, axis=1)
    across = np.sum(after * frame, axis=1)
    sine = np.abs(across)
    angle = np.arctan2(sine, cosine)
    turns = across * np.divide(angle, sine, out=np.ones_like(sine), where=sine > 0)
    return np.concatenate(([0.0], np.cumsum(turns)))

"""Geometry of a run: arrays in, arrays out. Metres and radians, float64, one row per row of the trajectory.

The vertical plane has x to the side of growing inclination and z down, with its origin where the bit starts the run.

The bit frame has its origin at the bit and its axis through the centre of the hole at the last stabilizer: at the
inclination averaged over the BHA. s grows up the hole; lateral offsets are positive to the high side, as in the model.
The model is linear in lateral offsets, so a frame turned by the small angle between the bit's axis and the mean axis
differs by that angle times s.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boreprop.case.case import Case
from boreprop.core.beam import Beam
from boreprop.core.survey import Survey
from boreprop.core.system import scale
from boreprop.errors import InputError
from boreprop.run.completion import path
from boreprop.run.trajectory import Trajectory

Array = NDArray[np.float64]

POINTS_ALONG_BHA = 48
POINTS_OF_PLAN = 1000
REACH_ABOVE_BHA = 1.15  # how far up the hole is drawn in the bit frame, over the length of the BHA
AHEAD = 0.2  # how far ahead of the bit the directions of bit and hole are drawn, over the length of the BHA


@dataclass(frozen=True)
class HolePath:
    """The hole axis in the vertical plane, straight between points."""

    length: Array  # (N,), increasing; drilled length, negative in the existing hole
    position: Array  # (N, 2), x and z

    def at(self, length: Array) -> Array:
        """Positions at the given lengths, shape (..., 2)."""
        return np.stack([np.interp(length, self.length, self.position[:, axis]) for axis in (0, 1)], axis=-1)

    def followed_by(self, length: Array, position: Array) -> "HolePath":
        """The hole drilled on through more points; those not ahead of its end are left out."""
        ahead = length > self.length[-1]
        return HolePath(np.append(self.length, length[ahead]), np.concatenate((self.position, position[ahead])))

    def chord_inclination(self, length: Array, chord: float) -> Array:
        """Inclination of the chord from `chord` metres before to the given lengths, (m,)."""
        x, z = (self.at(length) - self.at(length - chord)).T
        inclination: Array = np.arctan2(x, z)
        return inclination

    def since(self, length: float) -> "HolePath":
        """The end of this hole from the last point at or before `length` on."""
        first = max(int(np.searchsorted(self.length, length, side="right")) - 1, 0)
        return HolePath(self.length[first:], self.position[first:])


def existing_hole(survey: Survey, reach: float, spacing: float) -> HolePath:
    """The surveyed hole up to the bit at the start, extended straight to at least `reach`, a point each `spacing`."""
    station = np.asarray(survey.measured_depth) - survey.measured_depth[-1]
    top = min(float(station[0]), -reach)
    length = np.union1d(station, np.linspace(top, 0.0, int(np.ceil(-top / spacing)) + 1))
    position = path(length, np.interp(length, station, np.asarray(survey.inclination)))
    return HolePath(length, position - position[-1])


def planned_hole(plan: Survey, start: float) -> HolePath:
    """The hole that a plan asks for from its first station on, placed where it should be when drilling starts.

    Raises
    ------
    InputError
        If the plan does not reach the measured depth `start`, m, at which it does.
    """
    depth = np.asarray(plan.measured_depth)
    if not depth[0] <= start <= depth[-1]:
        raise InputError(
            f"measured_depth: must enclose {start:g} m, where drilling starts, got {depth[0]:g} to {depth[-1]:g}"
        )
    length = np.union1d(depth - start, np.linspace(depth[0] - start, depth[-1] - start, POINTS_OF_PLAN))
    length = np.union1d(length, 0.0)
    hole = HolePath(length, path(length, np.interp(length, depth - start, np.asarray(plan.inclination))))
    return HolePath(length, hole.position - hole.at(np.array(0.0)))


def turning(hole: HolePath, length: Array, over: float, chord: float) -> Array:
    """Change of inclination per length over the last `over` metres, (m,), rad/m; inclinations are those of chords."""
    change = hole.chord_inclination(length, chord) - hole.chord_inclination(length - over, chord)
    return change / over


def bit_positions(rows: Trajectory) -> Array:
    """Positions of the bit in the vertical plane, (m, 2)."""
    return np.column_stack((rows["displacement"], rows["true_vertical_depth"]))


class BitFrame:
    """Computes the shapes of a BHA and the hole around it in the bit frame.

    Attributes
    ----------
    stabilizer, rss
        Distance from the bit of the stabilizers, (n,), and of the steering pads.
    radius, blade_radius
        Radius of the hole, and of the blades of each stabilizer, (n,).
    s, s_hole
        Distances from the bit at which the BHA, (k,), and the hole, (k',), are computed: the first k are the same.
    at_stabilizer, at_rss
        Where the stabilizers, (n,), and the pads are in `s` and `s_hole`.
    """

    def __init__(self, case: Case) -> None:
        bha, scaled = case.bha, scale(case.bha, case.bit)
        self.stabilizer: Array = np.array(bha.stabilizer_positions)
        self.rss, self.radius = bha.rss_position, case.bit_diameter / 2
        self.blade_radius = np.maximum(self.radius - np.append(bha.stabilizer_clearances, 0.0), 0.0)

        reach = self.stabilizer[-1]
        even = np.linspace(0.0, reach, POINTS_ALONG_BHA)
        self.s = np.unique(np.concatenate((even, self.stabilizer, [self.rss])))
        self.s_hole = np.append(self.s, np.arange(reach, REACH_ABOVE_BHA * reach, even[1])[1:])
        self.at_stabilizer = np.searchsorted(self.s, self.stabilizer)
        self.at_rss = int(np.searchsorted(self.s, self.rss))

        # The shape is linear in its loads e_n, F_1 … F_{n−1}, F_RSS, sin⟨Θ⟩_1: the shape under a unit of each.
        beam = Beam(scaled)
        units = np.eye(self.stabilizer.size + 2).tolist()
        shapes = [[beam.shape(s, e_n, F, rss, g) for s in self.s / bha.length_scale] for e_n, *F, rss, g in units]
        load_scales = np.array([bha.length_scale] + [bha.force_scale] * self.stabilizer.size + [1.0])
        self._shape_per_load = bha.length_scale * np.array(shapes) / load_scales[:, None]

    def shapes(self, rows: Trajectory, hole: HolePath) -> "Shapes":
        """The shapes of each row; `hole` must reach from the last row's bit back over the first row's BHA."""
        mean = rows.stack("average_inclination") @ np.diff(self.stabilizer, prepend=0.0) / self.stabilizer[-1]
        return Shapes(self, rows, mean, self._hole_axis(rows, hole, mean), self._bha_axis(rows, mean))

    def _hole_axis(self, rows: Trajectory, hole: HolePath, mean: Array) -> Array:
        """The path of the hole, in the bit frame.

        It is shifted, by what small angles and the spacing of the rows leave, to pass exactly through the lateral
        coordinates Y(ξ−s_i) − Y(ξ) that the averages ⟨Θ⟩_i give at the stabilizers.
        """
        behind = hole.at(rows["drilled_length"][:, None] - self.s_hole) - bit_positions(rows)[:, None]
        axis: Array = behind[..., 0] * np.cos(mean)[:, None] - behind[..., 1] * np.sin(mean)[:, None]
        turns = (rows.stack("average_inclination") - mean[:, None]) * np.diff(self.stabilizer, prepend=0.0)
        shift = -np.cumsum(turns, axis=1) - axis[:, self.at_stabilizer]
        nodes = np.append(0.0, self.stabilizer)
        hats = np.array([np.interp(self.s_hole, nodes, unit) for unit in np.eye(nodes.size)[1:]])
        axis += shift @ hats
        return axis

    def _bha_axis(self, rows: Trajectory, mean: Array) -> Array:
        """The model's deflected shape under the loads of each row, turned from the bit's axis to the frame's."""
        turn = mean - rows["bit_inclination"]
        e_n = turn * self.stabilizer[-1]
        sin_Theta_1 = np.sin(rows.stack("average_inclination")[:, 0])
        loads = np.column_stack((e_n, rows.stack("stabilizer_force"), rows["rss_force"], sin_Theta_1))
        shape: Array = loads @ self._shape_per_load
        shape += turn[:, None] * self.s
        return shape


@dataclass(frozen=True)
class Shapes:
    """Hole and BHA in the bit frame for m rows of a run; lateral offsets in metres."""

    frame: BitFrame
    rows: Trajectory
    mean_inclination: Array  # (m,), of the frame's axis
    hole_axis: Array  # (m, k'), at frame.s_hole
    bha_axis: Array  # (m, k), at frame.s

    @property
    def walls(self) -> Array:
        """The low and the high side of the hole, (m, 2, k')."""
        return np.stack((self.hole_axis - self.frame.radius, self.hole_axis + self.frame.radius), axis=1)

    @property
    def blades(self) -> Array:
        """Both ends of the blades of each stabilizer, (m, n, 2)."""
        reach = np.multiply.outer(self.frame.blade_radius, (-1.0, 1.0))
        return self.bha_axis[:, self.frame.at_stabilizer, None] + reach

    @property
    def contact_points(self) -> Array:
        """The wall where it bears each non-ideal stabilizer, (m, n−1); NaN where it does not."""
        force = self.rows.stack("stabilizer_force")
        wall = self.hole_axis[:, self.frame.at_stabilizer[:-1]] - np.sign(force) * self.frame.radius
        return np.where(force == 0.0, np.nan, wall)

    @property
    def bit_turn(self) -> Array:
        """Angle from the frame's axis to the bit's, (m,)."""
        return self.rows["bit_inclination"] - self.mean_inclination

    @property
    def hole_turn(self) -> Array:
        """Angle from the frame's axis to the direction in which the hole goes on, (m,)."""
        return self.rows["borehole_inclination"] - self.mean_inclination

    @property
    def bha_in_section(self) -> Array:
        """Bit and stabilizers, in the middle of the BHA, in the vertical plane, (m, n+1, 2)."""
        at = np.append(0, self.frame.at_stabilizer)
        lateral, s = self.bha_axis[:, at], self.frame.s[at]
        sin, cos = np.sin(self.mean_inclination)[:, None], np.cos(self.mean_inclination)[:, None]
        away: Array = np.stack((lateral * cos - s * sin, -lateral * sin - s * cos), axis=-1)
        return bit_positions(self.rows)[:, None] + away


@dataclass(frozen=True)
class Bounds:
    """What a view shows, in metres of the view; y down the screen."""

    x: tuple[float, float]
    y: tuple[float, float]

    def hold(self, position: Array) -> bool:
        """Whether all positions (N, 2) are shown."""
        low, high = np.transpose((self.x, self.y))
        return bool(np.all((position >= low) & (position <= high)))


def section_bounds(position: Array, around: float) -> Bounds:
    """The vertical section around positions (N, 2), with `around` metres to spare, or a tenth."""
    low, high = position.min(axis=0), position.max(axis=0)
    around = max(around, 0.1 * float((high - low).max()))
    (left, top), (right, bottom) = low - around, high + around
    return Bounds((float(left), float(right)), (float(top), float(bottom)))


def frame_bounds(reach: float) -> Bounds:
    """The bit frame of a BHA that is `reach` metres long."""
    return Bounds((-0.45 * reach, 0.45 * reach), (-1.05 * REACH_ABOVE_BHA * reach, (AHEAD + 0.06) * reach))

"""Geometry of a run, in arrays of metres and radians, whose first axis is the rows of the trajectory.

In the vertical plane x points to the side to which inclination grows and z points down; the origin is the bit at the
start of the run.

The bit frame is that of `boreprop.analysis.sag.BeamInHole`.
"""

from dataclasses import dataclass
from math import floor, log10

import numpy as np
from numpy.typing import NDArray

from boreprop.analysis.hole import HoleAxis, SurveyedHole, bit_positions
from boreprop.analysis.hole_in_space import SurveyInSpace
from boreprop.analysis.plan import planned_hole
from boreprop.analysis.plan_in_space import planned_in_space
from boreprop.analysis.sag import BeamInHole
from boreprop.case.case import Case
from boreprop.core.quantities import CLEARANCES
from boreprop.core.survey import Survey
from boreprop.run.trajectory import Trajectory

Array = NDArray[np.float64]

POINTS_ALONG_BHA = 36  # of the drawn hole, and twice those of the BHA: smooth curves with little data
POINTS_OF_PLAN = 1000  # of the drawn plan: at most a pixel apart
MOST_LINES = 4.5  # of a grid, beside each other: numbers of metres fit there in a small window
REACH_ABOVE_BHA = 1.15  # lengths of the BHA up to which the bit frame shows the hole, so that its top can be seen
AHEAD = 0.2  # lengths of the BHA ahead of the bit over which the bit frame shows the directions of bit and hole
SECTION_SHAPE = 0.65  # width of the vertical section over its height
SECTION_LEFT, SECTION_RIGHT = 0.22, 0.9  # parts of its width between which holes are shown
FRAME_WIDTH = 0.9  # lengths of the BHA: room for the walls, and for arrows and names beside them


def planned_path(plan: Survey, case: Case, *, in_space: bool = False) -> Array:
    """Points along the planned hole, one of them where drilling starts, (N, 2); in space (N, 3).

    Raises
    ------
    InputError
        If the plan does not include the measured depth at which drilling starts.
    """
    hole: SurveyedHole | SurveyInSpace
    hole = planned_in_space(plan, case.survey) if in_space else planned_hole(plan, case.survey.measured_depth[-1])
    even = np.linspace(hole.length[0], hole.length[-1], POINTS_OF_PLAN)
    return hole.at(np.unique(np.concatenate((hole.length, [0.0], even))))


class BitFrame:
    """Computes the shapes of a BHA and of the hole around it in the bit frame.

    Attributes
    ----------
    stabilizer, rss
        Distances of the stabilizers, (n,), and of the steering pads from the bit.
    radius, blade_radius
        Radius of the hole, and of the blades of each stabilizer, (n,).
    s, s_hole
        Distances from the bit at which the BHA, (k,), and the hole, (k',), are computed; the first k are the same.
    at_stabilizer, at_rss
        Indices of the stabilizers, (n,), and of the pads in `s` and `s_hole`.
    body
        Distances of the points at which the body may touch the wall, (points,).
    at_body
        Indices of these points in `s` and `s_hole`.
    along_bha
        Indices of the points in `s` through which the BHA, which bends less than the hole, is drawn.
    body_radius
        Radius of the body at each of these, that behind a step of the diameter; None if the case does not say it.
    """

    def __init__(self, case: Case) -> None:
        bha = case.bha
        self.stabilizer: Array = np.array(bha.stabilizer_positions)
        self.rss, self.radius = bha.rss_position, case.bit_diameter / 2
        self.blade_radius = np.maximum(self.radius - np.append(bha.stabilizer_clearances, 0.0), 0.0)

        self.beam = BeamInHole(case, POINTS_ALONG_BHA)
        self.s, reach = self.beam.s, self.stabilizer[-1]
        self.s_hole = np.append(self.s, np.arange(reach, REACH_ABOVE_BHA * reach, reach / (POINTS_ALONG_BHA - 1))[1:])
        self.at_stabilizer = np.searchsorted(self.s, self.stabilizer)
        self.at_rss = int(np.searchsorted(self.s, self.rss))
        self.body: Array = np.array(bha.body_point_positions)
        self.at_body = np.searchsorted(self.s, self.body)
        self.along_bha = np.union1d(np.arange(0, self.s.size, 2), np.append(self.at_stabilizer, self.at_rss))
        self.body_radius: Array | None = None
        if bha.section_lengths and min(bha.section_outer_diameters) > 0.0:
            section = np.searchsorted(np.cumsum(bha.section_lengths)[:-1], self.s[self.along_bha], side="right")
            self.body_radius = np.array(bha.section_outer_diameters)[section] / 2

    def shapes(self, rows: Trajectory, hole: HoleAxis) -> "Shapes":
        """The shapes at each row; `hole` must reach from the bit of the last row to the top of the first row's BHA."""
        beam = self.beam
        hole_axis = beam.hole_axis(rows, hole, self.s_hole)
        bha_axis, body_force = beam.bha_axis(rows, hole_axis[:, : self.s.size])
        return Shapes(self, rows, beam.mean_inclination(rows), hole_axis, bha_axis, body_force)


@dataclass(frozen=True)
class Shapes:
    """Hole and BHA in the bit frame for m rows of a run; lateral offsets in metres."""

    frame: BitFrame
    rows: Trajectory
    mean_inclination: Array  # inclination of the frame's axis, (m,)
    hole_axis: Array  # lateral offset of the hole at frame.s_hole, (m, k')
    bha_axis: Array  # lateral offset of the BHA at frame.s, (m, k)
    body_force: Array  # force of the wall on each point of the body, N, (m, points)

    @property
    def walls(self) -> Array:
        """The low and the high side of the hole, (m, 2, k')."""
        return np.stack((self.hole_axis - self.frame.radius, self.hole_axis + self.frame.radius), axis=1)

    @property
    def blades(self) -> Array:
        """Both ends of the blades of each stabilizer, (m, n, 2)."""
        radius = np.tile(self.frame.blade_radius, (self.rows.row_count, 1))
        for i, name in enumerate(CLEARANCES):  # which may change along a run
            if name in self.rows:
                radius[:, i] = np.maximum(self.frame.radius - self.rows[name], 0.0)
        reach: Array = np.multiply.outer(radius, (-1.0, 1.0))
        ends: Array = self.bha_axis[:, self.frame.at_stabilizer, None] + reach
        return ends

    @property
    def contact_points(self) -> Array:
        """The wall where it pushes on each non-ideal stabilizer, (m, n−1); nan where it does not."""
        force = self.rows.stack("stabilizer_force")
        wall = self.hole_axis[:, self.frame.at_stabilizer[:-1]] - np.sign(force) * self.frame.radius
        return np.where(force == 0.0, np.nan, wall)

    @property
    def body_contact_points(self) -> Array:
        """The wall where it pushes on each point of the body, (m, points); nan where it does not."""
        wall = self.hole_axis[:, self.frame.at_body] - np.sign(self.body_force) * self.frame.radius
        return np.where(self.body_force == 0.0, np.nan, wall)

    @property
    def body(self) -> Array | None:
        """Both sides of the body, (m, 2, drawn points); None if the case does not say its diameter."""
        if self.frame.body_radius is None:
            return None
        axis = self.bha_axis[:, None, self.frame.along_bha]
        return axis + np.multiply.outer((-1.0, 1.0), self.frame.body_radius)

    @property
    def outside(self) -> dict[str, Array]:
        """By how much the axis of the BHA is beyond the wall, m, negative inside, and where, m behind the bit, (m,)."""
        offset = np.abs(self.bha_axis - self.hole_axis[:, : self.frame.s.size])
        farthest = offset.argmax(axis=1)
        beyond = offset[np.arange(len(offset)), farthest] - self.frame.radius
        return {"beyond_wall": beyond, "beyond_wall_at": self.frame.s[farthest]}

    @property
    def bit_turn(self) -> Array:
        """Angle from the frame's axis to the bit's, (m,)."""
        return self.rows["bit_inclination"] - self.mean_inclination

    @property
    def hole_turn(self) -> Array:
        """Angle from the frame's axis to the direction of the hole at the bit, (m,)."""
        return self.rows["borehole_inclination"] - self.mean_inclination

    @property
    def bha_in_section(self) -> Array:
        """Positions of the BHA's axis at the bit and the stabilizers in the vertical plane, (m, n+1, 2)."""
        at = np.append(0, self.frame.at_stabilizer)
        return self._in_section(self.bha_axis[:, at], self.frame.s[at])

    @property
    def blades_in_section(self) -> Array:
        """Both ends of the blades of each stabilizer in the vertical plane, (m, n, 2, 2)."""
        return self._in_section(self.blades, self.frame.stabilizer[:, None])

    @property
    def contacts_in_section(self) -> Array:
        """The wall where it pushes on each non-ideal stabilizer, in the vertical plane, (m, n−1, 2); or nan."""
        return self._in_section(self.contact_points, self.frame.stabilizer[:-1])

    def _in_section(self, lateral: Array, s: Array) -> Array:
        """Positions in the vertical plane, (m, …, 2), of points of the bit frame; `s` is for each row."""
        along = self.mean_inclination.reshape(-1, *np.ones(lateral.ndim - 1, dtype=int))
        bit = bit_positions(self.rows).reshape(*along.shape, 2)
        away = (lateral * np.cos(along) - s * np.sin(along), -lateral * np.sin(along) - s * np.cos(along))
        position: Array = bit + np.stack(away, axis=-1)
        return position


@dataclass(frozen=True)
class Bounds:
    """The range that a view shows, in metres of the view; y points down the screen."""

    x: tuple[float, float]
    y: tuple[float, float]

    @property
    def grid_step(self) -> float:
        """The length between two lines of a grid in it, m, so that the numbers of metres fit beside each other."""
        left, right = self.x
        return round_up((right - left) / MOST_LINES)

    def hold(self, position: Array) -> bool:
        """Whether all positions (N, 2) are shown."""
        low, high = np.transpose((self.x, self.y))
        return bool(np.all((position >= low) & (position <= high)))


def round_down(value: float) -> float:
    """The largest of 1, 2 and 5 times powers of ten that is not above `value`."""
    power = 10.0 ** floor(log10(value))
    return max(step * power for step in (1, 2, 5) if step * power <= value)


def round_up(value: float) -> float:
    """The smallest of 1, 2 and 5 times powers of ten that is not below `value`."""
    power = 10.0 ** floor(log10(value))
    return min(step * power for step in (1, 2, 5, 10) if step * power >= value)


def section_bounds(position: Array, around: float) -> Bounds:
    """The range of the vertical section: positions (N, 2) in a rectangle of about the shape of the view.

    Around them is a margin of about `around` metres, or of a tenth if that is more. To their left is room for the
    numbers of metres, and the shape leaves room for the key to the right of a hole that goes straight down.
    """
    low, high = position.min(axis=0), position.max(axis=0)
    around = max(around, 0.1 * float((high - low).max()))
    width, height = high - low + 2 * around
    width = max(width, (high - low)[0] / (SECTION_RIGHT - SECTION_LEFT), SECTION_SHAPE * height)
    height = width / SECTION_SHAPE
    x, y = (low + high) / 2
    left, top = x - (SECTION_LEFT + SECTION_RIGHT) / 2 * width, y - height / 2
    return Bounds((float(left), float(left + width)), (float(top), float(top + height)))


def frame_bounds(reach: float) -> Bounds:
    """The range of the bit frame of a BHA that is `reach` metres long."""
    side = FRAME_WIDTH / 2 * reach
    top, bottom = 1.05 * REACH_ABOVE_BHA, AHEAD + 0.06  # with a little room for text at either end
    return Bounds((-side, side), (-top * reach, bottom * reach))

"""Geometry of a run in space: the tube of its hole, and what is seen across its hole.

Across the hole one looks down along its axis, with the high side up the screen, or north where the hole is
nearly vertical. Each stabilizer has a disc whose edge is the wall; so have the tilt, with its limit, and the toolface.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boreprop.analysis.hole_in_space import NEARLY_VERTICAL
from boreprop.case.case import Case
from boreprop.core.quantities import CLEARANCES
from boreprop.run.ground import on_rows
from boreprop.run.trajectory import Trajectory

from .scene import Array, Bounds

SIDES = 10  # of the tube of a hole
PLAY = 0.35  # part of the radius of a disc which is the clearance of a stabilizer: it is enlarged
APART = 3.2  # radii from the middle of a disc to that of the next
ROOM, BELOW = 1.6, 2.2  # radii from the middle of a disc to the edges of the view, with room for text
IN_ONE_COLUMN = 6  # discs at most: in two columns seven are larger, but there is less room for text
TILT, TOOLFACE = -2, -1  # which discs, after those of the stabilizers


class Tube(NamedTuple):
    """Pieces of a tube: its vertices and normals, (pieces, points · SIDES, 3), and its triangles, the same for each."""

    vertices: Array
    normals: Array
    triangles: NDArray[np.uint32]


def tube(path: Array, radius: float) -> Tube:
    """The tube around pieces of a path, (pieces, points, 3), of a radius, m. Its sides do not twist around a piece."""
    along = np.gradient(path, axis=1)
    along /= np.linalg.norm(along, axis=2)[..., None]
    least = np.eye(3)[np.abs(along[:, 0]).argmin(axis=1)]
    side = np.empty_like(path)
    for point in range(path.shape[1]):
        least = least - np.sum(least * along[:, point], axis=1)[:, None] * along[:, point]
        least /= np.linalg.norm(least, axis=1)[:, None]
        side[:, point] = least
    turn = 2 * np.pi * np.arange(SIDES) / SIDES
    normals = np.cos(turn)[:, None] * side[:, :, None] + np.sin(turn)[:, None] * np.cross(along, side)[:, :, None]
    vertices = path[:, :, None] + radius * normals
    first = SIDES * np.arange(path.shape[1] - 1)[:, None] + np.arange(SIDES)
    beside = SIDES * np.arange(path.shape[1] - 1)[:, None] + (np.arange(SIDES) + 1) % SIDES
    halves = [(first, beside, first + SIDES), (beside, beside + SIDES, first + SIDES)]
    triangles = np.concatenate([np.stack(half, axis=-1).reshape(-1, 3) for half in halves]).astype(np.uint32)
    flat = (len(path), -1, 3)
    return Tube(vertices.reshape(flat), normals.reshape(flat), triangles)


def circle(points: int) -> Array:
    """Points around a circle of radius 1, (points + 1, 2), the last one the first again."""
    turn = np.linspace(0.0, 2 * np.pi, points + 1)
    return np.column_stack((np.sin(turn), -np.cos(turn)))


def disc_places(count: int) -> Array:
    """The middle of each of some discs in their view, (count, 2), in two columns if they are many."""
    columns = 1 if count <= IN_ONE_COLUMN else 2
    number = np.arange(count)
    return APART * np.column_stack((number % columns, number // columns)).astype(float)


def disc_bounds(count: int) -> Bounds:
    """The range of the view of some discs."""
    right, bottom = disc_places(count).max(axis=0)
    return Bounds((-ROOM, float(right) + ROOM), (-ROOM, float(bottom) + BELOW))


def contact_points(force: Array) -> Array:
    """Where the wall pushes with some forces, at the edge of a disc, (…, 2); nan where it does not."""
    size = np.linalg.norm(force, axis=-1)[..., None]
    places = np.full(force.shape, np.nan)
    np.divide(-force, size, out=places, where=size > 0.0)
    return places


@dataclass(frozen=True)
class Discs:
    """What the discs of a run show at m of its rows, in radii of its disc, y down the screen."""

    case: Case
    rows: Trajectory

    def _parts(self, name: str, index: str = "") -> Array:
        """The parts of a vector to the right and down the screen, (m, 2)."""
        return np.column_stack((self.rows[f"{name}_right{index}"], -self.rows[f"{name}_high{index}"]))

    def _of_stabilizers(self, name: str) -> Array:
        parts = [self._parts(name, f"[{i}]") for i in range(1, self.rows.n)]
        return np.stack(parts, axis=1) if parts else np.empty((self.rows.row_count, 0, 2))

    @cached_property
    def clearance(self) -> Array:
        """Clearance of each stabilizer, m, (m, n−1)."""
        columns = [on_rows(self.case, self.rows, name) for name in CLEARANCES[: self.rows.n - 1]]
        return np.column_stack(columns) if columns else np.empty((self.rows.row_count, 0))

    @cached_property
    def force(self) -> Array:
        """Force of the wall on each stabilizer, N, (m, n−1, 2)."""
        return self._of_stabilizers("stabilizer_force")

    @cached_property
    def middle(self) -> Array:
        """The middle of each stabilizer in its disc, (m, n−1, 2); its clearance is enlarged to `PLAY`."""
        clearance = np.broadcast_to(self.clearance[..., None], self.force.shape)
        inside = np.zeros(self.force.shape)
        np.divide(self._of_stabilizers("stabilizer_deflection"), clearance, out=inside, where=clearance > 0)
        return PLAY * inside

    @property
    def body_force(self) -> Array:
        """The largest force of the wall on the body, N, (m, 2)."""
        return self._parts("body_contact_force")

    @cached_property
    def tilt(self) -> Array:
        """The tilt of the bit over its limit, (m, 2)."""
        limit: Array = on_rows(self.case, self.rows, "bit_tilt_limit")
        tilt: Array = self._parts("bit_tilt") / limit[:, None]
        return tilt

    @property
    def bit_force(self) -> Array:
        """The lateral force on the bit, N, (m, 2)."""
        return self._parts("bit_lateral_force")

    @property
    def toolface(self) -> Array:
        """The force of the pads in the dial, N, (m, 2): up the screen is that from where the toolface counts."""
        toolface = self.rows.columns.get("rss_toolface", np.zeros(self.rows.row_count))
        force: Array = self.rows["rss_force"][:, None] * np.column_stack((np.sin(toolface), -np.cos(toolface)))
        return force

    @property
    def upright(self) -> list[str]:
        """What is up the screen at each row."""
        vertical = self.rows["bit_inclination"] < NEARLY_VERTICAL
        return [("high side", "north")[int(row)] for row in vertical.tolist()]

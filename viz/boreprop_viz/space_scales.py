"""The scales of what is shown of runs in space besides what is shown in the plane."""

from dataclasses import dataclass, replace

import numpy as np

from boreprop.analysis.hole_in_space import NEARLY_VERTICAL, positions_in_space
from boreprop.run.trajectory import Trajectory

from .scene import Array, Bounds
from .space_scene import disc_places

LOST = ("average_inclination", "north", "east")  # columns that have no projection
AZIMUTHS = ("bit_azimuth", "borehole_azimuth", "planned_azimuth")
PLAN_MARGIN = 0.3  # of the extent of the holes, to either side in the plan view: room for the numbers of metres


@dataclass(frozen=True)
class SpaceScales:
    """The scales of runs in space."""

    azimuth: float  # of the vertical section, rad
    plan: Bounds  # of the plan view
    lateral: float  # factor by which the enlarged hole lies farther from its trend than it does
    thickness: float  # radius with which the enlarged hole is drawn, m
    newtons: float  # force of which the arrow is as long as the radius of a disc, N
    stabilizers: int  # which have a disc each, beside those of tilt and toolface
    body: int  # 1: the body of a run may touch the wall, and has a disc after those of the stabilizers; else 0

    @property
    def discs(self) -> Array:
        """The middle of each disc, (discs, 2)."""
        return disc_places(self.stabilizers + self.body + 2)

    def projected(self, rows: Trajectory) -> Trajectory:
        """Rows as seen in the vertical section: positions and inclinations of a run in the plane."""
        columns = {name: values for name, values in rows.columns.items() if not name.startswith(LOST)}
        columns["displacement"] = self.on_section(positions_in_space(rows))[:, 0]
        for axis in ("bit", "borehole"):
            inclination, azimuth = rows[f"{axis}_inclination"], rows[f"{axis}_azimuth"]
            ahead = np.sin(inclination) * np.cos(azimuth - self.azimuth)
            columns[f"{axis}_inclination"] = np.arctan2(ahead, np.cos(inclination))
        return replace(rows, columns=columns)

    def plotted(self, rows: Trajectory) -> Trajectory:
        """Rows with azimuths as they are plotted: without a jump at north, and nan where a direction is near vertical.

        An azimuth is within half a turn of that of the vertical section.
        """
        columns = dict(rows.columns)
        for name in AZIMUTHS:
            if name in columns:
                inclination = columns[name.replace("azimuth", "inclination")]
                beside = np.mod(columns[name] - self.azimuth + np.pi, 2 * np.pi) - np.pi
                azimuth = self.azimuth % (2 * np.pi) + beside
                columns[name] = np.where(inclination > NEARLY_VERTICAL, azimuth, np.nan)
        return replace(rows, columns=columns)

    def on_section(self, position: Array) -> Array:
        """Positions north, east and down, (N, 3), in the vertical section: along its azimuth, and down, (N, 2)."""
        along = position[:, 0] * np.cos(self.azimuth) + position[:, 1] * np.sin(self.azimuth)
        return np.column_stack((along, position[:, 2]))

    def on_plan(self, position: Array) -> Array:
        """Positions north, east and down, (N, 3), in the plan view: east to the right, north up the screen, (N, 2)."""
        return np.column_stack((position[:, 1], -position[:, 0]))

    def widened(self, rows: Trajectory) -> "SpaceScales":
        """The same scales with a plan view at least twice as wide that also shows the rows."""
        corners = np.transpose((self.plan.x, self.plan.y))
        shown = np.concatenate((corners, self.on_plan(positions_in_space(rows))))
        return replace(self, plan=plan_bounds(shown, 2 * float(np.ptp(corners[:, 0]))))


def section_azimuth(position: Array) -> float:
    """The azimuth along which positions north, east and down, (N, 3), extend farthest from the first one, rad."""
    level = position[:, :2] - position[0, :2]
    north, east = np.linalg.svd(level, full_matrices=False)[2][0] if np.any(level) else (1.0, 0.0)
    forward = 1.0 if level[-1] @ (north, east) >= 0.0 else -1.0
    return float(np.arctan2(forward * east, forward * north))


def plan_bounds(shown: Array, least: float) -> Bounds:
    """A square around points of the plan view, (N, 2), of a side of at least `least` metres."""
    low, high = shown.min(axis=0), shown.max(axis=0)
    half = max((1 + 2 * PLAN_MARGIN) * float((high - low).max()), least) / 2
    x, y = ((low + high) / 2).tolist()
    return Bounds((x - half, x + half), (y - half, y + half))

"""The axis of a hole in space: of a survey, and of a run.

Positions are north, east and down of the bit at the start of the run; lengths are measured from there along the hole.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..core.survey import Survey
from ..run.trajectory import Trajectory
from .hole import POINTS_BEHIND, Hole, HoleAxis

STRAIGHT = 1e-9  # rad: a piece that turns by less is straight, since rounding decides to which side it turns
NEARLY_VERTICAL = np.radians(3.0)  # up to here the high side says little, and directions count from north
OF_SPACE = ("north", "east", "borehole_azimuth")  # columns of runs in space only
UPRIGHT = 1e-9  # a direction whose horizontal part is less has no azimuth


def is_in_space(run: Trajectory) -> bool:
    """Whether a run goes through space: its case does, or it has columns that others lack."""
    return (run.case is not None and run.case.in_space) or any(name in run for name in OF_SPACE)


def directions(inclination: Floats, azimuth: Floats) -> Floats:
    """North, east and down of directions, rad, shape (..., 3)."""
    sine = np.sin(inclination)
    return np.stack((sine * np.cos(azimuth), sine * np.sin(azimuth), np.cos(inclination)), axis=-1)


@dataclass(frozen=True)
class SurveyInSpace:
    """The hole of a survey by the method of minimum curvature: between stations it is an arc of a circle.

    Above the first station and below the last one it is straight.

    Parameters
    ----------
    length
        Of each station, m, increasing, (N,).
    direction, position
        North, east and down of each station, the position in m, (N, 3).
    """

    length: Floats
    direction: Floats
    position: Floats

    @classmethod
    def of(cls, survey: Survey, start: float | None = None) -> "SurveyInSpace":
        """The hole of a survey, at the origin where its measured depth is `start`, m; None: at its last station."""
        depth = np.asarray(survey.measured_depth)
        length = depth - (depth[-1] if start is None else start)
        azimuth = np.asarray(survey.azimuth) if survey.azimuth else np.zeros(length.size)
        hole = cls(length, directions(np.asarray(survey.inclination), azimuth), np.zeros((length.size, 3)))
        pieces = hole._from_station(np.arange(length.size - 1), np.diff(length))
        hole = replace(hole, position=np.concatenate((np.zeros((1, 3)), np.cumsum(pieces, axis=0))))
        return replace(hole, position=hole.position - hole.at(np.array(0.0)))

    def at(self, length: Floats) -> Floats:
        """Positions at lengths, m, shape (..., 3)."""
        station = self._station(length)
        position: Floats = self.position[station] + self._from_station(station, length - self.length[station])
        return position

    def turning_at(self, length: Floats) -> tuple[Floats, Floats]:
        """Directions at lengths, m, and by how much they change along the hole, 1/m, shape (..., 3) each."""
        station = self._station(length)
        start, side, curvature, turn = self._arc(station, length - self.length[station])
        cosine, sine = np.cos(turn), np.sin(turn)
        return cosine * start + sine * side, curvature * (cosine * side - sine * start)

    @cached_property
    def _bends(self) -> tuple[Floats, Floats]:
        """To which side the hole turns below each station, (N, 3), and its curvature there, 1/m, (N,)."""
        start, end = self.direction[:-1], self.direction[1:]
        turn = angle_between(start, end)
        bent = turn > STRAIGHT
        across = end - (start * end).sum(axis=-1, keepdims=True) * start
        size = np.where(bent, np.linalg.norm(across, axis=-1), 1.0)
        side = np.append(across / size[:, None], np.zeros((1, 3)), axis=0)
        return side, np.append(np.where(bent, turn / np.diff(self.length), 0.0), 0.0)

    def _station(self, length: Floats) -> NDArray[np.intp]:
        """The last station before each of some lengths, m, or the first one."""
        return np.clip(np.searchsorted(self.length, length, side="right") - 1, 0, None)

    def _arc(self, station: NDArray[np.intp], along: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Of the arc below stations its direction there, the side to which it turns, its curvature, 1/m, and its turn.

        The turn is that up to this far along, m, in rad. The shapes are (..., 3) twice and (..., 1) twice.
        """
        side, curvature = self._bends
        bend = np.where(along < 0.0, 0.0, curvature[station])[..., None]
        return self.direction[station], side[station], bend, bend * along[..., None]

    def _from_station(self, station: NDArray[np.intp], along: Floats) -> Floats:
        """From stations to the places this far along, m, which the next station is not before."""
        start, side, _, turn = self._arc(station, along)
        chord = along[..., None] * np.sinc(turn / (2 * np.pi))
        way: Floats = chord * (np.cos(turn / 2) * start + np.sin(turn / 2) * side)
        return way


def angle_between(start: Floats, end: Floats) -> Floats:
    """The angles between directions, rad: the dogleg of the method of minimum curvature."""
    across = np.linalg.norm(np.cross(start, end), axis=-1)
    angle: Floats = np.arctan2(across, (start * end).sum(axis=-1))
    return angle


def positions_in_space(run: Trajectory) -> Floats:
    """North, east and down of the bit, m, shape (rows, 3)."""
    return np.column_stack((run["north"], run["east"], run["true_vertical_depth"]))


def hole_in_space(run: Trajectory, survey: Survey, reach: float) -> HoleAxis:
    """The hole of a run that starts at the end of a survey, with at least `reach` metres of the existing hole."""
    existing = SurveyInSpace.of(survey)
    top = min(float(existing.length[0]), -reach)
    points = int(np.ceil(-top * POINTS_BEHIND / reach)) + 1
    length = np.union1d(existing.length, np.linspace(top, 0.0, points))
    return HoleAxis(length, existing.at(length)).followed_by(run["drilled_length"], positions_in_space(run))


def chord_direction(hole: Hole, length: Floats, chord: float) -> Floats:
    """Direction of the chord over the last `chord` metres before each of the given lengths, shape (m, 3)."""
    vector = hole.at(length) - hole.at(length - chord)
    unit: Floats = vector / np.linalg.norm(vector, axis=-1, keepdims=True)
    return unit


def inclination_of(direction: Floats) -> Floats:
    """Inclinations of directions from the downward vertical, rad, 0 to π."""
    inclination: Floats = np.arctan2(np.hypot(direction[..., 0], direction[..., 1]), direction[..., 2])
    return inclination


def azimuth_of(direction: Floats) -> Floats:
    """Azimuths of directions from north over east, rad, 0 to 2π; nan where they are vertical."""
    north, east = direction[..., 0], direction[..., 1]
    azimuth = np.mod(np.arctan2(east, north), 2 * np.pi)
    return np.where(np.hypot(north, east) > UPRIGHT, azimuth, np.nan)


def turned_to(azimuth: Floats, other: Floats) -> Floats:
    """How far azimuths are from others, rad, from −π to π."""
    return np.mod(azimuth - other + np.pi, 2 * np.pi) - np.pi


def sides(forward: Floats) -> tuple[Floats, Floats]:
    """The high side and the right of directions, looking along them, shape (..., 3) each.

    Within `NEARLY_VERTICAL` of the vertical they are the sides to the north and to the right of that.
    """
    vertical = inclination_of(forward) < NEARLY_VERTICAL
    towards = np.where(vertical[..., None], (1.0, 0.0, 0.0), (0.0, 0.0, -1.0))
    across = towards - np.sum(towards * forward, axis=-1, keepdims=True) * forward
    high = across / np.linalg.norm(across, axis=-1, keepdims=True)
    return high, np.cross(forward, high)

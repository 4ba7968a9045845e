"""The axis of a hole in space: of a survey, and of a run.

Positions are north, east and down of the bit at the start of the run; lengths are measured from there along the hole.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..core.survey import Survey
from ..run.trajectory import Trajectory
from .hole import LEAST_SLOPE, MOST_STEPS, NEAREST, POINTS_BEHIND, Hole, HoleAxis

STRAIGHT = 1e-6  # rad: a piece that turns by less is drawn straight, which is wrong by 1e-7 of its length at most
NEARLY_VERTICAL = np.radians(3.0)  # up to here the high side says little, and directions count from north
UPRIGHT = 1e-9  # a direction whose horizontal part is less has no azimuth


def is_in_space(run: Trajectory) -> bool:
    """Whether a run says where the bit is in space."""
    return "north" in run and "east" in run


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
        """The hole of a survey, which passes the origin at a measured depth `start`, m; without it at its end."""
        length = np.asarray(survey.measured_depth) - (survey.measured_depth[-1] if start is None else start)
        azimuth = np.asarray(survey.azimuth) if survey.azimuth else np.zeros(length.size)
        hole = cls(length, directions(np.asarray(survey.inclination), azimuth), np.zeros((length.size, 3)))
        pieces = hole._from_station(np.arange(length.size - 1), np.diff(length))
        position = np.concatenate((np.zeros((1, 3)), np.cumsum(pieces, axis=0)))
        placed = cls(length, hole.direction, position)
        return cls(length, hole.direction, position - placed.at(np.zeros(1)))

    def at(self, length: Floats) -> Floats:
        """Positions at lengths, m, shape (..., 3)."""
        station = self._station(length)
        position: Floats = self.position[station] + self._from_station(station, length - self.length[station])
        return position

    def direction_at(self, length: Floats) -> tuple[Floats, Floats]:
        """Directions at lengths, m, and how they turn, 1/m, shape (..., 3) each."""
        station = self._station(length)
        start, end, apart, turn = self._arc(station, length - self.length[station])
        own, rate = np.where(turn > 0.0, turn, 1.0)[..., None], (turn / apart)[..., None]
        done = rate * (length - self.length[station])[..., None]
        bent = (np.sin(own - done) * start + np.sin(done) * end) / np.sin(own)
        turned = rate * (np.cos(done) * end - np.cos(own - done) * start) / np.sin(own)
        return np.where(rate > 0.0, bent, start), np.where(rate > 0.0, turned, 0.0)

    def nearest(self, position: Floats, near: Floats) -> Floats:
        """The lengths at which this hole is nearest to some points, m, shape (m,), as `SurveyedHole.nearest`."""
        length = near
        for _ in range(MOST_STEPS):
            away, (direction, turned) = position - self.at(length), self.direction_at(length)
            slope = 1.0 - np.sum(away * turned, axis=-1)
            step = np.sum(away * direction, axis=-1) / np.maximum(slope, LEAST_SLOPE)
            length = length + step
            if np.abs(step).max(initial=0.0) < NEAREST:
                break
        return length

    def _station(self, length: Floats) -> NDArray[np.intp]:
        """The last station at or before each length, the first one above it."""
        return np.clip(np.searchsorted(self.length, length, side="right") - 1, 0, None)

    def _arc(self, station: NDArray[np.intp], along: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Direction at stations and at the next ones, the length between them, m, and the turn, rad: 0 if straight."""
        following = np.minimum(station + 1, self.length.size - 1)
        start, end = self.direction[station], self.direction[following]
        turn = angle_between(start, end)
        turn = np.where((turn < STRAIGHT) | (along < 0.0), 0.0, turn)
        return start, end, np.where(turn > 0.0, self.length[following] - self.length[station], 1.0), turn

    def _from_station(self, station: NDArray[np.intp], along: Floats) -> Floats:
        """From stations to the places this far along, m, which the next station is not before."""
        start, end, apart, turn = self._arc(station, along)
        straight = turn == 0.0
        own = np.where(straight, 1.0, turn)
        done = own * along / apart
        of_start = np.where(straight, along, apart * (np.cos(own - done) - np.cos(own)) / (own * np.sin(own)))
        of_end = np.where(straight, 0.0, apart * (1.0 - np.cos(done)) / (own * np.sin(own)))
        way: Floats = of_start[..., None] * start + of_end[..., None] * end
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


def sides(forward: Floats) -> tuple[Floats, Floats]:
    """The high side and the right of directions, looking along them, shape (..., 3) each.

    Within `NEARLY_VERTICAL` of the vertical they are the sides to the north and to the right of that.
    """
    vertical = inclination_of(forward) < NEARLY_VERTICAL
    towards = np.where(vertical[..., None], (1.0, 0.0, 0.0), (0.0, 0.0, -1.0))
    across = towards - np.sum(towards * forward, axis=-1, keepdims=True) * forward
    high = across / np.linalg.norm(across, axis=-1, keepdims=True)
    return high, np.cross(forward, high)


def turned_to(azimuth: Floats, other: Floats) -> Floats:
    """How far azimuths are from others, rad, from −π to π."""
    return np.mod(azimuth - other + np.pi, 2 * np.pi) - np.pi

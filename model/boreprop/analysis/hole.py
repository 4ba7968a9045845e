"""The axis of a hole in the vertical plane: of a survey or a plan, and of a run.

x points to the side to which inclination grows and z points down; the origin is the bit at the start of the run.
Lengths are measured from there along the hole, so they are negative in the existing hole.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Protocol

import numpy as np

from ..arrays import Floats
from ..core.survey import Survey
from ..run.completion import axis_of
from ..run.trajectory import Trajectory

NEAREST = 1e-9  # m: steps of the search for the nearest point end when they are shorter
POINTS_BEHIND = 200  # of the existing hole behind a run: close enough to miss no more than mm
MOST_STEPS = 50  # three or four are usual
KEPT = 8  # holes of surveys: the cases of a study share one
LEAST_SLOPE = 0.2  # keeps the steps short where a point is nearly as far away as the centre of the hole's curvature


class Hole(Protocol):
    """Anything that has a position at each length along it."""

    def at(self, length: Floats) -> Floats:
        """Positions (x, z) at the given lengths, m, shape (..., 2); in space north, east and down, shape (..., 3)."""


@dataclass(frozen=True)
class SurveyedHole:
    """The hole of a survey or a plan.

    The inclination is linear between stations, so each piece is an arc of a circle; above the first station and below
    the last one the hole is straight.

    Parameters
    ----------
    length, inclination
        Length, m, increasing, and inclination, rad, of each station, shape (N,).
    position
        x and z of each station, m, shape (N, 2).
    """

    length: Floats
    inclination: Floats
    position: Floats

    @classmethod
    def of(cls, survey: Survey, start: float) -> "SurveyedHole":
        """The hole of a survey, moved so that it is at the origin where its measured depth is `start`, m."""
        length, inclination = np.asarray(survey.measured_depth) - start, np.asarray(survey.inclination)
        hole = cls(length, inclination, axis_of(length, inclination))
        return cls(length, inclination, hole.position - hole.at(np.array(0.0)))

    def at(self, length: Floats) -> Floats:
        """Positions (x, z) at the given lengths, m, shape (..., 2)."""
        piece = np.searchsorted(self.length, length, side="right")
        station = np.maximum(piece - 1, 0)
        along, turn = length - self.length[station], self.curvature[piece] * (length - self.length[station])
        mean = self.inclination[station] + turn / 2
        chord = along * np.sinc(turn / (2 * np.pi))
        return self.position[station] + np.stack((chord * np.sin(mean), chord * np.cos(mean)), axis=-1)

    @cached_property
    def curvature(self) -> Floats:
        """Curvature, rad/m, above the first station, of each piece, and below the last station, shape (N + 1,)."""
        return np.concatenate(([0.0], np.diff(self.inclination) / np.diff(self.length), [0.0]))

    def inclination_at(self, length: Floats) -> Floats:
        """Inclinations at the given lengths, rad."""
        return np.interp(length, self.length, self.inclination)

    def nearest(self, position: Floats, near: Floats) -> Floats:
        """The lengths at which this hole is nearest to some points, m, shape (m,).

        They are found by Newton's method, so of several nearest points it is that of the neighbourhood of `near`.

        Parameters
        ----------
        position
            The points, m, shape (m, 2).
        near
            The lengths at which the search starts, m, shape (m,).
        """
        length = near
        for _ in range(MOST_STEPS):
            along, across = self.away(position, length)
            curvature = self.curvature[np.searchsorted(self.length, length, side="right")]
            step = along / np.maximum(1.0 - curvature * across, LEAST_SLOPE)
            length = length + step
            if np.abs(step).max(initial=0.0) < NEAREST:
                break
        return length

    def away(self, position: Floats, length: Floats) -> tuple[Floats, Floats]:
        """How far points lie from this hole at given lengths: along it, and across it to its high side, m, (m,)."""
        x, z = (position - self.at(length)).T
        sin, cos = np.sin(self.inclination_at(length)), np.cos(self.inclination_at(length))
        return x * sin + z * cos, x * cos - z * sin


@dataclass(frozen=True)
class HoleAxis:
    """The axis of a hole, straight between points."""

    length: Floats  # of each point, increasing, m, (N,)
    position: Floats  # x and z, m, (N, 2); in space north, east and down, (N, 3)

    def at(self, length: Floats) -> Floats:
        """Positions at the given lengths, m, shape (..., 2) or, in space, (..., 3)."""
        return np.stack([np.interp(length, self.length, along) for along in self.position.T], axis=-1)

    def followed_by(self, length: Floats, position: Floats) -> "HoleAxis":
        """The hole extended through further points, without those that are not ahead of its end."""
        ahead = length > self.length[-1]
        return HoleAxis(np.append(self.length, length[ahead]), np.concatenate((self.position, position[ahead])))

    def until(self, length: float) -> "HoleAxis":
        """The part of this hole up to the last point at or before `length`."""
        end = int(np.searchsorted(self.length, length, side="right"))
        return HoleAxis(self.length[:end], self.position[:end])

    def since(self, length: float) -> "HoleAxis":
        """The part of this hole from the last point at or before `length` on."""
        first = max(int(np.searchsorted(self.length, length, side="right")) - 1, 0)
        return HoleAxis(self.length[first:], self.position[first:])


def existing_hole(survey: Survey, reach: float, spacing: float) -> HoleAxis:
    """The existing hole, above the survey straight until it is `reach` long, with a point every `spacing` metres."""
    hole = _surveyed(survey)
    top = min(float(hole.length[0]), -reach)
    length = np.union1d(hole.length, np.linspace(top, 0.0, int(np.ceil(-top / spacing)) + 1))
    return HoleAxis(length, hole.at(length))


@lru_cache(KEPT)
def _surveyed(survey: Survey) -> SurveyedHole:
    return SurveyedHole.of(survey, survey.measured_depth[-1])


def hole_of(run: Trajectory, survey: Survey, reach: float) -> HoleAxis:
    """The hole of a run that starts at the end of a survey, with at least `reach` metres of the existing hole."""
    existing = existing_hole(survey, reach, reach / POINTS_BEHIND)
    return existing.followed_by(run["drilled_length"], bit_positions(run))


def bit_positions(rows: Trajectory) -> Floats:
    """Positions (x, z) of the bit, m, shape (rows, 2)."""
    return np.column_stack((rows["displacement"], rows["true_vertical_depth"]))


def chord_inclination(hole: Hole, length: Floats, chord: float) -> Floats:
    """Inclination of the chord over the last `chord` metres before each of the given lengths, rad, shape (m,)."""
    x, z = (hole.at(length) - hole.at(length - chord)).T
    inclination: Floats = np.arctan2(x, z)
    return inclination


def turning(hole: Hole, length: Floats, over: float, chord: float) -> Floats:
    """Change of inclination over the last `over` metres, per length, rad/m, (m,); inclinations are those of chords."""
    change = chord_inclination(hole, length, chord) - chord_inclination(hole, length - over, chord)
    return change / over

"""The axis of a hole in space: north, east and down from the bit at the start of the run.

Lengths are measured from there along the hole, so they are negative in the existing hole.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Floats
from ..core.survey import Survey
from ..run.trajectory import Trajectory
from .hole import HoleAxis

NEARLY_VERTICAL = np.deg2rad(3.0)  # inclination up to which high and right are north and east, and azimuth says little
SAME = 1e-12  # rad: directions that differ by less are one


def is_spatial(run: Trajectory) -> bool:
    """Whether a run may have left its vertical plane."""
    return "north" in run


def positions_in_space(rows: Trajectory) -> Floats:
    """Positions of the bit: north, east, down, m, shape (rows, 3)."""
    return np.column_stack((rows["north"], rows["east"], rows["true_vertical_depth"]))


def direction(inclination: Floats, azimuth: Floats) -> Floats:
    """Unit vectors north, east, down of inclinations and azimuths, rad, shape (..., 3)."""
    sideways = np.sin(inclination)
    parts = np.broadcast_arrays(sideways * np.cos(azimuth), sideways * np.sin(azimuth), np.cos(inclination))
    return np.stack(parts, axis=-1)


def existing_in_space(survey: Survey, azimuth: Sequence[float], reach: float, spacing: float) -> HoleAxis:
    """The existing hole in space, above the survey straight until it is `reach` long.

    It has a point every `spacing` metres. Between two stations it is an arc of a circle: minimum curvature.

    Parameters
    ----------
    survey
        Its measured depths and inclinations.
    azimuth
        Azimuth at each station, rad.
    reach, spacing
        Lengths, m.
    """
    station = np.asarray(survey.measured_depth) - survey.measured_depth[-1]
    heading = direction(np.asarray(survey.inclination), np.asarray(azimuth))
    top = min(float(station[0]), -reach)
    length = np.union1d(station, np.linspace(top, 0.0, int(np.ceil(-top / spacing)) + 1))
    headings = _turned(station, heading, length)
    turn = angle(headings[1:], headings[:-1])
    stretched = np.where(turn > SAME, np.tan(turn / 2) / np.maximum(turn / 2, SAME), 1.0)  # tangents
    pieces = (np.diff(length) * stretched)[:, None] * (headings[1:] + headings[:-1]) / 2
    path = np.concatenate((np.zeros((1, 3)), np.cumsum(pieces, axis=0)))
    return HoleAxis(length, path - path[-1])


def _turned(station: Floats, heading: Floats, length: Floats) -> Floats:
    """Directions at some lengths, which turn evenly from station to station along great circles, (k, 3)."""
    last = np.clip(np.searchsorted(station, length, side="right") - 1, 0, len(station) - 1)
    following = np.minimum(last + 1, len(station) - 1)
    share = (length - station[last]) / np.where(following > last, station[following] - station[last], 1.0)
    share = np.where(following > last, np.clip(share, 0.0, 1.0), 0.0)
    whole = angle(heading[last], heading[following])
    sine = np.where(whole > SAME, np.sin(whole), 1.0)
    before = np.where(whole > SAME, np.sin((1.0 - share) * whole) / sine, 1.0)
    after = np.where(whole > SAME, np.sin(share * whole) / sine, 0.0)
    found: Floats = before[:, None] * heading[last] + after[:, None] * heading[following]
    return found


def angle(a: Floats, b: Floats) -> Floats:
    """Angles between unit vectors, rad, exact for small ones, shape (...,) for vectors (..., 3)."""
    away, along = np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1)
    between: Floats = 2 * np.arctan2(away, along)
    return between


def chord_direction(hole: HoleAxis, length: Floats, chord: float) -> Floats:
    """Direction of the chord over the last `chord` metres before each of the given lengths, unit vectors, (m, 3)."""
    along = hole.at(length) - hole.at(length - chord)
    unit: Floats = along / np.linalg.norm(along, axis=-1)[..., None]
    return unit


def dogleg_severity(hole: HoleAxis, length: Floats, over: float) -> Floats:
    """Angle between the chords over the last `over` metres and over those before, per length, rad/m, (m,)."""
    return angle(chord_direction(hole, length, over), chord_direction(hole, length - over, over)) / over


def turning_in_space(hole: HoleAxis, length: Floats, over: float, chord: float) -> tuple[Floats, Floats]:
    """Change of inclination and of azimuth over the last `over` metres, per length, rad/m, (m,) each.

    Inclinations and azimuths are those of chords. Where one of these is nearly vertical the azimuth says little: nan.
    """
    now, before = chord_direction(hole, length, chord), chord_direction(hole, length - over, chord)
    inclination = [np.arctan2(np.hypot(at[:, 0], at[:, 1]), at[:, 2]) for at in (now, before)]
    azimuth = [np.arctan2(at[:, 1], at[:, 0]) for at in (now, before)]
    walk = (azimuth[0] - azimuth[1] + np.pi) % (2 * np.pi) - np.pi
    known = np.minimum(*inclination) > NEARLY_VERTICAL
    return (inclination[0] - inclination[1]) / over, np.where(known, walk, np.nan) / over


def beside_trend(away: Floats, forward: Floats) -> Floats:
    """Parts of vectors to north and to east, as these lie when the vertical is turned into the hole, (k, 2).

    Parameters
    ----------
    away
        The vectors: north, east, down, (k, 3).
    forward
        The direction of the hole at each, a unit vector that does not point up, (k, 3).
    """
    north, east, down = forward.T
    along = (away[:, 0] * north + away[:, 1] * east) / (1.0 + down) + away[:, 2]  # of the rotation from vertical
    return np.column_stack((away[:, 0] - north * along, away[:, 1] - east * along))

"""How the axis of a hole in space turns, and on which side of its trend it lies.

Positions are north, east and down, as in `hole_in_space`.
"""

import numpy as np

from ..arrays import Floats
from ..core.survey import Survey
from .hole import HoleAxis
from .hole_in_space import (
    NEARLY_VERTICAL,
    SurveyInSpace,
    angle_between,
    azimuth_of,
    chord_direction,
    inclination_of,
    turned_to,
)


def existing_in_space(survey: Survey, reach: float, spacing: float) -> HoleAxis:
    """The existing hole, above the survey straight until it is `reach` long, with a point every `spacing` metres."""
    hole = SurveyInSpace.of(survey)
    top = min(float(hole.length[0]), -reach)
    length = np.union1d(hole.length, np.linspace(top, 0.0, int(np.ceil(-top / spacing)) + 1))
    return HoleAxis(length, hole.at(length))


def dogleg_severity(hole: HoleAxis, length: Floats, over: float) -> Floats:
    """Angle between the chords over the last `over` metres and over those before, per length, rad/m, (m,)."""
    return angle_between(chord_direction(hole, length, over), chord_direction(hole, length - over, over)) / over


def turning_in_space(hole: HoleAxis, length: Floats, over: float, chord: float) -> tuple[Floats, Floats]:
    """Change of inclination and of azimuth over the last `over` metres, per length, rad/m, (m,) each.

    Inclinations and azimuths are those of chords. Where one of these is nearly vertical the azimuth says little: nan.
    """
    now, before = (chord_direction(hole, at, chord) for at in (length, length - over))
    walk = turned_to(azimuth_of(now), azimuth_of(before))
    known = np.minimum(inclination_of(now), inclination_of(before)) > NEARLY_VERTICAL
    return (inclination_of(now) - inclination_of(before)) / over, np.where(known, walk, np.nan) / over


def beside_trend(away: Floats, forward: Floats) -> Floats:
    """Parts of vectors to north and to east, as these lie when the vertical is turned into the hole, (k, 2).

    Parameters
    ----------
    away
        The vectors, (k, 3).
    forward
        The direction of the hole at each, a unit vector that does not point up, (k, 3).
    """
    north, east, down = forward.T
    along = (away[:, 0] * north + away[:, 1] * east) / (1.0 + down) + away[:, 2]  # of the rotation from vertical
    return np.column_stack((away[:, 0] - north * along, away[:, 1] - east * along))

"""How far a hole is off its plan.

The distance is to the nearest point of the plan: a hole that is only shorter or longer than planned is not beside it.
Inclinations are compared at equal measured depth, by which a plan is read.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..arrays import Floats
from ..case.tables import read_survey
from ..core.survey import Survey
from ..errors import InputError
from .hole import HoleAxis, SurveyedHole, chord_inclination

ROUNDING = 1e-6  # m of measured depth: a hole that goes on this little beyond its plan ends with it


@dataclass(frozen=True)
class Deviation:
    """How far a hole is off its plan at some lengths along it; nan where the plan does not reach.

    Parameters
    ----------
    distance
        Distance from the nearest point of the plan, m, positive to the high side of the plan, shape (m,).
    inclination
        Mean inclination of the hole less that of the plan, rad, shape (m,).
    planned_inclination
        Mean inclination of the plan, rad, shape (m,).
    """

    distance: Floats
    inclination: Floats
    planned_inclination: Floats


def read_plan(path: str | Path, start: float) -> Survey:
    """Read a plan, a file like that of a survey; errors name it.

    Raises
    ------
    InputError
        If the file cannot be read, or the plan does not include the measured depth `start`, m, of the start of the run.
    """
    plan = read_survey(path)
    try:
        check_reach(plan, start)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    return plan


def check_reach(plan: Survey, start: float) -> None:
    """Raise `InputError` if a plan does not include the measured depth `start`, m, at which drilling starts."""
    first, last = plan.measured_depth[0], plan.measured_depth[-1]
    if not first <= start <= last:
        raise InputError(
            f"measured_depth of the plan: must include {start:g} m, where drilling starts, got {first:g} to {last:g}"
        )


def planned_hole(plan: Survey, start: float) -> SurveyedHole:
    """The planned hole, moved so that it passes through the bit at the start of the run.

    Raises
    ------
    InputError
        If the plan does not include the measured depth `start`, m, at which drilling starts, or leaves its plane.
    """
    check_reach(plan, start)
    if plan.turns:
        raise InputError(
            "azimuth of the plan: must be the same everywhere for a run in the plane, got a plan that turns: "
            "drill it in space (drilling.dimensions = 3)"
        )
    return SurveyedHole.of(plan, start)


def deviation_from(plan: SurveyedHole, hole: HoleAxis, length: Floats, over: float) -> Deviation:
    """How far a hole is off its plan.

    Parameters
    ----------
    plan
        The `planned_hole` of the run.
    hole
        The hole, from `over` metres behind the first of the lengths on.
    length
        Lengths from the start of the run, m, shape (m,).
    over
        The length of hole over which inclinations, those of the plan too, are averaged, m. They are means over the
        `over` metres before each of the lengths, since the inclination at a point of a rippling hole says little.
    """
    position = hole.at(length)
    _, distance = plan.away(position, plan.nearest(position, length))
    planned = chord_inclination(plan, length, over)
    outside = (length < plan.length[0] - ROUNDING) | (length > plan.length[-1] + ROUNDING)
    return Deviation(
        distance=np.where(outside, np.nan, distance),
        inclination=np.where(outside, np.nan, chord_inclination(hole, length, over) - planned),
        planned_inclination=np.where(outside, np.nan, planned),
    )

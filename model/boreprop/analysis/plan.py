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
from ..run.completion import case_of
from ..run.trajectory import Trajectory
from .hole import HoleAxis, SurveyedHole, chord_inclination, hole_of
from .hole_in_space import (
    SurveyInSpace,
    azimuth_of,
    chord_direction,
    hole_in_space,
    inclination_of,
    is_in_space,
    sides,
    turned_to,
)

ROUNDING = 1e-6  # m of measured depth: a hole that goes on this little beyond its plan ends with it


@dataclass(frozen=True)
class Deviation:
    """How far a hole is off its plan at some lengths along it; nan where the plan does not reach.

    Parameters
    ----------
    distance
        Distance from the nearest point of the plan, m, positive to the high side of the plan, or, in space, never
        negative, shape (m,).
    inclination
        Mean inclination of the hole less that of the plan, rad, shape (m,).
    planned_inclination
        Mean inclination of the plan, rad, shape (m,).
    high, right
        In space, the parts of the distance to the high side of the plan and to the right of it, looking down the hole,
        m; where the plan is nearly vertical, to the north and to the right of that. None in a plane.
    azimuth, planned_azimuth
        In space, mean azimuth of the hole less that of the plan, and that of the plan, rad, nan where one of them is
        vertical; None in a plane.
    """

    distance: Floats
    inclination: Floats
    planned_inclination: Floats
    high: Floats | None = None
    right: Floats | None = None
    azimuth: Floats | None = None
    planned_azimuth: Floats | None = None


def read_plan(path: str | Path, start: float) -> Survey:
    """Read a plan, a file like that of a survey, with azimuths for a run in space; errors name it.

    Raises
    ------
    InputError
        If the file cannot be read, or the plan does not include the measured depth `start`, m, of the start of the run.
    """
    plan = read_survey(path)
    try:
        check_start(plan, start)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    return plan


def planned_hole(plan: Survey, start: float) -> SurveyedHole:
    """The planned hole in its plane, moved so that it passes through the bit at the start of the run.

    Raises
    ------
    InputError
        If the plan does not include the measured depth `start`, m, at which drilling starts.
    """
    check_start(plan, start)
    return SurveyedHole.of(plan, start)


def plan_of(run: Trajectory, plan: Survey) -> SurveyedHole | SurveyInSpace:
    """The planned hole of a run with its case, moved so that it passes through the bit at the start of the run.

    Raises
    ------
    InputError
        If the run lacks its case, the plan does not include the measured depth at which it starts, or the plan has no
        azimuth for a run in space.
    """
    start = case_of(run).survey.measured_depth[-1]
    if not is_in_space(run):
        return planned_hole(plan, start)
    check_start(plan, start)
    if not plan.azimuth:
        raise InputError("azimuth_deg of the plan: must be given for a run in space, got no such column")
    return SurveyInSpace.of(plan, start)


def check_start(plan: Survey, start: float) -> None:
    """Raise `InputError` if a plan does not include the measured depth `start`, m, at which drilling starts."""
    first, last = plan.measured_depth[0], plan.measured_depth[-1]
    if not first <= start <= last:
        raise InputError(
            f"measured_depth of the plan: must include {start:g} m, where drilling starts, got {first:g} to {last:g}"
        )


def deviation_from(plan: SurveyedHole | SurveyInSpace, hole: HoleAxis, length: Floats, over: float) -> Deviation:
    """How far a hole is off its plan.

    Parameters
    ----------
    plan
        The planned hole of the run, see `plan_of`.
    hole
        The hole, from `over` metres behind the first of the lengths on.
    length
        Lengths from the start of the run, m, shape (m,).
    over
        The length of hole over which inclinations, those of the plan too, are averaged, m. They are means over the
        `over` metres before each of the lengths, since the inclination at a point of a rippling hole says little.
    """
    outside = (length < plan.length[0] - ROUNDING) | (length > plan.length[-1] + ROUNDING)
    if isinstance(plan, SurveyInSpace):
        columns = _in_space(plan, hole, length, over)
    else:
        position, planned = hole.at(length), chord_inclination(plan, length, over)
        columns = {
            "distance": plan.away(position, plan.nearest(position, length))[1],
            "inclination": chord_inclination(hole, length, over) - planned,
            "planned_inclination": planned,
        }
    return Deviation(**{name: np.where(outside, np.nan, column) for name, column in columns.items()})


def _in_space(plan: SurveyInSpace, hole: HoleAxis, length: Floats, over: float) -> dict[str, Floats]:
    """The columns of a `Deviation` in space."""
    position = hole.at(length)
    nearest = plan.nearest(position, length)
    away = position - plan.at(nearest)
    high, right = sides(plan.direction_at(nearest)[0])
    own, planned = (chord_direction(each, length, over) for each in (hole, plan))
    return {
        "distance": np.linalg.norm(away, axis=-1),
        "inclination": inclination_of(own) - inclination_of(planned),
        "planned_inclination": inclination_of(planned),
        "high": np.sum(away * high, axis=-1),
        "right": np.sum(away * right, axis=-1),
        "azimuth": turned_to(azimuth_of(own), azimuth_of(planned)),
        "planned_azimuth": azimuth_of(planned),
    }


def deviation_of(run: Trajectory, plan: SurveyedHole | SurveyInSpace, over: float) -> Deviation:
    """How far each row of a run with its case is off its plan, see `deviation_from`."""
    of_run = hole_in_space if is_in_space(run) else hole_of
    return deviation_from(plan, of_run(run, case_of(run).survey, over), run["drilled_length"], over)

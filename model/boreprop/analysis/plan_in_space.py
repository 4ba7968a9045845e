"""How far a hole in space is off its plan.

As in `plan`, the distance is to the nearest point of the plan, and directions are compared at equal measured depth. A
plan without azimuths lies in the vertical plane in which the hole starts.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..core.survey import Survey
from ..run.completion import case_of
from ..run.trajectory import Trajectory
from .hole import LEAST_SLOPE, MOST_STEPS, NEAREST, HoleAxis, SurveyedHole, hole_of
from .hole_in_space import (
    NEARLY_VERTICAL,
    SurveyInSpace,
    azimuth_of,
    chord_direction,
    hole_in_space,
    inclination_of,
    is_in_space,
    turned_to,
)
from .plan import ROUNDING, Deviation, check_reach, deviation_from, planned_hole


@dataclass(frozen=True)
class DeviationInSpace:
    """How far a hole in space is off its plan at some lengths along it, shape (m,) each.

    Everything is nan where the plan does not reach; parts and azimuths also where a direction is nearly vertical.

    Parameters
    ----------
    distance, high, right
        Distance from the nearest point of the plan, m, and its parts to the high side of the plan and to the right,
        looking down.
    inclination, azimuth
        Those of the hole less those of the plan, means, rad.
    planned_inclination, planned_azimuth
        Those of the plan, means, rad.
    """

    distance: Floats
    high: Floats
    right: Floats
    inclination: Floats
    azimuth: Floats
    planned_inclination: Floats
    planned_azimuth: Floats


def planned_in_space(plan: Survey, survey: Survey) -> SurveyInSpace:
    """The planned hole, moved so that it passes through the bit where a survey ends and drilling starts.

    Raises
    ------
    InputError
        If the plan does not include the measured depth at which drilling starts.
    """
    start = survey.measured_depth[-1]
    check_reach(plan, start)
    if not plan.azimuth:
        azimuth = survey.azimuth[-1] if survey.azimuth else 0.0
        plan = replace(plan, azimuth=(azimuth,) * len(plan.inclination))
    return SurveyInSpace.of(plan, start)


def nearest(plan: SurveyInSpace, position: Floats, near: Floats) -> Floats:
    """The lengths at which a plan is nearest to some points, m, shape (m,), as `SurveyedHole.nearest` finds them."""
    length = near
    for _ in range(MOST_STEPS):
        off = position - plan.at(length)
        direction, change = plan.turning_at(length)
        step = (off * direction).sum(axis=-1) / np.maximum(1.0 - (off * change).sum(axis=-1), LEAST_SLOPE)
        length = length + step
        if np.abs(step).max(initial=0.0) < NEAREST:
            break
    return length


def deviation_in_space(plan: SurveyInSpace, hole: HoleAxis, length: Floats, over: float) -> DeviationInSpace:
    """How far a hole in space is off its plan; the parameters are those of `deviation_from`."""
    position = hole.at(length)
    at = nearest(plan, position, length)
    off, (direction, _) = position - plan.at(at), plan.turning_at(at)
    down = np.array([0.0, 0.0, 1.0])
    right = np.cross(down, direction)  # as long as the sine of the inclination
    sine = np.linalg.norm(right, axis=-1)
    right = right / np.where(sine > np.sin(NEARLY_VERTICAL), sine, np.nan)[:, None]
    now, planned = chord_direction(hole, length, over), chord_direction(plan, length, over)
    walked = turned_to(azimuth_of(now), azimuth_of(planned))
    inclined = np.minimum(inclination_of(now), inclination_of(planned)) > NEARLY_VERTICAL
    reached = (length >= plan.length[0] - ROUNDING) & (length <= plan.length[-1] + ROUNDING)

    def known(values: Floats, there: NDArray[np.bool_] = reached) -> Floats:
        return np.where(reached & there, values, np.nan)

    return DeviationInSpace(
        distance=known(np.linalg.norm(off, axis=-1)),
        high=known((off * np.cross(right, direction)).sum(axis=-1)),
        right=known((off * right).sum(axis=-1)),
        inclination=known(inclination_of(now) - inclination_of(planned)),
        azimuth=known(walked, inclined),
        planned_inclination=known(inclination_of(planned)),
        planned_azimuth=known(azimuth_of(planned), inclination_of(planned) > NEARLY_VERTICAL),
    )


def plan_of(run: Trajectory, plan: Survey) -> SurveyedHole | SurveyInSpace:
    """The planned hole of a run with its case, by `planned_in_space` of one in space, else by `planned_hole`."""
    survey = case_of(run).survey
    return planned_in_space(plan, survey) if is_in_space(run) else planned_hole(plan, survey.measured_depth[-1])


def off_plan(
    plan: SurveyedHole | SurveyInSpace, hole: HoleAxis, length: Floats, over: float
) -> Deviation | DeviationInSpace:
    """How far a hole is off its plan, by `deviation_in_space` of one in space, else by `deviation_from`."""
    if isinstance(plan, SurveyInSpace):
        return deviation_in_space(plan, hole, length, over)
    return deviation_from(plan, hole, length, over)


def deviation_of(run: Trajectory, plan: SurveyedHole | SurveyInSpace, over: float) -> Deviation | DeviationInSpace:
    """How far each row of a run with its case is off its plan, see `off_plan`."""
    of_run = hole_in_space if is_in_space(run) else hole_of
    return off_plan(plan, of_run(run, case_of(run).survey, over), run["drilled_length"], over)

"""A run listed at survey stations, as directional drillers read a hole."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..core.checks import check_number
from ..run.completion import case_of
from ..run.trajectory import Trajectory
from .hole import SurveyedHole, chord_inclination, hole_of
from .hole_in_space import (
    SurveyInSpace,
    angle_between,
    azimuth_of,
    chord_direction,
    hole_in_space,
    inclination_of,
    is_in_space,
)
from .plan import Deviation
from .plan_in_space import DeviationInSpace, off_plan
from .rippling import find_rippling
from .summary import averaging_length

APART = 1e-3  # m: a multiple of the spacing this close to the start or the end is no station of its own


@dataclass(frozen=True)
class Stations:
    """A run at stations along its hole; every array has the shape (stations,).

    Parameters
    ----------
    averaging_length
        Each inclination is that of the chord to the hole this far behind, m, so that no ripple shows in it.
    measured_depth
        Measured depth, m.
    inclination
        Mean inclination, rad.
    true_vertical_depth
        True vertical depth, m, which counts from the bit at the start of the run unless its case gives the depth there.
    displacement
        Horizontal distance from the bit at the start of the run, m.
    dogleg_severity
        Magnitude of the curvature since the station before, rad/m, at least over the averaging length; in space the
        angle between the directions there, as in the method of minimum curvature, over the length.
    deviation
        How far the hole is off its plan; None without a plan.
    azimuth
        Of a run in space, mean azimuth, rad, from north over east, nan where the hole is vertical; None in the plane.
    north, east
        Of a run in space, m from the bit at the start of the run; None in the plane.
    """

    averaging_length: float
    measured_depth: Floats
    inclination: Floats
    true_vertical_depth: Floats
    displacement: Floats
    dogleg_severity: Floats
    deviation: Deviation | DeviationInSpace | None = None
    azimuth: Floats | None = None
    north: Floats | None = None
    east: Floats | None = None


def list_stations(
    run: Trajectory,
    spacing: float,
    plan: SurveyedHole | SurveyInSpace | None = None,
    *,
    averaged_over: float | None = None,
) -> Stations:
    """List a run at survey stations.

    There is a station where it starts and where it ends, and at each multiple of the spacing in between.

    Parameters
    ----------
    run
        A run with its case.
    spacing
        Measured depth from station to station, m.
    plan
        The planned hole of the run, see `plan_in_space.plan_of`.
    averaged_over
        The length of hole over which inclinations are averaged, m; without it, that of `summarize`.

    Raises
    ------
    ParameterError
        If the spacing is not > 0.
    InputError
        If the run lacks its case or a column.
    """
    check_number("spacing", spacing, above=0.0)
    case = case_of(run)
    over = averaging_length(case.bha, find_rippling(run)) if averaged_over is None else averaged_over
    zero = case.survey.measured_depth[-1]
    drilled = run["drilled_length"]
    depth = station_depths(zero + float(drilled[0]), zero + float(drilled[-1]), spacing)
    length = depth - zero
    before = np.minimum(np.append(-np.inf, length[:-1]), length - over)
    before[0] = length[0] - over
    if is_in_space(run):
        return _in_space(run, plan, over, depth, length, before)
    hole = hole_of(run, case.survey, 2 * over)
    position, inclination = hole.at(length), chord_inclination(hole, length, over)
    turn = inclination - chord_inclination(hole, before, over)
    return Stations(
        averaging_length=over,
        measured_depth=depth,
        inclination=inclination,
        true_vertical_depth=case.true_vertical_depth + position[:, 1],
        displacement=position[:, 0],
        dogleg_severity=np.abs(turn) / (length - before),
        deviation=None if plan is None else off_plan(plan, hole, length, over),
    )


def _in_space(
    run: Trajectory,
    plan: SurveyedHole | SurveyInSpace | None,
    over: float,
    depth: Floats,
    length: Floats,
    before: Floats,
) -> Stations:
    """A run in space at stations, with the lengths from which the dogleg severity of each is taken."""
    case = case_of(run)
    hole = hole_in_space(run, case.survey, 2 * over)
    position, direction = hole.at(length), chord_direction(hole, length, over)
    return Stations(
        averaging_length=over,
        measured_depth=depth,
        inclination=inclination_of(direction),
        true_vertical_depth=case.true_vertical_depth + position[:, 2],
        displacement=np.hypot(position[:, 0], position[:, 1]),
        dogleg_severity=angle_between(chord_direction(hole, before, over), direction) / (length - before),
        deviation=None if plan is None else off_plan(plan, hole, length, over),
        azimuth=azimuth_of(direction),
        north=position[:, 0],
        east=position[:, 1],
    )


def station_depths(start: float, end: float, spacing: float) -> Floats:
    """The start, the multiples of the spacing in between, and the end, m."""
    first, last = int(np.floor((start + APART) / spacing)) + 1, int(np.ceil((end - APART) / spacing)) - 1
    inside = spacing * np.arange(first, last + 1)
    return np.concatenate(([start], inside, [end]))

"""What a run predicts against what a survey measured in the same hole."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..core.survey import Survey
from ..errors import InputError
from ..run.completion import case_of
from ..run.trajectory import Trajectory
from .hole import HoleAxis, chord_inclination, hole_of
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
from .rippling import find_rippling
from .summary import averaging_length


@dataclass(frozen=True)
class Comparison:
    """A run beside a survey, at the stations of the survey; every array has the shape (stations,).

    Parameters
    ----------
    averaging_length
        Each predicted inclination is that of the chord over this length, m, half of it to both sides of the station,
        so that no ripple shows in it.
    measured_depth
        Measured depth, m.
    predicted, measured
        Inclination of the run and of the survey, rad.
    predicted_build_rate, measured_build_rate
        Mean build rate since the station before, rad/m; nan at the first station.
    predicted_azimuth, measured_azimuth
        Of a run in space, beside a survey with azimuths: azimuth of both, rad, nan where the hole is vertical; else
        None.
    high, right
        Likewise: how far the measured hole is from the predicted one at equal measured depth, m, to the high side of
        that and to the right of it, looking down the hole; where it is nearly vertical to the north and to the right of
        that. The measured hole is that of minimum curvature, from where the run starts, or from the first station
        if that is further down.
    """

    averaging_length: float
    measured_depth: Floats
    predicted: Floats
    measured: Floats
    predicted_build_rate: Floats
    measured_build_rate: Floats
    predicted_azimuth: Floats | None = None
    measured_azimuth: Floats | None = None
    high: Floats | None = None
    right: Floats | None = None

    @property
    def residual(self) -> Floats:
        """Measured less predicted inclination, rad, shape (stations,)."""
        return self.measured - self.predicted

    @property
    def azimuth_residual(self) -> Floats | None:
        """Measured less predicted azimuth, rad, from −π to π, shape (stations,); None in a plane."""
        if self.predicted_azimuth is None or self.measured_azimuth is None:
            return None
        return turned_to(self.measured_azimuth, self.predicted_azimuth)

    @property
    def root_mean_square(self) -> float:
        """The root mean square of the residuals, rad."""
        return float(np.sqrt(np.mean(self.residual**2)))


def compare(run: Trajectory, survey: Survey) -> Comparison:
    """Compare a run with what a survey measured in the same hole: inclinations, and in space azimuths and positions.

    Parameters
    ----------
    run
        A run with its case.
    survey
        The survey, with measured depths as in the case's. Its stations in the drilled hole are compared, except those
        so near the end of the run that the chord around them is not drilled.

    Raises
    ------
    InputError
        If the run lacks its case or a column, or no station can be compared.
    """
    case = case_of(run)
    over = averaging_length(case.bha, find_rippling(run))
    zero, drilled = case.survey.measured_depth[-1], run["drilled_length"]
    depth, inclination = np.asarray(survey.measured_depth), np.asarray(survey.inclination)
    first, last = zero + float(drilled[0]), zero + float(drilled[-1]) - over / 2
    inside = (depth >= first) & (depth <= last)
    if not inside.any():
        raise InputError(
            f"measured_depth: must have a station from {first:g} to {last:.6g} m, which the run drills, "
            f"got {depth[0]:g} to {depth[-1]:g} m"
        )
    depth, measured = depth[inside], inclination[inside]
    length, apart = depth - zero, np.diff(depth)
    in_space: dict[str, Floats] = {}
    if is_in_space(run):
        hole = hole_in_space(run, case.survey, 2 * over)
        direction = chord_direction(hole, length + over / 2, over)
        predicted = inclination_of(direction)
        if survey.azimuth:
            in_space = _in_space(hole, direction, SurveyInSpace.of(survey, zero), length)
    else:
        predicted = chord_inclination(hole_of(run, case.survey, 2 * over), length + over / 2, over)
    return Comparison(
        averaging_length=over,
        measured_depth=depth,
        predicted=predicted,
        measured=measured,
        predicted_build_rate=np.append(np.nan, np.diff(predicted) / apart),
        measured_build_rate=np.append(np.nan, np.diff(measured) / apart),
        **in_space,
    )


def _in_space(hole: HoleAxis, direction: Floats, measured: SurveyInSpace, length: Floats) -> dict[str, Floats]:
    """The azimuths of both holes, and how far the measured one is from the other, whose directions are given."""
    both_begin = np.array([max(0.0, measured.length[0])])
    moved = hole.at(both_begin) - measured.at(both_begin)
    away = measured.at(length) + moved - hole.at(length)
    high, right = sides(direction)
    return {
        "predicted_azimuth": azimuth_of(direction),
        "measured_azimuth": azimuth_of(measured.turning_at(length)[0]),
        "high": np.sum(away * high, axis=-1),
        "right": np.sum(away * right, axis=-1),
    }

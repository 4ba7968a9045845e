"""What a run predicts against what a survey measured in the same hole."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..core.survey import Survey
from ..errors import InputError
from ..run.completion import case_of
from ..run.trajectory import Trajectory
from .hole import chord_inclination, hole_of
from .hole_in_space import chord_direction, hole_in_space, inclination_of, is_in_space
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
    """

    averaging_length: float
    measured_depth: Floats
    predicted: Floats
    measured: Floats
    predicted_build_rate: Floats
    measured_build_rate: Floats

    @property
    def residual(self) -> Floats:
        """Measured less predicted inclination, rad, shape (stations,)."""
        return self.measured - self.predicted

    @property
    def root_mean_square(self) -> float:
        """The root mean square of the residuals, rad."""
        return float(np.sqrt(np.mean(self.residual**2)))


def compare(run: Trajectory, survey: Survey) -> Comparison:
    """Compare the inclinations of a run with those that a survey measured in the same hole.

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
    middle = depth - zero + over / 2
    if is_in_space(run):
        predicted = inclination_of(chord_direction(hole_in_space(run, case.survey, 2 * over), middle, over))
    else:
        predicted = chord_inclination(hole_of(run, case.survey, 2 * over), middle, over)
    apart = np.diff(depth)
    return Comparison(
        averaging_length=over,
        measured_depth=depth,
        predicted=predicted,
        measured=measured,
        predicted_build_rate=np.append(np.nan, np.diff(predicted) / apart),
        measured_build_rate=np.append(np.nan, np.diff(measured) / apart),
    )

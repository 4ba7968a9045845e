"""How far in ηΠ spirals reach, for bits that walk more and less."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...arrays import Floats
from ...case.case import Case
from ...core.checks import check_increasing, check_quantity, some_numbers
from .closed_form import Search, solving


@dataclass(frozen=True)
class WalkChart:
    """Where spirals end, over the walk angle: those to the right; those to the left are there for the opposite walk.

    Parameters
    ----------
    walk_angle
        ϖ, rad, increasing, shape (k,).
    critical_eta_pi
        The ηΠ below which a small spiral to the right grows about a straight vertical hole with all stabilizers on the
        wall, shape (k,); nan where there is none.
    largest_eta_pi
        The largest ηΠ with a spiral to the right, with the clearances and the tilt limit of the case, shape (k,).
    """

    walk_angle: Floats
    critical_eta_pi: Floats
    largest_eta_pi: Floats


def walk_chart(case: Case, walk_angle: ArrayLike, progress: Callable[[float], None] = lambda _: None) -> WalkChart:
    """Find up to which ηΠ a vertical hole winds to the right, for bits that walk by different angles.

    Those to the left are there for the opposite angle.

    Parameters
    ----------
    case
        The drilling system; its own walk angle has no influence.
    walk_angle
        ϖ, rad, increasing, shape (k,).
    progress
        Is called with the fraction that is done.

    Returns
    -------
    WalkChart
        The critical ηΠ of small spirals and the largest one with the spiral of the case, for each angle.

    Raises
    ------
    ParameterError
        If there is no angle, they do not increase or are out of range, or as by `spiral`.
    SpiralNotFound
        If the equations could not be solved.

    Examples
    --------
    >>> from math import radians
    >>> from boreprop import paper_case, walk_chart
    >>> walk_chart(paper_case(), [radians(-10.0), radians(10.0)]).critical_eta_pi.round(3)
    array([0.118, 0.18 ])
    """
    angles = some_numbers("walk_angle", walk_angle)
    check_increasing("bit_walk_angle", angles)
    check_quantity("bit_walk_angle", angles)
    limits, ends = [], []
    for angle in angles:
        with solving(case):
            search = Search(case, angle)
            limit = search.critical()
            limits.append(limit.eta_pi if limit else np.nan)
            ends.append(search.largest_eta_pi())
        progress(len(ends) / len(angles))
    return WalkChart(np.array(angles, float), np.array(limits), np.array(ends))

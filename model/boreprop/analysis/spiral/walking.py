"""How far in ηΠ spirals reach, for bits that walk more and less."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...arrays import Floats
from ...case.case import Case
from ...core.checks import check_increasing, check_quantity
from ..rippling import longest_wave
from .closed_form import Search
from .straight import critical


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
    """Find where spirals end, over the walk angle, rad; `progress` is called with the fraction done."""
    angles = np.asarray(walk_angle, float)
    check_increasing("bit_walk_angle", tuple(angles.tolist()))
    check_quantity("bit_walk_angle", tuple(angles.tolist()))
    limits, ends = [], []
    for angle in angles.tolist():
        search = Search(case, angle)
        limit = critical(search.turning.beam, angle, longest_wave(case.bha) / case.length_scale)
        limits.append(limit.eta_pi if limit else np.nan)
        ends.append(search.eta_pi_range(search.at(case.eta_pi).own)[1])
        progress(len(ends) / len(angles))
    return WalkChart(angles, np.array(limits), np.array(ends))

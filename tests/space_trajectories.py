"""Runs in space as trajectories, from the engine and made up."""

from collections.abc import Iterator

import numpy as np

from boreprop.case.case import Case
from boreprop.kernel.space import SpaceDrilling
from boreprop.run.trajectory import Trajectory


def drilled(case: Case, spacing: float, azimuth: tuple[float, ...] = ()) -> Trajectory:
    """The run of a case in space under a constant force and weight, with rows so far apart, m."""
    bha, bit, survey, weight = case.bha, case.bit, case.survey, case.active_weight_on_bit
    force = case.schedule.rss_force[0]
    run = SpaceDrilling(bha, bit, survey, azimuth, active_weight_on_bit=weight, rss_force=force)

    def rows() -> Iterator[dict[str, float | int]]:
        for k in range(int(case.length / spacing) + 1):
            run.advance(k * spacing, force, weight)
            yield run.outputs()

    found = list(rows())
    return Trajectory({name: np.array([row[name] for row in found]) for name in found[0]}, case)

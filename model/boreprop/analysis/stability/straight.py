"""Whether a case drills straight on: the roots of its own mode."""

from dataclasses import dataclass

import numpy as np

from ...case.case import Case
from ..lying import pressing_weight
from ..steering import SteadyResponse, steady_response
from .any_beam import characteristic_of
from .characteristic import Characteristic
from .chart import unstable_roots
from .contacts import Contact, steady_mode
from .roots import SMALLEST_ETA_PI, CriticalEtaPi, Verdict, critical_eta_pi, touching_stabilizers


@dataclass(frozen=True)
class StraightDrilling:
    """How a case drills on in a straight hole, and whether a small disturbance of that dies out.

    Parameters
    ----------
    response
        The steady response to the first force of the schedule at the inclination of the end of the existing hole.
    contact, saturated
        Its mode: the stabilizers that touch, and whether the bit tilt is saturated.
    verdict
        What becomes of a small disturbance in this mode; None where ηΠ is below 1e-4, with too many roots to tell, and
        where the body may touch the wall.
    critical
        The largest ηΠ at which this mode oscillates; None if there is none, or the body may touch.
    """

    response: SteadyResponse
    contact: Contact
    saturated: bool
    verdict: Verdict | None
    critical: CriticalEtaPi | None


def straight_drilling(case: Case) -> StraightDrilling:
    """How a case drills on in a straight hole. Roots are counted, not found, so it takes milliseconds."""
    force, inclination = case.schedule.rss_force[0], case.survey.inclination[-1]
    contact, saturated = steady_mode(case, force, inclination)
    if case.bha.body_point_positions:
        return StraightDrilling(steady_response(case, force, inclination), contact, saturated, None, None)
    verdict = mode_verdict(case, contact, saturated, inclination)
    critical = critical_eta_pi(case, contact=contact, saturated=saturated)
    return StraightDrilling(steady_response(case, force, inclination), contact, saturated, verdict, critical)


def mode_verdict(case: Case, contact: Contact, saturated: bool, inclination: float) -> Verdict | None:
    """What becomes of a small disturbance in a mode; None where ηΠ is below 1e-4, with too many roots to tell."""
    if case.eta_pi < SMALLEST_ETA_PI:
        return None
    touching = touching_stabilizers(case.bha, contact)
    weight = pressing_weight(case)
    return verdict_at(characteristic_of(case.bha, case.bit, touching, saturated, inclination, weight), case.eta_pi)


def verdict_at(characteristic: Characteristic, eta_pi: float) -> Verdict:
    """The verdict on a mode at some ηΠ, by the number of its roots in the right half plane."""
    [total], [real] = unstable_roots(characteristic, np.array([eta_pi]))
    return Verdict.OSCILLATORY if total > real else Verdict.DRIFT if real else Verdict.STABLE

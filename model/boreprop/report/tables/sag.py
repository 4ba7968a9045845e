"""Where the model ends, in words: the body of the BHA outside the hole."""

from math import isnan

from ...analysis.sag import Sag, steady_sag
from ...analysis.steering import steady_response
from ...case.case import Case
from ...core.problems import OUTSIDE
from ...units import UNITS, small_length


def steadily_outside(case: Case) -> str:
    """The warning, if there is one, for drilling on steadily under the first force, at the inclination of the bit.

    There is none where the wall bears the body of the BHA, nor in space, where the axis is not that of a plane.
    """
    if case.bha.body_point_positions or case.in_space:
        return ""
    inclination = case.survey.inclination[-1]
    response = steady_response(case, case.schedule.rss_force[0], inclination)
    return outside_the_hole(steady_sag(case, response, inclination))


def outside_the_hole(sag: Sag) -> str:
    """A warning if the axis of the BHA leaves the hole: by how much and where; empty if it does not."""
    if not sag.outside:
        return ""
    small = small_length()
    return OUTSIDE.format(
        position=UNITS["m"].text(sag.position),
        offset=small.text(abs(sag.offset)),
        side=sag.side,
        when="" if isnan(sag.drilled_length) else f" after {UNITS['m'].text(sag.drilled_length)}",
        beyond=small.text(sag.beyond),
    )

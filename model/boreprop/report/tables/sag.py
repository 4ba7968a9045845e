"""Where the model ends, in words: the body of the BHA outside the hole."""

from math import isnan

from ...analysis.sag import Sag, steady_sag
from ...analysis.steering import steady_response
from ...case.case import Case
from ...units import SMALL_LENGTH, UNITS


def steadily_outside(case: Case) -> str:
    """The warning, if there is one, for drilling on steadily under the first force, at the inclination of the bit."""
    inclination = case.survey.inclination[-1]
    response = steady_response(case, case.schedule.rss_force[0], inclination)
    return outside_the_hole(steady_sag(case, response, inclination))


def outside_the_hole(sag: Sag) -> str:
    """A warning if the axis of the BHA leaves the hole: by how much and where; empty if it does not."""
    if not sag.outside:
        return ""
    side = "below" if sag.offset < 0 else "above"
    offset, radius = (SMALL_LENGTH.text(length, ".0f") for length in (abs(sag.offset), sag.hole_radius))
    place = f"{UNITS['m'].text(sag.position)} behind the bit"
    when = "" if isnan(sag.drilled_length) else f" after {UNITS['m'].text(sag.drilled_length)}"
    return (
        f"{place} the axis of the BHA is {offset} {side} that of the hole{when}, whose radius is {radius}: "
        "its body would lie on the wall, which the model leaves out, so forces and build rates are not to be trusted"
    )

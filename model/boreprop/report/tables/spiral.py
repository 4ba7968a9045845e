"""Spirals in words."""

from math import inf, isnan

from ...analysis.spiral.closed_form import Spiral, Winding
from ...analysis.spiral.transverse import TransverseGrowth
from ...case.case import Case
from ...units import UNITS, small_length
from .stability import change, metres, weight

NONE = "none"


def title(case: Case) -> str:
    """What the spiral is of."""
    walk = f", the bit walks by {UNITS['rad'].text(case.bit.walk_angle, '.3g')}" * bool(case.bit.walk_angle)
    return f"Spiral of a vertical hole at ηΠ = {case.eta_pi:.4g} ({weight(case.active_weight_on_bit)}){walk}"


def heading(found: Spiral) -> str:
    """To which side it winds."""
    return {"either": "to either side", "right": "to the right", "left": "to the left"}[found.handedness]


def caption(case: Case) -> str | None:
    """That the hole of the case is another one; None if it is vertical, and nothing steers."""
    inclination, force = case.survey.inclination[-1], case.schedule.rss_force
    left_out = [f"ends at {UNITS['rad'].text(inclination)} inclination"] * (round(inclination, 6) != 0.0)
    left_out += ["is steered"] * any(force)
    return f"the hole of the case {' and '.join(left_out)}: that has no part here" if left_out else None


def lines(case: Case, *found: Spiral) -> list[tuple[str, ...]]:
    """The lines of a table with a column for each spiral; those of which there is nothing to say are left out."""
    columns = [_column(case, one) for one in found]
    listed = [(what, *(column[what] for column in columns)) for what in columns[0]]
    none = [] if any(one.exists for one in found) else [("spiral", *(NONE for _ in found))]
    return none + [line for line in listed if set(line[1:]) != {NONE}]


def ripple_line(case: Case, found: TransverseGrowth) -> str:
    """What becomes of a ripple that is disturbed across its plane."""
    if isnan(found.growth):
        return "in a plane a vertical hole does not ripple after a dogleg of 0.5°"
    length = case.length_scale
    waves, what = metres(found.wavelength), change(complex(found.growth * length), length)
    return f"a ripple in a plane, in waves of {waves}: a disturbance across it {what}"


def _column(case: Case, found: Spiral) -> dict[str, str]:
    """What is said of a spiral: line → text."""
    length, angle = case.length_scale, UNITS["rad"]
    edge = found.edge
    return {
        "pitch": UNITS["m"].text(found.pitch, ".4g") if found.exists else NONE,
        "radius": small_length().text(found.radius) if found.exists else NONE,
        "inclination of the hole, of the bit": _angles(found) if found.exists else NONE,
        "bit tilt": angle.text(found.bit_tilt) if found.exists else NONE,
        "forces on stabilizers": _forces(found) if found.exists else NONE,
        "lateral force on the bit": UNITS["N"].text(found.bit_lateral_force) if found.exists else NONE,
        "a disturbance of it": change(complex(found.growth * length), length) if found.exists else NONE,
        "smallest spiral that grows into it": _edge(edge) if edge else NONE,
        "there is one from ηΠ": _eta_pi(case, found.least_eta_pi),
        "up to ηΠ": _eta_pi(case, found.largest_eta_pi),
        "down to a tilt limit of": NONE if isnan(found.least_tilt_limit) else angle.text(found.least_tilt_limit, ".3g"),
        "up to a clearance of": _clearance(found.widest_clearance),
        "a small spiral in a straight hole, on the wall": change(complex(found.straight_growth * length), length),
        "such spirals grow up to ηΠ": _eta_pi(case, found.critical.eta_pi) if found.critical else NONE,
        "in pitches of": metres(found.critical.wavelength) if found.critical else NONE,
    }


def _angles(found: Winding) -> str:
    return ", ".join(UNITS["rad"].text(each) for each in (found.hole_inclination, found.bit_inclination))


def _forces(found: Winding) -> str:
    return ", ".join(UNITS["N"].text(force) for force in found.stabilizer_force) or NONE


def _edge(found: Winding) -> str:
    inclination = UNITS["rad"].text(found.hole_inclination, ".3g")
    return f"{inclination}, radius {small_length().text(found.radius)}"


def _eta_pi(case: Case, value: float) -> str:
    if isnan(value):
        return NONE
    return f"{value:.4g} ({weight(case.active_weight_on_bit * value / case.eta_pi)})" if value else "0"


def _clearance(value: float) -> str:
    if isnan(value):
        return NONE
    return "any" if value == inf else small_length().text(value)

"""A hysteresis loop as a picture: where a ripple dies out and where it comes back."""

from math import degrees, nan

import numpy as np
from matplotlib.figure import Figure

from ...analysis.hysteresis import Hysteresis
from ...analysis.rippling import Rippling
from ...case.case import Case
from ...units import UNITS, small_length
from .drawing import COLOURS, add_weight_axis


def draw(case: Case, found: Hysteresis) -> Figure:
    """Draw the size of the ripple over a parameter, on the way up and on the way down."""
    figure = Figure(figsize=(9, 6.5), layout="constrained")
    length, small = UNITS["m"].text(case.bha.half_length, ".4g"), small_length()
    figure.suptitle(
        "Where a ripple dies out, and where a dogleg of "
        f"{degrees(found.dogleg):.3g}° over {length} in a straight hole brings it back"
    )
    axis, inclination = figure.subplots(2, 1, sharex=True)
    clearance = found.name != "eta_pi"
    unit = small if clearance else UNITS[""]
    x = unit.factor * np.array(found.values)
    branches = (
        (found.up, found.dies, "o-", COLOURS[0], "going up, from a ripple"),
        (found.down, found.returns, "v--", COLOURS[1], "going down, from straight holes"),
    )
    for waves, end, style, colour, name in branches:
        drawn = {"color": colour, "markersize": 5, "label": name}
        axis.plot(x, [small.factor * _size(wave, "axis_amplitude") for wave in waves], style, **drawn)
        inclination.plot(x, [UNITS["rad"].factor * _size(wave, "amplitude") for wave in waves], style, **drawn)
        if end:
            for panel in (axis, inclination):
                panel.axvspan(unit.factor * end[0], unit.factor * end[1], color=colour, alpha=0.4, linewidth=0)
    axis.set_ylabel(f"ripple of the hole axis (± {small.shown})")
    inclination.set_ylabel(f"ripple of the inclination (± {UNITS['rad'].shown})")
    varied = f"clearance of stabilizer {found.name.partition('[')[2][:-1]}" if clearance else "ηΠ"
    inclination.set_xlabel(unit.heading(varied))
    if not clearance:
        add_weight_axis(axis, case)
    for panel in (axis, inclination):
        panel.grid(alpha=0.3)
        panel.set_ylim(bottom=0.0)
    axis.legend(title="the ends lie in the bands" if found.dies or found.returns else None)
    return figure


def _size(wave: Rippling | None, what: str) -> float:
    """The field `what`, an amplitude; 0 without a ripple, nan where the run stopped."""
    if wave is None:
        return nan
    return float(getattr(wave, what)) if wave.ripples else 0.0

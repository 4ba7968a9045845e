"""Where spirals end, over the walk angle of the bit, as a picture."""

import numpy as np
from matplotlib.figure import Figure

from ...analysis.spiral.walking import WalkChart
from ...case.case import Case
from ...units import UNITS
from .drawing import COLOURS, multiple


def draw(case: Case, chart: WalkChart) -> Figure:
    """Draw the ends of right-handed and left-handed spirals in ηΠ over the walk angle, and the case."""
    figure = Figure(figsize=(9, 6), layout="constrained")
    figure.suptitle("Up to which ηΠ a vertical hole spirals")
    panel = figure.subplots()
    angle = UNITS["rad"]
    x = angle.factor * chart.walk_angle
    for side, colour, name in ((1, COLOURS[0], "to the right"), (-1, COLOURS[1], "to the left")):
        walk, order = side * x, slice(None, None, side)
        panel.plot(walk[order], chart.critical_eta_pi[order], color=colour, label=f"a small spiral {name} grows")
        panel.plot(walk[order], chart.largest_eta_pi[order], "--", color=colour, label=f"the case's spiral {name}")
    walks, own = angle.factor * case.bit.walk_angle, case.eta_pi
    if abs(walks) <= np.abs(x).max():
        panel.plot(walks, own, "k*", markersize=12, label="the case")
    panel.set_xlabel(angle.heading("walk angle of the bit"))
    panel.set_ylabel("ηΠ")
    panel.set_ylim(bottom=0.0)
    panel.set_xlim(x[0], x[-1])
    unit = UNITS["N"]
    per_eta_pi = unit.factor * case.bha.force_scale / case.bit.lateral_steering_resistance
    weight = panel.secondary_yaxis("right", functions=multiple(per_eta_pi))
    weight.set_ylabel(unit.heading("active weight on bit"))
    panel.grid(alpha=0.3)
    panel.legend()
    return figure

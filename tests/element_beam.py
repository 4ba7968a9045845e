"""A finite-element beam (cubic elements, exact at the nodes): what the model's closed forms are checked against."""

from itertools import pairwise

import numpy as np

from boreprop.core.modes import Loads
from boreprop.core.system import Scaled

EI = 1 / 3  # in units of F* ℓ₁²


class ElementBeam:
    """Deflection from the bit's axis, and the reactions at the bit, from beam elements between the stations."""

    def __init__(self, scaled: Scaled, at: Loads, contact: list[float], extra: float) -> None:
        # hung at s_n by the offset −e_n from the bit's axis, pushed by the contacts, the RSS and the weight
        points = {scaled.Delta: at.F_rss}
        for s_i, force in zip(scaled.s[:-1], contact, strict=True):
            points[s_i] = points.get(s_i, 0.0) + force
        self.nodes = sorted({0.0, extra, *points, *scaled.s})
        self.moments = np.zeros(len(self.nodes))
        size = 2 * len(self.nodes)
        stiffness, load = np.zeros((size, size)), np.zeros(size)
        for k, (a, b) in enumerate(pairwise(self.nodes)):
            L = b - a
            element = np.array(
                [
                    [12, 6 * L, -12, 6 * L],
                    [6 * L, 4 * L**2, -6 * L, 2 * L**2],
                    [-12, -6 * L, 12, -6 * L],
                    [6 * L, 2 * L**2, -6 * L, 4 * L**2],
                ]
            )
            part = slice(2 * k, 2 * k + 4)
            stiffness[part, part] += EI / L**3 * element
            weight = -scaled.w * at.sin_Theta_1  # toward the low side
            load[part] += weight * np.array([L / 2, L**2 / 12, L / 2, -(L**2) / 12])
        for position, force in points.items():
            load[2 * self.nodes.index(position)] += force
        held = np.zeros(size, dtype=bool)
        held[[0, 1, size - 2]] = True
        values = np.zeros(size)
        values[size - 2] = -at.e[-1]
        free = ~held
        values[free] = np.linalg.solve(
            stiffness[np.ix_(free, free)], load[free] - stiffness[np.ix_(free, held)] @ values[held]
        )
        # reactions of the bit on the beam. A growing θ turns the axis up the hole to the low side, dv/ds = −θ, so the
        # moment on the bit, opposite to that on the beam, has the beam's sign when counted with θ
        reactions = stiffness @ values - load
        for k, (a, b) in enumerate(pairwise(self.nodes)):  # EI v'' at both ends of an element
            L, own = b - a, values[2 * k : 2 * k + 4]
            bent = np.array([[-6, -4 * L, 6, -2 * L], [6, 2 * L, -6, 4 * L]]) / L**2 @ own
            self.moments[[k, k + 1]] = EI * bent - scaled.w * at.sin_Theta_1 * L**2 / 12
        self.deflections, self.slopes = values[::2], values[1::2]
        self.bit_force, self.bit_moment = reactions[0], reactions[1]

    def at(self, s: float) -> float:
        return float(self.deflections[self.nodes.index(s)])

    def bent(self, s: float) -> tuple[float, float]:
        """Slope of the deflection, and bending moment."""
        k = self.nodes.index(s)
        return float(self.slopes[k]), float(self.moments[k])


def well_spaced(scaled: Scaled, extra: float) -> bool:
    """Whether the stations are far enough apart for elements between them."""
    nodes = sorted({0.0, extra, scaled.Delta, *scaled.s})
    return min(b - a for a, b in pairwise(nodes)) > 0.02  # else the elements' own stiffness is ill-conditioned

"""What the model leaves out of the beam, by finite elements: changing stiffness, axial load, a last blade with play."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise, product
from math import cos, degrees, sin

import numpy as np

from boreprop.case.case import Case

SHORTEST = 0.25  # m, of an element


@dataclass(frozen=True)
class Built:
    """A BHA as it may be built and loaded: a case, and what a `Case` does not know.

    Parameters
    ----------
    case
        The case.
    stiffness
        EI at a distance from the bit over that of the case.
    weight_on_bit
        All of it, N, which compresses the beam; with 0 there is no axial load at all.
    drop
        How far the last stabilizer lies below the axis of the hole, m.
    """

    case: Case
    stiffness: Callable[[float], float] = lambda _: 1.0
    weight_on_bit: float = 0.0
    drop: float = 0.0

    def build_rate(self, rss_force: float, inclination: float) -> float:
        """Steady build rate under a force of the pads, N, at an inclination, rad: °/30 m.

        The hole turns evenly, so e(s) = −s ψ − s² κ/2; the bit drills with ψ = F_0/(η Π) and χ Π ℓ₁² κ = M. Of all
        contacts of the stabilizers those hold that keep to their walls.
        """
        bha, bit, weight = self.case.bha, self.case.bit, self.case.active_weight_on_bit
        s, y_star = np.array(bha.stabilizer_positions), np.array(bha.stabilizer_clearances)
        maps, others = self._maps(inclination)  # rows: v_1 … v_{n−1}, F_0, M; columns: v_n, F_1 … F_{n−1}, pads, weight
        fixed = others @ (rss_force, 1.0) + maps[:, 0] * -self.drop
        n, e = len(s), np.column_stack((-s, -(s**2) / 2))
        for contact in product((0, 1, -1), repeat=n - 1):
            system, right = np.zeros((n + 1, n + 1)), np.zeros(n + 1)  # of ψ, κ, F_1 … F_{n−1}
            deflection = np.column_stack((e[:-1] - np.outer(maps[:-2, 0], e[-1]), maps[:-2, 1:]))
            for row, (c, y) in enumerate(zip(contact, y_star, strict=True)):
                system[row] = deflection[row] if c else np.eye(n + 1)[2 + row]
                right[row] = -c * y - fixed[row] if c else 0.0
            resists = (bit.lateral_steering_resistance, bit.angular_steering_resistance * s[0] ** 2)
            for row in (0, 1):
                system[n - 1 + row] = np.append(maps[n - 1 + row, 0] * e[-1], -maps[n - 1 + row, 1:])
                system[n - 1 + row, row] += resists[row] * weight
                right[n - 1 + row] = fixed[n - 1 + row]
            tilt, curvature, *force = np.linalg.solve(system, right)
            delta = deflection @ (tilt, curvature, *force) + fixed[:-2]
            holds = all(
                c * F >= 0 if c else abs(d) <= y for c, F, d, y in zip(contact, force, delta, y_star, strict=True)
            )
            if holds and abs(tilt) < bit.tilt_limit:
                return degrees(30.0 * curvature)
        raise AssertionError("no contacts hold")

    def _maps(self, inclination: float) -> tuple[np.ndarray, np.ndarray]:
        """Deflections at the stabilizers, F_0 and M by v_n and the contacts, and by the pads and the weight."""
        bha = self.case.bha
        even = np.arange(0.0, bha.stabilizer_positions[-1], SHORTEST)
        nodes = np.unique(np.append(even, [*bha.stabilizer_positions, bha.rss_position]))
        stiffness, load = np.zeros((2 * nodes.size, 2 * nodes.size)), np.zeros(2 * nodes.size)
        for k, (a, b) in enumerate(pairwise(nodes)):
            L, middle, at = b - a, (a + b) / 2, slice(2 * k, 2 * k + 4)
            bend = np.array(
                [[12, 6 * L, -12, 6 * L], [0, 4 * L**2, -6 * L, 2 * L**2], [0, 0, 12, -6 * L], [0, 0, 0, 4 * L**2]]
            )
            pull = np.array(
                [[36, 3 * L, -36, 3 * L], [0, 4 * L**2, -3 * L, -(L**2)], [0, 0, 36, -3 * L], [0, 0, 0, 4 * L**2]]
            )
            bend, pull = (m + np.triu(m, 1).T for m in (bend, pull))
            tension = (
                bha.distributed_weight * cos(inclination) * middle - self.weight_on_bit if self.weight_on_bit else 0.0
            )
            stiffness[at, at] += (
                bha.flexural_stiffness * self.stiffness(middle) / L**3 * bend + tension / (30 * L) * pull
            )
            load[at] -= bha.distributed_weight * sin(inclination) * np.array([L / 2, L**2 / 12, L / 2, -(L**2) / 12])
        held = np.array([0, 1, 2 * nodes.size - 2])
        free = np.setdiff1d(np.arange(2 * nodes.size), held)
        places = [2 * int(np.searchsorted(nodes, s)) for s in bha.stabilizer_positions[:-1]]
        forces = [
            np.eye(2 * nodes.size)[place] for place in [*places, 2 * int(np.searchsorted(nodes, bha.rss_position))]
        ]
        columns = []
        for end, pushed in [(1.0, np.zeros(2 * nodes.size)), *((0.0, force) for force in [*forces, load])]:
            v = np.zeros(2 * nodes.size)
            v[held[-1]] = end
            v[free] = np.linalg.solve(
                stiffness[np.ix_(free, free)], pushed[free] - stiffness[np.ix_(free, held)] @ v[held]
            )
            columns.append([*v[places], *(stiffness @ v - pushed)[:2]])
        found = np.array(columns).T
        return found[:, :-2], found[:, -2:]

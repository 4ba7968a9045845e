"""A beam in sections under axial load, by finite elements: what the native engine's beam is checked against."""

from itertools import pairwise
from math import cos

import numpy as np
from scipy.linalg import solveh_banded

from boreprop.arrays import Floats
from boreprop.core.system import BottomHoleAssembly


def supports(bha: BottomHoleAssembly) -> Floats:
    """Distances of stabilizers and points of the body from the bit, m."""
    return np.array([*bha.stabilizer_positions, *bha.body_point_positions])


class Elements:
    """An independent beam: cubic Hermite elements, stiffened or softened by the tension in the middle of each."""

    def __init__(self, bha: BottomHoleAssembly, weight_on_bit: float, inclination: float, sine: float) -> None:
        reach, ends = bha.stabilizer_positions[-1], np.cumsum(bha.section_lengths)
        marks = np.unique([0.0, bha.rss_position, *supports(bha), *bha.sensor_positions, *ends[ends < reach]])
        marks = marks[np.append(True, np.diff(marks) > 1e-6)]
        parts = [np.linspace(a, b, max(int((b - a) / 0.25), 1), endpoint=False) for a, b in pairwise(marks)]
        self.s = np.concatenate([*parts, [reach]])
        middle, h = (self.s[1:] + self.s[:-1]) / 2, np.diff(self.s)
        section = np.minimum(np.searchsorted(ends, middle), len(ends) - 1)
        EI, w = np.array(bha.section_flexural_stiffnesses)[section], np.array(bha.section_distributed_weights)[section]
        above = np.append(0.0, np.cumsum(w * h))
        N = (-weight_on_bit + cos(inclination) * (above[1:] + above[:-1]) / 2) * bha.axial_load
        self.size = 2 * self.s.size
        self.own, self.load, self.h = [], w * sine, h
        self.K, self.f = np.zeros((4, self.size)), np.zeros(self.size)  # lower band
        for k in range(h.size):
            L = h[k]
            bend = [
                [12, 6 * L, -12, 6 * L],
                [0, 4 * L * L, -6 * L, 2 * L * L],
                [0, 0, 12, -6 * L],
                [0, 0, 0, 4 * L * L],
            ]
            pull = [[36, 3 * L, -36, 3 * L], [0, 4 * L * L, -3 * L, -L * L], [0, 0, 36, -3 * L], [0, 0, 0, 4 * L * L]]
            own = EI[k] / L**3 * np.array(bend) + N[k] / (30 * L) * np.array(pull)
            self.own.append(own + np.triu(own, 1).T)
            for i in range(4):
                for j in range(i, 4):
                    self.K[j - i, 2 * k + i] += own[i, j]
            self.f[2 * k : 2 * k + 4] += self.own_load(k)

    def own_load(self, k: int) -> Floats:
        L = self.h[k]
        load: Floats = -self.load[k] * np.array([L / 2, L * L / 12, L / 2, -L * L / 12])
        return load

    def push(self, s: float, force: float) -> None:
        self.f[2 * self.node(s)] += force

    def solve(self, e_n: float) -> Floats:
        """Deflections at the nodes, clamped to the bit and hinged at −e_n."""
        K, f = self.K.copy(), self.f.copy()
        for held, value in ((0, 0.0), (1, 0.0), (self.size - 2, -e_n)):
            for d in range(4):
                if held + d < self.size:
                    f[held + d] -= K[d, held] * value
                    K[d, held] = 0.0
                if d and held - d >= 0:
                    f[held - d] -= K[d, held - d] * value
                    K[d, held - d] = 0.0
            K[0, held], f[held] = 1.0, value
        deflections: Floats = solveh_banded(K, f, lower=True)
        return deflections

    def node(self, s: float) -> int:
        return int(np.argmin(abs(self.s - s)))

    def moment(self, deflections: Floats, s: float) -> float:
        """EI v'' at a node, from the element above it, at the end from the one below."""
        k, side = (self.node(s), 1) if s < self.s[-1] else (self.h.size - 1, 3)
        end = (self.own[k] @ deflections[2 * k : 2 * k + 4] - self.own_load(k))[side]
        return float(-end if side == 1 else end)

"""How far the body of a BHA is from the axis of the hole, and where it would pass through the wall.

The model is that of the paper: between the bit, the pads and the stabilizers nothing holds the beam. Where its axis
comes out of the hole, the wall would carry it in truth, and neither forces nor build rates are those of the real BHA.
"""

from collections.abc import Iterator
from math import sin

import numpy as np

from ..arrays import Floats
from ..case.case import Case
from ..core.beam import Beam
from ..core.sag import POINTS, Body, places
from ..core.sag import Sag as Sag
from ..core.system import scale
from ..run.completion import case_of
from ..run.trajectory import Trajectory
from .hole import HoleAxis, bit_positions, hole_of
from .steering import SteadyResponse

BATCH = 10_000  # rows at once, which limits memory


class BeamInHole:
    """The axes of a BHA and of the hole around it, in a frame that turns with the hole.

    The frame has its origin at the bit, and its axis passes through the centre of the hole at the last stabilizer, so
    its inclination is the mean over the BHA. s grows up the hole; lateral offsets are positive to the high side, as in
    the model. The model is linear in lateral offsets: turning its frame from the axis of the bit to this one, by a
    small angle, adds that angle times s.

    Attributes
    ----------
    stabilizer
        Distances of the stabilizers from the bit, m, (n,).
    s
        Distances from the bit at which the BHA is computed, m, (k,); the stabilizers and the pads are among them.
    """

    def __init__(self, case: Case, points: int = POINTS) -> None:
        bha = case.bha
        self.stabilizer: Floats = np.array(bha.stabilizer_positions)
        # The shape is linear in the loads e_n, F_1 … F_{n−1}, F_RSS, sin⟨Θ⟩_1; these are the shapes under unit loads.
        even = places(self.stabilizer[-1], points)
        self.s: Floats = np.unique(np.append(even, [*self.stabilizer, bha.rss_position]))
        body = Body(Beam(scale(bha, case.bit)), (self.s / bha.length_scale).tolist())
        load_scales = np.array([bha.length_scale] + [bha.force_scale] * self.stabilizer.size + [1.0])
        self._shape_per_load = bha.length_scale * np.array(body.shapes).T / load_scales[:, None]

    def bent(self, e_n: Floats, forces: Floats, rss_force: Floats, sin_inclination: Floats) -> Floats:
        """Deflection of the axis of the BHA from that of the bit, eq. (5) less e(s), m, (m, k).

        Parameters
        ----------
        e_n
            Offset of the axis of the bit from the hole at the last stabilizer, m, (m,).
        forces, rss_force
            Contact forces, (m, n − 1), and that of the pads, (m,), N.
        sin_inclination
            sin⟨Θ⟩_1, (m,).
        """
        bent: Floats = np.column_stack((e_n, forces, rss_force, sin_inclination)) @ self._shape_per_load
        return bent

    def mean_inclination(self, rows: Trajectory) -> Floats:
        """Inclination of the axis of the frame, rad, (m,)."""
        averages, spans = rows.stack("average_inclination"), np.diff(self.stabilizer, prepend=0.0)
        mean: Floats = averages @ spans / self.stabilizer[-1]
        return mean

    def bha_axis(self, rows: Trajectory) -> Floats:
        """The bent axis of the BHA under the loads of each row, m, (m, k)."""
        turn = self.mean_inclination(rows) - rows["bit_inclination"]
        sin_inclination = np.sin(rows.stack("average_inclination")[:, 0])
        loads = (turn * self.stabilizer[-1], rows.stack("stabilizer_force"), rows["rss_force"], sin_inclination)
        axis: Floats = self.bent(*loads) + turn[:, None] * self.s
        return axis

    def hole_axis(self, rows: Trajectory, hole: HoleAxis, s: Floats) -> Floats:
        """The axis of the hole at distances `s` behind the bit, which include the stabilizers, m, (m, k').

        It is corrected for the errors of the small angles and of the spacing of the rows, so that at the stabilizers it
        has exactly the lateral coordinates Y(ξ−s_i) − Y(ξ) that follow from the averages ⟨Θ⟩_i. `hole` must reach from
        the bit of the last row to the top of the first row's BHA.
        """
        mean = self.mean_inclination(rows)
        behind = hole.at(rows["drilled_length"][:, None] - s) - bit_positions(rows)[:, None]
        axis: Floats = behind[..., 0] * np.cos(mean)[:, None] - behind[..., 1] * np.sin(mean)[:, None]
        turns = (rows.stack("average_inclination") - mean[:, None]) * np.diff(self.stabilizer, prepend=0.0)
        shift = -np.cumsum(turns, axis=1) - axis[:, np.searchsorted(s, self.stabilizer)]
        nodes = np.append(0.0, self.stabilizer)
        axis += shift @ np.array([np.interp(s, nodes, unit) for unit in np.eye(nodes.size)[1:]])
        return axis


def largest_sag(run: Trajectory) -> Sag:
    """Where in a run, with its case, the axis of the BHA is farthest from that of the hole."""
    case = case_of(run)
    beam, reach = BeamInHole(case), case.bha.stabilizer_positions[-1]
    hole = hole_of(run, case.survey, reach)
    sags = []
    for rows in _parts(run):
        offset = beam.bha_axis(rows) - beam.hole_axis(rows, hole, beam.s)
        row, point = np.unravel_index(np.argmax(np.abs(offset)), offset.shape)
        at = float(rows["drilled_length"][row])
        sags.append(Sag(float(offset[row, point]), float(beam.s[point]), case.bit_diameter / 2, at))
    return max(sags, key=lambda sag: abs(sag.offset))


def _parts(run: Trajectory) -> Iterator[Trajectory]:
    for first in range(0, run.row_count, BATCH):
        yield Trajectory({name: values[first : first + BATCH] for name, values in run.columns.items()}, run.case)


def steady_sag(case: Case, response: SteadyResponse, inclination: float) -> Sag:
    """Where the axis of the BHA is farthest from that of the hole in a steady response at an inclination, rad.

    In a hole of constant curvature the offset of the bit's axis from the hole is e(s) = −s ψ − s² κ/2.
    """
    beam = BeamInHole(case)
    e = -beam.s * response.bit_tilt - beam.s**2 * response.build_rate / 2
    forces, others = np.array([response.stabilizer_force]), np.array([response.rss_force, sin(inclination)])
    offset = e + beam.bent(e[-1:], forces, others[:1], others[1:])[0]
    point = int(np.argmax(np.abs(offset)))
    return Sag(float(offset[point]), float(beam.s[point]), case.bit_diameter / 2, float("nan"))

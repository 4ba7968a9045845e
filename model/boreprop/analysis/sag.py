"""How far the body of a BHA is from the axis of the hole, and where it would pass through the wall.

In the model of the paper nothing holds the beam between the bit, the pads and the stabilizers. Where its axis comes out
of the hole, the wall would carry it in truth, and neither forces nor build rates are those of the real BHA. A BHA with
body contact lies on the wall instead.
"""

from collections.abc import Iterator

import numpy as np

from ..arrays import Floats
from ..case.case import Case
from ..core.beam import Beam
from ..core.sag import POINTS, Body, places
from ..core.sag import Sag as Sag
from ..core.system import scale
from ..kernel.binding import lie
from ..run.completion import case_of
from ..run.trajectory import Trajectory
from .hole import HoleAxis, bit_positions, hole_of
from .lying import supports_of
from .steering import SteadyResponse

BATCH = 10_000  # rows at once, which limits memory
WEIGHT_STEP = 500.0  # N: such a change of the load along a BHA does not show in its shape


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
        Distances from the bit at which the BHA is computed, m, (k,); the stabilizers, the pads and the points of the
        body are among them.
    """

    def __init__(self, case: Case, points: int = POINTS) -> None:
        bha = case.bha
        self.case, self.supports = case, supports_of(bha)
        self.stabilizer: Floats = np.array(bha.stabilizer_positions)
        even = places(self.stabilizer[-1], points)
        self.s: Floats = np.unique(np.concatenate((even, self.supports, [bha.rss_position])))
        self.at_supports = np.searchsorted(self.s, self.supports)
        # The shape of the paper's beam is linear in the loads e_n, F_1 … F_{n−1}, F_RSS, sin⟨Θ⟩_1; these are the shapes
        # under unit loads.
        self._shape_per_load: Floats | None = None
        if bha.structure.is_of_the_paper:
            body = Body(Beam(scale(bha, case.bit)), (self.s / bha.length_scale).tolist())
            load_scales = np.array([bha.length_scale] + [bha.force_scale] * self.stabilizer.size + [1.0])
            self._shape_per_load = bha.length_scale * np.array(body.shapes).T / load_scales[:, None]

    def bent(self, rows: Trajectory, e: Floats) -> tuple[Floats, Floats]:
        """How the BHA lies in a hole.

        Parameters
        ----------
        rows
            Rows of a run, for the loads other than those of the hole.
        e
            Offset of the axis of the bit from the hole at each of `s`, m, (m, k).

        Returns
        -------
        bent, body_force
            The deflection of the axis of the BHA from that of the bit, eq. (5) less e(s), m, (m, k), and the force of
            the wall on each point of the body, N, (m, points).
        """
        sine = np.sin(rows["average_inclination[1]"])
        if self._shape_per_load is not None:
            loads = (e[:, self.at_supports[-1]], rows.stack("stabilizer_force"), rows["rss_force"], sine)
            return np.column_stack(loads) @ self._shape_per_load, np.empty((len(e), 0))
        pressing = np.zeros(len(e))
        if self.case.bha.axial_load:
            sine, pressing = np.sin(rows["bit_inclination"]), self._pressing(rows)
        shapes, forces = np.empty_like(e), np.empty((len(e), self.supports.size))
        for weight in np.unique(pressing):
            at = np.flatnonzero(pressing == weight)
            found = lie(
                self.case.bha,
                e[np.ix_(at, self.at_supports)],
                rows["rss_force"][at],
                sine[at],
                weight_on_bit=float(weight),
                inclination=self.case.survey.inclination[-1],
                places=self.s,
            )
            shapes[at], forces[at] = found.shape, found.forces
        return shapes, forces[:, self.stabilizer.size :]

    def _pressing(self, rows: Trajectory) -> Floats:
        """The weight that presses the BHA, N, (m,), in steps, for there is a beam to be made for each."""
        weight = rows["active_weight_on_bit"]
        if "weight_on_bit" in rows:
            weight = np.where(rows["weight_on_bit"] > 0.0, rows["weight_on_bit"], weight)
        return WEIGHT_STEP * np.round(weight / WEIGHT_STEP)

    def mean_inclination(self, rows: Trajectory) -> Floats:
        """Inclination of the axis of the frame, rad, (m,)."""
        averages, spans = rows.stack("average_inclination"), np.diff(self.stabilizer, prepend=0.0)
        mean: Floats = averages @ spans / self.stabilizer[-1]
        return mean

    def bha_axis(self, rows: Trajectory, hole_axis: Floats) -> tuple[Floats, Floats]:
        """The bent axis of the BHA in the hole, m, (m, k), and the forces on the points of its body, N, (m, points).

        `hole_axis` is that at each of `s`.
        """
        turn = self.mean_inclination(rows) - rows["bit_inclination"]
        straight = turn[:, None] * self.s
        bent, body_force = self.bent(rows, straight - hole_axis)
        return bent + straight, body_force

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
    """Where in a run, with its case, the axis of the BHA is farthest from that of the hole.

    For a BHA without points of the body, which the wall does not hold.
    """
    case = case_of(run)
    beam, reach = BeamInHole(case), case.bha.stabilizer_positions[-1]
    hole = hole_of(run, case.survey, reach)
    sags = []
    for rows in _parts(run):
        hole_axis = beam.hole_axis(rows, hole, beam.s)
        offset = beam.bha_axis(rows, hole_axis)[0] - hole_axis
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
    values = {
        "drilled_length": 0.0,
        "rss_force": response.rss_force,
        "active_weight_on_bit": case.active_weight_on_bit,
        "weight_on_bit": case.weight_on_bit,
        "bit_inclination": inclination + response.bit_tilt,
        "average_inclination[1]": inclination,
    } | {f"stabilizer_force[{i}]": force for i, force in enumerate(response.stabilizer_force, 1)}
    row = Trajectory({name: np.array([value]) for name, value in values.items()}, case)
    offset = e + beam.bent(row, e[None])[0][0]
    point = int(np.argmax(np.abs(offset)))
    return Sag(float(offset[point]), float(beam.s[point]), case.bit_diameter / 2, float("nan"))

"""The beam of any BHA, the paper's or one in sections and under an axial load: its coefficients, and those of a mode.

M, F_0 and the deflections q̃ without contact are linear in the offsets e of the bit's axis, the contact forces, and the
angle of the weight. Of the paper's beam the coefficients are those of `core.beam`. Of others they follow from what
`lie` answers, with each stabilizer held without clearance, to each offset and to the weight alone: there the forces
are F = −K q̃, with q̃_i = e_i where only stabilizer i is off.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...arrays import Floats
from ...core.beam import Beam
from ...core.errors import ParameterError
from ...core.system import BitRock, BottomHoleAssembly, Scaled, check_in_plane, epsilon, scale
from ...kernel.binding import lie
from .characteristic import Characteristic, upright


class Rows(NamedTuple):
    """The deflections q̃ without contact, M and F_0 by e_1 … e_n and θ: shapes (n − 1, n + 1) and twice (n + 1,)."""

    q: Floats
    M: Floats
    F_0: Floats


@dataclass(frozen=True)
class AnyBeam:
    """The beam of a BHA, in the paper's numbers: with n stabilizers, i, j = 1 … n−1, and g the angle of the weight,

        δ_i = Σ_k q_e[i][k] e_k + Σ_j K_inv[i][j] F_j + q_g[i] g
        M   = M_e e_n           + Σ_j M_F[j] F_j      + M_g g ,                F_0 likewise.

    The angle g is ⟨Θ⟩_1 = e_1/s_1 + θ, or under an axial load θ, times the cosine of the inclination. ε, the bit's
    resistance to turning over that to moving sideways, makes it a drilling system.
    """

    s: Floats
    K_inv: Floats
    q_e: Floats
    q_g: Floats
    M_e: float
    M_F: Floats
    M_g: float
    F0_e: float
    F0_F: Floats
    F0_g: float
    epsilon: float
    axial: bool = False

    @classmethod
    def of(
        cls, bha: BottomHoleAssembly, bit: BitRock, weight_on_bit: float = 0.0, inclination: float = 0.0
    ) -> "AnyBeam":
        """That of a BHA under a weight on bit, N, which counts under an axial load, at an inclination, rad.

        Whether the bit walks has no influence.

        Raises
        ------
        ParameterError
            If the body of the BHA may touch the wall, a value is out of range, or the BHA buckles.
        KernelError
            If the BHA is not the paper's, and the native engine cannot be used.
        """
        if bha.structure.is_of_the_paper:
            return cls.of_the_paper(scale(bha, replace(bit, walk_angle=0.0)))
        if bha.body_point_positions:
            raise ParameterError(
                "bha.body_contact",
                "must be left out for roots, stability and spiral, which have no body on the wall; simulate shows it",
                True,
            )
        n, l1 = len(bha.stabilizer_positions), bha.length_scale
        held = replace(bha, stabilizer_clearances=(0.0,) * (n - 1), end_deflection=0.0)
        offsets, weight = np.vstack([np.eye(n) * l1, np.zeros(n)]), np.append(np.zeros(n), 1.0)
        found = lie(held, offsets, np.zeros(n + 1), weight, weight_on_bit=weight_on_bit, inclination=inclination)
        M, F_0 = found.bit_moment / (bha.force_scale * l1), found.bit_force / bha.force_scale
        F = found.forces[:, : n - 1].T / bha.force_scale
        K_inv = np.asarray(-np.linalg.inv(F[:, : n - 1]), float)
        q = -K_inv @ F
        M_F, F0_F = -M[: n - 1] @ K_inv, -F_0[: n - 1] @ K_inv
        return cls(
            s=np.array(bha.stabilizer_positions) / l1,
            K_inv=K_inv,
            q_e=q[:, :n],
            q_g=q[:, n],
            M_e=float(M[n - 1] - M_F @ F[:, n - 1]),
            M_F=M_F,
            M_g=float(M[n] - M_F @ F[:, n]),
            F0_e=float(F_0[n - 1] - F0_F @ F[:, n - 1]),
            F0_F=F0_F,
            F0_g=float(F_0[n] - F0_F @ F[:, n]),
            epsilon=epsilon(bit),
            axial=bha.axial_load,
        )

    @classmethod
    def of_the_paper(cls, scaled: Scaled) -> "AnyBeam":
        """The paper's beam."""
        beam, n = Beam(scaled), len(scaled.s)
        q_e = np.eye(n)[:-1]
        q_e[:, -1] += beam.delta_e
        return cls(
            s=np.array(scaled.s),
            K_inv=np.array(beam.K_inv).reshape(n - 1, n - 1),
            q_e=q_e,
            q_g=np.array(beam.delta_g),
            M_e=beam.M_e,
            M_F=np.array(beam.M_F),
            M_g=beam.M_g,
            F0_e=beam.F0_e,
            F0_F=np.array(beam.F0_F),
            F0_g=beam.F0_g,
            epsilon=scaled.epsilon,
        )

    def rows(self) -> Rows:
        """How q̃, M and F_0 go by the offsets and by θ in a vertical hole."""
        weight = np.zeros(len(self.s) + 1)
        weight[-1] = 1.0
        weight[0] = 0.0 if self.axial else 1.0 / self.s[0]
        by_e = np.zeros((len(self.q_g) + 2, len(weight)))
        by_e[:-2, :-1], by_e[-2:, -2] = self.q_e, (self.M_e, self.F0_e)
        by = by_e + np.outer(np.append(self.q_g, (self.M_g, self.F0_g)), weight)
        return Rows(by[:-2], by[-2], by[-1])

    def characteristic(
        self, contact: tuple[int, ...], saturated: bool = False, inclination: float = 0.0, walk: float = 0.0
    ) -> Characteristic:
        """The characteristic function of the mode with `contact` (0 where a stabilizer is free) in a straight hole.

        The hole has an inclination, rad; a bit that walks, by so many rad, has such a function in a vertical hole. The
        stabilizers that touch stay where they are: of these 0 = q_e e + K_inv F + q_g g.
        """
        touching = np.flatnonzero(contact)
        F_by = -np.linalg.solve(
            self.K_inv[np.ix_(touching, touching)], np.column_stack([self.q_e[touching], self.q_g[touching]])
        )
        own = np.zeros((2, len(self.s) + 1))
        own[:, -2:] = (self.M_e, self.M_g), (self.F0_e, self.F0_g)
        M, F_0 = own + np.vstack([self.M_F[touching], self.F0_F[touching]]) @ F_by
        weight = upright(inclination)
        m, f = ((row[:-1].tolist(), float(row[-1]) * weight) for row in (M, F_0))
        return Characteristic.made_of(self.s.tolist(), m, f, self.epsilon, saturated, axial=self.axial, walk=walk)


def characteristic_of(
    bha: BottomHoleAssembly,
    bit: BitRock,
    contact: tuple[int, ...],
    saturated: bool,
    inclination: float,
    weight_on_bit: float = 0.0,
) -> Characteristic:
    """The characteristic function of a mode in a straight hole at an inclination, rad, for a bit that does not walk.

    Errors are those of `AnyBeam.of`, and `ParameterError` if the bit walks.
    """
    check_in_plane(bit)
    return AnyBeam.of(bha, bit, weight_on_bit, inclination).characteristic(contact, saturated, inclination)

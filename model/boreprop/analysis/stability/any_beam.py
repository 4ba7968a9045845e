"""The characteristic function of a mode of any BHA: the paper's, or one in sections, under an axial load."""

from dataclasses import replace

import numpy as np

from ...core.errors import ParameterError
from ...core.system import BitRock, BottomHoleAssembly, epsilon, scale
from ...kernel.binding import lie
from .characteristic import Characteristic, upright

LOOSE = 1e6  # m: a clearance that no BHA uses up


def characteristic_of(
    bha: BottomHoleAssembly,
    bit: BitRock,
    contact: tuple[int, ...],
    saturated: bool,
    inclination: float,
    weight_on_bit: float = 0.0,
) -> Characteristic:
    """The characteristic function of the mode with `contact` (0 where a stabilizer is free) in a straight hole.

    In a mode M and F_0 are linear in the offsets e of the bit's axis and in g. Of a beam that is not the paper's their
    coefficients are what `lie` answers to each of these alone, with the stabilizers that touch held without clearance.

    Parameters
    ----------
    bha, bit
        The drilling system.
    contact
        1 for each non-ideal stabilizer that touches, 0 for the others.
    saturated
        Whether the bit tilt is at its limit.
    inclination
        Of the hole, rad.
    weight_on_bit
        All of it, N, where the axial load counts.

    Raises
    ------
    ParameterError
        If the body of the BHA may touch the wall, a value is out of range, or the BHA buckles.
    KernelError
        If the BHA is not the paper's, and the native engine cannot be used.
    """
    if bha.structure.is_of_the_paper:
        return Characteristic.of(scale(bha, bit), contact, saturated, inclination)
    if bha.body_point_positions:
        raise ParameterError(
            "bha.body_contact",
            "must be left out for roots and stability, which have no modes of a body on the wall; simulate shows them",
            len(bha.body_point_positions),
        )
    n, l1, weight = len(bha.stabilizer_positions), bha.length_scale, upright(inclination)
    clearances = tuple(0.0 if touches else LOOSE for touches in contact)
    answers = lie(
        replace(bha, stabilizer_clearances=clearances, end_deflection=0.0),
        np.vstack([np.eye(n) * l1, np.zeros(n)]),
        np.zeros(n + 1),
        np.append(np.zeros(n), weight),
        weight_on_bit=weight_on_bit,
        inclination=inclination,
    )
    *m, m_g = (answers.bit_moment / (bha.force_scale * l1)).tolist()
    *f, f_g = (answers.bit_force / bha.force_scale).tolist()
    s = [position / l1 for position in bha.stabilizer_positions]
    return Characteristic.made_of(s, (m, m_g), (f, f_g), epsilon(bit), saturated, axial=bha.axial_load)

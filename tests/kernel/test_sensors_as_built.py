"""Sensors on BHAs as they are built: against finite elements under the forces that the engine reports."""

from dataclasses import replace
from math import pi, sin
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beam_in_elements import Elements
from beams_as_built import CASES, built, reference_bha
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.binding import NativeDrilling

pytestmark = pytest.mark.usefixtures("kernel")
BIT = BitRock(10.0, 1.0, 0.03)
NO_SECTIONS: dict[str, Any] = {name: () for name in BottomHoleAssembly.__annotations__ if name.startswith("section_")}


def of_one_section(bha: BottomHoleAssembly) -> BottomHoleAssembly:
    """The BHA with its section at the bit all along it."""
    return replace(
        bha,
        section_lengths=bha.stabilizer_positions[-1:],
        section_distributed_weights=(bha.distributed_weight,),
        section_flexural_stiffnesses=(bha.flexural_stiffness,),
        section_outer_diameters=(0.0,),
    )


@given(
    bha=st.one_of(built(points=1), built(points=1).map(of_one_section), built(axial=True, points=1)),
    share=st.floats(0.0, 1.0),
    force=st.floats(-3e4, 3e4),
    inclination=st.floats(0.1, 1.5),
    curvature=st.floats(-2e-3, 2e-3),
    weight=st.floats(0.05, 0.4),
)
def test_sensors_are_those_of_finite_elements(
    bha: BottomHoleAssembly, share: float, force: float, inclination: float, curvature: float, weight: float
) -> None:
    """In a hole of constant curvature, where the offset of the bit's axis is −κ s²/2.

    A beam of one section without an axial load is given to the engine as the uniform one that it is.
    """
    reach = bha.stabilizer_positions[-1]
    # a fraction of the Euler load of the whole
    weight *= pi**2 * min(bha.section_flexural_stiffnesses) / reach**2
    positions = (0.0, round(share * reach, 2) if share * reach < reach - 0.02 else reach, reach)
    bha = replace(bha, sensor_positions=positions, sensor_body_clearances=(0.1, 0.1, 0.1))
    survey = Survey((-2 * reach, 0.0), (inclination - 2 * reach * curvature, inclination))
    uniform = len(bha.section_lengths) == 1 and not bha.axial_load
    given = replace(bha, **NO_SECTIONS) if uniform else bha
    run = NativeDrilling(given, BIT, survey, active_weight_on_bit=weight, rss_force=force)
    found = run.outputs()
    sine = sin(inclination if bha.axial_load else inclination - curvature * bha.length_scale / 2)
    elements = Elements(bha, weight, inclination, sine)
    elements.push(bha.rss_position, force)
    for i, s in enumerate(bha.stabilizer_positions[:-1], 1):
        elements.push(s, found[f"stabilizer_force[{i}]"])
    elements.push(bha.body_point_positions[0], found["body_contact_force"])
    bent = elements.solve(-curvature * reach**2 / 2)
    most, steepest = np.abs(bent[::2]).max(), np.abs(bent[1::2]).max()
    largest = max(abs(elements.moment(bent, s)) for s in elements.s)
    for i, s in enumerate(positions, 1):
        v, slope = bent[2 * elements.node(s) :][:2]
        offset = v - curvature * s**2 / 2
        assert found[f"sensor_inclination[{i}]"] == pytest.approx(inclination - slope, abs=1e-4 * steepest + 1e-9)
        assert found[f"sensor_clearance[{i}]"] == pytest.approx(0.1 - abs(offset), abs=1e-4 * most + 1e-9)
        expected = elements.moment(bent, s)
        assert found[f"sensor_bending_moment[{i}]"] == pytest.approx(expected, abs=1e-3 * largest + 1e-3)


@pytest.mark.parametrize("name", CASES)
def test_at_the_bit_a_sensor_is_the_bit_and_at_the_end_no_moment_is_left(name: str) -> None:
    case, bha = CASES[name], reference_bha(name)
    [[_, force, active, weight]] = case["schedule"][:1]
    run = NativeDrilling(
        replace(bha, sensor_positions=(0.0, bha.stabilizer_positions[-1])),
        BitRock(case["eta"], case["chi"], case["psi_star"]),
        Survey(tuple(case["hole_x"]), tuple(case["hole_inclination"])),
        active_weight_on_bit=active,
        rss_force=force,
        weight_on_bit=weight,
    )
    run.advance(5.0, force, active, weight_on_bit=weight)
    found = run.outputs()
    assert found["sensor_inclination[1]"] == found["bit_inclination"]
    assert found["sensor_bending_moment[1]"] == pytest.approx(found["bit_moment"], abs=1e-6)
    assert found["sensor_bending_moment[2]"] == pytest.approx(0.0, abs=1e-3)

"""The body of a BHA on the wall in space: by the contact problem as it is defined, the planar law, and symmetries."""

from dataclasses import replace
from math import cos, pi, sin
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from beam_in_elements import Elements
from beams_as_built import CASES, reference_bha, with_points
from boreprop import paper_case
from boreprop.arrays import Floats
from boreprop.core.errors import CannotContinue, ParameterError
from boreprop.core.options import Options
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.binding import NativeDrilling
from boreprop.kernel.space import SpaceDrilling
from space_runs import IN_SECTIONS, Outputs, direction, pair, place

pytestmark = pytest.mark.usefixtures("kernel")
PAPER = paper_case()
POINTS = [0.5 + 0.3 * k + 1e-3 for k in range(22)]


# the contact problem


def contact_problem(G: Floats, q: Floats, y: Floats) -> Floats:
    """The forces, (supports, 2), that minimise ½ Fᵀ(G ⊗ I)F + q·F + Σ y|F|, support by support until none moves."""
    F = np.zeros_like(q)
    for _ in range(100_000):
        before = F.copy()
        for i in range(len(q)):
            v = q[i] + G[i] @ F - G[i, i] * F[i]
            size = np.hypot(*v)
            F[i] = -max(1 - y[i] / size, 0.0) * v / G[i, i] if size > 0 else 0.0
        if np.abs(F - before).max() <= 1e-11 * np.abs(F).max():
            break
    return F


@settings(max_examples=8)
@given(
    force=st.floats(0.0, 6e4),
    toolface=st.floats(-pi, pi),
    inclination=st.floats(0.3, 1.5),
    curvature=st.tuples(st.floats(-4e-3, 4e-3), st.floats(-4e-3, 4e-3)),
    clearances=st.lists(st.floats(5e-3, 5e-2), min_size=3, max_size=3),
    axial=st.booleans(),
)
def test_contacts_are_those_of_the_contact_problem(
    force: float,
    toolface: float,
    inclination: float,
    curvature: tuple[float, float],
    clearances: list[float],
    axial: bool,
) -> None:
    """In a hole that has turned along an arc, with a beam of finite elements: e = −κ s²/2, in both directions."""
    azimuth, weight, reach, kappa = 0.4, 6e4, 24.0, np.array(curvature)
    bha = replace(
        IN_SECTIONS,
        stabilizer_positions=(3.0, 12.0, reach),
        section_lengths=(4.0, 20.0),
        end_deflection=0.0,
        axial_load=axial,
        body_point_positions=(7.5, 16.0, 20.0),
        body_point_clearances=tuple(clearances),
    )
    frame = Rotation.from_euler("ZY", [azimuth, inclination]).as_matrix()  # high, right, ahead
    back = frame @ Rotation.from_rotvec(40.0 * np.array([kappa[1], -kappa[0], 0.0])).as_matrix()[:, 2]
    survey = Survey((0.0, 40.0), (float(np.arccos(back[2])), inclination))
    azimuths = (float(np.arctan2(back[1], back[0])), azimuth)
    inputs: dict[str, Any] = {"active_weight_on_bit": 8e3, "rss_force": force, "weight_on_bit": weight * axial}
    row = SpaceDrilling(bha, BitRock(20.0, 1.0, 0.02), survey, azimuths, rss_toolface=toolface, **inputs).outputs()

    s = np.array([*bha.stabilizer_positions[:-1], *bha.body_point_positions])
    y = np.array([*bha.stabilizer_clearances, *clearances])
    first = Rotation.from_rotvec(1.5 * np.array([kappa[1], -kappa[0], 0.0])).as_matrix()[:, 2]  # of ⟨Θ⟩_1
    across = -frame.T[:2, 2] if axial else -(frame @ turned_frame(first))[2, :2]
    q, G = np.empty((5, 2)), np.empty((5, 5))
    for side, share in enumerate((cos(toolface), sin(toolface))):
        elements = Elements(bha, weight * axial, inclination, across[side])
        elements.push(bha.rss_position, force * share)
        bent = elements.solve(-kappa[side] * reach**2 / 2)
        q[:, side] = [bent[2 * elements.node(at)] - kappa[side] * at**2 / 2 for at in s]
    for j, at in enumerate(s):
        elements = Elements(bha, weight * axial, inclination, 0.0)
        elements.push(at, 1.0)
        G[:, j] = elements.solve(0.0)[[2 * elements.node(other) for other in s]]
    F = contact_problem(G, q, y)
    most = 1e-4 * np.abs(F).max() + 1e-2
    for i in (1, 2):
        assert pair(row, "stabilizer_force", i) == pytest.approx(F[i - 1], abs=most)
    largest = 2 + int(np.argmax(np.hypot(*F[2:].T)))
    if np.hypot(*F[largest]) > most:
        assert row["body_contact_position"] == pytest.approx(s[largest])
        assert pair(row, "body_contact_force") == pytest.approx(F[largest], abs=most)
        assert row["body_contact_force"] == pytest.approx(np.hypot(*F[largest]), abs=most)
        assert row["wall_distance"] == pytest.approx(0.0, abs=1e-12)
    gaps = y - np.hypot(*(q + G @ F).T)
    assert row["wall_distance"] == pytest.approx(max(gaps[2:].min(), 0.0), abs=1e-6)


def turned_frame(ahead: Floats) -> Floats:
    """The least turn that takes the third axis to a direction."""
    aside = np.cross([0.0, 0.0, 1.0], ahead)
    size = np.linalg.norm(aside)
    turned: Floats = Rotation.from_rotvec(aside / size * np.arcsin(size) if size > 0 else aside).as_matrix()
    return turned


# the planar law


def both(bha: BottomHoleAssembly, bit: BitRock, survey: Survey, **inputs: Any) -> tuple[NativeDrilling, SpaceDrilling]:
    options, azimuths = Options(relative_tolerance=1e-9), (0.3,) * len(survey.measured_depth)
    return (
        NativeDrilling(bha, bit, survey, options=options, **inputs),
        SpaceDrilling(bha, bit, survey, azimuths, options=options, **inputs),
    )


def same_in_both(flat: Outputs, row: Outputs) -> None:
    axis = [sin(flat["bit_inclination"]) * cos(0.3), sin(flat["bit_inclination"]) * sin(0.3)]
    assert direction(row, "bit")[:2] == pytest.approx(axis, abs=1e-7)
    assert row["wall_distance"] == pytest.approx(flat["wall_distance"], abs=1e-7)
    upward = row["body_contact_force_high"] if row["bit_inclination"] > 0.06 else np.inf
    for found in (abs(upward), row["body_contact_force"]):
        if np.isfinite(found):
            assert found == pytest.approx(abs(flat["body_contact_force"]), abs=0.1)
    if abs(flat["body_contact_force"]) > 0.1:
        assert row["body_contact_position"] == flat["body_contact_position"]


@pytest.mark.parametrize("name", ["fulcrum_ripples", "sections_rss"])
def test_the_references_are_drilled_as_in_the_plane(name: str) -> None:
    case = CASES[name]
    [_, force, active, weight] = case["schedule"][0]
    inputs = {"active_weight_on_bit": active, "rss_force": force, "weight_on_bit": weight}
    bit = BitRock(case["eta"], case["chi"], case["psi_star"])
    survey = Survey(tuple(case["hole_x"]), tuple(case["hole_inclination"]))
    planar, spatial = both(reference_bha(name), bit, survey, **inputs)
    for length in np.linspace(0.0, 6.0, 7).tolist():
        for run in (planar, spatial):
            run.advance(length, force, active, weight_on_bit=weight)
        same_in_both(planar.outputs(), spatial.outputs())
    assert spatial.statistics.events == planar.statistics.events


def test_a_body_that_comes_and_goes_in_a_ripple_does_so_as_in_the_plane() -> None:
    bha, seen = with_points(PAPER.bha, [0.5 + 0.1 * k + 1e-3 for k in range(66)], 0.01), set()
    planar, spatial = both(bha, PAPER.bit, PAPER.survey, active_weight_on_bit=PAPER.active_weight_on_bit)
    for length in np.linspace(0.1, 10.0, 100).tolist():
        for run in (planar, spatial):
            run.advance(length, 0.0, PAPER.active_weight_on_bit)
        same_in_both(planar.outputs(), spatial.outputs())
        seen.add(planar.outputs()["body_contact_force"] != 0)
    assert seen == {True, False}
    assert spatial.statistics.events == planar.statistics.events


# in three dimensions

TURNING = with_points(PAPER.bha, POINTS, 0.02)
SURVEY, AZIMUTHS = Survey((0.0, 6.0, 7.32), (0.5, 0.5, 0.52)), (1.0, 1.0, 1.03)


def turning(bha: BottomHoleAssembly = TURNING, turn: float = 0.0, **options: float) -> SpaceDrilling:
    return SpaceDrilling(
        bha,
        replace(PAPER.bit, walk_angle=0.2),
        SURVEY,
        tuple(azimuth + turn for azimuth in AZIMUTHS),
        active_weight_on_bit=PAPER.active_weight_on_bit,
        rss_force=6e3,
        rss_toolface=1.4,
        options=Options(**options),  # type: ignore[arg-type]
    )


def drill(run: SpaceDrilling, lengths: Floats | list[float]) -> list[Outputs]:
    found = []
    for length in lengths:
        run.advance(float(length), 6e3, PAPER.active_weight_on_bit, rss_toolface=1.4)
        found.append(run.outputs())
    return found


def test_a_turn_about_the_vertical_turns_the_hole() -> None:
    lengths = np.linspace(0.5, 12.0, 24)
    rows, others = (drill(turning(turn=turn, relative_tolerance=1e-9), lengths) for turn in (0.0, 2.0))
    turn = np.array([[cos(2.0), -sin(2.0), 0.0], [sin(2.0), cos(2.0), 0.0], [0.0, 0.0, 1.0]])
    for row, other in zip(rows, others, strict=True):
        assert place(other) == pytest.approx(turn @ place(row), abs=1e-8)
        assert pair(other, "body_contact_force") == pytest.approx(pair(row, "body_contact_force"), abs=1e-2)
    assert sum(abs(row["body_contact_force_right"]) > 100.0 for row in rows) > 3


def test_outputs_do_not_depend_on_where_the_bit_stops_and_a_saved_state_goes_on_to_the_same_bits() -> None:
    at_once, in_pieces, other = turning(), turning(), turning()
    drill(in_pieces, np.linspace(0.0, 5.0, 301))
    assert drill(at_once, [5.0])[0] == in_pieces.outputs()
    assert at_once.statistics == in_pieces.statistics
    other.restore(at_once.save())
    assert drill(other, [7.0, 9.0]) == drill(at_once, [7.0, 9.0])


@settings(max_examples=6)
@given(
    points=st.lists(st.integers(1, 68), min_size=1, max_size=20, unique=True).map(sorted),
    clearance=st.floats(5e-3, 4e-2),
)
def test_no_touch_is_missed_between_the_ends_of_steps(points: list[int], clearance: float) -> None:
    bha, lengths = with_points(PAPER.bha, [0.5 + 0.1 * k + 1e-3 for k in points], clearance), np.linspace(0.1, 4.0, 40)
    usual, fine = (
        drill(turning(bha, relative_tolerance=1e-8, largest_step=largest), lengths) for largest in (1.0, 0.02)
    )
    for row, expected in zip(usual, fine, strict=True):
        assert direction(row, "bit") == pytest.approx(direction(expected, "bit"), abs=1e-5)
        assert row["body_contact_force"] == pytest.approx(expected["body_contact_force"], abs=30.0)


def test_more_contacts_than_there_is_room_for_are_refused() -> None:
    bha = with_points(
        BottomHoleAssembly((1.5, 25.0, 60.0), (1e-3, 2e-3), 0.5, 400.0, 1.5e6),
        [2.0 + k + 1e-3 for k in range(54)],
        0.02,
    )
    with pytest.raises(CannotContinue, match="more than 26 supports touch the wall"):
        SpaceDrilling(bha, PAPER.bit, Survey((0.0, 60.0), (1.5, 1.5)), active_weight_on_bit=5e3)


@pytest.mark.parametrize(
    "stabilizers", [(40.0,), (20.0, 40.0), (10.0, 20.0, 30.0, 40.0), (2.0, 11.0, 18.0, 27.0, 40.0)]
)
def test_a_bha_bears_what_it_bears_without_its_stabilizers(stabilizers: tuple[float, ...]) -> None:
    """A clamped and hinged beam buckles under 4.4934² EI/ℓ²; held to no side it may be in a higher mode by far."""
    bha = BottomHoleAssembly(stabilizers, (0.0,) * len(stabilizers[1:]), 0.5, 0.0, 1e7, axial_load=True)
    with pytest.raises(ParameterError, match=r"^weight_on_bit: must be < .* in space, .* nearer to the bit") as refused:
        SpaceDrilling(bha, PAPER.bit, Survey((0.0,), (0.3,)), active_weight_on_bit=1e3, weight_on_bit=1e12)
    assert refused.value.problem
    assert refused.value.problem.limit == pytest.approx(4.493409458**2 * 1e7 / 40.0**2, rel=1e-5)

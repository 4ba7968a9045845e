"""The law in space against what shares no code with it: trajectories, a short program, closed forms, the planar law."""

from dataclasses import astuple, replace
from math import atan2, cos, degrees, pi, radians, sin
from typing import Any

import numpy as np
import pytest

from boreprop.case.paper import paper_case
from boreprop.core.errors import ParameterError
from boreprop.core.options import Options
from boreprop.core.quantities import ROCK
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.binding import NativeDrilling, available
from boreprop.kernel.space import SpaceDrilling
from reference.spatial import CASES, Drilling, Push, read_reference, system_of
from space_runs import IN_SECTIONS, TURNING, SpatialCase, Vector, direction, pair, place, referred, rows_of

pytestmark = pytest.mark.skipif(not available(), reason="the kernel is not built")

CALM = [name for name in CASES if CASES[name]["growth"] < 10]
SPIRALS = [name for name in CASES if name not in CALM]
PRINTED = 6e-11  # rounding of directions in the references


def errors(name: str, tolerance: float) -> dict[str, float]:
    """The largest errors of directions, place and forces over the rows of a reference."""
    rows = read_reference(name)
    found = dict.fromkeys(("bit", "borehole", "place", "force"), 0.0)
    for row, reference in zip(rows_of(name, rows["xi"], relative_tolerance=tolerance), rows, strict=True):
        for what, letter in (("bit", "d"), ("borehole", "T")):
            expected = np.array([reference[f"{letter}_{axis}"] for axis in "ned"])
            found[what] = max(found[what], abs(direction(row, what) - expected).max())
        expected = np.array([reference[f"x_{axis}"] for axis in "ned"])
        found["place"] = max(found["place"], abs(place(row) - expected).max())
        for i in range(1, len(CASES[name]["y_star"]) + 1):
            off = abs(row[f"stabilizer_force[{i}]"] - reference[f"F{i}"])
            found["force"] = max(found["force"], off)
    return found


@pytest.mark.parametrize("name", CALM)
def test_a_hole_in_space_is_that_of_the_reference(name: str) -> None:
    usual, tight = errors(name, 1e-7), errors(name, 1e-9)
    assert max(usual["bit"], usual["borehole"]) < 2e-5
    assert max(tight["bit"], tight["borehole"]) < 2e-7
    assert usual["place"] < 1e-5
    assert tight["force"] < 1e-7


@pytest.mark.parametrize("name", SPIRALS)
def test_a_spiral_is_that_of_the_reference_as_far_as_its_errors_grow(name: str) -> None:
    usual, tight = errors(name, 1e-7), errors(name, 1e-9)
    assert max(usual["bit"], usual["borehole"]) < 1e-3
    assert max(tight["bit"], tight["borehole"]) < 1e-5


def winding(xi: Vector, north: Vector, east: Vector) -> tuple[float, float]:
    """Pitch and radius of a spiral down a vertical hole by the directions of its last 10 ℓ₁."""
    last = xi > xi[-1] - 10.0
    T = (north + 1j * east)[last]
    omega = float(np.polyfit(xi[last], np.unwrap(np.angle(T)), 1)[0])
    return 2 * pi / omega, float(abs(T).mean() / abs(omega))


@pytest.mark.parametrize("name", SPIRALS)
def test_pitch_and_radius_of_a_spiral_are_those_of_the_reference(name: str) -> None:
    expected = read_reference(name)
    found = np.array([direction(row, "borehole") for row in rows_of(name, expected["xi"], relative_tolerance=1e-7)])
    ours = winding(expected["xi"], found[:, 0], found[:, 1])
    assert ours == pytest.approx(winding(expected["xi"], expected["T_n"], expected["T_e"]), rel=1e-4)
    assert abs(ours[0]) == pytest.approx(1.394, rel=5e-3)  # and it does wind


def test_the_error_falls_with_the_tolerance_down_to_what_the_reference_is_printed_with() -> None:
    loose, usual, tight = (errors("long_turn", tolerance)["bit"] for tolerance in (1e-6, 1e-8, 1e-10))
    assert usual < loose / 20
    assert tight < max(usual / 20, 4 * PRINTED)


def test_the_error_falls_nearly_with_the_sixth_power_of_the_step_where_all_is_smooth() -> None:
    """No contact, no saturation, and kinks where steps end; the frame turns, with the weight and the pads in it."""
    smooth = SpatialCase(y_star=(1.0,), w=5e-3, eta_pi=0.3, psi_star=0.5, walk=0.3, force=8e-3, toolface=1.2)
    smooth = replace(smooth, inclination=(0.5, 0.5, 0.51), azimuth=(1.0,) * 3)
    ends = []
    for h, tolerance in ((1.0, 1e-12), (1 / 8, 1e-2), (1 / 32, 1e-10)):
        layers = 16.0 if h == 1 else 1e9
        [row] = smooth.rows([4.0], largest_step=h, layers=layers, relative_tolerance=tolerance)
        ends.append(np.concatenate([direction(row, "bit"), place(row)]))
    exact, coarse, fine = ends
    assert abs(coarse - exact).max() > 4**5.5 * abs(fine - exact).max()


# what the short program follows too


@pytest.mark.parametrize("reference", ["gravity", "north"])
def test_a_toolface_is_followed_within_the_steps_as_the_short_program_does(reference: str) -> None:
    given = replace(referred("four_stabilizers"), force=0.004, toolface=1.1, reference=reference)
    push = Push(0.0, given.force, given.toolface, reference, follows=True)
    drilling = Drilling(replace(system_of("four_stabilizers"), pushes=(push,)), 0.01)
    while drilling.count < 300:
        drilling.take_step()
    row, expected = given.rows([3.0], relative_tolerance=1e-9)[0], drilling.row()
    assert abs(direction(row, "bit") - expected.d).max() < 2e-6
    assert abs(place(row) - expected.R).max() < 2e-6


def test_a_toolface_against_gravity_leads_elsewhere_than_one_that_the_frame_holds() -> None:
    """Held in the frame it ends at 96.5° and 94.2°; held against gravity all the way near 51.5° and 146°."""
    turn = replace(referred("long_turn"), toolface=pi / 2, reference="gravity")
    for reference, inclination, azimuth in (("gravity", 51.5, 146.0), ("frame", 96.5, 94.2)):
        [row] = replace(turn, reference=reference).rows([60.0])
        assert degrees(row["borehole_inclination"]) == pytest.approx(inclination, abs=0.3)
        assert degrees(row["borehole_azimuth"]) == pytest.approx(azimuth, abs=0.3)


# closed forms


def test_a_spiral_ends_as_its_closed_form_says() -> None:
    """ω and |T| of the equations for a relative equilibrium, with the paper's BHA and ψ* = 2°, to their printed digits.

    The axis of the spiral is inclined by a tenth of a degree, and very slowly becomes vertical.
    """
    omega, tilt_of_hole = 4.50697, radians(1.511)
    rows = referred("spiral").rows(np.linspace(100.0, 100.0 + 2 * pi / omega, 65).tolist(), relative_tolerance=1e-9)
    offsets = np.array([place(row) for row in rows])
    offsets = offsets[:-1] - np.outer(np.arange(64) / 64, offsets[-1] - offsets[0])
    radius = np.sqrt(((offsets - offsets.mean(axis=0)) ** 2).sum(axis=1))
    assert radius == pytest.approx(np.full(64, tilt_of_hole / omega), rel=4e-4)
    directions = np.array([direction(row, "borehole") for row in rows])
    axis = directions[:-1].mean(axis=0)
    assert np.arccos(directions @ axis / np.sqrt(axis @ axis)) == pytest.approx(np.full(65, tilt_of_hole), rel=4e-4)
    assert directions[-1] == pytest.approx(directions[0], abs=1e-4 * tilt_of_hole + 1e-5)


def test_without_weight_and_contact_a_constant_force_bends_a_circle_to_its_side() -> None:
    """Each toolface gives the planar curvature, in its own plane."""
    given = SpatialCase(s=(1.0,), y_star=(), w=0.0, eta_pi=0.3, psi_star=0.1, force=4e-3, reference="frame")
    given = replace(given, stations=(-1.0, 0.0), inclination=(0.6, 0.6), azimuth=(0.4, 0.4))
    rows = [replace(given, toolface=toolface).rows([20.0])[0] for toolface in (0.0, 1.0, pi / 2, 4.0)]
    curvatures = [row["borehole_curvature"] for row in rows]
    assert curvatures == pytest.approx([curvatures[0]] * 4, rel=1e-7)
    start = np.array([sin(0.6) * cos(0.4), sin(0.6) * sin(0.4), cos(0.6)])
    high = np.array([cos(0.6) * cos(0.4), cos(0.6) * sin(0.4), -sin(0.6)])
    right = np.cross(start, high)
    for row, toolface in zip(rows, (0.0, 1.0, pi / 2, 4.0), strict=True):
        out_of_plane = np.cross(start, cos(toolface) * high + sin(toolface) * right)
        assert direction(row, "bit") @ out_of_plane == pytest.approx(0.0, abs=1e-12)


# the planar law


def test_a_planar_case_is_drilled_as_in_the_plane_and_stays_there_exactly() -> None:
    case, options = paper_case(), Options(relative_tolerance=1e-9)
    planar = NativeDrilling(
        case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit, options=options
    )
    spatial = SpaceDrilling(
        case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit, options=options
    )
    for length in np.arange(1.0, 60.0, 1.7):
        planar.advance(length, 0.0, case.active_weight_on_bit)
        spatial.advance(length, 0.0, case.active_weight_on_bit)
        flat, row = planar.outputs(), spatial.outputs()
        signed = row["bit_inclination"] * cos(row["bit_azimuth"])
        assert signed == pytest.approx(flat["bit_inclination"], abs=1e-7)
        assert row["north"] == pytest.approx(flat["displacement"], abs=1e-7 * 3.66)
        assert row["stabilizer_force_high[1]"] == pytest.approx(flat["stabilizer_force[1]"], abs=1e-7 * 1.6e6)
        sideways = ("east", "bit_tilt_right", "bit_lateral_force_right", "stabilizer_force_right[1]")
        assert [row[name] for name in sideways] == [0.0] * 4
    assert spatial.statistics.events == planar.statistics.events


def test_sections_and_a_load_along_the_beam_count_as_in_the_plane() -> None:
    bit, survey = BitRock(20.0, 1.0, 0.02), Survey((0.0, 17.0), (0.7, 0.72))
    inputs: dict[str, Any] = {"active_weight_on_bit": 8e3, "rss_force": 4e3, "weight_on_bit": 8e4}
    options = Options(relative_tolerance=1e-9)
    planar = NativeDrilling(IN_SECTIONS, bit, survey, options=options, **inputs)
    spatial = SpaceDrilling(IN_SECTIONS, bit, survey, (0.3, 0.3), options=options, **inputs)
    for run in (planar, spatial):
        run.advance(90.0, 4e3, 8e3, weight_on_bit=8e4)
    flat, row = planar.outputs(), spatial.outputs()
    for name in ("bit_inclination", "borehole_inclination", "true_vertical_depth", "displacement"):
        assert row[name] == pytest.approx(flat[name], abs=1e-7)
    assert row["borehole_azimuth"] == pytest.approx(0.3, abs=1e-12)


# symmetries


def test_a_turn_about_the_vertical_turns_the_hole() -> None:
    turned = replace(TURNING, azimuth=tuple(a + 2.0 for a in TURNING.azimuth))
    [row], [other] = (case.rows([15.0], relative_tolerance=1e-9) for case in (TURNING, turned))
    turn = np.array([[cos(2.0), -sin(2.0), 0.0], [sin(2.0), cos(2.0), 0.0], [0.0, 0.0, 1.0]])
    assert place(other) == pytest.approx(turn @ place(row), abs=1e-9)
    assert direction(other, "bit") == pytest.approx(turn @ direction(row, "bit"), abs=1e-9)
    assert pair(other, "stabilizer_force", 2) == pytest.approx(pair(row, "stabilizer_force", 2), abs=1e-9)


def test_a_mirror_reverses_walk_and_toolface() -> None:
    mirrored = replace(TURNING, azimuth=tuple(-a for a in TURNING.azimuth), walk=-TURNING.walk, toolface=-0.8)
    [row], [other] = (case.rows([15.0], relative_tolerance=1e-9) for case in (TURNING, mirrored))
    assert place(other) == pytest.approx(place(row) * [1.0, -1.0, 1.0], abs=1e-9)
    assert pair(other, "bit_tilt") == pytest.approx(pair(row, "bit_tilt") * [1.0, -1.0], abs=1e-9)


def test_without_weight_all_that_is_small_may_be_larger_by_one_factor() -> None:
    small = replace(
        TURNING,
        w=0.0,
        reference="frame",
        inclination=(0.0, 0.0, 1e-5, 2e-5),
        azimuth=(1.0, 1.0, 1.2, 1.2),
        y_star=(8e-7, 1.5e-6),
        psi_star=1e-5,
        force=5e-6,
    )
    factor = 10.0
    large = replace(
        small,
        inclination=tuple(factor * i for i in small.inclination),
        y_star=tuple(factor * y for y in small.y_star),
        psi_star=factor * small.psi_star,
        force=factor * small.force,
    )
    [row] = small.rows([12.0], relative_tolerance=1e-12)
    [other] = large.rows([12.0], relative_tolerance=1e-11)
    for name in ("bit_inclination", "stabilizer_force[1]", "stabilizer_force[2]", "bit_tilt", "displacement"):
        assert other[name] == pytest.approx(factor * row[name], rel=1e-4)


# the two discs


@pytest.mark.parametrize("walk", [0.0, 0.3, -1.2])
def test_contacts_and_tilt_keep_to_their_discs_all_the_way(walk: float) -> None:
    case = replace(TURNING, walk=walk, psi_star=4e-3)
    seen = set()
    for row in case.rows(np.linspace(0.0, 20.0, 400).tolist()):
        seen.add((row["stabilizer_contact[1]"], row["stabilizer_contact[2]"], row["bit_tilt_saturation"]))
        for i, y in enumerate(case.y_star, 1):
            delta, force = pair(row, "stabilizer_deflection", i), pair(row, "stabilizer_force", i)
            size = np.hypot(*force)
            assert np.hypot(*delta) <= y + 1e-13
            assert force @ delta == pytest.approx(-y * size, abs=1e-13)
        psi, F_0 = pair(row, "bit_tilt"), pair(row, "bit_lateral_force")
        turned = np.array([[cos(walk), -sin(walk)], [sin(walk), cos(walk)]]) @ psi
        gauge = F_0 - case.eta_pi * turned  # on the gauge, along ψ
        assert np.hypot(*psi) <= case.psi_star + 1e-13
        assert gauge[0] * psi[1] - gauge[1] * psi[0] == pytest.approx(0.0, abs=1e-13)
        assert gauge @ psi >= -1e-13
        assert gauge @ psi == pytest.approx(np.hypot(*gauge) * case.psi_star, abs=1e-12)
    assert len(seen) > 2


# life


def test_outputs_do_not_depend_on_where_the_bit_stops() -> None:
    at_once, in_pieces = TURNING.begin(), TURNING.begin()
    for xi in np.linspace(0.0, 9.0, 1001):
        TURNING.advance(in_pieces, float(xi))
        in_pieces.outputs()
    TURNING.advance(at_once, 9.0)
    assert in_pieces.outputs() == at_once.outputs()
    assert in_pieces.statistics == at_once.statistics


def test_a_saved_state_goes_on_to_the_same_bits() -> None:
    run, other = TURNING.begin(), TURNING.begin()
    TURNING.advance(run, 4.3)
    state = run.save()
    other.restore(state)
    assert (other.save() == state).all()
    for each in (run, other):
        TURNING.advance(each, 9.0, rss_toolface=2.0)
    assert other.outputs() == run.outputs()


def test_a_state_whose_frame_is_none_is_refused() -> None:
    run = TURNING.begin()
    TURNING.advance(run, 4.3)
    state = run.save()
    here = run.outputs()
    # the frame is where each number lies between −1 and 1 and three in a row make a unit vector
    found = [k for k in range(len(state) - 8) if is_frame(state[k : k + 9].reshape(3, 3))]
    assert found
    state[found[0]] += 1e-6
    with pytest.raises(ParameterError, match="must be a valid saved state"):
        run.restore(state)
    assert run.outputs() == here


def is_frame(matrix: Vector) -> bool:
    return bool(abs(matrix @ matrix.T - np.eye(3)).max() < 1e-12)


def test_slopes_of_force_weight_and_rock_are_many_small_steps_of_them() -> None:
    given = replace(TURNING, eta_pi=0.3)
    ramp, stairs = given.begin(relative_tolerance=1e-9), given.begin(relative_tolerance=1e-9)
    aim: dict[str, Any] = {"rss_toolface": given.toolface, "toolface_reference": given.reference}
    own, slopes = astuple(ramp.bit)[:3], (0.2, 0.01, -7e-3)
    slope_of_rock: Any = {f"{name}_slope": slope for name, slope in zip(ROCK, slopes, strict=True)}
    ramp.advance(4.0, 2e-3, 0.3, rss_force_slope=1e-3, active_weight_on_bit_slope=0.02, **slope_of_rock, **aim)
    for start in np.arange(0.0, 4.0, 0.01):
        middle = start + 0.005
        eta, chi, limit = np.add(own, np.multiply(slopes, middle)).tolist()
        bit = BitRock(eta, chi, limit, given.walk)
        stairs.advance(start + 0.01, 2e-3 + 1e-3 * middle, 0.3 + 0.02 * middle, bit=bit, **aim)
    assert direction(stairs.outputs(), "bit") == pytest.approx(direction(ramp.outputs(), "bit"), abs=2e-6)


def test_rows_lie_anywhere_on_a_ramp_of_the_rock_in_space() -> None:
    """Where the tilt meets a limit that closes in on it, too."""
    slopes: Any = {"bit_tilt_limit_slope": -8e-3, "lateral_steering_resistance_slope": -0.15}
    runs = [replace(TURNING, eta_pi=0.3).begin() for _ in range(2)]
    aim: dict[str, Any] = {"rss_toolface": 1.0, "toolface_reference": "frame"}
    own = runs[0].bit
    for run, stops in zip(runs, ([4.0], np.linspace(0.0, 4.0, 38)[1:].tolist()), strict=True):
        start = 0.0
        for stop in stops:
            limit = own.tilt_limit - 8e-3 * start
            bit = replace(own, lateral_steering_resistance=1.0 - 0.15 * start, tilt_limit=limit)
            run.advance(stop, 5e-3, 0.3, bit=bit, **slopes, **aim)
            start = stop
    assert runs[0].outputs()["bit_tilt_saturation"] == 1
    assert runs[0].outputs() == pytest.approx(runs[1].outputs(), rel=1e-9, abs=1e-11)
    assert runs[0].statistics == runs[1].statistics


# the existing hole


def test_the_existing_hole_turns_along_great_circles() -> None:
    """Without weight, force and contact the BHA that follows a planar arc drills on in the plane of that arc."""
    arc = [np.array([cos(a), sin(a), 0.0]) for a in np.linspace(0.0, 0.3, 7)]  # about an axis that is then tilted
    tilt = np.array([[1.0, 0.0, 0.0], [0.0, cos(0.7), -sin(0.7)], [0.0, sin(0.7), cos(0.7)]])
    directions = [tilt @ d for d in arc]
    normal = tilt @ [0.0, 0.0, 1.0]
    case = replace(
        TURNING,
        w=0.0,
        force=0.0,
        walk=0.0,
        y_star=(0.1, 0.1),
        stations=tuple(np.linspace(-4.2, 0.0, 7).tolist()),
        inclination=tuple(float(np.arccos(d[2])) for d in directions),
        azimuth=tuple(atan2(d[1], d[0]) for d in directions),
    )
    for row in case.rows([0.0, 2.0, 6.0]):
        assert direction(row, "borehole") @ normal == pytest.approx(0.0, abs=1e-12)


def test_in_a_vertical_hole_the_frame_faces_where_the_last_bend_leads() -> None:
    """A force in the frame's first direction then bends the hole on to there."""
    case = replace(TURNING, w=0.0, walk=0.0, force=3e-3, toolface=0.0, reference="frame")
    bent = replace(case, inclination=(0.02, 0.02, 0.01, 0.0), azimuth=(2.0,) * 4)
    straight = replace(case, inclination=(0.0,) * 4, azimuth=(2.0,) * 4)
    for case, azimuth in ((bent, 2.0 - pi), (straight, 2.0)):
        [row] = case.rows([10.0])
        assert row["bit_azimuth"] == pytest.approx(azimuth, abs=1e-9)


# refusals


def test_what_cannot_be_in_space_is_refused() -> None:
    survey = Survey((0.0, 1.0), (0.1, 0.1))
    plain = BottomHoleAssembly((1.0, 2.0), (1e-3,), 0.2, 1e-3, 1 / 3)
    with pytest.raises(ParameterError, match="azimuth: must hold 2 values, one a station, got 3"):
        SpaceDrilling(plain, BitRock(1.0, 0.1, 0.03), survey, (0.0, 0.1, 0.2), active_weight_on_bit=0.01)
    with pytest.raises(ParameterError, match="toolface_reference: must be gravity or north or frame, got 'up'"):
        SpatialCase(reference="up").begin()
    with pytest.raises(ParameterError, match="rss_toolface: must be a finite number, got nan"):
        SpatialCase(toolface=float("nan")).begin()

"""Spirals in closed form: against numbers of another program, simulations in space, and the symmetries of the model."""

from dataclasses import replace
from functools import cache
from math import degrees, inf, isnan, pi, radians

import numpy as np
import pytest
from scipy.optimize import fsolve

from boreprop.analysis.spiral.closed_form import Search, Spiral, Winding, spiral
from boreprop.analysis.spiral.turning import MU, OMEGA, theta
from boreprop.arrays import Floats
from boreprop.case.case import Case
from boreprop.core.beam import Beam
from boreprop.core.errors import ParameterError
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly, scale
from boreprop.kernel.binding import available
from boreprop.kernel.space import SpaceDrilling
from reference.spatial import Drilling, System, tilted
from spirals import paper_spiral

BEAM = Beam(scale(paper_spiral().bha, paper_spiral().bit))
STATIONS = 801  # of an existing hole that spirals, over the BHA: chords are off by 1e-6 of its inclination


@cache
def paper() -> Spiral:
    return spiral(paper_spiral())


def search(case: Case, walk: float | None = None) -> Search:
    return Search(case, case.bit.walk_angle if walk is None else walk)


def exists(case: Case, *, left: bool = False) -> bool:
    walk = -case.bit.walk_angle if left else case.bit.walk_angle
    return search(case, walk).at(case.eta_pi).own is not None


def winding(case: Case) -> Winding:
    own = search(case)
    x = own.at(case.eta_pi).own
    assert x is not None
    return own.winding(x)


def three_stabilizers(walk_deg: float = 12.0) -> Case:
    bha = BottomHoleAssembly((3.66, 6.9, 11.7), (4e-3, 6e-3), 0.6, 1080.0, 7.2e6)
    case = replace(paper_spiral(walk_deg=walk_deg), bha=bha)
    return replace(case, bit=replace(case.bit, angular_steering_resistance=2.0), active_weight_on_bit=4e3)


def test_the_paper_case_winds_as_a_program_of_its_own_says() -> None:
    found = paper()
    assert found.pitch == pytest.approx(2 * pi / 4.50697 * 3.66, rel=1e-6)
    assert degrees(found.hole_inclination) == pytest.approx(1.511, abs=5e-4)
    assert found.radius == pytest.approx(5.85e-3 * 3.66, rel=1e-3)
    assert found.bit_tilt == pytest.approx(radians(2.0))
    assert found.stable


@pytest.mark.parametrize(("eta_pi", "inclination_deg"), [(0.01, 0.235), (0.05, 0.287), (0.10, 0.515), (0.13, 1.30)])
def test_the_edge_of_the_paper_case_is_the_published_one(eta_pi: float, inclination_deg: float) -> None:
    own = search(paper_spiral(eta_pi))
    found = own.at(eta_pi).edge
    assert found is not None
    edge = own.winding(found)
    assert degrees(edge.hole_inclination) == pytest.approx(inclination_deg, abs=6e-3 if eta_pi > 0.1 else 6e-4)
    assert not edge.stable


def test_below_a_tilt_limit_there_is_no_spiral() -> None:
    least = paper().least_tilt_limit
    assert degrees(least) == pytest.approx(0.236, abs=5e-4)
    assert exists(paper_spiral(tilt_limit_deg=degrees(least) * 1.001))
    below = spiral(paper_spiral(tilt_limit_deg=degrees(least) * 0.999))
    assert not below.exists
    assert isnan(below.pitch)
    assert below.edge is None


def test_above_a_clearance_there_is_no_spiral() -> None:
    widest = paper().widest_clearance / 3.66
    assert exists(paper_spiral(clearance=0.999 * widest))
    assert not exists(paper_spiral(clearance=1.001 * widest))


@pytest.mark.parametrize("walk_deg", [0.0, -10.0])
def test_the_range_of_eta_pi_is_where_spirals_are(walk_deg: float) -> None:
    own = search(paper_spiral(walk_deg=walk_deg))
    lowest, highest = own.eta_pi_range(own.at(0.01).own)
    assert lowest == 0.0
    assert own.at(0.9999 * highest).own is not None
    assert own.at(1.0001 * highest).own is None
    beyond = search(paper_spiral(1.0001 * highest, walk_deg=walk_deg))
    assert beyond.eta_pi_range(None)[1] == pytest.approx(highest, rel=1e-3)


@pytest.mark.parametrize(("walk_deg", "end"), [(0.0, 0.132702), (10.0, 0.165559), (20.0, 0.202379)])
def test_the_spiral_ends_where_its_equations_say_that_the_gauge_lets_go(walk_deg: float, end: float) -> None:
    """The five equations of two stabilizers by MINPACK: μ changes its sign there, and the two are within 1e-6."""
    case = paper_spiral(walk_deg=walk_deg)
    own = search(case)
    highest = own.eta_pi_range(own.at(case.eta_pi).own)[1]
    start = [4.6, 0.027, -0.0076, -0.0056, 0.0]  # ω, |T|, ϑ, μ
    below, there, above = (
        fsolve(five_equations, start, args=(share * highest, radians(walk_deg)), xtol=1e-12)
        for share in (0.99, 1.0, 1.01)
    )
    assert below[4] > 1e-4
    assert there[4] == pytest.approx(0.0, abs=1e-7)
    assert above[4] < -1e-4
    assert highest == pytest.approx(end, abs=1e-6)


def five_equations(x: Floats, eta_pi: float, walk: float) -> Floats:
    """The equations of docs/model.md for the paper's beam, y* = 1e-3 and ψ* = 2°, with K(1 − y*/|q|) for the wall."""
    omega, T, bit, mu = x[0], x[1], complex(x[2], x[3]), x[4]
    beam, s = BEAM, np.array([1.0, 2.0])
    B = (1 - np.exp(-1j * omega * s)) / (1j * omega)
    e, g = B * T - s * bit, B[0] * T
    q = e[0] + beam.delta_e[0] * e[1] + beam.delta_g[0] * g
    F = -(1 - 1e-3 / abs(q)) / beam.K_inv[0][0] * q
    M = beam.M_e * e[1] + beam.M_F[0] * F + beam.M_g * g
    F_0 = beam.F0_e * e[1] + beam.F0_F[0] * F + beam.F0_g * g
    moment, force = M - 0.1j * omega * eta_pi * bit, F_0 - (eta_pi * np.exp(1j * walk) + mu) * (bit - T)
    return np.array([moment.real, moment.imag, force.real, force.imag, abs(bit - T) - radians(2.0)])


def test_a_spiral_is_a_steady_state_of_a_simulation_in_space() -> None:
    for case in (paper_spiral(0.1, walk_deg=5.0), three_stabilizers()):
        own = search(case)
        x = own.at(case.eta_pi).own
        assert x is not None
        found = own.winding(x)
        direction = found.hole_inclination * np.exp(1j * x[OMEGA] * np.linspace(-own.turning.s[-1], 0.0, STATIONS))
        bit = np.array([found.hole_inclination * theta(x)]).view(float)
        drilling = Drilling(existing(own, direction, tilted(bit)), 0.002)
        drilling.theta = bit
        row = drilling.row()
        np.testing.assert_allclose(row.Theta, [found.hole_inclination, 0.0], atol=1e-4 * found.hole_inclination)
        forces = np.hypot(*row.F.T) * case.bha.force_scale
        np.testing.assert_allclose(forces, found.stabilizer_force, rtol=1e-3)
        for _ in range(100):
            drilling.take_step()
        turned = found.hole_inclination * np.exp(0.2j * x[OMEGA])
        np.testing.assert_allclose(drilling.row().Theta, [turned.real, turned.imag], atol=1e-3 * found.hole_inclination)


@pytest.mark.skipif(not available(), reason="the kernel is not built")
@pytest.mark.parametrize("walk_deg", [0.0, 5.0])
def test_a_simulation_that_starts_on_a_spiral_keeps_its_pitch_and_radius(walk_deg: float) -> None:
    """Its inclination is small, as the closed form takes it: a radius is less by a sixth of the square of that."""
    case = paper_spiral(0.05, tilt_limit_deg=0.5, walk_deg=walk_deg, clearance=2.5e-4)
    found = spiral(case)
    turns, places = np.arange(33) / 32, []
    depth = np.linspace(0.0, case.bha.stabilizer_positions[-1], 41)
    run = SpaceDrilling(
        case.bha,
        case.bit,
        Survey(tuple(depth), (found.hole_inclination,) * 41),
        tuple(2 * np.pi * (depth - depth[-1]) / found.pitch),
        active_weight_on_bit=case.active_weight_on_bit,
    )
    for turn in 8 + turns:
        run.advance(float(turn * found.pitch), 0.0, case.active_weight_on_bit)
        places.append([run.outputs()[name] for name in ("north", "east")])
    ahead = np.array(places) - np.outer(turns, np.array(places[-1]) - places[0])
    around = (ahead[:-1] - ahead[:-1].mean(axis=0)) @ [1.0, 1.0j]
    assert abs(around) == pytest.approx(np.full(32, found.radius), rel=1e-4)
    angles = np.unwrap(np.angle(around))
    assert angles[-1] - angles[0] == pytest.approx(2 * np.pi * 31 / 32, rel=1e-4)


def existing(own: Search, direction: np.ndarray, frame: np.ndarray) -> System:
    case = own.case
    scaled = scale(case.bha, replace(case.bit, walk_angle=0.0))
    return System(
        s=scaled.s,
        y_star=scaled.y_star,
        Delta=scaled.Delta,
        w=scaled.w,
        eta_pi=case.eta_pi,
        epsilon=scaled.epsilon,
        psi_star=scaled.psi_star,
        walk=case.bit.walk_angle,
        stations=np.linspace(-scaled.s[-1], 0.0, len(direction)),
        directions=np.column_stack([direction.real, direction.imag]),
        frame=frame,
    )


def test_a_bit_winds_to_the_side_to_which_it_walks_and_the_opposite_walk_gives_the_mirror_image() -> None:
    right, left = spiral(paper_spiral(walk_deg=8.0)), spiral(paper_spiral(walk_deg=-8.0))
    assert (right.handedness, left.handedness, paper().handedness) == ("right", "left", "either")
    assert replace(left, handedness="right") == right


def test_twice_the_clearance_and_tilt_limit_wind_twice_as_wide() -> None:
    once, twice = paper(), spiral(paper_spiral(tilt_limit_deg=4.0, clearance=2e-3))
    assert twice.pitch == pytest.approx(once.pitch)
    assert twice.radius == pytest.approx(2 * once.radius)
    assert twice.stabilizer_force == pytest.approx([2 * force for force in once.stabilizer_force])
    assert twice.growth == pytest.approx(once.growth, rel=1e-6)


def test_a_stabilizer_that_never_touches_changes_nothing() -> None:
    """Without weight, which acts at the mean inclination over ℓ₁; χ is measured in ℓ₁²."""
    two = paper_spiral(walk_deg=4.0)
    two = replace(two, bha=replace(two.bha, distributed_weight=0.0))
    bha = BottomHoleAssembly((2.0, 3.66, 7.32), (0.5, *two.bha.stabilizer_clearances), 0.6, 0.0, 7.2e6)
    resistance = two.bit.angular_steering_resistance * (3.66 / 2.0) ** 2
    three = replace(two, bha=bha, bit=replace(two.bit, angular_steering_resistance=resistance))
    found, expected = winding(three), winding(two)
    assert found.pitch == pytest.approx(expected.pitch)
    assert found.radius == pytest.approx(expected.radius)
    assert found.stabilizer_force == pytest.approx((0.0, *expected.stabilizer_force))
    assert found.growth == pytest.approx(expected.growth, abs=1e-7)


def test_without_clearance_any_tilt_limit_will_do() -> None:
    found = spiral(paper_spiral(clearance=0.0))
    assert found.exists
    assert found.edge is None
    assert (found.least_tilt_limit, found.widest_clearance) == (0.0, inf)


def test_a_single_stabilizer_has_no_edge() -> None:
    case = replace(paper_spiral(), bha=BottomHoleAssembly((3.66,), (), 0.6, 1080.0, 7.2e6))
    found: Spiral = spiral(case)
    assert found.edge is None
    assert found.stabilizer_force == ()


def test_the_hole_and_the_force_of_the_case_have_no_part() -> None:
    case = paper_spiral()
    inclined = replace(case, survey=replace(case.survey, inclination=(0.5,) * len(case.survey.inclination)))
    assert spiral(inclined) == paper()


@pytest.mark.parametrize(
    ("case", "handedness", "message"),
    [
        (paper_spiral(5e-5), None, "eta_pi: must be >= 0.0001, got"),
        (paper_spiral(), "up", "handedness: must be right or left, got 'up'"),
    ],
)
def test_what_cannot_be_is_refused(case: Case, handedness: str | None, message: str) -> None:
    with pytest.raises(ParameterError, match=f"^{message}"):
        spiral(case, handedness)


@pytest.mark.parametrize("seed", [0, 1, 3, 4])
def test_random_systems_have_spirals_that_obey_the_laws(seed: int) -> None:
    """Walls push inwards and are touched; the gauge pushes inwards; nothing is beyond its limit."""
    random = np.random.default_rng(seed)
    n = int(random.integers(2, 5))
    positions = np.cumsum(random.uniform(2.5, 4.5, n))
    clearances = random.uniform(1e-3, 8e-3, n - 1)
    bha = BottomHoleAssembly(tuple(positions.tolist()), tuple(clearances.tolist()), 0.5, 1000.0, 1e7)
    bit = BitRock(10.0, float(random.uniform(0.2, 2.0)), 0.05, float(random.uniform(-0.3, 0.3)))
    case = replace(paper_spiral(), bha=bha, bit=bit, active_weight_on_bit=0.01 / 10.0 * bha.force_scale)
    own = search(case)
    x = own.at(case.eta_pi).own
    assert x is not None
    touched = own.turning.contact(x)
    delta = own.turning.bend(own.turning.offsets(x), theta(x)) + own.turning.beam.K_inv @ touched.F
    allowed = x[4] * own.turning.y
    assert (abs(delta) <= allowed * (1 + 1e-9)).all()
    np.testing.assert_allclose((delta.conj() * touched.F).real, -allowed * abs(touched.F), atol=1e-10)
    assert x[MU] >= 0
    assert abs(own.turning.residual(x).value).max() < 1e-11


@pytest.mark.parametrize(("around", "there"), [(0.97, False), (1.03, True)])
def test_a_curve_that_turns_back_sharply_is_followed_to_its_edge(around: float, there: bool) -> None:
    """Just where a stabilizer comes off the wall; between two points of the curve its direction says nothing."""
    bha = BottomHoleAssembly((1.184, 5.383, 8.874), (8.148e-3, 3.152e-3), 0.596, 460.0, 2.394e7)
    bit = BitRock(34.7, 0.2103, 0.06975 * around, radians(10.0))
    case = replace(paper_spiral(), bha=bha, bit=bit, active_weight_on_bit=7000.0)
    found = search(case).at(case.eta_pi)
    assert (found.own is not None, found.edge is not None) == (there, there)
    if found.edge is not None:
        assert found.edge[MU] == pytest.approx(0.0, abs=1e-12)

"""How a BHA lies in a given hole: against finite elements, closed forms and the definition of the contact problem."""

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from beam_in_elements import Elements, supports
from beams_as_built import bearable, built, with_points
from boreprop.arrays import Floats
from boreprop.core.beam import Beam
from boreprop.core.errors import ParameterError
from boreprop.core.system import BitRock, BottomHoleAssembly, scale
from boreprop.kernel.binding import Lie, lie

pytestmark = pytest.mark.usefixtures("kernel")


def one(bha: BottomHoleAssembly, offsets: Floats, force: float = 0.0, sine: float = 0.0, **more: object) -> Lie:
    """How a BHA lies in one hole."""
    return lie(bha, offsets[None], np.array([force]), np.array([sine]), **more)  # type: ignore[arg-type]


def loose(bha: BottomHoleAssembly) -> BottomHoleAssembly:
    """The same with so much clearance that nothing touches."""
    return replace(bha, stabilizer_clearances=(1e6,) * len(bha.stabilizer_clearances))


@given(bha=built(), e_n=st.floats(-0.1, 0.1), force=st.floats(-3e4, 3e4), sine=st.floats(-1.0, 1.0))
def test_a_uniform_beam_in_sections_is_the_closed_form(
    bha: BottomHoleAssembly, e_n: float, force: float, sine: float
) -> None:
    same = (bha.flexural_stiffness,) * len(bha.section_lengths), (bha.distributed_weight,) * len(bha.section_lengths)
    stepped = replace(loose(bha), section_flexural_stiffnesses=same[0], section_distributed_weights=same[1])
    uniform = BottomHoleAssembly(*(getattr(bha, name) for name in list(bha.__dataclass_fields__)[:5]))
    scaled, l1, F_star = scale(uniform, BitRock(1.0, 1.0, 0.1)), bha.length_scale, bha.force_scale
    beam, none = Beam(scaled), [0.0] * (len(scaled.s) - 1)
    places = np.linspace(0.0, bha.stabilizer_positions[-1], 9)
    offsets = np.zeros(len(scaled.s))
    offsets[-1] = e_n
    found = one(stepped, offsets, force, sine, places=places)
    loads = e_n / l1, none, force / F_star, sine
    shape = [l1 * beam.shape(s / l1, *loads) for s in places]
    assert found.bit_force[0] == pytest.approx(F_star * beam.bit_force(*loads), rel=1e-12, abs=1e-12 * F_star)
    assert found.bit_moment[0] == pytest.approx(F_star * l1 * beam.bit_moment(*loads), rel=1e-12, abs=1e-12 * F_star)
    np.testing.assert_allclose(found.shape[0], shape, atol=1e-12 * max(map(abs, [*shape, 1.0])))


@given(
    bha=built(axial=True, points=3),
    e_n=st.floats(-0.1, 0.1),
    force=st.floats(-3e4, 3e4),
    weight=st.floats(0.0, 0.5),
    inclination=st.floats(0.0, pi / 2),
)
def test_sections_under_axial_load_are_those_of_finite_elements(
    bha: BottomHoleAssembly, e_n: float, force: float, weight: float, inclination: float
) -> None:
    free = replace(loose(bha), body_point_clearances=(1e6,) * 3)
    # a fraction of the Euler load of the whole, so that the beam stands without its stabilizers too
    weight *= pi**2 * min(bha.section_flexural_stiffnesses) / bha.stabilizer_positions[-1] ** 2
    offsets = np.zeros(supports(bha).size)
    offsets[len(bha.stabilizer_positions) - 1] = e_n
    elements = Elements(free, weight, inclination, sin(inclination))
    elements.push(bha.rss_position, force)
    expected = elements.solve(e_n)[::2]
    found = one(
        free, offsets, force, sin(inclination), weight_on_bit=weight, inclination=inclination, places=elements.s
    )
    assert np.abs(found.shape[0] - expected).max() <= 2e-5 * np.abs(expected).max() + 1e-9


@given(bha=built(axial=True), inclination=st.floats(0.0, 1.5), place=st.floats(0.05, 1.0))
def test_the_force_at_the_bit_is_what_equilibrium_and_reciprocity_ask_for(
    bha: BottomHoleAssembly, inclination: float, place: float
) -> None:
    """F_0 under a unit force at s is −(1 + E(s)), E(s) the deflection there where the end is off by one."""
    free = replace(loose(bha), rss_position=place * min(bha.stabilizer_positions[0], 3.0))
    offsets = np.zeros(len(bha.stabilizer_positions))
    more = {"weight_on_bit": 1e4, "inclination": inclination, "places": (free.rss_position,)}
    pushed = one(free, offsets, 1.0, 0.0, **more)
    offsets[-1] = 1.0
    off = one(free, offsets, 0.0, 0.0, **more)
    assert pushed.bit_force[0] == pytest.approx(-(1 + off.shape[0, 0]), abs=1e-9)


def misses(bha: BottomHoleAssembly, offsets: Floats, force: float, sine: float, **load: float) -> float:
    """By how much the contacts found miss their problem, m.

    No support is beyond the wall, and each that is pushed away from a wall is at that one.
    """
    s, n = supports(bha), len(bha.stabilizer_positions)
    found = one(bha, offsets, force, sine, places=np.sort(s), **load)
    delta, F = offsets + np.interp(s, np.sort(s), found.shape[0]), found.forces[0]
    y_star = np.array([*bha.stabilizer_clearances, 0.0, *bha.body_point_clearances])
    pushed = np.abs(F) > 1e-9 * max(1.0, np.abs(F).max())
    assert F[n - 1] == 0.0
    return float(max((np.abs(delta) - y_star).max(), np.abs(delta + np.sign(F) * y_star)[pushed].max(initial=0.0)))


@given(
    bha=built(axial=True, points=12),
    sine=st.floats(-1.0, 1.0),
    force=st.floats(-3e4, 3e4),
    bow=st.floats(-3e-3, 3e-3),
    tilt=st.floats(-0.01, 0.01),
    share=st.floats(0.0, 0.98),
)
def test_contacts_satisfy_the_complementarity_problem(
    bha: BottomHoleAssembly, sine: float, force: float, bow: float, tilt: float, share: float
) -> None:
    s = supports(bha)
    load = {"weight_on_bit": share * bearable(bha, 0.5), "inclination": 0.5}
    assert misses(bha, -tilt * s - bow * s**2 / 2, force, sine, **load) <= 1e-9


@pytest.mark.parametrize(
    ("stabilizers", "clearances", "weight", "inclination", "bow"),
    [
        ((18.0, 32.0, 45.0), (5e-3, 3e-3), 528e3, 0.5, -5e-4),
        ((17.0, 35.0, 40.0), (3e-3, 5e-3), 582e3, 0.5, -5e-4),
        ((18.0, 34.0, 39.0, 56.0), (1e-3, 5e-3, 1e-2), 596e3, 0.0, 0.0),
    ],
)
def test_a_beam_that_snaps_off_a_wall_comes_to_lie_on_others(
    stabilizers: tuple[float, ...], clearances: tuple[float, ...], weight: float, inclination: float, bow: float
) -> None:
    """It does not stand without a stabilizer that comes free as the load grows, or as the clearances open."""
    points = (stabilizers[-1] * (np.arange(6) + 0.4) / 6).tolist()
    uniform = BottomHoleAssembly(stabilizers, clearances, 0.5, 1000.0, 1e7)
    bha = replace(with_points(uniform, points, 0.02), axial_load=True)
    load = {"weight_on_bit": weight, "inclination": inclination}
    assert misses(bha, -bow * supports(bha) ** 2, 0.0, sin(inclination), **load) <= 1e-9


def test_a_point_of_the_body_where_a_stabilizer_is_changes_nothing() -> None:
    found = []
    for points in ([3.0, 12.0], [3.0, 8.0, 12.0, 16.0]):
        bha = with_points(BottomHoleAssembly((8.0, 16.0), (3e-3,), 0.5, 1000.0, 1e7), points, 0.02)
        lies = one(bha, 3e-3 * supports(bha) ** 2, 0.0, 0.5)
        found.append([*lies.forces[lies.forces != 0.0], lies.bit_force[0]])
    assert len(found[0]) == 3
    assert found[0] == pytest.approx(found[1], rel=1e-12)


def test_a_string_that_lies_on_the_low_side_is_held_there() -> None:
    bha = replace(
        BottomHoleAssembly((10.0,), (), 0.5, 1000.0, 1e7),
        section_lengths=(10.0,),
        section_distributed_weights=(1000.0,),
        section_flexural_stiffnesses=(1e7,),
        section_outer_diameters=(0.17,),
        end_deflection=-0.03,
    )
    found = one(bha, np.zeros(1), places=(10.0,))
    assert found.shape[0, 0] == pytest.approx(-0.03, rel=1e-12)
    assert found.bit_force[0] == pytest.approx(3 * 1e7 * 0.03 / 10.0**3, rel=1e-12)


def test_beyond_its_buckling_load_a_bha_is_refused_with_the_load() -> None:
    """A clamped and hinged beam without weight buckles under 4.4934² EI/ℓ², the root of tan x = x."""
    bha = replace(BottomHoleAssembly((10.0,), (), 0.5, 0.0, 1e7), axial_load=True)
    critical = brentq(lambda x: sin(x) - x * cos(x), 4.0, 4.6, xtol=1e-14) ** 2 * 1e7 / 10.0**2
    one(bha, np.zeros(1), weight_on_bit=critical * (1 - 1e-6))
    with pytest.raises(ParameterError, match=r"^weight_on_bit: must be < .*, where the BHA buckles") as refused:
        one(bha, np.zeros(1), weight_on_bit=critical * (1 + 1e-6))
    assert refused.value.problem
    assert refused.value.problem.limit == pytest.approx(critical, rel=1e-8)


@pytest.mark.parametrize(
    ("stabilizers", "EI", "weight", "critical"),
    [((1.2192, 28.6512), 1.704e7, 1850.0, 480e3), ((13.716, 22.86, 50.292), 9.575e6, 1332.9, 264e3)],
)
def test_between_held_stabilizers_known_bhas_buckle_where_finite_elements_say(
    stabilizers: tuple[float, ...], EI: float, weight: float, critical: float
) -> None:
    bha = BottomHoleAssembly(stabilizers, (1e-3,) * (len(stabilizers) - 1), 0.3, weight, EI, axial_load=True)
    with pytest.raises(ParameterError) as refused:
        one(bha, np.zeros(len(stabilizers)), weight_on_bit=1e7, inclination=np.radians(20.0))
    assert refused.value.problem
    assert refused.value.problem.limit == pytest.approx(critical, rel=2e-3)

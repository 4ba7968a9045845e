"""The stability chart and its picture: the verdicts of the roots, point by point."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from math import inf, log, pi, radians, sin

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from matplotlib.colors import to_rgb
from scipy.optimize import linprog

from boreprop.analysis.stability.any_beam import AnyBeam
from boreprop.analysis.stability.chart import (
    DRIFT,
    OSCILLATORY,
    VERDICTS,
    Chart,
    respaced,
    stability_chart,
    usual_grid,
)
from boreprop.analysis.stability.contacts import all_contacts, can_touch, charted, contacts_met, steady_mode
from boreprop.analysis.stability.roots import Verdict, find_roots, rightmost_roots
from boreprop.analysis.steering import offsets
from boreprop.case.case import Case
from boreprop.core.errors import ParameterError
from boreprop.core.modes import Loads, Mode, Modes
from boreprop.core.system import BitRock, BottomHoleAssembly, scale
from boreprop.report.figures.stability import SHADES, boundaries, draw
from stability import BIT, PAPER, VERTICAL, drilling


@pytest.fixture(scope="module")
def chart() -> Chart:
    return stability_chart(VERTICAL, np.linspace(0.005, 0.6, 60), np.linspace(0.5, 2.4, 39))


def test_the_panels_of_the_chart_are_the_four_modes_with_the_verdicts_of_their_roots(chart: Chart) -> None:
    assert [(panel.contact, panel.saturated) for panel in chart.panels] == [
        ((1,), False),
        ((1,), True),
        ((), False),
        ((), True),
    ]
    rng = np.random.default_rng(1)
    for panel in chart.panels:
        assert panel.verdicts.shape == (39, 60)
        for _ in range(25):
            i, j = rng.integers(39), rng.integers(60)
            first, second = PAPER.bha.stabilizer_positions[0], PAPER.bha.stabilizer_positions[0] * chart.lambda2[i]
            moved = drilling(replace(PAPER.bha, stabilizer_positions=(first, first + second)), PAPER.bit)
            found = find_roots(moved, float(chart.eta_pi[j]), contact=panel.contact, saturated=panel.saturated)
            assert VERDICTS[panel.verdicts[i, j]] is found.verdict


def test_every_verdict_is_in_the_chart_of_the_paper_s_case(chart: Chart) -> None:
    assert {VERDICTS[code] for panel in chart.panels for code in np.unique(panel.verdicts)} == set(Verdict)
    oscillating = [(panel.verdicts == OSCILLATORY).any() for panel in chart.panels]
    assert oscillating == [True, False, False, False]


def test_stabilizers_beyond_the_second_keep_their_distance_from_it() -> None:
    bha = BottomHoleAssembly((2.0, 3.6, 6.0), (1e-3, 1e-3), 0.4, 1e3, 1e7)
    assert respaced(bha, 0.5).stabilizer_positions == pytest.approx((2.0, 3.0, 5.4))
    built = replace(
        bha,
        section_lengths=(1.0, 5.0),
        section_distributed_weights=(1e3, 2e3),
        section_flexural_stiffnesses=(1e7, 2e7),
        section_outer_diameters=(0.0, 0.0),
    )
    assert respaced(built, 2.0).section_lengths == pytest.approx((1.0, 7.4))


def test_on_the_boundaries_of_the_chart_a_root_is_on_the_imaginary_axis(chart: Chart) -> None:
    for panel, least in zip(chart.panels, (100, 10, 10, 0), strict=True):
        points = np.concatenate([np.empty((0, 2)), *boundaries(chart, panel)])
        points = points[~np.isnan(points[:, 0])]
        assert len(points) >= least
        points = points[np.isin(points[:, 1], chart.lambda2)]  # between those the lines are straight
        for at, lambda2 in points[:: len(points) // 20 + 1]:
            scaled = scale(respaced(PAPER.bha, lambda2), PAPER.bit)
            contact = (int(bool(panel.contact)),)
            roots = rightmost_roots(AnyBeam.of_the_paper(scaled).characteristic(contact, panel.saturated), float(at))
            assert min(abs(root.real) for root in roots) < 1e-3


def test_a_drift_of_the_chart_doubles_as_fast_as_its_root_says(chart: Chart) -> None:
    free_saturated = chart.panels[3]
    assert (free_saturated.verdicts == DRIFT).all()
    for i, j in ((0, 0), (20, 3), (38, 59)):
        first = PAPER.bha.length_scale
        bha = replace(PAPER.bha, stabilizer_positions=(first, first * (1 + chart.lambda2[i])))
        [root, *_] = find_roots(drilling(bha, PAPER.bit), float(chart.eta_pi[j]), saturated=True).roots
        assert free_saturated.doubling[i, j] == pytest.approx(log(2) / root.real * first, rel=0.2)
    for panel in chart.panels:
        assert (np.isnan(panel.doubling) == (panel.verdicts != DRIFT)).all()


THREE = BottomHoleAssembly((4.3, 12.5, 21.5), (1.6e-3, 3.2e-3), 0.75, 1964.0, 1.923e7)


def test_the_chart_of_three_stabilizers_has_all_their_modes() -> None:
    made = stability_chart(drilling(THREE, BIT), np.linspace(0.02, 0.4, 4), np.linspace(1.0, 2.0, 3), inclination=0.46)
    contacts = ((1, 2), (1,), (2,), ())
    assert [(panel.contact, panel.saturated) for panel in made.panels] == [
        (contact, saturated) for contact in contacts for saturated in (False, True)
    ]


def test_with_many_stabilizers_a_chart_has_four_contacts_and_the_one_that_holds_the_case() -> None:
    six = BottomHoleAssembly(tuple(np.arange(1.0, 7.0) * 5.0), (2e-3,) * 5, 0.7, 1500.0, 1e7)
    here, _ = steady_mode(drilled_by(six, BIT, 5e4), 0.0, 0.5)
    shown = charted(six, BIT, 0.5, first=here)
    assert len(shown) == 4
    assert shown[0] == (1, 2, 3, 4, 5)
    assert here in shown
    assert set(shown) <= {*contacts_met(six, BIT, 0.5), here, shown[0]}


@settings(deadline=None, max_examples=20, derandomize=True)
@given(st.floats(0.3, 20.0), st.sampled_from([0.0, 0.3, 1.0]), st.floats(-2e4, 2e4))
def test_a_blade_that_cannot_touch_adds_no_mode_to_a_chart(at: float, inclination: float, force: float) -> None:
    assume(abs(np.array(THREE.stabilizer_positions) - at).min() > 0.1)
    place = int(np.searchsorted(THREE.stabilizer_positions, at))
    idle = replace(
        THREE,
        stabilizer_positions=(*THREE.stabilizer_positions[:place], at, *THREE.stabilizer_positions[place:]),
        stabilizer_clearances=(*THREE.stabilizer_clearances[:place], 0.2, *THREE.stabilizer_clearances[place:]),
        rss_position=0.3,
    )

    def renumbered(contact: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(i + (i > place) for i in contact)

    without = replace(THREE, rss_position=0.3)
    assert can_touch(idle, BIT, inclination, [force]) == renumbered(can_touch(without, BIT, inclination, [force]))
    shown = charted(without, BIT, inclination, [force])
    assert charted(idle, BIT, inclination, [force]) == tuple(map(renumbered, shown))


NEAR_BIT = BottomHoleAssembly((0.9, 5.5, 15.0), (0.8e-3, 3e-3), 0.5, 1400.0, 1.6e7)


@pytest.mark.parametrize("bha", [THREE, NEAR_BIT, PAPER.bha])
@pytest.mark.parametrize("inclination", [0.0, 0.3, pi / 2])
def test_contacts_that_a_hole_has_are_among_those_met_and_those_met_are_had_by_a_hole(
    bha: BottomHoleAssembly, inclination: float
) -> None:
    scaled, random = scale(bha, BIT), np.random.default_rng(1)
    modes, largest = Modes(scaled), np.array([radians(10.0) / 30.0 * bha.length_scale, BIT.tilt_limit])

    def loads(kappa: float, psi: float) -> Loads:
        return Loads(offsets(scaled.s, float(kappa), float(psi)), 0.0, sin(inclination))

    def contact(at: np.ndarray) -> tuple[int, ...]:
        walls = modes.settle(loads(*at), (0,) * len(scaled.y_star)).contact
        return tuple(i for i, wall in enumerate(walls, 1) if wall)

    had = {contact(at) for at in random.uniform(-1.0, 1.0, (4000, 2)) * largest}
    found = contacts_met(bha, BIT, inclination)
    assert had <= found
    for missed in found - had:  # random holes may miss what few holes have
        walls = product(*((1, -1) if i in missed else (0,) for i in range(1, len(bha.stabilizer_positions))))
        assert missed in [contact(hole_with(modes[on], loads, largest)) for on in walls]


def hole_with(mode: Mode, loads: Callable[[float, float], Loads], largest: np.ndarray) -> np.ndarray:
    """A curvature and a tilt at which a mode holds, by linear programming; zeros if there are none."""
    A, b = [], []
    for bound in mode.bounds:
        rest, *steps = (bound.scale * bound.row(loads(*at)) for at in ((0, 0), (1, 0), (0, 1)))
        slopes = np.array(steps) - rest
        for side, limit in ((1, bound.upper), (-1, -bound.lower)):
            if limit < inf:
                A.append([*(side * slopes), 1e-3 * np.abs(slopes).max()])  # as far from every bound as can be
                b.append(limit - side * rest)
    found = linprog([0.0, 0.0, -1.0], A, b, bounds=[*((-most, most) for most in largest), (0.0, 1.0)])
    return np.zeros(2) if found.x is None else found.x[:2]


def test_stabilizers_without_clearance_are_in_every_contact() -> None:
    assert all_contacts(replace(THREE, stabilizer_clearances=(0.0, 1e-3))) == ((1, 2), (1,))


def drilled_by(bha: BottomHoleAssembly, bit: BitRock, active_weight_on_bit: float) -> Case:
    return replace(PAPER, bha=bha, bit=bit, active_weight_on_bit=active_weight_on_bit)


def test_the_steady_mode_is_that_of_the_steady_response() -> None:
    assert steady_mode(drilled_by(THREE, BIT, 6e4), 0.0, 0.0) == ((), False)  # hangs straight
    easily_tilted = replace(BIT, tilt_limit=1e-6)
    contact, saturated = steady_mode(drilled_by(THREE, easily_tilted, 6e4), 2e4, radians(26.37))
    assert saturated
    assert contact in all_contacts(THREE)


def test_the_shades_of_the_chart_differ_in_lightness() -> None:
    lightness = sorted(np.dot(to_rgb(shade), (0.2126, 0.7152, 0.0722)) for shade in SHADES.values())
    assert min(np.diff(lightness)) > 0.1


def test_the_chart_s_picture_marks_the_case(chart: Chart) -> None:
    figure = draw(chart, PAPER)
    assert len(figure.axes) == 4
    for axes in figure.axes:
        assert axes.lines[-1].get_xydata() == pytest.approx(np.array([[0.01, 1.0]]), rel=1e-4)


def test_the_chart_s_picture_says_in_which_mode_the_case_drills_and_whether_waves_grow_there(chart: Chart) -> None:
    def told(chart: Chart) -> list[str]:
        titles = [panel.get_title().partition("\n") for panel in draw(chart, VERTICAL).axes]
        return [f"{mode}: {so}" for mode, _, so in titles if so]

    assert told(chart) == ["no contact, bit tilt not saturated: (the case drills in this mode)"]
    drops = "stabilizer 1 in contact, bit tilt not saturated: (the case would drill in this mode, but waves grow)"
    assert told(replace(chart, inclination=radians(3.5))) == [drops]


def test_the_chart_s_picture_has_kilonewtons_and_metres_and_no_specks(chart: Chart) -> None:
    axes = draw(chart, PAPER).axes[0]
    across, up = axes.child_axes[0], draw(chart, PAPER).axes[1].child_axes[-1]
    assert across.get_xlabel() == "active weight on bit (kN)"
    assert up.get_ylabel() == "stabilizer 1 to 2 (m)"
    for line in boundaries(chart, chart.panels[0]):
        assert np.ptp(line, axis=0).max() > 0.05


def test_the_usual_grid_has_the_case_inside() -> None:
    far = replace(PAPER.bha, stabilizer_positions=(1.0, 9.0))
    for bha, at, lambda2 in ((PAPER.bha, 0.01, 1.0), (PAPER.bha, 3.0, 1.0), (far, 0.01, 8.0)):
        eta_pi, second = usual_grid(bha, at)
        assert eta_pi[0] < at < eta_pi[-1]
        assert second[0] < lambda2 < second[-1]
        assert (len(eta_pi), len(second)) == (300, 200)


def test_a_chart_over_lambda2_needs_two_stabilizers() -> None:
    single = BottomHoleAssembly((3.66,), (), 0.6, 1080.0, 7.2e6)
    with pytest.raises(ParameterError, match="must hold at least 2"):
        stability_chart(drilling(single, PAPER.bit), np.linspace(0.1, 1, 3), np.linspace(0.1, 1, 3))

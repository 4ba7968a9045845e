"""How large a dogleg it takes to tip a system over, and where an ongoing ripple dies out."""

from dataclasses import replace
from math import degrees, inf, radians

import numpy as np
import pytest

from boreprop.analysis import tipping
from boreprop.analysis.rippling import Rippling, find_rippling
from boreprop.analysis.search import State
from boreprop.analysis.study.design import vary
from boreprop.analysis.tipping import (
    critical_dogleg,
    dogleg_map,
    drill_until_steady,
    usual_map,
    with_dogleg,
)
from boreprop.case.case import Case
from boreprop.case.inputs import Schedule
from boreprop.case.paper import LENGTH_SCALE, paper_case
from boreprop.core.errors import ParameterError
from boreprop.core.survey import Survey
from boreprop.report.tables.tipping import lines
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped
from tipping_cases import NO, YES, at


def ripples_for_long(case: Case, relative_tolerance: float = 1e-7) -> bool:
    """After 100 ℓ₁, however it may look before."""
    run = simulate(
        case, length=100 * LENGTH_SCALE, sample_interval=LENGTH_SCALE / 20, relative_tolerance=relative_tolerance
    )
    return find_rippling(run).ripples


@pytest.mark.parametrize(
    ("case", "ripples"),
    [
        (paper_case(), True),
        (paper_case(tilt_limit=radians(1.0)), True),
        (paper_case(tilt_limit=radians(0.5)), True),
        (paper_case(tilt_limit=radians(0.1)), False),
        (paper_case(clearance=1.5e-3), False),
        (paper_case(clearance=2e-3), False),
    ],
)
def test_the_cases_of_the_paper_settle_as_in_the_paper(case: Case, ripples: bool) -> None:
    assert drill_until_steady(case)[1].ripples is ripples


@pytest.mark.parametrize(
    ("eta_pi", "turn_deg", "ripples"),
    [
        (0.03, 0.5, True),
        (0.05, 0.5, False),
        (0.08, 1.0, True),
        (0.1, 1.0, False),
        (0.1, 2.0, True),
        (0.12, 2.0, False),  # it takes 60 ℓ₁ to die out
        (0.12, 5.0, True),
        (0.15, 5.0, False),
    ],
)
def test_an_early_verdict_is_that_of_a_long_run(eta_pi: float, turn_deg: float, ripples: bool) -> None:
    case = with_dogleg(at(eta_pi), radians(turn_deg))
    assert drill_until_steady(case)[1].ripples is ripples
    assert ripples_for_long(case) is ripples


def test_the_steady_wave_is_that_of_a_long_run() -> None:
    _, early = drill_until_steady(paper_case(tilt_limit=radians(1.0)))
    run = simulate(paper_case(tilt_limit=radians(1.0)), sample_interval=0.05)
    late = find_rippling(run)
    assert early.wavelength == pytest.approx(late.wavelength, rel=0.01)
    assert early.amplitude == pytest.approx(late.amplitude, rel=0.03)


def test_an_unstable_straight_hole_ripples_however_small_the_wave_is_at_first() -> None:
    # so little clearance that the weight of the BHA keeps the stabilizer on the lower wall
    case = replace(at(0.1, clearance=1e-4), survey=Survey((0.0,), (radians(5.0),)))
    run, found = drill_until_steady(case)
    assert found.ripples
    first = run["borehole_inclination"][run["drilled_length"] < 3 * LENGTH_SCALE]
    assert np.ptp(first) / 2 < found.amplitude / 20


def test_a_wave_that_takes_for_ever_to_die_out_does_not_ripple() -> None:
    case = replace(at(0.12, clearance=5e-5), survey=Survey((0.0,), (radians(2.0),)))
    run, found = drill_until_steady(case)
    assert np.ptp(run["borehole_inclination"][-100:]) > radians(0.01)
    assert found.state is State.DYING
    assert run["drilled_length"][-1] == pytest.approx(120 * LENGTH_SCALE, rel=0.01)


def test_a_failing_run_says_where() -> None:
    pushed = replace(paper_case(), schedule=Schedule((0.0,), (1e9,)))
    with pytest.raises(Stopped, match="after 0 m: the bit turns over"):
        drill_until_steady(pushed)


def test_the_hole_is_straight_at_the_inclination_of_the_case_and_turns_over_half_the_bha() -> None:
    case = replace(paper_case(), survey=Survey((0.0, 10.0, 10.0 + 2 * LENGTH_SCALE), (0.1, 0.2, 0.4)))
    survey = with_dogleg(case, 0.05).survey
    assert np.diff(survey.measured_depth) == pytest.approx([LENGTH_SCALE])
    assert survey.inclination == pytest.approx((0.3, 0.35))


@pytest.mark.slow
@pytest.mark.parametrize("eta_pi", [0.01, 0.05, 0.1])
def test_a_tenth_less_dies_out_and_a_tenth_more_ripples_at_another_tolerance_too(eta_pi: float) -> None:
    case = at(eta_pi)
    found = critical_dogleg(case)
    assert found.monotonic
    for factor, ripples in ((0.9, False), (1.1, True)):
        assert ripples_for_long(with_dogleg(case, factor * found.angle), 1e-9) is ripples


def test_in_a_vertical_hole_both_sides_are_the_same() -> None:
    up, down = (critical_dogleg(at(0.03), side=side, tolerance=0.1) for side in (1, -1))
    assert up == down


def test_it_lies_between_neighbours_as_close_as_the_tolerance() -> None:
    found = critical_dogleg(at(0.05), tolerance=0.1)
    below = max(turn for turn, ripples in found.tried if not ripples)
    above = min(turn for turn, ripples in found.tried if ripples)
    assert below < found.angle < above
    assert above - below <= 0.1 * above
    assert found.curvature == found.angle / LENGTH_SCALE


def test_more_clearance_and_more_weight_forgive_more() -> None:
    angles = [critical_dogleg(case, tolerance=0.1).angle for case in (at(0.01), at(0.01, clearance=2e-3), at(0.1))]
    assert angles[0] < min(angles[1:])


def test_where_nothing_tips_it_the_critical_dogleg_is_infinite() -> None:
    assert critical_dogleg(at(0.16)).angle == inf


@pytest.mark.slow
def test_a_stabilizer_without_clearance_forgives_nothing_where_its_mode_is_unstable() -> None:
    # the paper's limit of contact without saturation is ηΠ = 0.147
    assert [critical_dogleg(at(eta_pi, clearance=0.0)).angle for eta_pi in (0.1, 0.16)] == [0.0, inf]


def tipping_where(monkeypatch: pytest.MonkeyPatch, tips: "list[tuple[float, float]]") -> None:
    """Make doglegs tip within the given intervals, degrees."""

    def settle(case: Case, **_: float) -> tuple[None, Rippling]:
        turn = degrees(case.survey.inclination[1] - case.survey.inclination[0])
        return None, YES if any(low <= turn <= high for low, high in tips) else NO

    monkeypatch.setattr(tipping, "drill_until_steady", settle)


def test_where_the_straight_hole_ripples_the_critical_dogleg_is_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    tipping_where(monkeypatch, [(0.0, 90.0)])
    found = critical_dogleg(paper_case())
    assert (found.angle, found.monotonic) == (0.0, True)


@pytest.mark.parametrize("critical_deg", [0.004, 0.1, 3.3, 9.0])
def test_any_threshold_is_found(monkeypatch: pytest.MonkeyPatch, critical_deg: float) -> None:
    tipping_where(monkeypatch, [(critical_deg, 90.0)])
    found = critical_dogleg(paper_case(), limit=radians(10.0), tolerance=0.02)
    assert degrees(found.angle) == pytest.approx(critical_deg, rel=0.02, abs=0.001)
    assert len(found.tried) <= 20


def test_a_hole_that_ripples_straight_but_not_after_small_turns_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    tipping_where(monkeypatch, [(0.0, 0.0), (1.0, 90.0)])
    found = critical_dogleg(paper_case())
    assert (found.angle, found.monotonic) == (0.0, False)
    [(_, amount)] = lines(paper_case(), {1: found}, radians(10.0))
    assert amount == "none needed: it ripples from a straight hole, but not after a turn of 0.0098° to 0.62°"


def test_a_straight_hole_that_the_smallest_turn_tips_is_not_said_to_ripple(monkeypatch: pytest.MonkeyPatch) -> None:
    tipping_where(monkeypatch, [(0.0005, 90.0)])
    found = critical_dogleg(paper_case())
    assert found.angle == 0.0
    assert dict(found.tried)[0.0] is False
    assert [amount for _, amount in lines(paper_case(), {1: found}, radians(10.0))] == ["any of 0.001° or more"]


def test_an_inclined_hole_that_ripples_by_itself_does_not_after_a_small_turn_down() -> None:
    inclined = replace(paper_case(), survey=Survey((0.0,), (radians(4.0),)))
    found = critical_dogleg(inclined, side=-1)
    straight = [turn for turn, ripples in found.tried if not ripples]
    assert found.angle == 0.0
    assert any(turn == pytest.approx(radians(0.3), rel=0.05) for turn in straight)
    for turn in straight:
        assert not ripples_for_long(with_dogleg(inclined, -turn), 1e-9)


def test_an_answer_that_is_not_monotonic_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    tipping_where(monkeypatch, [(1.0, 4.0), (9.0, 90.0)])
    found = critical_dogleg(paper_case())
    assert degrees(found.angle) == pytest.approx(1.0, rel=0.02)
    assert not found.monotonic
    assert dict(found.tried)[radians(10.0) / 2] is False


@pytest.mark.parametrize(
    ("arguments", "message"),
    [({"limit": 0.0}, "limit: must be > 0, got 0.0"), ({"tolerance": 2.0}, "tolerance: must be <= 1, got 2.0")],
)
def test_arguments_out_of_range_are_refused(arguments: dict[str, float], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        critical_dogleg(paper_case(), **arguments)  # type: ignore[arg-type]


@pytest.mark.slow
def test_a_map_holds_the_critical_dogleg_of_each_point() -> None:
    done: list[float] = []
    eta_pi, clearance = np.array([0.02, 0.16]), np.array([2e-3, 4e-3, 6e-3])
    found = dogleg_map(paper_case(), eta_pi, clearance, tolerance=0.2, progress=done.append)
    for (row, column), angle in np.ndenumerate(found.angle):
        case = at(float(eta_pi[column]), clearance=float(clearance[row]) / LENGTH_SCALE)
        assert angle == pytest.approx(critical_dogleg(case, tolerance=0.2).angle)
    assert found.monotonic.all()
    assert not found.stopped.any()
    assert done[-1] == 6


def test_a_run_that_stops_leaves_its_point_out_of_the_map() -> None:
    pushed = replace(paper_case(), schedule=Schedule((0.0,), (3e6,)))
    found = dogleg_map(pushed, np.array([0.01, 5.0]), np.array([3.66e-3]), workers=1)
    assert np.isnan(found.angle).tolist() == [[True, False]]
    assert "the bit turns over" in found.stopped[0, 0]
    assert found.stopped[0, 1] == ""


@pytest.mark.parametrize("case", [paper_case(), at(0.4), paper_case(clearance=4e-3), paper_case(clearance=0.0)])
def test_the_case_is_on_its_usual_map(case: Case) -> None:
    eta_pi, clearance = usual_map(case)
    own = vary(case, {}).active_weight_on_bit * case.bit.lateral_steering_resistance / case.bha.force_scale
    assert eta_pi[0] <= own * (1 + 1e-12)
    assert own < eta_pi[-1]
    assert clearance[0] <= case.bha.stabilizer_clearances[0] < clearance[-1]


def test_a_map_varies_the_first_stabilizer_that_touches() -> None:
    bha = paper_case().bha
    idle = replace(bha, stabilizer_positions=(1.2, 3.66, 7.32), stabilizer_clearances=(0.2, *bha.stabilizer_clearances))
    bladed = replace(paper_case(), bha=idle)
    assert dogleg_map(bladed, np.array([0.02]), np.array([3e-3]), tolerance=1.0, workers=1).stabilizer == 2
    assert usual_map(bladed)[1] == pytest.approx(usual_map(paper_case())[1])

"""How large a dogleg it takes to tip a system over, and where an ongoing ripple dies out."""

from dataclasses import replace
from math import degrees, inf, nan, radians
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from boreprop.analysis import tipping
from boreprop.analysis.design import vary
from boreprop.analysis.rippling import Rippling, find_rippling
from boreprop.analysis.tipping import (
    CriticalDogleg,
    critical_dogleg,
    dogleg_map,
    drill_until_settled,
    hysteresis,
    with_dogleg,
)
from boreprop.case import Case, Schedule
from boreprop.core.assembly import ParameterError
from boreprop.core.drilling import Drilling
from boreprop.core.hole import Survey
from boreprop.paper import LENGTH_SCALE, paper_case
from boreprop.simulation import SimulationError, simulate
from boreprop.tipping_table import loop, rows
from conftest import Command


def at(eta_pi: float, **options: float) -> Case:
    return vary(paper_case(**options), {"eta_pi": eta_pi})


def ripples_for_long(case: Case, relative_tolerance: float = 1e-7) -> bool:
    """After 100 ℓ₁, however it may look before."""
    run = simulate(
        case, length=100 * LENGTH_SCALE, sample_interval=LENGTH_SCALE / 20, relative_tolerance=relative_tolerance
    )
    return find_rippling(run["drilled_length"], run["borehole_inclination"], LENGTH_SCALE).ripples


# one run


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
    assert drill_until_settled(case)[1].ripples is ripples


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
    assert drill_until_settled(case)[1].ripples is ripples
    assert ripples_for_long(case) is ripples


def test_the_settled_wave_is_that_of_a_long_run() -> None:
    _, early = drill_until_settled(paper_case(tilt_limit=radians(1.0)))
    run = simulate(paper_case(tilt_limit=radians(1.0)), sample_interval=0.05)
    late = find_rippling(run["drilled_length"], run["borehole_inclination"], LENGTH_SCALE)
    assert early.wavelength == pytest.approx(late.wavelength, rel=0.01)
    assert early.amplitude == pytest.approx(late.amplitude, rel=0.03)


def test_an_unstable_straight_hole_ripples_however_small_the_wave_is_at_first() -> None:
    # so little clearance that the weight of the BHA keeps the stabilizer on the lower wall
    case = replace(at(0.1, clearance=1e-4), survey=Survey((0.0,), (radians(5.0),)))
    run, found = drill_until_settled(case)
    assert found.ripples
    first = run["borehole_inclination"][run["drilled_length"] < 3 * LENGTH_SCALE]
    assert np.ptp(first) / 2 < found.amplitude / 20


def test_a_wave_that_takes_for_ever_to_die_out_does_not_ripple() -> None:
    case = replace(at(0.12, clearance=5e-5), survey=Survey((0.0,), (radians(2.0),)))
    run, found = drill_until_settled(case)
    assert run["drilled_length"][-1] == pytest.approx(150 * LENGTH_SCALE, rel=0.01)
    assert np.ptp(run["borehole_inclination"][-100:]) > radians(0.01)
    assert not found.ripples


def test_a_failing_run_says_where() -> None:
    pushed = replace(paper_case(), schedule=Schedule((0.0,), (1e9,)))
    with pytest.raises(SimulationError, match="after 0 m: the bit turns over"):
        drill_until_settled(pushed)


# the critical dogleg


def test_the_hole_is_straight_at_the_inclination_of_the_case_and_turns_over_the_last_length() -> None:
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
        return None, Rippling(any(low <= turn <= high for low, high in tips))

    monkeypatch.setattr(tipping, "drill_until_settled", settle)


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
    assert done[-1] == 6


# hysteresis


@pytest.mark.slow
def test_a_ripple_dies_at_the_weight_where_it_dies_in_one_run_and_comes_back_at_the_critical_dogleg() -> None:
    weights = [0.02, 0.03, 0.04, 0.06, 0.08, 0.1, 0.12, 0.135, 0.15]
    cases = [at(eta_pi) for eta_pi in weights]
    up, down = hysteresis(cases, radians(0.5))
    drilling = Drilling(
        cases[0].bha, cases[0].bit, with_dogleg(cases[0], radians(10.0)).survey,
        active_weight_on_bit=cases[0].active_weight_on_bit,
    )  # fmt: skip
    for case, wave in zip(cases, up, strict=True):
        rows = []
        for _ in range(60 * 30):
            length = drilling.drilled_length + LENGTH_SCALE / 30
            assert drilling.advance(length, 0.0, case.active_weight_on_bit) is None
            rows.append((length, drilling.outputs()["borehole_inclination"]))
        at_bit, inclination = np.array(rows).T
        in_one_run = find_rippling(at_bit, inclination, LENGTH_SCALE)
        assert wave.ripples is in_one_run.ripples
        assert wave.amplitude == pytest.approx(in_one_run.amplitude, rel=0.03, nan_ok=True)
    assert [wave.ripples for wave in up] == [eta_pi < 0.13 for eta_pi in weights]
    assert [wave.ripples for wave in down] == [critical_dogleg(case).angle < radians(0.5) for case in cases]


def test_opening_the_clearance_lets_a_ripple_go_on_that_it_would_not_let_start() -> None:
    cases = [paper_case(clearance=clearance) for clearance in (1e-3, 1.5e-3, 2e-3)]
    up, down = hysteresis(cases, radians(0.5))
    assert [wave.ripples for wave in up] == [True, True, True]
    assert [wave.ripples for wave in down] == [True, False, False]  # the paper's figure 8


# words and pictures


def critical(angle: float, monotonic: bool = True) -> CriticalDogleg:
    return CriticalDogleg(angle, angle / LENGTH_SCALE, monotonic, ())


def test_the_critical_dogleg_in_words() -> None:
    found = {1: critical(radians(1.0)), -1: critical(inf)}
    assert [amount for _, amount in rows(paper_case(), found, radians(10.0))] == [
        "1.00° over 3.66 m (8.2 °/30 m)", "none up to 10°"
    ]  # fmt: skip
    found = {1: critical(0.0), -1: critical(radians(2.0), monotonic=False)}
    assert [amount for _, amount in rows(paper_case(), found, radians(10.0))] == [
        "any: it ripples from a straight hole", "2.00° over 3.66 m (16.4 °/30 m), but not every larger one"
    ]  # fmt: skip


def test_the_loop_in_words() -> None:
    yes, no = Rippling(True, 5.0, 0.1), Rippling(False, nan, nan)
    x = [0.1, 0.2, 0.3]
    assert loop(x, "x", [yes, yes, no], [yes, no, no]) == (
        "on the way up it ripples to x = 0.2; on the way down it comes back at 0.1"
    )
    assert loop(x, "x", [yes, yes, no], [no, no, no]).endswith("on the way down it does not come back")
    assert loop(x, "x", [no, no, no], [no, no, no]) == "it ripples nowhere up to x = 0.3"


@pytest.mark.slow
def test_the_commands_print_and_draw(command: Command, tmp_path: Path, paper_case: Path) -> None:
    ranges = ["--eta-pi", "0.05:0.15:2", "--clearance-mm", "2:4:2"]
    result = command("boreprop", "dogleg", paper_case, "--output", "map.png", *ranges)
    assert (result.returncode, result.stderr) == (0, "")
    assert "0.43° over 3.66 m (3.5 °/30 m)" in result.stdout
    result = command("boreprop", "hysteresis", paper_case, "--output", "loop.png", "--eta-pi", "0.03:0.15:3")
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout == "loop.png: on the way up it ripples to ηΠ = 0.09; on the way down it comes back at 0.03\n"
    for name in ("map.png", "loop.png"):
        assert imread(tmp_path / name)[..., :3].std() > 0.05


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["dogleg", "CASE", "--output", "map.pdf"], ("map.pdf", ".png")),
        (["dogleg", "CASE", "--eta-pi", "0.1:0.05:3"], ("--eta-pi", "START:STOP:COUNT", "'0.1:0.05:3'")),
        (["dogleg", "CASE", "--clearance-mm", "1:2"], ("--clearance-mm", "START:STOP:COUNT", "'1:2'")),
        (["hysteresis", "CASE", "--output", "loop.png"], ("--eta-pi", "--clearance-mm", "neither")),
    ],
)
def test_wrong_arguments_are_one_line(
    command: Command, tmp_path: Path, paper_case: Path, arguments: list[str], named: tuple[str, ...]
) -> None:
    result = command("boreprop", *(str(paper_case) if argument == "CASE" else argument for argument in arguments))
    assert (result.returncode, result.stdout, result.stderr.count("\n")) == (2, "", 1)
    for name in named:
        assert name in result.stderr
    assert not list(tmp_path.iterdir())

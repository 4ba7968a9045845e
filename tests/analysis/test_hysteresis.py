"""How a system ripples while a parameter goes up and down again."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from boreprop.analysis.hysteresis import hysteresis
from boreprop.analysis.rippling import Rippling, find_rippling
from boreprop.analysis.study.design import vary
from boreprop.analysis.tipping import (
    critical_dogleg,
    with_dogleg,
)
from boreprop.case.inputs import Schedule
from boreprop.case.paper import LENGTH_SCALE, paper_case
from boreprop.core.drilling import Drilling
from boreprop.core.survey import Survey
from boreprop.report.tables.hysteresis import loop
from boreprop.run.trajectory import Trajectory
from tipping_cases import at


@pytest.mark.slow
def test_a_ripple_dies_at_the_weight_where_it_dies_in_one_run_and_comes_back_at_the_critical_dogleg() -> None:
    weights = [0.02, 0.03, 0.04, 0.06, 0.08, 0.1, 0.12, 0.135, 0.15]
    cases = [at(eta_pi) for eta_pi in weights]
    found = hysteresis(cases[0], "eta_pi", weights, radians(0.5))
    up, down = found.up, found.down
    drilling = Drilling(
        cases[0].bha, cases[0].bit, with_dogleg(cases[0], radians(10.0)).survey,
        active_weight_on_bit=cases[0].active_weight_on_bit,
    )  # fmt: skip
    for case, wave in zip(cases, up, strict=True):
        rows = []
        for _ in range(60 * 30):
            length = drilling.drilled_length + LENGTH_SCALE / 30
            drilling.advance(length, 0.0, case.active_weight_on_bit)
            rows.append(drilling.outputs())
        columns = {name: np.array([row[name] for row in rows], dtype=float) for name in rows[0]}
        in_one_run = find_rippling(Trajectory(columns, case))
        assert wave is not None
        assert wave.ripples is in_one_run.ripples
        if wave.ripples:
            assert wave.amplitude == pytest.approx(in_one_run.amplitude, rel=0.03)
    assert rippling(up) == [eta_pi < 0.13 for eta_pi in weights]
    assert rippling(down) == [critical_dogleg(case).angle < radians(0.5) for case in cases]


def rippling(waves: tuple[Rippling | None, ...]) -> list[bool]:
    return [wave is not None and wave.ripples for wave in waves]


def test_a_hole_that_drops_does_not_take_the_ripple_to_where_it_dies_for_another_reason() -> None:
    # in each run the hole drops by 8°, and where it has dropped to the ripple would die at any weight
    bha = replace(
        paper_case().bha, stabilizer_positions=(4.0, 11.0), stabilizer_clearances=(0.02,), flexural_stiffness=1.2e7
    )
    inclined = replace(paper_case(tilt_limit=radians(1.0)), bha=bha, survey=Survey((0.0,), (radians(20.0),)))
    found = hysteresis(inclined, "eta_pi", [0.005, 0.01, 0.02], radians(6.0))
    assert rippling(found.up) == [True, True, True]


@pytest.mark.slow
@pytest.mark.parametrize("values", [[0.005, 0.055, 0.15], np.linspace(0.02, 0.14, 7), np.linspace(0.03, 0.13, 13)])
def test_the_ends_of_the_loop_are_the_cases_not_the_grids(values: list[float]) -> None:
    vertical = replace(paper_case(), survey=Survey((0.0,), (0.0,)))
    found = hysteresis(vertical, "eta_pi", list(values), radians(0.5))
    for bracket, end in ((found.dies, 0.1265), (found.returns, 0.0336)):
        assert bracket is not None
        low, high = bracket
        assert high - low <= 0.01 * high
        assert end == pytest.approx((low + high) / 2, rel=0.015)


def test_the_dogleg_brings_a_ripple_back_where_it_is_the_critical_one() -> None:
    vertical = replace(paper_case(), survey=Survey((0.0,), (0.0,)))
    found = hysteresis(vertical, "eta_pi", [0.02, 0.06], radians(0.5))
    assert found.returns is not None
    angles = [critical_dogleg(vary(vertical, {"eta_pi": value}), tolerance=0.002).angle for value in found.returns]
    assert angles[0] <= radians(0.5) * 1.002
    assert angles[1] >= radians(0.5) * 0.998


def test_a_run_that_stops_leaves_its_value_out_of_the_loop() -> None:
    pushed = replace(paper_case(), schedule=Schedule((0.0,), (3e6,)))
    found = hysteresis(pushed, "eta_pi", [0.01, 5.0], radians(0.5))
    assert [wave is None for wave in (*found.up, *found.down)] == [True, False, True, False]
    assert loop(pushed, found).startswith("it ripples nowhere from ηΠ = 0.01 (1.612 kN)")


def test_opening_the_clearance_lets_a_ripple_go_on_that_it_would_not_let_start() -> None:
    clearances = [clearance * LENGTH_SCALE for clearance in (1e-3, 1.5e-3, 2e-3)]
    found = hysteresis(paper_case(), "stabilizer_clearance[1]", clearances, radians(0.5))
    assert rippling(found.up) == [True, True, True]
    assert rippling(found.down) == [True, False, False]  # the paper's figure 8

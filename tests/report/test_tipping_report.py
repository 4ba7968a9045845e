"""Critical doglegs and hysteresis in words."""

from dataclasses import replace
from math import inf, nan, radians

import numpy as np
import pytest

from boreprop.analysis.hysteresis import Hysteresis
from boreprop.analysis.tipping import (
    CriticalDogleg,
    DoglegMap,
)
from boreprop.case.paper import LENGTH_SCALE, paper_case
from boreprop.core.survey import Survey
from boreprop.report.tables.hysteresis import loop
from boreprop.report.tables.tipping import left_out, lines
from tipping_cases import NO, YES


def critical(angle: float, monotonic: bool = True) -> CriticalDogleg:
    return CriticalDogleg(angle, angle / LENGTH_SCALE, monotonic, ())


def test_the_critical_dogleg_in_words() -> None:
    found = {1: critical(radians(1.0)), -1: critical(inf)}
    assert [amount for _, amount in lines(paper_case(), found, radians(10.0))] == [
        "1.00° over 3.66 m (8.2 °/30 m)", "none up to 10°"
    ]  # fmt: skip
    found = {1: critical(0.0), -1: critical(radians(2.0), monotonic=False)}
    assert [amount for _, amount in lines(paper_case(), found, radians(10.0))] == [
        "any: it ripples from a straight hole", "2.00° over 3.66 m (16.4 °/30 m), but not every larger one"
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("inclination_deg", "clearance", "where_and_why"),
    [
        (3.5, 1e-3, " at 3.5°, since it drops with stabilizer 1 in contact, which oscillates"),
        (0.0, 0.0, ", since it drills on with stabilizer 1 in contact, which oscillates"),
        (0.0, 1e-3, ""),  # stable without contact: should it ripple, that is not why
    ],
)
def test_where_and_why_a_straight_hole_ripples_by_itself_in_words(
    inclination_deg: float, clearance: float, where_and_why: str
) -> None:
    case = replace(paper_case(clearance=clearance), survey=Survey((0.0,), (radians(inclination_deg),)))
    [(_, amount)] = lines(case, {1: critical(0.0)}, radians(10.0))
    assert amount == f"any: it ripples from a straight hole{where_and_why}"


def test_a_stopped_run_in_words() -> None:
    [(_, amount)] = lines(paper_case(), {1: "after 3 m: the bit turns over"}, radians(10.0))
    assert amount == "not known: after 3 m: the bit turns over"


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (
            Hysteresis("eta_pi", (0.1, 0.2, 0.3), 0.01, (YES, YES, NO), (YES, NO, NO), (0.2, 0.202), (0.11, 0.111)),
            "on the way up the ripple dies out between ηΠ = 0.2 (32.25 kN) and ηΠ = 0.202 (32.57 kN); on the way down "
            "a dogleg of 0.573° over 3.66 m in a straight hole brings it back between ηΠ = 0.11 (17.74 kN) and "
            "ηΠ = 0.111 (17.9 kN)",
        ),
        (
            Hysteresis("stabilizer_clearance[1]", (1e-3, 2e-3), 0.01, (YES, YES), (NO, NO), None, None),
            "on the way up the ripple lasts to 2 mm; on the way down a dogleg of 0.573° over 3.66 m in a straight hole "
            "does not bring it back",
        ),
        (
            Hysteresis("stabilizer_clearance[1]", (1e-3, 2e-3), 0.01, (YES, None), (YES, YES), None, None),
            "on the way up the ripple lasts to 1 mm; on the way down a dogleg of 0.573° over 3.66 m in a straight hole "
            "brings it back at once, at 2 mm; 1 of 4 values left out, where a run stopped",
        ),
        (
            Hysteresis("active_weight_on_bit", (1e3, 2e3), 0.01, (NO, NO), (NO, NO), None, None),
            "it ripples nowhere from 1 kN to 2 kN",
        ),
    ],
)
def test_the_loop_in_words(found: Hysteresis, words: str) -> None:
    assert loop(paper_case(), found) == words


def test_the_points_that_a_map_lacks_in_words() -> None:
    nothing, why = np.zeros(2), np.array([["", "after 3 m: the bit turns over"]])
    found = DoglegMap(nothing, nothing[:1], 1, np.array([[0.1, nan]]), np.ones((1, 2), dtype=bool), why)
    assert left_out(found) == "; 1 of 2 points left out (the first: after 3 m: the bit turns over)"

"""The options that are refused, and errors between processes; tests/engines drills."""

import pickle
from dataclasses import replace
from math import nan

import pytest

from boreprop.case.case import Case
from boreprop.core.drilling import Drilling
from boreprop.core.errors import CannotContinue, ParameterError, error_of
from boreprop.core.options import Options
from boreprop.core.problems import Problem
from boreprop.core.quantities import OUTPUTS


@pytest.mark.parametrize(
    "error",
    [
        CannotContinue(Problem("no mode", limit=1e-7, place=12.5)),
        error_of(Problem("not increasing", "measured_depth", value=1.0, before=2.0)),
        ParameterError("engine", "must be auto, native or python", "fortran"),
    ],
)
def test_an_error_travels_between_processes(error: CannotContinue | ParameterError) -> None:
    there = pickle.loads(pickle.dumps(error))
    assert (type(there), str(there), repr(there.problem)) == (type(error), str(error), repr(error.problem))


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"relative_tolerance": 1.0}, "relative_tolerance: must be <= 0.01, got 1.0"),
        ({"relative_tolerance": nan}, "relative_tolerance: must be a finite number, got nan"),
        ({"largest_step": 1.5}, "largest_step: must be <= 1, got 1.5"),
        ({"smallest_step": 0.0}, "smallest_step: must be >= 1e-15, got 0.0"),
        ({"layers": 0.0}, "layers: must be > 0, got 0.0"),
        ({"theta_weight": -1.0}, "theta_weight: must be >= 0, got -1.0"),
        ({"most_steps": 0}, "most_steps: must be >= 1, got 0"),
    ],
)
def test_options_out_of_range_are_refused(options: dict[str, float], told: str) -> None:
    with pytest.raises(ParameterError) as caught:
        Options(**options)  # type: ignore[arg-type]
    assert str(caught.value) == told


@pytest.mark.parametrize(
    "option", [{"largest_step": 1e-3}, {"smallest_step": 1e-15}, {"layers": 1e-3}, {"most_steps": 1}]
)
def test_options_at_the_edge_of_their_range_are_taken(option: dict[str, float]) -> None:
    assert vars(Options(**option)).items() >= option.items()  # type: ignore[arg-type]


def test_a_system_twice_as_large_drills_a_hole_twice_as_large(case: Case) -> None:
    """Lengths doubled, forces kept: w is a force over a length, EI a force times a length squared."""
    bha = replace(
        case.bha,
        stabilizer_positions=tuple(2 * s for s in case.bha.stabilizer_positions),
        stabilizer_clearances=tuple(2 * y for y in case.bha.stabilizer_clearances),
        rss_position=2 * case.bha.rss_position,
        distributed_weight=case.bha.distributed_weight / 2,
        flexural_stiffness=4 * case.bha.flexural_stiffness,
    )
    survey = replace(case.survey, measured_depth=tuple(2 * depth for depth in case.survey.measured_depth))
    weight = case.active_weight_on_bit
    small = Drilling(case.bha, case.bit, case.survey, active_weight_on_bit=weight)
    large = Drilling(bha, case.bit, survey, active_weight_on_bit=weight)
    small.advance(9.0, 700.0, weight)
    large.advance(18.0, 700.0, weight)
    found = large.outputs()
    grown = {"m": 2.0, "N.m": 2.0, "rad/m": 0.5}
    for quantity in OUTPUTS:
        for name in quantity.names(len(bha.stabilizer_positions)):
            expected = small.outputs()[name] * grown.get(quantity.unit, 1.0)
            assert found[name] == pytest.approx(expected, rel=1e-9), name

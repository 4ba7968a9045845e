"""The SI shell: options in, steps and statistics out, errors that name the place."""

import pickle
from dataclasses import replace
from math import nan

import pytest

from boreprop.case.case import Case
from boreprop.core.drilling import Drilling
from boreprop.core.errors import CannotContinue, ParameterError
from boreprop.core.options import Options
from boreprop.core.quantities import OUTPUTS


def drilling(case: Case, **options: float) -> Drilling:
    weight = case.active_weight_on_bit
    return Drilling(case.bha, case.bit, case.survey, active_weight_on_bit=weight, options=Options(**options))  # type: ignore[arg-type]


def test_steps_of_the_integrator_lead_where_one_advance_does(case: Case) -> None:
    stepping, straight = drilling(case), drilling(case)
    while stepping.drilled_length < 10.0:
        stepping.step()
    straight.advance(stepping.drilled_length, 0.0, case.active_weight_on_bit)
    assert straight.outputs() == stepping.outputs()
    assert straight.statistics == stepping.statistics
    assert straight.statistics.accepted > 10


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
    small, large = drilling(case), drilling(replace(case, bha=bha, survey=survey))
    small.advance(9.0, 700.0, case.active_weight_on_bit)
    large.advance(18.0, 700.0, case.active_weight_on_bit)
    found = large.outputs()
    grown = {"m": 2.0, "N.m": 2.0, "rad/m": 0.5}
    for quantity in OUTPUTS:
        for name in quantity.names(len(bha.stabilizer_positions)):
            expected = small.outputs()[name] * grown.get(quantity.unit, 1.0)
            assert found[name] == pytest.approx(expected, rel=1e-9), name


def test_what_cannot_go_on_says_where_why_and_what_helps(case: Case) -> None:
    short = drilling(case, smallest_step=0.5)
    with pytest.raises(CannotContinue) as caught:
        short.advance(5.0, 0.0, case.active_weight_on_bit)
    error = caught.value
    assert str(error) == f"the steps of the integrator become too short at 0 m: {error.helps}"
    assert error.helps == "raise relative_tolerance (--tolerance), now 1e-07"
    assert (error.code, error.place, short.drilled_length) == ("too short", 0.0, 0.0)


def test_the_place_is_in_metres_from_the_start_of_the_run(case: Case) -> None:
    pushed = drilling(case)
    pushed.advance(10.0, 0.0, case.active_weight_on_bit)
    with pytest.raises(CannotContinue, match="the bit turns over at 10") as caught:
        pushed.advance(20.0, 1e9, case.active_weight_on_bit)
    assert 10.0 <= caught.value.place < 20.0
    assert pushed.drilled_length == 10.0
    pushed.advance(20.0, 0.0, case.active_weight_on_bit)


def test_the_error_travels_between_processes() -> None:
    error = CannotContinue.because("no mode", 12.5, 1e-7)
    there = pickle.loads(pickle.dumps(error))
    assert (str(there), there.code, there.place) == (str(error), "no mode", 12.5)


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

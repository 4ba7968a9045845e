"""The options that are refused, and errors between processes; tests/engines drills."""

import pickle
from math import nan

import pytest

from boreprop.core.errors import CannotContinue, ParameterError, error_of
from boreprop.core.options import Options
from boreprop.core.problems import Problem


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

"""Each engine against the reference trajectories."""

import numpy as np
import pytest

from engine_runs import drilled_rows
from reference_cases import CASES, reference

PER_UNIT = 50  # rows for each ℓ₁

everywhere = pytest.mark.parametrize("name", CASES)


def largest(values: np.ndarray) -> float:
    return float(np.abs(values).max())


def errors(engine: str, name: str, **options: float) -> dict[str, float]:
    """The largest error of each column of a reference; of Y(ξ) − Y(ξ−1), which is ⟨Θ⟩_1, instead of Y."""
    got, expected = drilled_rows(engine, name, **options), reference(name)
    assert expected.dtype.names
    forces = {F: f"stabilizer_force[{F[2:]}]" for F in expected.dtype.names[6:]}
    names = {"theta": "bit_inclination", "Theta": "borehole_inclination", "F_0": "bit_lateral_force"} | forces
    found = {column: largest(got[name] - expected[column]) for column, name in names.items()}
    Y = expected["Y"]
    return found | {"Y": largest(got["average_inclination[1]"][PER_UNIT:] - (Y[PER_UNIT:] - Y[:-PER_UNIT]))}


@everywhere
def test_default_tolerance_gives_every_row_of_the_reference(engine: str, name: str) -> None:
    found = errors(engine, name)
    assert found["theta"] <= 1e-5
    assert found["Y"] <= 1e-5
    assert found["Theta"] <= 5e-4


@everywhere
def test_a_tight_tolerance_gives_the_reference_to_1e_7_and_its_forces(engine: str, name: str) -> None:
    found = errors(engine, name, relative_tolerance=1e-9)
    assert found.pop("Y") <= 1e-6
    assert found.pop("Theta") <= 1e-5
    assert max(found.values()) <= 1e-7

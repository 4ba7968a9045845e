"""The model against the reference trajectories."""

import numpy as np
import pytest

from reference_cases import CASES, drilled_rows, reference

everywhere = pytest.mark.parametrize("name", CASES)


def largest(got: dict[str, np.ndarray], expected: np.ndarray, column: str) -> float:
    return float(np.abs(got[column] - expected[column]).max())


@everywhere
def test_default_tolerance_gives_every_row_of_the_reference(name: str) -> None:
    got, expected = drilled_rows(name), reference(name)
    assert largest(got, expected, "theta") <= 1e-5
    assert largest(got, expected, "Y") <= 1e-5
    assert largest(got, expected, "Theta") <= 5e-4


@everywhere
def test_tight_tolerance_gives_the_reference_to_1e_7(name: str) -> None:
    got, expected = drilled_rows(name, 1e-9), reference(name)
    assert largest(got, expected, "theta") <= 1e-7
    assert largest(got, expected, "Y") <= 1e-6


@everywhere
def test_contact_forces_are_those_of_the_reference(name: str) -> None:
    got, expected = drilled_rows(name, 1e-9), reference(name)
    assert expected.dtype.names
    for column in expected.dtype.names[6:]:
        assert largest(got, expected, column) <= 1e-7


@everywhere
def test_bit_force_is_that_of_the_reference(name: str) -> None:
    got, expected = drilled_rows(name, 1e-9), reference(name)
    assert largest(got, expected, "F_0") <= 1e-7

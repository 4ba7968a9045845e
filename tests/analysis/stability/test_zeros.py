"""All zeros of an analytic function, as often as they are there."""

import numpy as np
import pytest

from boreprop.analysis.stability.zeros import Strip, find_zeros
from boreprop.arrays import Complexes


def product(zeros: list[complex], nu: Complexes) -> tuple[Complexes, Complexes]:
    """Π (ν − z) and its slope."""
    value, slope = np.ones_like(nu), np.zeros_like(nu)
    for zero in zeros:
        value, slope = value * (nu - zero), slope * (nu - zero) + value
    return value, slope


@pytest.mark.parametrize(
    "zeros",
    [
        [],
        [0.3],
        [0.3, 0.3, -0.1 + 2j, -0.1 + 2j],
        [0.3, 0.3 + 1e-5, 0.1 + 1e-3j],
        [0.2 + 3j, 0.2 + 3.001j, 0.2 + 3.002j, 0.0],
    ],
    ids=["none", "one", "double", "near each other", "three near each other"],
)
def test_zeros_are_found_as_often_as_they_are_there(zeros: list[complex]) -> None:
    all_of_them = [-3.0, *zeros, *(z.conjugate() for z in map(complex, zeros) if z.imag)]
    found = find_zeros(
        lambda nu: product(all_of_them, nu),
        lambda x, y: product(all_of_them, x + 1j * y[:, None])[0],
        Strip(-0.5, 2.0, 6.0),
        margin=0.1,
        spacing=0.25,
    )
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(np.array(zeros, complex)), abs=1e-7)


def test_a_zero_that_cannot_be_found_is_missed_by_the_count() -> None:
    with pytest.raises(ArithmeticError, match=r"^0 were found, but by the argument principle there are 1$"):
        find_zeros(
            lambda nu: (nu - 1.0, np.full_like(nu, 1e-3)),  # a slope that leads Newton's method astray
            lambda x, y: np.asarray(x + 1j * y[:, None] - 1.0, complex),
            Strip(-0.5, 2.0, 2.0),
            margin=0.1,
            spacing=0.25,
        )

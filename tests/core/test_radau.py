"""The collocation step against matrix exponentials and its own definition."""

from collections.abc import Callable
from math import factorial, perm

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from boreprop.core import radau

STIFF: radau.Jacobian = (-1142.9, 1428.6, 143.9, -228.6)  # the paper's case, in contact, not saturated
GENTLE: radau.Jacobian = (-1.0, 0.4, 0.7, -0.3)


def solve(
    h: float, J: radau.Jacobian, x: np.ndarray, g: Callable[[float], np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """One step of x' = J x + g(ξ) from ξ = 0: x at the end, and the coefficients of the polynomials."""
    f = np.array([np.array(J).reshape(2, 2) @ x + g(t * h) for t in radau.POINTS])
    parts = radau.collocate(h, J, list(f[:, 0]), list(f[:, 1]))
    coefficients = np.array([radau.coefficients(start, part)[1:] for start, part in zip(x, parts, strict=True)])
    return np.array([radau.values(start, part)[-1] for start, part in zip(x, parts, strict=True)]), coefficients


NODES = [t for t in radau.POINTS if t != radau.CHECK]


def test_nodes_are_the_right_radau_nodes() -> None:
    """Roots of P_{S−1} − P_S on [0, 1]."""
    legendre = np.zeros(radau.S + 1)
    legendre[radau.S - 1], legendre[radau.S] = 1, -1
    roots = np.sort(np.polynomial.legendre.legroots(legendre))
    assert NODES == pytest.approx((roots + 1) / 2, abs=1e-13)


def test_eigenvalues_are_those_of_the_inverse_collocation_matrix() -> None:
    t = np.array(NODES)
    powers = np.arange(1, radau.S + 1)
    A = (t[:, None] ** powers) @ np.linalg.inv(powers * t[:, None] ** (powers - 1))
    eigenvalues = np.linalg.eigvals(np.linalg.inv(A))
    for gamma in radau.GAMMA:
        assert np.abs(eigenvalues - gamma).min() < 1e-11


def eigenpolynomials() -> np.ndarray:
    """Coefficients of t … t^S of the polynomials v with v(0) = 0 and v' = γ v at every node, one row for each γ."""
    R = np.polynomial.polynomial.polyfromroots(NODES)  # v' − γ v = R, which is zero there
    v = np.zeros((len(radau.GAMMA), radau.S + 2), dtype=complex)
    for row, gamma in zip(v, radau.GAMMA, strict=True):
        for m in range(radau.S, 0, -1):
            row[m] = ((m + 1) * row[m + 1] - R[m]) / gamma
    return v[:, 1:-1]


def in_real_parts(values: np.ndarray) -> np.ndarray:
    """Factors of the five parts of W in Re Σ_k values[k] W_k, the conjugate halves added."""
    a, b, c = values
    return np.array([a.real, 2 * b.real, -2 * b.imag, 2 * c.real, -2 * c.imag]).T


def test_the_printed_tables_are_those_of_the_nodes_and_eigenvalues() -> None:
    v, m, points = eigenpolynomials(), np.arange(1, radau.S + 1), np.array(radau.POINTS)
    values = in_real_parts(v @ points ** m[:, None])
    into_parts = np.insert(np.linalg.inv(np.delete(values, radau.AT_CHECK, axis=0)), radau.AT_CHECK, 0.0, axis=1)
    np.testing.assert_allclose(radau.VALUES, values, rtol=0, atol=1e-15)
    np.testing.assert_allclose(radau.COEFFICIENTS, in_real_parts(v), rtol=0, atol=1e-15)
    np.testing.assert_allclose(radau.SLOPE, in_real_parts(v @ (m * radau.CHECK ** (m - 1))), rtol=0, atol=1e-15)
    np.testing.assert_allclose(radau.INTO_PARTS, into_parts, rtol=1e-13)


@given(st.floats(1e-4, 1.0), st.sampled_from([STIFF, GENTLE]), st.integers(0, 2**32))
def test_the_polynomial_meets_the_equation_at_every_node(h: float, J: radau.Jacobian, seed: int) -> None:
    random = np.random.default_rng(seed)
    x = random.normal(size=2)
    forcing = random.normal(size=(2, 4))

    def g(xi: float) -> np.ndarray:
        return np.asarray(forcing @ np.cos(np.arange(4) * xi))

    _, c = solve(h, J, x, g)
    m = np.arange(1, radau.S + 1)
    for t in NODES:
        slope = (c * m * t ** (m - 1)).sum(axis=1) / h
        value = x + (c * t**m).sum(axis=1)
        right = np.array(J).reshape(2, 2) @ value + g(t * h)
        assert slope == pytest.approx(right, rel=1e-8, abs=1e-8 * np.abs(J).max())


@given(st.floats(-200.0, 1.0))
def test_a_step_multiplies_a_mode_by_the_padé_approximant_of_the_exponential(z: float) -> None:
    """Radau IIA's stability function is the (S−1, S) Padé approximant: order 2S − 1, and → 0 as z → −∞."""
    k, j = radau.S - 1, radau.S
    numerator = np.polynomial.Polynomial([perm(k, i) / perm(k + j, i) / factorial(i) for i in range(k + 1)])
    denominator = np.polynomial.Polynomial(
        [perm(j, i) / perm(k + j, i) / factorial(i) * (-1) ** i for i in range(j + 1)]
    )
    end, _ = solve(1.0, (z, 0.0, 0.0, z / 3), np.array([1.0, 1.0]), lambda _: np.zeros(2))
    expected = [numerator(z) / denominator(z), numerator(z / 3) / denominator(z / 3)]
    assert end == pytest.approx(expected, abs=1e-9)


def test_a_long_step_from_a_state_at_rest_stays_at_rest() -> None:
    J, constant = np.array(STIFF).reshape(2, 2), np.array([3.0, 1.0])
    rest = np.linalg.solve(J, -constant)
    end, _ = solve(1.0, STIFF, rest, lambda _: constant)
    assert end == pytest.approx(rest, abs=1e-12)


def test_a_coupled_step_is_the_matrix_exponential() -> None:
    x, J = np.array([1.0, -0.5]), np.array(GENTLE).reshape(2, 2)
    end, _ = solve(0.5, GENTLE, x, lambda _: np.zeros(2))
    assert end == pytest.approx(expm(0.5 * J) @ x, abs=1e-10)


@given(st.integers(0, 2**32))
def test_values_and_slope_are_those_of_the_coefficients(seed: int) -> None:
    start, *parts = np.random.default_rng(seed).normal(size=6)
    polynomial = np.polynomial.Polynomial(radau.coefficients(start, tuple(parts)))
    assert radau.values(start, tuple(parts)) == pytest.approx(polynomial(np.array(radau.POINTS)), abs=1e-12)
    assert radau.slope(tuple(parts)) == pytest.approx(polynomial.deriv()(radau.CHECK), abs=1e-12)


def test_an_error_is_the_defect_with_its_stiff_part_damped() -> None:
    h, defects = 0.3, np.array([1.0, -2.0])
    expected = np.linalg.solve(np.eye(2) - h * np.array(STIFF).reshape(2, 2) / radau.GAMMA[0].real, defects)
    assert radau.error(h, STIFF, *defects) == pytest.approx(expected)

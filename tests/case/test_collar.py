"""Stiffness and weight of collars against published tables."""

import pytest

from boreprop.case.collar import STEEL_DENSITY, buoyant_weight, flexural_stiffness

INCH = 0.0254
POUND_PER_FOOT = 0.45359237 * 9.80665 / 0.3048  # N/m


@pytest.mark.parametrize(
    ("outer", "inner", "pounds_per_foot"),
    [(4.75, 2.25, 47), (6.0, 2.25, 83), (6.75, 2.25, 108), (8.0, 2.8125, 150)],
)
def test_weight_in_air_is_that_of_the_tables_of_api_collars(outer: float, inner: float, pounds_per_foot: float) -> None:
    weight = buoyant_weight(outer * INCH, inner * INCH, 0.0) / POUND_PER_FOOT
    assert weight == pytest.approx(pounds_per_foot, abs=0.6)


def test_mud_takes_off_the_handbooks_share() -> None:
    """The handbooks' buoyancy factor is 1 − mud weight / 65.5 ppg."""
    collar = (6.75 * INCH, 2.75 * INCH)
    factor = buoyant_weight(*collar, 10.0 * 119.826) / buoyant_weight(*collar, 0.0)
    assert factor == pytest.approx(1 - 10.0 / 65.5, abs=2e-4)


def test_mud_as_dense_as_steel_carries_it_all() -> None:
    assert buoyant_weight(0.2, 0.07, STEEL_DENSITY) == 0.0


def test_stiffness_of_a_published_collar() -> None:
    """BHAtp.jl, case_01: collars of 7 in by 2 3/4 in have 9.575e6 N m², with E = 29e6 psi in place of 206 GPa."""
    stiffness = flexural_stiffness(7.0 * INCH, 2.75 * INCH)
    assert stiffness * 29e6 * 6894.757 / 206e9 == pytest.approx(9.575e6, rel=1e-3)


def test_stiffness_is_that_of_the_sum_of_thin_tubes() -> None:
    """A thin tube of radius r and wall t has I = π r³ t."""
    outer, inner, count = 0.1, 0.04, 20_000
    wall = (outer - inner) / count
    radii = [inner + (i + 0.5) * wall for i in range(count)]
    moment = sum(3.141592653589793 * radius**3 * wall for radius in radii)
    assert flexural_stiffness(2 * outer, 2 * inner) == pytest.approx(206e9 * moment, rel=1e-8)

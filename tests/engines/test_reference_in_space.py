"""The short program of the model in space, `reference/spatial.py`, against trajectories of another one."""

import numpy as np
import pytest
from numpy.typing import NDArray

from reference.spatial import (
    CASES,
    Beam,
    Row,
    System,
    bit_tilt,
    contact_forces,
    drill,
    read_reference,
    system_of,
    turned,
)

ROWS = 0.1  # ξ from row to row of the references
FEW = 5.0  # ℓ₁ that are drilled in a test that takes a second
SMOOTH = {"toolface_inclined": 0.02, "four_stabilizers": 0.01, "through_vertical": 0.025, "long_turn": 0.02}
STIFF = {"spiral": 0.001, "walk_spiral": 0.001}  # θ follows M within a few thousandths of ℓ₁


def run(name: str, length: float, step: float) -> list[Row]:
    return drill(system_of(name), length, step, every=round(ROWS / step))


def errors(name: str, rows: list[Row]) -> dict[str, float]:
    """The largest error of the bit's axis, of the direction and the place of the hole, and of the contact forces."""
    expected = read_reference(name)[: len(rows)]
    found = {
        "d": largest(np.array([row.d for row in rows]) - world(expected, "d")),
        "T": largest(np.array([row.T for row in rows]) - world(expected, "T")),
        "R": largest(np.array([row.R for row in rows]) - world(expected, "x")),
    }
    for i in range(len(CASES[name]["y_star"])):
        forces = np.array([row.frame[:, :2] @ row.F[i] for row in rows])
        found[f"F_{i + 1}"] = largest(forces - world(expected, f"F{i + 1}"))
    return found


def world(rows: NDArray[np.void], name: str) -> NDArray[np.float64]:
    return np.column_stack([rows[f"{name}_{axis}"] for axis in "ned"])


def largest(values: NDArray[np.float64]) -> float:
    return float(abs(values).max())


@pytest.mark.parametrize("name", SMOOTH)
def test_a_smooth_case_is_the_reference(name: str) -> None:
    assert max(errors(name, run(name, FEW, SMOOTH[name])).values()) < 1.5e-5


@pytest.mark.parametrize("name", STIFF)
def test_a_spiral_begins_as_the_reference(name: str) -> None:
    found = errors(name, run(name, 2.0, STIFF[name]))
    assert found.pop("T") < 4e-5
    assert max(found.values()) < 2e-6


@pytest.mark.slow
def test_a_whole_spiral_is_the_reference_whose_errors_grow_150_times() -> None:
    found = errors("spiral", run("spiral", CASES["spiral"]["length"], 0.002))
    assert found["d"] < 6e-4
    assert found["R"] < 2e-3


def test_the_error_falls_with_the_fourth_power_of_the_step() -> None:
    coarse, fine = (errors("long_turn", run("long_turn", FEW, step))["d"] for step in (0.02, 0.01))
    assert coarse > 14 * fine


def test_contact_forces_are_where_the_walls_are_and_push_inwards() -> None:
    random = np.random.default_rng(1)
    for _ in range(200):
        n = int(random.integers(2, 7))
        system = some_system(tuple(np.cumsum(np.append(1.0, random.uniform(0.2, 2.0, n - 1)))))
        q = random.normal(size=(n - 1, 2)) * 10.0 ** random.uniform(-4, -1)
        y_star = random.uniform(0.0, 3e-3, n - 1) * random.integers(0, 2, n - 1)
        K_inv = Beam(system).K_inv
        F = contact_forces(K_inv, q, y_star.tolist(), np.zeros_like(q))
        delta, size = K_inv @ F + q, np.hypot(*F.T)
        rounding = 1e-14 * (abs(K_inv) @ size).max()
        assert (np.hypot(*delta.T) <= y_star + rounding).all()
        np.testing.assert_allclose(np.sum(delta * F, axis=1), -y_star * size, atol=rounding * size.max())


def some_system(s: tuple[float, ...]) -> System:
    none = (0.0,) * (len(s) - 1)
    return System(s, none, 0.2, 0.0, 0.1, 0.1, 0.01, 0.0, np.zeros(1), np.zeros((1, 2)), np.eye(3))


def test_the_tilt_turns_against_the_force_by_the_walk_until_the_gauge_takes_part_of_it() -> None:
    random = np.random.default_rng(2)
    for _ in range(200):
        walk, eta_pi, psi_star = random.uniform(-1.5, 1.5), random.uniform(0.01, 1.0), random.uniform(0.001, 0.1)
        F_0 = random.normal(size=2) * eta_pi * psi_star
        psi = bit_tilt(F_0, eta_pi, psi_star, walk)
        gauge = F_0 - eta_pi * turned(walk) @ psi  # on the gauge: along ψ, and only where |ψ| = ψ*
        share = gauge @ psi / psi_star**2
        np.testing.assert_allclose(gauge, share * psi, atol=1e-14)
        assert share > -1e-12
        assert share < 1e-12 or np.hypot(*psi) == pytest.approx(psi_star)

"""Rippling, found in made-up signals and in the reference trajectories."""

from math import radians

import numpy as np
import pytest

from boreprop.analysis.rippling import AXIS_REACH, axis_ripple, find_rippling
from reference_cases import reference

XI = np.linspace(0.0, 60.0, 3001)


def wave(wavelength: float, amplitude_deg: float) -> np.ndarray:
    return radians(amplitude_deg) * np.sin(2 * np.pi * XI / wavelength)


@pytest.mark.parametrize(
    ("name", "wavelength", "amplitude_deg"),
    [("fig7_psi_2deg", 1.386, 2.43), ("fig7_psi_1deg", 1.386, 1.20), ("fig7_psi_0.5deg", 1.366, 0.58)],
)
def test_the_rippling_reference_runs_ripple_with_their_wave(name: str, wavelength: float, amplitude_deg: float) -> None:
    rows = reference(name)
    found = find_rippling(rows["xi"], rows["Theta"], 1.0)
    assert found.ripples
    assert found.wavelength == pytest.approx(wavelength, abs=0.004)
    assert np.degrees(found.amplitude) == pytest.approx(amplitude_deg, rel=0.05)


@pytest.mark.parametrize(
    "name",
    [
        "fig7_psi_0.1deg",
        "fig8_clearance_1.5e-3",
        "fig8_clearance_2e-3",
        "steering_two_stabilizers",
    ],
)
def test_the_other_reference_runs_do_not(name: str) -> None:
    rows = reference(name)
    assert not find_rippling(rows["xi"], rows["Theta"], 1.0).ripples


def test_wavelength_and_amplitude_are_in_the_units_of_the_run() -> None:
    found = find_rippling(3.66 * XI, wave(1.4, 1.0), 3.66)
    assert found.wavelength == pytest.approx(3.66 * 1.4, rel=1e-3)
    assert np.degrees(found.amplitude) == pytest.approx(1.0, rel=0.02)


def test_a_build_section_under_the_wave_does_not_hide_it() -> None:
    found = find_rippling(XI, 0.5 + 0.01 * XI + wave(1.4, 0.5), 1.0)
    assert found.ripples
    assert found.wavelength == pytest.approx(1.4, rel=1e-2)


def test_noise_on_the_wave_does_not_hide_it() -> None:
    noise = np.random.default_rng(1).normal(scale=np.radians(0.01), size=XI.shape)
    assert find_rippling(XI, wave(1.4, 1.0) + noise, 1.0).wavelength == pytest.approx(1.4, rel=2e-2)


@pytest.mark.parametrize(
    "signal",
    [
        np.zeros_like(XI),
        0.01 * XI,
        wave(1.4, 1.0) * np.exp(-0.3 * XI),  # dies out
        wave(1.4, 1.0) * (XI < 40.0),  # has died out
        np.where(XI % 10.0 < 5.0, 0.0, 0.01),  # steps of the force
        np.random.default_rng(1).normal(scale=0.01, size=XI.shape),
    ],
    ids=["nothing", "a build", "a dying wave", "a dead wave", "steps", "noise"],
)
def test_what_is_no_lasting_wave_is_not_rippling(signal: np.ndarray) -> None:
    assert not find_rippling(XI, signal, 1.0).ripples


def test_a_run_too_short_to_tell_does_not_ripple() -> None:
    assert not find_rippling(XI[:100], wave(1.4, 1.0)[:100], 1.0).ripples


def arc(length: np.ndarray, curvature: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions on an arc that starts downwards, and the directions to its high side."""
    angle = curvature * length
    position = np.column_stack((1 - np.cos(angle), np.sin(angle))) / curvature
    return position, np.column_stack((np.cos(angle), -np.sin(angle)))


def test_an_evenly_curved_axis_has_no_ripple() -> None:
    length = np.arange(0.0, 200.0, 0.1)
    _, ripple = axis_ripple(length, arc(length, radians(2.0) / 30)[0], 3.66)
    assert np.abs(ripple).max() < 1e-5


@pytest.mark.parametrize("wavelength", [1.2, 1.4, 2.0])
def test_the_ripple_of_a_wavy_arc_is_its_wave(wavelength: float) -> None:
    length, scale = np.arange(0.0, 200.0, 0.02), 3.66
    position, high_side = arc(length, radians(2.0) / 30)
    number = 2 * np.pi / (wavelength * scale)
    at, ripple = axis_ripple(length, position + 0.03 * np.sin(number * length)[:, None] * high_side, scale)
    np.testing.assert_allclose(ripple, 0.03 * np.sin(number * at), atol=0.03 * 0.05)


def test_a_ripple_is_known_as_far_as_its_trend_is() -> None:
    length = np.arange(0.0, 20.0, 0.1)
    straight = np.column_stack((np.zeros_like(length), length))
    at, _ = axis_ripple(length, straight, 1.0)
    assert at[0] == pytest.approx(AXIS_REACH)
    assert at[-1] == pytest.approx(length[-1] - AXIS_REACH, abs=1 / 40)
    assert axis_ripple(length[:70], straight[:70], 1.0)[0].size == 0

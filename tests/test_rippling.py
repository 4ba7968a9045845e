"""Rippling, found in made-up signals and in the reference trajectories."""

from math import radians

import numpy as np
import pytest

from boreprop.analysis.rippling import find_rippling
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

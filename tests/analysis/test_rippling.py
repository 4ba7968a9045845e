"""Rippling, found in made-up signals and in the reference trajectories."""

from dataclasses import dataclass, field
from math import degrees, radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from boreprop.analysis.axis import AXIS_REACH, axis_ripple
from boreprop.analysis.rippling import find_rippling
from boreprop.analysis.search import State
from boreprop.case.paper import LENGTH_SCALE, paper_case
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from reference_cases import reference

XI = np.linspace(0.0, 60.0, 3001)
LONGEST = 3.0  # of the paper's BHA, in ℓ₁


def wave(wavelength: float, amplitude_deg: float) -> np.ndarray:
    return radians(amplitude_deg) * np.sin(2 * np.pi * XI / wavelength)


@pytest.mark.parametrize(
    ("name", "wavelength", "amplitude_deg"),
    [("fig7_psi_2deg", 1.386, 2.43), ("fig7_psi_1deg", 1.386, 1.20), ("fig7_psi_0.5deg", 1.366, 0.57)],
)
def test_the_rippling_reference_runs_ripple_with_their_wave(name: str, wavelength: float, amplitude_deg: float) -> None:
    rows = reference(name)
    found = find_rippling(rows["xi"], rows["Theta"], LONGEST)
    assert found.ripples
    assert found.wavelength == pytest.approx(wavelength, abs=0.002)
    assert np.degrees(found.amplitude) == pytest.approx(amplitude_deg, rel=0.02)


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
    assert not find_rippling(rows["xi"], rows["Theta"], LONGEST).ripples


def test_wavelength_and_amplitude_are_in_the_units_of_the_run() -> None:
    found = find_rippling(3.66 * XI, wave(1.4, 1.0), 3.66 * LONGEST)
    assert found.wavelength == pytest.approx(3.66 * 1.4, rel=1e-3)
    assert np.degrees(found.amplitude) == pytest.approx(1.0, rel=0.02)


def test_a_build_section_under_the_wave_does_not_hide_it() -> None:
    found = find_rippling(XI, 0.5 + 0.01 * XI + wave(1.4, 0.5), LONGEST)
    assert found.ripples
    assert found.wavelength == pytest.approx(1.4, rel=1e-2)


def test_noise_on_the_wave_does_not_hide_it() -> None:
    noise = np.random.default_rng(1).normal(scale=np.radians(0.01), size=XI.shape)
    assert find_rippling(XI, wave(1.4, 1.0) + noise, LONGEST).wavelength == pytest.approx(1.4, rel=2e-2)


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
    assert not find_rippling(XI, signal, LONGEST).ripples


def test_a_run_too_short_to_tell_does_not_ripple() -> None:
    assert not find_rippling(XI[:100], wave(1.4, 1.0)[:100], LONGEST).ripples


@dataclass
class Wavy:
    """Made-up rows of a run: a wave of any shape under a drift and noise; lengths in ℓ₁, angles in degrees."""

    xi: np.ndarray = field(repr=False)
    wavelength: float
    shape: np.ndarray = field(repr=False)
    drift: float
    noise: np.ndarray = field(repr=False)

    @property
    def inclination(self) -> NDArray[np.float64]:
        return np.asarray(np.radians(10.0 + self.drift * self.xi + self.shape + self.noise))

    @property
    def amplitude(self) -> float:
        return float(np.ptp(self.shape)) / 2


@st.composite
def wavy(draw: st.DrawFn) -> Wavy:
    """From 10 rows a wave on, ends at any phase; a harmonic gives a wave up to four zeros more."""
    wavelength, amplitude = draw(st.floats(0.7, 2.2)), draw(st.floats(0.5, 3.0))
    xi = np.arange(0.0, draw(st.floats(20.0, 70.0)), wavelength / draw(st.floats(10.0, 100.0)))
    phase = 2 * np.pi * xi / wavelength + draw(st.floats(0.0, 7.0))
    harmonic = draw(st.floats(0.0, 0.8)) * np.sin(draw(st.sampled_from((2, 3))) * phase + draw(st.floats(0.0, 7.0)))
    noise = np.random.default_rng(draw(st.integers(0, 10**6))).normal(scale=0.05, size=len(xi))
    drift = draw(st.floats(-8.0, 8.0)) * LENGTH_SCALE / 30.0
    return Wavy(xi, wavelength, amplitude * (np.sin(phase) + harmonic), drift, noise)


@given(wavy())
def test_any_lasting_wave_is_found_through_drift_and_noise(signal: Wavy) -> None:
    found = find_rippling(signal.xi, signal.inclination, LONGEST)
    assert found.ripples
    assert found.wavelength == pytest.approx(signal.wavelength, rel=0.02)
    assert degrees(found.amplitude) == pytest.approx(signal.amplitude, rel=0.1, abs=3 * 0.05)
    assert degrees(found.inclination_drift) == pytest.approx(signal.drift, abs=0.02)


@given(wavy())
def test_drift_and_noise_alone_are_no_wave(signal: Wavy) -> None:
    assert not find_rippling(signal.xi, signal.inclination - np.radians(signal.shape), LONGEST).ripples


def test_a_wave_that_is_mostly_its_third_harmonic_is_as_long_as_its_period() -> None:
    found = find_rippling(XI, wave(1.4, 1.0) + wave(1.4 / 3, 0.9), LONGEST)
    assert found.wavelength == pytest.approx(1.4, rel=1e-3)


def test_noise_that_happens_to_cross_its_trend_evenly_is_no_wave() -> None:
    rng = np.random.default_rng(5)
    for rows_per_length, length in rng.uniform((8.0, 12.0), (60.0, 60.0), size=(600, 2)):
        xi = np.arange(0.0, length, 1 / rows_per_length)
        assert not find_rippling(xi, 0.01 * rng.normal(size=len(xi)), LONGEST).ripples


@given(wavy(), st.floats(0.2, 1.0))
def test_a_wave_that_dies_out_is_not_rippling(signal: Wavy, rate: float) -> None:
    dying = signal.shape * np.exp(-rate * signal.xi / signal.wavelength)
    assert not find_rippling(signal.xi, np.radians(dying + signal.drift * signal.xi), LONGEST).ripples


@pytest.mark.parametrize(
    ("rate", "state"),
    [(-0.05, State.DYING), (-0.02, State.LASTING), (0.0, State.LASTING), (0.02, State.LASTING), (0.05, State.GROWING)],
)
def test_the_growth_of_a_wave_is_told_and_what_becomes_of_it(rate: float, state: State) -> None:
    found = find_rippling(3.66 * XI, wave(1.4, 1.0) * np.exp(rate * XI / 1.4), 3.66 * LONGEST)
    assert found.state is state
    assert found.growth == pytest.approx(rate / (1.4 * 3.66), abs=1e-4)


def test_a_wave_is_said_to_have_been_there_since_it_had_half_its_size() -> None:
    found = find_rippling(3.66 * XI, wave(1.4, 1.0) * np.clip((XI - 20.0) / 10.0, 0.0, 1.0), 3.66 * LONGEST)
    assert found.since == pytest.approx(3.66 * 25.0, abs=3.66 * 1.4)


def test_a_wave_while_the_force_changes_too_often_is_steered() -> None:
    force = np.floor(XI / 5.0)
    assert find_rippling(XI, wave(1.4, 1.0), LONGEST, inputs=[force]).state is State.STEERED
    held = np.where(XI > 40.0, 8.0, force)
    assert find_rippling(XI, wave(1.4, 1.0), LONGEST, inputs=[held]).state is State.LASTING


def test_a_wave_in_one_mode_is_linear_so_it_dies_however_slowly() -> None:
    slow = wave(1.4, 1.0) * np.exp(-0.005 * XI / 1.4)
    modes = np.zeros((len(XI), 2), dtype=int)
    assert find_rippling(XI, slow, LONGEST, modes=modes).state is State.DYING
    modes[:, 0] = np.sign(slow)
    assert find_rippling(XI, slow, LONGEST, modes=modes).state is State.LASTING


def test_while_the_bit_stands_still_the_last_row_counts() -> None:
    held = np.sort(np.concatenate((XI, XI[::7])))
    inclination = np.interp(held, XI, wave(1.4, 1.0))
    assert find_rippling(held, inclination, LONGEST).wavelength == pytest.approx(1.4, rel=1e-3)


@dataclass
class Waves:
    """Made-up rows of a run: waves of some shape that grow or fall a little on a trend that settles; m and rad."""

    length: NDArray[np.float64] = field(repr=False)
    inclination: NDArray[np.float64] = field(repr=False)
    wavelength: float
    amplitude: float  # at the end
    growth: float  # per wave


SHAPES = (np.sin, lambda x: np.clip(2 * np.sin(x), -1, 1), lambda x: np.arcsin(np.sin(x)) / (np.pi / 2))


@st.composite
def waves(draw: st.DrawFn) -> Waves:
    wavelength, amplitude = draw(st.floats(0.5, 40.0)), radians(draw(st.floats(0.01, 3.0)))
    length = np.arange(0.0, wavelength * draw(st.floats(12.0, 60.0)), wavelength / draw(st.floats(20.0, 100.0)))
    growth = draw(st.floats(-0.02, 0.06))
    wave = amplitude * draw(st.sampled_from(SHAPES))(2 * np.pi * length / wavelength + draw(st.floats(0.0, 7.0)))
    trend = radians(draw(st.floats(0.0, 90.0))) + radians(draw(st.floats(-8.0, 8.0))) / 30.0 * length
    settling = 20 * amplitude * np.exp(-draw(st.floats(0.0, 2.0)) * length / length[-1])
    grown = wave * np.exp(growth * (length - length[-1]) / wavelength)
    return Waves(length, trend + settling + grown, wavelength, amplitude, growth)


@given(waves())
def test_waves_are_found_from_half_a_metre_to_forty(made: Waves) -> None:
    found = find_rippling(made.length, made.inclination)
    assert found.ripples
    assert found.wavelength == pytest.approx(made.wavelength, rel=0.02)
    assert found.growth * made.wavelength == pytest.approx(made.growth, abs=0.01)
    ago = made.amplitude * np.exp(-20 * made.growth)  # the amplitude is that of the mean of the last twenty waves
    assert 0.9 * min(ago, made.amplitude) < found.amplitude < 1.1 * max(ago, made.amplitude)


def test_the_spread_is_that_of_the_last_wavelengths() -> None:
    lengths = np.where(np.arange(60) % 2, 1.35, 1.45)
    phase = np.interp(XI, np.concatenate(([0.0], np.cumsum(lengths))), np.arange(61))
    found = find_rippling(upright_run(3.66 * XI, np.sin(2 * np.pi * phase) * radians(1.0)), longest=3.66 * LONGEST)
    assert found.wavelength == pytest.approx(3.66 * 1.4, rel=0.01)
    assert found.spread == pytest.approx(3.66 * 0.05, rel=0.3)


def upright_run(length: NDArray[np.float64], inclination: NDArray[np.float64]) -> Trajectory:
    """A run of a BHA with one stabilizer, from its inclination alone."""
    steps = np.diff(length, prepend=length[0])
    columns = {
        "drilled_length": length,
        "borehole_inclination": inclination,
        "average_inclination[1]": inclination,
        "displacement": np.cumsum(np.sin(inclination) * steps),
        "true_vertical_depth": np.cumsum(np.cos(inclination) * steps),
        "bit_tilt_saturation": np.sign(inclination),
    }
    return Trajectory(columns)


@pytest.fixture(scope="module")
def paper_run() -> Trajectory:
    return simulate(paper_case(), sample_interval=0.02 * LENGTH_SCALE)


def test_the_ripple_of_the_axis_is_the_wave_that_the_inclination_makes(paper_run: Trajectory) -> None:
    found = find_rippling(paper_run)
    xi, Theta = reference("fig7_psi_2deg")["xi"], reference("fig7_psi_2deg")["Theta"]
    Y = np.concatenate(([0.0], np.cumsum((Theta[1:] + Theta[:-1]) / 2 * np.diff(xi))))
    late = Y[(xi > 40.0) & (xi < 40.0 + 10 * 1.386)]
    late = late - np.linspace(late[0], late[-1], len(late))  # ten waves: their trend is what they do not come back from
    assert found.axis_amplitude == pytest.approx(LENGTH_SCALE * np.ptp(late) / 2, rel=0.05)


@pytest.mark.parametrize("rows_a_wave", [10, 20, 70])
def test_stabilizer_and_tilt_go_from_limit_to_limit_in_a_wave_of_the_paper(rows_a_wave: int) -> None:
    found = find_rippling(simulate(paper_case(), sample_interval=1.386 * LENGTH_SCALE / rows_a_wave))
    held = [stretch[:2] for stretch in found.modes if stretch.share > 0.2]
    assert held == [((1,), -1), ((-1,), 1)]
    assert sum(stretch.share for stretch in found.modes) == pytest.approx(1.0)


def test_the_modes_of_a_wave_are_those_of_its_rows(paper_run: Trajectory) -> None:
    found = find_rippling(paper_run)
    late = paper_run["drilled_length"] > 40.0 * LENGTH_SCALE
    for wall in (-1, 0, 1):
        share = sum(stretch.share for stretch in found.modes if stretch.contact == (wall,))
        assert share == pytest.approx(np.mean(paper_run["stabilizer_contact[1]"][late] == wall), abs=0.03)


def test_a_run_that_does_not_ripple_has_no_wave_to_examine() -> None:
    found = find_rippling(simulate(paper_case(clearance=2e-3), sample_interval=0.1))
    assert (found.ripples, found.modes, np.isnan(found.axis_amplitude)) == (False, (), True)


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


def test_ctrl_c_while_modes_are_found_is_not_lost(paper_run: Trajectory, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    # numpy compares rows as structures by this, and hides what interrupts it behind an error of its own
    monkeypatch.setattr("numpy._core._internal._promote_fields", interrupted, raising=False)
    assert find_rippling(paper_run).modes

"""`boreprop-fmu run` under schedules of several inputs: exactly what `simulate` drills, however long the steps are."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.core.quantities import OUTPUTS, scalar_names
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from conftest import Command, Pack, assert_refused
from flavours import NATIVE, PYTHON, Flavour, both_flavours

LENGTH = 24.0


def scheduled(case: Case, interpolation: str, rates: tuple[float, ...] = ()) -> Case:
    """The paper's case under a force, a weight and perhaps a rate that change at lengths of their own."""
    inputs: list[tuple[str, tuple[float, ...]]] = [("active_weight_on_bit", (2e3, 6e3, 1e3))]
    if rates:
        inputs.append(("rate_of_penetration", rates))
    return replace(
        case,
        length=LENGTH,
        active_weight_on_bit=2e3,
        schedule=Schedule((0.0, 5.0, 9.5), (0.0, 3e3, -1e3), interpolation),
        inputs=InputSchedule((0.0, 6.3, 13.0), tuple(inputs), interpolation),
    )


def run_of(command: Command, fmu: Path, folder: Path, *more: str) -> Trajectory:
    done = command("boreprop-fmu", "run", fmu, "--output", "run.csv", *more)
    assert done.returncode == 0, done.stderr
    return read_trajectory(folder / "run.csv")


def assert_drilled(run: Trajectory, case: Case, interval: float) -> None:
    """Every input that acts and every output as `simulate` gives it at the rows of a run, within 1e-9."""
    expected = simulate(case, sample_interval=interval, length=LENGTH, engine="native")
    for name in ("rss_force", "active_weight_on_bit", *scalar_names(OUTPUTS, 2)):
        scale = max(1.0, float(np.abs(expected[name]).max()))
        np.testing.assert_allclose(run[name], expected[name], rtol=0, atol=1e-9 * scale, err_msg=name)


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize("step", [0.4, 1.5])
def test_linear_inputs_are_followed_exactly(
    case: Case, pack: Pack, command: Command, tmp_path: Path, step: float
) -> None:
    ramps = scheduled(case, "linear")
    run = run_of(command, pack(ramps, NATIVE), tmp_path, "--step", str(step))
    assert run.case == ramps
    assert_drilled(run, ramps, step)


@pytest.mark.usefixtures("kernel")
@both_flavours
def test_held_inputs_are_followed_exactly(
    case: Case, flavour: Flavour, pack: Pack, command: Command, tmp_path: Path
) -> None:
    held = scheduled(case, "held")
    assert_drilled(run_of(command, pack(held, flavour), tmp_path, "--step", "1.5"), held, 1.5)


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize("interpolation", ["held", "linear"])
def test_the_rate_of_penetration_changes_the_time_and_not_the_hole(
    case: Case, pack: Pack, command: Command, tmp_path: Path, interpolation: str
) -> None:
    """With 6.3 m at 2 m/s, 6.7 m at 0.5 m/s and the rest at 1 m/s, the time at each length is known."""
    slow = scheduled(case, interpolation, rates=(2.0, 0.5, 1.0))
    run = run_of(command, pack(slow, NATIVE), tmp_path, "--step", "0.25", "--stop", "25")
    lengths, times = (0.0, 6.3, 13.0, 21.45), (0.0, 3.15, 16.55, 25.0)
    np.testing.assert_allclose(run["drilled_length"], np.interp(run["time"], times, lengths), atol=1e-9)
    whole = simulate(scheduled(case, interpolation), sample_interval=0.01, length=22.0, engine="native")
    rows = np.rint(run["drilled_length"] / 0.01).astype(int)
    on = np.abs(run["drilled_length"] - 0.01 * rows) < 1e-6
    assert on.sum() > 20
    for name in ("bit_inclination", "average_inclination[1]", "displacement"):
        np.testing.assert_allclose(run[name][on], whole[name][rows[on]], rtol=0, atol=1e-7, err_msg=name)


def test_an_fmu_that_does_not_interpolate_refuses_a_linear_schedule(
    case: Case, pack: Pack, command_here: Command, tmp_path: Path
) -> None:
    done = command_here("boreprop-fmu", "run", pack(scheduled(case, "linear"), PYTHON), "--output", "run.csv")
    assert_refused(done, "Borehole.fmu: must interpolate inputs for a linear schedule", "--runtime native")
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("kernel")
def test_a_schedule_file_gives_any_input_and_leaves_the_others(
    fmu: Path, case: Case, command: Command, tmp_path: Path
) -> None:
    (tmp_path / "schedule.csv").write_text("drilled_length,force_kN,active_weight_on_bit_kN\n0,1,2\n3.3,-1,5\n")
    run = run_of(command, fmu, tmp_path, "--schedule", "schedule.csv", "--step", "1", "--stop", str(LENGTH))
    weights = ("active_weight_on_bit", (2e3, 5e3))
    given = replace(
        case,
        active_weight_on_bit=2e3,
        schedule=Schedule((0.0, 3.3), (1e3, -1e3)),
        inputs=InputSchedule((0.0, 3.3), (weights,)),
    )
    assert run.case == given
    assert_drilled(run, given, 1.0)


def interbedded(case: Case) -> Case:
    """The paper's case in hard and soft rock, with bits whose tilt is limited more and less."""
    rock = (
        ("lateral_steering_resistance", (10.0, 25.0, 6.0)),
        ("angular_steering_resistance", (1.0, 0.8, 1.3)),
        ("bit_tilt_limit", (0.03, 0.004, 0.02)),
    )
    schedule = Schedule((0.0, 5.0, 9.5), (0.0, 3e3, -1e3))
    return replace(case, length=LENGTH, schedule=schedule, inputs=InputSchedule((0.0, 6.3, 13.0), rock))


@pytest.mark.usefixtures("kernel")
@both_flavours
def test_rock_is_followed_exactly(case: Case, flavour: Flavour, pack: Pack, command: Command, tmp_path: Path) -> None:
    rock = interbedded(case)
    run = run_of(command, pack(rock, flavour), tmp_path, "--step", "1.5")
    assert run.case == rock
    assert_drilled(run, rock, 1.5)
    assert run["bit_tilt_limit"].tolist() == [0.03] * 5 + [0.004] * 4 + [0.02] * 8


@pytest.mark.usefixtures("kernel")
def test_rock_that_changes_evenly_is_followed_exactly(case: Case, pack: Pack, command: Command, tmp_path: Path) -> None:
    rock = interbedded(case)
    assert rock.inputs is not None
    ramp = replace(rock, inputs=replace(rock.inputs, interpolation="linear"))
    run = run_of(command, pack(ramp, NATIVE), tmp_path, "--step", "0.4")
    assert_drilled(run, ramp, 0.4)
    for name, values in rock.inputs.inputs:
        expected = np.interp(run["drilled_length"], rock.inputs.drilled_length, values)
        np.testing.assert_allclose(run[name], expected, rtol=1e-9)


@pytest.mark.usefixtures("kernel")
def test_rock_is_held_while_a_force_is_linear(case: Case, pack: Pack, command: Command, tmp_path: Path) -> None:
    rock = interbedded(case)
    ramp = replace(rock, schedule=replace(rock.schedule, interpolation="linear"))
    assert_drilled(run_of(command, pack(ramp, NATIVE), tmp_path, "--step", "0.4"), ramp, 0.4)

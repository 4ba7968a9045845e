"""The FMU as a running component. Every FMU runs in a process of its own, where the model is nowhere but in the FMU."""

import json
import os
from dataclasses import replace
from functools import partial
from itertools import product
from math import degrees, inf, radians
from pathlib import Path

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.case.inputs import Schedule
from boreprop.core.quantities import OUTPUTS, ROCK, quantity_of, scalar_names
from boreprop.core.survey import Survey
from boreprop.core.system import BottomHoleAssembly
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from conftest import Command, Pack
from flavours import Flavour, both_flavours
from scenarios import report

host = partial(report, "fmu_host")


def assert_agrees(rows: list[dict[str, float]], expected: Trajectory, tolerance: float) -> None:
    """Every output within `tolerance` of its largest value in the run, or of one of its unit."""
    assert len(rows) == expected.row_count
    for name in rows[0]:
        column = np.array([row[name] for row in rows])
        scale = max(1.0, float(np.abs(expected[name]).max()))
        assert np.abs(column - expected[name]).max() <= tolerance * scale, name


@pytest.fixture(scope="module")
def three(case: Case) -> Case:
    """A case with three stabilizers."""
    return replace(case, bha=BottomHoleAssembly((3.0, 6.5, 11.0), (2e-3, 4e-3), 0.5, 1100.0, 8e6))


@pytest.fixture(scope="module")
def fmu_3(three: Case, flavour: Flavour, pack: Pack) -> Path:
    return pack(three, flavour)


@both_flavours
@pytest.mark.parametrize(
    ("step", "count", "forces"),
    [
        (9.0, 5, {0: 0.0, 2: 2e3, 3: -1e3}),  # longer than the BHA
        (0.97, 40, {0: 1e3, 7: -2e3, 19: 500.0}),
        (3.66e-3, 500, {0: 0.0, 100: 3e3, 250: -3e3}),  # ℓ₁/1000
    ],
    ids=["longer than the BHA", "about 1 m", "a thousandth of the first length"],
)
@pytest.mark.parametrize("stabilizers", [2, 3])
def test_it_is_the_simulation_at_any_communication_step(
    case: Case,
    three: Case,
    flavour: Flavour,
    fmu: Path,
    fmu_3: Path,
    stabilizers: int,
    step: float,
    count: int,
    forces: dict[int, float],
) -> None:
    which, path = (case, fmu) if stabilizers == 2 else (three, fmu_3)
    run = host("follow", path, json.dumps(forces), step, count, 0.0, 1.0)
    assert run["modules"] == flavour.modules
    schedule = Schedule(tuple(k * step for k in forces), tuple(forces.values()))
    expected = simulate(replace(which, schedule=schedule), sample_interval=step, length=count * step)
    assert_agrees(run["rows"], expected, 1e-9)


@both_flavours
def test_neither_the_clock_nor_the_rate_of_penetration_matters(case: Case, fmu: Path) -> None:
    run = host("follow", fmu, json.dumps({0: 1e3, 11: -2e3}), 80.0, 40, 5e4, 0.00625)
    schedule = Schedule((0.0, 5.5), (1e3, -2e3))
    assert_agrees(run["rows"], simulate(replace(case, schedule=schedule), sample_interval=0.5, length=20.0), 1e-9)


@both_flavours
def test_rounding_does_not_add_up_over_many_steps(fmu: Path) -> None:
    # 5e-4 m added up as many times would be 7e-13 m off
    assert host("tick", fmu, 20_000, 0.1, 5e-3) == pytest.approx(10.0, rel=0, abs=1e-13)


@both_flavours
def test_at_rate_zero_nothing_changes(fmu: Path) -> None:
    before, *after = host("standstill", fmu)
    assert all(row == before for row in after)


@both_flavours
def test_outputs_follow_at_once_the_inputs_they_declare_and_no_others(fmu_3: Path) -> None:
    changed = host("respond", fmu_3)
    for output, name in product(scalar_names(OUTPUTS, 3), changed):
        if quantity_of(output).kind == "Real":  # an Integer may or may not switch
            assert (output in changed[name]) == (name in quantity_of(output).follows), (output, name)


@both_flavours
def test_outputs_before_the_first_step_are_those_of_the_initial_hole(case: Case, fmu: Path) -> None:
    inside, after = host("initial", fmu, json.dumps({"rss_force": 4e3, "bit_tilt_limit": 0.01}))
    changed = replace(case, bit=replace(case.bit, tilt_limit=0.01), schedule=Schedule((0.0,), (4e3,)))
    expected = simulate(changed, sample_interval=1.0, length=1.0)
    assert inside == after
    assert inside == pytest.approx({name: expected[name][0] for name in inside}, rel=1e-12, abs=1e-12)


@both_flavours
def test_running_on_from_a_state_repeats_bit_by_bit(fmu_3: Path, tmp_path: Path) -> None:
    first, restored, deserialized = host("rollback", fmu_3, tmp_path / "state")
    assert first == restored
    assert first == deserialized
    assert first == host("resume", fmu_3, tmp_path / "state")


@both_flavours
def test_a_survey_file_takes_the_place_of_the_packed_survey(case: Case, fmu: Path, tmp_path: Path) -> None:
    depths = (1000.0, 1004.0, 1010.0)
    inclinations = (0.1, 0.13, 0.12)
    lines = [f"{depth},{degrees(inclination)!r}" for depth, inclination in zip(depths, inclinations, strict=True)]
    (tmp_path / "survey.csv").write_text("\n".join(["measured_depth,inclination_deg", *lines]))
    _, row = host("initial", fmu, json.dumps({"survey_file": str(tmp_path / "survey.csv")}))
    survey = replace(case.survey, measured_depth=depths, inclination=inclinations)
    expected = simulate(replace(case, survey=survey), sample_interval=1.0, length=1.0)
    assert row == pytest.approx({name: expected[name][0] for name in row}, rel=1e-9, abs=1e-12)


@both_flavours
def test_the_command_runs_the_packed_schedule_exactly_whatever_the_step(
    case: Case, flavour: Flavour, pack: Pack, command: Command, tmp_path: Path
) -> None:
    schedule = Schedule((0.0, 3.21, 9.0), (0.0, 4e3, -1e3))  # the force changes within a step, and at the end of one
    changed = replace(case, length=20.0, schedule=schedule)
    done = command("boreprop-fmu", "run", pack(changed, flavour), "--output", "run.csv", "--step", "1.5")
    assert done.returncode == 0, done.stderr
    run = read_trajectory(tmp_path / "run.csv")
    expected = simulate(changed, sample_interval=1.5, length=20.0)
    assert run.case == changed
    assert list(run.columns) == [
        "time",
        "rss_force",
        "active_weight_on_bit",
        "rate_of_penetration",
        *ROCK,
        *scalar_names(OUTPUTS, 2),
    ]
    np.testing.assert_allclose(run["time"], 1.5 * np.arange(14), rtol=0, atol=0)
    rows = [{name: run[name][k] for name in scalar_names(OUTPUTS, 2)} for k in range(run.row_count)]
    assert_agrees(rows, expected, 1e-9)
    np.testing.assert_array_equal(run["rss_force"], expected["rss_force"])


@both_flavours
def test_the_command_runs_under_a_schedule_file_up_to_a_stop(
    fmu: Path, case: Case, command: Command, tmp_path: Path
) -> None:
    (tmp_path / "schedule.csv").write_text("drilled_length,force\n0,500\n2.5,-500\n")
    arguments = ["--schedule", "schedule.csv", "--step", "0.5", "--stop", "5"]
    done = command("boreprop-fmu", "run", fmu, "--output", "run.csv", *arguments)
    assert done.returncode == 0, done.stderr
    run = read_trajectory(tmp_path / "run.csv")
    assert run.case is not None
    assert run.case.schedule == Schedule((0.0, 2.5), (500.0, -500.0))
    assert run["rss_force"].tolist() == [500.0] * 5 + [-500.0] * 6


@both_flavours
def test_the_command_builds_what_build_fmu_builds(
    flavour: Flavour, fmu: Path, paper_case: Path, command: Command, tmp_path: Path
) -> None:
    done = command("boreprop-fmu", "build", paper_case, "--output", "Borehole.fmu", "--runtime", flavour.runtime)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "Borehole.fmu").read_bytes() == fmu.read_bytes()
    assert ("falls short of FMI 2.0" in done.stdout) == (flavour.runtime == "python")


@both_flavours
def test_the_command_runs_in_a_temporary_directory_of_any_name_or_says_why_not(
    flavour: Flavour, fmu: Path, command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "tü").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tü"))
    done = command("boreprop-fmu", "run", fmu, "--output", "run.csv", "--stop", "1")
    assert (done.returncode == 0) == (tmp_path / "run.csv").exists() == flavour.any_folder
    if not flavour.any_folder:
        assert done.returncode == 2
        assert done.stderr.startswith("error: TMPDIR: the temporary directory must ")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "missing.fmu", "--output", "run.csv"], "missing.fmu: must be an FMI 2.0 co-simulation FMU, got: "),
        (["run", "case.toml", "--output", "run.csv"], "case.toml: must be an FMI 2.0 co-simulation FMU, got: "),
        (["run", "FMU", "--output", "run.txt"], "run.txt: must end in .csv or .parquet, got '.txt'"),
        (["run", "FMU", "--output", "run.csv", "--step", "0"], "--step"),
        (["run", "FMU", "--output", "run.csv", "--stop", "nan"], "--stop"),
        (["run", "FMU", "--output", "run.csv", "--step", "1e-9"], "step: must give at most"),
        (["run", "FMU", "--output", "run.csv", "--schedule", "ragged.csv"], "ragged.csv:3: must have 2 values"),
        (["build", "case.toml", "--output", "Borehole.zip"], "Borehole.zip: must end in .fmu, got '.zip'"),
        (["build", "case.toml", "--output", "Borehole.fmu"], "case.toml: "),
    ],
)
def test_bad_input_to_the_command_is_one_line(
    fmu: Path, command: Command, tmp_path: Path, arguments: list[str], message: str
) -> None:
    (tmp_path / "case.toml").write_text("[bha]\n")
    (tmp_path / "ragged.csv").write_text("drilled_length,force\n0,1\n1\n")
    inputs = set(tmp_path.iterdir())
    done = command("boreprop-fmu", *[str(fmu) if argument == "FMU" else argument for argument in arguments])
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert set(tmp_path.iterdir()) == inputs


@both_flavours
def test_a_step_of_more_than_100_km_is_discarded_at_once(fmu: Path) -> None:
    """Without the bound, 2^18 steps of the integrator come before the refusal; the test's host would be given up."""
    *refused, usual = host("too_far", fmu)
    for (status, [line], then), length in zip(refused, (100_100.0, 1e15, inf), strict=True):
        assert (status, then) == ("discard", "kept")
        name, _, got = line.partition(": must be ")
        if length == inf:
            assert (name, got) == ("drilled_length", "a finite number, got inf")
        else:
            assert (name, got.partition(", got ")[0]) == ("step_size * rate_of_penetration", "<= 100000")
            assert float(got.partition(", got ")[2]) == pytest.approx(length)
    assert usual[:2] == ["ok", []]


@both_flavours
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
def test_a_survey_is_no_pipe_and_no_device(fmu: Path, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path("/dev/zero")):
        assert host("read_survey", fmu, path) == [
            f"{path}: must be a readable CSV file, got: a pipe or a device (survey_file)"
        ]


@both_flavours
def test_an_fmu_starts_at_the_depth_of_its_bit_and_its_schedule_counts_from_there(
    case: Case, flavour: Flavour, pack: Pack, command: Command, tmp_path: Path
) -> None:
    survey = Survey((1000.0, 1040.0), (0.0, radians(4.0)))
    packed = pack(replace(case, survey=survey.with_bit_at(1020.0), length=8.0), flavour)
    (tmp_path / "schedule.csv").write_text("measured_depth,force\n900,1e3\n1002.5,2e3\n1022.5,-4e3\n")
    done = command("boreprop-fmu", "run", packed, "--output", "run.csv", "--schedule", "schedule.csv", "--step", "1")
    assert done.returncode == 0, done.stderr
    run = read_trajectory(tmp_path / "run.csv")
    cut = Survey((1000.0, 1020.0), (0.0, radians(2.0)))  # halfway
    by_length = replace(case, survey=cut, length=8.0, schedule=Schedule((0.0, 2.5), (2e3, -4e3)))
    assert run.case is not None
    assert run.case.schedule == by_length.schedule
    rows = [{name: run[name][k] for name in scalar_names(OUTPUTS, 2)} for k in range(run.row_count)]
    assert_agrees(rows, simulate(by_length, sample_interval=1.0, length=8.0), 1e-9)

"""A run that cannot go on to its end keeps what it has drilled: in Python, in its files, from the commands."""

import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import typer

from beams_as_built import with_points
from boreprop.analysis.study.figures import key_figures, outcome
from boreprop.analysis.tipping import drill_until_steady
from boreprop.case.case import Case
from boreprop.case.file import dump_case, load_case
from boreprop.case.inputs import Schedule
from boreprop.cli.options import tolerance
from boreprop.core.survey import Survey
from boreprop.core.system import BottomHoleAssembly
from boreprop.errors import BorepropError, InputError
from boreprop.run.files import case_path
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped, Trajectory
from boreprop_fmu.host.drive import FmuRun
from conftest import Command, Pack
from flavours import Flavour, both_flavours

pytestmark = pytest.mark.usefixtures("kernel")

KEPT = 34  # rows at 0, 0.1, …, 3.3 m: there the force sets in, and the bit turns over before the next


@pytest.fixture(scope="module")
def pushed(case: Case) -> Case:
    """The paper's case under a force that no hole stands, from 3.35 m on."""
    return replace(case, schedule=Schedule((0.0, 3.35), (0.0, 1e9)), length=6.0)


@pytest.fixture
def pushed_file(tmp_path: Path, pushed: Case) -> Path:
    path = tmp_path / "pushed.toml"
    path.write_text(dump_case(pushed), encoding="utf-8")
    return path


def stopped(case: Case, engine: str = "native") -> tuple[Stopped, Trajectory]:
    with pytest.raises(Stopped) as caught:
        simulate(case, engine=engine)
    assert caught.value.trajectory is not None
    return caught.value, caught.value.trajectory


@pytest.mark.parametrize("engine", ["python", "native"])
def test_the_whole_rows_so_far_are_those_of_a_run_that_ends_before(case: Case, pushed: Case, engine: str) -> None:
    error, rows = stopped(pushed, engine)
    assert isinstance(error, BorepropError)
    assert rows.stopped == str(error)
    assert rows.case == pushed
    before = simulate(replace(case, length=3.3), engine=engine)
    assert before.row_count == KEPT
    assert list(rows.columns) == list(before.columns)
    for name, column in before.columns.items():
        np.testing.assert_array_equal(rows[name], column, err_msg=name)


def test_progress_makes_no_difference_to_what_is_kept(pushed: Case) -> None:
    seen: list[float] = []
    with pytest.raises(Stopped) as caught:
        simulate(pushed, progress=seen.append, engine="native")
    assert caught.value.trajectory is not None
    assert caught.value.trajectory.row_count == KEPT
    assert max(seen) == 3.35


def test_it_travels_between_processes(pushed: Case) -> None:
    error, rows = stopped(pushed)
    there = pickle.loads(pickle.dumps(error))
    assert (str(there), there.trajectory.row_count) == (str(error), rows.row_count)


@pytest.mark.parametrize("name", ["run.csv", "run.parquet"])
def test_files_say_why_a_run_stopped(pushed: Case, tmp_path: Path, name: str) -> None:
    error, rows = stopped(pushed)
    write_trajectory(rows, tmp_path / name)
    back = read_trajectory(tmp_path / name)
    assert back.stopped == str(error)
    assert back.case == pushed
    assert read_trajectory(tmp_path / name, pushed).stopped == str(error)
    np.testing.assert_array_equal(back["drilled_length"], rows["drilled_length"])


def test_the_case_file_of_a_run_that_stopped_is_a_case_file(pushed: Case, tmp_path: Path) -> None:
    _, rows = stopped(pushed)
    write_trajectory(rows, tmp_path / "run.csv")
    assert load_case(case_path(tmp_path / "run.csv")) == pushed
    write_trajectory(simulate(replace(pushed, length=1.0)), tmp_path / "run.csv")
    assert read_trajectory(tmp_path / "run.csv").stopped is None


@pytest.mark.parametrize("table", ["[run]\nstopped = 5", "[run]\nfinished = 'yes'", "run = 3"])
def test_another_table_of_a_run_is_refused(pushed: Case, tmp_path: Path, table: str) -> None:
    text = dump_case(pushed)
    (tmp_path / "case.toml").write_text(f"{table}\n{text}" if table.startswith("run") else f"{text}\n{table}\n")
    with pytest.raises(InputError, match=r"case.toml: run.*must "):
        load_case(tmp_path / "case.toml")


@pytest.mark.parametrize("name", ["run.csv", "run.parquet"])
def test_simulate_ends_with_3_and_one_line_and_keeps_the_rows(command: Command, pushed_file: Path, name: str) -> None:
    done = command("boreprop", "simulate", pushed_file, "--output", name, "--engine", "native")
    warning, *error = done.stderr.splitlines()
    assert (done.returncode, done.stdout, len(error)) == (3, "", 1)
    assert warning.endswith("pushed.toml: rss.force: is usually 100 to 100000 N, got 1e+09")
    assert "after 3.3" in done.stderr
    assert "the bit turns over at 3.35" in done.stderr
    run = read_trajectory(pushed_file.with_name(name))
    assert run.row_count == KEPT
    assert run.stopped is not None
    assert run.stopped in done.stderr
    told = command("boreprop", "summary", name)
    assert told.returncode == 0
    assert "stopped" in told.stdout


@both_flavours
def test_boreprop_fmu_run_keeps_the_rows_before_the_step_that_is_discarded(
    command: Command, pushed: Case, flavour: Flavour, pack: Pack, tmp_path: Path
) -> None:
    fmu = pack(pushed, flavour)
    done = command("boreprop-fmu", "run", fmu, "--output", "run.csv", "--step", "0.1")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (3, "", 1)
    assert "the bit turns over" in done.stderr
    run, (_, expected) = read_trajectory(tmp_path / "run.csv"), stopped(pushed)
    assert run.stopped is not None
    assert "the bit turns over" in run.stopped
    np.testing.assert_allclose(run["bit_inclination"], expected["bit_inclination"], atol=1e-9)


# the way out that the messages name


def test_simulate_takes_a_tolerance(command: Command, paper_case: Path, case: Case, tmp_path: Path) -> None:
    arguments = ["--length", "20", "--engine", "native", "--tolerance", "1e-4"]
    assert command("boreprop", "simulate", paper_case, "--output", "run.csv", *arguments).returncode == 0
    run = read_trajectory(tmp_path / "run.csv")["bit_inclination"]
    loose, usual = (
        simulate(case, length=20.0, relative_tolerance=tolerance, engine="native")["bit_inclination"]
        for tolerance in (1e-4, 1e-7)
    )
    np.testing.assert_array_equal(run, loose)
    assert np.abs(run - usual).max() > 1e-8


@pytest.mark.parametrize("text", ["0", "-1e-7", "1e-13", "0.1", "inf", "nan", "tight"])
def test_a_tolerance_out_of_range_is_refused(text: str) -> None:
    with pytest.raises(typer.BadParameter, match=f"must be .*, got '{text}'"):
        tolerance(text)


@pytest.mark.parametrize(
    "arguments",
    [
        ["boreprop", "simulate", "CASE", "--output", "run.csv"],
        ["boreprop", "study", "CASE", "--output", "study.parquet", "--vary", "eta_pi=0.1"],
        ["boreprop", "dogleg", "CASE"],
        ["boreprop", "hysteresis", "CASE", "--output", "loop.png", "--eta-pi", "0.01:0.1:3"],
        ["boreprop-fmu", "run", "FMU", "--output", "run.csv"],
    ],
)
def test_each_command_that_drills_refuses_it(
    command_here: Command, paper_case: Path, tmp_path: Path, arguments: list[str]
) -> None:
    given = [str(paper_case) if argument == "CASE" else argument for argument in arguments]
    done = command_here(*given, "--tolerance", "0.1")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert "--tolerance" in done.stderr
    assert "must be 1e-12 to 0.01, got '0.1'" in done.stderr
    assert not list(tmp_path.iterdir())


def test_the_viewer_draws_what_there_is_of_a_case_that_stops(command: Command, pushed: Case, tmp_path: Path) -> None:
    (tmp_path / "pushed.toml").write_text(dump_case(pushed), encoding="utf-8")
    done = command("boreprop-view", "pushed.toml", "--save", "run.rrd")
    warning, *error = done.stderr.splitlines()
    assert (done.returncode, len(error)) == (3, 1)
    assert warning == "warning: pushed.toml: rss.force: is usually 100 to 100000 N, got 1e+09"
    assert "the bit turns over" in done.stderr
    assert done.stdout.startswith(f"run.rrd: {KEPT} rows")
    assert (tmp_path / "run.rrd").stat().st_size > 10_000


def test_a_study_at_another_tolerance_is_another_study(command: Command, paper_case: Path, tmp_path: Path) -> None:
    arguments = ["study", paper_case, "--output", "study.parquet", "--vary", "eta_pi=0.05", "--workers", "1"]
    assert command("boreprop", *arguments, "--tolerance", "1e-6").returncode == 0
    assert command("boreprop", *arguments, "--tolerance", "1e-6").returncode == 0
    other = command("boreprop", *arguments)
    assert (other.returncode, other.stderr.count("\n")) == (2, 1)
    assert "relative_tolerance=1e-06" in other.stderr


@both_flavours
def test_boreprop_fmu_run_sets_the_tolerance_of_the_fmu(
    flavour: Flavour, fmu: Path, command: Command, case: Case, tmp_path: Path
) -> None:
    arguments = ["--step", "0.1", "--stop", "20", "--tolerance", "1e-4"]
    assert command("boreprop-fmu", "run", fmu, "--output", "run.csv", *arguments).returncode == 0
    run = read_trajectory(tmp_path / "run.csv")["bit_inclination"]
    loose = simulate(case, length=20.0, relative_tolerance=1e-4, engine="native")["bit_inclination"]
    np.testing.assert_allclose(run, loose, atol=1e-11)
    assert np.abs(FmuRun(fmu, step=0.1, stop=20.0).trajectory()["bit_inclination"] - run).max() > 1e-8


def test_a_run_that_cannot_start_stops_without_rows(case: Case, command_here: Command, tmp_path: Path) -> None:
    points = [1.0 + 0.37 * k for k in range(100)]
    bha = with_points(BottomHoleAssembly((20.0, 40.0), (0.0,), 0.5, 1500.0, 1e4), points, 0.01)
    limp = replace(case, bha=bha, survey=Survey((0.0, 40.0), (1.5, 1.5)))
    for crowded in (limp, replace(limp, dimensions=3)):
        with pytest.raises(Stopped, match=r"^after 0 m: more than .* supports touch the wall, .* at 0 m: ") as caught:
            simulate(crowded)
        assert caught.value.trajectory is None
    with pytest.raises(Stopped, match=r"^after 0 m: more than "):
        drill_until_steady(limp)
    assert str(outcome(key_figures, limp, (), ())).startswith("after 0 m: more than ")
    (tmp_path / "crowded.toml").write_text(dump_case(limp), encoding="utf-8")
    done = command_here("boreprop", "simulate", "crowded.toml", "--output", "run.csv")
    assert (done.returncode, len(done.stderr.splitlines())) == (3, 2)  # and a warning that the weight is unusual
    assert not (tmp_path / "run.csv").exists()

"""The command `boreprop`, as a user meets it: its own process, its exit status, its one line of error."""

import os
import re
import signal
import subprocess
import sys
import tomllib
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import boreprop_fmu.cli
from boreprop.case.file import load_case
from boreprop.cli import app, console
from boreprop.cli.lazy import new_app
from boreprop.core.errors import ParameterError, TableError
from boreprop.errors import InputError, RootsNotFound
from boreprop.run.engines import engine
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped
from conftest import Command, assert_refused
from places import EXAMPLES, ROOT

EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        pytest.param("= 0.6", "= 0.6\nrss_strength = 5", ("bha.rss_strength", "known key", "5"), id="unknown key"),
        pytest.param(
            "flexural_stiffness    = 7.2e6", "", ("bha.flexural_stiffness", "must be given"), id="missing key"
        ),
        pytest.param(
            "= 1612.469", '= "heavy"', ("drilling.active_weight_on_bit", "number", "'heavy'"), id="wrong type"
        ),
        pytest.param(
            "[3.66, 7.32]",
            "[7.32, 3.66]",
            ("bha.stabilizer_positions", "increase", "3.66"),
            id="positions not increasing",
        ),
        pytest.param(
            "[3.66e-3]", "[1e-3, 2e-3]", ("bha.stabilizer_clearances", "here 1", "(0.001, 0.002)"), id="clearance count"
        ),
        pytest.param("= 7.2e6", "= -7.2e6", ("bha.flexural_stiffness", "> 0", "-7200000.0"), id="negative stiffness"),
        pytest.param(
            "[0.0, 3.66, 7.32]", "[0, 5, 4]", ("hole.measured_depth", "increase", "4.0"), id="survey not monotonic"
        ),
        pytest.param("= 1080.0", "= nan", ("bha.distributed_weight", "finite", "nan"), id="NaN"),
        pytest.param("= 7.2e6", "= 1e308", ("3 flexural_stiffness / stabilizer_position[1]^2", "inf"), id="no F*"),
        pytest.param("= 7.2e6", "= 1e-307", ("distributed_weight stabilizer", "finite", "inf"), id="no scaled weight"),
        pytest.param("[bit]", "[bit", ("TOML", "line"), id="no TOML"),
    ],
)
def test_a_wrong_case_file(
    command_here: Command, tmp_path: Path, paper_text: str, old: str, new: str, named: tuple[str, ...]
) -> None:
    assert paper_text.count(old) == 1
    (tmp_path / "wrong.toml").write_text(paper_text.replace(old, new), encoding="utf-8")
    result = command_here("boreprop", "simulate", "wrong.toml", "--output", "run.csv")
    assert_refused(result, "wrong.toml: ", *named)
    assert [file.name for file in tmp_path.iterdir()] == ["wrong.toml"]


SURVEY = '[hole]\nsurvey = "data.csv"\n'
SCHEDULE = '[hole]\nmeasured_depth = [0]\ninclination_deg = [0]\n[rss]\nschedule = "data.csv"\n'


@pytest.mark.parametrize(
    ("tables", "content", "named"),
    [
        pytest.param(
            SURVEY,
            "measured_depth,inclination_deg\n0,0\n9,1\n8,2\n",
            ("measured_depth", "increase", "8.0"),
            id="not monotonic",
        ),
        pytest.param(SURVEY, "measured_depth,inclination_deg\n0,0\n9\n", (":3", "2 values", "got 1"), id="ragged row"),
        pytest.param(SCHEDULE, "drilled_length,force\n0,0\n9,NaN\n", (":3", "force", "finite", "'NaN'"), id="NaN"),
        pytest.param(SCHEDULE, None, ("readable", "No such file"), id="no file"),
    ],
)
def test_a_wrong_file_that_the_case_file_names(
    command_here: Command, tmp_path: Path, paper_text: str, tables: str, content: str | None, named: tuple[str, ...]
) -> None:
    (tmp_path / "case.toml").write_text(paper_text.partition("[hole]")[0] + tables, encoding="utf-8")
    if content is not None:
        (tmp_path / "data.csv").write_text(content)
    before = set(tmp_path.iterdir())
    assert_refused(command_here("boreprop", "simulate", "case.toml", "--output", "run.csv"), "data.csv", *named)
    assert set(tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["simulate", "CASE", "--output", "run.txt"], ("run.txt", ".csv or .parquet", "'.txt'")),
        (["simulate", "CASE", "--output", "nowhere/run.csv"], ("nowhere/run.csv", "directory", "'nowhere'")),
        (["simulate", "nothing.toml", "--output", "run.csv"], ("nothing.toml", "readable", "No such file")),
        (["simulate", "CASE", "--output", "run.csv", "--length", "-5"], ("--length", "> 0", "'-5'")),
        (
            ["simulate", "CASE", "--output", "run.csv", "--sample-interval", "nan"],
            ("--sample-interval", "> 0", "'nan'"),
        ),
        (["simulate", "CASE", "--output", "run.csv", "--colour"], ("--colour",)),
    ],
)
def test_a_wrong_argument(
    command_here: Command, tmp_path: Path, paper_case: Path, arguments: list[str], named: tuple[str, ...]
) -> None:
    result = command_here("boreprop", *(str(paper_case) if argument == "CASE" else argument for argument in arguments))
    assert_refused(result, *named)
    assert not list(tmp_path.iterdir())


def test_simulate_writes_a_row_at_each_multiple_of_the_sample_interval(
    command: Command, tmp_path: Path, paper_case: Path
) -> None:
    arguments = ["--length", "2", "--sample-interval", "0.3"]
    for name in ("run.csv", "run.parquet"):
        result = command("boreprop", "simulate", paper_case, "--output", name, *arguments)
        assert (result.returncode, result.stderr) == (0, "")
        assert result.stdout == f"{name}: 7 rows over 2 m ({engine()} engine)\n"
    run = read_trajectory(tmp_path / "run.csv")
    np.testing.assert_array_equal(run["drilled_length"], [0.3 * k for k in range(7)])
    assert run.case is not None
    assert run.case.length == 2.0
    assert run.case.bha == load_case(paper_case).bha
    parquet = read_trajectory(tmp_path / "run.parquet")
    assert parquet.case == run.case
    assert parquet.engine == run.engine == engine()
    for name, column in run.items():
        np.testing.assert_array_equal(parquet[name], column)
    assert {file.name for file in tmp_path.iterdir()} == {"run.csv", "run.case.toml", "run.parquet"}


HEAVY = {"fmpy", "matplotlib", "numpy", "pandas", "pyarrow", "pydantic", "rerun", "rich", "scipy", "xarray"}


@pytest.mark.parametrize(
    ("arguments", "loaded"),
    [
        (["--help"], set()),
        (["simulate", "CASE", "--output", "OUT", "--length", "1"], {"numpy", "pydantic"}),
        (["summary", "RUN"], {"numpy", "pydantic", "rich"}),
        (["roots", "CASE"], {"numpy", "pydantic", "rich", "scipy"}),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else "",
)
def test_a_command_loads_nothing_slow_that_it_does_not_use(
    tmp_path: Path, paper_case: Path, arguments: list[str], loaded: set[str]
) -> None:
    files = {"CASE": paper_case, "RUN": tmp_path / "run.csv", "OUT": tmp_path / "out.csv"}
    write_trajectory(simulate(load_case(paper_case), length=1.0), files["RUN"])
    command = [sys.executable, "-X", "importtime", "-m", "boreprop.cli.app"]
    given = [str(files.get(argument, argument)) for argument in arguments]
    result = subprocess.run([*command, *given], capture_output=True, text=True, check=True)
    names = {line.rpartition("|")[2].strip().partition(".")[0] for line in result.stderr.splitlines()}
    assert names & HEAVY == loaded


@pytest.mark.parametrize("commands", [app.COMMANDS, boreprop_fmu.cli.COMMANDS])
def test_the_list_of_commands_says_what_each_says_of_itself(commands: dict[str, tuple[str, str]]) -> None:
    for name, (module, summary) in commands.items():
        command = getattr(import_module(module), f"{name}_command")
        assert command.__doc__.splitlines()[0] == summary


def test_a_command_that_is_misspelt_is_guessed(command: Command) -> None:
    assert_refused(command("boreprop", "simulat"), "simulat", "Did you mean 'simulate'?")


@pytest.mark.parametrize(
    ("program", "arguments", "package", "extra"),
    [
        ("boreprop.cli.app", ["figures", "out"], "matplotlib", "plot"),
        ("boreprop_fmu.cli", ["run", "Borehole.fmu", "--output", "run.csv"], "fmpy", "fmu"),
        ("boreprop_viz.cli", ["run.csv"], "rerun", "viz"),
    ],
)
def test_without_its_extra_a_command_says_what_to_install(
    tmp_path: Path, program: str, arguments: list[str], package: str, extra: str
) -> None:
    text = f"import sys; sys.modules[{package!r}] = None; from {program} import main; main()"
    result = subprocess.run([sys.executable, "-c", text, *arguments], cwd=tmp_path, capture_output=True, text=True)
    assert_refused(result, package, f"pip install 'boreprop[{extra}]'")
    assert extra in EXTRAS


def test_every_extra_that_a_message_names_exists() -> None:
    named = {
        extra
        for folder in ("model", "fmu_build", "viz", "examples")
        for path in (ROOT / folder).rglob("*")
        if path.suffix in (".py", ".md")
        for extra in re.findall(r"boreprop\[(\w+)\]", path.read_text(encoding="utf-8"))
    }
    assert named | set(console.EXTRAS.values()) <= set(EXTRAS)


def test_the_version(command: Command) -> None:
    result = command("boreprop", "--version")
    assert (result.returncode, result.stdout.split(".")[0].isdigit()) == (0, True)


def test_figures_refuses_a_directory_that_is_a_file(command: Command, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine")
    assert_refused(command("boreprop", "figures", "out"), "out", "exists")
    assert (tmp_path / "out").read_text() == "mine"


def run_raising(error: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    one = new_app("An application with one command.")

    @one.command()
    def fails() -> None:
        raise error

    monkeypatch.setattr(sys, "argv", ["fails"])
    console.execute(one)


@pytest.mark.parametrize(
    "error",
    [
        InputError("x: must be y, got z"),
        ParameterError("x", "must be y", 5),
        TableError("x: must be y, got z"),
        RootsNotFound("x: 2 were found, but by the argument principle there are 4"),
        FileNotFoundError(2, "no such file", "x"),
        ModuleNotFoundError("No module named 'rerun.x'", name="rerun.x"),
        InputError("x: must be y,\ngot z"),
    ],
)
def test_whatever_a_user_can_mend_is_one_line(
    error: Exception, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        run_raising(error, monkeypatch)
    shown = capsys.readouterr()
    assert (ended.value.code, shown.out, shown.err.count("\n")) == (2, "", 1)
    assert "x" in shown.err


def test_a_run_that_stops_is_no_bad_input(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        run_raising(Stopped("after 5 m: x"), monkeypatch)
    assert (ended.value.code, *capsys.readouterr()) == (3, "", "error: after 5 m: x\n")


@pytest.mark.parametrize(
    "error", [ValueError("a bug"), RuntimeError("a bug"), ModuleNotFoundError("a bug", name="bug")]
)
def test_a_bug_is_not_dressed_up_as_bad_input(error: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(type(error), match="a bug"):
        run_raising(error, monkeypatch)


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
def test_ctrl_c_ends_a_run_with_130_and_no_file(tmp_path: Path, paper_case: Path) -> None:
    import pty

    terminal, stderr = pty.openpty()
    arguments = ["simulate", str(paper_case), "--output", "run.csv", "--length", "1e6", "--sample-interval", "100"]
    run = subprocess.Popen(
        [sys.executable, "-m", "boreprop.cli.app", *arguments],
        cwd=tmp_path,
        stderr=stderr,
        env={**os.environ, "TERM": "xterm"},
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    os.close(stderr)
    shown = b""
    while b"drilling" not in shown:  # the progress bar: it is under way
        shown += os.read(terminal, 1000)
    run.send_signal(signal.SIGINT)
    assert run.wait(timeout=60) == 130
    os.close(terminal)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("program", "arguments"),
    [
        ("boreprop", ["simulate", "case.toml", "--output", "run.csv"]),
        ("boreprop", ["steering", "case.toml"]),
        ("boreprop", ["roots", "case.toml"]),
        ("boreprop-fmu", ["build", "case.toml", "--output", "b.fmu"]),
        ("boreprop-view", ["case.toml", "--save", "run.rrd"]),
    ],
)
def test_what_is_far_from_any_bha_is_a_warning_of_one_line(
    command: Command, tmp_path: Path, paper_text: str, program: str, arguments: list[str]
) -> None:
    text = (
        paper_text.replace("= 219.6", "= 0.5").replace("= 1080.0", "= 1.08").replace("[0.0, 3.66, 7.32]", "[2, 3, 4]")
    )
    (tmp_path / "case.toml").write_text(text)
    result = command(program, *arguments)
    assert result.returncode == 0, result.stderr
    assert result.stderr == (
        "warning: case.toml: bha.distributed_weight: is usually 100 to 6000 N/m, got 1.08; "
        "hole.measured_depth: spans 2 m, less than the 7.32 m of the BHA: "
        "the hole is extended straight above its first station\n"
    )


def test_what_the_engine_refuses_is_named_by_the_file_and_the_key(command_here: Command, tmp_path: Path) -> None:
    pendulum = (EXAMPLES / "pendulum.toml").read_text(encoding="utf-8").replace("88.96e3", "88.96e6")
    (tmp_path / "case.toml").write_text(pendulum, encoding="utf-8")
    done = command_here("boreprop", "simulate", "case.toml", "--output", "run.csv")
    assert_refused(done, "case.toml: drilling.weight_on_bit: must be < ", "got 88960000.0")

"""No output of a command replaces a file that it reads, or one that boreprop has not written."""

import os
import shutil
from pathlib import Path

import pytest

from boreprop.case.case import Case
from boreprop.case.file import dump_case
from boreprop.cli.console import check_output
from boreprop.errors import InputError
from boreprop.run.files import MARK, check_case_beside
from boreprop.run.results import write_trajectory
from boreprop.run.trajectory import Trajectory
from conftest import Command, assert_refused
from places import ROOT


@pytest.fixture
def folder(command_here: Command, tmp_path: Path, trajectory: Trajectory) -> Path:
    """Cases that name a survey and a schedule, the schedule also under names that commands write, and a run."""
    text = (ROOT / "examples/build_section.toml").read_text(encoding="utf-8")
    head = text.partition("[hole]")[0]
    named = {
        "hole": ("survey", "measured_depth,inclination_deg\n0,0\n30,3\n"),
        "rss": ("schedule", "drilled_length,force\n0,0\n"),
    }
    for table, (key, content) in named.items():
        head += f'\n[{table}]\n{key} = "{key}.csv"\n'
        (tmp_path / f"{key}.csv").write_text(content)
    (tmp_path / "run.case.toml").write_text(head, encoding="utf-8")
    for suffix in ("png", "rrd", "fmu", "parquet"):  # the same schedule, where pictures and the rest go
        (tmp_path / f"s.{suffix}").write_text(named["rss"][1])
        (tmp_path / f"{suffix}.toml").write_text(head.replace("schedule.csv", f"s.{suffix}"), encoding="utf-8")
    write_trajectory(trajectory, tmp_path / "read.csv")
    return tmp_path


WRITING = [
    ["boreprop", "simulate", "run.case.toml", "--output", "schedule.csv"],
    ["boreprop", "simulate", "run.case.toml", "--output", "survey.csv"],
    ["boreprop", "simulate", "run.case.toml", "--output", "run.csv"],
    ["boreprop", "simulate", "parquet.toml", "--output", "s.parquet"],
    ["boreprop", "study", "parquet.toml", "--vary", "rss_force=1,2", "--output", "s.parquet"],
    ["boreprop", "steering", "png.toml", "--output", "s.png"],
    ["boreprop", "stability", "png.toml", "--output", "s.png"],
    ["boreprop", "dogleg", "png.toml", "--output", "s.png"],
    ["boreprop", "hysteresis", "png.toml", "--eta-pi", "0.01:0.02:2", "--output", "s.png"],
    ["boreprop-fmu", "build", "fmu.toml", "--output", "s.fmu"],
    ["boreprop-fmu", "run", "s.fmu", "--schedule", "schedule.csv", "--output", "schedule.csv"],
    ["boreprop-view", "read.csv", "--plan", "s.rrd", "--save", "s.rrd"],
    ["boreprop-view", "rrd.toml", "--save", "s.rrd"],
]


@pytest.mark.parametrize("arguments", WRITING, ids=lambda arguments: " ".join(arguments[:3] + arguments[-1:]))
def test_no_command_writes_to_a_file_that_it_reads(folder: Path, command_here: Command, arguments: list[str]) -> None:
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert_refused(command_here(*arguments), "must not be a file that the command reads")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize("link", [os.symlink, os.link])
def test_a_file_is_known_under_another_name(tmp_path: Path, link: object) -> None:
    (tmp_path / "read.csv").write_text("mine")
    link(tmp_path / "read.csv", tmp_path / "run.csv")  # type: ignore[operator]
    with pytest.raises(InputError, match=r"run\.csv: must not be a file that the command reads"):
        check_output(tmp_path / "run.csv", reads=[tmp_path / "read.csv"])


def test_a_case_that_boreprop_did_not_write_stays(command_here: Command, paper_case: Path, tmp_path: Path) -> None:
    mine = tmp_path / "run.case.toml"
    for content in ("# mine\n", paper_case.read_text(encoding="utf-8")):
        mine.write_text(content, encoding="utf-8")
        result = command_here("boreprop", "simulate", paper_case, "--length", "1", "--output", "run.csv")
        assert_refused(
            result, "run.case.toml: must be a case that boreprop wrote with run.csv", "choose another output"
        )
        assert mine.read_text(encoding="utf-8") == content
        assert list(tmp_path.iterdir()) == [mine]


def test_a_case_that_boreprop_wrote_is_replaced(trajectory: Trajectory, case: Case, tmp_path: Path) -> None:
    run, beside = tmp_path / "run.csv", tmp_path / "run.case.toml"
    write_trajectory(trajectory, run)
    assert beside.read_text(encoding="utf-8").startswith(MARK)
    run.unlink()
    write_trajectory(trajectory, run)
    beside.write_text(dump_case(case, engine="native"), encoding="utf-8")  # as boreprop 0.1 did
    write_trajectory(trajectory, run)
    assert beside.read_text(encoding="utf-8").startswith(MARK)
    run.unlink()
    beside.write_text(dump_case(case), encoding="utf-8")
    with pytest.raises(InputError, match=r"run\.case\.toml"):
        check_case_beside(run)


@pytest.mark.parametrize("with_case", [True, False])
def test_nor_does_the_function_replace_it(trajectory: Trajectory, tmp_path: Path, with_case: bool) -> None:
    (tmp_path / "run.case.toml").write_text("mine")
    run = trajectory if with_case else Trajectory(trajectory.columns)
    with pytest.raises(InputError, match=r"run\.case\.toml: must be a case that boreprop wrote with run\.csv"):
        write_trajectory(run, tmp_path / "run.csv")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"run.case.toml": "mine"}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
def test_an_output_is_no_pipe_and_no_device(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "run.csv")
    (tmp_path / "null.csv").symlink_to("/dev/null")
    for name in ("run.csv", "null.csv"):
        with pytest.raises(InputError, match=rf"{name}: must be a file, got a pipe or a device"):
            check_output(tmp_path / name)


def test_outputs_that_replace_nothing_are_written(folder: Path, command_here: Command) -> None:
    shutil.copy(folder / "run.case.toml", folder / "mine.toml")
    for _ in range(2):
        result = command_here("boreprop", "simulate", "mine.toml", "--length", "1", "--output", "new.csv")
        assert (result.returncode, result.stderr) == (0, "")

"""Files that are meant to do harm, or that no case can be: one line says why, and soon."""

import os
from dataclasses import replace
from pathlib import Path

import pytest

from boreprop.case.file import load_case, parse_case, read_run
from boreprop.case.inputs import Schedule
from boreprop.case.paper import paper_case
from boreprop.core.errors import ParameterError
from boreprop.errors import InputError
from boreprop.run.engines import DRILLING
from boreprop.run.files import case_path
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from conftest import Command, assert_refused

NESTED = "[" * 20_000
HOSTILE = {
    "open brackets": NESTED,
    "open braces": "{a=" * 20_000,
    "closed brackets": "[" * 800 + "]" * 800,
    "long integer": "9" * 5000,
    "long negative integer": "-" + "9" * 5000,
    "long hexadecimal integer": "0x" + "f" * 5000,
    "long integer in a list": f"[{'0x' + 'f' * 5000}]",
    "integer of 400 digits": "9" * 400,
    "long key in a table": "{" + ".".join("a" * 20_000) + " = 1}",
    "date": "1979-05-27",
}


@pytest.mark.parametrize("value", HOSTILE.values(), ids=HOSTILE)
@pytest.mark.parametrize("key", ["length = 219.6", "stabilizer_positions  = [3.66, 7.32]", "force          = [0.0]"])
def test_a_hostile_value(command_here: Command, tmp_path: Path, paper_text: str, key: str, value: str) -> None:
    old = next(line for line in paper_text.splitlines() if line.split()[:1] == key.split()[:1])
    (tmp_path / "case.toml").write_text(paper_text.replace(old, f"{key.split()[0]} = {value}"), encoding="utf-8")
    assert_refused(command_here("boreprop", "simulate", "case.toml", "--output", "run.csv"), "case.toml: ")
    assert [path.name for path in tmp_path.iterdir()] == ["case.toml"]


@pytest.mark.parametrize("line", [".".join("a" * 20_000) + " = 1", f"[{'.'.join('a' * 20_000)}]", f"[{NESTED}"])
def test_a_hostile_key(paper_text: str, line: str) -> None:
    with pytest.raises(InputError, match=r"^case\.toml: must be TOML") as caught:
        parse_case(f"{line}\n{paper_text}", "case.toml")
    assert len(str(caught.value)) < 200
    assert read_run(f"{line}\n{paper_text}") == {}


def test_rows_of_dots_and_long_lists_are_no_long_keys(paper_text: str) -> None:
    depths = ", ".join(f"{0.1 * k:.1f}" for k in range(5000))
    text = f"# {'.' * 500}\n{paper_text.partition('[hole]')[0]}[hole]\nmeasured_depth = [{depths}]\n"
    text += f"inclination_deg = [{'0.5, ' * 5000}]\n[rss]\ndrilled_length = [0.0]\nforce = [0.0]\n"
    assert len(parse_case(text, "case.toml").survey.measured_depth) == 5000


@pytest.mark.parametrize("name", ['"\\u0000.csv"', '"/dev/zero"', '"/dev/fd"', '"pipe"', '"/"'])
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
def test_what_is_no_file_is_not_read(tmp_path: Path, paper_text: str, name: str) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "case.toml").write_text(f"{paper_text.partition('[hole]')[0]}[hole]\nsurvey = {name}\n")
    with pytest.raises(InputError, match=r"must be a (readable CSV file|path with forward slashes)"):
        load_case(tmp_path / "case.toml")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
def test_a_pipe_is_waited_for_by_no_reader(command_here: Command, tmp_path: Path, trajectory: Trajectory) -> None:
    names = ("case.toml", "run.csv", "run.parquet", "Borehole.fmu", "study.parquet")
    for name in names:
        os.mkfifo(tmp_path / name)
    write_trajectory(trajectory, tmp_path / "sound.csv")
    case_path(tmp_path / "sound.csv").unlink()
    os.mkfifo(case_path(tmp_path / "sound.csv"))
    for arguments in (
        ["boreprop", "simulate", "case.toml", "--output", "new.csv"],
        ["boreprop", "summary", "run.csv"],
        ["boreprop", "summary", "run.parquet"],
        ["boreprop", "summary", "sound.csv"],
        ["boreprop", "summary", "sound.csv", "--case", "case.toml"],
        ["boreprop-fmu", "run", "Borehole.fmu", "--output", "new.csv"],
        ["boreprop-fmu", "build", "case.toml", "--output", "new.fmu"],
        ["boreprop-view", "run.csv", "--save", "new.rrd"],
        ["boreprop-view", "sound.csv", "--save", "new.rrd"],
        ["boreprop-view", "Borehole.fmu", "--save", "new.rrd"],
        ["boreprop-view", "sound.csv", "--fmu", "Borehole.fmu", "--save", "new.rrd"],
    ):
        assert_refused(command_here(*arguments), "a pipe or a device")
    assert not list(tmp_path.glob("*new.*"))


@pytest.mark.parametrize("engine", DRILLING)
def test_a_schedule_of_integers(engine: str) -> None:

    whole, real = (
        replace(paper_case(), schedule=Schedule(*columns))
        for columns in (((0, 2), (0, 1000)), ((0.0, 2.0), (0.0, 1e3)))
    )
    assert whole == real
    runs = [simulate(case, length=5.0, engine=engine) for case in (whole, real)]
    for name, column in runs[0].items():
        assert column.dtype == float
        assert (column == runs[1][name]).all()


def test_an_integer_that_is_no_float() -> None:
    with pytest.raises(ParameterError, match=r"rss_force\[1\]: must be a finite number, got inf"):
        Schedule((0.0,), (10**400,))

"""The README: one screen, and every command and line of Python on it works."""

import re
import shutil
import sys
from pathlib import Path

import pytest
import typer

from conftest import Command
from forking import run_script
from places import EXAMPLES, ROOT

TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = [line.partition("#")[0].split() for line in re.findall(r"^    (boreprop.+)$", TEXT, re.MULTILINE)]
COMMANDS += [command.split() for command in re.findall(r"`(boreprop-fmu .+?)`", TEXT)]
PYTHON = re.findall(r"^```python\n(.+?)^```", TEXT, re.MULTILINE | re.DOTALL)
ONE_SCREEN = 60  # lines


def test_it_is_one_screen() -> None:
    assert len(TEXT.splitlines()) <= ONE_SCREEN


def test_what_it_shows_works_in_order(
    command_here: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, binaries: Path
) -> None:
    """The questions are answered by Return, and the viewer records, since there is no screen."""
    assert binaries.exists()
    shutil.copytree(EXAMPLES, tmp_path / "examples")
    monkeypatch.setattr(typer, "prompt", lambda _text, default, err: default)
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert {command[0] for command in COMMANDS} == {"boreprop", "boreprop-fmu", "boreprop-view"}
    for command in COMMANDS:
        without_a_screen = ["--save", "run.rrd"] if command[0] == "boreprop-view" else []
        assert command_here(*command, *without_a_screen).returncode == 0, command
    assert len(PYTHON) == 2
    printed = [run_script(["-c", lines], cwd=tmp_path).stdout for lines in PYTHON]
    assert printed[0].splitlines()[-1] == "True"
    assert float(printed[1]) != 0.0


@pytest.mark.parametrize("goal", sorted(set(re.findall(r"(?:^    |`)make (\w+)", TEXT, re.MULTILINE))))
def test_what_it_makes_can_be_made(goal: str) -> None:
    assert re.search(rf"^{goal}: ", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)

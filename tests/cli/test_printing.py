"""Tables and help as a terminal, a pipe or a file can take them: nothing is cut, and no character is too much."""

import io
import os
import sys
from pathlib import Path

import pytest

from boreprop.case.file import load_case
from boreprop.cli import app, printing
from boreprop.cli.printing import print_table
from boreprop.cli.signs import PLAIN, written
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate
from forking import start
from places import ROOT

CASE = ROOT / "examples/build_section.toml"
CELLS = [
    ("η·Π of the case", "+12.34 to +56.78", "a-word-that-is-long-and-has-no-blanks"),
    ("[1]", ":smile:", "[bold]x"),
]
TABLES = [
    ["roots", "CASE"],
    ["roots", "CASE", "--contact", "1"],
    ["steering", "CASE"],
    ["summary", "RUN", "--stations", "30"],
    ["dogleg", "CASE"],
]
PROGRAMS = ["boreprop.cli.app", "boreprop_fmu.cli", "boreprop_viz.cli"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("run")
    write_trajectory(simulate(load_case(CASE), length=100.0), path / "RUN.csv")
    return path


COMMANDS = [
    *(("boreprop.cli.app", table) for table in TABLES),
    *((module, ["--help"]) for module in PROGRAMS),
    *(("boreprop.cli.app", [command, "--help"]) for command in app.COMMANDS),
    ("boreprop_fmu.cli", ["run", "--help"]),
]
ALL = """
import sys
from importlib import import_module

for module, arguments in {commands}:
    sys.argv = ["it", *arguments]
    try:
        import_module(module).main()
    except SystemExit as end:
        assert not end.code, end.code
    print("=== next ===", flush=True)
"""


def run_all(folder: Path, commands: list[tuple[str, list[str]]], encoding: str, columns: str = "80") -> list[str]:
    """What each command prints to a pipe of an encoding, saying nothing else; one process runs them, one by one."""
    files = {"CASE": str(CASE), "RUN": str(folder / "RUN.csv")}
    given = [(module, [files.get(argument, argument) for argument in arguments]) for module, arguments in commands]
    run = start(["-c", ALL.format(commands=given)], env=os.environ | {"PYTHONIOENCODING": encoding, "COLUMNS": columns})
    printed, said = run.communicate()
    assert (run.wait(), said) == (0, b"")
    return printed.decode(encoding).replace("\r\n", "\n").split("=== next ===\n")[:-1]


@pytest.fixture(scope="module")
def in_utf_8(folder: Path) -> list[str]:
    """What each of the commands prints where any character will do."""
    return run_all(folder, COMMANDS, "utf-8")


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
def test_any_encoding_will_do(folder: Path, in_utf_8: list[str], encoding: str) -> None:
    for (_, arguments), utf_8, text in zip(COMMANDS, in_utf_8, run_all(folder, COMMANDS, encoding), strict=True):
        if "--help" in arguments:
            assert text == written(utf_8, encoding)
        else:  # the lines of the frame are others
            words = [word for word in text.split() if word.strip("+-|")]
            assert words == [word for word in written(utf_8, encoding).split() if word.strip("+-|?")]
            assert len({len(line) for line in text.splitlines() if line.startswith("|")}) <= 2


def test_signs_and_words() -> None:
    assert written("ηΠ ≤ 0.5, λ₂ → θ², ±5 °/30 m", "cp1252") == "etaPi <= 0.5, lambda2 -> theta², ±5 °/30 m"
    assert written("ηΠ ≤ 0.5 − é, ±5 °, 雪, \udcff", "ascii") == "etaPi <= 0.5 - e, +/-5 deg, ?, ?"


@pytest.mark.parametrize("width", [20, 60, 80, 500])
@pytest.mark.parametrize("terminal", [True, False])
def test_no_word_of_a_table_is_cut(monkeypatch: pytest.MonkeyPatch, width: int, terminal: bool) -> None:
    out = io.TextIOWrapper(io.BytesIO(), encoding="utf-8", errors=PLAIN)
    monkeypatch.setattr(out, "isatty", lambda: terminal, raising=False)
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setenv("COLUMNS", str(width))
    monkeypatch.setenv("NO_COLOR", "1")
    print_table(CELLS, ("reverses at", "kN", "heading[i]"), title="A title", caption="And a caption")
    out.flush()
    text = out.buffer.getvalue().decode()
    words = [word for line in (*CELLS, ("reverses at", "kN", "heading[i]")) for cell in line for word in cell.split()]
    assert all(word in text.split() for word in words)
    assert "…" not in text
    lines = [line for line in text.splitlines() if line.startswith("│")]
    if terminal:
        assert len({len(line) for line in lines}) == 1
    else:
        assert len(lines) == len(CELLS)


@pytest.mark.parametrize(("no_color", "plain"), [("1", True), ("", False)])
def test_no_color(monkeypatch: pytest.MonkeyPatch, no_color: str, plain: bool) -> None:
    out = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    monkeypatch.setattr(out, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("NO_COLOR", no_color)
    printing.print_table(CELLS, ("a", "b", "c"), title="A title")
    out.flush()
    assert (b"\x1b" in out.buffer.getvalue()) != plain


@pytest.mark.parametrize("columns", ["60", "200"])
def test_what_goes_into_a_pipe_does_not_depend_on_the_terminal(folder: Path, in_utf_8: list[str], columns: str) -> None:
    tables = COMMANDS[: len(TABLES)]
    of_another_width = run_all(folder, tables, "utf-8", columns)
    for (_, arguments), text, other in zip(tables, in_utf_8, of_another_width, strict=False):
        assert text == other, arguments
        assert "…" not in text

"""What a command leaves behind that is told to end while it works: nothing, and an exit status that says why."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from boreprop.case.case import Case
from boreprop.kernel.compiler import FOLDER
from boreprop_fmu.pack.build import build_fmu
from flavours import Flavour, both_flavours
from forking import start

pytestmark = pytest.mark.skipif(os.name != "posix", reason="no such signals")
ENDS = pytest.mark.parametrize(
    ("name", "status"), [("SIGINT", 130), ("SIGTERM", -signal.SIGTERM), ("SIGHUP", -signal.SIGHUP)]
)


def end(folder: Path, name: str, begun: Callable[[], object], *arguments: str | Path) -> int:
    """Start Python code with arguments, and send it a signal once it has begun. It is quiet; gives its exit status."""
    temporary = folder / "tmp"
    temporary.mkdir(exist_ok=True)
    run = start(["-c", *arguments], cwd=folder, env={**os.environ, "TMPDIR": str(temporary)})
    while not begun():
        assert run.poll() is None
        time.sleep(0.01)
    run.send_signal(getattr(signal, name))
    _, errors = run.communicate()
    assert errors == b""
    assert not list(temporary.iterdir())
    temporary.rmdir()
    return run.wait()


@ENDS
def test_a_file_that_is_being_written(tmp_path: Path, paper_case: Path, name: str, status: int) -> None:
    arguments = ["simulate", str(paper_case), "--output", "run.csv", "--length", "1000", "--sample-interval", "0.005"]
    begun = lambda: list(tmp_path.glob(".*.run.csv"))  # noqa: E731
    assert end(tmp_path, name, begun, "from boreprop.cli.app import main; main()", *arguments) == status
    assert not list(tmp_path.iterdir())


@both_flavours
@ENDS
def test_an_fmu_that_is_being_run(tmp_path: Path, case: Case, flavour: Flavour, name: str, status: int) -> None:
    fmu = build_fmu(case, tmp_path / "Borehole.fmu", runtime=flavour.runtime)
    arguments = ["run", str(fmu), "--output", "run.csv", "--step", "0.001", "--stop", "1000"]
    begun = lambda: list(tmp_path.glob("tmp/boreprop-fmu-*/binaries"))  # noqa: E731
    assert end(tmp_path, name, begun, "from boreprop_fmu.cli import main; main()", *arguments) == status
    assert list(tmp_path.iterdir()) == [fmu]


@ENDS
def test_a_library_that_is_being_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, status: int
) -> None:
    compiler = tmp_path / "slow"
    compiler.write_text(f"#!/bin/sh\ntouch {tmp_path}/begun\nexec sleep 60\n")
    compiler.chmod(0o755)
    monkeypatch.setenv("CC", str(compiler))
    before = set(FOLDER.iterdir())
    code = "import runpy; runpy.run_module('boreprop.kernel', run_name='__main__')"
    assert end(tmp_path, name, (tmp_path / "begun").exists, code) == status
    assert set(FOLDER.iterdir()) == before


REPLACED = """
import ctypes, os, signal, sys
import typer
from boreprop.cli.console import execute

class Number:
    @classmethod
    def from_param(cls, value):
        os.kill(os.getpid(), signal.SIGINT)

def command():
    ctypes.pythonapi.Py_IncRef.argtypes = [Number]
    ctypes.pythonapi.Py_IncRef(None)  # ArgumentError: argument 1: KeyboardInterrupt

app = typer.Typer()
app.command()(command)
sys.argv = ["command"]
execute(app)
"""


def test_ctrl_c_for_which_a_library_raises_an_error_of_its_own() -> None:
    done = subprocess.run([sys.executable, "-c", REPLACED], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


TWICE = """
import os, signal, sys
from boreprop.endings import endings_like_interrupt

first, second = (getattr(signal, name) for name in sys.argv[1:])
with endings_like_interrupt():
    try:
        os.kill(os.getpid(), first)
    finally:
        os.kill(os.getpid(), second)
        print("what cleans up comes to its end")
"""


@pytest.mark.parametrize("first", ["SIGINT", "SIGTERM"])
@pytest.mark.parametrize("second", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_second_signal_does_not_disturb_the_end_after_the_first(first: str, second: str) -> None:
    done = subprocess.run([sys.executable, "-c", TWICE, first, second], capture_output=True, text=True, timeout=60)
    assert done.stdout == "what cleans up comes to its end\n"
    assert done.returncode == -signal.Signals[first]


AT_RANDOM = """
import os, random, signal, sys, time
from pathlib import Path
from boreprop.endings import endings_like_interrupt
from boreprop.leftovers import temporary_folder
from boreprop.replacing import replacing

def write(folder):
    print(end="x", flush=True)
    while True:
        with temporary_folder("tmp-", folder) as place, replacing(folder / "run.csv") as draft:
            (place / "library").write_text("")
            draft.write_text("whole")

folder, chance = Path(sys.argv[1]), random.Random(1)
for _ in range(int(sys.argv[2])):
    begun, told = os.pipe()
    child = os.fork()
    if not child:
        os.dup2(told, 1)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        try:
            with endings_like_interrupt():
                write(folder)
        finally:
            os._exit(0)
    os.close(told)
    os.read(begun, 1)
    os.close(begun)
    for number in chance.choices([signal.SIGINT, signal.SIGTERM, signal.SIGHUP], k=3):
        time.sleep(chance.expovariate(1 / 3e-4))
        os.kill(child, number)
    os.waitpid(child, 0)
"""


def test_signals_at_any_moment_leave_neither_drafts_nor_folders(tmp_path: Path) -> None:
    command = [sys.executable, "-c", AT_RANDOM, str(tmp_path), "300"]
    subprocess.run(command, check=True, timeout=120)
    assert [path.name for path in tmp_path.iterdir()] in ([], ["run.csv"])
    assert all(path.read_text() == "whole" for path in tmp_path.iterdir())

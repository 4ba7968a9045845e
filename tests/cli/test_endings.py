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

pytestmark = pytest.mark.skipif(os.name != "posix", reason="no such signals")
ENDS = pytest.mark.parametrize(
    ("name", "status"), [("SIGINT", 130), ("SIGTERM", -signal.SIGTERM), ("SIGHUP", -signal.SIGHUP)]
)


def end(folder: Path, name: str, begun: Callable[[], object], *arguments: str | Path) -> int:
    """Start Python code with arguments, and send it a signal once it has begun. It is quiet; gives its exit status."""
    temporary = folder / "tmp"
    temporary.mkdir(exist_ok=True)
    run = subprocess.Popen(
        [sys.executable, "-c", *map(str, arguments)],
        cwd=folder,
        stderr=subprocess.PIPE,
        env={**os.environ, "TMPDIR": str(temporary)},
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    while not begun():
        assert run.poll() is None
        time.sleep(0.01)
    run.send_signal(getattr(signal, name))
    _, errors = run.communicate(timeout=60)
    assert errors == b""
    assert not list(temporary.iterdir())
    temporary.rmdir()
    return run.returncode


@ENDS
def test_a_file_that_is_being_written(tmp_path: Path, paper_case: Path, name: str, status: int) -> None:
    arguments = ["simulate", str(paper_case), "--output", "run.csv", "--length", "5000", "--sample-interval", "0.005"]
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

"""Signals that come while an FMU is called wait for the end of the call."""

import os
import signal
import zipfile
from pathlib import Path

import pytest

from boreprop.case.case import Case
from boreprop_fmu.pack.build import build_fmu
from forking import run_script

SCRIPT = """
import os, signal, sys
from boreprop_fmu.host.instance import interruptions, uninterrupted

def handler(number, frame):
    raise KeyboardInterrupt

number = getattr(signal, sys.argv[1])
if sys.argv[2] == "handled":
    signal.signal(number, handler)
try:
    with uninterrupted(interruptions()):
        os.kill(os.getpid(), number)
        print("the call ends", flush=True)
    print("nothing came")
except KeyboardInterrupt:
    print("then it came")
"""


@pytest.mark.skipif(os.name != "posix", reason="no such signals")
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_signal_that_is_handled_comes_after_the_call(name: str) -> None:
    done = run_script(["-c", SCRIPT, name, "handled"])
    assert (done.stdout, done.returncode) == ("the call ends\nthen it came\n", 0)


@pytest.mark.skipif(os.name != "posix", reason="no such signals")
def test_a_signal_that_nobody_handles_ends_the_process_at_once() -> None:
    done = run_script(["-c", SCRIPT, "SIGTERM", "not"])
    assert (done.stdout, done.returncode) == ("", -signal.SIGTERM)


SIGNALLING = """
def signalling(*arguments, call=Slave.{method}, **values):
    import os, signal
    os.kill(os.getpid(), signal.SIGTERM)
    return call(*arguments, **values)

Slave.{method} = signalling
"""
RUN = "import sys; from boreprop_fmu.cli import main; sys.argv[0] = 'boreprop-fmu'; main()"


@pytest.mark.skipif(os.name != "posix", reason="no such signals")
@pytest.mark.parametrize("method", ["__init__", "setup_experiment", "exit_initialization_mode", "terminate"])
def test_a_signal_while_an_fmu_begins_or_ends_is_no_error_of_the_fmu(case: Case, tmp_path: Path, method: str) -> None:
    """The FMU, which is Python, sends the signal itself, from the call."""
    fmu, signalling = build_fmu(case, tmp_path / "Borehole.fmu", runtime="python"), tmp_path / "Signalling.fmu"
    with zipfile.ZipFile(fmu) as archive, zipfile.ZipFile(signalling, "w") as changed:
        slave = archive.read("resources/slavemodule.txt").decode().strip()
        for name in archive.namelist():
            text = archive.read(name)
            if name == f"resources/{slave}.py":
                text += SIGNALLING.format(method=method).encode()
            changed.writestr(name, text)
    arguments = ["run", str(signalling), "--output", "run.csv", "--stop", "1"]
    done = run_script(["-c", RUN, *arguments], cwd=tmp_path)
    assert (done.returncode, done.stderr) == (-signal.SIGTERM, "")
    assert not (tmp_path / "run.csv").exists()

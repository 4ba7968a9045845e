"""Signals that come while an FMU is called wait for the end of the call."""

import os
import signal
import subprocess
import sys

import pytest

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
    done = subprocess.run([sys.executable, "-c", SCRIPT, name, "handled"], capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.returncode) == ("the call ends\nthen it came\n", 0)


@pytest.mark.skipif(os.name != "posix", reason="no such signals")
def test_a_signal_that_nobody_handles_ends_the_process_at_once() -> None:
    done = subprocess.run([sys.executable, "-c", SCRIPT, "SIGTERM", "not"], capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.returncode) == ("", -signal.SIGTERM)

"""Recordings for tests, viewers that take them, and processes that make them.

Most viewers here are the command `rerun --save`, which takes what a viewer takes and writes it to a file.
"""

import os
import random
import socket
import subprocess
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from textwrap import dedent
from typing import TypeVar

import numpy as np
import psutil
import pytest
import rerun as rr
from rerun.chunk import RrdReader

from boreprop_viz import feeder
from boreprop_viz.feeder import PROGRAM
from boreprop_viz.picture import SOFTWARE_DRIVERS
from boreprop_viz.ports import LOOPBACK, bound
from forking import Process, start
from places import TESTS

T = TypeVar("T")

ROWS = 1000  # in a batch
signals = pytest.mark.skipif(os.name != "posix", reason="no such signals")
draws = pytest.mark.skipif(
    not SOFTWARE_DRIVERS, reason="no software Vulkan driver (Debian: mesa-vulkan-drivers and libvulkan1)"
)


def send(rec: rr.RecordingStream, batches: range) -> None:
    """Log a scalar and 100 points a row, 1.2 MB a batch that do not compress."""
    for batch in batches:
        rows = np.arange(batch * ROWS, (batch + 1) * ROWS)
        index = [rr.TimeColumn("row", sequence=rows)]
        points = np.random.default_rng(batch).random((100 * ROWS, 3), dtype=np.float32)
        rec.send_columns("cloud", index, rr.Points3D.columns(positions=points).partition([100] * ROWS))
        rec.send_columns("row", index, rr.Scalars.columns(scalars=rows.astype(float)))


def read(path: Path) -> list[float]:
    """The scalars in a recording, in their order; those so far, if it is still being written."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="RRD file has no footer")
        try:
            stream = RrdReader(path).stream()
        except (ValueError, RuntimeError):  # no recording yet, half a chunk
            return []
    chunks = stream.filter(content="/row", components="Scalars:scalars", has_timeline="row")
    batches = [chunk.to_record_batch() for chunk in chunks]
    return sorted(value for batch in batches for [value] in batch.column("Scalars:scalars").to_pylist())


def rows(batches: int) -> list[float]:
    """What there is to read after so many batches."""
    return [float(row) for row in range(batches * ROWS)]


def sound(path: Path) -> bool:
    """Whether Rerun itself finds nothing wrong in a file, not even that its end is missing."""
    return subprocess.run([PROGRAM, "rrd", "verify", path], capture_output=True, check=False).returncode == 0


def until(ask: Callable[[], T | None]) -> T:
    """Ask until there is something in the answer."""
    for _ in range(600):
        if answer := ask():
            return answer
        time.sleep(0.05)
    raise TimeoutError


def listens(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex((LOOPBACK, port)) == 0


def own_port() -> int:
    """A free port that no other process of the suite takes, not even when the viewer at it has ended.

    Systems give out ports from 32768 on, or higher, to whoever asks for any.
    """
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    for port in random.sample(range(20000 + 500 * worker, 20500 + 500 * worker), 100):
        with suppress(OSError):
            return bound(port)
    raise OSError("no free port for a viewer")


@contextmanager
def rerun(
    *options: str | Path, env: dict[str, str] | None = None, port: int | None = None
) -> Iterator[tuple[subprocess.Popen[bytes], str]]:
    """Run a viewer that is there already, at a port or any; yields its process and its address."""
    port = port or own_port()
    where = ["--bind", LOOPBACK, "--port", str(port)]
    process = subprocess.Popen([PROGRAM, *where, *options], stderr=subprocess.DEVNULL, env=env)
    try:
        until(lambda: listens(port))
        yield process, f"rerun+http://{LOOPBACK}:{port}/proxy"
    finally:
        process.kill()
        process.wait()


def port_of(address: str) -> int:
    return int(address.rpartition(":")[2].partition("/")[0])


def stand_in(command: str, monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Let a command, which is given rerun's path and options, be the viewer of `spawn` and `serve`."""
    program = folder / "viewer"
    program.write_text(f"#!/bin/sh\nrerun='{PROGRAM}'\n{command}\n")
    program.chmod(0o755)
    monkeypatch.setattr(feeder, "PROGRAM", str(program))


def children_from_now_on() -> Callable[[], list[psutil.Process]]:
    """A function that lists the processes which are started after this and still run."""
    others = psutil.Process().children(recursive=True)  # which earlier tests have left to help multiprocessing
    return lambda: [process for process in psutil.Process().children(recursive=True) if process not in others]


def script(body: str, env: Mapping[str, str] = os.environ) -> Process:
    """Start another Python, in a process group of its own as from a terminal, that has `send` and `open_recording`."""
    top = f"import sys\nsys.path.append({str(TESTS)!r})\n"
    top += "from boreprop_viz.sinks import open_recording\nfrom viewers import send\n"
    return start(["-c", top + dedent(body)], env=env)


def boreprop_view(*arguments: str | Path, before: str = "", folder: Path) -> Process:
    """Start the command boreprop-view, as `script` does, after a line of Python; its new viewers need no screen."""
    program = folder / "viewer"
    program.write_text(f"""#!/bin/sh\ncase "$*" in *--web-viewer*) ;; *) set -- --serve-grpc "$@";; esac
exec '{PROGRAM}' "$@"\n""")
    program.chmod(0o755)
    return script(
        f"""
            import signal
            from boreprop_viz import cli, feeder
            feeder.PROGRAM = {str(program)!r}
            sys.argv = ["boreprop-view", *{[str(argument) for argument in arguments]!r}]
            {before}
            cli.main()
        """,
        env=os.environ | {"BROWSER": "true"},
    )

"""A whole run into a recording: to a file, to a viewer, or both."""

import socket
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import rerun as rr

from boreprop.case import Case, InputError
from boreprop.results import Trajectory, replacing

from .layout import blueprint
from .stream import RunStream
from .style import scales

APPLICATION = "boreprop"
BATCH = 1000  # rows


def record(
    run: Trajectory,
    *,
    save: str | Path | None = None,
    connect: str | None = None,
    progress: Callable[[float], None] = lambda _: None,
) -> None:
    """Draw a run into a file, a viewer, or both.

    Parameters
    ----------
    run
        The run, with its case.
    save
        The .rrd file to write. Nothing of that name changes before everything is written.
    connect
        Address of a Rerun viewer, rerun+http://…/proxy.
    progress
        Called with the number of rows done.

    Raises
    ------
    InputError
        If the run lacks its case or a column, or its drilled length decreases.
    ConnectionError
        If there is no viewer at `connect`.
    OSError
        If the file cannot be written.
    """
    case = check(run)
    look = scales(run, case)
    with ExitStack() as stack:
        sinks: list[rr.FileSink | rr.GrpcSink] = []
        if connect is not None:
            sinks.append(viewer_sink(connect))
        if save is not None:
            sinks.append(rr.FileSink(stack.enter_context(replacing(Path(save)))))
        rec = rr.RecordingStream(APPLICATION)
        rec.set_log_time_enabled(False)
        rec.set_sinks(*sinks, default_blueprint=blueprint(look))
        stack.callback(rec.disconnect)  # this writes the file's end, before it takes its name
        stream = RunStream(rec, case, look)
        for done, rows in batches(run):
            stream.send(rows)
            progress(done)
        rec.flush()


def viewer_sink(address: str) -> rr.GrpcSink:
    """The way to the viewer at `address`; `ConnectionError` if there is none, for which Rerun would wait for ever."""
    try:
        sink = rr.GrpcSink(address)
        place = urlsplit(address)
        socket.create_connection((place.hostname, place.port or 9876), timeout=5.0).close()
    except (RuntimeError, OSError, ValueError) as error:
        message = f"the viewer must listen at rerun+http://HOST:PORT/proxy, got {address!r}: {error}"
        raise ConnectionError(message) from error
    return sink


def check(run: Trajectory) -> Case:
    """The case of a run that can be drawn; `InputError` if it cannot."""
    if run.case is None:
        raise InputError("the run must have its case, got none: give it with --case or --fmu")
    length = run["drilled_length"]
    back = np.flatnonzero(np.diff(length) < 0.0)
    if back.size:
        raise InputError(f"drilled_length: row {back[0] + 2}: must not decrease, got {length[back[0] + 1]:g}")
    return run.case


def batches(run: Trajectory) -> Iterator[tuple[int, Trajectory]]:
    """Consecutive rows of a run, and how many there have been with them."""
    for first in range(0, len(run), BATCH):
        columns = {name: column[first : first + BATCH] for name, column in run.columns.items()}
        rows = Trajectory(columns, run.case)
        yield first + len(rows), rows

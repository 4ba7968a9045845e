"""Sends a recording to a file, to a viewer, or to both.

A recording is always written to a file, which is removed afterwards unless it was asked for, and a viewer is sent what
is in the file. So a run waits for the disk alone. (Rerun's own connections block the run, and for ever if the viewer
hangs.)
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from urllib.parse import quote

import rerun as rr

from boreprop.cli.console import warn
from boreprop.errors import InputError
from boreprop.leftovers import temporary_folder
from boreprop.replacing import replacing

from .feeder import Feeder, NewViewer, RunningViewer, check_that_one_listens
from .ports import LOOPBACK, check_free, free_port, port_pair

APPLICATION = "boreprop"
SERVER_MEMORY = "50%"  # of this machine's, that what is served may take; beyond that Rerun drops the oldest
PATIENCE = 20.0  # s after which a disk that accepts no data is given up


@contextmanager
def open_recording(
    application: str = APPLICATION,
    *,
    save: str | Path | None = None,
    spawn: bool = False,
    serve: bool = False,
    connect: str | None = None,
    port: int | None = None,
) -> Iterator[rr.RecordingStream]:
    """Open a recording whose data go to a file, to a viewer, or to both.

    When the block ends, the file is complete and the viewer has all data. With `spawn` this then waits until the viewer
    is closed, with `serve` until Ctrl-C. If the viewer fails, there is a warning at the end.

    Parameters
    ----------
    application
        What Rerun calls the application; recordings of one application share a layout in a viewer.
    save
        The .rrd file to write. An existing file is replaced when the block ends, also by Ctrl-C (with the data up to
        then), but not by any other exception.
    spawn, serve, connect
        The viewer, at most one: a new window, the browser, or the viewer at an address rerun+http://HOST:PORT/proxy.
        The first two listen on this machine only. A browser that comes late is sent everything, unless that takes more
        than half of this machine's memory: then the oldest data are missing. A viewer at an address may end during the
        run: the next one there is sent everything, from the beginning.
    port
        With `serve`, the port of the page; the data are at the next one. With `spawn`, the port at which the new viewer
        takes further data. None: ports that are free.

    Raises
    ------
    InputError
        If `connect` is not such an address, a port is in use or given without `serve` and `spawn`; without `save`, if
        the viewer does not start.
    ConnectionError
        Without `save`, if there is no viewer at `connect`.
    OSError
        If the file cannot be written.
    """
    interrupt = viewer = None
    with replacing(Path(save)) if save is not None else scratch_file() as draft:
        try:
            with recording_to(draft, application) as rec:
                viewer = open_viewer(draft, spawn, serve, connect, port, required=save is None)
                yield rec
            if viewer is not None:
                viewer.finish()
        except BaseException as error:
            if viewer is not None:
                viewer.stop()
            if not isinstance(error, KeyboardInterrupt):
                raise
            interrupt = error
    if interrupt is not None:
        raise interrupt
    if viewer is not None:
        viewer.wait()


@contextmanager
def scratch_file() -> Iterator[Path]:
    """Yield the name of a file that is removed at the end."""
    with temporary_folder("boreprop-view-") as folder:
        yield folder / f"{APPLICATION}.rrd"


@contextmanager
def recording_to(path: Path, application: str) -> Iterator[rr.RecordingStream]:
    """Open a recording whose data go to a file, which is complete at the end; `OSError` if it cannot be written."""
    rec = new_recording(application)
    try:
        try:
            rec.set_sinks(rr.FileSink(path))
        except RuntimeError as error:
            raise OSError(f"{path}: must be a file that can be written, got: {error}") from error
        yield rec
        flush(rec)
    finally:
        end = Thread(target=rec.disconnect, daemon=True)  # writes the end of the file
        end.start()
        end.join(PATIENCE)  # like `flush`, it may wait for ever
        if end.is_alive():
            raise OSError(f"{path}: must be written within {PATIENCE:g} s, got a file without its end")


def new_recording(application: str) -> rr.RecordingStream:
    """A recording of an application, without the time of day. What Rerun does not take in a name becomes "-"."""
    rec = rr.RecordingStream(re.sub(r"[^A-Za-z0-9 :\[\]_-]", "-", application))
    rec.set_log_time_enabled(False)
    return rec


def flush(rec: rr.RecordingStream) -> None:
    """Wait until all data sent so far are in the file; `OSError` if they cannot be written.

    Rerun may wait for ever if the disk is full, so the wait ends after `PATIENCE`.
    """
    try:
        rec.flush(timeout_sec=PATIENCE)
    except (RuntimeError, TimeoutError) as error:
        raise OSError(f"the recording must be written within {PATIENCE:g} s, got: {error}") from error


def open_viewer(
    path: Path, spawn: bool, serve: bool, connect: str | None, port: int | None, required: bool
) -> Feeder | None:
    """Start to send a growing file to a viewer, see `open_recording`; None if no viewer is wanted."""
    if port is not None and not (spawn or serve):
        raise InputError(f"port: must be given with spawn or serve, got {port} without")
    if connect is not None:
        seen = True
        try:
            check_that_one_listens(connect)
        except ConnectionError as error:
            if required:
                raise
            seen = False
            warn(f"{error}; one that starts there before the end is sent everything")
        return RunningViewer(path, connect, seen)
    if serve:
        page, data = port_pair(port)
        address = quote(f"rerun+http://{LOOPBACK}:{data}/proxy", safe="")
        print(f"until Ctrl-C: http://{LOOPBACK}:{page}/?url={address}&hide_welcome_screen", flush=True)
        where = ["--bind", LOOPBACK, "--port", str(data), "--web-viewer", "--web-viewer-port", str(page)]
        return NewViewer(path, *where, "--server-memory-limit", SERVER_MEMORY)
    if not spawn:
        return None
    if port is None:
        port = free_port()
    else:
        check_free(port)
    viewer = NewViewer(path, "--bind", LOOPBACK, "--port", str(port), "--hide-welcome-screen")
    if required:
        try:
            viewer.await_start(f"rerun+http://{LOOPBACK}:{port}/proxy")
        except BaseException:
            viewer.stop()
            raise
    return viewer

"""Sends a recording to a file, to a viewer, or to both.

A recording is always written to a file, which is removed afterwards unless it was asked for. A viewer is another
process. A thread reads the growing file and writes it to the viewer's standard input. So a run waits for the disk
alone. A viewer that is slow, hangs, dies or never starts blocks that thread and nothing else, and what it has not read
yet takes no memory. (Rerun's own connections block the run, and for ever if the viewer hangs.)
"""

import os
import shutil
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.resources import files
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen, TimeoutExpired
from tempfile import TemporaryDirectory
from threading import Event, Thread
from time import monotonic, sleep
from urllib.parse import quote, urlsplit

import rerun as rr
from rerun.experimental import ViewerClient

from boreprop.cli.console import warn
from boreprop.errors import InputError
from boreprop.replacing import replacing

APPLICATION = "boreprop"
LOOPBACK = "127.0.0.1"  # only this machine; by default Rerun listens on all its networks
PORT = 9876  # Rerun's default
# the binary itself: the command `rerun` is a wrapper, and ending that would not end its child
PROGRAM = shutil.which("rerun", path=str(files("rerun_cli"))) or "rerun"
# reading the standard input occupies one thread; without a second one a viewer would show nothing until that ends
THREADS = max(2, (os.cpu_count() or 2) - 2)
BLOCK = 1 << 16  # bytes that are read from the file and written to the viewer at once
TICK = 0.05  # s between two checks whether the file has grown
STARTS_WITHIN = 30.0  # s that a viewer may take to start
PATIENCE = 20.0  # s after which a viewer or a disk that accepts no data is given up


@contextmanager
def open_recording(
    application: str = APPLICATION,
    *,
    save: str | Path | None = None,
    spawn: bool = False,
    serve: bool = False,
    connect: str | None = None,
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
        The first two listen on this machine only.

    Raises
    ------
    InputError
        If `connect` is not such an address; without `save`, if the viewer does not start.
    ConnectionError
        Without `save`, if there is no viewer at `connect`.
    OSError
        If the file cannot be written.
    """
    interrupt = viewer = None
    with replacing(Path(save)) if save is not None else scratch_file() as draft:
        try:
            with recording_to(draft, application) as rec:
                viewer = open_viewer(draft, spawn, serve, connect, required=save is None)
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
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        yield Path(folder) / f"{APPLICATION}.rrd"


@contextmanager
def recording_to(path: Path, application: str) -> Iterator[rr.RecordingStream]:
    """Open a recording whose data go to a file, which is complete at the end; `OSError` if it cannot be written."""
    rec = rr.RecordingStream(application)
    rec.set_log_time_enabled(False)
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


def flush(rec: rr.RecordingStream) -> None:
    """Wait until all data sent so far are in the file; `OSError` if they cannot be written.

    Rerun may wait for ever if the disk is full, so the wait ends after `PATIENCE`.
    """
    try:
        rec.flush(timeout_sec=PATIENCE)
    except (RuntimeError, TimeoutError) as error:
        raise OSError(f"the recording must be written within {PATIENCE:g} s, got: {error}") from error


class Viewer:
    """A process of Rerun's viewer that is sent a growing file.

    Parameters
    ----------
    path
        The file.
    options
        Options of the command `rerun`.
    stays
        Whether the process, once it has all data, runs until the user closes it.
    """

    def __init__(self, path: Path, *options: str, stays: bool) -> None:
        command = [PROGRAM, *options, "--threads", str(THREADS), "-"]
        environment = os.environ | {"RERUN_APP_ONLY": "true"}  # without any dialogue
        self.process = Popen(command, stdin=PIPE, stdout=DEVNULL, stderr=DEVNULL, env=environment)
        self.stays = stays
        self.complete = Event()  # set when the file is complete
        self.taken = 0  # bytes that the viewer has read
        self.fed = False  # whether the viewer has read the whole file
        self.feeder = Thread(target=self._feed, args=(path,), daemon=True)
        self.feeder.start()

    def _feed(self, path: Path) -> None:
        assert self.process.stdin is not None
        with suppress(OSError), self.process.stdin as pipe, open(path, "rb") as file:
            complete = False
            while not complete:
                complete = self.complete.wait(TICK)  # checked before the last read, so that no data are missed
                while block := file.read(BLOCK):
                    pipe.write(block)
                    self.taken += len(block)
                pipe.flush()
            self.fed = True

    def await_start(self, address: str) -> None:
        """Wait until the viewer answers at `address`; `InputError` if it ends instead."""
        deadline = monotonic() + STARTS_WITHIN
        while self.process.poll() is None and monotonic() < deadline:
            with suppress(OSError):
                ViewerClient.connect(address).get_state()  # it may listen and still fail to find a screen
                return
            sleep(TICK)
        if self.process.poll() is not None:
            message = "the Rerun viewer must start, for which it needs a screen: use --save, --serve or --connect"
            raise InputError(f"{message}, got exit status {self.process.returncode}")

    def finish(self) -> None:
        """Declare the file complete, and wait until the viewer has read all of it or stops reading."""
        self.complete.set()
        taken = -1
        while self.feeder.is_alive() and taken < self.taken:
            taken = self.taken
            self.feeder.join(PATIENCE)

    def wait(self) -> None:
        """Wait until the viewer is closed or has passed on all data, or until Ctrl-C; warn if it has failed."""
        with suppress(KeyboardInterrupt):
            try:
                status = self.process.wait(None if self.stays else PATIENCE if self.fed else 0.0)
            except TimeoutExpired:
                warn("the viewer hangs: it may not have received all data")
            else:
                if status or not self.fed:
                    warn(f"the viewer ended with exit status {status}: it may not have received all data")
        self.stop()

    def stop(self) -> None:
        """End the viewer and the thread that feeds it."""
        self.process.kill()
        self.process.wait()
        self.complete.set()
        self.feeder.join()


def open_viewer(path: Path, spawn: bool, serve: bool, connect: str | None, required: bool) -> Viewer | None:
    """Start the viewer of a growing file, see `open_recording`.

    None if no viewer is wanted, or if there is none at the address and none is `required`.
    """
    if connect is not None:
        try:
            host, port = reach(connect)
        except ConnectionError as error:
            if required:
                raise
            warn(str(error))
            return None
        # a viewer that is given the port of another one passes all data on to that one
        return Viewer(path, "--bind", host, "--port", str(port), "--headless", stays=False)
    if not (spawn or serve):
        return None
    port, web_port = free_port(), free_port()
    address = f"rerun+http://{LOOPBACK}:{port}/proxy"
    where = ["--bind", LOOPBACK, "--port", str(port)]
    if serve:
        print(f"until Ctrl-C: http://{LOOPBACK}:{web_port}/?url={quote(address, safe='')}", flush=True)
        return Viewer(path, *where, "--web-viewer", "--web-viewer-port", str(web_port), stays=True)
    viewer = Viewer(path, *where, "--hide-welcome-screen", stays=True)
    if required:
        try:
            viewer.await_start(address)
        except BaseException:
            viewer.stop()
            raise
    return viewer


def reach(address: str) -> tuple[str, int]:
    """IP address and port of a viewer; `InputError` if its address is bad, `ConnectionError` if none is there."""
    expected = f"the viewer must listen at rerun+http://HOST:PORT/proxy, got {address!r}"
    try:
        url = urlsplit(address)
        place = url.hostname or "", url.port or PORT
    except ValueError as error:
        raise InputError(f"{expected}: {error}") from error
    if (url.scheme, url.path) != ("rerun+http", "/proxy") or not url.hostname:
        raise InputError(expected)
    try:
        with socket.create_connection(place, timeout=5.0) as connection:
            host, port = connection.getpeername()[:2]
    except OSError as error:
        raise ConnectionError(f"{expected}: {error}") from error
    return host, port


def free_port() -> int:
    """A port of this machine that is free."""
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        port: int = probe.getsockname()[1]
    return port

"""Where a recording goes: a file, a viewer, or both.

A recording is always written to a file, which is removed afterwards unless it was asked for. A viewer is another
process; a thread feeds it, through its standard input, what is in the file and what is added. So a run waits for the
disk alone. A viewer that is slow, hangs, dies or never comes holds up that thread and nothing else, and what it has not
taken yet needs no memory. (Rerun's own connections hold up the run: with a viewer that hangs, for ever.)
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
LOOPBACK = "127.0.0.1"  # Rerun's own default is every network that the machine is in
PORT = 9876  # Rerun's default
# the binary itself: the command is a wrapper, whose child outlives it
PROGRAM = shutil.which("rerun", path=str(files("rerun_cli"))) or "rerun"
# the standard input takes one, and a viewer without another would show nothing until it ends
THREADS = max(2, (os.cpu_count() or 2) - 2)
BLOCK = 1 << 16  # bytes, read and fed at once
TICK = 0.05  # s, between two looks at the file
STARTS_WITHIN = 30.0  # s, a viewer
PATIENCE = 20.0  # s, with a viewer or a disk that takes nothing


@contextmanager
def open_recording(
    *, save: str | Path | None = None, spawn: bool = False, serve: bool = False, connect: str | None = None
) -> Iterator[rr.RecordingStream]:
    """Open a recording whose data go to a file, a viewer, or both.

    When the block has ended the file is complete, and the viewer has everything. Then this waits, with `spawn` until
    the viewer is closed, with `serve` until Ctrl-C. A viewer that fails is a warning at the end.

    Parameters
    ----------
    save
        The .rrd file to write. Nothing of that name changes before the block has ended: then the file takes its place,
        after Ctrl-C with what there is by then, but not after any other exception.
    spawn, serve, connect
        The viewer, one at most: a new window, the browser, or the one at an address rerun+http://HOST:PORT/proxy. The
        first two listen on this machine alone.

    Raises
    ------
    InputError
        If `connect` is no such address; without `save`, if the viewer does not start.
    ConnectionError
        Without `save`, if there is no viewer at `connect`.
    OSError
        If the file cannot be written.
    """
    interrupt = viewer = None
    with replacing(Path(save)) if save is not None else scratch_file() as draft:
        try:
            with recording_to(draft) as rec:
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
def recording_to(path: Path) -> Iterator[rr.RecordingStream]:
    """Open a recording whose data go to a file, which is complete at the end; `OSError` if it cannot be written."""
    rec = rr.RecordingStream(APPLICATION)
    rec.set_log_time_enabled(False)
    try:
        try:
            rec.set_sinks(rr.FileSink(path))
        except RuntimeError as error:
            raise OSError(f"{path}: must be a file that can be written, got: {error}") from error
        yield rec
        flush(rec)
    finally:
        end = Thread(target=rec.disconnect, daemon=True)  # this writes the file's end
        end.start()
        end.join(PATIENCE)  # as `flush`
        if end.is_alive():
            raise OSError(f"{path}: must be written within {PATIENCE:g} s, got a file without its end")


def flush(rec: rr.RecordingStream) -> None:
    """Wait until what has been sent is in its file; `OSError` if it cannot be written.

    Rerun may wait for ever where a disk has filled up, so there is an end to it.
    """
    try:
        rec.flush(timeout_sec=PATIENCE)
    except (RuntimeError, TimeoutError) as error:
        raise OSError(f"the recording must be written within {PATIENCE:g} s, got: {error}") from error


class Viewer:
    """A process of Rerun's, fed with a file that grows.

    Parameters
    ----------
    path
        The file.
    options
        Of the command `rerun`.
    stays
        Whether it stays when it has everything, until it is closed.
    """

    def __init__(self, path: Path, *options: str, stays: bool) -> None:
        command = [PROGRAM, *options, "--threads", str(THREADS), "-"]
        environment = os.environ | {"RERUN_APP_ONLY": "true"}  # ask nothing
        self.process = Popen(command, stdin=PIPE, stdout=DEVNULL, stderr=DEVNULL, env=environment)
        self.stays = stays
        self.complete = Event()  # the file
        self.taken = 0  # bytes
        self.fed = False  # all of them
        self.feeder = Thread(target=self._feed, args=(path,), daemon=True)
        self.feeder.start()

    def _feed(self, path: Path) -> None:
        assert self.process.stdin is not None
        with suppress(OSError), self.process.stdin as pipe, open(path, "rb") as file:
            complete = False
            while not complete:
                complete = self.complete.wait(TICK)  # before the last look, or what came in between would be missed
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
                ViewerClient.connect(address).get_state()  # that it listens does not mean that it finds a screen
                return
            sleep(TICK)
        if self.process.poll() is not None:
            message = "the Rerun viewer must start, for which it needs a screen: use --save, --serve or --connect"
            raise InputError(f"{message}, got exit status {self.process.returncode}")

    def finish(self) -> None:
        """Now that the file is complete, wait until the viewer has taken all of it, or takes nothing any more."""
        self.complete.set()
        taken = -1
        while self.feeder.is_alive() and taken < self.taken:
            taken = self.taken
            self.feeder.join(PATIENCE)

    def wait(self) -> None:
        """Wait until the viewer is closed, or Ctrl-C, or it has passed everything on; warn if something went wrong."""
        with suppress(KeyboardInterrupt):
            try:
                status = self.process.wait(None if self.stays else PATIENCE if self.fed else 0.0)
            except TimeoutExpired:
                warn("the viewer hangs: it may not have got everything")
            else:
                if status or not self.fed:
                    warn(f"the viewer ended with exit status {status}: it may not have got everything")
        self.stop()

    def stop(self) -> None:
        """End the viewer, and with it the feeding."""
        self.process.kill()
        self.process.wait()
        self.complete.set()
        self.feeder.join()


def open_viewer(path: Path, spawn: bool, serve: bool, connect: str | None, required: bool) -> Viewer | None:
    """Show a file that grows, see `open_recording`; None if no viewer is wanted, or not `required` and not there."""
    if connect is not None:
        try:
            host, port = reach(connect)
        except ConnectionError as error:
            if required:
                raise
            warn(str(error))
            return None
        # a viewer that is told of a port where another one listens passes everything on to it
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

"""Viewers that are sent a growing file: new ones, and those that run already at an address.

A viewer is another process. A thread reads the file and writes it to the standard input of the command `rerun`. A
viewer that is slow, hangs, dies or never starts blocks that thread and nothing else, and what it has not read yet takes
no memory.
"""

import os
import re
import shutil
import socket
import sys
from abc import ABC, abstractmethod
from collections import deque
from contextlib import suppress
from importlib.resources import files
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen
from threading import Event, Lock, Thread
from time import monotonic, sleep
from urllib.parse import urlsplit

from rerun.experimental import ViewerClient

from boreprop.cli.console import warn
from boreprop.errors import InputError

PORT = 9876  # Rerun's default
# the binary itself: the command `rerun` is a wrapper, and ending that would not end its child
PROGRAM = shutil.which("rerun", path=str(files("rerun_cli"))) or "rerun"
# reading the standard input occupies one thread; without a second one a viewer would show nothing until that ends
THREADS = max(2, (os.cpu_count() or 2) - 2)
QUIET = {"RERUN_APP_ONLY": "true", "CI": "true"}  # without any dialogue, and without statistics for Rerun's makers
SCREENS = ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET")  # environment variables that name one, on Linux
BLOCK = 1 << 16  # bytes that are read from the file and written to the viewer at once
TICK = 0.05  # s between two checks whether the file has grown
RETRY = 1.0  # s between two looks whether a viewer has come back
STARTS_WITHIN = 30.0  # s that a viewer may take to start
PATIENCE = 20.0  # s after which a viewer that accepts no data is given up
LAST_LINES = 50  # of what a viewer says, which are kept
COLOUR = re.compile(r"\x1b\[[0-9;]*m")
ERROR = re.compile(r"^(?:Error:|\S+\s+ERROR\s+\S+:)\s+(.+)")  # the end of Rerun, and a line of its log
PLACE = re.compile(r" at \S+\.rs:\d+")  # in Rerun's sources


class Rerun(Popen[bytes]):
    """The command `rerun`, which reads a recording from its standard input.

    Parameters
    ----------
    options
        Its other options.
    """

    def __init__(self, *options: str) -> None:
        command = [PROGRAM, *options, "--threads", str(THREADS), "-"]
        super().__init__(command, stdin=PIPE, stdout=DEVNULL, stderr=PIPE, env=os.environ | QUIET)
        self.lines: deque[str] = deque(maxlen=LAST_LINES)  # that it has said
        self.listener = Thread(target=self._listen, daemon=True)
        self.listener.start()

    def _listen(self) -> None:
        assert self.stderr is not None
        with self.stderr as lines:
            for line in lines:
                self.lines.append(line.decode(errors="replace"))

    def ending(self) -> str:
        """The exit status of the ended process, and its last word on an error, if it had one."""
        self.listener.join(1.0)  # longer if another process has taken over its output
        errors = [found[1] for line in self.lines if (found := ERROR.match(COLOUR.sub("", line).strip()))]
        return f"exit status {self.returncode}" + (f" ({PLACE.sub('', errors[-1])})" if errors else "")

    def end(self) -> None:
        """End the process at once."""
        self.kill()
        self.wait()


class Feeder(ABC):
    """A thread that writes a growing file to a viewer."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.complete = Event()  # set when the file is complete
        self.taken = 0  # bytes that viewers have read
        self.fed = False  # whether the viewer has read the whole file
        self.thread = Thread(target=self._run, daemon=True)
        self.thread.start()

    @abstractmethod
    def _run(self) -> None:
        """Find the viewer's process, write the file to it, and say in `fed` whether that went well."""

    def _feed(self, process: Rerun) -> bool:
        """Write the file to a process while it grows; whether the process has read all of it."""
        assert process.stdin is not None
        with suppress(OSError), process.stdin as pipe, open(self.path, "rb") as file:
            complete = False
            while not complete and process.poll() is None:
                complete = self.complete.wait(TICK)  # checked before the last read, so that no data are missed
                while block := file.read(BLOCK):
                    pipe.write(block)
                    self.taken += len(block)
                pipe.flush()
            return complete
        return False

    def finish(self) -> None:
        """Declare the file complete, and wait until the viewer has read all of it or stops reading."""
        self.complete.set()
        taken = -1
        while self.thread.is_alive() and taken < self.taken:
            taken = self.taken
            self.thread.join(PATIENCE)

    @abstractmethod
    def wait(self) -> None:
        """Wait for the end of the viewer, if it is ours; warn if the viewer has failed."""

    @abstractmethod
    def stop(self) -> None:
        """End all processes and the thread."""


class NewViewer(Feeder):
    """A viewer of our own, which runs until the user closes it.

    Parameters
    ----------
    path
        The file.
    options
        Options of the command `rerun`.
    """

    def __init__(self, path: Path, *options: str) -> None:
        self.process = Rerun(*options)
        super().__init__(path)

    def _run(self) -> None:
        self.fed = self._feed(self.process)

    def await_start(self, address: str) -> None:
        """Wait until the viewer answers at `address`; `InputError` if it ends instead."""
        deadline = monotonic() + STARTS_WITHIN
        while self.process.poll() is None and monotonic() < deadline:
            with suppress(OSError):
                ViewerClient.connect(address).get_state()  # it may listen and still fail to find a screen
                return
            sleep(TICK)
        if self.process.poll() is not None:
            must = "the Rerun viewer must start" + ("" if has_screen() else ", for which it needs a screen")
            raise InputError(f"{must}: use --save, --serve or --connect, got {self.process.ending()}")

    def wait(self) -> None:
        """Wait until the viewer is closed, or until Ctrl-C; warn if it has failed."""
        with suppress(KeyboardInterrupt):
            if self.process.wait() or not self.fed:
                warn(f"the viewer ended with {self.process.ending()}: it may not have received all data")
        self.stop()

    def stop(self) -> None:
        """End the viewer and the thread."""
        self.process.end()
        self.complete.set()
        self.thread.join()


class RunningViewer(Feeder):
    """The viewer at an address. If it ends and another one starts there, that one is sent everything.

    The command `rerun`, given the port of a viewer, passes all data on to that viewer. It does not notice the end of
    one and the start of another, and where it finds none it becomes a viewer itself, in the place of the user's. So
    it is ended as soon as a connection to the viewer breaks that is kept open for this.

    Parameters
    ----------
    path
        The file.
    address
        The address, rerun+http://HOST:PORT/proxy.
    seen
        Whether a viewer has been seen there.

    Raises
    ------
    InputError
        If the address is not of that form.
    """

    def __init__(self, path: Path, address: str, seen: bool) -> None:
        self.address, self.seen = address, seen
        self.place = host_and_port(address)
        self.process: Rerun | None = None  # passes the data on
        self.stopped = False  # whether no further process may be started
        self.lock = Lock()  # on these two
        super().__init__(path)

    def _run(self) -> None:
        last = False
        while not (self.fed or last):
            last = self.complete.is_set()  # checked before the last attempt, so that no data are missed
            with suppress(OSError), connection(self.place) as line:
                self.fed = self._pass_on(line)
            if not self.fed:
                self.complete.wait(RETRY)

    def _pass_on(self, line: socket.socket) -> bool:
        """Send the file to the viewer at the other end of `line`; whether it has received everything."""
        host, port = line.getpeername()[:2]
        with self.lock:
            if self.stopped:
                return False
            self.seen = True
            process = self.process = Rerun("--bind", host, "--port", str(port), "--headless")
        watcher = Thread(target=end_with, args=(line, process), daemon=True)
        watcher.start()
        try:
            return self._feed(process) and process.wait() == 0
        finally:
            process.end()
            with suppress(OSError):  # the viewer may have closed it
                line.shutdown(socket.SHUT_RDWR)
            watcher.join()

    def wait(self) -> None:
        """Warn if the viewer has not received everything."""
        if self.thread.is_alive():
            warn("the viewer hangs: it may not have received all data")
        elif not self.fed and self.seen:
            warn(f"the viewer at {self.address} has ended: it may not have received all data")
        self.stop()

    def stop(self) -> None:
        """End the process and the thread."""
        with self.lock:
            self.stopped = True
            if self.process is not None:
                self.process.end()
        self.complete.set()
        self.thread.join()


def end_with(line: socket.socket, process: Rerun) -> None:
    """End a process when a connection ends."""
    with suppress(OSError):
        while line.recv(BLOCK):
            pass
    process.end()


def connection(place: tuple[str, int]) -> socket.socket:
    """A connection to a host and port; `OSError` if nothing listens there."""
    line = socket.create_connection(place, timeout=5.0)
    line.settimeout(None)
    return line


def host_and_port(address: str) -> tuple[str, int]:
    """Host and port in the address of a viewer; `InputError` if it is not one."""
    expected = f"the viewer must listen at rerun+http://HOST:PORT/proxy, got {address!r}"
    try:
        url = urlsplit(address)
        place = url.hostname or "", url.port or PORT
    except ValueError as error:
        raise InputError(f"{expected}: {error}") from error
    if (url.scheme, url.path) != ("rerun+http", "/proxy") or not url.hostname:
        raise InputError(expected)
    return place


def check_that_one_listens(address: str) -> None:
    """Raise `ConnectionError` if there is no viewer at an address, `InputError` if it is not one."""
    try:
        connection(host_and_port(address)).close()
    except OSError as error:
        raise ConnectionError(
            f"the viewer must listen at rerun+http://HOST:PORT/proxy, got {address!r}: {error}"
        ) from error


def has_screen() -> bool:
    """Whether the environment names a screen; only on Linux need it do so."""
    return sys.platform != "linux" or any(os.environ.get(name) for name in SCREENS)

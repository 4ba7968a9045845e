"""Processes for Python that begin with what is slow to import: a process that has imported it forks them.

Each is a process of its own all the same, with its own arguments, environment, folder, output and exit status.
"""

import atexit
import gc
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import cache
from importlib import import_module
from io import TextIOWrapper
from pathlib import Path
from runpy import run_path
from select import select
from typing import Any

TIME = 300  # s that a process may take

# what commands are slow to import
OF_COMMANDS = ("boreprop_fmu.cli", "boreprop_viz.view", "fmpy.simulation", "scipy.optimize", "scipy.spatial")


class Forked:
    """A process that has been forked: what `subprocess.Popen` would give, with pipes, in a session of its own."""

    def __init__(self, server: socket.socket, **asked: object) -> None:
        (stdin, given), (printed, stdout), (said, stderr), (self._told, telling) = (os.pipe() for _ in range(4))
        theirs = [stdin, stdout, stderr, telling]
        socket.send_fds(server, [json.dumps(asked).encode()], theirs)
        for file in theirs:
            os.close(file)
        self.stdin, self.stdout, self.stderr = os.fdopen(given, "wb"), os.fdopen(printed, "rb"), os.fdopen(said, "rb")
        self.pid = self._hear()
        self.returncode: int | None = None

    def _hear(self) -> int:
        told = os.read(self._told, 4)
        assert told, "the process that forks has ended"
        return int.from_bytes(told, "big", signed=True)

    def poll(self) -> int | None:
        """The exit status, if it has ended."""
        ended = self.returncode is None and select([self._told], [], [], 0)[0]
        return self.wait() if ended else self.returncode

    def wait(self) -> int:
        """The exit status, once it has ended."""
        if self.returncode is None:
            self.returncode = self._hear()
            os.close(self._told)
        return self.returncode

    def send_signal(self, number: int) -> None:
        """Send a signal, if it has not ended."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def kill(self) -> None:
        """End it."""
        self.send_signal(signal.SIGKILL)

    def communicate(self, given: bytes = b"") -> tuple[bytes, bytes]:
        """Give it this on stdin; what it has printed and said when it has ended."""
        with ThreadPoolExecutor(2) as readers, self.stdout, self.stderr:
            texts = [readers.submit(file.read) for file in (self.stdout, self.stderr)]
            with suppress(BrokenPipeError), self.stdin:
                self.stdin.write(given)
            printed, said = (text.result() for text in texts)
        self.wait()
        return printed, said


Process = Forked | subprocess.Popen[bytes]


def start(
    words: Sequence[str | Path],
    imported: tuple[str, ...] = OF_COMMANDS,
    cwd: Path | None = None,
    env: Mapping[str, str] = os.environ,
) -> Process:
    """Start a script, or code after ``-c``, with arguments; these modules may be imported already. Ctrl-C ends it."""
    given = [str(word) for word in words]
    if sys.platform != "linux":  # where a fork may be unsafe, or there is none
        pipe = subprocess.PIPE
        command = [sys.executable, *given]
        return subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, cwd=cwd, env=env, start_new_session=True)
    return Forked(_server(imported), words=given, cwd=str(cwd or Path.cwd()), environment=dict(env))


def run_script(
    words: Sequence[str | Path],
    imported: tuple[str, ...] = OF_COMMANDS,
    cwd: Path | None = None,
    env: Mapping[str, str] = os.environ,
) -> subprocess.CompletedProcess[str]:
    """`start` a process, and wait until it has ended."""
    process = start(words, imported, cwd, env)
    texts = (text.decode().replace(os.linesep, "\n") for text in process.communicate())
    return subprocess.CompletedProcess(list(words), process.wait(), *texts)


@cache
def _server(imported: tuple[str, ...]) -> socket.socket:
    """The way to the process that has imported these modules."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with theirs:
        command = [sys.executable, __file__, str(theirs.fileno()), *imported]
        pipe, files = subprocess.PIPE, [theirs.fileno()]  # what it forks has pipes, too, in their place
        server = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, pass_fds=files)
    atexit.register(server.communicate)
    atexit.register(ours.close)  # which comes first, and ends it
    return ours


def requests(link: socket.socket) -> dict[str, Any] | None:
    """For each request fork a guard; give what is asked for in the process that the guard forks."""
    gc.freeze()  # or each process would look for garbage in all that has been imported
    signal.signal(signal.SIGCHLD, wait_for_guards)
    while True:
        text, files, _, _ = socket.recv_fds(link, 2**20, 4)
        if not text:
            return None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of Python's that numpy has threads
            guard = os.fork()
        if not guard:
            link.close()
            *standard, telling = files
            guarded(standard, telling)
            asked: dict[str, Any] = json.loads(text)
            return asked | {"standard": standard}
        for file in files:
            os.close(file)


def wait_for_guards(*_: object) -> None:
    """Of guards that have ended; so their time counts as that of the suite."""
    with suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass


def guarded(standard: list[int], telling: int) -> None:
    """Fork and go on in the new process; the old one tells its number and, when it has ended, its exit status."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    if child := os.fork():
        for file in (0, 1, 2, *standard):
            os.close(file)
        os.write(telling, child.to_bytes(4, "big"))
        _, status = os.waitpid(child, 0)
        os.write(telling, os.waitstatus_to_exitcode(status).to_bytes(4, "big", signed=True))
        os._exit(0)
    os.close(telling)


def begin(words: list[str], cwd: str, environment: Mapping[str, str], standard: list[int]) -> None:
    """Be a process that runs a script or code."""
    signal.alarm(TIME)
    os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.chdir(cwd)
    os.environ.clear()
    os.environ.update(environment)
    tempfile.tempdir = None
    for number, file in enumerate(standard):
        os.dup2(file, number)
        os.close(file)
    if encoding := environment.get("PYTHONIOENCODING"):
        assert isinstance(sys.stdout, TextIOWrapper)
        sys.stdout.reconfigure(encoding=encoding)
    if words[0] == "-c":
        sys.path[0], sys.argv[:] = "", ["-c", *words[2:]]
        exec(words[1], {"__name__": "__main__"})
    else:
        sys.path[0], sys.argv[:] = str(Path(words[0]).parent), words
        run_path(words[0], run_name="__main__")


if __name__ == "__main__":
    for name in sys.argv[2:]:
        import_module(name)
    if asked := requests(socket.socket(fileno=int(sys.argv[1]))):
        begin(**asked)

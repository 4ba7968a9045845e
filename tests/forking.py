"""Processes for Python scripts that begin with what is slow to import: a process that has imported it forks them.

Each is a process of its own all the same, with its own arguments, environment, folder, output and exit status.
"""

import atexit
import gc
import json
import os
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import import_module
from pathlib import Path
from runpy import run_path
from signal import alarm
from typing import Any

TIME = 300  # s that a script may take


def run_script(
    words: Sequence[str | Path], imported: tuple[str, ...], cwd: Path | None = None
) -> subprocess.CompletedProcess[str]:
    """Run a script, the first of the words, with the others as its arguments; these modules may be imported already."""
    given = [str(word) for word in words]
    if sys.platform != "linux":  # where a fork may be unsafe, or there is none
        command = [sys.executable, *given]
        return subprocess.run(command, cwd=cwd, capture_output=True, text=True, encoding="utf-8", timeout=TIME)
    with tempfile.TemporaryDirectory() as folder:
        printed, said = Path(folder, "stdout"), Path(folder, "stderr")
        server = _server(imported)
        assert server.stdin
        assert server.stdout
        request = {"words": given, "cwd": str(cwd or Path.cwd()), "environment": dict(os.environ)}
        server.stdin.write(json.dumps(request | {"printed": str(printed), "said": str(said)}) + "\n")
        server.stdin.flush()
        status = int(server.stdout.readline())
        texts = (path.read_text(encoding="utf-8") for path in (printed, said))
        return subprocess.CompletedProcess(given, status, *texts)


@cache
def _server(imported: tuple[str, ...]) -> "subprocess.Popen[str]":
    """The process that has imported these modules."""
    command = [sys.executable, __file__, *imported]
    server = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    atexit.register(server.communicate)
    return server


def requests() -> dict[str, Any] | None:
    """Fork for every line of stdin, and give what it asks for, in the new process; its status goes to stdout."""
    gc.freeze()  # or each process would look for garbage in all that has been imported
    lines, statuses = os.fdopen(os.dup(0)), os.dup(1)
    for line in lines:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of Python's that numpy has threads
            child = os.fork()
        if not child:
            os.close(statuses)
            asked: dict[str, Any] = json.loads(line)
            return asked
        _, status = os.waitpid(child, 0)
        os.write(statuses, f"{os.waitstatus_to_exitcode(status)}\n".encode())
    return None


def begin(words: list[str], cwd: str, environment: Mapping[str, str], printed: str, said: str) -> None:
    """Be a process that runs a script."""
    alarm(TIME)
    os.chdir(cwd)
    os.environ.clear()
    os.environ.update(environment)
    tempfile.tempdir = None
    for number, path in enumerate((os.devnull, printed, said)):
        file = os.open(path, os.O_RDWR | os.O_CREAT)
        os.dup2(file, number)
        os.close(file)
    sys.argv[:] = words
    sys.path[0] = str(Path(words[0]).parent)
    run_path(words[0], run_name="__main__")


if __name__ == "__main__":
    for name in sys.argv[1:]:
        import_module(name)
    if asked := requests():
        begin(**asked)

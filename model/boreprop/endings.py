"""Lets signals that ask a process to end do what Ctrl-C does, so that nothing half-written is left behind."""

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

from .leftovers import remove_leftovers

ENDINGS = ("SIGINT", "SIGTERM", "SIGHUP")  # signals that ask for the end: Ctrl-C, another process, a closed terminal
UNTOUCHED = (signal.SIG_DFL, signal.default_int_handler)  # what they do unless somebody has another wish, as nohup has


@contextmanager
def endings_like_interrupt() -> Iterator[None]:
    """Let the first signal that asks for the end raise KeyboardInterrupt, which removes drafts; ignore all others.

    Where C code that has called Python puts an error of its own in the place of that, it is raised from that error.
    At the end drafts and temporary folders are removed, and a process that was asked by another signal than Ctrl-C ends
    by that signal, so that its exit status says why.
    """
    received: list[int] = []

    def interrupt(number: int, _: FrameType | None) -> None:
        if not received:  # another one, of somebody who cannot wait, must not disturb the end
            received.append(number)
            raise KeyboardInterrupt

    handlers = {
        getattr(signal, name): signal.getsignal(getattr(signal, name)) for name in ENDINGS if hasattr(signal, name)
    }
    ours = {number: handler for number, handler in handlers.items() if handler in UNTOUCHED}
    for number in ours:
        signal.signal(number, interrupt)
    try:
        yield
    except Exception as error:
        if received:
            raise KeyboardInterrupt from error
        raise
    finally:
        for number, handler in ours.items():
            signal.signal(number, signal.SIG_IGN if received else handler)
        remove_leftovers()
        if received and received[0] != signal.SIGINT:
            with suppress(OSError):  # the terminal may be gone
                sys.stdout.flush()
            signal.signal(received[0], signal.SIG_DFL)
            os.kill(os.getpid(), received[0])

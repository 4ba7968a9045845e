"""Lets signals that ask a process to end do what Ctrl-C does, so that nothing half-written is left behind."""

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

ENDINGS = ("SIGTERM", "SIGHUP")  # signals that ask a process to end: by another one, by a terminal that is closed


@contextmanager
def endings_like_interrupt() -> Iterator[None]:
    """Let a signal that asks for the end raise KeyboardInterrupt, which removes drafts, and then end the process."""
    received: list[int] = []

    def interrupt(number: int, _: FrameType | None) -> None:
        if not received:  # another one must not disturb the end
            received.append(number)
            raise KeyboardInterrupt

    numbers = [getattr(signal, name) for name in ENDINGS if hasattr(signal, name)]
    ours = [number for number in numbers if signal.getsignal(number) is signal.SIG_DFL]  # nohup ignores one of them
    for number in ours:
        signal.signal(number, interrupt)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)
        if received:
            with suppress(OSError):  # the terminal may be gone
                sys.stdout.flush()
            os.kill(os.getpid(), received[0])  # so that the exit status says why

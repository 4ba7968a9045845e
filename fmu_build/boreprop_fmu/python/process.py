"""What pythonfmu's library does to the process that it runs in, and how the slave mends it.

Python alone cannot mend the rest: where ctypes is missing it stays as it is.
"""

import signal
import sys
from contextlib import suppress

try:
    import ctypes
except ImportError:  # an interpreter that was built without it
    ctypes = None  # type: ignore[assignment]

GIVEN_BACK = "boreprop_gave_ctrl_c_back"  # once a process: a host may have a handler of its own later


def give_ctrl_c_back() -> None:
    """Let Ctrl-C end a host that is not Python again.

    The interpreter that pythonfmu starts takes SIGINT over, if nobody else has: so it was left to the system before.
    """
    embedded = not sys.orig_argv  # nobody started it from a command line
    taken = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if ctypes and embedded and taken and not hasattr(signal, GIVEN_BACK):
        set_handler = ctypes.pythonapi.PyOS_setsig  # signal.signal() works in the thread that started Python only
        set_handler.argtypes, set_handler.restype = (ctypes.c_int, ctypes.c_void_p), ctypes.c_void_p
        set_handler(signal.SIGINT, int(signal.SIG_DFL))
        setattr(signal, GIVEN_BACK, True)


def forget(folder: str) -> None:
    """Take a folder off the path of modules, on which pythonfmu puts it again for each instance."""
    if folder in sys.path:
        sys.path.remove(folder)


def keep_alive(namespace: dict[str, object]) -> bool:
    """Add a reference to the namespace of a module, since pythonfmu drops one too many for each instance.

    Returns
    -------
    Whether it could be done.
    """
    if ctypes is None:
        return False
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(namespace))
    return True


def open_log(switch: int | None) -> None:
    """Let messages through to the host's logger, whatever its loggingOn says.

    Parameters
    ----------
    switch
        The address at which pythonfmu's logger remembers loggingOn; None: unknown, so that loggingOn decides.
    """
    if ctypes and switch is not None:
        ctypes.c_bool.from_address(switch).value = True


def write_to_user(line: str) -> None:
    """Write a line to stderr, if there is one."""
    if sys.stderr is not None:  # a program without a console has none
        with suppress(OSError, ValueError):  # it is closed
            print(line, file=sys.stderr, flush=True)

"""Ports of this machine at which viewers listen."""

import os
import socket

from boreprop.errors import InputError

LOOPBACK = "127.0.0.1"  # only this machine; by default Rerun listens on all its networks
LAST = 65535
TRIES = 100


def free_port() -> int:
    """A port of this machine that is free."""
    return bound(0)


def port_pair(first: int | None) -> tuple[int, int]:
    """Two free ports next to each other: `first` and the one after it, or any; `InputError` if they are in use."""
    if first is not None:
        check_free(first, first + 1)
        return first, first + 1
    for _ in range(TRIES):
        port = free_port()
        try:
            return port, bound(port + 1)
        except (OSError, OverflowError):
            continue
    raise InputError(f"--port: must be the first of two free ports, got none in {TRIES} tries")


def check_free(*ports: int) -> None:
    """Raise `InputError` if one of the ports cannot be used."""
    for port in ports:
        if not 1 <= port <= LAST:
            raise InputError(f"--port: must be 1 to {LAST}, got {port}")
        try:
            bound(port)
        except OSError as error:
            expected = f"--port: port{'s' * (len(ports) > 1)} {' and '.join(map(str, ports))} must be free"
            raise InputError(f"{expected}, got {port}: {error.strerror}") from error


def bound(port: int) -> int:
    """Bind a port for a moment and return its number, which is another one for 0; `OSError` if it cannot be bound."""
    with socket.socket() as probe:
        if os.name == "posix":  # a port whose last connections are just closing counts as free, as it does for Rerun
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        probe.bind((LOOPBACK, port))
        number: int = probe.getsockname()[1]
    return number

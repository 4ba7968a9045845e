"""Lets a study compute on a Dask cluster."""

import logging
from collections.abc import Generator
from concurrent.futures import Executor
from contextlib import contextmanager

from ...errors import InputError

PATIENCE = 10.0  # s that a scheduler may take to answer: one that is running answers within a second


@contextmanager
def on_cluster(address: str | None) -> Generator[Executor | None]:
    """Yield an executor on the workers of the Dask scheduler at an address, tcp://HOST:PORT; None for no address.

    Raises
    ------
    InputError
        If Dask is not installed, or no scheduler answers.
    """
    if address is None:
        yield None
        return
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError("--dask: distributed must be installed for this: pip install distributed") from error
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # errors come as exceptions, too
    try:
        client = Client(address, timeout=PATIENCE)  # type: ignore[no-untyped-call]
    except (OSError, TypeError, ValueError) as error:
        raise InputError(f"--dask: must be the address of a running Dask scheduler, got {address!r}") from error
    with client:
        yield client.get_executor()  # type: ignore[no-untyped-call]

"""A Dask cluster as the place where a study computes."""

import logging
from collections.abc import Generator
from concurrent.futures import Executor
from contextlib import contextmanager

from ...errors import InputError

PATIENCE = 10.0  # s that a scheduler may take to answer: those of a cluster that is there answer at once


@contextmanager
def on_cluster(address: str | None) -> Generator[Executor | None]:
    """The workers of the Dask scheduler at an address, tcp://HOST:PORT; None: no cluster, the cores of this machine.

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
        raise InputError("--dask: needs Dask: pip install distributed") from error
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what matters comes as an exception
    try:
        client = Client(address, timeout=PATIENCE)  # type: ignore[no-untyped-call]
    except (OSError, TypeError, ValueError) as error:
        raise InputError(f"--dask: must be the address of a running Dask scheduler, got {address!r}") from error
    with client:
        yield client.get_executor()  # type: ignore[no-untyped-call]

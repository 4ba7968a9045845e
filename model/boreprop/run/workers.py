"""One function on many items, on all cores or on a cluster, though workers may die."""

import os
import pickle
import signal
from collections import deque
from collections.abc import Callable, Generator, Mapping
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from functools import partial
from itertools import count
from math import ceil
from multiprocessing import get_context, parent_process
from queue import Empty, SimpleQueue
from threading import Thread
from time import perf_counter
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")

CHUNK = 0.25  # s: quick items go to a worker together, as many as take about this long
TICK = 0.25  # s between two looks up from waiting
AHEAD = 2  # chunks submitted for each process of ours
SUBMITTED = 1000  # chunks submitted to an executor of whose size nothing is known
LIVES = 2  # workers that an item may cost, alone


class WorkerLost(Exception):
    """What became of a worker that an item did not leave alive."""


def work(
    function: Callable[[T], R],
    items: Mapping[int, T],
    executor: Executor | None = None,
    workers: int | None = None,
) -> Generator[list[tuple[int, R | WorkerLost]]]:
    """Apply `function` to every item and yield what is done, as it comes.

    Items that were with a worker when it died are tried again one by one: so it shows which of them killed it. Closing
    the generator cancels what has not begun.

    Parameters
    ----------
    function
        Of one item. Picklable, as the items and what it returns.
    items
        By key.
    executor
        Where to work; it is left open. None: on processes of this machine, started again when one dies.
    workers
        Number of those processes; None: one for each core.

    Yields
    ------
    list of (key, result)
        `WorkerLost` for an item that cost `LIVES` workers. Empty if nothing was done for a moment.

    Raises
    ------
    Exception
        What the function raises.
    BrokenExecutor
        If workers die and there has not been one result, or if the given executor is broken.
    """
    if executor is None:
        pickle.dumps(function)  # what cannot travel is an error here; our pool might wait for it for ever
    workers = _cores() if workers is None else workers
    slots = SUBMITTED if executor else AHEAD * workers
    pool = _Pool(executor, workers)
    serial = count()
    waiting, suspects, deaths = deque(items), deque[int](), dict.fromkeys(items, 0)
    running: dict[Future[tuple[list[R], float]], list[int]] = {}
    done: SimpleQueue[Future[tuple[list[R], float]]] = SimpleQueue()
    chunk, alone, fruitless = 1, False, True

    def submit(keys: list[int]) -> None:
        future = pool.submit(partial(_apply, function, [items[key] for key in keys], next(serial)))
        running[future] = keys
        future.add_done_callback(done.put)

    try:
        while waiting or suspects or running:
            if not running:
                alone = bool(suspects)
                if alone:
                    submit([suspects.popleft()])
            while waiting and not suspects and not alone and len(running) < slots:
                submit([waiting.popleft() for _ in range(min(chunk, ceil(len(waiting) / slots)))])
            try:
                future = done.get(timeout=TICK)
            except Empty:
                yield []
                continue
            keys = running.pop(future)
            try:
                results, seconds = future.result()
            except Exception as error:
                if not _lost(error):
                    raise
                if alone:
                    deaths[keys[0]] += 1
                if deaths[keys[0]] < LIVES:
                    suspects.extend(keys)
                elif fruitless:
                    raise
                else:
                    yield [(keys[0], WorkerLost(str(error)))]
            else:
                fruitless = False
                chunk = max(1, int(CHUNK * len(keys) / max(seconds, 1e-6)))
                yield list(zip(keys, results, strict=True))
    finally:
        for future in running:
            future.cancel()
        pool.close()


class _Pool:
    """An executor that was given, or else processes of this machine, and new ones when those have broken down."""

    def __init__(self, given: Executor | None, workers: int) -> None:
        self.given, self.workers = given, workers
        self.executor = given or _processes(workers)

    def submit(self, call: Callable[[], R]) -> Future[R]:
        try:
            return self.executor.submit(call)
        except BrokenExecutor:
            if self.given:
                raise
            self.executor.shutdown()
            self.executor = _processes(self.workers)
            return self.executor.submit(call)

    def close(self) -> None:
        if not self.given:
            self.executor.shutdown(cancel_futures=True)


def _cores() -> int:
    """How many cores this process may use; no more than Windows can wait for."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return min(os.cpu_count() or 1, 61)


def _processes(workers: int) -> ProcessPoolExecutor:
    """Processes that start in the same way on every system."""
    return ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=_prepare)


def _prepare() -> None:
    """In a process of ours: Ctrl-C ends it without a word, and so does the end of the process that started it."""
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:  # as in the background
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def _apply(function: Callable[[T], R], items: list[T], _serial: int) -> tuple[list[R], float]:
    """In the worker: the results and the seconds they took. Dask takes equal calls for one, so they are numbered."""
    begin = perf_counter()
    return [function(item) for item in items], perf_counter() - begin


def _lost(error: Exception) -> bool:
    """Whether an error tells of the worker rather than of the function."""
    dask = type(error).__module__.partition(".")[0] == "distributed"  # KilledWorker and others that have no common base
    return dask or isinstance(error, BrokenExecutor | CancelledError)

"""Applies one function to many items on all cores or on a cluster, and survives workers that die."""

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
from typing import Generic, TypeVar

from ..errors import BorepropError, InputError

T = TypeVar("T")
R = TypeVar("R")

CHUNK = 0.25  # s of work sent to a worker at once: more would delay progress, less would be spent on sending
TICK = 0.25  # s of waiting for a result after which control returns to the caller, who may save or report progress
AHEAD = 2  # chunks submitted for each of our processes: one at work and one waiting, so that none stands idle
SUBMITTED = 1000  # chunks submitted to an executor of the caller's, whose number of workers is not known
CLOCK = 1e-6  # s, for a chunk that took no measurable time
LIVES = 2  # an item is given up once this many workers have died while working on it alone
THREADS = {"OMP_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"}
"""Variables that set how many threads numpy computes on: in a worker one, since each core has a worker."""


class WorkerLost(BorepropError):
    """An item whose worker died every time it was tried. The message is that of the last death."""


def work(
    function: Callable[[T], R],
    items: Mapping[int, T],
    executor: Executor | None = None,
    workers: int | None = None,
) -> Generator[list[tuple[int, R | WorkerLost]]]:
    """Apply `function` to every item and yield the results as they come.

    Items that were with a worker when it died are tried again one by one, which shows which of them killed it. Closing
    the generator cancels all items that have not been started.

    Parameters
    ----------
    function
        Takes one item. The function, the items and the results must be picklable.
    items
        Key → item.
    executor
        Where to compute; the caller closes it. None: on processes of this machine, started again when one dies.
    workers
        Number of processes on this machine; None: one for each core.

    Yields
    ------
    list of (key, result)
        The results since the last time. The result is a `WorkerLost` for an item that `LIVES` workers died of. The list
        is empty if there was none for a moment.

    Raises
    ------
    InputError
        If there are to be no workers.
    Exception
        Any that the function raises.
    BrokenExecutor
        If workers die before there is a single result, or if the given executor is broken.
    """
    if executor is None:
        pickle.dumps(function)  # raises here if it cannot be pickled, where our pool might wait for ever
    workers = _cores() if workers is None else workers
    if workers < 1:
        raise InputError(f"workers: must be >= 1, got {workers!r}")
    pool = _Pool(executor, workers)
    tasks = _Work(function, items, pool, SUBMITTED if executor else AHEAD * workers)
    try:
        while tasks.unfinished:
            tasks.send()
            try:
                future = tasks.done.get(timeout=TICK)
            except Empty:
                yield []
                continue
            if results := tasks.take(future):
                yield results
    finally:
        for future in tasks.running:
            future.cancel()
        pool.close()


class _Work(Generic[T, R]):
    """Items on their way through a pool: waiting, running, or suspected of having killed a worker."""

    def __init__(self, function: Callable[[T], R], items: Mapping[int, T], pool: "_Pool", slots: int) -> None:
        self.function, self.items, self.pool, self.slots = function, items, pool, slots
        self.waiting, self.suspects, self.deaths = deque(items), deque[int](), dict.fromkeys(items, 0)
        self.running: dict[Future[tuple[list[R], float]], list[int]] = {}
        self.done: SimpleQueue[Future[tuple[list[R], float]]] = SimpleQueue()
        self.serial = count()
        self.chunk = 1  # items that are sent at once
        self.alone = False  # whether a suspect runs, and nothing beside it
        self.fruitless = True  # until there is a first result

    @property
    def unfinished(self) -> bool:
        """Whether there are items without a result."""
        return bool(self.waiting or self.suspects or self.running)

    def send(self) -> None:
        """Send a suspect, alone, once nothing else runs; where there are none, as many chunks as there are slots."""
        if not self.running:
            self.alone = bool(self.suspects)
            if self.alone:
                self._submit([self.suspects.popleft()])
        while self.waiting and not self.suspects and not self.alone and len(self.running) < self.slots:
            size = min(self.chunk, ceil(len(self.waiting) / self.slots))
            self._submit([self.waiting.popleft() for _ in range(size)])

    def _submit(self, keys: list[int]) -> None:
        items = [self.items[key] for key in keys]
        future = self.pool.submit(partial(_apply, self.function, items, next(self.serial)))
        self.running[future] = keys
        future.add_done_callback(self.done.put)

    def take(self, future: Future[tuple[list[R], float]]) -> list[tuple[int, R | WorkerLost]]:
        """The results of a chunk that is done; if its worker has died, its items are suspects."""
        keys = self.running.pop(future)
        try:
            results, seconds = future.result()
        except Exception as error:
            if not _lost(error):
                raise
            return self._suspect(keys, error)
        self.fruitless = False
        self.chunk = max(1, int(CHUNK * len(keys) / max(seconds, CLOCK)))
        return list(zip(keys, results, strict=True))

    def _suspect(self, keys: list[int], error: Exception) -> list[tuple[int, R | WorkerLost]]:
        """Have items whose worker has died tried again, alone; give up one that was alone and has no lives left."""
        if self.alone:
            self.deaths[keys[0]] += 1
        if self.deaths[keys[0]] < LIVES:
            self.suspects.extend(keys)
            return []
        if self.fruitless:
            raise error
        return [(keys[0], WorkerLost(str(error)))]


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
    """The number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return min(os.cpu_count() or 1, 61)  # on Windows no more processes can be waited for


def _processes(workers: int) -> ProcessPoolExecutor:
    """A pool of processes, spawned rather than forked, so that they start in the same way on every system."""
    pool = ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=_prepare)
    free = THREADS - os.environ.keys()  # what a user has set stays
    os.environ.update(dict.fromkeys(free, "1"))
    try:
        pool.submit(int)  # with the first call all processes start, in the environment of now
    finally:
        for name in free:
            del os.environ[name]
    return pool


def _prepare() -> None:
    """Set up a worker process: it ends silently on Ctrl-C, and when the process that started it ends."""
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:  # a process in the background ignores Ctrl-C
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def _apply(function: Callable[[T], R], items: list[T], _serial: int) -> tuple[list[R], float]:
    """Called in the worker: returns the results and the seconds they took.

    Dask computes equal calls only once, so a serial number makes each call different.
    """
    begin = perf_counter()
    return [function(item) for item in items], perf_counter() - begin


def _lost(error: Exception) -> bool:
    """Whether an error means that the worker was lost, rather than that the function failed."""
    dask = type(error).__module__.partition(".")[0] == "distributed"  # Dask's errors have no base class in common
    return dask or isinstance(error, BrokenExecutor | CancelledError)

"""Workers of a study that are killed, hang, or are interrupted."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

import study_functions
from boreprop.analysis.study.compute import study
from boreprop.run.workers import work
from forking import start
from places import TESTS
from study_functions import calls, counted, numbered

parquet = pytest.importorskip("pyarrow.parquet")
posix = pytest.mark.skipif(os.name != "posix", reason="kills with signals")


def rows_in(path: Path) -> list[int]:
    """The cases in a study's file."""
    if not path.exists():
        return []
    cases: list[int] = parquet.read_table(BytesIO(path.read_bytes()))["case"].to_pylist()  # of one file, not of two
    return cases


def wait_for(condition: Callable[[], bool]) -> None:
    """Return when it holds; fails after a minute."""
    end = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


@posix
@pytest.mark.slow
def test_a_killed_study_resumes_where_it_stopped(tmp_path: Path) -> None:
    path = tmp_path / "study.parquet"
    killed = subprocess.Popen([sys.executable, study_functions.__file__, str(tmp_path)])
    wait_for(lambda: len(rows_in(path)) >= 6)
    processes = psutil.Process(killed.pid).children(recursive=True)
    killed.kill()
    killed.wait()
    assert not psutil.wait_procs(processes, timeout=60)[1]  # no worker outlives it
    done, called = rows_in(path), calls(tmp_path)
    assert 6 <= len(done) < 60
    assert len(called) - len(done) <= 8  # in flight: two chunks a worker, and what had come in since the last writing

    results = study(numbered(60), partial(counted, tmp_path, 0.1), output=path, workers=2)
    assert list(results["weight"]) == list(range(1, 61))
    later = calls(tmp_path)[len(called) :]
    assert sorted(later) == [case + 1 for case in range(60) if case not in done]


@posix
def test_a_study_ends_complete_though_a_worker_is_killed(tmp_path: Path) -> None:
    results = study(numbered(40), partial(study_functions.die_once, tmp_path), workers=2)
    assert (tmp_path / "died").exists()
    assert list(results["weight"]) == list(range(1, 41))
    assert (results["error"] == "").all()
    called = calls(tmp_path)
    assert len(called) <= 40 + 2 * 2 * 12  # twice at most what two workers had before them, chunks of a dozen


@posix
def test_a_case_that_kills_every_worker_is_the_only_one_to_fail() -> None:
    results = study(numbered(20), study_functions.die_at_5, workers=2)
    assert list(np.flatnonzero(results["error"] != "")) == [4]
    assert "terminated" in results["error"].item(4)
    assert list(results["weight"].dropna("active_weight_on_bit")) == [*range(1, 5), *range(6, 21)]


@posix
def test_workers_that_never_give_a_result_end_the_study() -> None:
    with pytest.raises(BrokenProcessPool):
        study(numbered(2), study_functions.die, workers=1)


@posix
@pytest.mark.slow
def test_a_study_on_a_dask_cluster_ends_complete_though_a_worker_is_killed(tmp_path: Path, paper_case: Path) -> None:
    pytest.importorskip("distributed")
    output, cases = tmp_path / "study.parquet", 300
    command = [sys.executable, *map(str, (TESTS / "study_on_dask.py", paper_case, output, cases))]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    before, killed = map(int, done.stdout.split()[-2:])
    assert before < cases
    assert not psutil.pid_exists(killed)
    table = parquet.read_table(output).to_pydict()
    assert table["case"] == list(range(cases))
    assert table["error"] == [None] * cases


@posix
def test_ctrl_c_keeps_what_is_done_and_leaves_no_process(tmp_path: Path, paper_case: Path) -> None:
    command = ["-c", "from boreprop.cli.app import main; main()", "study", str(paper_case), "--output", "study.parquet"]
    child = start([*command, "--vary", "eta_pi=0.005:0.02:500", "--workers", "2"], cwd=tmp_path)
    wait_for(lambda: len(rows_in(tmp_path / "study.parquet")) >= 2)
    processes = psutil.Process(child.pid).children(recursive=True)
    os.killpg(child.pid, signal.SIGINT)  # as a terminal does
    _, stderr = child.communicate()
    assert child.returncode == 130
    assert stderr.count(b"\n") == 1
    assert b"study.parquet: keeps" in stderr
    assert 2 <= len(rows_in(tmp_path / "study.parquet")) < 500
    assert not psutil.wait_procs(processes, timeout=60)[1]
    assert os.listdir(tmp_path) == ["study.parquet"]


class Counting(ThreadPoolExecutor):
    """Counts what is submitted."""

    submitted = 0

    def submit(self, *call: Any, **options: Any) -> Future[Any]:
        self.submitted += 1
        return super().submit(*call, **options)


def test_quick_items_go_together_and_slow_ones_alone() -> None:
    with Counting(1) as executor:
        quick = [pair for done in work(abs, dict.fromkeys(range(20_000), -1), executor) for pair in done]
        assert sorted(quick) == [(key, 1) for key in range(20_000)]
        assert executor.submitted < 5000
        executor.submitted = 0
        slow = [pair for done in work(time.sleep, dict.fromkeys(range(4), 0.3), executor) for pair in done]
        assert (len(slow), executor.submitted) == (4, 4)


def test_closing_cancels_what_has_not_begun() -> None:
    begun: list[float] = []

    def note(item: float) -> None:
        begun.append(item)
        time.sleep(0.05)

    with ThreadPoolExecutor(1) as executor:
        results = work(note, dict.fromkeys(range(200), 1.0), executor)
        next(results)
        results.close()
    assert len(begun) < 20


def test_a_worker_computes_on_one_thread_unless_told_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    monkeypatch.setenv("VECLIB_MAXIMUM_THREADS", "3")
    names = dict(enumerate(("OMP_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")))
    told = dict(result for results in work(os.getenv, names, workers=1) for result in results)
    assert told == {0: "1", 1: "3"}
    assert "OMP_NUM_THREADS" not in os.environ

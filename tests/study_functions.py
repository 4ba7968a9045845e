"""What the studies of the tests compute: at the top level of a module that a worker process is quick to import."""

import os
import signal
import sys
import time
from pathlib import Path

from boreprop.analysis.study.compute import study
from boreprop.analysis.study.design import Study, grid
from boreprop.case.case import Case
from boreprop.case.paper import paper_case


def numbered(n: int) -> Study:
    """Cases whose active weight on bit is 1, 2, … N."""
    return grid(paper_case(), {"active_weight_on_bit": range(1, n + 1)})


def weight(case: Case) -> dict[str, float]:
    """The active weight on bit and its square."""
    return {"weight": case.active_weight_on_bit, "square": case.active_weight_on_bit**2}


def counted(folder: Path, seconds: float, case: Case) -> dict[str, float]:
    """`weight`, in so many seconds; leaves a line in ``folder / "calls"``."""
    with open(folder / "calls", "a", encoding="utf-8") as file:
        file.write(f"{case.active_weight_on_bit:g}\n")
    time.sleep(seconds)
    return weight(case)


def calls(folder: Path) -> list[int]:
    """The weights that `counted` was called with."""
    path = folder / "calls"
    return [int(line) for line in path.read_text().split()] if path.exists() else []


def first_slow(case: Case) -> dict[str, float]:
    """`weight`, late if that is 1."""
    time.sleep(2.0 if case.active_weight_on_bit == 1.0 else 0.0)
    return weight(case)


def divided(case: Case) -> dict[str, float]:
    """Fails at a weight of 3."""
    return {"inverse": 1 / (case.active_weight_on_bit - 3.0)}


def buggy(case: Case) -> dict[str, float]:
    """Always wrong."""
    return {"wrong": case.active_weight_on_bit + "N"}  # type: ignore[operator]


def named_like_a_parameter(case: Case) -> dict[str, float]:
    """Wrongly named."""
    return {"active_weight_on_bit": 1.0}


def die_once(folder: Path, case: Case) -> dict[str, float]:
    """`weight`, but the first worker to get a weight of 5 is killed."""
    marker = folder / "died"
    if case.active_weight_on_bit == 5.0 and not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return counted(folder, 0.02, case)


def die_at_5(case: Case) -> dict[str, float]:
    """`weight`, but no worker survives a weight of 5."""
    if case.active_weight_on_bit == 5.0:
        os.kill(os.getpid(), signal.SIGKILL)
    return weight(case)


def die(case: Case) -> dict[str, float]:
    """Kills the worker."""
    os.kill(os.getpid(), signal.SIGKILL)
    return {}


if __name__ == "__main__":  # a study in a process of its own, to be killed
    from functools import partial

    import study_functions  # not __main__: so the function is the same one as in the tests

    where = Path(sys.argv[1])
    study(numbered(60), partial(study_functions.counted, where, 0.1), output=where / "study.parquet", workers=2)

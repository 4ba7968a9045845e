"""More scenarios for FMUs in a process of their own; see fmu_host.py.

python fmu_trust_host.py SCENARIO ARGUMENT … → JSON on stdout
"""

import importlib
import json
import shutil
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from copy import copy
from math import inf, nan
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from types import ModuleType

import psutil
from fmpy.fmi2 import FMU2Slave

from fmu_host import Instance, attempt, instance, modules, outputs

Row = dict[str, float]


@contextmanager
def instances(*fmus: str) -> Iterator[list[Instance]]:
    """One instance of each FMU, all alive; each in a directory of its own."""
    with TemporaryDirectory() as directory:
        made = [Instance(fmu, f"{directory}/{k}") for k, fmu in enumerate(fmus)]
        yield made
        for one in made[1::2] + made[::2]:
            one.free()


def weave(made: list[Instance]) -> list[list[Row]]:
    """Rows of each instance under a changing force, their steps interleaved."""
    for one in made:
        one.initialize(rss_force=500.0)
    rows: list[list[Row]] = [[] for _ in made]
    for k in range(6):
        for one, its_rows in zip(made, rows, strict=True):
            one.set(rss_force=500.0 * (-1) ** k * k)
            its_rows += one.steps(1, 0.7)
    return rows


# own code only


def together(*fmus: str) -> object:
    """Rows of one instance of each FMU."""
    with instances(*fmus) as made:
        return weave(made)


def invaded(packages: str, *fmus: str) -> object:
    """The same where another boreprop and another pythonfmu are already there; whether these were left alone."""
    sys.path.insert(0, packages)
    before = {name: importlib.import_module(f"boreprop.core.{name}") for name in ("beam", "drilling", "quantities")}
    assert all(str(module.__file__).startswith(packages) for module in before.values())
    for name in ("pythonfmu", "pythonfmu.fmi2slave", "pythonfmu.enums"):
        sys.modules[name] = ModuleType(name)
    with instances(*fmus) as made:
        rows = weave(made)
    return {"rows": rows, "undisturbed": all(sys.modules[f"boreprop.core.{n}"] is m for n, m in before.items())}


@contextmanager
def siblings(fmu: str, count: int) -> Iterator[list[Instance]]:
    """Many instances in one directory, as one host has them."""
    with instance(fmu) as first:
        made = [first]
        for k in range(1, count):
            one = copy(first)
            one.slave = FMU2Slave(
                guid=one.description.guid,
                modelIdentifier=one.description.coSimulation.modelIdentifier,
                unzipDirectory=one.directory,
                instanceName=f"number {k}",
            )
            one.slave.instantiate(loggingOn=False)
            made.append(one)
        yield made
        for one in made[1:]:
            one.slave.fmi2FreeInstance(one.slave.component)


def crowd(fmu: str, count: str) -> object:
    """Rows of many instances, and where their code came from."""
    with siblings(fmu, int(count)) as made:
        return {"rows": weave(made), "modules": modules(made[0])}


def threads(fmu: str, count: str) -> object:
    """Rows of many instances that run one after the other, and then of all at once, each in its own thread."""

    def live(numbered: tuple[int, Instance]) -> list[Row]:
        number, one = numbered
        one.slave.reset()
        one.initialize(rss_force=500.0 * number, flexural_stiffness=7e6 + 1e5 * number)
        rows = []
        for k in range(20):
            one.set(rss_force=500.0 * (-1) ** k * (number + 1))
            rows += one.steps(1, 60.0)  # long enough for the threads to meet in it
            one.set_state(one.state())
            one.set(rate_of_penetration=nan)
            assert one.step(0.5) == "discard"
            one.set(rate_of_penetration=1.0)
        return rows

    with siblings(fmu, int(count)) as made, ThreadPoolExecutor(len(made)) as pool:
        alone = [live(numbered) for numbered in enumerate(made)]
        return [alone, list(pool.map(live, enumerate(made)))]


def reborn(fmu: str, count: str) -> object:
    """Whether every one of many instances, one after the other, gives the same row; growth of memory, bytes."""
    with instance(fmu) as one:
        same, first = True, one.initialize().steps(1, 0.7)
        for k in range(int(count)):
            one.slave.fmi2FreeInstance(one.slave.component)
            one.slave.instantiate(loggingOn=False)
            same &= one.initialize().steps(1, 0.7) == first
            if k == 50:
                before = memory()
        return [same, memory() - before]


def homeless(fmu: str) -> object:
    """Statuses and last row where the folder that the FMU was unpacked in is gone once it is initialized."""
    with instance(fmu) as one:
        one.initialize()
        shutil.rmtree(one.directory)
        one.set(rss_force=nan)
        statuses = [one.step(0.7)]
        one.set(rss_force=0.0)
        content = one.state()
        one.steps(5, 0.7)
        one.set_state(content)
        one.time = 0.0
        row = one.steps(5, 0.7)[-1]
        Path(one.directory).mkdir()
        return [statuses, row == one.row(), row["drilled_length"]]


# states


def travel(one: Instance) -> list[Row]:
    """Run on under inputs that change at every step."""
    rows = []
    for k in range(15):
        one.set(rss_force=(-1) ** k * 2e3, active_weight_on_bit=6e4 + 500.0 * k, rate_of_penetration=0.5 + k % 3)
        rows += one.steps(1, 0.37)
    return rows


def far(fmu: str, path: str) -> object:
    """After 1000 m: run on, go back, run on, go back to the serialized form, run on. The state goes to `path`."""
    with instance(fmu) as one:
        one.initialize(rss_force=1e3)
        one.steps(1, 980.0)
        for k in range(20):
            one.set(rss_force=(-1) ** k * 500.0 * k)
            one.steps(1, 1.0)
        kept, content = one.slave.getFMUstate(), one.state()
        Path(path).write_bytes(content)
        runs = [travel(one)]
        for restore in (lambda: one.slave.setFMUstate(kept), lambda: one.set_state(content)):
            restore()
            one.time = 1000.0
            assert one.state() == content
            runs.append(travel(one))
        one.slave.freeFMUstate(kept)
        return runs


def far_again(fmu: str, path: str) -> object:
    """The same run from the serialized state, in another process; elsewhere and under other inputs before."""
    with instance(fmu) as one:
        one.initialize(rss_force=-7e3)
        one.steps(3, 1.1)
        one.set_state(Path(path).read_bytes())
        one.time = 1000.0
        return travel(one)


def spoilt_states(fmu: str, *others: str) -> object:
    """What becomes of bad states: statuses, the log, outputs, steps, and steps after a good state or a reset."""
    random = Random(3)
    with instances(fmu, *others) as (one, *foreigners):
        foreign = [other.initialize().state() for other in foreigners]
        one.initialize(rss_force=1e3).steps(3, 1.7)
        good, time, row = one.state(), one.time, one.row()
        bad = {f"foreign {k}": content for k, content in enumerate(foreign)}
        bad |= {"text": good.replace(b"0", b"1"), "no text": b"\xff\x00"}
        bad |= {f"cut at {k}": good[:k] for k in range(0, len(good), 211)}
        for _ in range(100):
            at, bit = random.randrange(len(good)), random.randrange(8)
            flipped = bytearray(good)
            flipped[at] ^= 1 << bit
            bad[f"bit {bit} of byte {at}"] = bytes(flipped)
        reports = []
        for k, (name, content) in enumerate(bad.items()):
            one.log.clear()
            refused = attempt(one.set_state, content)
            lines = [line for _, _, line in one.log]
            levels = {(status, category) for status, category, _ in one.log}
            becomes = outputs(one, row)
            steps = [one.step(0.5) for _ in range(3)]
            if k % 2:
                one.slave.reset()
                one.initialize(rss_force=1e3)
                recovered = one.steps(3, 1.7)[-1] == row
            else:
                one.set_state(good)
                one.time = time
                recovered = one.row() == row and one.step(0.5) == "ok"
            reports.append([name, refused, lines, sorted(levels), becomes, steps, recovered])
            one.set_state(good)
            one.time = time
        return reports


def faulty_state(fmu: str) -> object:
    """Steps after going back to a state that was taken while the instance was not to be trusted."""
    with instance(fmu) as one:
        one.initialize()
        good = one.state()
        one.set_state(b"no state")
        faulty = one.state()
        one.set_state(good)
        before = one.step(0.5)
        one.set_state(faulty)
        return [before, one.step(0.5)]


def systemless_state(fmu: str) -> object:
    """Steps from a good state, and after going back to one that was taken under bad parameters."""
    with instance(fmu) as one:
        one.initialize()
        good = one.state()
        one.slave.reset()
        one.set(flexural_stiffness=-1.0)
        attempt(one.initialize)
        systemless = one.state()
        one.set_state(good)
        before = one.step(0.5)
        one.set_state(systemless)
        return [before, one.step(0.5)]


# steps


def cuts(fmu: str, seed: str, rate: str) -> object:
    """Rows at the ends of legs under inputs held: legs in one step, then each leg cut at random, four times over."""
    random = Random(int(seed))
    legs = [(random.uniform(0.5, 15.0), random.uniform(-3e3, 3e3), random.uniform(1e3, 3e3)) for _ in range(5)]

    def run(one: Instance, pieces: Callable[[float], list[float]]) -> list[Row]:
        one.slave.reset()
        one.initialize(rate_of_penetration=float(rate))
        rows, end = [], 0.0
        for seconds, force, weight in legs:
            begin, end = end, end + seconds
            one.set(rss_force=force, active_weight_on_bit=weight)
            for stop in pieces(seconds):
                chance = random.random()
                if chance < 0.1:
                    one.row()
                elif chance < 0.2:
                    one.set_state(one.state())
                elif chance < 0.3:
                    one.set(rate_of_penetration=0.0)
                    assert one.step(0.25) == "ok"  # the clock runs, the bit stands
                    begin, end = begin + 0.25, end + 0.25
                    one.set(rate_of_penetration=float(rate))
                target = begin + stop
                assert one.step(target - one.time) == "ok", one.log
            rows.append(one.row())
        return rows

    def cut(seconds: float) -> list[float]:
        size = random.choice([3e-3, 0.1, 2.0]) * seconds
        count = min(int(seconds / size) + 1, 400)
        return [*sorted(random.uniform(0.0, seconds) for _ in range(count)), seconds]

    with instance(fmu) as one:
        return [run(one, lambda seconds: [seconds]), *(run(one, cut) for _ in range(4))]


def changed_inputs(fmu: str) -> object:
    """The row after a step with inputs set before it, and after the same once more with a detour in between."""
    with instance(fmu) as one:
        one.initialize()
        one.steps(2, 1.3)
        state, time = one.state(), one.time
        one.set(rss_force=2e3, active_weight_on_bit=2e3)
        direct = one.steps(1, 0.9)[-1]
        one.set_state(state)
        one.time = time
        one.set(rss_force=-9e3)
        one.row()
        one.set(rss_force=2e3, active_weight_on_bit=2e3)
        return [direct, one.steps(1, 0.9)[-1]]


# errors


def bad_values(fmu: str) -> object:
    """For each bad value: status, the log, outputs under it, whether anything moved, the status after a good value."""
    bad = [
        (name, value)
        for name in ("rss_force", "active_weight_on_bit", "rate_of_penetration")
        for value in (nan, inf, -inf)
    ]
    bad += [("active_weight_on_bit", -1.0), ("active_weight_on_bit", 0.0), ("rate_of_penetration", -1e-3)]
    reports = []
    with instance(fmu) as one:
        one.initialize(rss_force=1e3)
        one.steps(3, 0.9)
        for name, value in bad:
            before, state, good = one.row(), one.state(), one.get(name)
            one.log.clear()
            one.set_names({name: value})
            status = one.step(0.5)
            log, under = list(one.log), outputs(one, before)
            one.set_names({name: good})
            unmoved = one.row() == before and one.state() == state
            reports.append([name, value, status, log, under, unmoved, one.step(0.5)])
        for size in (0.0, -1.0, nan, inf):
            before, state = one.row(), one.state()
            one.log.clear()
            status = one.step(size)
            log, one.time = list(one.log), one.get("drilled_length")
            under, unmoved = outputs(one, before), one.state() == state
            reports.append(["step_size", size, status, log, under, unmoved, one.step(0.5)])
    return reports


def bad_parameters(fmu: str, bad: str) -> object:
    """For each bad parameter: statuses of the initialization and of two steps, the log of each, then after a reset."""
    reports = []
    with instance(fmu) as one:
        for name, value in json.loads(bad):
            one.set_names({name: value})
            statuses, logs = [], []
            for call in (one.initialize, lambda: one.slave.doStep(0.0, 0.5), lambda: one.slave.doStep(0.0, 0.5)):
                one.log.clear()
                statuses.append(attempt(call))
                logs.append(list(one.log))
            one.slave.reset()
            one.initialize()
            reports.append([name, value, statuses, logs, one.step(0.5)])
            one.slave.reset()
    return reports


def unforeseen(fmu: str) -> object:
    """Statuses after an exception that nobody foresaw: at once, with good input, after a good state, after a reset."""
    with instance(fmu) as one:
        one.initialize()
        good = one.state()
        report = []
        for _ in range(100):
            one.set(rss_force=13.0)
            report = [one.step(0.5), [line for _, _, line in one.log]]
            one.set(rss_force=0.0)
            report.append(one.step(0.5))
            one.set_state(good)
            one.time = 0.0
            report.append(one.step(0.5))
            one.set(rss_force=13.0)
            one.step(0.5)
            one.slave.reset()
            one.initialize()
            report.append(one.step(0.5))
            one.log.clear()
        return report


def endure(fmu: str, count: str) -> object:
    """Growth of memory, bytes, and the statuses, over many calls of each kind; the status of a good step at the end."""
    with instance(fmu) as one:
        one.initialize()
        good, bad = one.state(), one.state()[:-3]

        def wrong_value() -> str:
            one.set(rss_force=nan)
            status = one.step(0.5)
            one.set(rss_force=0.0)
            return status

        def wrong_step() -> str:
            return one.step(-1.0)

        def wrong_state() -> str:
            statuses = f"{attempt(one.set_state, bad)}, {one.step(0.5)}"
            one.set_state(good)
            one.time = 0.0
            return statuses

        def wrong_reference() -> str:
            statuses = f"{attempt(one.slave.getReal, [10_000])}, {one.step(0.5)}"
            one.set_state(good)
            one.time = 0.0
            return statuses

        def right_state() -> str:
            return attempt(one.set_state, one.state())

        growth, statuses = {}, {}
        for action in (wrong_value, wrong_step, wrong_state, wrong_reference, right_state):
            seen = set()
            for k in range(int(count) + 500):
                if k == 500:
                    before = memory()
                seen.add(action())
                one.log.clear()
            growth[action.__name__], statuses[action.__name__] = memory() - before, sorted(seen)
        one.time = 0.0
        return [growth, statuses, one.step(0.5)]


def memory() -> int:
    """What this process holds now, bytes."""
    return int(psutil.Process().memory_info().rss)


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]](*sys.argv[2:])))

"""A host for FMUs, run in a process of its own: fmpy only, the model nowhere but in the FMU.

python fmu_host.py SCENARIO ARGUMENT … → JSON on stdout
"""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from math import nan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE


class Instance:
    """An instance of an FMU whose variables go by name."""

    def __init__(self, fmu: str, directory: str) -> None:
        extract(fmu, directory)
        self.directory = directory
        self.description = read_model_description(fmu)
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.outputs = [v.name for v in self.description.modelVariables if v.causality == "output"]
        self.log: list[tuple[int, str, str]] = []
        callbacks = fmi2CallbackFunctions(
            logger=fmi2CallbackLoggerTYPE(
                lambda _, __, status, category, message: self.log.append((status, category.decode(), message.decode()))
            ),
            allocateMemory=defaultCallbacks.allocateMemory,
            freeMemory=defaultCallbacks.freeMemory,
        )
        self.slave = FMU2Slave(
            guid=self.description.guid,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            unzipDirectory=directory,
            instanceName=Path(fmu).stem,
        )
        self.slave.instantiate(callbacks=callbacks, loggingOn=True)

    def free(self) -> None:
        self.slave.fmi2FreeInstance(self.slave.component)
        self.slave.dll.finalizePythonInterpreter()  # at exit pythonfmu's library would drop its static state twice
        self.slave.freeLibrary()

    def initialize(self, time: float = 0.0, **values: object) -> "Instance":
        self.time = time
        self.slave.setupExperiment(startTime=time)
        self.set(**values)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        return self

    def set(self, **values: object) -> None:
        self.set_names(values)

    def set_names(self, values: dict[str, object]) -> None:
        for name, value in values.items():
            put = {"Real": self.slave.setReal, "String": self.slave.setString}[self.variables[name].type]
            put([self.variables[name].valueReference], [value])

    def get(self, name: str) -> Any:
        get = {"Real": self.slave.getReal, "Integer": self.slave.getInteger, "String": self.slave.getString}
        return get[self.variables[name].type]([self.variables[name].valueReference])[0]

    def row(self) -> dict[str, float]:
        return {name: self.get(name) for name in self.outputs}

    def step(self, size: float) -> str:
        """ "ok", or the status that the step ended with."""
        try:
            self.slave.doStep(self.time, size)
        except FMICallException as error:
            return {2: "discard", 3: "error", 4: "fatal"}[error.status]
        self.time += size
        return "ok"

    def steps(self, count: int, size: float) -> list[dict[str, float]]:
        rows = []
        for _ in range(count):
            assert self.step(size) == "ok", self.log
            rows.append(self.row())
        return rows

    def state(self) -> bytes:
        state = self.slave.getFMUstate()
        content = self.slave.serializeFMUstate(state)
        self.slave.freeFMUstate(state)
        return bytes(content)

    def set_state(self, content: bytes) -> None:
        state = self.slave.deSerializeFMUstate(content)
        self.slave.setFMUstate(state)
        self.slave.freeFMUstate(state)


@contextmanager
def instance(fmu: str) -> Iterator[Instance]:
    with TemporaryDirectory() as directory:
        one = Instance(fmu, directory)
        yield one
        one.free()


def own_modules(one: Instance) -> bool:
    """Whether all of the model that this process has loaded came from the FMU."""
    loaded = {name: module for name, module in sys.modules.items() if name.startswith("boreprop")}
    return bool(loaded) and all(str(module.__file__).startswith(one.directory) for module in loaded.values())


# scenarios


def follow(fmu: str, schedule: str, step: str, count: str, time: str, rate: str) -> object:
    """Rows at the communication points; `schedule` is {point number: force}."""
    forces = {int(k): force for k, force in json.loads(schedule).items()}
    with instance(fmu) as one:
        one.initialize(float(time), rss_force=forces.pop(0), rate_of_penetration=float(rate))
        rows = [one.row()]
        for k in range(int(count)):
            if k in forces:
                one.set(rss_force=forces[k])
                rows[-1] = one.row()
            assert one.step(float(step)) == "ok", one.log
            rows.append(one.row())
        return {"rows": rows, "own modules": own_modules(one)}


def respond(fmu: str) -> object:
    """Which outputs follow a change of each input at once, anywhere along a run."""
    changes = {"rss_force": 3e3, "active_weight_on_bit": 3e3, "rate_of_penetration": 1.0}
    moved: dict[str, set[str]] = {name: set() for name in changes}
    with instance(fmu) as one:
        one.initialize(active_weight_on_bit=1e5)
        for _ in range(8):
            for name, change in changes.items():
                before, old = one.row(), one.get(name)
                one.set_names({name: old + change})
                moved[name] |= {output for output, value in one.row().items() if value != before[output]}
                one.set_names({name: old})
            one.steps(1, 1.37)
    return {name: sorted(outputs) for name, outputs in moved.items()}


def tick(fmu: str, count: str, step: str, rate: str) -> object:
    """Drilled length after many small steps."""
    with instance(fmu) as one:
        one.initialize(rate_of_penetration=float(rate))
        for k in range(int(count)):
            one.slave.doStep(k * float(step), float(step))
        return one.get("drilled_length")


def standstill(fmu: str) -> object:
    """Rows before and after steps at rate zero."""
    with instance(fmu) as one:
        one.initialize()
        before = one.steps(3, 1.3)[-1]
        one.set(rate_of_penetration=0.0)
        return [before, *one.steps(3, 10.0)]


def rollback(fmu: str, path: str) -> object:
    """Run on from a state three times: at once, after going back to it, after going back to its serialized form."""
    with instance(fmu) as one:
        one.initialize(rss_force=1e3)
        one.steps(11, 0.77)
        kept, content, time = one.slave.getFMUstate(), one.state(), one.time
        Path(path).write_bytes(content)
        one.set(rss_force=-3e3)
        runs = [one.steps(20, 0.31)]
        for restore in (lambda: one.slave.setFMUstate(kept), lambda: one.set_state(content)):
            restore()
            one.time = time
            one.set(rss_force=-3e3)
            runs.append(one.steps(20, 0.31))
        one.slave.freeFMUstate(kept)
        return runs


def resume(fmu: str, path: str) -> object:
    """The same run, from the serialized state in another process."""
    with instance(fmu) as one:
        one.initialize()
        one.set_state(Path(path).read_bytes())
        for _ in range(11):  # not sum(): since Python 3.12 that compensates for rounding
            one.time += 0.77
        one.set(rss_force=-3e3)
        return one.steps(20, 0.31)


def bad_inputs(fmu: str) -> object:
    """For each bad input: status, whether an output moved, the log, the status after a good value."""
    bad = {
        "rss_force": [nan, float("inf")],
        "active_weight_on_bit": [nan, -1.0],
        "rate_of_penetration": [nan, -1.0],
    }
    reports = []
    with instance(fmu) as one:
        one.initialize()
        one.steps(3, 0.9)
        for name, values in bad.items():
            for value in values:
                before, good = one.row(), one.get(name)
                one.set_names({name: value})
                status = one.step(0.5)
                moved = one.row() != before
                one.set_names({name: good})
                reports.append([name, status, moved, one.log[-1], one.step(0.5)])
                one.log.clear()
        for size in (0.0, -1.0):
            before = one.row()
            reports.append(["step_size", one.step(size), one.row() != before, one.log[-1], one.step(0.5)])
    return reports


def bad_parameter(fmu: str, name: str, value: str) -> object:
    """Status of a step and the log with a bad parameter; status of a step after a reset."""
    with instance(fmu) as one:
        text = one.variables[name].type == "String"
        one.set_names({name: value if text else float(value)})
        one.initialize()
        report = [one.step(0.5), one.log[-1]]
        one.slave.reset()
        one.initialize()
        return [*report, one.step(0.5)]


def bad_states(fmu: str, other: str) -> object:
    """Status of a step after a bad state, and then after a good one."""
    reports = []
    with instance(fmu) as one, instance(other) as foreigner:
        foreigner.initialize()
        one.initialize()
        good = one.state()
        for content in (foreigner.state(), good[:-20], good.replace(b"0", b"1"), b"", b"\xff\x00"):
            one.time = 0.0
            one.set_state(content)
            log = one.log[-1]
            first = one.step(0.5)
            one.set_state(good)
            reports.append([first, log, one.step(0.5)])
    return reports


def side_by_side(*fmus: str) -> object:
    """Each FMU's outputs, all of them alive in one process."""
    with TemporaryDirectory() as directory:
        instances = [Instance(fmu, f"{directory}/{k}") for k, fmu in enumerate(fmus)]
        for one in instances:
            one.initialize()
        rows = [one.steps(5, 0.7)[-1] for one in instances]
        for one in instances:
            one.free()
        return rows


def initial(fmu: str, values: str) -> object:
    """Outputs in initialization mode, and after it."""
    with instance(fmu) as one:
        one.slave.setupExperiment()
        one.slave.enterInitializationMode()
        one.row()
        one.set_names(json.loads(values))
        inside = one.row()
        one.slave.exitInitializationMode()
        return [inside, one.row()]


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]](*sys.argv[2:])))

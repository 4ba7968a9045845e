"""A host for FMUs, run in a process of its own: fmpy only, the model nowhere but in the FMU.

python fmu_host.py SCENARIO ARGUMENT … → JSON on stdout
"""

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import isnan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE


def attempt(call: Callable[..., object], *arguments: object) -> str:
    """ "ok", or the status that the call ended with."""
    try:
        call(*arguments)
    except FMICallException as error:
        return {2: "discard", 3: "error", 4: "fatal"}[error.status]
    return "ok"


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
        if hasattr(self.slave.dll, "finalizePythonInterpreter"):
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
            put = {"Real": self.slave.setReal, "Integer": self.slave.setInteger, "String": self.slave.setString}
            put[self.variables[name].type]([self.variables[name].valueReference], [value])

    def get(self, name: str) -> Any:
        get = {"Real": self.slave.getReal, "Integer": self.slave.getInteger, "String": self.slave.getString}
        return get[self.variables[name].type]([self.variables[name].valueReference])[0]

    def row(self) -> dict[str, float]:
        return {name: self.get(name) for name in self.outputs}

    def step(self, size: float) -> str:
        """ "ok", or the status that the step ended with."""
        status = attempt(self.slave.doStep, self.time, size)
        if status == "ok":
            self.time += size
        return status

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


def modules(one: Instance) -> str:
    """Whether what this process has loaded of the model is the FMU's "own", "foreign" (some of it), or "none"."""
    loaded = [str(module.__file__) for name, module in sys.modules.items() if name.startswith("boreprop")]
    own = all(path.startswith(one.directory) for path in loaded)
    return ("own" if own else "foreign") if loaded else "none"


def outputs(one: Instance, before: dict[str, float]) -> str:
    """Whether the outputs are "kept" as they were, "changed", or "unknown": no numbers, or an error status."""
    if attempt(one.row) == "error":
        return "unknown"
    reals = [name for name in before if one.variables[name].type == "Real"]
    row = one.row()
    return "kept" if row == before else "unknown" if all(isnan(row[name]) for name in reals) else "changed"


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
        return {"rows": rows, "modules": modules(one)}


def act(fmu: str, actions: str) -> object:
    """What actions give: ["set", values] and ["step", size] a status, ["row"] a row; ["save"] and ["back"] nothing."""
    answers: list[object] = []
    with instance(fmu) as one:
        one.initialize()
        saved, time = b"", 0.0
        for kind, *given in json.loads(actions):
            if kind == "set":
                answers.append(attempt(one.set_names, *given))
            elif kind == "step":
                answers.append(one.step(*given))
            elif kind == "row":
                answers.append(one.row())
            elif kind == "save":
                saved, time = one.state(), one.time
            else:
                one.set_state(saved)
                one.time = time
    return answers


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
        one.initialize(rss_force=1e3, rate_of_penetration=0.3)
        one.steps(5, 0.77)
        one.set(rate_of_penetration=0.37)
        one.steps(6, 0.77)
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


def too_far(fmu: str) -> object:
    """Status, log and outputs after steps of 100 km and a bit, of many more, without end, and of a usual length."""
    answers = []
    with instance(fmu) as one:
        one.initialize(rate_of_penetration=1e3)
        one.steps(1, 1e-3)
        before = one.row()
        for size in (100.1, 1e12, 1e306, 1e-3):
            one.log.clear()
            answers.append((one.step(size), [line for _, _, line in one.log], outputs(one, before)))
    return answers


def read_survey(fmu: str, path: str) -> object:
    """What is logged if this is to be the survey."""
    with instance(fmu) as one:
        attempt(lambda: one.initialize(survey_file=path))
        return [line for _, _, line in one.log]


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]](*sys.argv[2:])))

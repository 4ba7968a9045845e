"""The system on fmpy."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from system import BOREHOLE, System, parameters

from boreprop.errors import InputError


def steps(system: System, weights: list[float]) -> Iterator[list[float]]:
    """Step the system with fmpy; yield the recorded variables after each step."""
    with ExitStack() as stack:
        fmus = {one.name: stack.enter_context(opened(one, system.directory)) for one in system.elements}

        def exchange() -> None:
            values = [fmus[c.startElement].get(c.startConnector) for c in system.connections]
            for c, value in zip(system.connections, values, strict=True):
                fmus[c.endElement].set(c.endConnector, value)

        for fmu in fmus.values():
            fmu.slave.enterInitializationMode()
        for _ in fmus:
            exchange()
        for fmu in fmus.values():
            fmu.slave.exitInitializationMode()
        exchange()
        for k, weight in enumerate(weights):
            fmus[BOREHOLE].set("active_weight_on_bit", weight)
            for name, fmu in fmus.items():
                try:
                    fmu.slave.doStep(k * system.step, system.step)
                except FMICallException as error:
                    raise InputError(f"{system.ssp}: {name}: at {k * system.step:g} s: {error}") from error
            row = [fmus[BOREHOLE].get(name) for name in system.recorded]
            exchange()
            yield row


class Fmu:
    """An FMU instance whose variables go by name."""

    def __init__(self, element: Any, directory: Path) -> None:
        path = directory / element.source
        description = fmpy.read_model_description(path)
        self.variables = {variable.name: variable for variable in description.modelVariables}
        self.slave = FMU2Slave(
            instanceName=element.name,
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=fmpy.extract(path, directory / element.name),
        )
        self.slave.instantiate(loggingOn=True)

    def get(self, name: str) -> float:
        """The value of a Real or Integer variable."""
        variable = self.variables[name]
        get = self.slave.getInteger if variable.type == "Integer" else self.slave.getReal
        return float(get([variable.valueReference])[0])

    def set(self, name: str, value: float) -> None:
        """Give a Real variable a value."""
        self.slave.setReal([self.variables[name].valueReference], [value])


@contextmanager
def opened(element: Any, directory: Path) -> Iterator[Fmu]:
    """A component of the system as an FMU instance, with its parameters set."""
    fmu = Fmu(element, directory)
    fmu.slave.setupExperiment(startTime=0.0)
    for parameter in parameters(element):
        fmu.set(parameter.name, float(parameter.value))
    try:
        yield fmu
    finally:
        fmu.slave.fmi2FreeInstance(fmu.slave.component)
        if hasattr(fmu.slave.dll, "finalizePythonInterpreter"):  # at exit pythonfmu would drop its static state twice
            fmu.slave.dll.finalizePythonInterpreter()
        fmu.slave.freeLibrary()

"""Run the closed loop: ``python run.py closed_loop.ssp --output closed_loop.csv``, on fmpy or on libcosim.

Both importers exchange values as Jacobi does: every FMU steps from the same communication point, with the outputs that
the others had there. Before the first step the initial outputs are passed on as often as there are FMUs.
"""

import zipfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from enum import StrEnum
from itertools import compress
from math import inf
from operator import not_
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any
from xml.etree import ElementTree

import fmpy
import numpy as np
import typer
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.ssp.ssd import read_ssd

from boreprop.cli import console
from boreprop.cli.lazy import new_app
from boreprop.cli.options import positive
from boreprop.core.quantities import INPUTS, OUTPUTS, scalar_names
from boreprop.errors import InputError
from boreprop.run.results import SUFFIXES, write_trajectory
from boreprop.run.trajectory import Trajectory
from boreprop_fmu.packed_case import read_packed_case

BOREHOLE = "borehole"  # the component that is disturbed and recorded
WEIGHT = "active_weight_on_bit"
EXPERIMENT = "{http://ssp-standard.org/SSP1/SystemStructureDescription}DefaultExperiment"
FIXED_STEP = "{http://opensimulationplatform.com/SSP/OSPAnnotations}FixedStepAlgorithm"
NANOSECONDS = 1_000_000_000  # libcosim's times are integers

app = new_app("The closed loop of controller and borehole.")


class Importer(StrEnum):
    """What runs the FMUs."""

    fmpy = "fmpy"
    libcosim = "libcosim"


@app.command()
def run(
    ssp: Annotated[Path, typer.Argument(metavar="SYSTEM.ssp", help="What make_ssp.py made.")],
    output: Annotated[Path, typer.Option(metavar="RUN.csv", help="The result file, .csv or .parquet.")],
    importer: Annotated[Importer, typer.Option(help="What runs the FMUs.")] = Importer.fmpy,
    half_weight_at: Annotated[
        float | None,
        typer.Option(parser=positive, metavar="M", help="Drilled length where the weight on bit drops by half."),
    ] = None,
) -> None:
    """Run the system over its default experiment; a row after each communication step."""
    console.check_output(output, SUFFIXES)
    with TemporaryDirectory() as directory:
        system = System(ssp, Path(directory))
        times = system.step * np.arange(system.count)  # at 1 m/s they are metres too
        weights = np.where(times < (half_weight_at or inf), 1.0, 0.5) * system.case.active_weight_on_bit
        steps = {Importer.fmpy: step_fmpy, Importer.libcosim: step_libcosim}[importer]
        with console.progress("drilling", system.count) as done:
            rows = []
            for row in steps(system, weights.tolist()):
                rows.append(row)
                done(len(rows))
    columns = dict(zip(system.recorded, np.array(rows).T, strict=True))
    write_trajectory(Trajectory({"time": times + system.step, **columns}, system.case), output)
    print(f"{output}: {len(rows)} rows over {columns['drilled_length'][-1]:g} m")


class System:
    """An SSP, unpacked into a directory.

    Attributes
    ----------
    ssp, directory
        Paths.
    elements, connections
        The components and what connects them.
    step, count
        Communication step, s, and how many there are.
    case
        The case packed in the borehole FMU.
    recorded
        The borehole's inputs and outputs, by scalar name.

    Raises
    ------
    InputError
        If it is not like the one that make_ssp.py makes.
    """

    def __init__(self, ssp: Path, directory: Path) -> None:
        self.ssp, self.directory = ssp, directory
        try:
            with zipfile.ZipFile(ssp) as archive:
                archive.extractall(directory)
            structure = read_ssd(ssp).system
            experiment = ElementTree.parse(directory / "SystemStructure.ssd").getroot().find(EXPERIMENT)
            self.step = float(experiment.find(f".//{FIXED_STEP}").get("baseStepSize"))
            self.count = round(float(experiment.get("stopTime")) / self.step)
            self.elements, self.connections = structure.elements, structure.connections
            [borehole] = [element for element in self.elements if element.name == BOREHOLE]
        except OSError:
            raise
        except Exception as error:  # fmpy raises what its parsers raise
            raise InputError(f"{ssp}: must be an SSP made by make_ssp.py, got: {error}") from error
        self.case = read_packed_case(directory / borehole.source)
        self.recorded = scalar_names(INPUTS + OUTPUTS, len(self.case.bha.stabilizer_positions))


def step_fmpy(system: System, weights: list[float]) -> Iterator[list[float]]:
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
            fmus[BOREHOLE].set(WEIGHT, weight)
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
    for binding in element.parameterBindings:
        for parameter in binding.parameterValues[0].parameters:
            fmu.set(parameter.name, float(parameter.value))
    try:
        yield fmu
    finally:
        fmu.slave.fmi2FreeInstance(fmu.slave.component)
        if hasattr(fmu.slave.dll, "finalizePythonInterpreter"):
            fmu.slave.dll.finalizePythonInterpreter()  # at exit pythonfmu's library would drop its static state twice
        fmu.slave.freeLibrary()


def step_libcosim(system: System, weights: list[float]) -> Iterator[list[float]]:
    """Step the system with libcosim; yield the recorded variables after each step."""
    from libcosimpy.CosimEnums import CosimVariableType
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.WARNING)
    execution = CosimExecution.from_ssp_file(str(system.directory), round(system.step * NANOSECONDS))
    override, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(override)
    execution.add_observer(observer)
    borehole = execution.slave_index_from_instance_name(BOREHOLE)
    variables = {variable.name.decode(): variable for variable in execution.slave_variables(borehole)}
    integer = [variables[name].type == CosimVariableType.INTEGER.value for name in system.recorded]
    references = [variables[name].reference for name in system.recorded]
    integers = list(compress(references, integer))
    reals = list(compress(references, map(not_, integer)))
    for k, weight in enumerate(weights):
        override.slave_real_values(borehole, [variables[WEIGHT].reference], [weight])
        if not execution.step():
            raise InputError(f"{system.ssp}: at {k * system.step:g} s: libcosim could not step")
        values = {
            True: iter(observer.last_integer_values(borehole, integers)),
            False: iter(observer.last_real_values(borehole, reals)),
        }
        yield [float(next(values[is_integer])) for is_integer in integer]


if __name__ == "__main__":
    console.execute(app)

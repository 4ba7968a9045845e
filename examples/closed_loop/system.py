"""What is in an SSP that make_ssp.py made: components, connections, communication step, the borehole's case."""

import zipfile
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from fmpy.ssp.ssd import read_ssd

from boreprop.case.packed import read_packed_case
from boreprop.case.parameters import with_parameters
from boreprop.core.quantities import INPUTS, OUTPUTS, scalar_names
from boreprop.errors import InputError

BOREHOLE = "borehole"  # the component that is disturbed and recorded
PARAMETER_SET = "initial_values"  # of both components
EXPERIMENT = "{http://ssp-standard.org/SSP1/SystemStructureDescription}DefaultExperiment"
FIXED_STEP = "{http://opensimulationplatform.com/SSP/OSPAnnotations}FixedStepAlgorithm"


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
        The case packed in the borehole FMU, with the parameters that the SSP gives it.
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
        given = {p.name: float(p.value) for p in parameters(borehole)}
        self.case = with_parameters(read_packed_case(directory / borehole.source), given)
        self.recorded = scalar_names(INPUTS + OUTPUTS, self.case.bha.structure)


def parameters(element: Any) -> list[Any]:
    """The parameters that the SSP gives a component; each has a name and a value."""
    return [p for binding in element.parameterBindings for p in binding.parameterValues[0].parameters]

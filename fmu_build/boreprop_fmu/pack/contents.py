"""The contents that both flavours of FMU have: the description, the case, the icon and the documentation."""

from collections.abc import Sequence
from importlib.resources import files

from boreprop.case.case import Case
from boreprop.case.file import dump_case
from boreprop.case.packed import CASE_FILE
from boreprop.case.parameters import parameters
from boreprop.core.quantities import INPUTS, PARAMETERS

from .description import model_description
from .documentation import documents

CAPABILITIES = {
    "needsExecutionTool": False,
    "canHandleVariableCommunicationStepSize": True,
    "canBeInstantiatedOnlyOncePerProcess": False,
    "canNotUseMemoryManagementFunctions": True,
    "canGetAndSetFMUstate": True,
    "canSerializeFMUstate": True,
    "canInterpolateInputs": False,
}
NATIVE_CAPABILITIES = {
    "canInterpolateInputs": True,
    "maxOutputDerivativeOrder": 1,
    "providesDirectionalDerivative": True,
}
STEP_SIZE = 0.1  # s: 0.1 m at the start value of the rate of penetration, as `simulate` has it


def describe(
    case: Case, identifier: str, guid: str, *, native: bool = False, source_files: Sequence[str] = ()
) -> dict[str, bytes]:
    """The description for hosts, and the case file for `read_packed_case`.

    Parameters
    ----------
    case
        The case from which the FMU starts.
    identifier
        The FMU's modelIdentifier.
    guid
        The FMU's identity.
    native
        Whether the FMU is native, and so takes derivatives of inputs and gives those of outputs.
    source_files
        The files in the folder sources/ that are to be compiled.
    """
    description = model_description(
        identifier,
        guid,
        case.structure,
        start_values(case),
        stop_time=case.length,
        step_size=STEP_SIZE,
        capabilities=CAPABILITIES | (NATIVE_CAPABILITIES if native else {}),
        source_files=source_files,
    )
    return {"modelDescription.xml": description, CASE_FILE: dump_case(case).encode()}


def pack_manual(case: Case, identifier: str, runtime: str) -> dict[str, bytes]:
    """The icon (made by docs/make_icon.py) and the documentation."""
    icon = files("boreprop_fmu.pack").joinpath("icon.png").read_bytes()
    return {"model.png": icon, **documents(case, identifier, runtime, start_values(case))}


def start_values(case: Case) -> dict[str, float | str]:
    """Start value of every input and parameter, by scalar name."""
    own = {q.name: q.start for q in INPUTS + PARAMETERS if q.start is not None}
    return {**own, **parameters(case)}

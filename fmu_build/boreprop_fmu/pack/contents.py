"""What an FMU holds whichever flavour it is: its description, its case, its icon and its documentation."""

from collections.abc import Sequence
from importlib.resources import files

from boreprop.case.case import Case
from boreprop.case.file import dump_case
from boreprop.core.propagation import RELATIVE_TOLERANCE
from boreprop.core.quantities import BY_NAME

from ..packed_case import CASE_FILE
from .description import model_description
from .documentation import documentation

IDENTIFIER = "Borehole"
CAPABILITIES = {
    "needsExecutionTool": False,
    "canHandleVariableCommunicationStepSize": True,
    "canBeInstantiatedOnlyOncePerProcess": False,
    "canNotUseMemoryManagementFunctions": True,
    "canGetAndSetFMUstate": True,
    "canSerializeFMUstate": True,
}
STEP_SIZE = 0.1  # s, so 0.1 m at the start value of the rate of penetration


def describe(
    case: Case, guid: str, *, interpolates: bool = False, source_files: Sequence[str] = ()
) -> dict[str, bytes]:
    """The description for hosts, and the case file for `read_packed_case`.

    Parameters
    ----------
    case
        What the FMU starts from.
    guid
        The FMU's identity.
    interpolates
        Whether it takes derivatives of inputs.
    source_files
        What is to be compiled of the folder sources/.
    """
    description = model_description(
        IDENTIFIER,
        guid,
        len(case.bha.stabilizer_positions),
        start_values(case),
        stop_time=case.length,
        step_size=STEP_SIZE,
        capabilities={**CAPABILITIES, "canInterpolateInputs": interpolates},
        source_files=source_files,
    )
    return {"modelDescription.xml": description, CASE_FILE: dump_case(case).encode()}


def pack_manual(case: Case, runtime: str) -> dict[str, bytes]:
    """What people see: the icon (made by docs/make_icon.py) and the documentation."""
    icon = files("boreprop_fmu.pack").joinpath("icon.png").read_bytes()
    return {"model.png": icon, "documentation/index.html": documentation(case, runtime)}


def start_values(case: Case) -> dict[str, float | str]:
    """Start value of every input and parameter, by scalar name."""
    bha, bit = case.bha, case.bit
    n = len(bha.stabilizer_positions)
    return {
        "rss_force": case.schedule.rss_force[0],
        "active_weight_on_bit": case.active_weight_on_bit,
        "rate_of_penetration": 1.0,
        **dict(zip(BY_NAME["stabilizer_position"].names(n), bha.stabilizer_positions, strict=True)),
        **dict(zip(BY_NAME["stabilizer_clearance"].names(n), bha.stabilizer_clearances, strict=True)),
        "rss_position": bha.rss_position,
        "distributed_weight": bha.distributed_weight,
        "flexural_stiffness": bha.flexural_stiffness,
        "lateral_steering_resistance": bit.lateral_steering_resistance,
        "angular_steering_resistance": bit.angular_steering_resistance,
        "bit_tilt_limit": bit.tilt_limit,
        "relative_tolerance": RELATIVE_TOLERANCE,
        "survey_file": "",
    }

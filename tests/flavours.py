"""The two FMUs of a case, on pythonfmu's runtime and as machine code: where they may differ it stands here only."""

from dataclasses import dataclass
from pathlib import Path

import pytest

from boreprop.case.case import Case
from boreprop_fmu.pack.build import build_fmu


@dataclass(frozen=True, eq=False)
class Flavour:
    """What one of them answers.

    Parameters
    ----------
    runtime
        Its name, for `build_fmu`.
    error, discard
        Status and category of what it logs when a call ends so.
    wrong_call
        Status of a call that cannot be right: a reference that there is not, a state of another FMU.
    under_bad_input
        What has become of the outputs while they cannot be computed from an input, see `fmu_host.outputs`.
    without_system
        With parameters that make no drilling system: statuses of the end of the initialization and of a step.
    after_bad_state
        What a step then does, and what has become of the outputs.
    modules
        Whose modules of the model are in a process that runs it, see `fmu_host.modules`.
    leak
        What ten thousand bad calls, or five hundred instances, may leave, bytes.
    numbers
        Where it has the numbers of its case; what else it has of resources/ and sources/ is code.
    interpolates
        Whether it takes derivatives of inputs.
    any_folder
        Whether it runs from folders that are not named in ASCII.
    """

    runtime: str
    error: tuple[int, str]
    discard: tuple[int, str]
    wrong_call: str
    under_bad_input: str
    without_system: tuple[str, str]
    after_bad_state: tuple[str, str]
    modules: str
    leak: float
    numbers: str
    interpolates: bool
    any_folder: bool

    def __str__(self) -> str:
        return self.runtime


PYTHON = Flavour(
    runtime="python",
    error=(3, "logStatusError"),
    discard=(3, "logStatusError"),
    wrong_call="ok",  # pythonfmu would make fmi2Fatal of any other answer: the log says it, and the next step
    under_bad_input="kept",
    without_system=("ok", "discard"),
    after_bad_state=("discard", "unknown"),
    modules="own",
    leak=6e6,  # pythonfmu's library keeps each line logged, some 100 bytes, and 6 kB of each instance; a state is 5 kB
    numbers="resources/fmu.json",
    interpolates=False,
    any_folder=False,
)
NATIVE = Flavour(
    runtime="native",
    error=(3, "logStatusError"),
    discard=(2, "logStatusDiscard"),
    wrong_call="error",
    under_bad_input="unknown",
    without_system=("error", "error"),
    after_bad_state=("ok", "kept"),
    modules="none",
    leak=1e5,
    numbers="resources/case.txt",
    interpolates=True,
    any_folder=True,
)

both_flavours = pytest.mark.parametrize("flavour", [PYTHON, NATIVE], ids=str, indirect=True, scope="session")


def build_to_read(case: Case, output: Path, flavour: Flavour) -> Path:
    """An FMU that is not to run: a native one has no binaries."""
    return build_fmu(case, output, runtime=flavour.runtime, binaries=output.parent)

"""The two FMUs of a case, on pythonfmu's runtime and as machine code: where they may differ it stands here only."""

from dataclasses import dataclass
from pathlib import Path

import pytest

from boreprop.case.case import Case
from boreprop_fmu.pack.build import build_fmu

# status and category of what is logged when a call ends so
LOGGED = {"warning": (1, "logStatusWarning"), "discard": (2, "logStatusDiscard"), "error": (3, "logStatusError")}


@dataclass(frozen=True, eq=False)
class Flavour:
    """What one of them answers.

    Parameters
    ----------
    runtime
        Its name, for `build_fmu`.
    wrong_call
        Status of a call that cannot be right: a reference that there is not, a state of another FMU.
    wrong_step
        Status of a step that cannot be right: out of order, not from where the last one ended, beyond the stop time.
    after_bad_call
        Status of the step after a call that cannot be right.
    without_system
        With parameters that make no drilling system: statuses of the end of the initialization and of a step.
    after_bad_state
        What a step then does, and what has become of the outputs.
    modules
        Whose modules of the model are in a process that runs it, see `fmu_host.modules`.
    leak, leak_of_instances
        What ten thousand bad calls, and what five hundred instances may leave, bytes.
    numbers
        Where it has the numbers of its case; what else it has of resources/ and sources/ is code.
    interpolates
        Whether it takes derivatives of inputs.
    any_folder
        Whether it runs from folders that are not named in ASCII.
    """

    runtime: str
    wrong_call: str
    wrong_step: str
    after_bad_call: str
    without_system: tuple[str, str]
    after_bad_state: tuple[str, str]
    modules: str
    leak: float
    leak_of_instances: float
    numbers: str
    interpolates: bool
    any_folder: bool

    def __str__(self) -> str:
        return self.runtime


PYTHON = Flavour(
    runtime="python",
    wrong_call="ok",  # pythonfmu would make fmi2Fatal of any other answer: the log says it, and the next step
    wrong_step="discard",
    after_bad_call="discard",
    without_system=("ok", "discard"),
    after_bad_state=("discard", "unknown"),
    modules="own",
    leak=6e6,  # pythonfmu's library keeps each line logged, some 100 bytes; a state is 5 kB
    leak_of_instances=1.5e6,  # and 1 kB of each
    numbers="resources/fmu.json",
    interpolates=False,
    any_folder=False,
)
NATIVE = Flavour(
    runtime="native",
    wrong_call="error",
    wrong_step="error",
    after_bad_call="ok",
    without_system=("error", "error"),
    after_bad_state=("ok", "kept"),
    modules="none",
    leak=1e5,
    leak_of_instances=1e5,
    numbers="resources/case.txt",
    interpolates=True,
    any_folder=True,
)

both_flavours = pytest.mark.parametrize("flavour", [PYTHON, NATIVE], ids=str, indirect=True, scope="session")


def build_to_read(case: Case, output: Path, flavour: Flavour) -> Path:
    """An FMU that is not to run: a native one has no binaries."""
    return build_fmu(case, output, runtime=flavour.runtime, binaries=output.parent)

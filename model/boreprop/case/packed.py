"""The case file inside the FMUs of boreprop-fmu, which writes it when it packs a case."""

from pathlib import Path

from .archive import open_archive
from .case import Case
from .file import parse_case
from .inputs import InputSchedule, Schedule
from .tables import read_inputs

CASE_FILE = "resources/case.toml"


def read_packed_case(fmu: str | Path) -> Case | None:
    """Read the case that an FMU was made from.

    Parameters
    ----------
    fmu
        The FMU.

    Returns
    -------
    The case; None if the FMU holds none, since another tool made it.

    Raises
    ------
    InputError
        If the file is not an archive that `open_archive` opens, or its case breaks a constraint.
    """
    with open_archive(fmu) as archive:
        if CASE_FILE not in archive.namelist():
            return None
        text = archive.read(CASE_FILE).decode()
    return parse_case(text, Path(fmu, CASE_FILE))


def read_schedules_for(fmu: str | Path, path: str | Path) -> tuple[Schedule | None, InputSchedule | None]:
    """Read schedules for an FMU, see `read_inputs`. Measured depths count from the bit of the case packed in the FMU.

    Raises
    ------
    InputError
        As `read_inputs`, also for measured depths if no case is packed in the FMU; or as `read_packed_case`.
    """
    case = read_packed_case(fmu)
    return read_inputs(path, None if case is None else case.survey.measured_depth[-1])

"""The case file inside the FMUs of this package, which is written when a case is packed."""

import zipfile
from pathlib import Path

from boreprop.case.case import Case
from boreprop.case.file import parse_case
from boreprop.errors import InputError

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
        If the file is not a ZIP archive, or its case breaks a constraint.
    """
    try:
        with zipfile.ZipFile(fmu) as archive:
            if CASE_FILE not in archive.namelist():
                return None
            return parse_case(archive.read(CASE_FILE).decode(), Path(fmu, CASE_FILE))
    except zipfile.BadZipFile as error:
        raise InputError(f"{fmu}: must be an FMU, got: {error}") from error

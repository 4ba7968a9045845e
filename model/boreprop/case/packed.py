"""The case file inside the FMUs of boreprop-fmu, which writes it when it packs a case."""

import zipfile
from pathlib import Path

from ..errors import InputError
from .case import Case
from .file import parse_case

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

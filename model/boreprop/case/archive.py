"""Opens FMUs made by anybody: what could do harm is refused before anything is unpacked.

This makes an FMU safe to unpack and its description safe to parse. It does not make it safe to run: to run an FMU is to
run the code that is in it.
"""

import re
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from stat import S_ISDIR, S_ISREG
from typing import Any
from xml.parsers.expat import ExpatError, ParserCreate

from ..core.columns import regular
from ..errors import InputError, shown

DESCRIPTION = "modelDescription.xml"
MOST_FILES = 100_000
MOST_BYTES = 4 << 30  # unpacked, all files together
MOST_DESCRIPTION = 256 << 20  # bytes of the description, which is parsed in memory
MOST_GROWTH = 300  # times the packed size, of files larger than SMALL; binaries and tables of numbers stay below 30
SMALL = 1 << 20  # bytes
FAULTS = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError, OSError)
"""What reading a damaged or unusual archive raises."""


@contextmanager
def open_archive(fmu: str | Path) -> Iterator[zipfile.ZipFile]:
    """Open an FMU to read from it, or to unpack it.

    Parameters
    ----------
    fmu
        The FMU.

    Yields
    ------
    The archive. Its files stay in the folder into which they are unpacked, and are not absurdly many or large.

    Raises
    ------
    InputError
        If it is not a sound ZIP archive, has a file with an absolute path or with .. in its path, or twice the same, a
        link, files whose size is absurd, or a description with a document type, which could hold entities.
    """
    try:
        with zipfile.ZipFile(regular(fmu)) as archive:
            _check_files(fmu, archive.infolist())
            if DESCRIPTION in archive.namelist():
                _check_description(fmu, archive.read(DESCRIPTION))
            yield archive
    except InputError:
        raise
    except FAULTS as error:
        raise InputError(f"{fmu}: must be an FMU, got: {getattr(error, 'strerror', None) or error}") from error


def _check_files(fmu: str | Path, files: list[zipfile.ZipInfo]) -> None:
    """Raise `InputError` if files would be unpacked elsewhere, over one another, or to absurd sizes."""
    seen: set[str] = set()
    for file in files:
        name = file.orig_filename  # zipfile cuts it at a null character and, on Windows, takes \ for /
        parts = name.removesuffix("/").split("/")
        if re.search(r"[:\\\0]", name) or any(not part.strip(" .") for part in parts):  # also an empty first part
            raise InputError(f"{fmu}: must hold files under plain relative paths, got {shown(name)}")
        mode = file.external_attr >> 16
        if mode and S_ISREG(mode) + S_ISDIR(mode) == 0 and mode >> 12:
            raise InputError(f"{fmu}: must hold plain files, got a link or a device, {shown(name)}")
        if name in seen:
            raise InputError(f"{fmu}: must hold each file once, got {shown(name)} twice")
        seen.add(name)
        if file.file_size > max(SMALL, MOST_GROWTH * file.compress_size):
            raise InputError(
                f"{fmu}: must hold files packed at most {MOST_GROWTH}-fold, got {shown(name)}: "
                f"{file.file_size} bytes in {file.compress_size}"
            )
    if len(files) > MOST_FILES:
        raise InputError(f"{fmu}: must hold at most {MOST_FILES} files, got {len(files)}")
    size = sum(file.file_size for file in files)
    packed = sum(file.compress_size for file in files)
    if size > MOST_BYTES or packed > Path(fmu).stat().st_size:
        raise InputError(f"{fmu}: must unpack to at most {MOST_BYTES >> 30} GB, got {size} bytes in {packed}")
    description = sum(file.file_size for file in files if file.filename == DESCRIPTION)
    if description > MOST_DESCRIPTION:
        raise InputError(f"{fmu}: {DESCRIPTION}: must have at most {MOST_DESCRIPTION} bytes, got {description}")


def _check_description(fmu: str | Path, text: bytes) -> None:
    """Raise `InputError` if an XML text declares a document type, the only place where entities can be defined."""

    def refuse(*_: Any) -> None:
        raise InputError(f"{fmu}: {DESCRIPTION}: must be XML without a document type and its entities, got one")

    parser = ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(text, True)
    except ExpatError as error:
        raise InputError(f"{fmu}: {DESCRIPTION}: must be XML, got: {error}") from error

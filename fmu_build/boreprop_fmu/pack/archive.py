"""Writes the archive of an FMU, with the same bytes for the same files, and derives its guid from them."""

import zipfile
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from uuid import UUID, uuid5

from boreprop.replacing import replacing

GUID_NAMESPACE = UUID("6f0a3c1e-9d1b-5a55-8a0e-0d6c1f9f7b11")
EPOCH = (1980, 1, 1, 0, 0, 0)  # the date of every file: the date of packing would make each archive different


def write_archive(files: Mapping[str, bytes], output: Path) -> None:
    """Write an FMU completely or not at all. The description comes first, then the other files by name.

    Parameters
    ----------
    files
        Path in the FMU → content.
    output
        The file to write.

    Raises
    ------
    OSError
        If it cannot be written; it is unchanged then.
    """
    with replacing(output) as draft, zipfile.ZipFile(draft, "w") as fmu:
        for name in sorted(files, key=lambda name: (name != "modelDescription.xml", name)):
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            fmu.writestr(entry, files[name])


def identify(files: Mapping[str, bytes]) -> str:
    """The guid of an FMU, derived from all files that determine its behaviour."""
    return str(uuid5(GUID_NAMESPACE, digest(files)))


def digest(files: Mapping[str, bytes]) -> str:
    """The SHA-256 of names and contents, hexadecimal."""
    lines = (f"{sha256(content).hexdigest()} {name}\n" for name, content in sorted(files.items()))
    return sha256("".join(lines).encode()).hexdigest()

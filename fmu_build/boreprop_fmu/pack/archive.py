"""The archive that an FMU is: the same bytes for the same files, and an identity that follows from them."""

import zipfile
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from uuid import UUID, uuid5

from boreprop.replacing import replacing

GUID_NAMESPACE = UUID("6f0a3c1e-9d1b-5a55-8a0e-0d6c1f9f7b11")
EPOCH = (1980, 1, 1, 0, 0, 0)  # the date of every file: that of the build would make each build different


def write_archive(files: Mapping[str, bytes], output: Path) -> None:
    """Write an FMU whole or not at all; the description comes first, the other files in alphabetical order.

    Parameters
    ----------
    files
        Path in the FMU → content.
    output
        The file to write.

    Raises
    ------
    OSError
        If it cannot be written; nothing is left behind then.
    """
    with replacing(output) as draft, zipfile.ZipFile(draft, "w") as fmu:
        for name in sorted(files, key=lambda name: (name != "modelDescription.xml", name)):
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            fmu.writestr(entry, files[name])


def identify(files: Mapping[str, bytes]) -> str:
    """Give the guid of an FMU, from all the files that decide what it does."""
    return str(uuid5(GUID_NAMESPACE, digest(files)))


def digest(files: Mapping[str, bytes]) -> str:
    """SHA-256 over names and contents, hexadecimal."""
    lines = (f"{sha256(content).hexdigest()} {name}\n" for name, content in sorted(files.items()))
    return sha256("".join(lines).encode()).hexdigest()

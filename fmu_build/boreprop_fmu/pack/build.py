"""Packs a case as an FMI 2.0 co-simulation FMU, either as Python code on pythonfmu's runtime or as machine code."""

import re
from collections.abc import Sequence
from pathlib import Path

from boreprop.case.case import Case
from boreprop.core.system import check_in_plane
from boreprop.errors import InputError

from ..native.binaries import BINARIES
from .archive import write_archive
from .native import is_native_here, pack_native
from .python import pack_python

RUNTIMES = ("auto", "native", "python")
IDENTIFIER = "Borehole"


def build_fmu(
    case: Case,
    output: Path,
    *,
    runtime: str = "auto",
    name: str = IDENTIFIER,
    platforms: Sequence[str] | None = None,
    binaries: Path = BINARIES,
) -> Path:
    """Write the FMU of a case. The same case, code and binaries give the same bytes. Nothing is compiled.

    Parameters
    ----------
    case
        The case from which the FMU starts.
    output
        The file to write.
    runtime
        "native" packs machine code, for the platforms for which there are binaries, and its C sources; "python" packs
        Python code, for hosts that have a Python; "auto" is native if there is a binary for this machine, else Python.
    name
        The FMU's modelIdentifier: the name of its binaries, and the beginning of the names of its C functions.
    platforms
        Of a native FMU: for which of `boreprop_fmu.native.binaries.PLATFORMS` it has binaries. None: for all for which
        there is one; empty: the sources only.
    binaries
        The folder of the binaries for a native FMU, see `boreprop_fmu.native.binaries`.

    Returns
    -------
    output

    Raises
    ------
    InputError
        If there is no such runtime, the name is not one of C, a binary is missing for a platform that is named, or was
        compiled from other sources.
    ParameterError
        If the bit walks.
    OSError
        If the file cannot be written; it is unchanged then.
    """
    if runtime not in RUNTIMES:
        raise InputError(f"runtime: must be {', '.join(RUNTIMES[:-1])} or {RUNTIMES[-1]}, got {runtime!r}")
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{0,99}", name):
        raise InputError(f"name: must be a letter, then letters, digits and _, at most 100, got {name!r}")
    if runtime == "python" and platforms is not None:
        raise InputError(f"platforms: must be left out for the runtime python, got {', '.join(platforms) or 'none'}")
    if runtime == "python" and not case.bha.structure.is_of_the_paper:
        raise InputError(f"runtime: must be native for a BHA with {case.bha.structure.beyond_the_paper}, got 'python'")
    check_in_plane(case.bit)
    if runtime == "native" or (runtime == "auto" and (platforms is not None or is_native_here(binaries))):
        write_archive(pack_native(case, name, binaries, platforms), output)
    else:
        write_archive(pack_python(case, name), output)
    return output

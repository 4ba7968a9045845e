"""Packs a case as an FMI 2.0 co-simulation FMU, either as Python code on pythonfmu's runtime or as machine code."""

import re
from collections.abc import Sequence
from pathlib import Path

from boreprop.case.case import Case
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
        If there is no such runtime, a case in space is to run in Python, the name is not one of C, a binary is missing
        for a platform that is named, or was compiled from other sources.
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
        beyond = case.bha.structure.beyond_the_paper
        raise InputError(f"runtime: must be native for a BHA with {beyond}, got 'python': use --runtime native")
    native_here = platforms is not None or is_native_here(binaries, case.in_space)
    if case.in_space and (runtime == "python" or (runtime == "auto" and not native_here)):
        remedy = "use --runtime native; where a binary is missing, run: python -m boreprop_fmu.native"
        raise InputError(f"runtime: must be native for a case in space, got {runtime!r}: {remedy}")
    if runtime == "native" or (runtime == "auto" and native_here):
        write_archive(pack_native(case, name, binaries, platforms), output)
    else:
        write_archive(pack_python(case, name), output)
    return output

"""Packs a case as an FMI 2.0 co-simulation FMU, either as Python code on pythonfmu's runtime or as machine code."""

from collections.abc import Callable, Sequence
from pathlib import Path

from boreprop.case.case import Case
from boreprop.errors import InputError

from .archive import write_archive
from .native import pack_native
from .python import pack_python

RUNTIMES = ("python", "native")


def build_fmu(
    case: Case,
    output: Path,
    *,
    runtime: str = "python",
    platforms: Sequence[str] | None = None,
    compiler: str | None = None,
    progress: Callable[[float], None] | None = None,
) -> Path:
    """Write the FMU of a case. The same case and the same code give the same bytes.

    Parameters
    ----------
    case
        The case from which the FMU starts.
    output
        The file to write.
    runtime
        "python" packs Python code, for hosts that have a Python; "native" packs machine code and its C sources.
    platforms
        For a native FMU: the names, in `boreprop.kernel.compiler.PLATFORMS`, of the platforms for which it has
        binaries. None: this machine; empty: no binaries, only the sources.
    compiler
        For a native FMU: "ziglang" compiles for every platform, and gives the same bytes on every machine; "own" is
        this machine's C compiler ($CC with $CFLAGS, else cc, gcc or clang) and compiles for this machine only. None:
        ziglang or, if that is not installed and no platforms are named, the own compiler.
    progress
        Called with the number of binaries compiled so far.

    Returns
    -------
    output

    Raises
    ------
    InputError
        If the runtime, a platform or the compiler does not exist or does not fit the others, or no compiler is
        installed for a platform.
    OSError
        If the file cannot be written; it is unchanged then.
    """
    if runtime not in RUNTIMES:
        raise InputError(f"runtime: must be {' or '.join(RUNTIMES)}, got {runtime!r}")
    if runtime == "native":
        write_archive(pack_native(case, platforms, compiler, progress), output)
        return output
    if platforms is not None:
        raise InputError(f"platforms: must be left out for the runtime python, got {', '.join(platforms) or 'none'}")
    if compiler is not None:
        raise InputError(f"compiler: must be left out for the runtime python, got {compiler!r}")
    write_archive(pack_python(case), output)
    return output

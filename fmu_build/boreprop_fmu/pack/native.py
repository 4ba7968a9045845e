"""Packs the model as machine code: the kernel behind the functions of FMI 2.0, for hosts without Python.

The folder `sources/` can be compiled with any C99 compiler; the binaries are compiled from nothing else.
"""

from collections.abc import Callable, Sequence
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

from boreprop.case.case import Case
from boreprop.core.quantities import INPUTS, VARIABLES
from boreprop.errors import InputError
from boreprop.kernel.compiler import PLATFORMS, CompilerError, NoCompilerError, compile_library, host_platform

from .archive import identify
from .contents import IDENTIFIER, describe, pack_manual, start_values

COMPILERS = ("ziglang", "own")
SOURCE_FILE = "fmi2.c"
FMI_HEADERS = ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h")
CASE_HEADER = """\
/* What this FMU is made for and starts from: written when it was packed. */
#define GUID "{guid}"

enum {{ STABILIZERS = {stabilizers}, VARIABLES = {variables}, INPUTS = {inputs}, STATIONS = {stations} }};

/* Value references; of a stacked variable the first. */
enum {{
{references}
}};

static const Variable VARIABLE[VARIABLES] = {{
{table}
}};

/* The existing hole: m, rad. */
static const double MEASURED_DEPTH[STATIONS] = {{
{measured_depth}
}};
static const double INCLINATION[STATIONS] = {{
{inclination}
}};
"""


def pack_native(
    case: Case,
    platforms: Sequence[str] | None = None,
    compiler: str | None = None,
    progress: Callable[[float], None] | None = None,
) -> dict[str, bytes]:
    """The files of an FMU that needs no Python: path in the FMU → content. Parameters are those of `build_fmu`."""
    check_targets(platforms, compiler)
    code = pack_sources()

    def numbers(guid: str) -> dict[str, bytes]:
        description = describe(case, guid, interpolates=True, source_files=[SOURCE_FILE])
        return {**description, "sources/case.h": case_header(case, guid)}

    guid = identify({**code, **numbers(guid="")})
    packed = {**numbers(guid), **code}
    sources = {name: content for name, content in packed.items() if name.startswith("sources/")}
    return {**packed, **compile_binaries(sources, platforms, compiler, progress), **pack_manual(case, "native")}


def pack_sources() -> dict[str, bytes]:
    """The C code, which does not depend on the case."""
    own, kernel, fmi = files("boreprop_fmu") / "native", files("boreprop.kernel"), files("fmpy") / "c-code"
    code = [path for folder in (own, kernel) for path in folder.iterdir() if path.name.endswith(".h")]
    code += [own / SOURCE_FILE, *(fmi / name for name in FMI_HEADERS)]
    return {f"sources/{path.name}": path.read_bytes() for path in code}


def case_header(case: Case, guid: str) -> bytes:
    """A C header with the numbers of the case, and with the variables and their start values."""
    start = start_values(case)
    n = len(case.bha.stabilizer_positions)
    scalars = [(name, quantity) for quantity in VARIABLES for name in quantity.names(n)]
    references, reference = [], 0
    for quantity in VARIABLES:
        references.append(f"    {quantity.name.upper()} = {reference},")
        reference += len(quantity.names(n))
    table = [
        f'    {{"{name}", {quantity.role.upper()}, {quantity.kind.upper()}, {_real(start.get(name, 0.0))}}},'
        for name, quantity in scalars
    ]
    return CASE_HEADER.format(
        guid=guid,
        stabilizers=n,
        variables=len(scalars),
        inputs=len(INPUTS),
        stations=len(case.survey.measured_depth),
        references="\n".join(references),
        table="\n".join(table),
        measured_depth=_lines(case.survey.measured_depth),
        inclination=_lines(case.survey.inclination),
    ).encode()


def _real(value: float | str) -> str:
    return "0.0" if isinstance(value, str) else repr(float(value))


def _lines(values: Sequence[float]) -> str:
    return "\n".join(f"    {float(value)!r}," for value in values)


def check_targets(platforms: Sequence[str] | None, compiler: str | None) -> None:
    """Raise `InputError` unless the platforms and the compiler exist and fit each other; None fits everything."""
    for platform in platforms or ():
        if platform not in PLATFORMS:
            raise InputError(f"platforms: must be among {', '.join(PLATFORMS)}, got {platform!r}")
    if compiler is not None and compiler not in COMPILERS:
        raise InputError(f"compiler: must be {' or '.join(COMPILERS)}, got {compiler!r}")
    if compiler == "own" and platforms is not None:
        named = ", ".join(platforms) or "none"
        raise InputError(f"platforms: must be left out for this machine's own compiler, got {named}")


def compile_binaries(
    sources: dict[str, bytes],
    platforms: Sequence[str] | None,
    compiler: str | None = None,
    progress: Callable[[float], None] | None = None,
) -> dict[str, bytes]:
    """Compile the binaries of an FMU.

    Parameters
    ----------
    sources
        The files of the folder sources/: path in the FMU → content.
    platforms, compiler, progress
        As in `build_fmu`.

    Returns
    -------
    The binaries: path in the FMU → content.

    Raises
    ------
    InputError
        If there is no compiler for a platform, or it fails.
    """
    archive = {}
    if platforms is None and compiler is None:
        compilers: Sequence[str] = COMPILERS
    else:
        compilers = [compiler or "ziglang"]
    with TemporaryDirectory(prefix="boreprop-fmu-") as folder:
        for name, content in sources.items():
            Path(folder, Path(name).name).write_bytes(content)
        source = Path(folder, SOURCE_FILE)
        for done, platform in enumerate(_targets(platforms), 1):
            library = Path(folder, f"{IDENTIFIER}{PLATFORMS[platform].suffix}")
            _compile(source, library, platform, compilers)
            archive[f"binaries/{platform}/{library.name}"] = library.read_bytes()
            if progress:
                progress(done)
    return archive


def _targets(platforms: Sequence[str] | None) -> Sequence[str]:
    """The platforms for which binaries are compiled, without repetitions."""
    if platforms is not None:
        return list(dict.fromkeys(platforms))
    host = host_platform()
    if host is None:
        raise InputError(
            f"platforms: must be given (--platforms) on this machine, which is none of {', '.join(PLATFORMS)}, got none"
        )
    return [host]


def _compile(source: Path, library: Path, platform: str, compilers: Sequence[str]) -> None:
    """Compile with the first of these compilers that is installed. If that one fails, no other is tried."""
    for compiler in compilers:
        try:
            compile_library(source, library, platform=platform if compiler == "ziglang" else None)
        except NoCompilerError as error:
            missing = InputError(str(error))
        except CompilerError as error:
            raise InputError(str(error)) from error
        else:
            return
    raise missing

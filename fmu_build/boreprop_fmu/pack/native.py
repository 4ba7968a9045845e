"""Packs the model as machine code: the kernel behind the functions of FMI 2.0, for hosts without Python.

The code is the same for every case: what an instance starts from is data, `resources/case.txt`. So nothing is compiled
here; the binaries are those that there are, see `boreprop_fmu.native`. The folder `sources/` can be compiled with any
C99 compiler and the headers of FMI 2.0.
"""

from collections.abc import Sequence
from pathlib import Path

from boreprop.case.case import Case
from boreprop.core.quantities import INPUTS, PARAMETERS, scalar_names
from boreprop.errors import InputError
from boreprop.kernel.compiler import FOLDER as KERNEL
from boreprop.kernel.compiler import host_platform
from boreprop.kernel.generate import quantities_digest

from ..native.binaries import NATIVE, PLATFORMS, SOURCE, SPACE, binary_path, check_platform, is_current
from .archive import identify
from .contents import describe, pack_manual, start_values

CASE_TEXT = "resources/case.txt"  # the case, as the C code reads it
PREFIX = """\
#ifndef FMI2_FUNCTION_PREFIX /* a shared library has none: -DFMI2_FUNCTION_PREFIX= */
#define FMI2_FUNCTION_PREFIX {identifier}_
#endif
"""


def pack_native(case: Case, identifier: str, binaries: Path, platforms: Sequence[str] | None) -> dict[str, bytes]:
    """The files of an FMU that needs no Python: path in the FMU → content. Parameters are those of `build_fmu`."""
    code = pack_sources(identifier, case.in_space)

    def numbers(guid: str) -> dict[str, bytes]:
        description = describe(case, identifier, guid, native=True, source_files=[SOURCE.name])
        return {**description, CASE_TEXT: case_text(case, guid)}

    guid = identify({**code, **numbers(guid="")})
    return {
        **numbers(guid),
        **code,
        **pack_binaries(identifier, binaries, platforms, case.in_space),
        **pack_manual(case, identifier, "native"),
    }


def pack_sources(identifier: str, in_space: bool) -> dict[str, bytes]:
    """The C code. Its functions are called after the FMU, so that several can be linked into one program."""
    code = {path.name: path.read_bytes() for folder in (NATIVE, KERNEL) for path in folder.glob("*.h")}
    law = f"#define {SPACE}\n" if in_space else ""
    code[SOURCE.name] = (PREFIX.format(identifier=identifier) + law).encode() + SOURCE.read_bytes()
    return {f"sources/{name}": content for name, content in code.items()}


def case_text(case: Case, guid: str) -> bytes:
    """The case as lines "name value", in SI units, in the order in which packed_case.h reads them."""
    structure, start, survey = case.structure, start_values(case), case.survey
    lines: dict[str, object] = {"guid": guid, "quantities": quantities_digest(), **structure._asdict()}
    names = scalar_names(INPUTS + PARAMETERS, structure)
    lines |= {name: float(start[name]) for name in names if not isinstance(start[name], str)}
    lines["bit_diameter"] = float(case.bit_diameter)
    lines["stations"] = len(survey.measured_depth)
    columns = {"measured_depth": survey.measured_depth, "inclination": survey.inclination}
    if structure.space:
        columns["azimuth"] = survey.azimuth or (0.0,) * len(survey.measured_depth)
    for column, values in columns.items():
        lines |= {f"{column}[{k}]": float(value) for k, value in enumerate(values, start=1)}
    ground = case.ground.numbers if case.ground else []
    lines["ground"] = len(ground)
    lines |= {f"ground[{k}]": float(value) for k, value in enumerate(ground, start=1)}
    return "".join(f"{name} {value}\n" for name, value in lines.items()).encode()


def pack_binaries(identifier: str, folder: Path, platforms: Sequence[str] | None, in_space: bool) -> dict[str, bytes]:
    """The binaries for some platforms, or all that there are, under the FMU's name; errors as in `build_fmu`."""
    packed = {}
    if platforms is None:
        platforms = [platform for platform in PLATFORMS if binary_path(platform, folder, in_space).exists()]
    for platform in platforms:
        check_platform(platform)
        path = binary_path(platform, folder, in_space)
        content = path.read_bytes() if path.exists() else b""
        if not is_current(content):
            got = "one of others; compile it again:" if content else "none; compile it:"
            name = "" if content else f" {platform}"  # without a name this machine's own compiler will do
            raise InputError(
                f"{path}: must be compiled from the sources as they are, got {got} python -m boreprop_fmu.native{name}"
            )
        packed[f"binaries/{platform}/{identifier}{path.suffix}"] = content
    return packed


def is_native_here(folder: Path, in_space: bool) -> bool:
    """Whether there is a binary for this machine, in the plane or in space."""
    platform = host_platform()
    return platform is not None and binary_path(platform, folder, in_space).exists()

"""The command `boreprop-fmu build`."""

from pathlib import Path
from typing import Annotated
from zipfile import ZipFile

import typer

from boreprop.cli import console
from boreprop.cli.cases import open_case
from boreprop.cli.options import CaseFile, one_of
from boreprop.errors import InputError
from boreprop.kernel.compiler import CompilerError
from boreprop.report.tables.sag import steadily_outside
from boreprop.run.files import files_read

from ..native.binaries import BINARIES, LAWS, PLATFORMS, build_binaries, check_platform, is_compiled
from ..pack.build import IDENTIFIER, RUNTIMES, build_fmu
from ..pack.python import ADVICE


def build_command(
    case_file: CaseFile,
    output: Annotated[Path, typer.Option(metavar="Borehole.fmu", help="The FMU.")],
    runtime: Annotated[
        str,
        typer.Option(
            parser=one_of(*RUNTIMES),
            metavar="auto|native|python",
            help="What computes in the FMU: native, compiled code, or python, for which the host needs Python; "
            "auto: native if there is a binary for this machine.",
        ),
    ] = "auto",
    name: Annotated[
        str, typer.Option(metavar="ID", help="The FMU's modelIdentifier: give FMUs that are linked together their own.")
    ] = IDENTIFIER,
    platforms: Annotated[
        str | None,
        typer.Option(
            metavar="linux64,win64,…|all|none",
            help="Platforms of a native FMU; what is missing for them is compiled. none: the C sources only. "
            "Default: all that are compiled.",
        ),
    ] = None,
) -> None:
    """Pack a case, and the model with it, as an FMU."""
    console.check_output(output, (".fmu",), reads=files_read(case_file))
    case, chosen = open_case(case_file, in_plane=False), None if platforms is None else _chosen(platforms)
    if runtime != "python":
        _compile_missing(chosen or [])
    if warning := steadily_outside(case):
        console.warn(f"{case_file}: {warning}")
    build_fmu(case, output, runtime=runtime, name=name, platforms=chosen, binaries=BINARIES)
    with ZipFile(output) as archive:
        folders = [path.split("/") for path in archive.namelist()]
    is_native = any(path[0] == "sources" for path in folders)
    binaries = [path[1] for path in folders if path[0] == "binaries"]
    contents = ", ".join(binaries + ["C sources"] * is_native)
    print(f"{output}: {output.stat().st_size / 1e6:.2g} MB, {'native' if is_native else 'python'}: {contents}")
    missing = [platform for platform in PLATFORMS if platform not in binaries]
    if is_native and missing and chosen is None:
        print(f"not for {', '.join(missing)}: to compile what is missing: python -m boreprop_fmu.native all")
    if not is_native and runtime == "auto":
        print("python, since there is no binary for this machine: to compile it: python -m boreprop_fmu.native")
    if not is_native:
        print(f"note: {ADVICE}")


def _chosen(platforms: str) -> list[str]:
    return {"all": list(PLATFORMS), "none": []}.get(platforms, [name.strip() for name in platforms.split(",")])


def _compile_missing(platforms: list[str]) -> None:
    """Compile what is not there, or stale, for platforms that were asked for."""
    for platform in platforms:
        check_platform(platform)
    missing = [platform for platform in platforms if not all(is_compiled(platform, BINARIES, law) for law in LAWS)]
    if not missing:
        return
    with console.progress("compiling", len(missing) * len(LAWS)) as done:
        try:
            for count, _ in enumerate(build_binaries(missing, BINARIES), start=1):
                done(count)
        except CompilerError as error:
            raise InputError(f"--platforms: {error}") from error

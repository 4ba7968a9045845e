"""The command `boreprop-fmu build`."""

from pathlib import Path
from typing import Annotated
from zipfile import ZipFile

import typer

from boreprop.case.file import load_case
from boreprop.cli import console
from boreprop.cli.options import CaseFile

from ..native.binaries import PLATFORMS
from ..pack.build import IDENTIFIER, build_fmu


def build_command(
    case_file: CaseFile,
    output: Annotated[Path, typer.Option(metavar="Borehole.fmu", help="The FMU.")],
    runtime: Annotated[
        str,
        typer.Option(
            metavar="auto|native|python",
            help="What computes in the FMU: native, compiled code, or python, for which the host needs Python; "
            "auto: native if there is a binary for this machine.",
        ),
    ] = "auto",
    name: Annotated[
        str, typer.Option(metavar="ID", help="The FMU's modelIdentifier: give FMUs that are linked together their own.")
    ] = IDENTIFIER,
) -> None:
    """Pack a case, and the model with it, as an FMU."""
    console.check_output(output, (".fmu",))
    build_fmu(load_case(case_file), output, runtime=runtime, name=name)
    with ZipFile(output) as archive:
        folders = [path.split("/") for path in archive.namelist()]
    is_native = any(path[0] == "sources" for path in folders)
    binaries = [path[1] for path in folders if path[0] == "binaries"]
    contents = ", ".join(binaries + ["C sources"] * is_native)
    print(f"{output}: {output.stat().st_size / 1e6:.2g} MB, {'native' if is_native else 'python'}: {contents}")
    missing = [platform for platform in PLATFORMS if platform not in binaries]
    if is_native and missing:
        print(f"not for {', '.join(missing)}: to compile what is missing: python -m boreprop_fmu.native all")
    if not is_native and runtime == "auto":
        print("python, since there is no binary for this machine: to compile it: python -m boreprop_fmu.native")

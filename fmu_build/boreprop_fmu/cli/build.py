"""The command `boreprop-fmu build`."""

from pathlib import Path
from typing import Annotated
from zipfile import ZipFile

import typer

from boreprop.case.file import load_case
from boreprop.cli import console
from boreprop.cli.options import CaseFile
from boreprop.kernel.compiler import PLATFORMS

from ..pack.build import build_fmu
from ..pack.python import ADVICE


def build_command(
    case_file: CaseFile,
    output: Annotated[Path, typer.Option(metavar="Borehole.fmu", help="The FMU.")],
    runtime: Annotated[
        str,
        typer.Option(
            metavar="python|native",
            help="What computes in the FMU: python, for which the host needs Python, or native, compiled code.",
        ),
    ] = "python",
    platforms: Annotated[
        str | None,
        typer.Option(
            metavar="linux64,win64,…|all|none",
            help="The platforms of a native FMU; none: only the C sources are packed. Default: this machine.",
        ),
    ] = None,
) -> None:
    """Pack a case, and the model with it, as an FMU."""
    console.check_output(output, (".fmu",))
    chosen = None if platforms is None else _chosen(platforms)
    case = load_case(case_file)
    with console.progress("compiling", 1 if chosen is None else len(chosen)) as done:
        build_fmu(case, output, runtime=runtime, platforms=chosen, progress=done)
    print(f"{output}: {output.stat().st_size / 1e6:.2g} MB, {runtime}: {', '.join(_contents(output))}")
    if runtime == "python":
        print(f"note: {ADVICE}")


def _chosen(platforms: str) -> list[str]:
    return {"all": list(PLATFORMS), "none": []}.get(platforms, [name.strip() for name in platforms.split(",")])


def _contents(fmu: Path) -> list[str]:
    """The platforms for which an FMU has binaries, and "C sources" if it has them."""
    with ZipFile(fmu) as archive:
        folders = [name.split("/")[:2] for name in archive.namelist()]
    binaries = sorted({path[1] for path in folders if path[0] == "binaries"})
    has_sources = any(path[0] == "sources" for path in folders)
    return [*binaries, "C sources"] if has_sources else binaries

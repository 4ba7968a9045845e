"""Build the two FMUs and pack them with SystemStructure.ssd as an SSP: ``python make_ssp.py closed_loop.ssp``."""

import zipfile
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from pythonfmu.builder import FmuBuilder

from boreprop.case.file import load_case
from boreprop.cli import console
from boreprop.cli.lazy import new_app
from boreprop.replacing import replacing
from boreprop_fmu.pack.build import build_fmu

HERE = Path(__file__).parent

app = new_app("Pack the controller and the borehole as an SSP.")


@app.command()
def make_ssp(
    output: Annotated[Path, typer.Argument(metavar="SYSTEM.ssp", help="The SSP.")],
    runtime: Annotated[
        str, typer.Option(metavar="auto|native|python", help="What computes in the borehole's FMU.")
    ] = "auto",
) -> None:
    """Build both FMUs and pack them."""
    console.check_output(output, (".ssp",))
    case = load_case(HERE.parent / "build_section.toml")
    with TemporaryDirectory() as directory, replacing(output) as draft, zipfile.ZipFile(draft, "w") as ssp:
        ssp.write(HERE / "SystemStructure.ssd", "SystemStructure.ssd")
        borehole = build_fmu(case, Path(directory, "Borehole.fmu"), runtime=runtime)
        for fmu in (borehole, build_controller(Path(directory))):
            ssp.write(fmu, f"resources/{fmu.name}")
    print(f"{output}: {output.stat().st_size / 1e6:.1f} MB")


def build_controller(directory: Path) -> Path:
    """Build InclinationController.fmu in `directory` and return its path.

    The script's name carries a hash of its content: the interpreter finds modules by name, process-wide, and would give
    the first controller's code to every other one.
    """
    code = (HERE / "controller.py").read_bytes()
    script = directory / f"controller_{sha256(code).hexdigest()[:16]}.py"
    script.write_bytes(code)
    options = {"needsExecutionTool": False, "canGetAndSetFMUstate": True, "canSerializeFMUstate": True}
    built: Path = FmuBuilder.build_FMU(script, directory, **options)
    return built


if __name__ == "__main__":
    console.execute(app)

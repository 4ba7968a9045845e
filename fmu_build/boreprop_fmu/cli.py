"""The command `boreprop-fmu`: pack a case as an FMU, run an FMU."""

from pathlib import Path
from typing import Annotated, NoReturn
from zipfile import ZipFile

from boreprop.cli import console
from boreprop.cli.console import positive, typer

app = console.new_app("The borehole as a component of a system simulation: an FMI 2.0 co-simulation FMU.")


def main() -> NoReturn:
    """Run the command `boreprop-fmu`."""
    console.run(app)


@app.callback()
def _boreprop_fmu(version: console.Version = False) -> None:
    pass


@app.command()
def build(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")],
    output: Annotated[Path, typer.Option(metavar="Borehole.fmu", help="The FMU.")],
    runtime: Annotated[
        str, typer.Option(metavar="python|native", help="What runs in it: Python, which the host has, or machine code.")
    ] = "python",
    platforms: Annotated[
        str | None,
        typer.Option(
            metavar="linux64,win64,…|all|none",
            help="What native code is compiled for, instead of this machine; none: only the C sources are packed.",
        ),
    ] = None,
) -> None:
    """Pack a case, and the model with it, as an FMU."""
    from boreprop.case.file import load_case

    from .pack.build import build_fmu

    console.check_output(output, (".fmu",))
    chosen = None if platforms is None else _chosen(platforms)
    case = load_case(case_file)
    with console.progress("compiling", 1 if chosen is None else len(chosen)) as done:
        build_fmu(case, output, runtime=runtime, platforms=chosen, progress=done)
    print(f"{output}: {output.stat().st_size / 1e6:.2g} MB, {runtime}: {', '.join(_contents(output))}")


def _chosen(platforms: str) -> list[str]:
    from boreprop.kernel.compiler import PLATFORMS

    return {"all": list(PLATFORMS), "none": []}.get(platforms, [name.strip() for name in platforms.split(",")])


def _contents(fmu: Path) -> list[str]:
    """What an FMU runs on: platforms, and whether it has C sources."""
    with ZipFile(fmu) as archive:
        folders = [name.split("/")[:2] for name in archive.namelist()]
    binaries = sorted({path[1] for path in folders if path[0] == "binaries"})
    return binaries + ["C sources"] * any(path[0] == "sources" for path in folders)


@app.command()
def run(
    fmu: Annotated[Path, typer.Argument(metavar="Borehole.fmu", help="An FMU with our variable names.")],
    output: Annotated[Path, typer.Option(metavar="RUN.csv", help="The result file, .csv or .parquet.")],
    schedule: Annotated[
        Path | None, typer.Option(metavar="S.csv", help="RSS force over drilled length, instead of the packed one.")
    ] = None,
    step: Annotated[
        float | None,
        typer.Option(parser=positive, metavar="S", help="Communication step, s, instead of the FMU's own."),
    ] = None,
    stop: Annotated[
        float | None, typer.Option(parser=positive, metavar="T", help="End, s, instead of the FMU's own.")
    ] = None,
    tolerance: console.Tolerance = None,
) -> None:
    """Run an FMU through fmpy; rows at k times the step, k = 0, 1, …

    If the FMU cannot go on to the end, the rows so far are written all the same; the exit status is then 3.
    """
    from boreprop.case.tables import read_schedule
    from boreprop.errors import Stopped
    from boreprop.run.results import SUFFIXES, write_trajectory

    from .host.drive import FmuRun

    console.check_output(output, SUFFIXES)
    forces = None if schedule is None else read_schedule(schedule)
    fmu_run = FmuRun(fmu, forces, step=step, stop=stop, relative_tolerance=tolerance)
    try:
        with console.progress("drilling", fmu_run.stop) as done:
            trajectory = fmu_run.trajectory(done)
    except Stopped as stopped:
        if stopped.trajectory is not None:
            write_trajectory(stopped.trajectory, output)
        raise
    write_trajectory(trajectory, output)
    print(f"{output}: {len(trajectory)} rows over {trajectory['drilled_length'][-1]:g} m")


if __name__ == "__main__":
    main()

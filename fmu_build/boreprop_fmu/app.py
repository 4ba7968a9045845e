"""The command `boreprop-fmu`: pack a case as an FMU, run an FMU."""

from pathlib import Path
from typing import Annotated, NoReturn

from boreprop import console
from boreprop.console import positive, typer

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
) -> None:
    """Pack a case, and the model with it, as an FMU."""
    from boreprop.case import load_case

    from .build import build_fmu

    console.check_output(output, (".fmu",))
    build_fmu(load_case(case_file), output)
    print(f"{output}: {output.stat().st_size / 1e6:.1f} MB")


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
) -> None:
    """Run an FMU through fmpy; rows at k times the step, k = 0, 1, …"""
    from boreprop.case import read_schedule
    from boreprop.results import SUFFIXES, write_trajectory

    from .drive import Run

    console.check_output(output, SUFFIXES)
    forces = None if schedule is None else read_schedule(schedule)
    fmu_run = Run(fmu, forces, step=step, stop=stop)
    with console.progress("drilling", fmu_run.stop) as done:
        trajectory = fmu_run.trajectory(done)
    write_trajectory(trajectory, output)
    print(f"{output}: {len(trajectory)} rows over {trajectory['drilled_length'][-1]:g} m")


if __name__ == "__main__":
    main()

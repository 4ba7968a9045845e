"""The command `boreprop-view`: draws runs with Rerun."""

from pathlib import Path
from typing import Annotated, NoReturn

import typer

from boreprop.cli import console
from boreprop.cli.options import positive
from boreprop.errors import InputError


def main() -> NoReturn:
    """Run the command `boreprop-view`."""
    console.run(console.one_command(view))


def view(
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="RUN.csv|RUN.parquet|CASE.toml|Borehole.fmu…",
            help="Runs of any FMI tool, cases to run, FMUs to run and show while they run; several as overlays.",
        ),
    ],
    case: Annotated[
        Path | None, typer.Option(metavar="CASE.toml", help="The runs' case, if not the one that they come with.")
    ] = None,
    fmu: Annotated[
        Path | None, typer.Option(metavar="Borehole.fmu", help="The FMU that made the runs, with its case.")
    ] = None,
    plan: Annotated[
        Path | None, typer.Option(metavar="PLAN.csv", help="The planned hole: measured_depth, inclination_deg.")
    ] = None,
    schedule: Annotated[
        Path | None, typer.Option(metavar="S.csv", help="RSS force over drilled length, for an FMU.")
    ] = None,
    step: Annotated[
        float | None, typer.Option(parser=positive, metavar="S", help="Communication step, s, for an FMU.")
    ] = None,
    stop: Annotated[float | None, typer.Option(parser=positive, metavar="T", help="End, s, for an FMU.")] = None,
    save: Annotated[Path | None, typer.Option(metavar="X.rrd", help="The recording to write.")] = None,
    spawn: Annotated[bool, typer.Option("--spawn", help="Show it in a new viewer; what happens by default.")] = False,
    serve: Annotated[bool, typer.Option("--serve", help="Show it in the browser, until Ctrl-C.")] = False,
    connect: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Show it in the viewer at rerun+http://HOST:PORT/proxy.")
    ] = None,
    _version: console.Version = False,
) -> None:
    """Draw runs in Rerun; a case is drilled first, an FMU drills while it is drawn."""
    if save is not None:
        console.check_output(save, (".rrd",))
    if case is not None and fmu is not None:
        raise InputError("--case and --fmu: must be at most one, got both")
    if (viewers := spawn + serve + (connect is not None)) > 1:
        raise InputError(f"--spawn, --serve and --connect: must be at most one, got {viewers}")
    for option, value in (("--schedule", schedule), ("--step", step), ("--stop", stop)):
        if value is not None and not any(source.suffix == ".fmu" for source in sources):
            raise InputError(f"{option}: must come with an FMU to run, got {', '.join(map(str, sources))}")
    from .view import show  # here: Rerun takes longer to load than --help should

    show(
        sources,
        case=case,
        fmu=fmu,
        plan=plan,
        schedule=schedule,
        step=step,
        stop=stop,
        save=save,
        spawn=spawn or (save is None and viewers == 0),
        serve=serve,
        connect=connect,
    )


if __name__ == "__main__":
    main()

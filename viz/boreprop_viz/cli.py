"""The command `boreprop-view`: draws runs with Rerun."""

from pathlib import Path
from typing import Annotated, NoReturn

import typer

from boreprop.cli import console
from boreprop.cli.lazy import Command, new_app
from boreprop.cli.options import positive
from boreprop.cli.version import Version
from boreprop.errors import InputError

from .ports import check_free

app = new_app("Show runs in Rerun: vertical section, bit frame, ripple, plots over the drilled length.")


def main() -> NoReturn:
    """Run the command `boreprop-view`."""
    console.execute(app)


@app.command(cls=Command)
def view(
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="RUN.csv|RUN.parquet|CASE.toml|Borehole.fmu…",
            help="Result files of any FMI tool, cases to simulate, FMUs to drive and draw as they run. Several are "
            "drawn over one another.",
        ),
    ],
    case: Annotated[
        Path | None,
        typer.Option(metavar="CASE.toml", help="The case of the runs. Default: the one stored with each."),
    ] = None,
    fmu: Annotated[
        Path | None, typer.Option(metavar="Borehole.fmu", help="The FMU that made the runs: it holds their case.")
    ] = None,
    plan: Annotated[
        Path | None,
        typer.Option(
            metavar="PLAN.csv", help="The planned hole: columns measured_depth, inclination_deg[, azimuth_deg]."
        ),
    ] = None,
    schedule: Annotated[
        Path | None,
        typer.Option(metavar="S.csv", help="Inputs over drilled length or measured depth, for an FMU."),
    ] = None,
    step: Annotated[
        float | None, typer.Option(parser=positive, metavar="S", help="Communication step, s, for an FMU.")
    ] = None,
    stop: Annotated[
        float | None, typer.Option(parser=positive, metavar="T", help="Time at the end, s, for an FMU.")
    ] = None,
    pace: Annotated[
        float | None,
        typer.Option(
            parser=positive,
            metavar="SECONDS_PER_SECOND",
            help="Seconds of simulation per second of the clock, for an FMU. Default: as fast as it goes.",
        ),
    ] = None,
    save: Annotated[Path | None, typer.Option(metavar="X.rrd", help="The recording to write.")] = None,
    spawn: Annotated[bool, typer.Option("--spawn", help="Show the runs in a new viewer. This is the default.")] = False,
    serve: Annotated[
        bool,
        typer.Option(
            "--serve",
            help="Show the runs in the browser until Ctrl-C. Everything is kept for browsers that come late, in up to "
            "half of this machine's memory; beyond that the oldest data are dropped.",
        ),
    ] = False,
    connect: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Show the runs in the viewer at rerun+http://HOST:PORT/proxy. If it is started again during the run, "
            "it is sent everything again.",
        ),
    ] = None,
    port: Annotated[
        int | None,
        typer.Option(
            metavar="PORT",
            help="With --serve, the port of the page; the data are at the next one. To look from another machine: "
            "ssh -L PORT:localhost:PORT -L PORT+1:localhost:PORT+1. With --spawn, the port at which the viewer takes "
            "further data. Default: free ports.",
        ),
    ] = None,
    _version: Version = False,
) -> None:
    """Draw runs with Rerun. A case is simulated first; an FMU is drawn while it runs.

    To run an FMU is to run the code in it, with all your rights: run only those from people whom you trust.
    """
    if save is not None:
        from boreprop.run.files import files_read  # imported here, since reading cases takes longer than help

        console.check_output(save, (".rrd",), reads=files_read(*sources, case, fmu, plan, schedule))
    if case is not None and fmu is not None:
        raise InputError("--case, --fmu: at most one must be given, got both")
    if (viewers := spawn + serve + (connect is not None)) > 1:
        raise InputError(f"--spawn, --serve, --connect: at most one must be given, got {viewers}")
    check_port(port, spawn, serve)
    check_that_one_runs(sources, {"--schedule": schedule, "--step": step, "--stop": stop, "--pace": pace})
    from .view import show  # imported here, so that a wrong option is reported before Rerun, which is slow, is imported

    show(
        sources,
        case=case,
        fmu=fmu,
        plan=plan,
        schedule=schedule,
        step=step,
        stop=stop,
        pace=pace,
        save=save,
        spawn=spawn or (save is None and viewers == 0),
        serve=serve,
        connect=connect,
        port=port,
    )


def check_port(port: int | None, spawn: bool, serve: bool) -> None:
    """Raise `InputError` if a port is given that cannot be used, before a case is simulated."""
    if port is None:
        return
    if not (spawn or serve):
        raise InputError(f"--port: must be given with --serve or --spawn, got {port} without")
    check_free(port, *([port + 1] if serve else []))


def check_that_one_runs(sources: list[Path], options: dict[str, object]) -> None:
    """Raise `InputError` if an option for driving an FMU is given without an FMU to drive."""
    if any(source.suffix == ".fmu" for source in sources):
        return
    for option, value in options.items():
        if value is not None:
            raise InputError(f"{option}: must be given with an FMU to run, got {', '.join(map(str, sources))}")


if __name__ == "__main__":
    main()

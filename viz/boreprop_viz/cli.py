"""The command `boreprop-view`: draws runs with Rerun."""

import sys
from collections import Counter
from importlib.abc import MetaPathFinder
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from boreprop.case.file import load_case
from boreprop.case.tables import read_schedule, read_survey
from boreprop.cli import console
from boreprop.cli.lazy import new_app
from boreprop.cli.options import Version, positive
from boreprop.errors import InputError, Stopped
from boreprop.run.results import SUFFIXES, read_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory


class WithoutPandas(MetaPathFinder):
    """Says that pandas is not installed.

    pyarrow, on which Rerun builds, would load it to see whether it was given a table of pandas: a third of a second.
    """

    def find_spec(self, fullname: str, path: object = None, target: object = None) -> None:  # noqa: ARG002
        """Refuse pandas, and leave all else to the other finders."""
        if fullname == "pandas":
            raise ModuleNotFoundError("pandas is not needed here", name=fullname)


app = new_app("Runs to look at in Rerun: vertical section, bit frame, ripple, plots over the drilled length.")


def main() -> NoReturn:
    """Run the command `boreprop-view`."""
    console.run(app)


@app.command()
def view(
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="RUN.csv|RUN.parquet|CASE.toml|Borehole.fmu…",
            help="Runs of any FMI tool, cases to simulate, FMUs to run and show while they run. Several are drawn over "
            "one another.",
        ),
    ],
    case: Annotated[
        Path | None,
        typer.Option(metavar="CASE.toml", help="The case of the runs. Default: the one that they come with."),
    ] = None,
    fmu: Annotated[
        Path | None, typer.Option(metavar="Borehole.fmu", help="The FMU that made the runs, with its case.")
    ] = None,
    plan: Annotated[
        Path | None, typer.Option(metavar="PLAN.csv", help="The planned hole: measured_depth, inclination_deg.")
    ] = None,
    schedule: Annotated[
        Path | None, typer.Option(metavar="S.csv", help="Steering force over drilled length, for an FMU.")
    ] = None,
    step: Annotated[
        float | None, typer.Option(parser=positive, metavar="S", help="Communication step, s, for an FMU.")
    ] = None,
    stop: Annotated[
        float | None, typer.Option(parser=positive, metavar="T", help="Time at the end, s, for an FMU.")
    ] = None,
    save: Annotated[Path | None, typer.Option(metavar="X.rrd", help="The recording to write.")] = None,
    spawn: Annotated[bool, typer.Option("--spawn", help="Show it in a new viewer: the default.")] = False,
    serve: Annotated[bool, typer.Option("--serve", help="Show it in the browser until Ctrl-C.")] = False,
    connect: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Show it in the viewer that listens at rerun+http://HOST:PORT/proxy."),
    ] = None,
    _version: Version = False,
) -> None:
    """Draw runs. A case is simulated first; an FMU is drawn while it runs."""
    sys.meta_path.insert(0, WithoutPandas())
    # here: Rerun takes longer to load than it takes to say what is wrong with an option
    from .record import draw
    from .sinks import open_recording
    from .source import Source, live, stored

    if save is not None:
        console.check_output(save, (".rrd",))
    if case is not None and fmu is not None:
        raise InputError("--case and --fmu: must be at most one, got both")
    if (viewers := spawn + serve + (connect is not None)) > 1:
        raise InputError(f"--spawn, --serve and --connect: must be at most one, got {viewers}")
    check_that_one_runs(sources, {"--schedule": schedule, "--step": step, "--stop": stop})
    forces = None if schedule is None else read_schedule(schedule)
    planned = None if plan is None else read_survey(plan)

    stopped: list[Stopped] = []

    def open_source(name: str, path: Path) -> Source:
        if path.suffix == ".fmu":
            from boreprop_fmu.host.drive import Run  # here: only an FMU needs fmpy

            return live(name, Run(path, forces, step=step, stop=stop), planned)
        run, error = drawable(path, case, fmu)
        if error:
            stopped.append(error)
        try:
            return stored(name, run, planned)
        except InputError as wrong:
            raise InputError(f"{path}: {wrong}") from wrong

    opened = [open_source(name, path) for name, path in zip(names(sources), sources, strict=True)]
    rows = sum(source.rows for source in opened)
    spawn = spawn or (save is None and not serve and connect is None)
    with (
        open_recording(save=save, spawn=spawn, serve=serve, connect=connect) as rec,
        console.progress("drawing", rows) as done,
    ):
        draw(rec, opened, planned, done)
    if save is not None:
        print(f"{save}: {rows} rows, {save.stat().st_size / 1e6:.1f} MB")
    if stopped:
        raise stopped[0]


def check_that_one_runs(sources: list[Path], options: dict[str, object]) -> None:
    """Raise `InputError` if one of the options for running an FMU is given without an FMU to run."""
    if any(source.suffix == ".fmu" for source in sources):
        return
    for option, value in options.items():
        if value is not None:
            raise InputError(f"{option}: must come with an FMU to run, got {', '.join(map(str, sources))}")


def drawable(source: Path, case: Path | None, fmu: Path | None) -> tuple[Trajectory, Stopped | None]:
    """The run in a file or of a case file, as far as it goes, and what it raised if that is not to its end."""
    try:
        return load_run(source, case, fmu), None
    except Stopped as error:
        if error.trajectory is None:
            raise
        return error.trajectory, error


def names(sources: list[Path]) -> list[str]:
    """What the runs are called: as their files, without what is not needed to tell them apart."""
    for short in (lambda path: path.stem, lambda path: path.name, str):
        found = [short(source) for source in sources]
        if len(set(found)) == len(found):
            return found
    [(twice, _)] = Counter(sources).most_common(1)
    raise InputError(f"{twice}: must be given once, got it again")


def load_run(source: Path, case: Path | None, fmu: Path | None) -> Trajectory:
    """The run in a result file, or of a case file that is run now."""
    if source.suffix == ".toml":
        if case or fmu:
            raise InputError(f"{source}: must be a run to be given a case, got a case file")
        to_run = load_case(source)
        with console.progress("drilling", to_run.length) as drilled:
            return simulate(to_run, progress=drilled)
    if source.suffix not in SUFFIXES:
        raise InputError(f"{source}: must end in {', '.join(SUFFIXES)}, .fmu or .toml, got {source.suffix!r}")
    if fmu is not None:
        from boreprop_fmu.host.drive import read_packed_case  # here: only an FMU needs fmpy

        packed = read_packed_case(fmu)
        if packed is None:
            raise InputError(f"{fmu}: must hold its case, as ours do, got an FMU without")
        return read_trajectory(source, packed)
    return read_trajectory(source, None if case is None else load_case(case))


if __name__ == "__main__":
    main()

"""The command `boreprop-view`: draws a run with Rerun."""

import shutil
import socket
import subprocess
from importlib.resources import files
from pathlib import Path
from time import monotonic, sleep
from typing import Annotated, NoReturn

from boreprop import console
from boreprop.case import InputError, load_case
from boreprop.console import typer
from boreprop.results import SUFFIXES, Trajectory, read_trajectory

STARTS_WITHIN = 30.0  # s, a viewer
LOOPBACK = "127.0.0.1"  # Rerun's own default is every network that the machine is in

app = console.new_app("A run to look at in Rerun: vertical section, bit frame, plots over the drilled length.")


def main() -> NoReturn:
    """Run the command `boreprop-view`."""
    console.run(app)


@app.command()
def view(
    source: Annotated[Path, typer.Argument(metavar="RUN.csv|RUN.parquet|CASE.toml", help="A run, or a case to run.")],
    case: Annotated[
        Path | None, typer.Option(metavar="CASE.toml", help="The run's case, if not the one that it comes with.")
    ] = None,
    fmu: Annotated[
        Path | None, typer.Option(metavar="Borehole.fmu", help="The FMU that made the run, with its case.")
    ] = None,
    save: Annotated[Path | None, typer.Option(metavar="X.rrd", help="The recording to write.")] = None,
    spawn: Annotated[bool, typer.Option("--spawn", help="Show it in a new viewer; what happens by default.")] = False,
    serve: Annotated[bool, typer.Option("--serve", help="Show it in the browser, until Ctrl-C.")] = False,
    connect: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Show it in the viewer at rerun+http://HOST:PORT/proxy.")
    ] = None,
    _version: console.Version = False,
) -> None:
    """Draw a run; a case is run first."""
    from .record import record

    if save is not None:
        console.check_output(save, (".rrd",))
    if case is not None and fmu is not None:
        raise InputError("--case and --fmu: must be at most one, got both")
    if source.suffix == ".toml" and (case or fmu):
        raise InputError(f"{source}: must be a run to be given a case, got a case file")
    if (viewers := spawn + serve + (connect is not None)) > 1:
        raise InputError(f"--spawn, --serve and --connect: must be at most one, got {viewers}")
    run = load_run(source, case, fmu)
    viewer = None
    if serve or spawn or (save is None and connect is None):
        viewer, connect = start_viewer(in_browser=serve)
    with console.progress("drawing", len(run)) as done:
        try:
            record(run, save=save, connect=connect, progress=done)
        except InputError as error:
            raise InputError(f"{source}: {error}") from error
    if save is not None:
        print(f"{save}: {len(run)} rows, {save.stat().st_size / 1e6:.1f} MB")
    if serve and viewer is not None:
        viewer.wait()


def load_run(source: Path, case: Path | None, fmu: Path | None) -> Trajectory:
    """The run in a result file, or of a case file that is run now."""
    if source.suffix == ".toml":
        from boreprop.simulation import simulate

        to_run = load_case(source)
        with console.progress("drilling", to_run.length) as drilled:
            return simulate(to_run, progress=drilled)
    if source.suffix not in SUFFIXES:
        raise InputError(f"{source}: must end in {', '.join(SUFFIXES)} or .toml, got {source.suffix!r}")
    if fmu is not None:
        from boreprop_fmu.drive import read_packed_case

        packed = read_packed_case(fmu)
        if packed is None:
            raise InputError(f"{fmu}: must hold its case, as ours do, got an FMU without")
        return read_trajectory(source, packed)
    return read_trajectory(source, None if case is None else load_case(case))


def start_viewer(in_browser: bool) -> tuple[subprocess.Popen[bytes], str]:
    """Start a Rerun viewer on this machine; returns its process and its address, once it listens."""
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        port = probe.getsockname()[1]
    options = ["--web-viewer", "--web-viewer-port", "0"] if in_browser else ["--hide-welcome-screen"]
    # the binary itself: the command is a wrapper whose child outlives it
    program = shutil.which("rerun", path=str(files("rerun_cli"))) or "rerun"
    viewer = subprocess.Popen([program, "--bind", LOOPBACK, "--port", str(port), *options])
    deadline = monotonic() + STARTS_WITHIN
    while viewer.poll() is None and monotonic() < deadline:
        try:
            socket.create_connection((LOOPBACK, port), timeout=1.0).close()
        except OSError:
            sleep(0.1)
        else:
            return viewer, f"rerun+http://{LOOPBACK}:{port}/proxy"
    viewer.kill()
    raise InputError("the Rerun viewer must start, for which it needs a screen: use --save, --serve or --connect")


if __name__ == "__main__":
    main()

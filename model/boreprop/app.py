"""The command `boreprop`: simulate a case, draw the paper's figures."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, NoReturn

from . import console
from .case import SAMPLE_INTERVAL
from .console import typer

MAX_ROWS = 10_000_000

app = console.new_app("Borehole propagation of a directional drilling system.")


def main() -> NoReturn:
    """Run the command `boreprop`."""
    console.run(app)


@app.callback()
def _boreprop(version: console.Version = False) -> None:
    pass


@app.command()
def simulate(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")],
    output: Annotated[Path, typer.Option(metavar="RUN.csv", help="The result file, .csv or .parquet.")],
    sample_interval: Annotated[
        float, typer.Option(parser=console.positive, metavar="M", help="Drilled length between rows, m.")
    ] = SAMPLE_INTERVAL,
    length: Annotated[
        float | None, typer.Option(parser=console.positive, metavar="M", help="Length to drill, m, if not the case's.")
    ] = None,
) -> None:
    """Simulate a case; rows at k times the sample interval, k = 0, 1, …"""
    from .case import InputError, load_case
    from .core.assembly import check_number
    from .results import SUFFIXES, case_path, write_trajectory

    console.check_output(output, SUFFIXES)
    if case_path(output).resolve() == case_file.resolve():
        raise InputError(f"{output}: must have another name, as its case would replace the case file, got {case_file}")
    case = load_case(case_file)
    if length is not None:
        case = replace(case, length=length)
    check_number("--sample-interval", sample_interval, at_least=case.length / MAX_ROWS)
    from .simulation import simulate

    with console.progress("drilling", case.length) as drilled:
        trajectory = simulate(case, sample_interval=sample_interval, progress=drilled)
    write_trajectory(trajectory, output)
    print(f"{output}: {len(trajectory)} rows over {case.length:g} m")


@app.command()
def summary(
    run_file: Annotated[Path, typer.Argument(metavar="RUN.csv", help="A result file, .csv or .parquet.")],
    case_file: Annotated[
        Path | None, typer.Option("--case", metavar="CASE.toml", help="Its case, if it does not carry one.")
    ] = None,
) -> None:
    """Print a run in a dozen numbers."""
    from rich.console import Console
    from rich.table import Table

    from .case import InputError, load_case
    from .results import read_trajectory
    from .summary import rows, summarize

    trajectory = read_trajectory(run_file, load_case(case_file) if case_file else None)
    if trajectory.case is None:
        raise InputError(f"{run_file}: must carry its case, or be given one with --case, got neither")
    if len(trajectory) < 2:
        raise InputError(f"{run_file}: must have at least 2 rows, got {len(trajectory)}")
    length_scale = trajectory.case.bha.length_scale
    table = Table(str(run_file), "")
    for row in rows(summarize(trajectory, length_scale), length_scale):
        table.add_row(*row)
    Console().print(table)


@app.command()
def figures(output: Annotated[Path, typer.Argument(metavar="OUT/", help="The directory to put them in.")]) -> None:
    """Draw the paper's figures 7 and 8 (PNG)."""
    from .figures import make_figures

    output.mkdir(parents=True, exist_ok=True)
    with console.progress("figures", 1.0) as done:
        make_figures(output, done)
    print(f"{output}: figures 7 and 8")


if __name__ == "__main__":
    main()

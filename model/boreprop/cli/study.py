"""The command `boreprop study`."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from ..analysis.study.cluster import on_cluster
from ..analysis.study.compute import study
from ..analysis.study.design import Study, grid, sample
from ..analysis.study.figures import key_figures
from ..core.checks import check_number
from ..errors import InputError
from ..report.tables.study import as_plain, lines, outcome
from ..run.files import files_read
from . import console
from .cases import open_case
from .fallback import warn_of_fallback
from .options import AsJson, CaseFile, Tolerance, Units
from .outputs import check_run_output
from .printing import print_json, print_table
from .ranges import parse_axis, parse_distribution, parse_each

QUANTILES_OF_GRID = {"least": 0.0, "median": 0.5, "largest": 1.0}
QUANTILES_OF_SAMPLE = {"10 %": 0.1, "50 %": 0.5, "90 %": 0.9}


def study_command(
    case_file: CaseFile,
    output: Annotated[
        Path,
        typer.Option(
            metavar="STUDY.csv",
            help="The file of results, .csv or .parquet. If it exists, the study continues from it.",
        ),
    ],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=START:STOP:COUNT",
            help="Values of a parameter: an axis of a grid. Also NAME=VALUE,VALUE,… May be given several times.",
        ),
    ] = None,
    uncertain: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=normal(MEAN,DEVIATION)",
            help="The distribution of an uncertain parameter. Also lognormal(MEDIAN,DEVIATION OF THE LOG), "
            "uniform(LOW,HIGH) or triangular(LOW,MODE,HIGH). May be given several times.",
        ),
    ] = None,
    draws: Annotated[int, typer.Option("--sample", metavar="N", help="Number of draws with --uncertain.")] = 200,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the draws.")] = 1,
    workers: Annotated[
        int | None, typer.Option(metavar="K", help="Number of processes. Default: one for each core.")
    ] = None,
    dask: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Compute on the workers of a Dask scheduler, tcp://HOST:PORT.")
    ] = None,
    tolerance: Tolerance = None,
    as_json: AsJson = False,
    units: Units = "si",  # noqa: ARG001 - its callback has done it
) -> None:
    """Simulate many cases on all cores: over a grid, or of uncertain parameters.

    NAME is an input or parameter of the case, such as stabilizer_clearance[1], in SI units; or eta_pi; or
    bit_tilt_limit_deg.
    """
    check_run_output(output, files_read(case_file))
    check_number("--sample", draws, at_least=1)
    check_number("--seed", seed, at_least=0)
    if workers is not None:
        check_number("--workers", workers, at_least=1)
    if dask is not None and workers is not None:
        raise InputError(f"--workers: must not be given with --dask, whose workers compute, got {workers}")
    cases = _cases(case_file, vary or [], uncertain or [], draws, seed)
    figures = key_figures if tolerance is None else partial(key_figures, relative_tolerance=tolerance)
    if dask is None:
        warn_of_fallback()
    try:
        with on_cluster(dask) as executor, console.progress("cases", len(cases)) as done:
            results = study(cases, figures, output=output, executor=executor, workers=workers, progress=done)
    except KeyboardInterrupt:
        if output.exists():
            console.warn(f"{output}: keeps the cases that are done; the same command continues from there")
        raise
    quantiles = QUANTILES_OF_SAMPLE if uncertain else QUANTILES_OF_GRID
    if as_json:
        print_json(as_plain(results, quantiles.values()))
        return
    print_table(lines(results, quantiles.values()), (str(output), *quantiles))
    print(f"{output}: {outcome(results)}")


def _cases(case_file: Path, vary: list[str], uncertain: list[str], draws: int, seed: int) -> Study:
    """The cases of the study: a grid, or a sample."""
    if bool(vary) == bool(uncertain):
        raise InputError(f"--vary, --uncertain: exactly one must be given, got {'both' if vary else 'neither'}")
    case = open_case(case_file, in_plane=False)
    if vary:
        return grid(case, parse_each(parse_axis, vary))
    return sample(case, parse_each(parse_distribution, uncertain), draws, seed)

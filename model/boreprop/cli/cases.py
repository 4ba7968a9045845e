"""The case of a command that drills or analyses it, and the run of one that reads it."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from ..case.case import Case, check_plane
from ..case.file import load_case, read_case
from ..case.usual import unusual
from ..core.quantities import BY_NAME
from ..core.system import scale
from ..errors import InputError, ParameterError, shown
from ..run.results import read_trajectory
from ..run.trajectory import Trajectory
from . import console

RunFile = Annotated[Path, typer.Argument(metavar="RUN.csv", help="A result file, .csv or .parquet.")]
"""The argument RUN.csv: ``run_file: RunFile``."""

RunCase = Annotated[
    Path | None,
    typer.Option("--case", metavar="CASE.toml", help="The case of the run. Default: the one stored with it."),
]
"""The option --case of a command that reads a run: ``case_file: RunCase = None``."""


def open_case(path: Path, *, in_plane: bool = True) -> Case:
    """Read a case file; warn, once and in one line, of what is far from any assembly, and of a hole made longer.

    A case that leaves its plane is refused `in_plane`; a constant azimuth only says where the plane is.
    """
    case, notes = read_case(path)
    with naming(path):
        if in_plane:
            check_plane(case)
        if case.bha.structure.is_of_the_paper:  # others are checked by the native engine
            scale(case.bha, replace(case.bit, walk_angle=0.0))
    found = notes + unusual(case)
    if found:
        console.warn(f"{path}: {'; '.join(found)}")
    return case


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Turn an error about a parameter of a case into one that names the file of the case and the key there."""
    try:
        yield
    except ParameterError as error:
        raise InputError(f"{path}: {as_in_file(error)}") from error


def as_in_file(error: ParameterError) -> str:
    """What is wrong with a parameter, by its key in the case file if it has one, angles in degrees."""
    name, bracket, index = error.name.partition("[")
    quantity = BY_NAME.get(name)
    if quantity is None or not quantity.field:
        return str(error)
    value = error.value
    if quantity.key.endswith("_deg"):
        value = np.round(np.degrees(np.asarray(value)), 9).tolist()
    return f"{quantity.key}{bracket}{index}: {error.constraint}, got {shown(value)}"


def open_run(run_file: Path, case_file: Path | None) -> Trajectory:
    """Read a run of at least two rows, with the case stored with it or that of a case file; else `InputError`."""
    run = read_trajectory(run_file, load_case(case_file) if case_file else None)
    if run.case is None:
        raise InputError(f"{run_file}: must come with its case, got none: give it with --case")
    if run.row_count < 2:
        raise InputError(f"{run_file}: must have at least 2 rows, got {run.row_count}")
    return run

"""Writes and reads result files: the columns of a run, and its case.

The case of a CSV file is in a file beside it (run.csv, run.case.toml); that of a Parquet file is in its metadata. In
both, the table [run] says which engine computed the run and, if the run ended early, why. Parquet files need pyarrow.

Other tools write our columns under longer names. OMSimulator and fmpy put the path of the component before the name
(model.root.borehole.bit_tilt); libcosim up to 0.9 puts the kind of variable after it (bit_tilt [6 real output]).
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..case.case import Case
from ..case.file import dump_case, parse_case, read_run
from ..case.sheet import read_sheet
from ..core.columns import regular
from ..core.quantities import BY_NAME, CLEARANCES, OUTPUTS, QUANTITIES
from ..errors import InputError, shown
from ..replacing import replacing
from .files import MARK, case_path, check_case_beside
from .trajectory import Stopped, Trajectory, plain_name

SUFFIXES = (".csv", ".parquet")
CASE_KEY = b"boreprop.case"
BLOCK = 1000  # rows of a CSV file that are written at once: the numbers of more are never Python objects together


def write_trajectory(trajectory: Trajectory, path: str | Path) -> None:
    """Write a run to a .csv or .parquet file, with its case if it has one.

    An existing file is replaced only once the new one is complete.

    Parameters
    ----------
    trajectory
        The run. Its engine and the reason why it stopped, if it did, are written with its case.
    path
        The file. The case of run.csv goes to run.case.toml beside it, that of a Parquet file into its metadata.

    Raises
    ------
    InputError
        If `path` ends in neither .csv nor .parquet, if it ends in .parquet and pyarrow is not installed, or if a file
        that is not ours lies where the case goes.
    OSError
        If the file cannot be written.
    """
    path = Path(path)
    write = {".csv": _write_csv, ".parquet": _write_parquet}.get(path.suffix)
    if write is None:
        raise InputError(f"{path}: must end in {' or '.join(SUFFIXES)}, got {path.suffix!r}")
    write(trajectory, path)


@contextmanager
def keeping_rows(path: Path) -> Iterator[None]:
    """Write the rows of a run that stops inside this context to a file, as `write_trajectory` does, and raise again."""
    try:
        yield
    except Stopped as stopped:
        if stopped.trajectory is not None:
            write_trajectory(stopped.trajectory, path)
        raise


def read_trajectory(path: str | Path, case: Case | None = None) -> Trajectory:
    """Read a run written by `write_trajectory` or by any FMI tool.

    Only drilled_length must be there. Columns that are not in the table of quantities are left out. A file of a system
    of several components is read for the component that has drilled_length. If several have it (one of them may have it
    as an input), the one is read that has every output that the others have.

    Parameters
    ----------
    path
        A .csv or .parquet file.
    case
        The case that was drilled. None: the case that `write_trajectory` wrote with the run, if there is one.

    Returns
    -------
    Trajectory
        The columns in SI units, shape (rows,), at least one row; its case, engine and reason of stopping where the file
        has them.

    Raises
    ------
    InputError
        If the file cannot be read, drilled_length is missing or no single component has every output, a line has too
        few or too many values, a value is not a finite number, or the case has another number of stabilizers.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from boreprop import paper_case, read_trajectory, simulate, write_trajectory
    >>> run = simulate(paper_case(), length=10.0, sample_interval=0.5)
    >>> with TemporaryDirectory() as directory:
    ...     write_trajectory(run, Path(directory, "run.csv"))
    ...     again = read_trajectory(Path(directory, "run.csv"))
    >>> again.case == run.case, bool((again["bit_tilt"] == run["bit_tilt"]).all())
    (True, True)
    """
    path = Path(path)
    read = {".csv": _read_csv, ".parquet": _read_parquet}.get(path.suffix)
    if read is None:
        raise InputError(f"{path}: must end in {' or '.join(SUFFIXES)}, got {path.suffix!r}")
    trajectory = read(path, case)
    if not trajectory.row_count:
        raise InputError(f"{path}: must have at least one row, got none")
    found = Trajectory(trajectory.columns).n
    if found not in (0, trajectory.n):
        raise InputError(f"{path}: average_inclination: must have {trajectory.n} columns like its case, got {found}")
    still = [name for name in CLEARANCES if name in trajectory and np.ptp(trajectory[name]) == 0.0]  # a parameter
    return replace(trajectory, columns={name: values for name, values in trajectory.items() if name not in still})


IO_NAMES = {quantity.name for quantity in QUANTITIES if quantity.role in ("input", "output") or quantity.tunable}
OUTPUT_NAMES = {quantity.name for quantity in OUTPUTS}
# the heading of a column of another tool: component.name [reference type causality]
HEADING = re.compile(r"(?:(?P<component>.+)\.)?(?P<name>[^.\s]+)(?: \[\d+ [\w ]+\])?")


def _taken_apart(heading: str) -> re.Match[str] | None:
    """The parts of the heading of one of our inputs or outputs; None for any other heading."""
    match = HEADING.fullmatch(heading)
    return match if match and plain_name(match["name"]) in IO_NAMES else None


def _ours(path: Path, headings: list[str]) -> dict[str, str]:
    """Scalar names of the time and of one borehole's inputs and outputs → their headings in the file."""
    components: dict[str, dict[str, str]] = {}
    for heading in headings:
        if match := _taken_apart(heading):
            components.setdefault(match["component"] or "", {}).setdefault(match["name"], heading)
    drilling = [names for names in components.values() if "drilled_length" in names]
    if not drilling:
        raise InputError(f"{path}: must have a column 'drilled_length' (m), got {shown(headings)}")
    outputs = [{name for name in names if plain_name(name) in OUTPUT_NAMES} for names in drilling]
    ours = [names for names, own in zip(drilling, outputs, strict=True) if own >= set().union(*outputs)]
    if len(ours) != 1:
        found = ", ".join(names["drilled_length"] for names in drilling)
        raise InputError(f"{path}: must have a single borehole with all its outputs, got several: {found}")
    times = [heading for heading in headings if heading.lower() == "time"]
    return dict(zip(("time",), times, strict=False)) | ours[0]


def _typed(trajectory: Trajectory) -> dict[str, NDArray[Any]]:
    """The columns, with whole numbers for the quantities of kind Integer."""
    integers = {name for name in trajectory.columns if (v := BY_NAME.get(plain_name(name))) and v.kind == "Integer"}
    return {k: v.astype(np.int32) if k in integers else v for k, v in trajectory.columns.items()}


def _case_text(trajectory: Trajectory, case: Case) -> str:
    """The text of the case file of a run, with the table [run]."""
    return dump_case(case, engine=trajectory.engine, stopped=trajectory.stopped)


def _write_csv(trajectory: Trajectory, path: Path) -> None:
    columns = _typed(trajectory)
    check_case_beside(path)
    with replacing(path) as draft:
        with open(draft, "w", encoding="utf-8", newline="\n") as file:
            file.write(",".join(columns) + "\n")
            for start in range(0, trajectory.row_count, BLOCK):
                # repr is the shortest text that reads back as the same number
                cells = (map(repr, column[start : start + BLOCK].tolist()) for column in columns.values())
                file.writelines(",".join(row) + "\n" for row in zip(*cells, strict=True))
        if trajectory.case is None:
            case_path(path).unlink(missing_ok=True)  # it belonged to the run that is overwritten
        else:
            with replacing(case_path(path)) as case_draft:
                case_draft.write_text(MARK + _case_text(trajectory, trajectory.case), encoding="utf-8")


def _read_csv(path: Path, case: Case | None) -> Trajectory:
    sheet = read_sheet(path, lambda heading: _taken_apart(heading) is not None)
    ours = _ours(path, sheet.headings)
    columns = {name: np.array(c) for name, c in zip(ours, sheet.numbers(list(ours.values())), strict=True)}
    own = case_path(path)
    if not own.exists():
        return Trajectory(columns, case)
    text = regular(own).read_text("utf-8-sig", errors="replace")
    about = read_run(text)
    return Trajectory(
        columns, parse_case(text, own) if case is None else case, about.get("stopped"), about.get("engine")
    )


def _write_parquet(trajectory: Trajectory, path: Path) -> None:
    pyarrow, parquet = _pyarrow(path)
    metadata = {} if trajectory.case is None else {CASE_KEY: _case_text(trajectory, trajectory.case)}
    with replacing(path) as draft:
        parquet.write_table(pyarrow.table(_typed(trajectory), metadata=metadata), draft)


def _read_parquet(path: Path, case: Case | None) -> Trajectory:
    pyarrow, parquet = _pyarrow(path)
    try:
        with parquet.ParquetFile(regular(path)) as file:
            ours = _ours(path, file.schema_arrow.names)
            table, metadata = file.read(columns=list(ours.values())), file.schema_arrow.metadata or {}
    except (OSError, pyarrow.ArrowException) as error:
        raise InputError(f"{path}: must be a readable Parquet file, got: {error}") from error
    columns = {name: _numbers(path, name, table.column(heading)) for name, heading in ours.items()}
    if CASE_KEY not in metadata:
        return Trajectory(columns, case)
    own = metadata[CASE_KEY].decode()
    about = read_run(own)
    return Trajectory(
        columns, parse_case(own, path) if case is None else case, about.get("stopped"), about.get("engine")
    )


def _numbers(path: Path, name: str, column: Any) -> NDArray[np.float64]:
    """A Parquet column as finite floats; `InputError` if it holds anything else."""
    try:
        values = np.asarray(column.to_numpy(), dtype=np.float64)
    except (ValueError, TypeError) as error:
        raise InputError(f"{path}: {name}: must hold numbers, got {column.type}") from error
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise InputError(f"{path}: {name}: row {bad[0] + 1}: must be a finite number, got {values[bad[0]]}")
    return values


def _pyarrow(path: Path) -> tuple[Any, Any]:
    """The modules pyarrow and pyarrow.parquet, imported only where needed: that takes longer than a short run."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ModuleNotFoundError as error:
        raise InputError(f"{path}: must be .csv unless pyarrow is installed: pip install 'boreprop[study]'") from error
    return pyarrow, pyarrow.parquet

"""Checks, before the work, the files that a command is to write."""

from collections.abc import Iterable
from pathlib import Path

from ..run.files import case_path, check_case_beside
from ..run.results import SUFFIXES
from .console import check_output


def check_run_output(path: Path, reads: Iterable[Path]) -> None:
    """Check that a run, with its case, can be written to `path`, over none of the files that the command reads.

    Raises
    ------
    InputError
        As `console.check_output`, also for the case beside a CSV file; or if that is there and boreprop did not
        write it.
    """
    reads = list(reads)
    check_output(path, SUFFIXES, reads=reads)
    if path.suffix == ".csv":
        check_output(case_path(path), reads=reads)
        check_case_beside(path)

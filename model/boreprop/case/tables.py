"""Reads surveys and force schedules from CSV files."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import radians
from pathlib import Path

from ..core.columns import read_columns
from ..core.errors import ParameterError, TableError
from ..core.quantities import columns_of
from ..core.survey import Survey
from ..errors import InputError, shown
from .case import Schedule


def read_survey(path: str | Path) -> Survey:
    """Read a survey: a CSV file with the columns measured_depth (m) and inclination_deg (degrees).

    Raises
    ------
    InputError
        If the file cannot be read, or the depths do not increase.
    """
    with _naming(path):
        measured_depth, inclination_deg = read_columns(path, columns_of("hole"))
        return Survey(measured_depth, tuple(map(radians, inclination_deg)))


def read_schedule(path: str | Path) -> Schedule:
    """Read a force schedule: a CSV file with the columns drilled_length (m) and force (N).

    Raises
    ------
    InputError
        If the file cannot be read, or the lengths do not start at 0 or do not increase.
    """
    with _naming(path):
        return Schedule(*read_columns(path, columns_of("rss")))


@contextmanager
def _naming(path: str | Path) -> Iterator[None]:
    """Turn errors about the columns of a file into an `InputError` that names the file."""
    try:
        yield
    except TableError as error:
        raise InputError(str(error)) from error
    except ParameterError as error:
        raise InputError(f"{path}: {error.name}: {error.constraint}, got {shown(error.value)}") from error

"""A schedule in, a trajectory out."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..case.case import Case, Schedule
from ..core.checks import check_number
from ..core.errors import CannotContinue
from ..core.options import RELATIVE_TOLERANCE, Options
from ..core.quantities import OUTPUTS, scalar_names
from .engines import chosen, start
from .trajectory import Stopped, Trajectory

SAMPLE_INTERVAL = 0.1  # m between the rows of a run, unless told otherwise: some 50 for each wave of a rippling hole
PARTS = 100  # a run reports its progress about so often
LONGEST_LEG = 50.0  # ℓ₁: an engine keeps the way back to where a leg began
ROUNDING = 1e-9  # of a sample interval: a row this close before the end or a change of force counts as on it


def simulate(
    case: Case,
    *,
    sample_interval: float = SAMPLE_INTERVAL,
    length: float | None = None,
    relative_tolerance: float = RELATIVE_TOLERANCE,
    progress: Callable[[float], None] | None = None,
    engine: str = "auto",
) -> Trajectory:
    """Drill a case under its force schedule.

    Parameters
    ----------
    case
        What is drilled.
    sample_interval
        Drilled length between rows, m. Rows are at k times the interval, k = 0, 1, …; where the force changes on a
        row, the row holds the values after the change.
    length
        Length to drill, m; without it, the case's.
    relative_tolerance
        Local error allowed in one step of the integrator, relative to 1 rad and to ℓ₁.
    progress
        Called with the drilled length, m, about a hundred times.
    engine
        "native": compiled code; "python": the same model in Python, which agrees but for rounding and is many times
        slower; "auto": native where it is there. The trajectory says which one drilled it.

    Returns
    -------
    Trajectory
        The inputs `rss_force` and `active_weight_on_bit` and every output of the table of quantities.

    Raises
    ------
    ParameterError
        If a value is out of range.
    Stopped
        If the integrator cannot go on; its `trajectory` holds the rows so far, its cause is the `CannotContinue`.
    KernelError
        If the native engine is not there.
    """
    length = case.length if length is None else length
    check_number("length", length, above=0.0)
    check_number("sample_interval", sample_interval, above=0.0)
    weight = case.active_weight_on_bit
    engine = chosen(engine)
    drilling = start(case, engine, Options(relative_tolerance))
    names = scalar_names(OUTPUTS, len(case.bha.stabilizer_positions))
    table = np.full((int(length / sample_interval + ROUNDING) + 1, len(names)), np.nan)
    legs = _legs(case.schedule, len(table), sample_interval)
    lengths, forces, rows = _in_parts(*legs, LONGEST_LEG * case.bha.length_scale)
    batch = len(lengths) // PARTS + 1 if progress else len(lengths)
    failure = None
    for first in range(0, len(lengths), batch):
        part = slice(first, first + batch)
        try:
            drilling.follow(lengths[part], forces[part], weight, rows[part], table)
        except CannotContinue as error:
            failure = error
            break
        if progress:
            progress(drilling.drilled_length)
    drilled = np.count_nonzero(~np.isnan(table[:, 0]))
    outputs = np.ascontiguousarray(table[:drilled].T)  # whoever reads a run reads it by columns
    columns = {"rss_force": forces[rows >= 0][:drilled], "active_weight_on_bit": np.full(drilled, weight)}
    stopped = f"after {drilling.drilled_length:g} m of {length:g} m: {failure}" if failure else None
    trajectory = Trajectory(columns | dict(zip(names, outputs, strict=True)), case, stopped, engine)
    if stopped:
        raise Stopped(stopped, trajectory) from failure
    return trajectory


def _legs(schedule: Schedule, count: int, sample_interval: float) -> tuple[Floats, Floats, NDArray[np.intc]]:
    """Where the legs of a run end, m, the force along each, N, and the row that each ends on; −1: the force changes."""
    at = sample_interval * np.arange(count)
    changes = np.array(schedule.drilled_length[1:])
    before = np.searchsorted(at + ROUNDING * sample_interval, changes)
    before = before[before < count]
    lengths = np.maximum.accumulate(np.insert(at, before, changes[: len(before)]))
    rows = np.insert(np.arange(count, dtype=np.intc), before, -1)
    changed = rows < 0
    return lengths, np.array(schedule.rss_force)[np.cumsum(changed) - changed], rows


def _in_parts(
    lengths: Floats, forces: Floats, rows: NDArray[np.intc], longest: float
) -> tuple[Floats, Floats, NDArray[np.intc]]:
    """The same legs, each in so many parts that none is longer than `longest`, m; only its last ends on a row."""
    starts = np.concatenate([[0.0], lengths[:-1]])
    parts = int(np.ceil((lengths - starts).max() / longest)) or 1
    ends = starts[:, None] + np.outer(lengths - starts, np.arange(1, parts + 1) / parts)
    ends[:, -1] = lengths
    on_rows = np.full(ends.shape, -1, dtype=np.intc)
    on_rows[:, -1] = rows
    return ends.ravel(), np.repeat(forces, parts), on_rows.ravel()

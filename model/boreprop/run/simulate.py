"""Simulates a case: drills it under its inputs and gives the trajectory."""

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np

from ..arrays import Floats
from ..case.case import Case, in_dimensions
from ..core.checks import check_number
from ..core.errors import CannotContinue
from ..core.options import RELATIVE_TOLERANCE, Options
from ..core.quantities import CLEARANCES, OUTPUTS, ROCK, scalar_names
from .course import Course, Indices, acting, course_of
from .engines import Engine, chosen, start, start_in_space
from .ground import rock_in_layers
from .trajectory import Stopped, Trajectory

SAMPLE_INTERVAL = 0.1  # m, the usual distance between rows: about 50 rows for each wave of the paper's rippling hole
PARTS = 100  # a run reports its progress about this many times
LONGEST_LEG = 50.0  # ℓ₁, to limit memory: an engine keeps all that it needs to return to the beginning of a leg
CONSTANT = (*ROCK, "bit_walk_angle", "toolface_reference")  # inputs with a column only where they change
ROUNDING = 1e-9  # sample intervals: a row this close before the end, or before a change of force, counts as on it


def simulate(
    case: Case,
    *,
    sample_interval: float = SAMPLE_INTERVAL,
    length: float | None = None,
    relative_tolerance: float = RELATIVE_TOLERANCE,
    progress: Callable[[float], None] | None = None,
    engine: str = "auto",
    dimensions: int | None = None,
) -> Trajectory:
    """Drill a case under its inputs: solve the paper's equations (5) to (18), or those in space, over the length.

    Parameters
    ----------
    case
        What is drilled.
    sample_interval
        Drilled length between rows, m. Rows are at k times the interval, k = 0, 1, …; where the force changes on a
        row, the row holds the values after the change.
    length
        Length to drill, m; without it, that of the case.
    relative_tolerance
        Error allowed in one step of the integrator, relative to 1 rad and to ℓ₁, 1e-12 to 1e-2.
    progress
        Called with the drilled length, m, about a hundred times.
    engine
        "native" is compiled code. "python" is the same model in Python, many times slower; the two agree but for
        rounding. "auto" is the native engine if it is installed, else the Python one. The trajectory says which one
        drilled it. What drills in space is native only.
    dimensions
        3: drill in space, as a case anyway does that is `Case.in_space`; the case of the trajectory says so then.

    Returns
    -------
    Trajectory
        Columns `rss_force`, `active_weight_on_bit` and whatever else the case schedules, of bit and rock what changes,
        and one for every output of the table of quantities, shape (rows,), SI units. With wear `active_weight_on_bit`
        is that of the sharp bit, as it is given; `eta_pi` shows what is left of it.

    Raises
    ------
    ParameterError
        If a value is out of range.
    Stopped
        If the integrator cannot go on; its `trajectory` holds the rows up to there, None if it cannot even start. Its
        cause is the `CannotContinue`.
    KernelError
        If the native engine is asked for and is not installed.

    Examples
    --------
    >>> from boreprop import paper_case, simulate
    >>> run = simulate(paper_case(), length=60.0, sample_interval=0.5)
    >>> run.row_count
    121
    >>> round(float(run["stabilizer_force[1]"].max()) / 1e3, 1)  # kN
    27.5
    """
    length = case.length if length is None else length
    check_number("length", length, above=0.0)
    check_number("sample_interval", sample_interval, above=0.0)
    if dimensions is not None:
        case = in_dimensions(case, dimensions)
    engine, course, options = chosen(engine, in_space=case.in_space), course_of(case), Options(relative_tolerance)
    drilling = start_in_space(case, options) if case.in_space else start(case, engine, options, case.ground)
    names = scalar_names(OUTPUTS, case.structure)
    outputs = np.empty((len(names), int(length / sample_interval + ROUNDING) + 1))  # a run is read column by column
    outputs[0], table = np.nan, outputs.T  # until a row is drilled
    lengths, pieces, rows = _in_parts(*_legs(course, len(table), sample_interval), LONGEST_LEG * case.bha.length_scale)
    inputs, which = acting(course, np.append(0.0, lengths[:-1]), pieces)
    opening = [name for name in course.names if name in CLEARANCES]
    failure = None
    try:
        for part in _parts(len(lengths), progress is not None, _opened(course, opening, pieces)):
            if opening:
                _change_clearances(drilling, case, course, pieces[part.start])
            drilling.follow(lengths[part], inputs, rows[part], table, which[part])
            if progress:
                progress(drilling.drilled_length)
    except CannotContinue as error:
        failure = error
    drilled = np.count_nonzero(~np.isnan(outputs[0]))
    outputs = outputs[:, :drilled]
    on_rows = rows >= 0
    at, piece = lengths[on_rows][:drilled], pieces[on_rows][:drilled]
    told = [name for name in course.names if name not in CONSTANT or course.changes(name)]
    columns = {name: course.column(name, at, piece) for name in told}
    if case.in_layers:
        columns |= rock_in_layers(case, outputs[names.index("formation")])
    stopped = f"after {drilling.drilled_length:g} m of {length:g} m: {failure}" if failure else None
    trajectory = Trajectory(columns | dict(zip(names, outputs, strict=True)), case, stopped, engine)
    if stopped:
        raise Stopped(stopped, trajectory) from failure
    return trajectory


def _parts(legs: int, reported: bool, cuts: Indices) -> Iterator[slice]:
    """The legs in `PARTS` parts, after each of which progress is reported; in one if it is not. Cut at some legs."""
    batch = legs // PARTS + 1 if reported else legs
    starts = sorted({*range(0, legs, batch), *cuts.tolist()})
    return (slice(first, end) for first, end in pairwise((*starts, legs)))


def _opened(course: Course, opening: list[str], pieces: Indices) -> Indices:
    """The legs with which others of the clearances that a course changes begin."""
    changed = np.zeros(len(pieces), dtype=bool)
    for name in opening:
        changed[1:] |= np.diff(course.values[pieces, course.names.index(name)]) != 0.0
    return np.flatnonzero(changed).astype(np.intc)


def _change_clearances(drilling: Engine, case: Case, course: Course, piece: int) -> None:
    """Let the stabilizers have the clearances of a piece of the course."""
    given = dict(zip(course.names, course.values[piece].tolist(), strict=True))
    own = zip(CLEARANCES, case.bha.stabilizer_clearances, strict=False)
    drilling.change_clearances(tuple(given.get(name, clearance) for name, clearance in own))


def _legs(course: Course, count: int, sample_interval: float) -> tuple[Floats, Indices, Indices]:
    """The ends of the legs of a run, m, the piece of the course of each, and the row on which each ends; −1 if on none.

    A leg ends at every row and, on no row, wherever another piece starts.
    """
    on_rows: Indices = np.arange(count, dtype=np.intc)
    at = sample_interval * np.arange(float(count))
    changes = course.starts[1:]
    if not changes.size:
        return at, np.zeros_like(on_rows), on_rows
    before = np.searchsorted(at + ROUNDING * sample_interval, changes)
    before = before[before < count]
    lengths = np.maximum.accumulate(np.insert(at, before, changes[: len(before)]))
    rows = np.insert(on_rows, before, -1)
    changed = rows < 0
    return lengths, (np.cumsum(changed) - changed).astype(np.intc), rows


def _in_parts(lengths: Floats, pieces: Indices, rows: Indices, longest: float) -> tuple[Floats, Indices, Indices]:
    """The same legs, each cut into parts no longer than `longest`, m. Only the last part of a leg ends on its row."""
    starts = np.concatenate([[0.0], lengths[:-1]])
    parts = int(np.ceil((lengths - starts).max() / longest))
    if parts <= 1:
        return lengths, pieces, rows
    ends = starts[:, None] + np.outer(lengths - starts, np.arange(1, parts + 1) / parts)
    ends[:, -1] = lengths
    on_rows = np.full(ends.shape, -1, dtype=np.intc)
    on_rows[:, -1] = rows
    return ends.ravel(), np.repeat(pieces, parts), on_rows.ravel()

"""What is drawn: runs that are there and runs that are being drilled, in stretches of rows with the hole around."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import chain
from time import monotonic

import numpy as np

from boreprop.analysis.axis import AXIS_REACH
from boreprop.case.case import Case
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.completion import case_of, complete
from boreprop.run.trajectory import Trajectory
from boreprop.units import BUILD_LENGTH
from boreprop_fmu.host.drive import Run

from .scene import REACH_ABOVE_BHA, Array, Hole, bit_positions, existing_hole, turning

BATCH = 1000  # rows drawn at once
PATIENCE = 0.1  # s until rows that have come are drawn


@dataclass(frozen=True)
class Stretch:
    """Consecutive rows of a run with what the hole says of them, and the hole around them."""

    rows: Trajectory  # with the columns of `hole_columns`
    hole: Hole  # reaches far enough behind the first row


@dataclass(frozen=True)
class Source:
    """A run to be drawn.

    Parameters
    ----------
    name
        What it is called beside others.
    case
        What is drilled.
    rows
        How many there will be.
    beginning
        The whole run, or its first rows if it is `live`.
    live
        Whether it is being drilled while it is drawn.
    stretches
        The whole run in pieces, once.
    """

    name: str
    case: Case
    rows: int
    beginning: Trajectory
    live: bool
    stretches: Iterator[Stretch]

    def likely_positions(self) -> Array:
        """Where the bit comes along: known, or guessed to go straight on from the survey, (N, 2)."""
        if not self.live:
            return bit_positions(self.beginning)
        inclination = self.case.survey.inclination[-1]
        return np.outer([0.0, self.case.length], [np.sin(inclination), np.cos(inclination)])


def stored(name: str, run: Trajectory, plan: Survey | None = None) -> Source:
    """A run that is there; `InputError` if it lacks its case or a column, or its drilled length decreases."""
    length = run["drilled_length"]
    back = np.flatnonzero(np.diff(length) < 0.0)
    if back.size:
        raise InputError(f"drilled_length: row {back[0] + 2}: must not decrease, got {length[back[0] + 1]:g}")
    run = complete(run)
    case = case_of(run)
    [whole] = stretches([run], case, plan)
    return Source(name, case, run.row_count, whole.rows, live=False, stretches=pieces(whole))


def live(name: str, run: Run, plan: Survey | None = None) -> Source:
    """A run that an FMU drills; `InputError` if the FMU has no case in it, lacks a column or fails at the start."""
    if run.case is None:
        raise InputError(f"{run.fmu}: must hold its case, as ours do, got an FMU without")
    coming = stretches(gather(run), run.case, plan)
    first = next(coming)
    return Source(name, run.case, len(run), first.rows, live=True, stretches=chain([first], coming))


def gather(run: Run) -> Iterator[Trajectory]:
    """The rows of a run as they come, by the batch or every tenth of a second."""
    rows: list[list[float]] = []
    due = 0.0  # the first row comes at once
    for row in run:
        rows.append(row)
        if len(rows) == BATCH or monotonic() > due:
            yield _table(run, rows)
            rows, due = [], monotonic() + PATIENCE
    if rows:
        yield _table(run, rows)


def _table(run: Run, rows: list[list[float]]) -> Trajectory:
    return Trajectory(dict(zip(run.columns, np.array(rows).T.copy(), strict=True)), run.case)


def stretches(runs: Iterable[Trajectory], case: Case, plan: Survey | None) -> Iterator[Stretch]:
    """Consecutive rows with the hole behind them; no more of it is kept than what is drawn of the next rows needs."""
    half = case.bha.half_length
    reach = max(2 * REACH_ABOVE_BHA * half, BUILD_LENGTH + half, 2 * AXIS_REACH * half) + half
    hole = existing_hole(case.survey, reach, spacing=half / 25)
    for rows in runs:
        length = rows["drilled_length"]
        hole = hole.followed_by(length, bit_positions(rows))
        yield Stretch(replace(rows, columns=rows.columns | hole_columns(length, hole, case, plan)), hole)
        hole = hole.since(float(length[-1]) - reach)


def hole_columns(length: Array, hole: Hole, case: Case, plan: Survey | None) -> dict[str, Array]:
    """What the hole behind the bit says: its build rate, its dogleg severity, rad/m, and what is planned, rad."""
    half = case.bha.half_length
    columns = {
        "build_rate": turning(hole, length, over=BUILD_LENGTH, chord=half),
        "dogleg_severity": np.abs(turning(hole, length, over=half, chord=half)),
    }
    if plan is not None:
        depth = case.survey.measured_depth[-1] + length
        planned = np.interp(depth, plan.measured_depth, plan.inclination, left=np.nan, right=np.nan)
        columns["planned_inclination"] = planned
    return columns


def pieces(whole: Stretch) -> Iterator[Stretch]:
    """A stretch in batches."""
    for first in range(0, whole.rows.row_count, BATCH):
        columns = {name: column[first : first + BATCH] for name, column in whole.rows.columns.items()}
        yield replace(whole, rows=replace(whole.rows, columns=columns))

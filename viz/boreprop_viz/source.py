"""The sources of what is drawn: stored and live runs, as stretches of consecutive rows with the hole behind them."""

from collections.abc import Callable, Iterable, Iterator, Sequence, Sized
from dataclasses import dataclass, replace
from itertools import chain
from time import monotonic, sleep
from typing import Protocol

import numpy as np

from boreprop.analysis.axis import AXIS_REACH
from boreprop.analysis.hole import HoleAxis, SurveyedHole, bit_positions, existing_hole, turning
from boreprop.analysis.hole_in_space import directions, is_in_space, positions_in_space
from boreprop.analysis.plan import deviation_from
from boreprop.analysis.plan_in_space import DeviationInSpace, deviation_in_space, planned_in_space
from boreprop.analysis.turning import dogleg_severity, existing_in_space, turning_in_space
from boreprop.case.case import Case
from boreprop.core.survey import Survey
from boreprop.errors import BorepropError, InputError
from boreprop.run.completion import case_of, complete, complete_rows
from boreprop.run.trajectory import Trajectory
from boreprop.units import BUILD_LENGTH

from .scene import REACH_ABOVE_BHA, Array

BATCH = 1000  # rows drawn at once, which limits memory
POINTS_IN_HALF = 25  # points of the existing hole over half the length of the BHA: its curve looks smooth
PATIENCE = 0.1  # s after which the rows of a live run are drawn though there are fewer: longer would look like stalling
DRAWN = (
    *("drilled_length", "displacement", "true_vertical_depth", "bit_inclination", "borehole_inclination", "bit_tilt"),
    *("bit_tilt_saturation", "average_inclination", "stabilizer_force", "stabilizer_contact", "rss_force"),
)  # the quantities without which there is no picture


class LiveRun(Protocol):
    """A run that is drilled while it is drawn: iterating over it drills, and gives one row after the other.

    If it has a length, that is the number of rows to come.
    """

    @property
    def case(self) -> Case | None:
        """What is drilled."""

    @property
    def columns(self) -> Sequence[str]:
        """The names of the values of a row; they are names of columns of a `Trajectory`."""

    def __iter__(self) -> Iterator[Sequence[float] | None]:
        """Drill; a None says that there is no row for the moment. `InputError` if drilling fails."""


@dataclass(frozen=True)
class Stretch:
    """Consecutive rows of a run, and the hole behind the bit."""

    rows: Trajectory  # has the columns of `hole_columns`, too
    hole: HoleAxis  # reaches as far behind the first row as drawing it needs


@dataclass(frozen=True)
class Source:
    """A run to be drawn.

    Parameters
    ----------
    name
        Its name, shown if there are several runs.
    case
        What is drilled.
    row_count
        The number of rows that it will have; None if that is not known.
    beginning
        The whole run, or its first rows if it is `live`.
    live
        Whether it is being drilled while it is drawn.
    stretches
        Iterates over the whole run, once.
    """

    name: str
    case: Case
    row_count: int | None
    beginning: Trajectory
    live: bool
    stretches: Iterator[Stretch]

    def likely_positions(self) -> Array:
        """Positions of the bit, (N, 2). Those of a live run are expected straight on from the end of the survey."""
        if not self.live:
            return bit_positions(self.beginning)
        inclination = self.case.survey.inclination[-1]
        return np.outer([0.0, self.case.length], [np.sin(inclination), np.cos(inclination)])

    @property
    def spatial(self) -> bool:
        """Whether it may leave its vertical plane."""
        return is_in_space(self.beginning)

    def likely_positions_in_space(self) -> Array:
        """Positions of the bit of a run in space, (N, 3), as `likely_positions` gives them in the plane."""
        rows = self.beginning
        if not self.live:
            return positions_in_space(rows)
        return np.outer([0.0, self.case.length], directions(rows["bit_inclination"][:1], rows["bit_azimuth"][:1]))


def stored(name: str, run: Trajectory, plan: Survey | None = None, *, batch: int = BATCH) -> Source:
    """The source of a complete run.

    Parameters
    ----------
    name
        Its name, shown if there are several runs.
    run
        The run with its case.
    plan
        The planned hole, with measured depths as in the survey.
    batch
        Number of rows drawn at once.

    Raises
    ------
    InputError
        If the run lacks its case or a column, or its drilled length decreases.
    """
    length = run["drilled_length"]
    back = np.flatnonzero(np.diff(length) < 0.0)
    if back.size:
        raise InputError(f"drilled_length: row {back[0] + 2}: must not decrease, got {length[back[0] + 1]:g}")
    run = complete(run)
    case = case_of(run)
    [whole] = (stretches_in_space if is_in_space(run) else stretches)([run], case, plan)
    return Source(name, case, run.row_count, whole.rows, live=False, stretches=pieces(whole, batch))


def live(
    name: str, run: LiveRun, plan: Survey | None = None, *, pace: float | None = None, batch: int = BATCH
) -> Source:
    """The source of a run that is drilled while it is drawn.

    Parameters
    ----------
    name, plan
        As in `stored`.
    run
        The run; drilling begins now. Columns that it lacks are computed from the others as far as each row determines
        them.
    pace
        Seconds of simulation per second of the clock: no row is drawn before it is due. None: as fast as they come.
    batch
        Largest number of rows drawn at once; fewer are drawn if no more have come after a tenth of a second.

    Raises
    ------
    InputError
        If the run has no case, lacks a column or fails at the start.
    """
    if run.case is None:
        raise InputError(f"{name}: must come with its case, as the FMUs of boreprop-fmu do, got none")
    rows = run if pace is None else paced(run, run.columns.index("time"), pace)
    trajectories = (rows_of(run.case, run.columns, some) for some in gather(rows, batch))
    coming = (stretches_in_space if "north" in run.columns else stretches)(trajectories, run.case, plan)
    first = next(coming)
    row_count = len(run) if isinstance(run, Sized) else None
    return Source(name, run.case, row_count, first.rows, live=True, stretches=chain([first], coming))


def paced(
    rows: Iterable[Sequence[float] | None],
    time: int,
    pace: float,
    clock: Callable[[], float] = monotonic,
    pause: Callable[[float], None] = sleep,
) -> Iterator[Sequence[float] | None]:
    """Rows, each given when it is due.

    Parameters
    ----------
    rows
        The rows, as of a `LiveRun`.
    time
        The place of the time in a row.
    pace
        Seconds of simulation per second of the clock, which starts when the second row is asked for: the viewer may
        take some seconds to start with the first one.
    clock, pause
        What tells the time, s, and what waits for some seconds.
    """
    begin = None  # what the clock shows at time 0
    for row in rows:
        if row is not None and begin is not None and (early := begin + row[time] / pace - clock()) > 0.0:
            pause(early)
        yield row
        if row is not None and begin is None:
            begin = clock() - row[time] / pace


def gather(coming: Iterable[Sequence[float] | None], batch: int) -> Iterator[list[Sequence[float]]]:
    """The rows of a run in batches, of fewer rows if no more have come after a tenth of a second, or ever will."""
    rows: list[Sequence[float]] = []
    due = 0.0  # the first row comes at once
    try:
        for row in coming:
            if row is not None:
                rows.append(row)
            if rows and (len(rows) == batch or monotonic() > due):
                yield rows
                rows, due = [], monotonic() + PATIENCE
    except (BorepropError, KeyboardInterrupt):
        if rows:
            yield rows
        raise
    if rows:
        yield rows


def rows_of(case: Case, columns: Sequence[str], rows: Sequence[Sequence[float]]) -> Trajectory:
    """Some rows of a live run, with its case and all columns that are drawn; `MissingColumn` if one cannot be had."""
    given = Trajectory(dict(zip(columns, np.array(rows, dtype=float).T.copy(), strict=True)), case)
    completed = complete_rows(given)
    for name in DRAWN:
        completed.stack(name)  # raises if it is missing
    return completed


def stretches(runs: Iterable[Trajectory], case: Case, plan: Survey | None) -> Iterator[Stretch]:
    """Add the hole behind them to consecutive rows. No more hole is kept than drawing the next rows needs."""
    half = case.bha.half_length
    reach = reach_behind(half)
    hole = existing_hole(case.survey, reach, spacing=half / POINTS_IN_HALF)
    planned = None if plan is None else SurveyedHole.of(plan, case.survey.measured_depth[-1])
    for rows in runs:
        length = rows["drilled_length"]
        hole = hole.followed_by(length, bit_positions(rows))
        yield Stretch(replace(rows, columns=rows.columns | hole_columns(length, hole, half, planned)), hole)
        hole = hole.since(float(length[-1]) - reach)


def stretches_in_space(runs: Iterable[Trajectory], case: Case, plan: Survey | None) -> Iterator[Stretch]:
    """Add the hole behind them to consecutive rows of a run in space, as `stretches` does in the plane."""
    half = case.bha.half_length
    hole: HoleAxis | None = None
    planned = None if plan is None else planned_in_space(plan, case.survey)
    for rows in runs:
        if hole is None:
            hole = existing_in_space(case.survey, reach_behind(half), half / POINTS_IN_HALF)
        length = rows["drilled_length"]
        hole = hole.followed_by(length, positions_in_space(rows))
        build, walk = turning_in_space(hole, length, over=BUILD_LENGTH, chord=half)
        severity = dogleg_severity(hole, length, over=half)
        columns = {"build_rate": build, "walk_rate": walk, "dogleg_severity": severity}
        if planned is not None:
            columns |= columns_off_plan(deviation_in_space(planned, hole, length, half))
        yield Stretch(replace(rows, columns=rows.columns | columns), hole)
        hole = hole.since(float(length[-1]) - reach_behind(half))


def columns_off_plan(off: DeviationInSpace) -> dict[str, Array]:
    """What there is to say of the plan of a run in space."""
    return {
        "planned_inclination": off.planned_inclination,
        "planned_azimuth": off.planned_azimuth,
        "distance_from_plan": off.distance,
        "distance_from_plan_high": off.high,
        "distance_from_plan_right": off.right,
        "inclination_less_plan": off.inclination,
        "azimuth_less_plan": off.azimuth,
    }


def reach_behind(half: float) -> float:
    """The length of hole behind a row that drawing it needs, m, for half the length of a BHA, m."""
    return max(2 * REACH_ABOVE_BHA * half, BUILD_LENGTH + half, 2 * AXIS_REACH * half) + half


def hole_columns(length: Array, hole: HoleAxis, half: float, plan: SurveyedHole | None) -> dict[str, Array]:
    """Build rate and dogleg severity of the hole behind the bit, rad/m, and what there is to say of the plan.

    These are the planned inclination, rad, and how far the hole is off the plan: the distance, m, positive to the high
    side, and the difference of the inclinations, rad; nan where the plan does not reach. `half` is half the length of
    the BHA, m, over which inclinations are averaged.
    """
    columns = {
        "build_rate": turning(hole, length, over=BUILD_LENGTH, chord=half),
        "dogleg_severity": np.abs(turning(hole, length, over=half, chord=half)),
    }
    if plan is not None:
        off = deviation_from(plan, hole, length, half)
        columns["planned_inclination"] = np.where(np.isnan(off.distance), np.nan, plan.inclination_at(length))
        columns["distance_from_plan"] = off.distance
        columns["inclination_less_plan"] = off.inclination
    return columns


def pieces(whole: Stretch, batch: int) -> Iterator[Stretch]:
    """A stretch cut into stretches of `batch` rows."""
    for first in range(0, whole.rows.row_count, batch):
        columns = {name: column[first : first + batch] for name, column in whole.rows.columns.items()}
        yield replace(whole, rows=replace(whole.rows, columns=columns))


def joined(before: Trajectory, after: Trajectory) -> Trajectory:
    """Rows of a run and those that follow."""
    columns = {name: np.concatenate((before.columns[name], values)) for name, values in after.columns.items()}
    return Trajectory(columns, after.case)


def between(rows: Trajectory, low: float, high: float) -> Trajectory:
    """Those rows of a run that lie between two drilled lengths, m, both included."""
    length = rows["drilled_length"]
    kept = slice(int(np.searchsorted(length, low)), int(np.searchsorted(length, high, side="right")))
    return Trajectory({name: values[kept] for name, values in rows.columns.items()}, rows.case)

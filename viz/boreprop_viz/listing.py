"""The listing of each hole at survey stations."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import rerun as rr

from boreprop.analysis.plan_in_space import plan_of
from boreprop.analysis.stations import list_stations
from boreprop.analysis.summary import averaging_length
from boreprop.core.survey import Survey
from boreprop.report.tables.stations import caption, headings, lines
from boreprop.run.trajectory import Trajectory
from boreprop.units import BUILD_LENGTH

from .card import plain
from .scene import Array
from .source import Source
from .verdict import Verdict

STATIONS = "stations"
AXIS_IN_SPACE = ("drilled_length", "displacement", "true_vertical_depth", "north", "east")
AXIS = ("drilled_length", "displacement", "true_vertical_depth")  # the columns that a listing needs


class Listing:
    """Logs a table of each hole at survey stations, when its run has ended; the tables stand under one another."""

    def __init__(self, rec: rr.RecordingStream, plan: Survey | None) -> None:
        self.rec, self.plan = rec, plan
        self.tables: list[str] = []

    @contextmanager
    def listed(self, source: Source, verdict: Verdict) -> Iterator[Callable[[Trajectory], None]]:
        """Give a function that takes the rows of a run, and log its table when the block ends."""
        drilled: list[list[Array]] = []
        names = AXIS_IN_SPACE if source.spatial else AXIS
        try:
            yield lambda rows: drilled.append([rows[name] for name in names])
        finally:
            if drilled:
                columns = dict(zip(names, map(np.concatenate, zip(*drilled, strict=True)), strict=True))
                self._log(source, Trajectory(columns, source.case), verdict)

    def _log(self, source: Source, run: Trajectory, verdict: Verdict) -> None:
        plan = None if self.plan is None else plan_of(run, self.plan)
        over = averaging_length(source.case.bha, verdict.told)
        found = list_stations(run, BUILD_LENGTH, plan, averaged_over=over)
        heading = [[text.replace("\n", " ") for text in headings(found)], ["---:"] * len(headings(found))]
        rows = "\n".join(f"| {' | '.join(row)} |" for row in [*heading, *lines(found)])
        self.tables.append(f"**{plain(source.name)}**\n\n{rows}\n\n{caption(found)}")
        text = rr.TextDocument("\n\n".join(self.tables), media_type=rr.MediaType.MARKDOWN)
        self.rec.log(STATIONS, text, static=True)

"""Draws a run into a recording, stretch by stretch."""

import numpy as np

from boreprop.analysis.rippling import find_rippling
from boreprop.run.trajectory import Trajectory

from .card import in_words
from .entities import (
    log_bha,
    log_bha_in_section,
    log_bit,
    log_contacts,
    log_drilled_hole,
    log_existing_hole,
    log_forces,
    log_modes,
    log_plots,
    log_ripple,
    log_stabilizers,
    log_tilt,
    log_tilt_limits,
    log_walls,
)
from .furniture import log_styles
from .scene import BitFrame
from .source import Stretch
from .track import Track

RECENT = 32.0  # half lengths of the BHA up to the bit that decide whether the hole ripples: five of the longest waves


class RunStream:
    """Draws the stretches of a run one after the other."""

    def __init__(self, track: Track) -> None:
        self.track = track
        self.frame = BitFrame(track.case)
        self.drilled: float | None = None  # drilled length up to which the hole is drawn, m
        self.rippled = -np.inf  # drilled length up to which its ripple is drawn, m
        self.modes: dict[str, float] = {}  # the last value of each lane
        self.recent: Trajectory | None = None  # the last rows, which decide whether the hole ripples
        log_styles(track)

    def send(self, stretch: Stretch) -> None:
        """Log the next rows of the run."""
        if self.drilled is None:
            self.drilled = float(stretch.rows["drilled_length"][0])
            log_existing_hole(self.track, stretch.hole, self.drilled)
        log_drilled_hole(self.track, stretch, self.drilled)
        self.drilled = float(stretch.rows["drilled_length"][-1])
        rows = stretch.rows if self.recent is None else _joined(self.recent, stretch.rows)
        self.recent = _last(rows, RECENT * self.track.case.bha.half_length)
        shapes = self.frame.shapes(stretch.rows, stretch.hole)
        for log in (
            log_bha_in_section,
            log_walls,
            log_bha,
            log_bit,
            log_tilt,
            log_stabilizers,
            log_contacts,
            log_forces,
            log_plots,
            log_tilt_limits,
        ):
            log(self.track, shapes)
        self.rippled = log_ripple(self.track, stretch, rows, self.rippled)
        self.modes = log_modes(self.track, stretch, self.modes)

    def finding(self) -> str:
        """Whether the hole ripples near the bit, in words; empty before the first rows."""
        return in_words(find_rippling(self.recent)) if self.recent else ""


def _joined(before: Trajectory, after: Trajectory) -> Trajectory:
    """Rows of a run and those that follow."""
    columns = {name: np.concatenate((before.columns[name], values)) for name, values in after.columns.items()}
    return Trajectory(columns, after.case)


def _last(rows: Trajectory, length: float) -> Trajectory:
    """The last rows of a run, over `length` m."""
    first = int(np.searchsorted(rows["drilled_length"], rows["drilled_length"][-1] - length))
    return Trajectory({name: values[first:] for name, values in rows.columns.items()}, rows.case)

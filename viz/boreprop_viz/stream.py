"""Draws a run into a recording, stretch by stretch."""

from dataclasses import replace

import numpy as np

from .entities import (
    find_ripple,
    log_bha,
    log_bit,
    log_body,
    log_contacts,
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
from .scales import Scales
from .scene import BitFrame
from .section import DrilledHole, log_bha_in_section, log_existing_hole
from .source import Stretch, joined
from .strip import log_strip
from .track import Track
from .verdict import Saying, Verdict


class RunStream:
    """Draws the stretches of a run one after the other."""

    def __init__(self, track: Track) -> None:
        self.track = track
        self.frame = BitFrame(track.case)
        self.begin = 0.0  # drilled length at the first row, m
        self.hole: DrilledHole | None = None  # from the first rows on
        self.rippled = -np.inf  # drilled length up to which its ripple is drawn, m
        self.verdict = Verdict(track.case, track.scales.start or 0.0)
        log_styles(track)

    def rescale(self, scales: Scales) -> None:
        """Draw what follows for views that have become wider."""
        self.track = replace(self.track, scales=scales)
        if self.hole is not None:
            self.hole.track = self.track

    def send(self, stretch: Stretch) -> list[Saying]:
        """Log the next rows of the run; returns what there is to say of its ripple."""
        if self.hole is None:
            self.begin = float(stretch.rows["drilled_length"][0])
            log_existing_hole(self.track, stretch.hole, self.begin)
            self.hole = DrilledHole(self.track, self.begin)
        rows = stretch.rows if self.verdict.rows is None else joined(self.verdict.rows, stretch.rows)
        self.hole.log(stretch, rows)
        shapes = self.frame.shapes(stretch.rows, stretch.hole)
        for log in (
            log_bha_in_section,
            log_walls,
            log_bha,
            log_body,
            log_bit,
            log_tilt,
            log_stabilizers,
            log_contacts,
            log_forces,
        ):
            log(self.track, shapes)
        for log_curves in (log_plots, log_tilt_limits):
            log_curves(self.track, stretch.rows)
        length, ripple = find_ripple(self.track, stretch, self.begin, self.rippled)
        for log_along in (log_ripple, log_strip):
            log_along(self.track, rows, length, ripple, self.rippled)
        self.rippled = max([self.rippled, *length[-1:]])
        log_modes(self.track, rows, stretch.rows.row_count)
        return self.verdict.follow(replace(stretch.rows, columns=stretch.rows.columns | shapes.outside))

"""Draws a run into a recording, stretch by stretch."""

import numpy as np

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
from .source import Stretch, joined
from .track import Track
from .verdict import Saying, Verdict


class RunStream:
    """Draws the stretches of a run one after the other."""

    def __init__(self, track: Track) -> None:
        self.track = track
        self.frame = BitFrame(track.case)
        self.drilled: float | None = None  # drilled length up to which the hole is drawn, m
        self.rippled = -np.inf  # drilled length up to which its ripple is drawn, m
        self.modes: dict[str, float] = {}  # the last value of each lane
        self.verdict = Verdict(track.case, track.scales.start or 0.0)
        log_styles(track)

    def send(self, stretch: Stretch) -> list[Saying]:
        """Log the next rows of the run; returns what there is to say of its ripple."""
        if self.drilled is None:
            self.drilled = float(stretch.rows["drilled_length"][0])
            log_existing_hole(self.track, stretch.hole, self.drilled)
        log_drilled_hole(self.track, stretch, self.drilled)
        self.drilled = float(stretch.rows["drilled_length"][-1])
        rows = stretch.rows if self.verdict.rows is None else joined(self.verdict.rows, stretch.rows)
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
        return self.verdict.follow(stretch.rows)

"""Draws a run in space into a recording, stretch by stretch."""

from dataclasses import replace

from boreprop.analysis.hole import HoleAxis

from .entities import log_modes, log_plots, log_tilt_limits
from .scales import Scales
from .section import DrilledHole, log_existing_hole
from .source import Stretch, joined
from .space_entities import (
    DrilledTube,
    log_bha_in_hole,
    log_body_across,
    log_ripple_in_space,
    log_stabilizers_across,
    log_tilt_across,
    log_toolface,
    log_upright,
    projections,
)
from .space_furniture import log_styles_in_space
from .space_scales import SpaceScales
from .space_scene import Discs
from .track import Track
from .verdict import Saying, Verdict


class SpaceStream:
    """Draws the stretches of a run in space one after the other."""

    def __init__(self, track: Track, space: SpaceScales) -> None:
        self.track, self.space = track, space
        self.begin = 0.0  # drilled length at the first row, m
        self.holes: dict[str, DrilledHole] = {}  # by view, from the first rows on
        self.tube: DrilledTube | None = None
        self.rippled = float("-inf")  # drilled length up to which its ripple is drawn, m
        self.verdict = Verdict(track.case, track.scales.start or 0.0)
        log_styles_in_space(track)

    def rescale(self, scales: Scales) -> None:
        """Draw what follows for views that have become wider."""
        self.track = replace(self.track, scales=scales)
        self.space = scales.space or self.space
        for hole in self.holes.values():
            hole.track = self.track

    def send(self, stretch: Stretch) -> list[Saying]:
        """Log the next rows of the run; returns what there is to say of its ripple."""
        views = {
            view: replace(stretch, hole=HoleAxis(stretch.hole.length, project(stretch.hole.position)))
            for view, project in projections(self.space).items()
        }
        if self.tube is None:
            self.begin = float(stretch.rows["drilled_length"][0])
            self.tube = DrilledTube(self.track, self.begin)
            for view, seen in views.items():
                log_existing_hole(self.track, seen.hole, self.begin, view)
                self.holes[view] = DrilledHole(self.track, self.begin, view)
        rows = stretch.rows if self.verdict.rows is None else joined(self.verdict.rows, stretch.rows)
        for view, hole in self.holes.items():
            hole.log(views[view], rows)
        self.tube.log(stretch, rows)
        log_bha_in_hole(self.track, self.space, stretch)
        discs = Discs(self.track.case, stretch.rows)
        for log in (log_stabilizers_across, log_body_across, log_tilt_across, log_toolface, log_upright):
            log(self.track, self.space, discs)
        for log_curves in (log_plots, log_tilt_limits):
            log_curves(self.track, self.space.plotted(stretch.rows))
        self.rippled = log_ripple_in_space(self.track, self.space, stretch, rows, self.begin, self.rippled)
        log_modes(self.track, rows, stretch.rows.row_count)
        return self.verdict.follow(stretch.rows)

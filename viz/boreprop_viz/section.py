"""Logs the vertical section: the hole, coloured by its dogleg severity, and the BHA in it, at true scale.

The view is in metres with y down the screen.
"""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from boreprop.analysis.hole import HoleAxis, bit_positions
from boreprop.run.trajectory import Trajectory
from boreprop.units import UNITS

from .furniture import log_labels, metres
from .scales import Scales
from .scene import REACH_ABOVE_BHA, Array, Shapes
from .source import Stretch
from .style import BY_SEVERITY, BY_STABILIZER
from .track import Indices, Track, arrivals, consecutive, moments, points, send, send_paths, send_strips

POINTS_IN_HALF = 20  # of the drawn hole over half the length of the BHA, at most: a wave shows no corners
POINTS_IN_PIECE = 20  # of it: the fewer pieces, the sooner the view is drawn, see benchmarks/viewer_seek.py
FLAT = 2.5  # horizontal over vertical length of a hole that has its measured depths above and below, not aside
DEPTH_ASIDE = 0.22  # of the width of the view, from the hole to the middle of a measured depth beside it
HALF_DEPTH = 0.14  # of its width: half the width of one
DEPTH_ABOVE, TEXT = 0.05, 0.025  # of its height, from a flat hole to the middle of one, and half a line of text
SWATCH = 0.055  # height of a colour of the key over that of the view, which is a line of text with some room


def log_existing_hole(track: Track, hole: HoleAxis, start: float, view: str = "vertical_section") -> None:
    """The existing hole in a view, up from where drilling starts, for at least the length of the BHA."""
    bha = track.case.bha.stabilizer_positions[-1]
    surveyed = track.case.survey.measured_depth[-1] - track.case.survey.measured_depth[0]
    behind = hole.since(start - max(REACH_ABOVE_BHA * bha, surveyed))
    there = behind.position[behind.length <= start]
    strips = rr.LineStrips2D if there.shape[1] == 2 else rr.LineStrips3D
    track.rec.log(track.entity(f"{view}/existing_hole"), strips.from_fields(strips=[there]), static=True)


class DrilledHole:
    """Logs the drilled hole of a run in pieces, of which the view shows those up to its cursor.

    Each piece is logged where it ends, and up to there what is drilled of it, for each row. In the vertical section the
    measured depths are beside it.
    """

    def __init__(self, track: Track, start: float, view: str = "vertical_section") -> None:
        self.track, self.view = track, view
        self.apart = track.case.bha.half_length / POINTS_IN_HALF
        self.start = start  # drilled length at the first row, m
        self.begun = start  # drilled length at which the current piece begins, m
        self.drilled = start  # drilled length up to which the hole is logged, m
        self.step = track.scales.section.grid_step  # between two depths that are shown beside the hole, m
        self.places = np.empty((0, 5))  # depths at powers of ten; where the hole is there, and half a BHA before, m

    def log(self, stretch: Stretch, recent: Trajectory) -> None:
        """Log the hole that some rows drill; `recent` are these and those over half the length of the BHA before."""
        hole = stretch.hole.since(self.begun).until(stretch.rows["drilled_length"][-1])
        interval = ((hole.length - self.start) // self.apart).astype(np.int64)
        drawn = np.flatnonzero(np.diff(interval, prepend=-1))  # the first points in each interval
        ends = np.flatnonzero(np.diff(interval // POINTS_IN_PIECE, prepend=-1))
        at_ends = np.searchsorted(drawn, ends)
        count = np.diff(at_ends) + 1
        self._send("drilled_hole", hole, drawn[consecutive(at_ends[:-1], count)], count, recent)

        new = np.flatnonzero(hole.length > self.drilled)
        first = at_ends[np.searchsorted(ends, new, side="right") - 1]
        count = np.searchsorted(drawn, new) - first + 1
        through = np.append(drawn, 0)[consecutive(first, count)]
        through[np.cumsum(count) - 1] = new  # each row ends where its bit is
        self._send("newly_drilled", hole, through, count, recent)
        if self.view == "vertical_section":
            self._log_depths(stretch.hole, hole.length[-1], recent)
        self.begun, self.drilled = hole.length[ends[-1]], hole.length[-1]

    def _send(self, thing: str, hole: HoleAxis, through: Indices, count: Indices, recent: Trajectory) -> None:
        """Send strips through points of the hole, `count` of them each, where the last of these is drilled."""
        ends = hole.length[through[np.cumsum(count) - 1]]
        colours = None if self.track.colour else severity_colours(self.track, recent, ends)
        at, path = arrivals(recent, ends), hole.position[through]
        send_paths(self.track, f"{self.view}/{thing}", at, path, count, colours)

    def _log_depths(self, hole: HoleAxis, last: float, recent: Trajectory) -> None:
        """The round measured depths down to each that is reached, beside the hole; of one run alone.

        They are at the side of a steep hole, and by turns above and below a flat one. When the view has become wider,
        fewer of them are shown.
        """
        start, step = self.track.scales.start, self.track.scales.section.grid_step
        if start is None or self.track.place:
            return
        fine = 10.0 ** np.floor(np.log10(step))
        reached = fine * np.arange(np.floor((start + self.drilled) / fine) + 1, np.floor((start + last) / fine) + 1)
        there, before = hole.at(reached - start), hole.at(reached - start - POINTS_IN_HALF * self.apart)
        self.places = np.concatenate((self.places, np.column_stack((reached, there, before))))
        shown = self.places[np.isclose(self.places[:, 0], step * np.rint(self.places[:, 0] / step))]
        new = shown[:, 0] > start + self.drilled
        ends, count = shown[new, 0] - start, 1 + np.flatnonzero(new)
        if step != self.step:
            self.step, ends, count = step, np.append(ends, last), np.append(count, len(shown))
        shown = shown[consecutive(np.zeros_like(count), count)]
        depth, x, y, x_before, y_before = shown.T
        (left, right), (top, bottom) = self.track.scales.section.x, self.track.scales.section.y
        side = np.where(x < 0.6 * left + 0.4 * right, 1.0, -1.0)  # that on which there is room
        turn = np.where(np.rint(depth / step) % 2 == 0, 1.0, -1.0)
        flat = np.abs(x - x_before) > FLAT * np.abs(y - y_before)
        aside = np.where(flat, 0.0, side * DEPTH_ASIDE * (right - left))
        above = np.where(flat, turn * DEPTH_ABOVE * (bottom - top), 0.0) - TEXT * (bottom - top) * flat
        room = HALF_DEPTH * (right - left)
        beside = points(np.clip(x + aside, left + room, right - room), y + above)
        labels = rr.Points2D.columns(positions=beside, labels=[f"MD {metres(value)} m" for value in depth])
        send(self.track, "vertical_section/depths", arrivals(recent, ends), labels.partition(count))


def severity_colours(track: Track, rows: Trajectory, ends: Array) -> NDArray[np.uint8]:
    """The colours for the largest dogleg severity over half the length of the BHA up to each drilled length, (k, 3).

    The severity where the hole ends would go up and down with every wave of a ripple.
    """
    length, severity = rows["drilled_length"], np.append(rows["dogleg_severity"], 0.0)
    last = np.searchsorted(length, ends, side="right")
    first = np.minimum(np.searchsorted(length, ends - track.case.bha.half_length), last - 1)
    largest = np.maximum.reduceat(severity, np.column_stack((first, last)).ravel())[::2]
    of_key = np.searchsorted(track.scales.severities, UNITS["rad/m"].factor * largest, side="right")
    return np.array(BY_SEVERITY, dtype=np.uint8)[of_key]


def log_severities(rec: rr.RecordingStream, scales: Scales) -> None:
    """The colours of the dogleg severity at the top right, and the values between them."""
    (left, right), (top, bottom) = scales.section.x, scales.section.y
    width, height = right - left, bottom - top
    down = top + height * SWATCH * (1.8 + np.arange(len(BY_SEVERITY) + 1))
    ends = np.stack((down[:-1], down[1:]), axis=1)
    swatches = rr.LineStrips2D(
        list(points(right - 0.17 * width, ends)), colors=BY_SEVERITY, radii=rr.Radius.ui_points(4.0), draw_order=1.0
    )
    rec.log("vertical_section/severities", swatches, static=True)
    labels = [f"dogleg {UNITS['rad/m'].shown}"] + [f"{severity:g}" for severity in scales.severities]
    above = height * SWATCH * np.array([1.3] + [0.5] * len(scales.severities))
    aside = width * np.array([0.22] + [0.07] * len(scales.severities))  # the heading is wider than the numbers
    log_labels(rec, "vertical_section/severities/labels", points(right - aside, down[:-1] - above), labels)


def log_bha_in_section(track: Track, shapes: Shapes) -> None:
    """The BHA with its stabilizers, where the wall pushes on them, and the bit."""
    at = moments(shapes.rows)
    send_strips(track, "vertical_section/bha", at, shapes.bha_in_section[:, None])
    send_strips(track, "vertical_section/stabilizers", at, shapes.blades_in_section)
    contacts = shapes.contacts_in_section
    there = np.isfinite(contacts[..., 0])
    colours = np.array(track.shades(BY_STABILIZER[: there.shape[1]]), dtype=np.uint8)
    dots = rr.Points2D.columns(positions=contacts[there], colors=colours[np.nonzero(there)[1]])
    send(track, "vertical_section/contacts", at, dots.partition(there.sum(axis=1)))
    send(track, "vertical_section/bit", at, rr.Points2D.columns(positions=bit_positions(shapes.rows)))

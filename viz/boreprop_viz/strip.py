"""Logs the strip: the whole hole down the screen, straightened, with its ripple to the side.

The view is in metres with y, the measured depth or the drilled length, down the screen. The high side is to the right,
and the lateral axis is multiplied by the factor that the view's name gives. Several runs are side by side.
"""

import numpy as np
import rerun as rr

from boreprop.analysis.axis import AXIS_POINTS
from boreprop.run.trajectory import Trajectory
from boreprop.units import SMALL_LENGTH

from .furniture import log_labels, metres
from .scales import STRIP_TOP, Scales
from .scene import Array, round_down
from .track import Track, arrivals, consecutive, points, send_paths

PIECE = AXIS_POINTS // 2  # points of the ripple in one piece of the hole: half a width of the trend
DRAWN = PIECE // 4  # every so many of these one is drawn, and the crests of the waves
TEXT = 0.03  # height of a line of text over that of the view


def log_strip(track: Track, recent: Trajectory, length: Array, ripple: Array, rippled: float) -> None:
    """The ripple, m, at whole multiples of an even spacing of drilled length, in pieces that end beyond `rippled`, m.

    The view shows the pieces up to its cursor. `recent` are the last rows of the run, back to these lengths.
    """
    if len(length) <= PIECE:
        return
    number = np.rint(length / (length[1] - length[0])).astype(np.int64)
    steps = np.diff(ripple)
    crest = np.concatenate(([False], steps[:-1] * steps[1:] < 0.0, [False]))
    drawn = np.flatnonzero(crest | (number % DRAWN == 0))
    ends = np.flatnonzero((number % PIECE == 0) & (length > rippled))
    ends = ends[ends >= PIECE]
    first, last = np.searchsorted(drawn, [ends - PIECE, ends])
    strip = track.scales.strip
    path = points(strip.lanes[track.place] + strip.lateral * ripple, strip.start + length)
    count = last - first + 1
    send_paths(track, "strip/hole", arrivals(recent, length[ends]), path[drawn[consecutive(first, count)]], count)


def log_strip_grid(rec: rr.RecordingStream, scales: Scales) -> None:
    """Lines at round numbers of metres down the hole, and to both sides of it at round numbers of millimetres."""
    (left, right), (top, bottom) = scales.strip.bounds.x, scales.strip.bounds.y
    step = round_down((bottom - top) / 6)
    begin = top + STRIP_TOP * (bottom - top)
    depth = step * np.arange(np.ceil(begin / step), (bottom - TEXT * (bottom - top)) / step)
    aside = round_down(scales.ripple[1]) / SMALL_LENGTH.factor
    across = np.array(scales.strip.lanes)[:, None] + scales.strip.lateral * aside * np.array([-1.0, 0.0, 1.0])
    down = points(across.ravel()[:, None], np.array([begin, bottom]))
    lines = [*points(np.array([0.0, right]), depth[:, None]), *down]
    rec.log("strip/grid", rr.LineStrips2D.from_fields(strips=lines), static=True)
    above = TEXT * (bottom - top)
    log_labels(rec, "strip/grid/depth", points(left / 2, depth - above / 2), [metres(value) for value in depth])
    places = points((left + right) / 2, top + above * np.array([-0.3, 0.8, 1.9]))
    along = "drilled length (m)" if scales.start is None else "MD (m)"
    heading = [f"ripple × {scales.strip.lateral:g}", f"lines ±{SMALL_LENGTH.text(aside)}", along]
    log_labels(rec, "strip/grid/ripple", places, heading)

"""Tracks: the entities, colour and timelines of each run in a recording, and functions that send data to them.

All that a run shows is on up to three timelines: the drilled length and, if all runs start at the same one, the
measured depth, in whole millimetres; and the simulation time, if the run has one.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import rerun as rr
from numpy.typing import NDArray
from rerun.components import LineStrip2DBatch, LineStrip3DBatch
from rerun.encodings import Vec2DBatch, Vec3DBatch

from boreprop.case.case import Case
from boreprop.run.trajectory import Trajectory
from boreprop.units import UNITS

from .scales import Scales
from .scene import Array
from .source import Source
from .style import BY_RUN, DECIMALS, GREY, SHADES, Colour, mixed

TIMELINE = "drilled_length_mm"  # the one that a viewer shows first
DEPTH_TIMELINE = "measured_depth_mm"
TIME_TIMELINE = "simulation_time"
TIMELINES = (TIMELINE, DEPTH_TIMELINE, TIME_TIMELINE)
MODES = "modes"  # the lanes
MOST_NUMBERED = 2  # runs
LABEL_APART = 0.09  # of the width of the bit frame, from the tail of an arrow to the middle of its number, which …
LABELS_APART = 0.035  # of the height of the bit frame, from the number of a run to that of the next
LABEL_AT_MOST = 0.8  # … is at most so far from the middle of the frame, parts of its half width

Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Track:
    """The entities of a run in a recording, and its colour there.

    Parameters
    ----------
    rec
        The recording.
    scales
        The scales of the recording.
    case
        What is drilled.
    name, part, colour, place
        The name of the run, its part of the paths of entities, its own colour and its number, from 0. The defaults are
        for a single run.
    numbered
        Whether its forces and its tilt are shown in numbers, too: with more than two runs they would cover each other.
    """

    rec: rr.RecordingStream
    scales: Scales
    case: Case
    name: str = ""
    part: str = ""
    colour: Colour | None = None
    place: int = 0
    numbered: bool = True

    def entity(self, thing: str) -> str:
        """The entity of a thing, named view/thing; with several runs it contains the run's part, too.

        Those of the lanes begin with the number of the run, since they are shown in the order of their names.
        """
        if not self.part:
            return thing
        view, _, name = thing.rpartition("/")
        number = f"{self.place + 1}_" if view == MODES else ""
        return f"{view}/{rr.escape_entity_path_part(number + self.part)}/{name}"

    @property
    def lanes(self) -> int:
        """The number of lanes of its modes."""
        return len(self.case.bha.stabilizer_positions)

    def label(self, text: str) -> str:
        """`text`; with several runs, after the run's name."""
        return f"{self.name}: {text}" if self.name else text

    def shades(self, colours: tuple[Colour, ...]) -> tuple[Colour, ...]:
        """`colours`; with several runs, as many shades of the run's own colour."""
        if self.colour is None:
            return colours
        return tuple(mixed(self.colour, GREY, share) for share in SHADES[: len(colours)])


def make_tracks(rec: rr.RecordingStream, scales: Scales, sources: Sequence[Source]) -> list[Track]:
    """A track for each run."""
    if len(sources) == 1:
        return [Track(rec, scales, sources[0].case)]
    numbered = len(sources) <= MOST_NUMBERED
    return [
        Track(rec, scales, source.case, source.name, part, BY_RUN[place % len(BY_RUN)], place, numbered)
        for place, (source, part) in enumerate(zip(sources, parts([source.name for source in sources]), strict=True))
    ]


def parts(names: Sequence[str]) -> list[str]:
    """The parts of runs in the paths of entities: their names without spaces, made different by their numbers."""
    found: list[str] = []
    for number, name in enumerate(names, 1):
        part = "_".join(name.split()) or "run"
        while part in found:
            part += f"_{number}"
        found.append(part)
    return found


class Moments(NamedTuple):
    """Some moments of a run: the drilled length, m, and the time, s, at each; no times if the run has none."""

    length: Array
    time: Array | None

    def where(self, kept: NDArray[Any] | slice) -> "Moments":
        """The moments that a mask, indices or a slice select."""
        return Moments(self.length[kept], None if self.time is None else self.time[kept])


def moments(rows: Trajectory) -> Moments:
    """The moments of the rows of a run."""
    return Moments(rows["drilled_length"], rows.columns.get("time"))


def arrivals(rows: Trajectory, length: Array) -> Moments:
    """The moments at which the bit first came to some drilled lengths, which the rows of a run reach."""
    drilled, time = moments(rows)
    if time is not None:  # of several rows at one length `interp` takes the last: in the reversed order, the first
        time = np.interp(-length, -drilled[::-1], time[::-1])
    return Moments(length, time)


def send(track: Track, thing: str, at: Moments, columns: rr.ComponentColumnList) -> None:
    """Send components of a thing at some moments."""
    send_to(track, track.entity(thing), at, columns)


def send_to(track: Track, entity: str, at: Moments, columns: rr.ComponentColumnList) -> None:
    """Send components of an entity at some moments. Nothing is sent if there are none, since viewers fail on that."""
    if not len(at.length):
        return
    index = lengths_index(track.scales.start, at.length)
    if at.time is not None:
        index.append(times_index(at.time))
    track.rec.send_columns(entity, index, columns)


def lengths_index(start: float | None, length: Array) -> list[rr.TimeColumn]:
    """Drilled lengths, m, on their timeline and, given the measured depth of the start, m, on that of depths."""
    millimetres = np.rint(1000 * length).astype(np.int64)
    index = [rr.TimeColumn(TIMELINE, sequence=millimetres)]
    if start is not None:
        index.append(rr.TimeColumn(DEPTH_TIMELINE, sequence=millimetres + round(1000 * start)))
    return index


def times_index(time: Array) -> rr.TimeColumn:
    """Simulation times, s, on their timeline."""
    return rr.TimeColumn(TIME_TIMELINE, duration=time)


def points(x: Array | float, y: Array | float) -> Array:
    """Points (x, y), shape (..., 2), from coordinates that broadcast."""
    return np.stack(np.broadcast_arrays(x, y), axis=-1)


def send_strips(track: Track, thing: str, at: Moments, strips: Array) -> None:
    """Send line strips at some moments, shape (rows, strips, points, 2), in space (rows, strips, points, 3)."""
    rows, per_row, count, dimensions = strips.shape
    lines = line_strips(strips.reshape(-1, dimensions), np.full(rows * per_row, count))
    columns = (rr.LineStrips2D if dimensions == 2 else rr.LineStrips3D).columns(strips=lines)
    send(track, thing, at, columns if per_row == 1 else columns.partition(np.full(rows, per_row)))


def consecutive(first: Indices, count: Indices) -> Indices:
    """The indices from each `first` on, `count` of them each, all in one array."""
    index: Indices = np.arange(count.sum()) + np.repeat(first - np.cumsum(count) + count, count)
    return index


def send_paths(
    track: Track, thing: str, at: Moments, path: Array, count: Indices, colours: NDArray[np.uint8] | None = None
) -> None:
    """Send one line strip at each moment, in colours (rows, 3) or that of the thing.

    `path` has the points of all strips one after the other, (N, 2), in space (N, 3), and `count` how many each of them
    has, (rows,).
    """
    strips = rr.LineStrips2D if path.shape[1] == 2 else rr.LineStrips3D
    send(track, thing, at, strips.columns(strips=line_strips(path, count), colors=colours))


def line_strips(path: Array, count: Indices) -> pa.ListArray:
    """Line strips through points (N, 2) or (N, 3) one after the other, `count` of them each, as Arrow's array of lists.

    Rerun's own conversion from numpy goes from strip to strip.
    """
    offsets = np.append(0, np.cumsum(count)).astype(np.int32)
    point, strip = (Vec2DBatch, LineStrip2DBatch) if path.shape[1] == 2 else (Vec3DBatch, LineStrip3DBatch)
    through = point(path.astype(np.float32)).as_arrow_array()
    return pa.ListArray.from_arrays(offsets, through, type=strip([]).as_arrow_array().type)


def send_arrows(track: Track, thing: str, at: Moments, tip: Array, force: Array) -> None:
    """Send lateral forces (rows,), N, as arrows that end at `tip` (rows, 2), with their values; none where zero."""
    there = force != 0.0
    vectors = points(force[there] / track.scales.newtons_per_metre, 0.0)
    tails = tip[there] - vectors
    send(track, thing, at, rr.Arrows2D.columns(vectors=vectors, origins=tails).partition(there))
    if track.numbered:
        left, right = track.scales.frame.x
        beside = tails - points(LABEL_APART * (right - left) * np.sign(force[there]), 0.0)
        beside[:, 1] += LABELS_APART * track.place * np.ptp(track.scales.frame.y)  # clear of that of the run before
        beside[:, 0] = np.clip(beside[:, 0], LABEL_AT_MOST * left, LABEL_AT_MOST * right)
        send(track, f"{thing}/label", at, rr.Points2D.columns(positions=beside).partition(there))
        unit = UNITS["N"]
        shown = np.round(unit.factor * np.abs(force), 2)
        send_numbers(track, f"{thing}/label", at, shown, lambda number: f"{number:.3g} {unit.shown}")


def send_numbers(track: Track, thing: str, at: Moments, numbers: Array, text: Callable[[float], str]) -> None:
    """Send the text of a label, which is of a number, where the number changes."""
    changes = np.flatnonzero(np.diff(numbers, prepend=np.nan) != 0.0)
    labels = rr.Points2D.columns(labels=[text(number) for number in numbers[changes].tolist()])
    send(track, thing, at.where(changes), labels)


def send_curve(track: Track, entity: str, at: Moments, values: Array) -> None:
    """Send a curve of a plot, in the unit of the plot, rounded for those who read its values under the mouse."""
    send_to(track, entity, at, rr.Scalars.columns(scalars=np.round(values, DECIMALS)))

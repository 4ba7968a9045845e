"""Logs a run into a Rerun recording: one ``log_…`` function per thing shown, each for a stretch of rows.

The timeline is the drilled length in whole millimetres. Views are in metres with y down the screen. In the bit frame
the hole runs up the screen, the high side is to the right, and the lateral axis is multiplied by the factor that the
view's name gives.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import rerun as rr

from boreprop.analysis.axis import AXIS_REACH, axis_ripple
from boreprop.analysis.rippling import find_rippling
from boreprop.case.case import Case
from boreprop.core.quantities import BY_NAME
from boreprop.run.trajectory import Trajectory

from .card import in_words
from .scene import AHEAD, Array, BitFrame, Hole, Shapes, bit_positions
from .source import Source, Stretch
from .style import (
    BY_RUN,
    BY_STABILIZER,
    FURNITURE,
    GREEN,
    GREY,
    LANES,
    ORANGE,
    PLOTS,
    STROKES,
    WHITE,
    Colour,
    Look,
    Stroke,
    curve_label,
    round_down,
    shade,
)

TIMELINE = "drilled_length_mm"
RIPPLE = "plots/ripple/ripple"
RECENT = 32.0  # half lengths of the BHA that show whether a hole ripples: ten of the longest waves
BIT_LENGTH = 0.04  # of the drawn bit, over the length of the BHA


@dataclass(frozen=True)
class Track:
    """Where in a recording a run goes, and how it looks there."""

    rec: rr.RecordingStream
    look: Look
    case: Case
    run: str = ""  # its name beside others
    colour: Colour | None = None  # its own beside others
    place: int = 0  # among the others

    def entity(self, thing: str) -> str:
        """The entity of a thing, named by its view and what it is; where there are others, the run's name is in it."""
        if not self.run:
            return thing
        view, _, name = thing.rpartition("/")
        return f"{view}/{rr.escape_entity_path_part('_'.join(self.run.split()))}/{name}"

    @property
    def lanes(self) -> int:
        """How many lanes its modes take."""
        return len(self.case.bha.stabilizer_positions)

    def label(self, text: str) -> str:
        """`text`, with the run's name where there are others."""
        return f"{self.run}: {text}" if self.run else text

    def shades(self, colours: tuple[Colour, ...]) -> tuple[Colour, ...]:
        """`colours` for one run, shades of its own colour for one of several."""
        if self.colour is None:
            return colours
        return tuple(shade(self.colour, i / (len(colours) + 1)) for i in range(len(colours)))


def make_tracks(rec: rr.RecordingStream, look: Look, sources: Sequence[Source]) -> list[Track]:
    """A track for each run."""
    if len(sources) == 1:
        return [Track(rec, look, sources[0].case)]
    return [
        Track(rec, look, source.case, source.name, BY_RUN[place % len(BY_RUN)], place)
        for place, source in enumerate(sources)
    ]


class RunStream:
    """A run on its way into a recording, stretch by stretch."""

    def __init__(self, track: Track) -> None:
        self.track = track
        self.frame = BitFrame(track.case)
        self.drilled: float | None = None  # how far the hole has been drawn, m
        self.rippled = -np.inf  # how far its ripple has, m
        self.modes: dict[str, float] = {}  # what each lane shows last
        self.recent: Trajectory | None = None  # the rows that the verdict is about
        log_styles(track)

    def send(self, stretch: Stretch) -> None:
        """Log the next rows of the run."""
        if self.drilled is None:
            self.drilled = float(stretch.rows["drilled_length"][0])
            log_existing_hole(self.track, stretch.hole, self.drilled)
        log_drilled_hole(self.track, stretch, self.drilled)
        self.drilled = float(stretch.rows["drilled_length"][-1])
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
        self.rippled = log_ripple(self.track, stretch, self.rippled)
        self.modes = log_modes(self.track, stretch, self.modes)
        self.recent = _latest(self.recent, stretch.rows, RECENT * self.track.case.bha.half_length)

    def verdict(self) -> str:
        """Whether the hole ripples where the bit is."""
        return in_words(find_rippling(self.recent)) if self.recent else ""


def _latest(before: Trajectory | None, new: Trajectory, length: float) -> Trajectory:
    """The last rows of a run, over `length` m."""
    columns = {
        name: np.concatenate((before.columns[name], values)) if before else values
        for name, values in new.columns.items()
    }
    drilled = columns["drilled_length"]
    first = int(np.searchsorted(drilled, drilled[-1] - length))
    return Trajectory({name: values[first:] for name, values in columns.items()}, new.case)


# How it looks


def log_furniture(rec: rr.RecordingStream, look: Look, cases: Sequence[Case]) -> None:
    """What belongs to no run: the grid of the vertical section, the places and the scales of the bit frame."""
    for thing, stroke in FURNITURE.items():
        log_stroke(rec, thing, stroke)
    log_grid(rec, look)
    log_places(rec, look, cases)
    log_scale(rec, look)


def log_styles(track: Track) -> None:
    """Colours, widths, layers and names of what a run shows, for all time."""
    rec, n = track.rec, len(track.case.bha.stabilizer_positions)
    for thing, stroke in STROKES.items():
        log_stroke(rec, track.entity(thing), stroke if track.colour is None else stroke.of(track.colour))
    rec.log(track.entity("vertical_section/bit"), _dots(WHITE, 4.0), static=True)
    for i, colour in enumerate(track.shades(BY_STABILIZER[: n - 1]), 1):
        rec.log(track.entity(f"bit_frame/contact_point/{i}"), _dots(colour, 5.0), static=True)
        rec.log(track.entity(f"bit_frame/contact_force/{i}"), _arrows(colour), static=True)
    for force, colour in (("rss_force", GREEN), ("bit_lateral_force", WHITE)):
        rec.log(track.entity(f"bit_frame/{force}"), _arrows(track.colour or colour), static=True)
    rec.log(track.entity("bit_frame/tilt/label"), _text(track.colour or WHITE), static=True)
    for name, plot in PLOTS.items():
        scalars = plot.names(n)
        for scalar, colour in zip(scalars, track.shades(plot.colours[: len(scalars)]), strict=True):
            width = 1.0 if scalar.startswith("planned") else 2.0
            log_curve_style(track, curve(name, scalar), curve_label(scalar), colour, width)
    for side in ("lower", "upper"):
        log_curve_style(track, f"plots/bit_tilt/{side}_limit", "±ψ*  limit", GREY, 1.0)
    log_curve_style(track, RIPPLE, "hole axis less its trend", track.colour or ORANGE, 2.0)
    for variable, states in LANES.items():
        words, colours = zip(*states.values(), strict=True)
        for lane in lanes(variable, n):
            rec.log(track.entity(lane), rr.StateConfiguration(values=words, colors=colours), static=True)


def log_stroke(rec: rr.RecordingStream, entity: str, stroke: Stroke) -> None:
    """How lines look."""
    radii = rr.Radius.ui_points(stroke.width / 2)
    strips = rr.LineStrips2D.from_fields(colors=stroke.colour, radii=radii, draw_order=stroke.layer)
    rec.log(entity, strips, static=True)


def log_curve_style(track: Track, thing: str, label: str, colour: Colour, width: float) -> None:
    """How a curve of a plot looks, and what it is called."""
    shown = track.label(label)
    line = rr.SeriesLines(
        colors=colour, names=shown, widths=width, aggregation_policy=rr.components.AggregationPolicy.MinMax
    )
    track.rec.log(track.entity(thing), line, static=True)


def _dots(colour: Colour, radius: float) -> rr.Points2D:
    return rr.Points2D.from_fields(colors=colour, radii=rr.Radius.ui_points(radius), draw_order=40.0)


def _arrows(colour: Colour) -> rr.Arrows2D:
    return rr.Arrows2D.from_fields(colors=colour, radii=rr.Radius.ui_points(2.0), draw_order=50.0, show_labels=True)


def _text(colour: Colour) -> rr.Points2D:
    return rr.Points2D.from_fields(colors=colour, radii=rr.Radius.ui_points(0.0), show_labels=True)


# How it is sent


def send(track: Track, thing: str, length: Array, columns: rr.ComponentColumnList) -> None:
    """Components of a thing at drilled lengths; nothing where there are none, as viewers fail on that."""
    if len(length):
        time = rr.TimeColumn(TIMELINE, sequence=np.rint(1000 * length).astype(np.int64))
        track.rec.send_columns(track.entity(thing), [time], columns)


def points(x: Array | float, y: Array | float) -> Array:
    """Points (x, y), shape (..., 2), from coordinates that broadcast."""
    return np.stack(np.broadcast_arrays(x, y), axis=-1)


def send_strips(track: Track, thing: str, length: Array, strips: Array) -> None:
    """Line strips (rows, strips a row, points, 2)."""
    rows, per_row = strips.shape[:2]
    columns = rr.LineStrips2D.columns(strips=strips.reshape(-1, *strips.shape[2:]).astype(np.float32))
    send(track, thing, length, columns.partition([per_row] * rows))


def send_arrows(track: Track, thing: str, length: Array, tip: Array, force: Array) -> None:
    """A lateral force (rows,), N, as an arrow that ends at `tip` (rows, 2), with its size; none where it is zero."""
    there = force != 0.0
    vectors = points(force[there] / track.look.newtons_per_metre, 0.0)
    labels = [f"{round(abs(newtons) / 1000, 2):.3g} kN" for newtons in force[there]]
    columns = rr.Arrows2D.columns(vectors=vectors, origins=tip[there] - vectors, labels=labels)
    send(track, thing, length, columns.partition(there))


def send_curve(track: Track, thing: str, length: Array, values: Array) -> None:
    """A curve of a plot, in the plot's unit."""
    send(track, thing, length, rr.Scalars.columns(scalars=values))


def log_labels(rec: rr.RecordingStream, entity: str, places: Array, labels: Sequence[str]) -> None:
    """Text at fixed places of a view."""
    text = rr.Points2D(places, labels=labels, colors=GREY, radii=rr.Radius.ui_points(0.0), show_labels=True)
    rec.log(entity, text, static=True)


# The vertical section


def log_grid(rec: rr.RecordingStream, look: Look) -> None:
    """Lines at round numbers of metres, labelled along the left and the bottom, but for the corners."""
    (left, right), (top, bottom) = look.section.x, look.section.y
    step = round_down(max(right - left, bottom - top) / 4)
    x, z = (step * np.arange(np.ceil(low / step), high / step) for low, high in (look.section.x, look.section.y))
    lines = [*points(x[:, None], np.array([top, bottom])), *points(np.array([left, right]), z[:, None])]
    rec.log("vertical_section/grid", rr.LineStrips2D.from_fields(strips=lines), static=True)
    left, right, bottom = 0.9 * left + 0.1 * right, 0.9 * right + 0.1 * left, 0.95 * bottom + 0.05 * top
    x, z = x[(x > left) & (x < right)], z[z < bottom]
    log_labels(rec, "vertical_section/grid/depth", points(left, z), [f"{round(value)} m" for value in z])
    log_labels(rec, "vertical_section/grid/displacement", points(x, bottom), [f"{round(value)} m" for value in x])


def log_plan(rec: rr.RecordingStream, plan: Hole) -> None:
    """The planned path."""
    rec.log("vertical_section/plan", rr.LineStrips2D.from_fields(strips=[plan.position]), static=True)


def log_existing_hole(track: Track, hole: Hole, start: float) -> None:
    """The surveyed hole, behind where drilling starts; a BHA long at least."""
    bha = track.case.bha.stabilizer_positions[-1]
    surveyed = track.case.survey.measured_depth[-1] - track.case.survey.measured_depth[0]
    behind = hole.since(start - max(1.15 * bha, surveyed))
    there = behind.position[behind.length <= start]
    track.rec.log(
        track.entity("vertical_section/existing_hole"), rr.LineStrips2D.from_fields(strips=[there]), static=True
    )


def log_drilled_hole(track: Track, stretch: Stretch, drilled: float) -> None:
    """Each row's own piece of the hole, from where it is drawn on: the view shows the pieces up to its cursor."""
    hole = stretch.hole.since(drilled)
    new = (hole.length > drilled) & (hole.length <= stretch.rows["drilled_length"][-1])
    ends = np.flatnonzero(new)
    segments = np.stack((hole.position[ends - 1], hole.position[ends]), axis=1)
    send_strips(track, "vertical_section/drilled_hole", hole.length[ends], segments[:, None])


def log_bha_in_section(track: Track, shapes: Shapes) -> None:
    """The BHA and the bit at true scale."""
    length = shapes.rows["drilled_length"]
    send_strips(track, "vertical_section/bha", length, shapes.bha_in_section[:, None])
    send(track, "vertical_section/bit", length, rr.Points2D.columns(positions=bit_positions(shapes.rows)))


# The bit frame


def log_places(rec: rr.RecordingStream, look: Look, cases: Sequence[Case]) -> None:
    """What is where along the BHAs."""
    names: dict[float, str] = {}
    for case in cases:
        bha = case.bha
        stabilizers = {f"stabilizer {i}": s for i, s in enumerate(bha.stabilizer_positions, 1)}
        for name, s in ({"bit": 0.0, "RSS": bha.rss_position} | stabilizers).items():
            if name not in names.get(s, ""):
                names[s] = f"{names[s]}, {name}" if s in names else name
    (left, right), up = look.frame.x, -np.array(list(names))
    lines = list(points(np.array([left, right]), up[:, None]))
    rec.log("bit_frame/places", rr.LineStrips2D.from_fields(strips=lines), static=True)
    above = up + 0.045 * look.frame.y[0]
    labels = [f"{name}  {s:.4g} m" for s, name in names.items()]
    log_labels(rec, "bit_frame/places/labels", points(0.74 * left, above), labels)


def log_scale(rec: rr.RecordingStream, look: Look) -> None:
    """Which side is which, how long 100 mm are across the hole, and how long a force."""
    (left, right), (top, bottom) = look.frame.x, look.frame.y
    newtons = round_down(look.newtons_per_metre * (right - left) / 5)
    across, force = look.lateral * 0.1, newtons / look.newtons_per_metre
    at = 0.85 * bottom
    bars = [points(0.9 * left + np.array([0.0, across]), at), points(0.9 * right - np.array([0.0, force]), at)]
    rec.log("bit_frame/scale", rr.LineStrips2D.from_fields(strips=bars), static=True)
    places = points(
        np.array([0.8 * left, 0.8 * right, 0.9 * left + across / 2, 0.9 * right - force / 2]),
        np.array([top, top, at, at]),
    )
    labels = ["low side", "high side", "100 mm", f"{newtons / 1000:g} kN"]
    log_labels(rec, "bit_frame/scale/labels", places, labels)


def log_names(rec: rr.RecordingStream, look: Look, tracks: Sequence[Track]) -> None:
    """Which colour is which run, at the top of both pictures."""
    for view, bounds, side in (("vertical_section", look.section, 0.9), ("bit_frame", look.frame, 0.5)):
        (left, right), (top, bottom) = bounds.x, bounds.y
        down = top + 0.045 * (bottom - top) * np.arange(1.0, len(tracks) + 1)
        names = rr.Points2D(
            points(left + side * (right - left), down),
            labels=[track.run for track in tracks],
            colors=[track.colour or GREY for track in tracks],
            radii=rr.Radius.ui_points(0.0),
            show_labels=True,
        )
        rec.log(f"{view}/names", names, static=True)


def log_walls(track: Track, shapes: Shapes) -> None:
    """The low and the high side of the hole."""
    strips = points(track.look.lateral * shapes.walls, -shapes.frame.s_hole)
    send_strips(track, "bit_frame/walls", shapes.rows["drilled_length"], strips)


def log_bha(track: Track, shapes: Shapes) -> None:
    """The axis of the BHA, as the model says it bends."""
    strips = points(track.look.lateral * shapes.bha_axis, -shapes.frame.s)[:, None]
    send_strips(track, "bit_frame/bha", shapes.rows["drilled_length"], strips)


def log_bit(track: Track, shapes: Shapes) -> None:
    """The bit: as wide as the hole at s = 0, and tapering ahead along its own axis."""
    ahead = BIT_LENGTH * shapes.frame.stabilizer[-1]
    across = shapes.frame.radius * np.array([-1.0, 1.0, 0.5, -0.5, -1.0])
    along = ahead * np.array([0.0, 0.0, 1.0, 1.0, 0.0])
    strips = points(track.look.lateral * (across + shapes.bit_turn[:, None] * along), along)[:, None]
    send_strips(track, "bit_frame/bit", shapes.rows["drilled_length"], strips)


def log_tilt(track: Track, shapes: Shapes) -> None:
    """The axis of the bit against the direction of the hole, and how far apart the tilt limit lets them be."""
    length, reach = shapes.rows["drilled_length"], AHEAD * float(shapes.frame.stabilizer[-1])
    limit = track.case.bit.tilt_limit
    directions = {
        "limits": shapes.hole_turn[:, None] + np.array([-limit, limit]),
        "hole_axis": shapes.hole_turn[:, None],
        "bit_axis": shapes.bit_turn[:, None],
    }
    ahead = np.array([0.0, reach])
    for thing, angles in directions.items():
        strips = points(track.look.lateral * angles[..., None] * ahead, ahead)
        send_strips(track, f"bit_frame/tilt/{thing}", length, strips)
    tilts = np.degrees(shapes.rows["bit_tilt"])
    places = points(track.look.lateral * shapes.bit_turn * reach, (1.1 - 0.2 * track.place) * reach)
    labels = rr.Points2D.columns(positions=places, labels=[f"ψ {tilt:+.2f}°" for tilt in tilts])
    send(track, "bit_frame/tilt/label", length, labels)


def log_stabilizers(track: Track, shapes: Shapes) -> None:
    """The blades, from one side of the BHA to the other; the last stabilizer fills the hole."""
    strips = points(track.look.lateral * shapes.blades, -shapes.frame.stabilizer[:, None])
    send_strips(track, "bit_frame/stabilizers", shapes.rows["drilled_length"], strips)


def log_contacts(track: Track, shapes: Shapes) -> None:
    """Where the wall bears a stabilizer, and its force on it: nothing where there is none."""
    length, force = shapes.rows["drilled_length"], shapes.rows.stack("stabilizer_force")
    for i, lateral in enumerate(shapes.contact_points.T):
        place = points(track.look.lateral * lateral, -shapes.frame.stabilizer[i])
        there = np.isfinite(lateral)
        dots = rr.Points2D.columns(positions=place[there]).partition(there)
        send(track, f"bit_frame/contact_point/{i + 1}", length, dots)
        send_arrows(track, f"bit_frame/contact_force/{i + 1}", length, place, force[:, i])


def log_forces(track: Track, shapes: Shapes) -> None:
    """The force of the steering pads on the BHA, and the side force on the bit."""
    frame, rows = shapes.frame, shapes.rows
    ahead = (track.place + 1.5) * BIT_LENGTH * frame.stabilizer[-1]  # where its arrow and the bit can be told apart
    at = {"rss_force": (frame.at_rss, frame.rss), "bit_lateral_force": (0, -ahead)}
    for force, (place, s) in at.items():
        if force in rows.columns:
            tip = points(track.look.lateral * shapes.bha_axis[:, place], -s)
            send_arrows(track, f"bit_frame/{force}", rows["drilled_length"], tip, rows[force])


# The plots


def curve(plot: str, scalar: str) -> str:
    """Where a scalar is in a plot: stabilizer_force[1] is plots/stabilizer_force/stabilizer_force_1."""
    return f"plots/{plot}/{scalar.replace('[', '_').rstrip(']')}"


def log_plots(track: Track, shapes: Shapes) -> None:
    """The curves of all plots that there is something for."""
    rows = shapes.rows
    for name, plot in PLOTS.items():
        for scalar in plot.names(rows.n):
            if scalar in rows.columns:
                send_curve(track, curve(name, scalar), rows["drilled_length"], plot.unit.factor * rows[scalar])


def log_tilt_limits(track: Track, shapes: Shapes) -> None:
    """±ψ*, from the first row to the last."""
    ends, limit = shapes.rows["drilled_length"][[0, -1]], np.degrees(track.case.bit.tilt_limit)
    for side, sign in (("lower", -1.0), ("upper", 1.0)):
        send_curve(track, f"plots/bit_tilt/{side}_limit", ends, np.full(2, sign * limit))


def log_ripple(track: Track, stretch: Stretch, rippled: float) -> float:
    """The ripple of the hole, mm, in the drilled hole as far as its trend is known; returns how far that is."""
    width = track.look.trend
    hole = stretch.hole.since(max(rippled, 0.0) - (AXIS_REACH + 1.0) * width)
    length, ripple = axis_ripple(hole.length, hole.position, width)
    new = (length > rippled) & (length >= 0.0)
    send_curve(track, RIPPLE, length[new], 1000 * ripple[new])
    return float(length[-1]) if len(length) else rippled


# The modes


def lanes(variable: str, n: int) -> list[str]:
    """Where the lanes of a variable of few values are: stabilizer_contact[1] is modes/stabilizer_1."""
    if variable == "bit_tilt_saturation":
        return ["modes/tilt"]
    return [f"modes/stabilizer_{i}" for i, _ in enumerate(BY_NAME[variable].names(n), 1)]


def log_modes(track: Track, stretch: Stretch, shown: dict[str, float]) -> dict[str, float]:
    """Which stabilizer touches which wall, and whether the tilt is at its limit, where that changes."""
    rows, last = stretch.rows, {}
    for variable, states in LANES.items():
        for lane, scalar in zip(lanes(variable, rows.n), BY_NAME[variable].names(rows.n), strict=True):
            values = rows[scalar]
            changed = np.flatnonzero(np.diff(values, prepend=shown.get(lane, np.nan)) != 0.0)
            words = [states[int(value)][0] for value in values[changed]]
            send(track, lane, rows["drilled_length"][changed], rr.StateChange.columns(state=words))
            last[lane] = values[-1]
    return last

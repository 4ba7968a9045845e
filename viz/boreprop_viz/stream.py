"""Logs a run into a Rerun recording: one ``log_…`` function per thing shown, each for a batch of rows.

The timeline is the drilled length in whole millimetres. Views are in metres with y down the screen. In the bit frame
the hole runs up the screen, the high side is to the right, and the lateral axis is multiplied by the factor that the
view's name gives.
"""

import numpy as np
import rerun as rr

from boreprop.case import Case
from boreprop.results import Trajectory

from .scene import Array, BitFrame, Hole, Shapes, bit_positions, existing_hole
from .style import (
    BY_STABILIZER,
    GREEN,
    GREY,
    PLOTS,
    STRIPS,
    WHITE,
    Colour,
    Scales,
    curve_label,
    round_down,
)

TIMELINE = "drilled_length_mm"
BIT_LENGTH = 0.04  # of the drawn bit, over the length of the BHA


class RunStream:
    """A run on its way into a recording, batch by batch; remembers no more of the hole than it shows around the BHA."""

    def __init__(self, rec: rr.RecordingStream, case: Case, scales: Scales) -> None:
        self.rec, self.scales = rec, scales
        self.frame = BitFrame(case)
        self.reach = float(self.frame.s_hole[-1])
        self.hole = existing_hole(case.survey, self.reach, spacing=self.reach / 100)
        log_styles(rec, contacts=len(case.bha.stabilizer_clearances))
        log_grid(rec, scales)
        log_existing_hole(rec, self.hole)
        log_places(rec, self.frame, scales)
        log_scale(rec, scales)

    def send(self, rows: Trajectory) -> None:
        """Log the next rows of the run."""
        log_drilled_hole(self.rec, rows, self.hole)
        self.hole = self.hole.followed_by(rows["drilled_length"], bit_positions(rows))
        shapes = self.frame.shapes(rows, self.hole)
        for log in (
            log_bha_in_section,
            log_walls,
            log_bha,
            log_bit,
            log_stabilizers,
            log_contacts,
            log_rss_force,
            log_plots,
            log_tilt_limits,
        ):
            log(self.rec, shapes, self.scales)
        self.hole = self.hole.since(float(rows["drilled_length"][-1]) - self.reach)


def log_styles(rec: rr.RecordingStream, contacts: int) -> None:
    """Colours, widths, layers and names, for all time."""
    for entity, (colour, width, order) in STRIPS.items():
        strips = rr.LineStrips2D.from_fields(colors=colour, radii=rr.Radius.ui_points(width / 2), draw_order=order)
        rec.log(entity, strips, static=True)
    rec.log("vertical_section/bit", _dots(WHITE, 4.0), static=True)
    for i in range(contacts):
        rec.log(f"bit_frame/contact_point/{i + 1}", _dots(BY_STABILIZER[i], 5.0), static=True)
        rec.log(f"bit_frame/contact_force/{i + 1}", _arrows(BY_STABILIZER[i]), static=True)
    rec.log("bit_frame/rss_force", _arrows(GREEN), static=True)
    for entity, plot in PLOTS.items():
        for name, colour in zip(plot.names(contacts + 1), plot.colours, strict=False):
            line = rr.SeriesLines(
                colors=colour,
                names=curve_label(name),
                widths=2.0,
                aggregation_policy=rr.components.AggregationPolicy.MinMax,
            )
            rec.log(curve_entity(entity, name), line, static=True)
    for side in ("lower", "upper"):
        rec.log(f"plots/bit_tilt/{side}_limit", rr.SeriesLines(colors=GREY, names="±ψ* limit", widths=1.0), static=True)


def _dots(colour: Colour, radius: float) -> rr.Points2D:
    return rr.Points2D.from_fields(colors=colour, radii=rr.Radius.ui_points(radius), draw_order=40.0)


def _arrows(colour: Colour) -> rr.Arrows2D:
    return rr.Arrows2D.from_fields(colors=colour, radii=rr.Radius.ui_points(2.0), draw_order=50.0, show_labels=True)


def timeline(length: Array) -> rr.TimeColumn:
    """The drilled lengths as a column of the timeline."""
    return rr.TimeColumn(TIMELINE, sequence=np.rint(1000 * length).astype(np.int64))


def points(x: Array | float, y: Array | float) -> Array:
    """Points (x, y), shape (..., 2), from coordinates that broadcast."""
    return np.stack(np.broadcast_arrays(x, y), axis=-1)


def send_strips(rec: rr.RecordingStream, entity: str, time: rr.TimeColumn, strips: Array) -> None:
    """Line strips (rows, strips a row, points, 2)."""
    rows, per_row = strips.shape[:2]
    columns = rr.LineStrips2D.columns(strips=strips.reshape(-1, *strips.shape[2:]).astype(np.float32))
    rec.send_columns(entity, [time], columns.partition([per_row] * rows))


def send_arrows(
    rec: rr.RecordingStream, entity: str, time: rr.TimeColumn, tip: Array, force: Array, scale: float
) -> None:
    """A lateral force (rows,), N, as an arrow that ends at `tip` (rows, 2), with its size; none where it is zero."""
    there = force != 0.0
    vectors = points(force[there] / scale, 0.0)
    labels = [f"{abs(newtons) / 1000:.3g} kN" for newtons in force[there]]
    columns = rr.Arrows2D.columns(vectors=vectors, origins=tip[there] - vectors, labels=labels)
    rec.send_columns(entity, [time], columns.partition(there))


def log_labels(rec: rr.RecordingStream, entity: str, places: Array, labels: list[str]) -> None:
    """Text at fixed places of a view."""
    text = rr.Points2D(places, labels=labels, colors=GREY, radii=rr.Radius.ui_points(0.0), show_labels=True)
    rec.log(entity, text, static=True)


# The vertical section


def log_grid(rec: rr.RecordingStream, scales: Scales) -> None:
    """Lines at round numbers of metres, labelled along the left and the bottom, but for the corners."""
    (left, right), (top, bottom) = scales.section.x, scales.section.y
    step = round_down(max(right - left, bottom - top) / 4)
    x, z = (step * np.arange(np.ceil(low / step), high / step) for low, high in (scales.section.x, scales.section.y))
    lines = [*points(x[:, None], np.array([top, bottom])), *points(np.array([left, right]), z[:, None])]
    rec.log("vertical_section/grid", rr.LineStrips2D.from_fields(strips=lines), static=True)
    left, right, bottom = 0.9 * left + 0.1 * right, 0.9 * right + 0.1 * left, 0.95 * bottom + 0.05 * top
    x, z = x[(x > left) & (x < right)], z[z < bottom]
    log_labels(rec, "vertical_section/grid/depth", points(left, z), [f"{round(value)} m" for value in z])
    log_labels(rec, "vertical_section/grid/displacement", points(x, bottom), [f"{round(value)} m" for value in x])


def log_existing_hole(rec: rr.RecordingStream, hole: Hole) -> None:
    """The surveyed hole."""
    rec.log("vertical_section/existing_hole", rr.LineStrips2D.from_fields(strips=[hole.position]), static=True)


def log_drilled_hole(rec: rr.RecordingStream, rows: Trajectory, hole: Hole) -> None:
    """Each row's own piece of the hole, from the end of `hole` on: the view shows the pieces up to its cursor."""
    drilled = hole.since(float(hole.length[-1])).followed_by(rows["drilled_length"], bit_positions(rows))
    pieces = np.stack((drilled.position[:-1], drilled.position[1:]), axis=1)
    send_strips(rec, "vertical_section/drilled_hole", timeline(drilled.length[1:]), pieces[:, None])


def log_bha_in_section(rec: rr.RecordingStream, shapes: Shapes, _: Scales) -> None:
    """The BHA and the bit at true scale."""
    time = timeline(shapes.rows["drilled_length"])
    send_strips(rec, "vertical_section/bha", time, shapes.bha_in_section[:, None])
    rec.send_columns("vertical_section/bit", [time], rr.Points2D.columns(positions=bit_positions(shapes.rows)))


# The bit frame


def log_places(rec: rr.RecordingStream, frame: BitFrame, scales: Scales) -> None:
    """What is where along the BHA."""
    names: dict[float, str] = {}
    places = {"bit": 0.0, "RSS": frame.rss} | {f"stabilizer {i + 1}": s for i, s in enumerate(frame.stabilizer)}
    for name, s in places.items():
        names[s] = f"{names[s]}, {name}" if s in names else name
    (left, right), up = scales.frame.x, -np.array(list(names))
    lines = list(points(np.array([left, right]), up[:, None]))
    rec.log("bit_frame/places", rr.LineStrips2D.from_fields(strips=lines), static=True)
    above = up + 0.045 * scales.frame.y[0]
    labels = [f"{name}  {s:.4g} m" for s, name in names.items()]
    log_labels(rec, "bit_frame/places/labels", points(0.84 * left, above), labels)


def log_scale(rec: rr.RecordingStream, scales: Scales) -> None:
    """Which side is which, and how long 100 mm are across the hole."""
    (left, right), (top, bottom) = scales.frame.x, scales.frame.y
    bar = points(scales.lateral * np.array([-0.05, 0.05]), 0.65 * bottom)
    rec.log("bit_frame/scale", rr.LineStrips2D.from_fields(strips=[bar]), static=True)
    corners = points(np.array([0.84 * left, 0.84 * right, 0.0]), np.array([top, top, 0.67 * bottom]))
    log_labels(rec, "bit_frame/scale/labels", corners, ["low side", "high side", "100 mm"])


def log_walls(rec: rr.RecordingStream, shapes: Shapes, scales: Scales) -> None:
    """The axis and the walls of the hole."""
    time, up = timeline(shapes.rows["drilled_length"]), -shapes.frame.s_hole
    send_strips(rec, "bit_frame/hole_axis", time, points(scales.lateral * shapes.hole_axis, up)[:, None])
    send_strips(rec, "bit_frame/walls", time, points(scales.lateral * shapes.walls, up))


def log_bha(rec: rr.RecordingStream, shapes: Shapes, scales: Scales) -> None:
    """The axis of the BHA."""
    strips = points(scales.lateral * shapes.bha_axis, -shapes.frame.s)[:, None]
    send_strips(rec, "bit_frame/bha", timeline(shapes.rows["drilled_length"]), strips)


def log_bit(rec: rr.RecordingStream, shapes: Shapes, scales: Scales) -> None:
    """The bit: as wide as the hole at s = 0, and tapering ahead along its own axis."""
    ahead = BIT_LENGTH * shapes.frame.stabilizer[-1]
    across = shapes.frame.radius * np.array([-1.0, 1.0, 0.5, -0.5, -1.0])
    along = ahead * np.array([0.0, 0.0, 1.0, 1.0, 0.0])
    strips = points(scales.lateral * (across + shapes.bit_turn[:, None] * along), along)[:, None]
    send_strips(rec, "bit_frame/bit", timeline(shapes.rows["drilled_length"]), strips)


def log_stabilizers(rec: rr.RecordingStream, shapes: Shapes, scales: Scales) -> None:
    """The blades, from one side of the BHA to the other; the last stabilizer fills the hole."""
    strips = points(scales.lateral * shapes.blades, -shapes.frame.stabilizer[:, None])
    send_strips(rec, "bit_frame/stabilizers", timeline(shapes.rows["drilled_length"]), strips)


def log_contacts(rec: rr.RecordingStream, shapes: Shapes, scales: Scales) -> None:
    """Where the wall bears a stabilizer, and its force on it: nothing where there is none."""
    time, force = timeline(shapes.rows["drilled_length"]), shapes.rows.stack("stabilizer_force")
    for i, lateral in enumerate(shapes.contact_points.T):
        place = points(scales.lateral * lateral, -shapes.frame.stabilizer[i])
        there = np.isfinite(lateral)
        dots = rr.Points2D.columns(positions=place[there])
        rec.send_columns(f"bit_frame/contact_point/{i + 1}", [time], dots.partition(there))
        send_arrows(rec, f"bit_frame/contact_force/{i + 1}", time, place, force[:, i], scales.newtons_per_metre)


def log_rss_force(rec: rr.RecordingStream, shapes: Shapes, scales: Scales) -> None:
    """The force of the steering pads on the BHA."""
    tip = points(scales.lateral * shapes.bha_axis[:, shapes.frame.at_rss], -shapes.frame.rss)
    time, force = timeline(shapes.rows["drilled_length"]), shapes.rows["rss_force"]
    send_arrows(rec, "bit_frame/rss_force", time, tip, force, scales.newtons_per_metre)


# The plots


def curve_entity(plot: str, name: str) -> str:
    """Entity of a scalar of the table in a plot: stabilizer_force[1] is plots/stabilizer_force/stabilizer_force_1."""
    return f"plots/{plot}/{name.replace('[', '_').rstrip(']')}"


def log_plots(rec: rr.RecordingStream, shapes: Shapes, _: Scales) -> None:
    """The curves of all plots."""
    time = timeline(shapes.rows["drilled_length"])
    for entity, plot in PLOTS.items():
        for name in plot.names(shapes.rows.n):
            scalars = rr.Scalars.columns(scalars=plot.factor * shapes.rows[name])
            rec.send_columns(curve_entity(entity, name), [time], scalars)


def log_tilt_limits(rec: rr.RecordingStream, shapes: Shapes, scales: Scales) -> None:
    """±ψ*, from the first row of the batch to the last."""
    time = timeline(shapes.rows["drilled_length"][[0, -1]])
    for side, sign in (("lower", -1.0), ("upper", 1.0)):
        scalars = rr.Scalars.columns(scalars=np.full(2, sign * scales.tilt_limit))
        rec.send_columns(f"plots/bit_tilt/{side}_limit", [time], scalars)

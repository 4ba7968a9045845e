"""Logs what is shown of the rows of a run: one ``log_…`` function for each thing, each for a stretch of rows.

Views are in metres with y down the screen. In the bit frame the hole runs up the screen, the high side is to the right,
and the lateral axis is multiplied by the factor that the view's name gives.
"""

import numpy as np
import rerun as rr

from boreprop.analysis.axis import AXIS_REACH, axis_ripple
from boreprop.core.quantities import BY_NAME
from boreprop.run.ground import on_rows
from boreprop.run.trajectory import Trajectory
from boreprop.units import SMALL_LENGTH, UNITS

from .scene import AHEAD, Array, Shapes
from .source import Stretch
from .track import Track, arrivals, moments, points, send, send_arrows, send_curve, send_numbers, send_strips

RIPPLE = "plots/ripple/ripple"
BIT_LENGTH = 0.04  # length of the drawn bit over that of the BHA
AGAIN = 10.0  # half lengths of the BHA after which lanes are logged again
LABEL, LABELS_APART = 1.1, 0.2  # places of the labels of ψ over the length of the drawn directions: the first one just
# ahead of these, those of further runs nearer to the bit, each clear of the one before

# The bit frame


def log_walls(track: Track, shapes: Shapes) -> None:
    """The low and the high side of the hole."""
    strips = points(track.scales.lateral * shapes.walls, -shapes.frame.s_hole)
    send_strips(track, "bit_frame/walls", moments(shapes.rows), strips)


def log_bha(track: Track, shapes: Shapes) -> None:
    """The axis of the BHA, bent as in the model."""
    drawn = shapes.frame.along_bha
    strips = points(track.scales.lateral * shapes.bha_axis[:, drawn], -shapes.frame.s[drawn])[:, None]
    send_strips(track, "bit_frame/bha", moments(shapes.rows), strips)


def log_body(track: Track, shapes: Shapes) -> None:
    """Both sides of the body of the BHA, where its diameter is known, and the wall where it pushes, with the forces."""
    at, sides, frame = moments(shapes.rows), shapes.body, shapes.frame
    if sides is not None:
        strips = points(track.scales.lateral * sides, -frame.s[frame.along_bha])
        send_strips(track, "bit_frame/body", at, strips)
    if frame.body.size:
        touching = shapes.body_force != 0.0
        count = touching.sum(axis=1)
        places = points(track.scales.lateral * shapes.body_contact_points, -frame.body)[touching]
        vectors = points(shapes.body_force[touching] / track.scales.newtons_per_metre, 0.0)
        send(track, "bit_frame/body_contact_point", at, rr.Points2D.columns(positions=places).partition(count))
        arrows = rr.Arrows2D.columns(vectors=vectors, origins=places - vectors)
        send(track, "bit_frame/body_contact_force", at, arrows.partition(count))


def log_bit(track: Track, shapes: Shapes) -> None:
    """The bit: as wide as the hole at s = 0, and tapering ahead along its own axis."""
    ahead = BIT_LENGTH * shapes.frame.stabilizer[-1]
    across = shapes.frame.radius * np.array([-1.0, 1.0, 0.5, -0.5, -1.0])
    along = ahead * np.array([0.0, 0.0, 1.0, 1.0, 0.0])
    strips = points(track.scales.lateral * (across + shapes.bit_turn[:, None] * along), along)[:, None]
    send_strips(track, "bit_frame/bit", moments(shapes.rows), strips)


def log_tilt(track: Track, shapes: Shapes) -> None:
    """The axis of the bit, the direction of the hole, and the limits of the angle between them."""
    at, reach = moments(shapes.rows), AHEAD * float(shapes.frame.stabilizer[-1])
    limit = on_rows(track.case, shapes.rows, "bit_tilt_limit")
    directions = {
        "limits": shapes.hole_turn[:, None] + np.multiply.outer(limit, (-1.0, 1.0)),
        "hole_axis": shapes.hole_turn[:, None],
        "bit_axis": shapes.bit_turn[:, None],
    }
    ahead = np.array([0.0, reach])
    for thing, angles in directions.items():
        strips = points(track.scales.lateral * angles[..., None] * ahead, ahead)
        send_strips(track, f"bit_frame/tilt/{thing}", at, strips)
    if track.numbered:
        places = points(track.scales.lateral * shapes.bit_turn * reach, (LABEL - LABELS_APART * track.place) * reach)
        send(track, "bit_frame/tilt/label", at, rr.Points2D.columns(positions=places))
        unit = UNITS["rad"]
        shown = np.round(unit.factor * shapes.rows["bit_tilt"], 2) + 0.0  # without a zero below zero
        send_numbers(
            track, "bit_frame/tilt/label", at, shown, lambda degrees: f"ψ {degrees:+.2f}{unit.shown}".replace("-", "−")
        )


def log_stabilizers(track: Track, shapes: Shapes) -> None:
    """The blades of the stabilizers, from one side of the BHA to the other; the last stabilizer fills the hole."""
    strips = points(track.scales.lateral * shapes.blades, -shapes.frame.stabilizer[:, None])
    send_strips(track, "bit_frame/stabilizers", moments(shapes.rows), strips)


def log_contacts(track: Track, shapes: Shapes) -> None:
    """The points where the wall pushes on a stabilizer, and its force; nothing where it does not."""
    at, force = moments(shapes.rows), shapes.rows.stack("stabilizer_force")
    for i, lateral in enumerate(shapes.contact_points.T):
        place = points(track.scales.lateral * lateral, -shapes.frame.stabilizer[i])
        there = np.isfinite(lateral)
        dots = rr.Points2D.columns(positions=place[there]).partition(there)
        send(track, f"bit_frame/contact_point/{i + 1}", at, dots)
        send_arrows(track, f"bit_frame/contact_force/{i + 1}", at, place, force[:, i])


def log_forces(track: Track, shapes: Shapes) -> None:
    """The force of the steering pads on the BHA, and the side force on the bit."""
    frame, rows = shapes.frame, shapes.rows
    ahead = (track.place + 1.5) * BIT_LENGTH * frame.stabilizer[-1]  # ahead of the bit, which would hide the arrow
    from_places = {"rss_force": (frame.at_rss, frame.rss), "bit_lateral_force": (0, -ahead)}
    for force, (place, s) in from_places.items():
        if force in rows.columns:
            tip = points(track.scales.lateral * shapes.bha_axis[:, place], -s)
            send_arrows(track, f"bit_frame/{force}", moments(rows), tip, rows[force])


# The plots


def curve(plot: str, scalar: str) -> str:
    """The entity of the curve of a scalar: plots/stabilizer_force/stabilizer_force_1 for stabilizer_force[1]."""
    return f"plots/{plot}/{scalar.replace('[', '_').rstrip(']')}"


def planned_curve(track: Track, plot: str) -> str:
    """The entity of what is planned in a plot; it comes first, so that all runs are drawn over it.

    Over the drilled length, runs that start at different measured depths have different plans.
    """
    shared = f"plots/{plot}/0_plan"
    return shared if track.scales.start is not None else track.entity(f"{shared}/planned")


def log_plots(track: Track, rows: Trajectory) -> None:
    """The curves of all plots for which the run has columns."""
    for name, plot in track.scales.plots.items():
        curves = {track.entity(curve(name, scalar)): scalar for scalar in plot.names(rows.structure)}
        for entity, scalar in (curves | {planned_curve(track, name): plot.planned}).items():
            if scalar in rows.columns:
                send_curve(track, entity, moments(rows), plot.unit.factor * rows[scalar])


def log_tilt_limits(track: Track, rows: Trajectory) -> None:
    """±ψ*, from the first row to the last, with both ends of each change."""
    limit = UNITS["rad"].factor * on_rows(track.case, rows, "bit_tilt_limit")
    changes = np.flatnonzero(np.diff(limit))
    at = np.unique([0, *changes, *(changes + 1), len(limit) - 1])
    ends = moments(rows).where(at)
    for side, sign in (("lower", -1.0), ("upper", 1.0)):
        send_curve(track, track.entity(f"plots/bit_tilt/{side}_limit"), ends, sign * limit[at])


def find_ripple(track: Track, stretch: Stretch, begin: float, rippled: float) -> tuple[Array, Array]:
    """Drilled lengths and the ripple of the hole there, m, as far as its trend is determined.

    They begin at most half a width of the trend before the drilled length `rippled`, m, but not before the run does, at
    the length `begin`, m. The hole behind a run that begins late is not known, nor is the trend at its beginning.
    """
    width = track.scales.trend
    hole = stretch.hole.since(max(rippled, begin) - (AXIS_REACH + 1.0) * width)
    length, ripple = axis_ripple(hole.length, hole.position, width)
    known = length >= (begin + AXIS_REACH * width if begin > width else begin)
    return length[known], ripple[known]


def log_ripple(track: Track, recent: Trajectory, length: Array, ripple: Array, rippled: float) -> None:
    """The ripple at the lengths beyond `rippled`, mm; `recent` are the last rows of the run, back to these lengths."""
    new = length > rippled
    send_curve(track, track.entity(RIPPLE), arrivals(recent, length[new]), SMALL_LENGTH.factor * ripple[new])


# The modes


def lanes(quantity: str, n: int) -> list[str]:
    """The entities of the lanes of a quantity of few values: modes/stabilizer_1 for stabilizer_contact[1]."""
    if quantity == "bit_tilt_saturation":
        return ["modes/tilt"]
    return [f"modes/stabilizer_{i}" for i, _ in enumerate(BY_NAME[quantity].names(n), 1)]


def log_modes(track: Track, rows: Trajectory, new: int) -> None:
    """Where the wall that each stabilizer touches, and the saturation of the bit tilt, change in the `new` last rows.

    `rows` are these and at least the row before. Once in a while what has not changed is logged again: a server that is
    short of memory drops what is oldest.
    """
    again = np.diff(rows["drilled_length"] // (AGAIN * track.case.bha.half_length), prepend=np.nan) != 0.0
    for quantity, states in track.scales.lanes.items():
        for lane, scalar in zip(lanes(quantity, rows.n), BY_NAME[quantity].names(rows.n), strict=True):
            changed = np.flatnonzero((np.diff(rows[scalar], prepend=np.nan) != 0.0) | again)
            changed = changed[changed >= rows.row_count - new]
            words = [states[int(value)][0] for value in rows[scalar][changed]]
            send(track, lane, moments(rows).where(changed), rr.StateChange.columns(state=words))

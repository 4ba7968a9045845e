"""Logs what is shown of the rows of a run in space: one ``log_…`` function for each thing.

The view across the hole is in radii of its discs, see `space_scene`. Views in three dimensions are in metres north,
east and down.
"""

from collections.abc import Callable

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from boreprop.analysis.axis import AXIS_POINTS, AXIS_REACH, axis_away
from boreprop.analysis.turning import beside_trend
from boreprop.core.system import BottomHoleAssembly
from boreprop.run.trajectory import Trajectory
from boreprop.units import SMALL_LENGTH, UNITS

from .entities import RIPPLE
from .scene import Array
from .section import severity_colours
from .source import Stretch
from .space_scales import SpaceScales
from .space_scene import PLAY, TILT, TOOLFACE, Discs, Tube, circle, contact_points, tube
from .track import Moments, Track, arrivals, moments, send, send_curve, send_numbers, send_strips

RIPPLE_EAST = f"{RIPPLE}_east"
POINTS_OF_BHA = 8
POINTS_IN_HALF = 20  # of the tube over half the length of the BHA
PIECE, EVERY = AXIS_POINTS // 2, 2  # points of the ripple in a piece of the enlarged hole, and every how many is drawn
POINTS_OF_BLADES = 24
Projection = Callable[[Array], Array]


def projections(space: SpaceScales) -> dict[str, Projection]:
    """The views that show places, and how each shows positions north, east and down, (N, 3)."""
    return {"hole": lambda position: position, "vertical_section": space.on_section, "plan_view": space.on_plan}


def log_bha_in_hole(track: Track, space: SpaceScales, stretch: Stretch) -> None:
    """The BHA along the axis of the hole, its stabilizers and the bit, in all views that show places."""
    at, stabilizers = moments(stretch.rows), places_of(track.case.bha)
    s = np.union1d(np.linspace(0.0, stabilizers[-1], POINTS_OF_BHA), stabilizers)
    axis = stretch.hole.at(stretch.rows["drilled_length"][:, None] - s)
    for view, project in projections(space).items():
        shown = project(axis.reshape(-1, 3)).reshape(*axis.shape[:2], -1)
        dots = rr.Points2D if shown.shape[2] == 2 else rr.Points3D
        send_strips(track, f"{view}/bha", at, shown[:, None])
        at_stabilizers = shown[:, np.searchsorted(s, stabilizers)]
        count = np.full(len(shown), len(stabilizers))
        several = dots.columns(positions=at_stabilizers.reshape(-1, shown.shape[2])).partition(count)
        send(track, f"{view}/stabilizers", at, several)
        send(track, f"{view}/bit", at, dots.columns(positions=shown[:, 0]))


def places_of(bha: BottomHoleAssembly) -> Array:
    """Distances of the stabilizers from the bit, m, (n,)."""
    return np.array(bha.stabilizer_positions, dtype=float)


class DrilledTube:
    """Logs the tube of the drilled hole at true scale, in pieces of half the length of the BHA."""

    def __init__(self, track: Track, start: float) -> None:
        self.track, self.start = track, start
        self.length = track.case.bha.half_length  # of a piece, m
        self.done = 0  # pieces that are logged

    def log(self, stretch: Stretch, recent: Trajectory) -> None:
        """Log the pieces that some rows complete; `recent` are these and those over a length of the BHA before."""
        complete = int((stretch.rows["drilled_length"][-1] - self.start) // self.length)
        if complete == self.done:
            return
        pieces = np.arange(self.done, complete)[:, None] + np.linspace(0.0, 1.0, POINTS_IN_HALF + 1)
        length = self.start + self.length * pieces
        round_the_hole = tube(stretch.hole.at(length), self.track.case.bit_diameter / 2)
        send_tube(self.track, "hole/tube", recent, length, round_the_hole)
        self.done = complete


def send_tube(track: Track, thing: str, recent: Trajectory, length: Array, shown: Tube) -> None:
    """Send pieces of a tube, each where it ends, coloured by dogleg severity; `length` is that of each point, m."""
    pieces, points = length.shape
    sides = shown.vertices.shape[1] // points
    of_points = (
        np.tile(track.colour, (length.size, 1)) if track.colour else severity_colours(track, recent, length.ravel())
    )
    colours: NDArray[np.uint8] = np.repeat(of_points.astype(np.uint8), sides, axis=0)
    of_vertices = rr.Mesh3D.columns(
        vertex_positions=shown.vertices.reshape(-1, 3),
        vertex_normals=shown.normals.reshape(-1, 3),
        vertex_colors=colours,
    )
    of_triangles = rr.Mesh3D.columns(triangle_indices=np.tile(shown.triangles, (pieces, 1)))
    columns = [
        *of_vertices.partition(np.full(pieces, points * sides)),
        *of_triangles.partition(np.full(pieces, len(shown.triangles))),
    ]
    send(track, thing, arrivals(recent, length[:, -1]), rr.ComponentColumnList(columns))


def log_ripple_in_space(
    track: Track, space: SpaceScales, stretch: Stretch, recent: Trajectory, begin: float, rippled: float
) -> float:
    """How far the hole lies from its trend, as curves and enlarged as a tube; returns up to where it is known, m.

    That was known up to the drilled length `rippled`, m. The run starts at `begin`, m; `recent` are its last rows.
    """
    width = track.scales.trend
    hole = stretch.hole.since(max(rippled, begin) - (AXIS_REACH + 1.0) * width)
    length, away, forward = axis_away(hole.length, hole.position, width)
    known = length >= (begin + AXIS_REACH * width if begin > width else begin)
    length, beside = length[known], beside_trend(away, forward)[known]
    new = length > rippled
    for curve, parts in zip((RIPPLE, RIPPLE_EAST), beside.T, strict=True):
        send_curve(track, track.entity(curve), arrivals(recent, length[new]), SMALL_LENGTH.factor * parts[new])
    number = np.rint(length * AXIS_POINTS / width).astype(np.int64)
    ends = np.flatnonzero((number % PIECE == 0) & new)
    ends = ends[ends >= PIECE]
    if len(ends):
        through = ends[:, None] + np.arange(-PIECE, 1, EVERY)
        down = (track.scales.start or 0.0) + length
        path = np.column_stack((space.lateral * beside, down))[through]
        send_tube(track, "enlarged/tube", recent, length[through], tube(path, space.thickness))
    return float(np.max(length, initial=rippled))


# Across the hole


def log_stabilizers_across(track: Track, space: SpaceScales, discs: Discs) -> None:
    """The blades of each stabilizer in its disc, their middle, and where the wall pushes, with its force."""
    at, blades = moments(discs.rows), (1.0 - PLAY) * circle(POINTS_OF_BLADES)
    for i, place in enumerate(space.discs[: discs.force.shape[1]]):
        middle = place + discs.middle[:, i]
        send_strips(track, f"across/blades/{i + 1}", at, (middle[:, None] + blades)[:, None])
        for dot in ("middle", "trail"):
            send(track, f"across/{dot}/{i + 1}", at, rr.Points2D.columns(positions=middle))
        log_contact(track, space, at, str(i + 1), place, discs.force[:, i])


def log_body_across(track: Track, space: SpaceScales, discs: Discs) -> None:
    """Where the wall pushes most on the body, in its disc, with the force there and the distance from the bit."""
    if not track.case.bha.body_point_positions:
        return
    at, place = moments(discs.rows), space.discs[space.stabilizers]
    log_contact(track, space, at, "body", place, discs.body_force)
    if track.numbered:
        inside = place + np.array([0.0, 0.25 * track.place])
        send(track, "across/body/label", at, rr.Points2D.columns(positions=np.tile(inside, (len(at.length), 1))))
        behind = np.round(discs.rows["body_contact_position"], 1)
        send_numbers(track, "across/body/label", at, behind, lambda far: f"{far:.1f} m" if far else "free")


def log_contact(track: Track, space: SpaceScales, at: Moments, which: str, place: Array, force: Array) -> None:
    """Where the wall pushes in a disc with some forces, N, (rows, 2), and these with their size."""
    touched = place + contact_points(force)
    there = np.isfinite(touched[:, 0])
    send(track, f"across/contact_point/{which}", at, rr.Points2D.columns(positions=touched[there]).partition(there))
    send_force(track, f"across/contact_force/{which}", at, space, force, touched)
    log_size(track, f"across/contact_force/{which}/label", at, place, force)


def log_tilt_across(track: Track, space: SpaceScales, discs: Discs) -> None:
    """The tilt in its disc, and the lateral force on the bit from the middle of it."""
    at, place = moments(discs.rows), space.discs[TILT]
    tip = place + discs.tilt
    send_strips(track, "across/tilt", at, np.stack(np.broadcast_arrays(place, tip), axis=1)[:, None])
    for dot in ("middle", "trail"):
        send(track, f"across/{dot}/tilt", at, rr.Points2D.columns(positions=tip))
    force = discs.bit_force
    send_force(track, "across/bit_lateral_force", at, space, force, np.broadcast_to(place, force.shape))
    if track.numbered:
        degrees = np.round(UNITS["rad"].factor * discs.rows["bit_tilt"], 2)
        label_under(track, "across/bit_lateral_force/label", at, place)
        send_numbers(
            track, "across/bit_lateral_force/label", at, degrees, lambda size: f"ψ {size:.2f} {UNITS['rad'].shown}"
        )


def log_toolface(track: Track, space: SpaceScales, discs: Discs) -> None:
    """The force of the pads in the dial of the toolface."""
    at, place, force = moments(discs.rows), space.discs[TOOLFACE], discs.toolface
    send_force(track, "across/rss_force", at, space, force, np.broadcast_to(place, force.shape))
    log_size(track, "across/rss_force/label", at, place, force)
    if track.numbered and "rss_toolface" in discs.rows:
        inside = place + np.array([0.0, 0.45 + 0.25 * track.place])
        send(track, "across/toolface/label", at, rr.Points2D.columns(positions=np.tile(inside, (len(force), 1))))
        degrees = np.round(UNITS["rad"].factor * discs.rows["rss_toolface"], 1) + 0.0  # without a zero below zero
        send_numbers(track, "across/toolface/label", at, degrees, in_degrees)


def in_degrees(angle: float) -> str:
    """An angle in degrees, with its unit."""
    return f"{angle:.15g} {UNITS['rad'].shown}".replace("-", "−")


def log_upright(track: Track, space: SpaceScales, discs: Discs) -> None:
    """What is up the screen, where it changes."""
    if not track.numbered:
        return
    words = np.array(discs.upright)
    changes = np.flatnonzero(np.append(True, words[1:] != words[:-1]))
    at = moments(discs.rows).where(changes)
    place = space.discs[0] + np.array([-1.2, -1.45 + 0.25 * track.place])
    send(
        track,
        "across/upright",
        at,
        rr.Points2D.columns(positions=np.tile(place, (len(changes), 1)), labels=words[changes]),
    )


def send_force(track: Track, thing: str, at: Moments, space: SpaceScales, force: Array, origin: Array) -> None:
    """Send forces, N, (rows, 2), as arrows from `origin`, (rows, 2); none where zero."""
    there = np.any(force != 0.0, axis=1)
    vectors = force[there] / space.newtons
    send(track, thing, at, rr.Arrows2D.columns(vectors=vectors, origins=origin[there]).partition(there))


def log_size(track: Track, thing: str, at: Moments, place: Array, force: Array) -> None:
    """The size of a force, N, (rows, 2), under its disc."""
    if track.numbered:
        unit = UNITS["N"]
        label_under(track, thing, at, place)
        shown = np.round(unit.factor * np.linalg.norm(force, axis=1), 2)
        send_numbers(track, thing, at, shown, lambda number: f"{number:.3g} {unit.shown}")


def label_under(track: Track, thing: str, at: Moments, place: Array) -> None:
    """The place of a label under a disc, below that of the run before."""
    below = place + np.array([0.0, 1.62 + 0.25 * track.place])
    send(track, thing, at, rr.Points2D.columns(positions=np.tile(below, (len(at.length), 1))))

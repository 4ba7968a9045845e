"""Logs what does not change over a run: grid, marks and scales of the views, names, colours and strokes.

Views are in metres with y down the screen. In the bit frame the hole runs up the screen, the high side is to the right,
and the lateral axis is multiplied by the factor that the view's name gives.
"""

from collections.abc import Sequence

import numpy as np
import rerun as rr

from boreprop.case.case import Case
from boreprop.units import UNITS

from .entities import RIPPLE, curve, lanes
from .scales import Scales, round_down
from .scene import Array
from .style import (
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
    Stroke,
    curve_label,
)
from .track import Track, points

LINE = 0.045  # height of a line of text over that of its view, which is some 20 lines high
# Other places in a view are parts of its width and height, chosen so that text neither is cut nor covers other text.


def log_furniture(rec: rr.RecordingStream, scales: Scales, cases: Sequence[Case]) -> None:
    """What is common to all runs: the grid of the vertical section, the marks and the scales of the bit frame."""
    for thing, stroke in FURNITURE.items():
        log_stroke(rec, thing, stroke)
    log_grid(rec, scales)
    log_places(rec, scales, cases)
    log_scale(rec, scales)


def log_styles(track: Track) -> None:
    """Colours, widths, layers and names of all that a run shows."""
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
    for quantity, states in LANES.items():
        words, colours = zip(*states.values(), strict=True)
        for lane in lanes(quantity, n):
            rec.log(track.entity(lane), rr.StateConfiguration(values=words, colors=colours), static=True)


def log_stroke(rec: rr.RecordingStream, entity: str, stroke: Stroke) -> None:
    """The colour, width and layer of the lines of an entity."""
    radii = rr.Radius.ui_points(stroke.width / 2)
    strips = rr.LineStrips2D.from_fields(colors=stroke.colour, radii=radii, draw_order=stroke.layer)
    rec.log(entity, strips, static=True)


def log_curve_style(track: Track, thing: str, label: str, colour: Colour, width: float) -> None:
    """The colour, width and name of a curve of a plot."""
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


def log_labels(rec: rr.RecordingStream, entity: str, places: Array, labels: Sequence[str]) -> None:
    """Text at fixed places of a view."""
    text = rr.Points2D(places, labels=labels, colors=GREY, radii=rr.Radius.ui_points(0.0), show_labels=True)
    rec.log(entity, text, static=True)


def log_grid(rec: rr.RecordingStream, scales: Scales) -> None:
    """Lines at round numbers of metres, labelled along the left and the bottom edge, except in the corners."""
    (left, right), (top, bottom) = scales.section.x, scales.section.y
    step = round_down(max(right - left, bottom - top) / 4)
    x, z = (step * np.arange(np.ceil(low / step), high / step) for low, high in (scales.section.x, scales.section.y))
    lines = [*points(x[:, None], np.array([top, bottom])), *points(np.array([left, right]), z[:, None])]
    rec.log("vertical_section/grid", rr.LineStrips2D.from_fields(strips=lines), static=True)
    left, right, bottom = 0.9 * left + 0.1 * right, 0.9 * right + 0.1 * left, 0.95 * bottom + 0.05 * top
    x, z = x[(x > left) & (x < right)], z[z < bottom]
    log_labels(rec, "vertical_section/grid/depth", points(left, z), [f"{round(value)} m" for value in z])
    log_labels(rec, "vertical_section/grid/displacement", points(x, bottom), [f"{round(value)} m" for value in x])


def log_plan(rec: rr.RecordingStream, plan: Array) -> None:
    """The planned path through points (N, 2)."""
    rec.log("vertical_section/plan", rr.LineStrips2D.from_fields(strips=[plan]), static=True)


def log_places(rec: rr.RecordingStream, scales: Scales, cases: Sequence[Case]) -> None:
    """Marks at the bit, the pads and the stabilizers of all BHAs, with their names and distances from the bit."""
    names: dict[float, str] = {}
    for case in cases:
        bha = case.bha
        stabilizers = {f"stabilizer {i}": s for i, s in enumerate(bha.stabilizer_positions, 1)}
        for name, s in ({"bit": 0.0, "RSS": bha.rss_position} | stabilizers).items():
            if name not in names.get(s, ""):
                names[s] = f"{names[s]}, {name}" if s in names else name
    (left, right), up = scales.frame.x, -np.array(list(names))
    lines = list(points(np.array([left, right]), up[:, None]))
    rec.log("bit_frame/places", rr.LineStrips2D.from_fields(strips=lines), static=True)
    above = up + LINE * scales.frame.y[0]
    labels = [f"{name}  {s:.4g} m" for s, name in names.items()]
    log_labels(rec, "bit_frame/places/labels", points(0.74 * left, above), labels)


def log_scale(rec: rr.RecordingStream, scales: Scales) -> None:
    """The names of the two sides, and bars for 100 mm across the hole and for a force."""
    (left, right), (top, bottom) = scales.frame.x, scales.frame.y
    newtons = round_down(scales.newtons_per_metre * (right - left) / 5)
    across, force = scales.lateral * 0.1, newtons / scales.newtons_per_metre
    at = 0.85 * bottom
    bars = [points(0.9 * left + np.array([0.0, across]), at), points(0.9 * right - np.array([0.0, force]), at)]
    rec.log("bit_frame/scale", rr.LineStrips2D.from_fields(strips=bars), static=True)
    places = points(
        np.array([0.8 * left, 0.8 * right, 0.9 * left + across / 2, 0.9 * right - force / 2]),
        np.array([top, top, at, at]),
    )
    labels = ["low side", "high side", "100 mm", UNITS["N"].text(newtons, "g")]
    log_labels(rec, "bit_frame/scale/labels", places, labels)


def log_names(rec: rr.RecordingStream, scales: Scales, tracks: Sequence[Track]) -> None:
    """The names of the runs in their colours, at the top of both pictures."""
    for view, bounds, side in (("vertical_section", scales.section, 0.9), ("bit_frame", scales.frame, 0.5)):
        (left, right), (top, bottom) = bounds.x, bounds.y
        down = top + LINE * (bottom - top) * np.arange(1.0, len(tracks) + 1)
        names = rr.Points2D(
            points(left + side * (right - left), down),
            labels=[track.name for track in tracks],
            colors=[track.colour or GREY for track in tracks],
            radii=rr.Radius.ui_points(0.0),
            show_labels=True,
        )
        rec.log(f"{view}/names", names, static=True)

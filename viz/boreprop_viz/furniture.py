"""Logs what does not change over a run: grid, marks and scales of the views, names, colours and strokes.

Views are in metres with y down the screen. In the bit frame the hole runs up the screen, the high side is to the right,
and the lateral axis is multiplied by the factor that the view's name gives.
"""

from collections.abc import Sequence

import numpy as np
import rerun as rr

from boreprop.case.case import Case
from boreprop.units import UNITS

from .entities import RIPPLE, curve, lanes, planned_curve
from .scales import Scales
from .scene import Array, Bounds, round_down
from .style import (
    BIT,
    BODY,
    BY_STABILIZER,
    FAINT,
    FURNITURE,
    GREY,
    HOLE,
    PLAN,
    RSS,
    SHADES,
    STROKES,
    WHITE,
    Colour,
    Stroke,
    curve_label,
    mixed,
)
from .track import DEPTH_TIMELINE, Track, points

PALE = 0.5  # share of white in the colour of a run's text, which is read on the grey ground of a label
APART = 1.4  # lines of text from one name to the next
LINE = 0.045  # height of a line of text over that of its view, which is some 20 lines high
# Other places in a view are parts of its width and height, chosen so that text neither is cut nor covers other text.


def log_furniture(rec: rr.RecordingStream, scales: Scales, cases: Sequence[Case]) -> None:
    """What is common to all runs and does not change: strokes, and the marks and the scales of the bit frame."""
    for thing, stroke in FURNITURE.items():
        log_stroke(rec, thing, stroke)
    log_places(rec, scales, cases)
    log_scale(rec, scales)
    log_round_start(rec, scales)


def log_styles(track: Track) -> None:
    """Colours, widths, layers and names of all that a run shows."""
    rec, n = track.rec, len(track.case.bha.stabilizer_positions)
    for thing, stroke in STROKES.items():
        log_stroke(rec, track.entity(thing), stroke if track.colour is None else stroke.of(track.colour))
    rec.log(track.entity("vertical_section/bit"), dots(WHITE, 4.0), static=True)
    contacts = rr.Points2D.from_fields(radii=rr.Radius.ui_points(3.0), draw_order=5.0)
    rec.log(track.entity("vertical_section/contacts"), contacts, static=True)
    forces = {"rss_force": track.colour or RSS, "bit_lateral_force": track.colour or BIT}
    rec.log(track.entity("vertical_section/depths"), text_style(WHITE), static=True)
    for i, colour in enumerate(track.shades(BY_STABILIZER[: n - 1]), 1):
        rec.log(track.entity(f"bit_frame/contact_point/{i}"), dots(colour, 5.0), static=True)
        forces[f"contact_force/{i}"] = colour
    if track.case.bha.body_point_positions:
        rec.log(track.entity("bit_frame/body_contact_point"), dots(track.colour or BODY, 3.0), static=True)
        rec.log(track.entity("bit_frame/body_contact_force"), arrows(track.colour or BODY), static=True)
    text = text_style(mixed(track.colour or WHITE, WHITE, PALE))
    for force, colour in forces.items():
        rec.log(track.entity(f"bit_frame/{force}"), arrows(colour), static=True)
        rec.log(track.entity(f"bit_frame/{force}/label"), text, static=True)
    rec.log(track.entity("bit_frame/tilt/label"), text, static=True)
    log_curve_styles(track)
    log_curve_style(track, RIPPLE, "ripple (mm)", track.colour or HOLE, 2.0)
    log_lane_styles(track)


def log_curve_styles(track: Track) -> None:
    """Colours and names of the curves of the plots."""
    rec = track.rec
    for name, plot in track.scales.plots.items():
        scalars = plot.names(track.case.structure)
        for scalar, colour in zip(scalars, track.shades(plot.colours[: len(scalars)]), strict=True):
            log_curve_style(track, curve(name, scalar), curve_label(scalar, plot.unit), colour, 2.0)
        if plot.planned:
            line = curve_style(curve_label(plot.planned, plot.unit), PLAN, 3.0)
            rec.log(planned_curve(track, name), line, static=True)
    for side in ("lower", "upper"):
        log_curve_style(track, f"plots/bit_tilt/{side}_limit", f"{side} limit of the bit tilt (°)", GREY, 1.0)


def log_lane_styles(track: Track) -> None:
    """The words of the lanes, and their colours: those of the stabilizers and of the bit, or that of the run."""
    n = len(track.case.bha.stabilizer_positions)
    own = dict(zip(lanes("stabilizer_contact", n), BY_STABILIZER, strict=False))
    for quantity, states in track.scales.lanes.items():
        for lane in lanes(quantity, n):
            colour = track.colour or own.get(lane, BIT)
            colours = [FAINT if i is None else mixed(colour, GREY, SHADES[i]) for _, i in states.values()]
            words = [word for word, _ in states.values()]
            track.rec.log(track.entity(lane), rr.StateConfiguration(values=words, colors=colours), static=True)


def log_stroke(rec: rr.RecordingStream, entity: str, stroke: Stroke) -> None:
    """The colour, width and layer of the lines of an entity."""
    radii = rr.Radius.ui_points(stroke.width / 2)
    strips = rr.LineStrips2D.from_fields(colors=stroke.colour, radii=radii, draw_order=stroke.layer)
    rec.log(entity, strips, static=True)


def log_curve_style(track: Track, thing: str, label: str, colour: Colour, width: float) -> None:
    """The colour, width and name of a curve of a run."""
    track.rec.log(track.entity(thing), curve_style(track.label(label), colour, width), static=True)


def curve_style(label: str, colour: Colour, width: float) -> rr.SeriesLines:
    """The colour, width and name of a curve of a plot."""
    thinned = rr.components.AggregationPolicy.MinMax
    return rr.SeriesLines(colors=colour, names=label, widths=width, aggregation_policy=thinned)


def dots(colour: Colour, radius: float) -> rr.Points2D:
    """The style of dots."""
    return rr.Points2D.from_fields(colors=colour, radii=rr.Radius.ui_points(radius), draw_order=40.0)


def arrows(colour: Colour) -> rr.Arrows2D:
    """The style of forces."""
    return rr.Arrows2D.from_fields(colors=colour, radii=rr.Radius.ui_points(2.0), draw_order=50.0)


def text_style(colour: Colour) -> rr.Points2D:
    """The style of text."""
    return rr.Points2D.from_fields(colors=colour, radii=rr.Radius.ui_points(0.0), show_labels=True)


def log_labels(rec: rr.RecordingStream, entity: str, places: Array, labels: Sequence[str]) -> None:
    """Text at fixed places of a view."""
    text = rr.Points2D(places, labels=labels, colors=WHITE, radii=rr.Radius.ui_points(0.0), show_labels=True)
    rec.log(entity, text, static=True)


def metres(value: float) -> str:
    """A round number of metres, without digits that are not needed."""
    return f"{round(value, 3) + 0.0:.15g}"


def log_grid(
    rec: rr.RecordingStream, shown: Bounds, view: str = "vertical_section", up: float = -1.0, above: float = 0.08
) -> None:
    """Lines at round numbers of metres, labelled along the left and the bottom edge, except in the corners.

    `up` is the sign of the numbers up the screen, and `above` how far those at the bottom are from that edge, a part of
    the height.
    """
    (left, right), (top, bottom) = shown.x, shown.y
    step = shown.grid_step
    x, z = (step * np.arange(np.ceil(low / step), high / step) for low, high in (shown.x, shown.y))
    lines = [*points(x[:, None], np.array([top, bottom])), *points(np.array([left, right]), z[:, None])]
    rec.log(f"{view}/grid", rr.LineStrips2D.from_fields(strips=lines), static=True)
    left, right, bottom = 0.9 * left + 0.1 * right, 0.9 * right + 0.1 * left, (1 - above) * bottom + above * top
    x, z = x[(x > left) & (x < right)], z[z < bottom - above * (bottom - top)]  # a line of text above the lowest
    log_labels(rec, f"{view}/grid/depth", points(left, z), [f"{metres(-up * value)} m" for value in z])
    log_labels(rec, f"{view}/grid/displacement", points(x, bottom), [f"{metres(value)} m" for value in x])


def log_round_start(rec: rr.RecordingStream, scales: Scales) -> None:
    """Nothing at a round measured depth, in every plot: the viewer counts the axis from the first tick."""
    if scales.start is None:
        return
    tick = rr.TimeColumn(DEPTH_TIMELINE, sequence=[round(1000 * scales.round_start)])
    for plot in (*scales.plots, "ripple"):
        rec.send_columns(f"plots/{plot}/0_start", [tick], rr.Scalars.columns(scalars=np.full(1, np.nan)))


def log_plan(rec: rr.RecordingStream, paths: Sequence[Array]) -> None:
    """The planned paths, each through points (N, 2)."""
    rec.log("vertical_section/plan", rr.LineStrips2D.from_fields(strips=paths), static=True)


def log_places(rec: rr.RecordingStream, scales: Scales, cases: Sequence[Case]) -> None:
    """Marks at the bit, the pads and the stabilizers of all BHAs, with their names and distances from the bit."""
    names: dict[float, str] = {}
    for case in cases:
        bha = case.bha
        stabilizers = {f"stabilizer {i}": s for i, s in enumerate(bha.stabilizer_positions, 1)}
        for name, s in ({"bit": 0.0, "RSS": bha.rss_position} | stabilizers).items():
            if name not in names.get(s, ""):
                names[s] = f"{names[s]}, {name}" if s in names else name
    places = sorted(names)
    (left, right), up = scales.frame.x, -np.array(places)
    lines = list(points(np.array([left, right]), up[:, None]))
    rec.log("bit_frame/places", rr.LineStrips2D.from_fields(strips=lines), static=True)
    line = LINE * scales.frame.y[0]
    beside = [up[0] - line, *(up[1:] + line)]  # the bit's are below its mark, the others above theirs, …
    for i in range(2, len(beside)):
        beside[i] = min(beside[i], beside[i - 1] + APART * line)  # … clear of each other
    log_labels(rec, "bit_frame/places/names", points(0.72 * left, np.array(beside)), [names[s] for s in places])
    log_labels(
        rec, "bit_frame/places/distances", points(0.82 * right, np.array(beside)), [f"{s:.4g} m" for s in places]
    )


def log_scale(rec: rr.RecordingStream, scales: Scales) -> None:
    """The names of the two sides, and bars for 100 mm across the hole and for a force."""
    (left, right), (top, bottom) = scales.frame.x, scales.frame.y
    newtons = round_down(scales.newtons_per_metre * (right - left) / 5)
    across, force = scales.lateral * 0.1, newtons / scales.newtons_per_metre
    at = 0.85 * bottom
    bars = [points(0.9 * left + np.array([0.0, across]), at), points(0.9 * right - np.array([0.0, force]), at)]
    rec.log("bit_frame/scale", rr.LineStrips2D.from_fields(strips=bars), static=True)
    places = points(
        np.array([0.8 * left, 0.6 * right, 0.9 * left + across / 2, 0.9 * right - force / 2]),
        np.array([top, top, at, at]),
    )
    labels = ["low side", "high side", "100 mm", UNITS["N"].text(newtons, "g")]
    log_labels(rec, "bit_frame/scale/labels", places, labels)

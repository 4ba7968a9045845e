"""Logs what does not change over a run in space: grid, discs and marks of the views, names, colours and strokes."""

import numpy as np
import rerun as rr

from boreprop.run.trajectory import Trajectory
from boreprop.units import SMALL_LENGTH, UNITS

from .entities import RIPPLE
from .furniture import (
    arrows,
    dots,
    log_curve_style,
    log_curve_styles,
    log_grid,
    log_labels,
    log_lane_styles,
    log_round_start,
    log_stroke,
    metres,
    text_style,
)
from .scales import Scales
from .scene import Array, round_down
from .space_entities import RIPPLE_EAST, projections
from .space_scales import SpaceScales
from .space_scene import PLAY, TOOLFACE, circle
from .style import (
    BIT,
    BLUE,
    BODY,
    BY_STABILIZER,
    FAINT,
    FURNITURE,
    GREY,
    HOLE,
    RSS,
    STROKES,
    STROKES_IN_SPACE,
    WHITE,
    Colour,
    Stroke,
    mixed,
)
from .track import Track

PALE = 0.5  # share of white in the colour of a run's text
REFERENCES = ("the high side", "north", "the frame of the bit")  # from where a toolface counts
POINTS_OF_DISC = 72
TO_THE_LEFT = (0.43, -0.9)  # of the eye that sees the enlarged hole: north, east
DEPTHS_ASIDE = 0.16  # of the length of a run, from the trend of the enlarged hole to the middle of its depths
BELOW = 1.28  # radii of a disc from its middle to its name


def log_furniture_in_space(rec: rr.RecordingStream, scales: Scales, space: SpaceScales, runs: list[Trajectory]) -> None:
    """What is common to all runs and does not change."""
    log_stroke(rec, "vertical_section/grid", FURNITURE["vertical_section/grid"])
    log_stroke(rec, "plan_view/grid", FURNITURE["vertical_section/grid"])
    for view in ("vertical_section", "plan_view"):
        log_stroke(rec, f"{view}/plan", FURNITURE["vertical_section/plan"])
    for view in ("hole", "enlarged"):
        rec.log(view, rr.ViewCoordinates.FRD, static=True)  # north, east, down
    log_discs(rec, space, runs)
    log_depths(rec, scales, space)
    log_round_start(rec, scales)


def log_plan_grid(rec: rr.RecordingStream, space: SpaceScales) -> None:
    """Lines at round numbers of metres to north, up the screen, and to east."""
    log_grid(rec, space.plan, "plan_view", up=1.0, above=0.14)


def log_plan_in_space(rec: rr.RecordingStream, space: SpaceScales, paths: list[Array]) -> None:
    """The planned paths in all views that show places, each through points north, east and down, (N, 3)."""
    plan = FURNITURE["vertical_section/plan"]
    for view, project in projections(space).items():
        shown = [project(path) for path in paths]
        if view == "hole":
            radii = rr.Radius.ui_points(plan.width / 2)
            rec.log("hole/plan", rr.LineStrips3D(shown, colors=plan.colour, radii=radii), static=True)
        else:
            rec.log(f"{view}/plan", rr.LineStrips2D.from_fields(strips=shown), static=True)


def log_discs(rec: rr.RecordingStream, space: SpaceScales, runs: list[Trajectory]) -> None:
    """The discs across the hole: walls, clearances, the limit of the tilt, the dial of the toolface, their names."""
    edges = space.discs[:, None] + circle(POINTS_OF_DISC)
    colours = [HOLE] * (space.stabilizers + space.body) + [GREY, GREY]
    rec.log("across/edges", rr.LineStrips2D(list(edges), colors=colours, radii=rr.Radius.ui_points(1.5)), static=True)
    clearances = space.discs[: space.stabilizers, None] + PLAY * circle(POINTS_OF_DISC)
    ticks = np.array(
        [[[0.0, -1.0], [0.0, -0.85]], [[1.0, 0.0], [0.85, 0.0]], [[0.0, 1.0], [0.0, 0.85]], [[-1.0, 0.0], [-0.85, 0.0]]]
    )
    faint = [*clearances, *(space.discs[TOOLFACE] + ticks)]
    rec.log("across/marks", rr.LineStrips2D(faint, colors=GREY, radii=rr.Radius.ui_points(0.5)), static=True)
    names = [f"stabilizer {i + 1}{clearance(runs, i)}" for i in range(space.stabilizers)]
    names += ["body, largest force"] * space.body + [f"bit tilt{limit(runs)}", f"toolface, from {reference(runs)}"]
    log_labels(rec, "across/names", space.discs + np.array([0.0, BELOW]), names)


def clearance(runs: list[Trajectory], stabilizer: int) -> str:
    """The clearance of a stabilizer that all runs have, in words; empty if they differ."""
    all_of = [run.case.bha.stabilizer_clearances for run in runs if run.case]
    found = {each[stabilizer] if stabilizer < len(each) else np.nan for each in all_of}
    return f", clearance {SMALL_LENGTH.text(found.pop())}" if len(found) == 1 else ""


def limit(runs: list[Trajectory]) -> str:
    """The limit of the tilt that all runs have, in words; empty if they differ."""
    found = {run.case.bit.tilt_limit for run in runs if run.case}
    return f", ψ* {UNITS['rad'].text(found.pop())}" if len(found) == 1 else ""


def reference(runs: list[Trajectory]) -> str:
    """From where the toolface of all runs counts, in words."""
    found = {int(value) for run in runs for value in np.unique(run.columns.get("toolface_reference", np.zeros(1)))}
    return " or ".join(REFERENCES[value] for value in sorted(found))


def log_depths(rec: rr.RecordingStream, scales: Scales, space: SpaceScales) -> None:
    """Beside the enlarged hole: depths down its trend, and how far some millimetres to north and to east are."""
    begin = (scales.start or 0.0) + scales.begin
    step = round_down(scales.shown_length / 5)
    depth = step * np.arange(np.ceil(begin / step), (begin + scales.length) / step)
    aside = round_down(scales.ripple[1]) / SMALL_LENGTH.factor
    far = space.lateral * aside
    down = np.zeros((len(depth), 3))
    down[:, :2], down[:, 2] = DEPTHS_ASIDE * scales.shown_length * np.array(TO_THE_LEFT), depth
    words = "MD" if scales.start is not None else "drilled"
    labels = [f"{words} {metres(value)} m" for value in depth]
    rec.log("enlarged/depths", rr.Points3D(down, labels=labels, colors=WHITE, radii=0.0, show_labels=True), static=True)
    top = begin - 0.05 * scales.shown_length
    ends = np.array([[far, 0.0, top], [0.0, far, top]])
    size = SMALL_LENGTH.text(aside)
    rec.log(
        "enlarged/axes",
        rr.Arrows3D(
            vectors=ends - np.array([0.0, 0.0, top]),
            origins=np.tile([0.0, 0.0, top], (2, 1)),
            colors=GREY,
            radii=rr.Radius.ui_points(1.5),
        ),
        static=True,
    )
    names = np.array(
        [[far, 0.0, top - 0.05 * scales.shown_length], [0.0, 2.5 * far, top]]
    )  # apart, as the eye sees them
    text = rr.Points3D(names, labels=["north", f"east {size}"], colors=WHITE, radii=0.0, show_labels=True)
    rec.log("enlarged/names", text, static=True)
    line = np.array([[0.0, 0.0, begin], [0.0, 0.0, begin + scales.shown_length]])
    rec.log("enlarged/trend", rr.LineStrips3D([line], colors=FAINT, radii=rr.Radius.ui_points(1.0)), static=True)


def log_styles_in_space(track: Track) -> None:
    """Colours, widths, layers and names of all that a run shows."""
    rec, n = track.rec, len(track.case.bha.stabilizer_positions)

    def own(stroke: Stroke) -> Stroke:
        return stroke if track.colour is None else stroke.of(track.colour)

    flat = {thing: stroke for thing, stroke in STROKES.items() if thing.startswith("vertical_section/")}
    for thing, stroke in (flat | STROKES_IN_SPACE).items():
        if thing != "across/blades":
            log_stroke(rec, track.entity(thing), own(stroke))
    for thing in ("existing_hole", "drilled_hole", "newly_drilled", "bha"):
        log_stroke_in_space(track, f"hole/{thing}", own(STROKES[f"vertical_section/{thing}"]))
    log_stroke_in_space(track, "hole/newly_drilled", own(STROKES["vertical_section/newly_drilled"]))
    for view in ("vertical_section", "plan_view"):
        rec.log(track.entity(f"{view}/bit"), dots(WHITE, 4.0), static=True)
        rec.log(track.entity(f"{view}/stabilizers"), dots(track.colour or BIT, 3.5), static=True)
    rec.log(track.entity("vertical_section/depths"), text_style(WHITE), static=True)
    for thing, colour in {"bit": WHITE, "stabilizers": track.colour or BIT}.items():
        spheres = rr.Points3D.from_fields(colors=colour, radii=rr.Radius.ui_points(4.0))
        rec.log(track.entity(f"hole/{thing}"), spheres, static=True)
    log_styles_across(track, n)
    log_curve_styles(track)
    for curve, side, colour in zip((RIPPLE, RIPPLE_EAST), ("north", "east"), track.shades((HOLE, BLUE)), strict=True):
        log_curve_style(track, curve, f"to {side} (mm)", colour, 2.0)
    log_lane_styles(track)


def log_styles_across(track: Track, n: int) -> None:
    """Colours and widths of what a run shows across the hole."""
    rec, text = track.rec, text_style(mixed(track.colour or WHITE, WHITE, PALE))
    forces: dict[str, Colour] = {"rss_force": track.colour or RSS, "bit_lateral_force": track.colour or BIT}
    for i, colour in enumerate(track.shades(BY_STABILIZER[: n - 1]), 1):
        log_stroke(rec, track.entity(f"across/blades/{i}"), Stroke(track.colour or BIT, 3.0, 2.0))
        rec.log(track.entity(f"across/contact_point/{i}"), dots(colour, 5.0), static=True)
        forces[f"contact_force/{i}"] = colour
    if track.case.bha.body_point_positions:
        rec.log(track.entity("across/contact_point/body"), dots(track.colour or BODY, 5.0), static=True)
        rec.log(track.entity("across/body/label"), text, static=True)
        forces["contact_force/body"] = track.colour or BODY
    for thing in [*map(str, range(1, n)), "tilt"]:
        rec.log(track.entity(f"across/middle/{thing}"), dots(WHITE, 4.0), static=True)
        rec.log(track.entity(f"across/trail/{thing}"), dots(track.colour or BIT, 1.0), static=True)
    rec.log(track.entity("across/upright"), text, static=True)
    rec.log(track.entity("across/toolface/label"), text, static=True)
    for force, colour in forces.items():
        rec.log(track.entity(f"across/{force}"), arrows(colour), static=True)
        rec.log(track.entity(f"across/{force}/label"), text, static=True)


def log_stroke_in_space(track: Track, thing: str, stroke: Stroke) -> None:
    """The colour and width of lines in three dimensions."""
    radii = rr.Radius.ui_points(stroke.width / 2)
    track.rec.log(track.entity(thing), rr.LineStrips3D.from_fields(colors=stroke.colour, radii=radii), static=True)

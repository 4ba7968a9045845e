"""The blueprint of runs in space, as `layout` has that of runs in the plane."""

from collections.abc import Sequence

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from .key import KEY, LINE, Entry, line_count
from .layout import (
    HERE,
    TAB,
    TimePanel,
    card,
    key_bounds,
    plot,
    so_far,
    stations,
    tab,
    verdict,
    vertical_section,
    visual,
    waves,
)
from .scales import WAVES, Scales
from .space_scales import SpaceScales
from .space_scene import disc_bounds
from .style import GROUND, TABS_IN_SPACE
from .track import TIME_TIMELINE, TIMELINES, Track

TRAIL = 2.0  # waves up to the cursor, of which the view across the hole shows the way of bit and stabilizers
UP = (0.0, 0.0, -1.0)


def blueprint_in_space(
    scales: Scales, space: SpaceScales, tracks: Sequence[Track], key: Sequence[Entry]
) -> rrb.Blueprint:
    """Three columns: section, plan view and the hole in three dimensions, above the verdict; what is across the hole;
    the key above the plots.

    The parameters are those of `layout.blueprint`.
    """
    tabs = [
        tab(name, [plot(entity, scales) for entity in plots if entity in scales.ranges])
        for name, plots in TABS_IN_SPACE
    ]
    tabs[1:1] = [waves("Ripple", scales, tracks, whole=True), waves("Last waves", scales, tracks, whole=False)]
    high = LINE * line_count(key)
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(
                rrb.Horizontal(
                    rrb.Vertical(vertical_section(scales, tracks), plan_view(space, tracks), row_shares=[0.65, 0.35]),
                    rrb.Tabs(enlarged(scales, space, tracks), whole_hole(tracks)),
                    column_shares=[0.19, 0.21],
                ),
                verdict(),
                row_shares=[0.85, 0.15],
            ),
            across(scales, space, tracks),
            rrb.Vertical(
                rrb.Spatial2DView(origin=KEY, titlebar=False, background=GROUND, visual_bounds=key_bounds(high)),
                rrb.Tabs(*(one for one in tabs if one), card(), stations(), active_tab=1 if scales.rippling else 0),
                row_shares=[high, TAB],
            ),
            column_shares=[0.4, 0.17, 0.43],
        ),
        TimePanel(scales),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        auto_views=False,
        auto_layout=False,
    )


def plan_view(space: SpaceScales, tracks: Sequence[Track]) -> rrb.Spatial2DView:
    """The hole from above, north up, at true scale and as far as the cursor."""
    return rrb.Spatial2DView(
        origin="plan_view",
        name="Plan view (m)",
        background=GROUND,
        visual_bounds=visual(space.plan),
        overrides={track.entity("plan_view/drilled_hole"): so_far() for track in tracks},
    )


def enlarged(scales: Scales, space: SpaceScales, tracks: Sequence[Track]) -> rrb.Spatial3DView:
    """The hole along its trend, and its distance from that enlarged; as far as the cursor."""
    middle = (scales.start or 0.0) + scales.begin + scales.length / 2
    eye = np.array([-1.08, -0.51, -0.25]) * scales.shown_length + (0.0, 0.0, middle)
    return rrb.Spatial3DView(
        origin="enlarged",
        name=f"Ripple × {space.lateral:g}",
        background=GROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital, position=eye, look_target=(0.0, 0.0, middle), eye_up=UP
        ),
        overrides={track.entity("enlarged/tube"): so_far() for track in tracks},
    )


def whole_hole(tracks: Sequence[Track]) -> rrb.Spatial3DView:
    """The hole at true scale, as far as the cursor, around the bit."""
    reach = max(track.case.bha.stabilizer_positions[-1] for track in tracks)
    return rrb.Spatial3DView(
        origin="hole",
        name="× 1",
        background=GROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital,
            position=1.2 * reach * np.array([-1.08, -0.51, -0.25]),
            look_target=(0.0, 0.0, 0.0),
            eye_up=UP,
            tracking_entity=tracks[0].entity("hole/bit"),
        ),
        overrides={track.entity(f"hole/{thing}"): so_far() for track in tracks for thing in ("drilled_hole", "tube")},
    )


def across(scales: Scales, space: SpaceScales, tracks: Sequence[Track]) -> rrb.Spatial2DView:
    """Stabilizers, tilt and toolface as seen along the axis of the hole."""
    things = [*map(str, range(1, space.stabilizers + 1)), "tilt"]
    return rrb.Spatial2DView(
        origin="across",
        name="Looking down",
        background=GROUND,
        visual_bounds=visual(disc_bounds(len(space.discs))),
        overrides={track.entity(f"across/trail/{thing}"): trail(scales) for track in tracks for thing in things},
    )


def trail(scales: Scales) -> rrb.VisibleTimeRanges:
    """The last waves up to the cursor."""
    length = TRAIL * scales.window / WAVES
    seconds = length * (scales.duration or 0.0) / max(scales.length, length)
    starts = {
        timeline: rr.TimeRangeBoundary.cursor_relative(seconds=-seconds)
        if timeline == TIME_TIMELINE
        else rr.TimeRangeBoundary.cursor_relative(seq=-round(1000 * length))
        for timeline in TIMELINES
    }
    return rrb.VisibleTimeRanges(
        [rrb.VisibleTimeRange(timeline, start=start, end=HERE) for timeline, start in starts.items()]
    )

"""The blueprint: the arrangement of the views, what each shows, and over which ranges.

All plots over the whole run share one range of the horizontal axis: to zoom in one is to zoom in all. The plots of the
last waves follow the cursor.
"""

from collections.abc import Sequence

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from .card import CARD, VERDICT
from .key import KEY, LINE, WIDTH, Entry, line_count
from .listing import STATIONS
from .scales import Scales
from .scene import Bounds
from .style import GROUND, TABS
from .track import DEPTH_TIMELINE, TIMELINE, TIMELINES, Track

INFINITE = rr.TimeRangeBoundary.infinite()
PLAYED_IN = 30.0  # s that a run takes when it is played
HERE = rr.TimeRangeBoundary.cursor_relative(seq=0)
WHOLE_RUN = rr.TimeRange(start=INFINITE, end=INFINITE)
SHARED_AXIS = "view/5c0dca6a-e63f-9cf7-f657-2602590474cc/TimeAxis"  # where a viewer looks for the range of linked axes
# pixels of a small window, 1280 × 720: the height of a lane, of the lanes' title and axis, and of what is below the key
LANE, LANES_FRAME, TAB = 40, 60, 590


def blueprint(scales: Scales, tracks: Sequence[Track], key: Sequence[Entry]) -> rrb.Blueprint:
    """Four columns: the vertical section above the verdict; the strip; the bit frame; the key above the plots.

    Parameters
    ----------
    scales
        The scales and ranges of the views.
    tracks
        The entities of each run.
    key
        The entries of the key.
    """
    tabs = [tab(name, [plot(entity, scales) for entity in plots if entity in scales.ranges]) for name, plots in TABS]
    tabs[1:1] = [waves("Ripple", scales, tracks, whole=True), waves("Last waves", scales, tracks, whole=False)]
    high = LINE * line_count(key)
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(vertical_section(scales, tracks), verdict(), row_shares=[0.7, 0.3]),
            strip(scales, tracks),
            bit_frame(scales),
            rrb.Vertical(
                rrb.Spatial2DView(origin=KEY, titlebar=False, background=GROUND, visual_bounds=key_bounds(high)),
                rrb.Tabs(*(one for one in tabs if one), card(), stations(), active_tab=2 if scales.rippling else 0),
                row_shares=[high, TAB],
            ),
            column_shares=[0.185, 0.095, 0.215, 0.505],
        ),
        TimePanel(scales),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        auto_views=False,
        auto_layout=False,
    )


class TimePanel(rrb.TimePanel):
    """The time panel, which plays a run in half a minute, and the range of the axes that are linked.

    Rerun plays `playback_speed` seconds of time, and `playback_speed` × `fps` ticks of a length, per second. For the
    linked axes it has no part of its own.
    """

    def __init__(self, scales: Scales) -> None:
        speed = (scales.duration or PLAYED_IN) / PLAYED_IN
        ticks = max(1000 * scales.length, 1.0) / PLAYED_IN
        super().__init__(
            state="collapsed",
            timeline=first_timeline(scales),
            playback_speed=speed,
            fps=ticks / speed,
            play_state="following",
        )

    def _log_to_stream(self, stream: rr.RecordingStream) -> None:
        super()._log_to_stream(stream)
        stream.log(SHARED_AXIS, rrb.archetypes.TimeAxis(view_range=WHOLE_RUN))


def first_timeline(scales: Scales) -> str:
    """The timeline that a viewer shows first."""
    return TIMELINE if scales.start is None else DEPTH_TIMELINE


def visual(bounds: Bounds) -> rrb.VisualBounds2D:
    """The range of a view."""
    return rrb.VisualBounds2D(x_range=bounds.x, y_range=bounds.y)


def so_far() -> rrb.VisibleTimeRanges:
    """All that was logged up to the cursor, on any timeline."""
    return rrb.VisibleTimeRanges([rrb.VisibleTimeRange(timeline, start=INFINITE, end=HERE) for timeline in TIMELINES])


def vertical_section(scales: Scales, tracks: Sequence[Track]) -> rrb.Spatial2DView:
    """Existing, planned and drilled hole, BHA and bit at true scale; the hole only as far as the cursor."""
    azimuth = None if scales.space is None else round(np.rad2deg(scales.space.azimuth)) % 360
    return rrb.Spatial2DView(
        origin="vertical_section",
        name="Vertical section (m)" if azimuth is None else f"Section at {azimuth}° (m)",
        background=GROUND,
        visual_bounds=visual(scales.section),
        overrides={track.entity("vertical_section/drilled_hole"): so_far() for track in tracks},
    )


def strip(scales: Scales, tracks: Sequence[Track]) -> rrb.Spatial2DView:
    """The whole hole straightened, with its ripple, as far as the cursor."""
    return rrb.Spatial2DView(
        origin="strip",
        name=f"Ripple × {scales.strip.lateral:g}",
        titlebar=False,  # of which the view is too narrow to show more than the buttons
        background=GROUND,
        visual_bounds=visual(scales.strip.bounds),
        overrides={track.entity("strip/hole"): so_far() for track in tracks},
    )


def verdict() -> rrb.TextDocumentView:
    """Whether the holes ripple, at the cursor."""
    return rrb.TextDocumentView(origin=VERDICT, name="At the cursor")


def card() -> rrb.TextDocumentView:
    """The cases side by side."""
    return rrb.TextDocumentView(origin=CARD, name="Case")


def stations() -> rrb.TextDocumentView:
    """The holes at survey stations."""
    return rrb.TextDocumentView(origin=STATIONS, name="Stations")


def bit_frame(scales: Scales) -> rrb.Spatial2DView:
    """Hole, BHA and forces around the BHA."""
    return rrb.Spatial2DView(
        origin="bit_frame",
        name=f"Bit frame, lateral × {scales.lateral:g}",
        background=GROUND,
        visual_bounds=visual(scales.frame),
    )


def tab(name: str, views: Sequence[rrb.View]) -> rrb.Vertical | None:
    """A tab of some views; None if there are none."""
    return rrb.Vertical(*views, name=name) if views else None


def plot(entity: str, scales: Scales) -> rrb.TimeSeriesView:
    """One plot over the whole run."""
    shown = scales.plots[entity]
    return series(entity, shown.unit.heading(shown.title), scales, scales.ranges[entity], whole=True)


def waves(name: str, scales: Scales, tracks: Sequence[Track], *, whole: bool) -> rrb.Vertical:
    """A tab of ripple and modes, over the whole run or over the last waves up to the cursor."""
    lanes = LANES_FRAME + LANE * sum(track.lanes for track in tracks)
    modes = rrb.StateTimelineView(origin="modes", name=scales.lanes_title, time_view=_time_axis(scales, whole))
    return rrb.Vertical(
        series("ripple", "Ripple: hole axis less its trend (mm)", scales, scales.ripple, whole=whole),
        modes,
        name=name,
        row_shares=[max(TAB - lanes, lanes / 2), lanes],
    )


def series(
    entity: str, title: str, scales: Scales, span: tuple[float, float] | None, *, whole: bool
) -> rrb.TimeSeriesView:
    """A plot, over the whole run or over the last waves up to the cursor."""
    return rrb.TimeSeriesView(
        origin=f"plots/{entity}",
        name=f"{title} over {scales.along}",
        axis_x=_time_axis(scales, whole),
        axis_y=None if span is None else rrb.ScalarAxis(range=span, zoom_lock=True),
        plot_legend=rrb.PlotLegend(visible=False),
    )


def _time_axis(scales: Scales, whole: bool) -> rrb.TimeAxis:
    if whole:
        return rrb.TimeAxis(link=rrb.components.LinkAxis.LinkToGlobal)
    before = rr.TimeRangeBoundary.cursor_relative(seq=-round(1000 * scales.window))
    return rrb.TimeAxis(view_range=rr.TimeRange(start=before, end=HERE))


def key_bounds(high: float) -> rrb.VisualBounds2D:
    """The range of the key, of a height of `high` pixels."""
    return rrb.VisualBounds2D(x_range=(0.0, WIDTH), y_range=(0.0, high))

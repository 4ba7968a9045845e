"""The blueprint: the arrangement of the views, what each shows, and over which ranges."""

from collections.abc import Sequence

import rerun as rr
import rerun.blueprint as rrb

from .card import CARD
from .listing import STATIONS
from .scales import Scales
from .scene import Bounds
from .style import GROUND, PLOTS, TABS
from .track import TIMELINE, Track

INFINITE = rr.TimeRangeBoundary.infinite()
MOST_LANES = 5  # lanes for which the view has room; with more, one scrolls
HERE = rr.TimeRangeBoundary.cursor_relative(seq=0)


def blueprint(scales: Scales, tracks: Sequence[Track]) -> rrb.Blueprint:
    """Three columns: the vertical section above the case; the bit frame; the plots above the ripple and the modes.

    Parameters
    ----------
    scales
        The scales and ranges of the views.
    tracks
        The entities of each run.
    """
    tabs = {
        name: [plot(entity, scales, legend=len(tracks) == 1) for entity in plots if entity in scales.ranges]
        for name, plots in TABS.items()
    }
    lanes = min(sum(track.lanes for track in tracks), MOST_LANES)
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(
                vertical_section(scales, tracks), rrb.Tabs(card(), stations(), active_tab=0), row_shares=[0.6, 0.4]
            ),
            bit_frame(scales),
            rrb.Vertical(
                rrb.Tabs(*(rrb.Vertical(*plots, name=name) for name, plots in tabs.items() if plots), active_tab=0),
                ripple(scales),
                modes(scales),
                row_shares=[500, 170, 55 + 40 * lanes],
            ),
            column_shares=[0.24, 0.36, 0.4],
        ),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE, play_state="following"),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        auto_views=False,
        auto_layout=False,
    )


def _bounds(bounds: Bounds) -> rrb.VisualBounds2D:
    return rrb.VisualBounds2D(x_range=bounds.x, y_range=bounds.y)


def vertical_section(scales: Scales, tracks: Sequence[Track]) -> rrb.Spatial2DView:
    """Existing, planned and drilled hole, BHA and bit at true scale; the hole only as far as the cursor."""
    so_far = rrb.VisibleTimeRanges(timeline=TIMELINE, start=INFINITE, end=HERE)
    return rrb.Spatial2DView(
        origin="vertical_section",
        name="Vertical section, true scale (m)",
        background=GROUND,
        visual_bounds=_bounds(scales.section),
        overrides={track.entity("vertical_section/drilled_hole"): so_far for track in tracks},
    )


def card() -> rrb.TextDocumentView:
    """The cases, and whether their holes ripple."""
    return rrb.TextDocumentView(origin=CARD, name="Case")


def stations() -> rrb.TextDocumentView:
    """The holes at survey stations."""
    return rrb.TextDocumentView(origin=STATIONS, name="Stations")


def bit_frame(scales: Scales) -> rrb.Spatial2DView:
    """Hole, BHA and forces around the BHA."""
    return rrb.Spatial2DView(
        origin="bit_frame",
        name=f"Bit frame, lateral axis × {scales.lateral:g} (m)",
        background=GROUND,
        visual_bounds=_bounds(scales.frame),
    )


def plot(entity: str, scales: Scales, legend: bool) -> rrb.TimeSeriesView:
    """One plot over the whole run."""
    shown = PLOTS[entity]
    span = scales.ranges[entity]
    return rrb.TimeSeriesView(
        origin=f"plots/{entity}",
        name=f"{shown.unit.heading(shown.title)} over drilled length (mm)",
        axis_x=rrb.TimeAxis(view_range=rr.TimeRange(start=INFINITE, end=INFINITE)),
        axis_y=None if span is None else rrb.ScalarAxis(range=span),
        plot_legend=rrb.PlotLegend(rrb.Corner2D.LeftTop, visible=legend and len(shown.colours) > 1),
    )


def _last_waves(scales: Scales) -> rrb.TimeAxis:
    """The range of hole, up to the cursor, that both ripple and modes show."""
    before = rr.TimeRangeBoundary.cursor_relative(seq=-round(1000 * scales.window))
    return rrb.TimeAxis(view_range=rr.TimeRange(start=before, end=HERE))


def ripple(scales: Scales) -> rrb.TimeSeriesView:
    """The axis of the hole less its trend."""
    depth = "drilled length" if scales.start is None else f"measured depth less {scales.start:g} m"
    return rrb.TimeSeriesView(
        origin="plots/ripple",
        name=f"Ripple: hole axis less its trend (mm) over {depth} (mm)",
        axis_x=_last_waves(scales),
        axis_y=rrb.ScalarAxis(range=(-scales.ripple, scales.ripple)),
        plot_legend=rrb.PlotLegend(rrb.Corner2D.LeftTop, visible=False),
    )


def modes(scales: Scales) -> rrb.StateTimelineView:
    """Contacts and saturation as lanes."""
    return rrb.StateTimelineView(origin="modes", name="Modes over drilled length (mm)", time_view=_last_waves(scales))

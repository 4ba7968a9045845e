"""The blueprint: which view stands where, what it shows, and over which ranges."""

import rerun as rr
import rerun.blueprint as rrb

from .scene import Bounds
from .stream import TIMELINE
from .style import GROUND, PLOTS, Scales

WHOLE_RUN = rr.TimeRange(start=rr.TimeRangeBoundary.infinite(), end=rr.TimeRangeBoundary.infinite())


def blueprint(scales: Scales) -> rrb.Blueprint:
    """The vertical section, the bit frame and the plots side by side."""
    return rrb.Blueprint(
        rrb.Horizontal(
            vertical_section(scales),
            bit_frame(scales),
            rrb.Vertical(*(plot(entity, scales) for entity in scales.ranges)),
            column_shares=[0.24, 0.4, 0.36],
        ),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE, play_state="following"),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        auto_views=False,
        auto_layout=False,
    )


def _bounds(bounds: Bounds) -> rrb.VisualBounds2D:
    return rrb.VisualBounds2D(x_range=bounds.x, y_range=bounds.y)


def vertical_section(scales: Scales) -> rrb.Spatial2DView:
    """Existing and drilled hole, BHA and bit at true scale; the hole only as far as the cursor."""
    so_far = rrb.VisibleTimeRanges(
        timeline=TIMELINE, start=rr.TimeRangeBoundary.infinite(), end=rr.TimeRangeBoundary.cursor_relative(seq=0)
    )
    return rrb.Spatial2DView(
        origin="vertical_section",
        name="Vertical section, true scale (m)",
        background=GROUND,
        visual_bounds=_bounds(scales.section),
        overrides={"vertical_section/drilled_hole": so_far},
    )


def bit_frame(scales: Scales) -> rrb.Spatial2DView:
    """Hole, BHA and forces around the BHA."""
    return rrb.Spatial2DView(
        origin="bit_frame",
        name=f"Bit frame, lateral axis × {scales.lateral:g} (m)",
        background=GROUND,
        visual_bounds=_bounds(scales.frame),
    )


def plot(entity: str, scales: Scales) -> rrb.TimeSeriesView:
    """One plot over the whole run."""
    shown = PLOTS[entity]
    return rrb.TimeSeriesView(
        origin=f"plots/{entity}",
        name=f"{shown.title.format(tilt_limit=scales.tilt_limit)} ({shown.unit}) over drilled length (mm)",
        axis_x=rrb.TimeAxis(view_range=WHOLE_RUN),
        axis_y=rrb.ScalarAxis(range=scales.ranges[entity]),
        plot_legend=rrb.PlotLegend(rrb.Corner2D.LeftTop, visible=shown.legend),
    )

"""What the viewer draws, without a screen: a picture of every view."""

import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from shutil import which

import numpy as np
import pytest
import rerun as rr
import rerun.blueprint as rrb
from PIL import Image
from rerun.chunk import RrdReader
from rerun.experimental import View

from boreprop.case.case import Case
from boreprop.run.simulate import simulate
from boreprop_viz import picture
from boreprop_viz.feeder import PROGRAM
from boreprop_viz.picture import SOFTWARE_DRIVERS, Viewer, viewer
from boreprop_viz.record import record
from boreprop_viz.scene import Array
from boreprop_viz.style import BIT, BY_SEVERITY, HOLE, Colour
from boreprop_viz.track import DEPTH_TIMELINE, TIMELINE

LENGTH = 60.0
RATE = 0.5  # m/s
SIZE = 720, 450
BLANK = 1e-3  # of a picture: a line across it is three times that

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        not SOFTWARE_DRIVERS, reason="no software Vulkan driver (Debian: mesa-vulkan-drivers and libvulkan1)"
    ),
]


@pytest.fixture(scope="module")
def recorded(case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The paper's case, far enough to ripple, with its time."""
    path = tmp_path_factory.mktemp("render") / "run.rrd"
    run = simulate(replace(case, length=LENGTH), sample_interval=0.1)
    record(replace(run, columns={"time": run["drilled_length"] / RATE} | run.columns), save=path)
    return path


@pytest.fixture(scope="module")
def shown(recorded: Path) -> Iterator[Viewer]:
    with viewer(recorded, *SIZE) as started:
        yield started


def drawn(view: View, image: Image.Image) -> float:
    """Share of a view's picture that shows what is in it: colours, since ground, grid, axes and names are grey."""
    pixels = np.asarray(image, dtype=int)
    if view.view_class == "TextDocument":
        return float(np.mean(pixels.max(axis=-1) > 128))
    return float(np.mean(np.ptp(pixels, axis=-1) > 40))


def test_every_view_draws_something_and_complains_of_nothing(shown: Viewer) -> None:
    views = shown.views()
    assert len(views) >= 4
    for view in views:
        assert drawn(view, shown.picture(view)) > BLANK, view.name
        assert not shown.reports(view), view.name
    assert not shown.warnings()


@pytest.mark.parametrize(("size", "light"), [((1280, 720), True), ((1600, 900), False)])
def test_by_day_and_by_night_a_window_of_either_size_shows_all_views(
    recorded: Path, size: tuple[int, int], light: bool
) -> None:
    if light and not which("Xvfb"):
        pytest.skip("no virtual screen (Debian: xvfb)")
    with viewer(recorded, *size, light=light) as shown:
        assert not [view.name for view in shown.views() if shown.reports(view)]
        picture = np.asarray(shown.picture(), dtype=int)
    assert picture.shape[:2] == size[::-1]
    left, middle, right = np.split(picture, [round(0.29 * size[0]), round(0.52 * size[0])], axis=1)
    assert coloured(left, [HOLE]) > 100  # section and strip
    assert coloured(middle, [HOLE]) > 500  # walls
    assert coloured(middle, [BIT]) > 1000  # BHA and stabilizers
    assert coloured(right, [HOLE]) > 1000  # ripple
    ground = np.median(right.reshape(-1, 3), axis=0)
    assert np.all(ground > 230) if light else np.all(ground < 25)


def test_a_view_that_cannot_draw_complains(tmp_path: Path) -> None:
    rec = rr.RecordingStream("broken")
    layout = rrb.Blueprint(rrb.Tabs(rrb.TextDocumentView(origin="text"), rrb.Spatial2DView(origin="image")))
    rec.save(tmp_path / "broken.rrd", default_blueprint=layout)
    rec.log(
        "image", rr.Image.from_fields(buffer=b"four", format=rr.components.ImageFormat(9, 9, channel_datatype="U8"))
    )
    rec.disconnect()
    with viewer(tmp_path / "broken.rrd", *SIZE) as shown:
        [view] = [view for view in shown.views() if view.view_class == "2D"]
        shown.picture(view)
        [report] = shown.reports(view)
    assert report.severity == "error"
    assert "got 4 bytes" in report.summary


def test_a_view_without_its_data_is_blank(recorded: Path, tmp_path: Path) -> None:
    """What is left of the run are the ticks of its timeline: grids, axes and names are drawn, and no more."""
    reader, ticks, left = RrdReader(recorded), tmp_path / "ticks.rrd", tmp_path / "left.rrd"
    [run] = reader.recordings()
    rec = rr.RecordingStream(run.application_id, recording_id=run.recording_id)
    rec.save(ticks)
    for tick in (0, round(1000 * LENGTH)):
        for timeline in (TIMELINE, DEPTH_TIMELINE):
            rec.set_time(timeline, sequence=tick)
        rec.log("nowhere", rr.Scalars(0.0))
    rec.disconnect()
    data = {chunk.entity_path for chunk in reader.stream() if not chunk.is_static}
    data |= {chunk.entity_path for chunk in reader.stream().filter(components="TextDocument:text")}
    data.add("/vertical_section/severities")  # the key of the colours, which is no data
    drop = [argument for entity in sorted(data) for argument in ("--drop-entity", entity)]
    subprocess.run([PROGRAM, "rrd", "filter", *drop, recorded, ticks, "--output", left], check=True)
    with viewer(left, *SIZE) as shown:
        views = [view for view in shown.views() if view.name != "key"]
        assert len(views) >= 4
        for view in views:
            assert drawn(view, shown.picture(view)) < BLANK, view.name


def coloured(pixels: Array, colours: Sequence[Colour]) -> int:
    """How many pixels have about one of some colours."""
    return sum(int(np.count_nonzero(np.abs(pixels - colour).max(axis=-1) < 12)) for colour in colours)


@pytest.mark.parametrize("timeline", ["drilled_length_mm", "measured_depth_mm", "simulation_time"])
@pytest.mark.parametrize(("name", "colours"), [("Vertical section", BY_SEVERITY[:4]), ("Ripple ×", [HOLE])])
def test_half_way_there_is_half_of_the_hole(
    shown: Viewer, case: Case, timeline: str, name: str, colours: Sequence[Colour]
) -> None:
    [view] = [view for view in shown.views() if view.name.startswith(name)]
    counts = []
    for length in (0.0, LENGTH / 2, LENGTH):
        depth = case.survey.measured_depth[-1] + length
        if timeline == "simulation_time":
            shown.client.set_time(timeline, duration=length / RATE, play_state="paused")
        else:
            tick = round(1000 * {"drilled_length_mm": length, "measured_depth_mm": depth}[timeline])
            shown.client.set_time(timeline, sequence=tick, play_state="paused")
        counts.append(coloured(np.asarray(shown.picture(view), dtype=int), colours))
    key, half, whole = counts
    assert 0.3 < (half - key) / (whole - key) < 0.7  # the BHA covers some of the section, and a ripple has to grow


def test_the_plots_show_the_whole_run_wherever_the_cursor_is(shown: Viewer) -> None:
    [view] = [view for view in shown.views() if view.name.startswith("Inclination")]
    curves = []
    for length in (0.0, LENGTH):
        shown.client.set_time(TIMELINE, sequence=round(1000 * length), play_state="paused")
        curves.append(coloured(np.asarray(shown.picture(view), dtype=int), [HOLE]))
    assert curves[0] > 1000
    assert curves[1] == pytest.approx(curves[0], rel=0.1)


def test_the_section_shows_where_rippling_sets_in(shown: Viewer) -> None:
    """The hole is darker above than below, and the key beside it has all the colours."""
    [section] = [view for view in shown.views() if view.name.startswith("Vertical section")]
    shown.client.set_time(TIMELINE, sequence=round(1000 * LENGTH), play_state="paused")
    pixels = np.asarray(shown.picture(section), dtype=int)
    hole, key = np.split(pixels, [round(0.56 * pixels.shape[1])], axis=1)
    rows = [np.argwhere(np.abs(hole - BY_SEVERITY[band]).max(axis=-1) < 12)[:, 0] for band in (1, 3)]
    assert np.median(rows[0]) < np.median(rows[1])
    assert all(coloured(key, [colour]) for colour in BY_SEVERITY)


def test_without_a_driver_the_viewer_says_what_it_needs(monkeypatch: pytest.MonkeyPatch, recorded: Path) -> None:
    monkeypatch.setattr(picture, "SOFTWARE_DRIVERS", [Path("none.json")])
    monkeypatch.setenv("WGPU_BACKEND", "vulkan")
    with pytest.raises(RuntimeError, match=r"must find a Vulkan driver .* got exit status"), viewer(recorded):
        pass

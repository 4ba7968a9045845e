"""Runs in a notebook: what reaches the viewer's widget, and the example from top to bottom."""

import io
import re
import shutil
import subprocess
import sys
from base64 import b64decode
from copy import deepcopy
from pathlib import Path
from typing import Any

import nbformat
import numpy as np
import pytest
import rerun as rr
import rerun_notebook
from IPython.display import Image as DisplayedImage
from nbconvert import HTMLExporter
from PIL import Image
from rerun.chunk import RrdReader

from boreprop.case.case import Case
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz import show
from boreprop_viz.notebook import picture_size
from notebooks import counts, executed, kinds, printed, read
from places import EXAMPLES
from viewers import draws

NOTEBOOK = EXAMPLES / "rippling.ipynb"
LARGEST = 500_000  # bytes, of a notebook that is quick to open on a web page


@pytest.fixture(scope="module")
def run(case: Case) -> Trajectory:
    return simulate(case, sample_interval=0.5, length=20.0)


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[RrdReader]:
    """What is sent to the widget of a viewer, as it is sent."""
    pieces: list[RrdReader] = []

    def keep(_: rerun_notebook.Viewer, data: bytes) -> None:
        path = tmp_path / f"{len(pieces)}.rrd"
        path.write_bytes(data)
        pieces.append(RrdReader(path))

    monkeypatch.setattr(rerun_notebook.Viewer, "send_rrd", keep)
    return pieces


def ticks(sent: list[RrdReader], entity: str) -> list[int]:
    """The ticks of the timeline at which an entity has been sent something."""
    chunks = [
        chunk
        for piece in sent
        for recording in piece.recordings()
        for chunk in piece.stream(store=recording).filter(content=entity, has_timeline="drilled_length_mm")
    ]
    return [tick for chunk in chunks for tick in chunk.to_record_batch().column("drilled_length_mm").to_pylist()]


def millimetres(run: Trajectory) -> list[int]:
    return [int(tick) for tick in np.rint(1000 * run["drilled_length"])]


def test_every_row_of_a_run_reaches_the_widget(sent: list[RrdReader], run: Trajectory) -> None:
    show(run)
    assert ticks(sent, "/plots/inclination/bit_inclination") == millimetres(run)


def test_several_runs_reach_one_widget_under_their_names(sent: list[RrdReader], run: Trajectory, case: Case) -> None:
    other = simulate(case, sample_interval=0.7, length=28.0)
    show({"fine": run, "coarse": other})
    assert ticks(sent, "/plots/inclination/fine/bit_inclination") == millimetres(run)
    assert ticks(sent, "/plots/inclination/coarse/bit_inclination") == millimetres(other)
    assert len({store.recording_id for piece in sent for store in piece.recordings()}) == 1


def test_runs_without_names_are_numbered(sent: list[RrdReader], run: Trajectory) -> None:
    show(run, run)
    for name in ("run_1", "run_2"):
        assert ticks(sent, f"/plots/inclination/{name}/bit_inclination") == millimetres(run)


def test_a_plan_reaches_the_widget(sent: list[RrdReader], run: Trajectory) -> None:
    show(run, plan=Survey((0.0, 100.0), (0.0, 0.1)))
    assert ticks(sent, "/plots/inclination/0_plan") == millimetres(run)


def test_the_widget_gets_the_layout(sent: list[RrdReader], run: Trajectory) -> None:
    show(run)
    [layout] = {store.recording_id for piece in sent for store in piece.blueprints()}
    assert layout


def test_the_viewer_has_the_size_asked_for(run: Trajectory, monkeypatch: pytest.MonkeyPatch) -> None:
    sizes = []

    class Viewer:
        """In place of Rerun's."""

        def __init__(self, *, recording: rr.RecordingStream, width: int | str, height: int | str) -> None:
            sizes.append((width, height))

        def display(self) -> None:
            """Show nothing."""

    monkeypatch.setattr("rerun.notebook.Viewer", Viewer)
    show(run)
    show(run, width=900, height=500)
    assert sizes == [("auto", 720), (900, 500)]


@pytest.mark.parametrize(
    ("runs", "got"), [((), "none"), (({},), "none"), (("run.csv",), "str"), (({"a": None},), "NoneType")]
)
def test_what_is_no_run_is_refused(runs: tuple[Any, ...], got: str) -> None:
    with pytest.raises(InputError, match=f"must be given runs, or one mapping from names to runs, got {got}$"):
        show(*runs)


def test_nothing_is_shown_of_a_run_that_cannot_be_drawn(sent: list[RrdReader], run: Trajectory) -> None:
    with pytest.raises(InputError, match="must come with its case"):
        show(Trajectory(run.columns))
    assert not sent


@pytest.mark.parametrize("package", ["rerun", "rerun_notebook"])
def test_what_is_not_installed_is_named_with_its_extra(
    run: Trajectory, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(InputError, match=rf"{package} must be installed .* 'boreprop\[viz\]', got: "):
        show(run)


def test_importing_the_package_does_not_import_rerun() -> None:
    code = "import sys; from boreprop_viz import show; print({'rerun', 'rerun_notebook', 'fmpy'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.stdout.strip(), done.stderr) == ("set()", "")


# The still picture


@pytest.fixture(scope="module")
def committed() -> nbformat.NotebookNode:
    """The example as it is in its file."""
    return read(NOTEBOOK)


@pytest.fixture(scope="module")
def now(committed: nbformat.NotebookNode, tmp_path_factory: pytest.TempPathFactory) -> nbformat.NotebookNode:
    """The example as it runs in a new kernel, and after it a viewer of another size."""
    longer, folder = deepcopy(committed), tmp_path_factory.mktemp("example")
    longer.cells.append(nbformat.v4.new_code_cell("show(run, width=800, height=500, still=True)"))  # type: ignore[no-untyped-call]
    nbformat.write(longer, folder / NOTEBOOK.name)  # type: ignore[no-untyped-call]
    shutil.copy(EXAMPLES / "paper_case.toml", folder)
    return executed(folder / NOTEBOOK.name)


@draws
@pytest.mark.slow
def test_a_page_made_by_nbconvert_has_a_picture_of_the_viewer(now: nbformat.NotebookNode) -> None:
    assert kinds(now)[-1] == {"image/png", "text/plain"}
    page, _ = HTMLExporter().from_notebook_node(now)  # type: ignore[no-untyped-call]
    *_, picture = re.findall(r'<img[^>]* src="data:image/png;base64,([^"]+)"', page)
    shown = Image.open(io.BytesIO(b64decode(picture)))
    assert shown.size == (800, 500)
    assert len(np.unique(np.array(shown.convert("RGB")).reshape(-1, 3), axis=0)) > 20  # not an empty window


@pytest.fixture
def displayed(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What is displayed below the cell."""
    outputs: list[Any] = []
    monkeypatch.setattr("IPython.display.display", outputs.append)
    return outputs


def test_no_picture_is_taken_unless_asked_for(run: Trajectory, displayed: list[Any]) -> None:
    show(run)
    assert displayed
    assert not [output for output in displayed if isinstance(output, DisplayedImage)]


def test_the_viewer_is_shown_without_a_picture_if_none_can_be_taken(
    run: Trajectory, displayed: list[Any], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("boreprop_viz.picture.PROGRAM", shutil.which("false"))
    show(run, still=True)
    assert displayed
    assert not [output for output in displayed if isinstance(output, DisplayedImage)]
    [warning] = capsys.readouterr().err.splitlines()
    assert warning.startswith("warning: show: no still picture is left, the viewer must find a Vulkan driver")


@pytest.mark.parametrize(
    ("size", "pixels"), [(("auto", 720), (1600, 720)), (("auto", "auto"), (1600, 900)), ((640, "auto"), (640, 360))]
)
def test_the_picture_is_as_large_as_the_viewer(size: tuple[Any, Any], pixels: tuple[int, int]) -> None:
    assert picture_size(*size) == pixels


# The example


def test_the_example_is_executed_from_top_to_bottom(committed: nbformat.NotebookNode) -> None:
    assert counts(committed) == list(range(1, len(counts(committed)) + 1))
    assert committed.metadata.kernelspec.name == "python3"


def test_the_example_can_be_read_without_its_kernel(committed: nbformat.NotebookNode) -> None:
    assert {"image/png", "text/plain"} in kinds(committed)
    assert all(kind <= {"image/png", "text/plain"} for kind in kinds(committed))
    assert "widgets" not in committed.metadata
    assert NOTEBOOK.stat().st_size < LARGEST


def test_each_viewer_in_the_example_has_left_a_picture(committed: nbformat.NotebookNode) -> None:
    viewers = [cell for cell in committed.cells if cell.cell_type == "code" and "\nshow(" in "\n" + cell.source]
    assert len(viewers) == 2
    for cell in viewers:
        [output] = cell.outputs
        assert "image/png" in output.data


@draws
@pytest.mark.slow
def test_the_example_runs_in_a_new_kernel_and_says_what_is_in_its_file(
    committed: nbformat.NotebookNode, now: nbformat.NotebookNode
) -> None:
    assert printed(now) == printed(committed)
    assert kinds(now)[:-1] == kinds(committed)
    assert now.metadata == committed.metadata

"""Shows runs in a notebook, with the Rerun viewer as the output of a cell.

Rerun, and the modules that draw with it, are imported only when needed, so `import boreprop_viz` works without them.
"""

import io
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

from boreprop.cli.console import warn
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.trajectory import Trajectory

if TYPE_CHECKING:
    from .record import Drawing

STILL_WIDTH = 1600  # pixels, of the picture of a viewer that is as wide as its cell
COLOURS = 128  # in the picture: as many as one can tell apart in it, at a third of the bytes


def show(
    *runs: Trajectory | Mapping[str, Trajectory],
    plan: Survey | None = None,
    width: int | Literal["auto"] = "auto",
    height: int | Literal["auto"] = 720,
    still: bool = False,
) -> None:
    """Show runs in a Rerun viewer below the cell of a Jupyter notebook.

    The runs are sent from the notebook's kernel to the page and nowhere else. The page loads the viewer's program from
    app.rerun.io, unless the environment variable RERUN_NOTEBOOK_ASSET says otherwise before the first call. Two of its
    values need no internet: with "serve-local" the kernel serves the program to a browser on the same machine, and with
    "inline" it sends the program, 23 MB, with each viewer, wherever the browser is.

    A viewer lives as long as its kernel. After the page is reloaded, or the notebook reopened, it is empty: run the
    cell again. On a web page made from the notebook, by nbconvert or by GitHub, it shows nothing at all: there a still
    picture helps.

    Parameters
    ----------
    runs
        A run with its case, several runs to be drawn over one another, or one mapping from names to runs.
    plan
        The planned hole, with measured depths as in the survey.
    width, height
        Size of the viewer, pixels. "auto" is the width of the cell, and 9/16 of the width as height.
    still
        Whether a picture of the viewer, with all runs at their end, is left below it for pages without a kernel. This
        takes a few seconds. If it fails, for want of a graphics driver for one, there is a warning.

    Raises
    ------
    InputError
        If rerun-notebook is not installed, there is no run, a run lacks its case or a column, its drilled length
        decreases, or the plan does not reach its start.

    Examples
    --------
    ``show(run)``, ``show({"ripples": run, "more weight": heavier}, height=800)`` and ``show(run, still=True)``.
    """
    named = by_name(runs)
    try:
        import rerun  # noqa: F401
        import rerun_notebook  # noqa: F401  # Rerun imports it only when it shows something
        from rerun.notebook import Viewer
    except ModuleNotFoundError as error:
        message = f"show: {error.name} must be installed for this: pip install 'boreprop[viz]', got: {error}"
        raise InputError(message) from error
    from .record import Drawing, find_sources
    from .sinks import new_recording

    drawing = Drawing.of(find_sources(named, plan), plan)
    rec = new_recording(drawing.application)
    viewer = Viewer(recording=rec, width=width, height=height)
    drawing.draw(rec)
    rec.flush()
    viewer.display()
    if still:
        display_still(Drawing.of(find_sources(named, plan), plan), *picture_size(width, height))


def picture_size(width: int | Literal["auto"], height: int | Literal["auto"]) -> tuple[int, int]:
    """Width and height in pixels of the picture of a viewer of that size."""
    wide = STILL_WIDTH if width == "auto" else width
    return wide, wide * 9 // 16 if height == "auto" else height


def display_still(drawing: "Drawing", width: int, height: int) -> None:
    """Display a picture of the viewer of a drawing; warn if none can be taken."""
    from IPython.display import Image, display

    from .picture import viewer
    from .sinks import recording_to, scratch_file

    try:
        with scratch_file() as path:
            with recording_to(path, drawing.application) as rec:
                drawing.draw(rec)
            with viewer(path, width, height) as shown:
                picture = shown.picture()
    except (RuntimeError, OSError) as error:
        warn(f"show: no still picture is left, {error}")
        return
    png = io.BytesIO()
    picture.quantize(COLOURS).save(png, "PNG", optimize=True)
    display(Image(png.getvalue()))  # type: ignore[no-untyped-call]


def by_name(runs: tuple[Trajectory | Mapping[str, Trajectory], ...]) -> dict[str, Trajectory]:
    """Name → run: the names of the mapping, else "run", or "run 1", "run 2", …; `InputError` if they are not runs."""
    match runs:
        case [Trajectory() as run]:
            named = {"run": run}
        case [Mapping() as mapping]:
            named = dict(mapping)
        case _:
            named = {f"run {k}": run for k, run in enumerate(runs, start=1)}  # type: ignore[misc]  # checked below
    if not named or not all(isinstance(run, Trajectory) for run in named.values()):
        got = ", ".join(type(run).__name__ for run in named.values()) or "none"
        raise InputError(f"show: must be given runs, or one mapping from names to runs, got {got}")
    return named

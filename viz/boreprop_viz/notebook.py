"""Shows runs in a notebook, with the Rerun viewer as the output of a cell.

Rerun, and the modules that draw with it, are imported only when needed, so `import boreprop_viz` works without them.
"""

from collections.abc import Mapping
from typing import Literal

from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.trajectory import Trajectory


def show(
    *runs: Trajectory | Mapping[str, Trajectory],
    plan: Survey | None = None,
    width: int | Literal["auto"] = "auto",
    height: int | Literal["auto"] = 720,
) -> None:
    """Show runs in a Rerun viewer below the cell of a Jupyter notebook.

    The runs are sent from the notebook's kernel to the page and nowhere else. The program of the viewer is loaded from
    app.rerun.io. If the environment variable RERUN_NOTEBOOK_ASSET is "serve-local" before the first call, the kernel
    serves it on this machine, which needs no internet. After the page is reloaded, or the notebook reopened, the viewer
    is empty: run the cell again.

    Parameters
    ----------
    runs
        A run with its case, several runs to be drawn over one another, or one mapping from names to runs.
    plan
        The planned hole, with measured depths as in the survey.
    width, height
        Size of the viewer, pixels. "auto" is the width of the cell, and 9/16 of the width as height.

    Raises
    ------
    InputError
        If rerun-notebook is not installed, there is no run, a run lacks its case or a column, its drilled length
        decreases, or the plan does not reach its start.

    Examples
    --------
    ``show(run)`` and ``show({"ripples": run, "more weight": heavier}, height=800)``.
    """
    named = by_name(runs)
    try:
        import rerun as rr
        import rerun_notebook  # noqa: F401  # Rerun imports it only when it shows something
        from rerun.notebook import Viewer
    except ModuleNotFoundError as error:
        message = f"show: {error.name} must be installed for this: pip install 'boreprop[viz]', got: {error}"
        raise InputError(message) from error
    from .record import Drawing, find_sources

    drawing = Drawing.of(find_sources(named, plan), plan)
    rec = rr.RecordingStream(drawing.application)
    rec.set_log_time_enabled(False)
    viewer = Viewer(recording=rec, width=width, height=height)
    drawing.draw(rec)
    rec.flush()
    viewer.display()


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

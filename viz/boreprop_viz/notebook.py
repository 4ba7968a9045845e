"""Runs in a notebook: the Rerun viewer as the output of a cell.

Rerun and what draws with it are imported when they are needed, so that `import boreprop_viz` needs neither.
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

    The runs go from the kernel to the page and nowhere else. The viewer itself comes from app.rerun.io, unless the
    environment variable RERUN_NOTEBOOK_ASSET says otherwise before the first call: with "serve-local" the kernel serves
    it on this machine, which needs no internet. A viewer is empty once its page has been loaded anew, and a notebook's
    file does not keep it: run the cell again.

    Parameters
    ----------
    runs
        A run with its case, or several to be drawn over one another, or one mapping from names to runs.
    plan
        The planned hole, its measured depth counted as the survey's.
    width, height
        Of the viewer, pixels. "auto": as wide as the cell, and 9/16 of that high.

    Raises
    ------
    InputError
        If rerun-notebook is not installed, there is no run, a run lacks its case or a column, its drilled length
        decreases, or the plan ends above it.

    Examples
    --------
    ``show(run)`` and ``show({"ripples": run, "more weight": heavier}, height=800)``.
    """
    named = by_name(runs)
    try:
        import rerun as rr
        import rerun_notebook  # noqa: F401  # Rerun does without until it shows something
        from rerun.notebook import Viewer
    except ModuleNotFoundError as error:
        message = f"show: {error.name} must be installed for this: pip install 'boreprop[viz]', got: {error}"
        raise InputError(message) from error
    from .record import draw, find_sources
    from .sinks import APPLICATION

    sources = list(find_sources(named, plan))
    rec = rr.RecordingStream(APPLICATION)
    rec.set_log_time_enabled(False)
    viewer = Viewer(recording=rec, width=width, height=height)
    draw(rec, sources, plan)
    rec.flush()
    viewer.display()


def by_name(runs: tuple[Trajectory | Mapping[str, Trajectory], ...]) -> dict[str, Trajectory]:
    """The runs by name: as in the mapping, else run, or run 1, run 2, …; `InputError` if they are no runs."""
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

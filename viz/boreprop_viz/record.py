"""Runs into a recording: to a file, to a viewer, or both."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import rerun as rr

from boreprop.core.survey import Survey
from boreprop.run.trajectory import Trajectory
from boreprop_fmu.host.drive import Run

from .card import log_card
from .layout import blueprint
from .scene import bit_positions, planned_hole
from .sinks import flush, open_recording
from .source import Source, live, stored
from .stream import RunStream, log_furniture, log_grid, log_names, log_plan, make_tracks
from .style import look

Runs = Trajectory | Mapping[str, Trajectory | Run]


def record(
    runs: Runs,
    *,
    plan: Survey | None = None,
    save: str | Path | None = None,
    spawn: bool = False,
    serve: bool = False,
    connect: str | None = None,
    progress: Callable[[float], None] = lambda _: None,
) -> None:
    """Draw runs into a file, a viewer, or both.

    Parameters
    ----------
    runs
        A run with its case, or several by name. A `Run` of an FMU is drilled while it is drawn.
    plan
        The planned hole, its measured depth counted as the survey's.
    save
        The .rrd file to write. Nothing of that name changes before everything is written, or stopped by Ctrl-C.
    spawn, serve, connect
        Show it in a new viewer, in the browser, or in the viewer at an address rerun+http://HOST:PORT/proxy.
    progress
        Called with the number of rows done.

    Raises
    ------
    InputError
        If a run lacks its case or a column, its drilled length decreases, its FMU fails, or the plan ends above it.
    ConnectionError
        If there is no viewer at `connect`, and nothing to save.
    OSError
        If the file cannot be written.
    """
    sources = list(find_sources(runs, plan))
    with open_recording(save=save, spawn=spawn, serve=serve, connect=connect) as rec:
        draw(rec, sources, plan, progress)


def find_sources(runs: Runs, plan: Survey | None = None) -> Iterator[Source]:
    """What there is to draw of `runs`."""
    for name, run in {"run": runs}.items() if isinstance(runs, Trajectory) else runs.items():
        yield live(name, run, plan) if isinstance(run, Run) else stored(name, run, plan)


def draw(
    rec: rr.RecordingStream,
    sources: Sequence[Source],
    plan: Survey | None = None,
    progress: Callable[[float], None] = lambda _: None,
) -> None:
    """Log everything there is of some runs, and the blueprint, into an open recording."""
    planned = None if plan is None else planned_hole(plan, sources[0].case.survey.measured_depth[-1])
    ahead = [source.likely_positions() for source in sources] + ([] if planned is None else [planned.position])
    seen = look(
        [source.beginning for source in sources],
        whole=not any(source.live for source in sources),
        section=np.concatenate(ahead),
    )
    log_furniture(rec, seen, [source.case for source in sources])
    if planned is not None:
        log_plan(rec, planned)
    tracks = make_tracks(rec, seen, sources)
    if len(tracks) > 1:
        log_names(rec, seen, tracks)
    rec.send_blueprint(blueprint(seen, tracks))
    verdicts = ["drilling" if source.live else "" for source in sources]
    log_card(rec, sources, verdicts)
    done = 0
    for i, (source, track) in enumerate(zip(sources, tracks, strict=True)):
        stream = RunStream(track)
        for stretch in source.stretches:
            if not seen.section.hold(bit_positions(stretch.rows)):
                seen = seen.around(bit_positions(stretch.rows))
                log_grid(rec, seen)
                rec.send_blueprint(blueprint(seen, tracks))
            flush(rec)  # what came before: it would pile up in memory if the disk is slow
            stream.send(stretch)
            done += stretch.rows.row_count
            progress(done)
        verdicts[i] = stream.verdict()
        log_card(rec, sources, verdicts)

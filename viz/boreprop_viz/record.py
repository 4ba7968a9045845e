"""Draws runs into a recording, which goes to a file, to a viewer, or to both."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from secrets import token_hex
from typing import Self

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from boreprop.case.file import dump_case
from boreprop.case.parameters import parameters
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.trajectory import Trajectory

from .card import Card
from .furniture import log_furniture, log_grid, log_plan
from .key import Entry, entries, log_key
from .layout import blueprint
from .listing import Listing
from .scales import Extremes, Scales, choose_scales, choose_scales_in_space
from .scene import Array, planned_path
from .section import log_severities
from .sinks import flush, open_recording
from .source import LiveRun, Source, live, stored
from .space_furniture import log_furniture_in_space, log_plan_grid, log_plan_in_space
from .space_layout import blueprint_in_space
from .space_stream import SpaceStream
from .stream import RunStream
from .strip import log_strip_grid
from .track import Track, make_tracks

LONGEST_NAME = 100  # letters of the name of an application: Rerun allows some 150

Runs = Trajectory | Mapping[str, Trajectory | LiveRun]


def record(
    runs: Runs,
    *,
    plan: Survey | None = None,
    save: str | Path | None = None,
    spawn: bool = False,
    serve: bool = False,
    connect: str | None = None,
    port: int | None = None,
    progress: Callable[[float], None] = lambda _: None,
) -> None:
    """Draw runs into a file, a viewer, or both.

    Parameters
    ----------
    runs
        A run with its case, or several: name → run. A live run, such as `boreprop_fmu.host.drive.FmuRun`, is drilled
        while it is drawn.
    plan
        The planned hole, with measured depths as in the survey.
    save
        The .rrd file to write. An existing file is replaced only at the end, or at Ctrl-C by the data up to then.
    spawn, serve, connect
        Show the runs in a new viewer, in the browser, or in the viewer at an address rerun+http://HOST:PORT/proxy.
    port
        With `serve`, the port of the page; the data are at the next one. With `spawn`, the port at which the viewer
        takes further data.
    progress
        Called with the number of rows done.

    Raises
    ------
    InputError
        If a run lacks its case or a column, its drilled length decreases, a live run fails, or the plan does not reach
        the start of the run.
    ConnectionError
        If there is no viewer at `connect`, and nothing to save.
    OSError
        If the file cannot be written.
    """
    drawing = Drawing.of(find_sources(runs, plan), plan)
    with open_recording(drawing.application, save=save, spawn=spawn, serve=serve, connect=connect, port=port) as rec:
        drawing.draw(rec, progress)


def find_sources(runs: Runs, plan: Survey | None = None) -> Iterator[Source]:
    """The source of each run."""
    for name, run in {"run": runs}.items() if isinstance(runs, Trajectory) else runs.items():
        yield stored(name, run, plan) if isinstance(run, Trajectory) else live(name, run, plan)


@dataclass(frozen=True)
class Drawing:
    """Runs that are ready to be drawn in one recording.

    Parameters
    ----------
    sources
        The runs.
    plan
        The planned hole, if there is one, with measured depths as in the survey.
    scales
        The scales and ranges of the views that suit all of them.
    """

    sources: Sequence[Source]
    plan: Survey | None
    scales: Scales

    @classmethod
    def of(cls, sources: Iterable[Source], plan: Survey | None = None) -> Self:
        """Choose the scales; `InputError` if the plan does not reach the start of a run."""
        sources = list(sources)
        if any(source.spatial for source in sources):
            return cls(sources, plan, scales_in_space(sources, plan))
        ahead = [source.likely_positions() for source in sources]
        if plan is not None:
            ahead += planned_paths(plan, sources)
        scales = choose_scales(
            [source.beginning for source in sources],
            whole=not any(source.live for source in sources),
            section=np.concatenate(ahead),
        )
        return cls(sources, plan, scales)

    @property
    def name(self) -> str:
        """The name of the recording: those of its runs."""
        return " + ".join(source.name for source in self.sources)

    @property
    def application(self) -> str:
        """What Rerun calls the application: its name with a digest of the look.

        A viewer keeps one layout for all recordings of an application, the newest, so recordings that look different
        must have different applications. How a live run will look in the end is not known, so its application is its
        own.
        """
        if any(source.live for source in self.sources):
            return application_of_its_own(self.name)
        look = repr((self.scales, [(source.name, source.case) for source in self.sources], version("boreprop")))
        return application(self.name, sha256(look.encode()).hexdigest()[:8])

    def draw(self, rec: rr.RecordingStream, progress: Callable[[float], None] = lambda _: None) -> None:
        """Log the runs and the blueprint into an open recording.

        Parameters
        ----------
        rec
            The recording.
        progress
            As in `record`.

        Raises
        ------
        InputError
            If a live run fails.
        OSError
            If the recording's file cannot be written.
        """
        sources, scales = self.sources, self.scales
        rec.send_recording_name(self.name)
        log_cases(rec, sources)
        if scales.space is None:
            log_furniture(rec, scales, [source.case for source in sources])
        else:
            log_furniture_in_space(rec, scales, scales.space, [source.beginning for source in sources])
        log_frames(rec, scales)
        if self.plan is not None:
            paths = planned_paths(self.plan, sources)
            if scales.space is None:
                log_plan(rec, paths)
            else:
                log_plan_in_space(rec, scales.space, paths)
        tracks = make_tracks(rec, scales, sources)
        key = entries(tracks, planned=self.plan is not None)
        log_key(rec, key)
        rec.send_blueprint(arranged(scales, tracks, key))
        card, listing = Card(rec, scales, sources), Listing(rec, self.plan)
        extremes, done = Extremes(scales.plots), 0
        try:
            for i, (source, track) in enumerate(zip(sources, tracks, strict=True)):
                stream = new_stream(replace(track, scales=scales))
                with (
                    listing.listed(source, stream.verdict) as follow,
                    card.ending(i, stream.verdict, source.beginning.stopped),
                ):
                    for stretch in source.stretches:
                        if not scales.hold(stretch.rows):
                            scales = scales.widened(stretch.rows)
                            stream.rescale(scales)
                            log_frames(rec, scales)
                            rec.send_blueprint(arranged(scales, tracks, key))
                        # the stretch before this one would pile up in memory if the disk is slow
                        flush(rec)
                        card.say(i, stream.send(stretch))
                        follow(stretch.rows)
                        extremes.take(scales.plotted(stretch.rows))
                        done += stretch.rows.row_count
                        progress(done)
        finally:
            if any(source.live for source in sources):
                rec.send_blueprint(arranged(extremes.complete(scales), tracks, key))


def scales_in_space(sources: Sequence[Source], plan: Survey | None) -> Scales:
    """The scales of runs in space; `InputError` if one is in the plane, or a plan lies in no plane of all."""
    in_plane = [source.name for source in sources if not source.spatial]
    if in_plane:
        raise InputError(
            f"{in_plane[0]}: must be a run in space like the others, got one in the plane: drill it with "
            "drilling.dimensions = 3"
        )
    ahead = [source.likely_positions_in_space() for source in sources]
    if plan is not None:
        azimuths = {source.case.survey.azimuth[-1:] or (0.0,) for source in sources}
        if not plan.azimuth and len(azimuths) > 1:
            raise InputError(
                "azimuth of the plan: must be given with runs that start in different directions, got none: "
                "add a column azimuth_deg"
            )
        ahead += planned_paths(plan, sources)
    return choose_scales_in_space(
        [source.beginning for source in sources],
        whole=not any(source.live for source in sources),
        positions=np.concatenate(ahead),
    )


def new_stream(track: Track) -> RunStream | SpaceStream:
    """What draws a run, in the plane or in space."""
    return RunStream(track) if track.scales.space is None else SpaceStream(track, track.scales.space)


def arranged(scales: Scales, tracks: Sequence[Track], key: Sequence[Entry]) -> rrb.Blueprint:
    """The blueprint of runs in the plane or in space."""
    if scales.space is None:
        return blueprint(scales, tracks, key)
    return blueprint_in_space(scales, scales.space, tracks, key)


def planned_paths(plan: Survey, sources: Sequence[Source]) -> list[Array]:
    """The planned path from each measured depth at which runs start, as the pictures begin where drilling starts."""
    starts = {source.case.survey.measured_depth[-1]: source for source in sources}
    return [planned_path(plan, source.case, in_space=source.spatial) for source in starts.values()]


def application_of_its_own(name: str) -> str:
    """What Rerun calls the application of a recording that shares its look with no other."""
    return application(name, token_hex(4))


def application(name: str, digest: str) -> str:
    """What Rerun calls the application of a recording: the name of the recording, as far as allowed, and a digest."""
    return f"boreprop: {name[:LONGEST_NAME]} {digest}"


def log_frames(rec: rr.RecordingStream, scales: Scales) -> None:
    """What is at fixed places of the section and the strip."""
    log_grid(rec, scales.section)
    if scales.space is None:
        log_strip_grid(rec, scales)
    else:
        log_plan_grid(rec, scales.space)
    if len(scales.strip.lanes) == 1:  # the holes of several runs have the colours of the runs
        log_severities(rec, scales)


def log_cases(rec: rr.RecordingStream, sources: Sequence[Source]) -> None:
    """The cases as properties of the recording: each with its parameters, SI units, and as the text of a case file."""
    for source in sources:
        name = "case" if len(sources) == 1 else f"case {source.name}"
        values = parameters(source.case) | {"case_file": dump_case(source.case)}
        arrays = {what: np.array([value]) for what, value in values.items()}  # of anything else pyarrow asks pandas
        rec.send_property(name, rr.AnyValues(drop_untyped_nones=True, **arrays))

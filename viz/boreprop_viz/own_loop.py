"""Draws the run of one's own loop, such as one that steps an FMU, while it goes on."""

from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import inf, isfinite
from pathlib import Path
from threading import Event, Thread
from typing import Any

import numpy as np
import rerun as rr
from numpy.typing import ArrayLike

from boreprop.analysis.plan import check_reach, read_plan
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.packed import read_packed_case
from boreprop.cli.console import check_output, warn
from boreprop.core.quantities import BY_NAME, CLEARANCES, Structure, names_of_runs
from boreprop.core.survey import Survey
from boreprop.errors import InputError, shown

from .record import Drawing, application_of_its_own
from .sinks import open_recording
from .source import live as live_source
from .source import rows_of
from .without_pandas import skip_pandas_check

TICK = 0.05  # s between two looks for new rows: the thread that draws is not woken by each of them
NUMBERS = frozenset((float, int, np.float64))
ALONG = ("time", "drilled_length")  # these must not decrease


@contextmanager
def live(
    case_or_fmu: Case | str | Path,
    plan: Survey | str | Path | None = None,
    *,
    name: str | None = None,
    spawn: bool = False,
    serve: bool = False,
    connect: str | None = None,
    port: int | None = None,
    save: str | Path | None = None,
) -> Iterator["LiveView"]:
    """Draw the run of one's own loop while it goes on: ``with live(…) as view: … view.send(time=…, **outputs)``.

    The loop is never held up by a slow disk or viewer: `LiveView.send` puts a row into a queue, which another thread
    draws. The two share the interpreter: at 100 steps a second a step took 0.1 ms longer on average and 5 ms at most.
    Rows that are not drawn yet wait in memory, and the end of the block waits until all are drawn. With `spawn` it then
    waits until the viewer is closed, with `serve` until Ctrl-C. However the block ends, `save` has all rows up to then;
    after an exception, or Ctrl-C, a viewer that was started is closed.

    Parameters
    ----------
    case_or_fmu
        What is drilled: a case, a case file, or an FMU of boreprop-fmu, which holds its case.
    plan
        The planned hole, with measured depths as in the survey, or its file.
    name
        The name of the run. Default: that of the file without its ending, or "run".
    spawn, serve, connect
        Show the run in a new viewer, in the browser, or in the viewer at an address rerun+http://HOST:PORT/proxy. At
        most one.
    port
        With `serve`, the port of the page; the data are at the next one. With `spawn`, the port at which the viewer
        takes further data.
    save
        The .rrd file to write. An existing file is replaced at the end of the block, unless no row was sent.

    Yields
    ------
    LiveView
        It takes the rows.

    Raises
    ------
    InputError
        At once, if an argument cannot be used or the viewer does not start. At the end, if no row was sent.
    ConnectionError
        If there is no viewer at `connect`, and nothing to save.
    OSError
        At the end, if the file cannot be written; the loop goes on until then. If the block ends with an exception of
        its own, that is raised, and what was wrong with the drawing is a warning.

    Examples
    --------
    With a slave of fmpy::

        names = [variable.name for variable in description.modelVariables if variable.causality == "output"]
        with boreprop_viz.live("Borehole.fmu", plan="plan.csv", spawn=True, save="loop.rrd") as view:
            while time < stop:
                slave.setReal([rss_force], [controller(…)])
                slave.doStep(time, step)
                time += step
                view.send(time=time, **dict(zip(names, read(slave))))
    """
    skip_pandas_check()  # which the thread would do, and hold the loop up
    case = case_from(case_or_fmu)
    start = case.survey.measured_depth[-1]
    planned = read_plan(plan, start) if isinstance(plan, str | Path) else plan
    if planned is not None:
        check_reach(planned, start)
    check_sinks(spawn, serve, connect, save)
    name = name or ("run" if isinstance(case_or_fmu, Case) else Path(case_or_fmu).stem)
    ended = None
    try:
        with open_recording(
            application_of_its_own(name), save=save, spawn=spawn, serve=serve, connect=connect, port=port
        ) as rec:
            view = LiveView(name, case, planned, rec)
            try:
                yield view
            except BaseException as error:
                ended = error
            view.finish(ended)
            if ended:
                raise KeyboardInterrupt  # so the file is kept, and the viewer closed
    except BaseException as error:
        if ended is None:
            raise
        if not isinstance(error, KeyboardInterrupt):
            warn(str(error))
    if ended:
        raise ended


def case_from(case_or_fmu: Case | str | Path) -> Case:
    """The case, or that of a case file or in an FMU."""
    if isinstance(case_or_fmu, Case):
        return case_or_fmu
    path = Path(case_or_fmu)
    match path.suffix:
        case ".toml":
            return load_case(path)
        case ".fmu":
            packed = read_packed_case(path)
            if packed is None:
                raise InputError(f"{path}: must hold a case, as FMUs of boreprop-fmu do, got none: give the case")
            return packed
    raise InputError(f"{path}: must be a case, or end in .toml or .fmu, got {path.suffix!r}")


def check_sinks(spawn: bool, serve: bool, connect: str | None, save: str | Path | None) -> None:
    """Raise `InputError` if there is nothing to draw into, or several viewers, or no such file can be written."""
    viewers = spawn + serve + (connect is not None)
    if viewers > 1:
        raise InputError(f"spawn, serve, connect: at most one must be given, got {viewers}")
    if not viewers and save is None:
        raise InputError("spawn, serve, connect, save: one must be given, got none")
    if save is not None:
        check_output(save, (".rrd",))


class LiveView:
    """Takes the rows of one's own loop, and has them drawn by another thread. Made by `live`."""

    def __init__(self, name: str, case: Case, plan: Survey | None, rec: rr.RecordingStream) -> None:
        self._rows = Rows(case)
        self._before: Mapping[str, float] = dict.fromkeys(ALONG, -inf)  # the last row
        self._failure: BaseException | None = None  # why nothing more is drawn
        self._thread = Thread(target=self._draw, args=(name, plan, rec), daemon=True)

    def send(self, *, time: float, **values: ArrayLike) -> None:
        """Draw a row, soon.

        Parameters
        ----------
        time
            Time, s. It must not decrease.
        values
            Inputs and outputs of the FMU, in SI units, the same ones at each call. Those of a stabilizer go by scalar
            name, ``**{"stabilizer_force[1]": 9e3}``, or all together, ``stabilizer_force=[9e3]``. Needed are
            drilled_length, displacement, true_vertical_depth and average_inclination; two of bit_inclination,
            borehole_inclination and bit_tilt; and rss_force, or stabilizer_force with bit_lateral_force or bit_moment.
            What is left out is computed from the others or, if they do not determine it, not shown.

        Raises
        ------
        InputError
            If a value is missing, unknown or not finite, time or drilled_length decreases, or the block has ended.
        """
        rows = self._rows
        if rows.ended.is_set():
            raise InputError(f"send: must be called inside the with block, got a row at {time:g} s after its end")
        row = scalars({"time": time, **values}, rows.case.structure)
        if not rows.columns:
            rows.begin(row)
            self._thread.start()
        if row.keys() != rows.names:
            others = ", ".join(sorted(row.keys() ^ rows.names))
            raise InputError(f"send: must be given the same values each time, got a difference in {others}")
        if not isfinite(sum(row.values())):
            check_finite(row)
        for name in ALONG:
            if row[name] < self._before[name]:
                raise InputError(f"{name}: must not decrease, got {row[name]:.9g} after {self._before[name]:.9g}")
        self._before = row
        if self._failure is None:
            rows.waiting.append([row[name] for name in rows.columns])

    def finish(self, error: BaseException | None) -> None:
        """Wait until all rows are drawn; raise what went wrong, or `InputError` if there was no row.

        `error` is what ended the loop; None if it came to its end.
        """
        if isinstance(error, Exception):
            self._rows.error = InputError(f"{type(error).__name__}: {error}")
        elif error is not None:
            self._rows.error = KeyboardInterrupt()
        self._rows.ended.set()
        if not self._rows.columns:
            raise InputError("send: must be called at least once in the with block, got no row to draw")
        try:
            self._thread.join()
        except KeyboardInterrupt:  # of someone who cannot wait
            self._rows.waiting.clear()
            self._thread.join()
            raise
        if self._failure is not None:
            raise self._failure

    def _draw(self, name: str, plan: Survey | None, rec: rr.RecordingStream) -> None:
        try:
            Drawing.of([live_source(name, self._rows, plan)], plan).draw(rec)
        except BaseException as error:
            if error is not self._rows.error:
                self._failure = error
                self._rows.waiting.clear()


class Rows:
    """The rows of a loop as a `LiveRun`: one thread appends them to `waiting`, another takes them from there.

    Attributes
    ----------
    case, n
        What is drilled, and its number of stabilizers.
    columns, names
        The names of the values of a row, in order and as a set; empty before the first row.
    waiting
        The rows that are not taken yet.
    error
        What ended the loop, raised after the last row; None if it came to its end.
    ended
        Set when no more rows will come.
    """

    def __init__(self, case: Case) -> None:
        self.case, self.n = case, len(case.bha.stabilizer_positions)
        self.columns: list[str] = []
        self.names: set[str] = set()
        self.waiting: deque[list[float]] = deque()
        self.error: BaseException | None = None
        self.ended = Event()

    def begin(self, row: Mapping[str, float]) -> None:
        """Let rows have the values of this one; `InputError` if one is unknown, not finite or missing."""
        known = {"time", *names_of_runs(self.n), *CLEARANCES[: self.n - 1]}
        for name in row:
            if name not in known:
                raise InputError(f"send: must be given time and inputs and outputs of the FMU alone, got {name!r}")
        check_finite(row)
        columns = list(row)
        rows_of(self.case, columns, [list(row.values())])  # raises if one is missing
        self.columns, self.names = columns, set(columns)

    def __iter__(self) -> Iterator[list[float] | None]:
        """The rows as they come; None when there is none for the moment; at last what ended the loop is raised."""
        over = False
        while not over:
            over = self.ended.wait(TICK)  # asked before the last look, so that no row is missed
            while self.waiting:
                yield self.waiting.popleft()
            yield None
        if self.error is not None:
            raise self.error


def scalars(values: dict[str, Any], structure: int | Structure) -> dict[str, float]:
    """Values by scalar name, from values of quantities, some of which are one for each stabilizer or sensor."""
    if NUMBERS.issuperset(map(type, values.values())):
        return values
    by_name: dict[str, float] = {}
    for name, value in values.items():
        try:
            elements = np.asarray(value, dtype=float)
        except (TypeError, ValueError) as error:
            raise InputError(f"{name}: must be a number, or one for each stabilizer, got {shown(value)}") from error
        if elements.ndim == 0:
            by_name[name] = float(elements)
            continue
        names = BY_NAME[name].names(structure) if name in BY_NAME else [name]
        if elements.shape != (len(names),):
            raise InputError(f"{name}: must have {len(names)} values, got the shape {elements.shape}")
        by_name |= zip(names, elements.tolist(), strict=True)
    return by_name


def check_finite(row: Mapping[str, float]) -> None:
    """Raise `InputError` if a value is not a finite number."""
    for name, value in row.items():
        if not isfinite(value):
            raise InputError(f"{name}: must be a finite number, got {value} at {row['time']:g} s")

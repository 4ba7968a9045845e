"""The work of the command `boreprop-view`: opens runs and draws them."""

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from boreprop.analysis.plan import read_plan
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.packed import read_packed_case, read_schedules_for
from boreprop.cli import console
from boreprop.cli.cases import open_case
from boreprop.cli.fallback import warn_of_fallback
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.results import SUFFIXES, read_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped, Trajectory

from .record import Drawing
from .sinks import open_recording
from .source import Source, live, stored
from .without_pandas import skip_pandas_check


@dataclass
class Opener:
    """Opens result files, cases (which it simulates first) and FMUs (which it drives).

    Parameters
    ----------
    case, fmu
        The case of the result files, or the FMU that holds it. None: the case stored with each file.
    plan
        The file with the planned hole.
    schedule
        Schedules of inputs for an FMU. None: those packed in it.
    step, stop
        Communication step and end, s, for an FMU. None: those of its default experiment.
    pace
        Seconds of an FMU's simulation per second of the clock. None: as fast as it goes.
    """

    case: Path | None
    fmu: Path | None
    plan: Path | None
    schedule: Path | None
    step: float | None
    stop: float | None
    pace: float | None
    stopped: list[Stopped] = field(default_factory=list)  # from runs that ended early; they are drawn all the same

    def open(self, name: str, path: Path) -> Source:
        """The source of a run, under a name."""
        if path.suffix == ".fmu":
            from boreprop_fmu.host.drive import FmuRun  # imported here, since importing fmpy takes long

            forces, inputs = (None, None) if self.schedule is None else read_schedules_for(path, self.schedule)
            fmu_run = FmuRun(path, forces, inputs, step=self.step, stop=self.stop)
            return live(name, fmu_run, self.planned(fmu_run.case), pace=self.pace)
        try:
            run = self._run(path)
        except Stopped as error:
            if error.trajectory is None:
                raise
            self.stopped.append(error)
            run = error.trajectory
        plan = self.planned(run.case)
        try:
            return stored(name, run, plan)
        except InputError as error:
            raise InputError(f"{path}: {error}") from error

    def planned(self, case: Case | None) -> Survey | None:
        """The plan for a run of a case; `InputError` if it does not include where the case starts."""
        return None if self.plan is None or case is None else read_plan(self.plan, case.survey.measured_depth[-1])

    def _run(self, path: Path) -> Trajectory:
        """The run in a result file, or that of a case file, which is simulated now."""
        if path.suffix == ".toml":
            if self.case or self.fmu:
                raise InputError(f"{path}: must be a result file with --case or --fmu, got a case file")
            case = open_case(path, in_plane=False)
            self.planned(case)  # raises before anything is drilled
            if not case.in_space:
                warn_of_fallback()
            with console.progress("drilling", case.length) as drilled:
                return simulate(case, progress=drilled)
        if path.suffix not in SUFFIXES:
            raise InputError(f"{path}: must end in {', '.join(SUFFIXES)}, .fmu or .toml, got {path.suffix!r}")
        if self.fmu is None:
            return read_trajectory(path, None if self.case is None else load_case(self.case))
        packed = read_packed_case(self.fmu)
        if packed is None:
            raise InputError(f"{self.fmu}: must hold a case, as FMUs of boreprop-fmu do, got none: use --case")
        return read_trajectory(path, packed)


def show(
    sources: list[Path],
    *,
    case: Path | None,
    fmu: Path | None,
    plan: Path | None,
    schedule: Path | None,
    step: float | None,
    stop: float | None,
    pace: float | None,
    save: Path | None,
    spawn: bool,
    serve: bool,
    connect: str | None,
    port: int | None,
) -> None:
    """Draw runs, see the options of the command."""
    skip_pandas_check()
    opener = Opener(case, fmu, plan, schedule, step, stop, pace)
    opened = [opener.open(name, path) for name, path in zip(names(sources), sources, strict=True)]
    drawing = Drawing.of(opened, opener.planned(opened[0].case))
    rows = sum(source.row_count or 0 for source in opened)
    with (
        open_recording(drawing.application, save=save, spawn=spawn, serve=serve, connect=connect, port=port) as rec,
        console.progress("drawing", rows) as done,
    ):
        drawing.draw(rec, done)
    if save is not None:
        print(f"{save}: {rows} rows, {save.stat().st_size / 1e6:.1f} MB")
    if opener.stopped:
        raise opener.stopped[0]


def names(sources: list[Path]) -> list[str]:
    """The names of the runs: the shortest of stem, file name and path with which all are different."""
    for short in (lambda path: path.stem, lambda path: path.name, str):
        found = [short(source) for source in sources]
        if len(set(found)) == len(found):
            return found
    [(twice, _)] = Counter(sources).most_common(1)
    raise InputError(f"{twice}: must be given once, got it twice")

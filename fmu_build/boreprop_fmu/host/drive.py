"""Drives an FMU that has the names of the table of quantities, through fmpy, under the inputs of a case."""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import inf, isclose
from pathlib import Path
from typing import Any

import numpy as np
from fmpy.fmi1 import FMICallException

from boreprop.case.inputs import RATE, InputSchedule, Schedule
from boreprop.case.packed import read_packed_case
from boreprop.core.checks import check_number
from boreprop.core.quantities import CLEARANCES, names_of_runs
from boreprop.errors import InputError
from boreprop.run.course import Course
from boreprop.run.ground import rock_in_layers
from boreprop.run.trajectory import Stopped, Trajectory

from .instance import interruptions, open_instance, read_description, uninterrupted

MAX_ROWS = 10_000_000  # more would need gigabytes of memory
MAX_POINTS = 2**53  # more are no different times
CLOSE = 1e-9  # of a step: times closer than this are taken as equal, for they differ by rounding
ROUNDING = 1e-12  # relative: inputs closer than this are taken as equal


class FmuRun:
    """A run of an FMU. Iterating over it gives a row at each communication point start + k·step, k = 0, 1, …

    Parameters
    ----------
    fmu
        An FMI 2.0 co-simulation FMU with an input rss_force and an output drilled_length.
    schedule
        The force over the drilled length; a step in which it changes is split there. None: the schedule of the case
        that is packed in the FMU or, without one, the FMU's own start value.
    inputs
        Other inputs over the drilled length. None: those of the case that is packed in the FMU.
    step, stop
        Communication step and last communication point, s. None: those of the FMU's default experiment.
    relative_tolerance
        The FMU's parameter of that name. None: the value packed in the FMU.

    Attributes
    ----------
    columns
        The names of the values of a row: time, then the FMU's inputs and outputs that are in the table of quantities,
        in its order.
    case
        The case packed in the FMU, with the schedule of this run; None if there is none.
    start, step, stop
        First communication point, communication step and last communication point, s.
    warning
        The first warning that the FMU has logged so far; empty without one.

    Raises
    ------
    InputError, ParameterError
        If the FMU or a value cannot be used. While iterating, if a call fails; the message is then the FMU's own.
    """

    def __init__(
        self,
        fmu: str | Path,
        schedule: Schedule | None = None,
        inputs: InputSchedule | None = None,
        *,
        step: float | None = None,
        stop: float | None = None,
        relative_tolerance: float | None = None,
    ) -> None:
        self.fmu = Path(fmu)
        self._description = read_description(self.fmu)
        self.case = read_packed_case(self.fmu)
        if self.case is not None:
            self.case = replace(
                self.case,
                schedule=schedule or self.case.schedule,
                inputs=inputs or self.case.inputs,
            )
        self._course = self._course_of(schedule, inputs)
        experiment = self._description.defaultExperiment
        self.start = float(getattr(experiment, "startTime", None) or 0.0)
        self.step = self._choose("step", step, getattr(experiment, "stepSize", None))
        self.stop = self._choose("stop", stop, getattr(experiment, "stopTime", None))
        check_number("step", self.step, above=0.0)
        check_number("stop", self.stop, at_least=self.start)
        check_number("step", self.step, at_least=(self.stop - self.start) / MAX_POINTS)
        self._variables = {variable.name: variable for variable in self._description.modelVariables}
        self._tolerance = relative_tolerance
        self.warning = ""
        for name in ("rss_force", "drilled_length") + ("relative_tolerance",) * (relative_tolerance is not None):
            if name not in self._variables:
                raise InputError(f"{fmu}: must have a variable {name!r}, got {', '.join(self._variables) or 'none'}")
        if self._course and "rss_toolface" in self._course.names and "rss_toolface" not in self._variables:
            raise InputError(f"{fmu}: must be made of a case in space for a toolface, got one that drills in a plane")
        n = sum(name.startswith("average_inclination[") for name in self._variables)
        scheduled = [name for name in CLEARANCES if self._course and name in self._course.names]
        own = [name for name in (*names_of_runs(n), *scheduled) if name in self._variables]
        self.columns = ["time", *own]

    def __len__(self) -> int:
        return int((self.stop - self.start) / self.step + CLOSE) + 1

    def __iter__(self) -> Iterator[list[float]]:
        messages: deque[str] = deque(maxlen=1)
        time, handlers = self.start, interruptions()
        try:
            with open_instance(
                self.fmu, self._description, messages, start=self.start, stop=self.stop, warn=self._heed
            ) as slave:
                with uninterrupted(handlers):
                    if self._tolerance is not None:
                        slave.setReal([self._variables["relative_tolerance"].valueReference], [self._tolerance])
                    inputs = GivenInputs(slave, self._variables, self._course, self.start)
                    read = self._reader(slave)
                    self._advance(time, time, inputs)
                    slave.exitInitializationMode()
                for k in range(len(self)):
                    point = self.start + k * self.step
                    with uninterrupted(handlers):
                        self._advance(time, point, inputs)
                        time = point
                        row = [time, *read()]
                    yield row
        except FMICallException as error:
            raise InputError(f"{self.fmu}: at {time:.9g} s: {' '.join(messages) or error}") from error

    def trajectory(self, progress: Callable[[float], None] | None = None) -> Trajectory:
        """The whole run, with its case; `progress` is called with the time, s, after each row.

        Raises `Stopped`, with the rows up to there, if a call fails after the first row.
        """
        if len(self) > MAX_ROWS:
            raise InputError(
                f"step: must give at most {MAX_ROWS} rows up to {self.stop:g} s, got {self.step:g} s; raise --step"
            )
        rows, done, stopped = np.empty((len(self), len(self.columns))), 0, None
        try:
            for row in self:
                rows[done] = row
                done += 1
                if progress:
                    progress(row[0])
        except InputError as error:
            if not done:
                raise
            stopped = str(error)
        columns = dict(zip(self.columns, rows[:done].T.copy(), strict=True))
        if self.case is not None and self.case.in_layers:
            columns |= rock_in_layers(self.case, columns["formation"])
        trajectory = Trajectory(columns, self.case, stopped)
        if stopped:
            raise Stopped(stopped, trajectory)
        return trajectory

    def _heed(self, warning: str) -> None:
        self.warning = self.warning or warning

    def _choose(self, name: str, given: float | None, default: str | float | None) -> float:
        if given is None and default is None:
            raise InputError(f"{self.fmu}: {name}: must be given (--{name}), since the FMU has no default, got nothing")
        return float(default if given is None else given)  # type: ignore[arg-type]

    def _course_of(self, schedule: Schedule | None, inputs: InputSchedule | None) -> Course | None:
        """The inputs of the run; `InputError` if the FMU cannot follow them."""
        if self.case is not None:
            profiles = self.case.profiles()
        else:
            profiles = {} if schedule is None else {"rss_force": schedule.profile()}
            profiles |= {} if inputs is None else inputs.profiles()
        if not profiles:
            return None
        course = Course.of(profiles)
        if course.slopes.any() and not self._description.coSimulation.canInterpolateInputs:
            remedy = "build it with --runtime native, or take held schedules"
            raise InputError(
                f"{self.fmu}: must interpolate inputs for a linear schedule, got one that does not: {remedy}"
            )
        return course

    def _advance(self, time: float, point: float, inputs: "GivenInputs") -> None:
        """Step from `time` to `point`; the inputs change on the way and at the end."""
        close = CLOSE * self.step
        while inputs.next_change <= point + close:
            change = inputs.next_change
            end = change if change < point - close else point
            if time < end:
                inputs.step(time, end)
                time = end
            inputs.change()
        if time < point:
            inputs.step(time, point)

    def _reader(self, slave: Any) -> Callable[[], list[float]]:
        """A function that reads the values of all columns but the time."""
        variables = [self._variables[name] for name in self.columns[1:]]
        integer = [variable.type == "Integer" for variable in variables]
        reals = [v.valueReference for v, is_integer in zip(variables, integer, strict=True) if not is_integer]
        integers = [v.valueReference for v, is_integer in zip(variables, integer, strict=True) if is_integer]

        def read() -> list[float]:
            values = {True: iter(slave.getInteger(integers)), False: iter(slave.getReal(reals))}
            return [next(values[is_integer]) for is_integer in integer]

        return read


class GivenInputs:
    """The inputs that an instance is given: values where another piece of their course starts, then derivatives."""

    def __init__(self, slave: Any, variables: dict[str, Any], course: Course | None, start: float) -> None:
        self._slave, self._course = slave, course
        self._changes: deque[tuple[float, int]] = deque()  # time, and the piece that starts then
        self._given: dict[str, float] = {}
        self._slopes: dict[int, float] = {}  # reference → change per second
        if course is None:
            return
        names = [name for name in course.names if name in variables]
        self._references = {name: variables[name].valueReference for name in names}
        self._whole = {name for name in names if variables[name].type == "Integer"}
        self._rates = np.ones(len(course.starts))
        if RATE in course.names:
            self._rates = course.values[:, course.names.index(RATE)]
        elif RATE in variables:
            self._rates = np.full(len(course.starts), slave.getReal([variables[RATE].valueReference])[0])
        time = start
        for piece, rate in enumerate(self._rates):
            if piece:
                time += (course.starts[piece] - course.starts[piece - 1]) / self._rates[piece - 1]
            self._changes.append((float(time), piece))
            if rate == 0.0:  # nothing is drilled any more
                break

    @property
    def next_change(self) -> float:
        """When the inputs change next, s."""
        return self._changes[0][0] if self._changes else inf

    def change(self) -> None:
        """Give the instance the inputs with which the next piece starts: those that jump, for the others are there."""
        _, piece = self._changes.popleft()
        course, slave = self._course, self._slave
        assert course is not None
        values = dict(zip(course.names, course.values[piece].tolist(), strict=True))
        slopes = dict(zip(course.names, (course.slopes[piece] * self._rates[piece]).tolist(), strict=True))
        for name, reference in self._references.items():
            if name not in self._given or not isclose(self._given[name], values[name], rel_tol=ROUNDING):
                if name in self._whole:
                    slave.setInteger([reference], [int(values[name])])
                else:
                    slave.setReal([reference], [values[name]])
        self._slopes = {self._references[name]: slopes[name] for name in self._references if slopes[name]}
        if self._changes:  # what is there when the piece after this one starts
            ahead = course.starts[piece + 1] - course.starts[piece]
            ends = course.values[piece] + course.slopes[piece] * ahead
            self._given = dict(zip(course.names, ends.tolist(), strict=True))

    def step(self, time: float, end: float) -> None:
        """Take a communication step; derivatives act over one."""
        if self._slopes:
            references, slopes = list(self._slopes), list(self._slopes.values())
            self._slave.setRealInputDerivatives(references, [1] * len(references), slopes)
        self._slave.doStep(time, end - time)


def drive(
    fmu: str | Path,
    schedule: Schedule | None = None,
    *,
    step: float | None = None,
    stop: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Run an FMU to its end: `FmuRun.trajectory`.

    Parameters
    ----------
    fmu, schedule, step, stop
        See `FmuRun`.
    progress
        Called with the time, s, after each row.

    Raises
    ------
    InputError, ParameterError, Stopped
        See `FmuRun` and its `trajectory`.
    """
    return FmuRun(fmu, schedule, step=step, stop=stop).trajectory(progress)

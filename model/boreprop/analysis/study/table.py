"""The table of a study, with a line for each case, and the file to which it is saved meanwhile."""

import tomllib
from functools import partial
from importlib.metadata import version
from math import nan
from pathlib import Path
from time import monotonic, thread_time
from typing import Any

from ...case.file import dump_case
from ...errors import InputError, shown
from ...run.workers import WorkerLost
from .design import Study
from .figures import Function
from .store import Line, check, read, write

WRITING = 0.02  # share of the time spent on writing the file: a larger one slows a study, a smaller one loses more


class Table:
    """The lines of a study by the number of their case, and the file that keeps them, if there is one."""

    def __init__(self, cases: Study, function: Function, path: Path | None) -> None:
        self._cases = cases
        self.identity = {
            "function": _name(function),
            "boreprop": version("boreprop"),
            "varied parameters": ", ".join(cases.names),
        }
        self.case = dump_case(cases.case)
        self.lines: dict[int, Line] = {}
        self.results: list[str] = []  # the names of the results
        self._path = path
        self._unsaved, self._next_save = False, 0.0
        if path is not None:
            check(path)
            if path.exists():
                self._read(path)
            else:  # raises now, before the work, if the file cannot be written
                self._unsaved = True
                self.save()
                self._next_save = 0.0  # the first save took longer than later ones will

    def add(self, case: int, outcome: dict[str, float] | str | WorkerLost) -> Line:
        """Add the outcome of a case to the table; returns its line."""
        results = outcome if isinstance(outcome, dict) else {}
        taken = {"case", "error", *self._cases.names} & set(results)
        if taken:
            raise InputError(
                f"{self.identity['function']}: must name its results otherwise than the study's own columns, "
                f"got {taken.pop()!r}"
            )
        self.results += [name for name in results if name not in self.results]
        varied = dict(zip(self._cases.names, self._cases.values[case].tolist(), strict=True))
        line = {"case": case, **varied, **results, "error": None if isinstance(outcome, dict) else str(outcome)}
        self.lines[case] = line
        self._unsaved = True
        return line

    def columns(self, lines: list[Line]) -> dict[str, list[Any]]:
        """The results and errors of `lines`."""
        results = {name: [line.get(name, nan) for line in lines] for name in self.results}
        return {**results, "error": [line["error"] for line in lines]}

    def save_now_and_then(self) -> None:
        """Write the file if there is something new, and if enough time has passed since the last time."""
        if monotonic() >= self._next_save:
            self.save()

    def save(self) -> None:
        """Write the file if there is something new."""
        if self._path is None or not self._unsaved:
            return
        begin = thread_time()
        lines = [self.lines[case] for case in sorted(self.lines)]
        columns = {name: [line[name] for line in lines] for name in ("case", *self._cases.names)} | self.columns(lines)
        write(self._path, columns, self.identity, self._cases.case)
        self._unsaved = False
        self._next_save = monotonic() + (thread_time() - begin) / WRITING

    def _read(self, path: Path) -> None:
        """Read the lines of the file; `InputError` if it is not that of this study."""
        stored = read(path)
        theirs, ours = stored.identity | _keys(stored.case), self.identity | _keys(self.case)
        for name in ours | theirs:
            if theirs.get(name) != ours.get(name):
                self._refuse(name, theirs.get(name), ours.get(name))
        self.lines = {line["case"]: line for line in stored.lines}
        for case, values in enumerate(self._cases.values.tolist()):
            for name, value in zip(self._cases.names, values, strict=True):
                if case in self.lines and self.lines[case][name] != value:
                    self._refuse(f"{name} of case {case}", self.lines[case][name], value)
        others = {"case", "error", *self._cases.names}
        self.results = [name for name in stored.columns if name not in others]

    def _refuse(self, what: str, theirs: object, ours: object) -> None:
        raise InputError(
            f"{self._path}: {what}: must be {shown(theirs)} as in the study that the file holds, got {shown(ours)}; "
            "use another --output for another study"
        )


def _name(function: Any) -> str:
    """The name of a function, which is the same in every process."""
    if isinstance(function, partial):
        arguments = [repr(value) for value in function.args]
        arguments += [f"{name}={value!r}" for name, value in function.keywords.items()]
        return f"{_name(function.func)}({', '.join(arguments)})"
    return f"{function.__module__}.{function.__qualname__}" if hasattr(function, "__qualname__") else repr(function)


def _keys(case: str) -> dict[str, Any]:
    """The values of a case file but for [run]: "table.key" → value."""
    tables = ((table, content) for table, content in tomllib.loads(case).items() if table != "run")
    return {f"{table}.{key}": value for table, content in tables for key, value in content.items()}

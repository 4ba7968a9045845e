"""Studies: one function of many cases, computed on all cores or on a cluster, kept in a file as they come.

An engineer with an uncertain case asks what build rate to expect, and how likely the hole is to ripple::

    from scipy.stats import lognorm, norm
    from boreprop.analysis.study import probability, quantiles, run, sample

    if __name__ == "__main__":
        uncertain = {"active_weight_on_bit": norm(60e3, 6e3), "stabilizer_clearance[1]": lognorm(0.2, scale=3e-3)}
        results = run(sample(case, uncertain, n=1000, seed=1), output="study.parquet")
        print(quantiles(results)["build_rate"].values, probability(results["ripples"]))

A researcher asks any function of a case over a grid::

    results = run(grid(case, {"eta_pi": np.linspace(0.005, 0.2, 40), "rss_force": [0, 5e3, 1e4]}), rightmost_root)
    results["rightmost_root"].plot()

The worker processes import the script that starts them: it must do so under ``if __name__ == "__main__":``.
"""

import json
import tomllib
import warnings
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor
from contextlib import closing
from functools import partial
from importlib.metadata import version
from math import nan
from pathlib import Path
from time import monotonic, thread_time
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...case.case import Case
from ...case.file import dump_case
from ...core.options import RELATIVE_TOLERANCE
from ...core.quantities import BY_NAME
from ...errors import InputError, Stopped, shown
from ...replacing import replacing
from ...run.engines import engine
from ...run.results import CASE_KEY
from ...run.simulate import simulate
from ...run.workers import WorkerLost, work
from ..rippling import State
from ..summary import summarize
from .design import Study as Study
from .design import grid as grid
from .design import parameter_of
from .design import sample as sample
from .design import vary as vary

if TYPE_CHECKING:
    from xarray import DataArray, Dataset

Function = Callable[[Case], Mapping[str, float]]
Row = dict[str, Any]  # "case", the varied parameters, the results, "error": None or what went wrong

STUDY_KEY = b"boreprop.study"
WRITING = 0.02  # share of the time that goes into writing the file


def key_figures(case: Case, relative_tolerance: float = RELATIVE_TOLERANCE) -> dict[str, float]:
    """A simulation in a dozen numbers, SI units: the `boreprop.summary.Summary` of a run, one name for each number."""
    summary = summarize(simulate(case, relative_tolerance=relative_tolerance, engine=engine()))
    wave = summary.rippling
    stabilizers = list(enumerate(zip(summary.largest_contact_force, summary.contact_share, strict=True), 1))
    return {
        "end_inclination": summary.end_inclination,
        "build_rate": summary.build_rate,
        "largest_build_rate": summary.largest_build_rate,
        **{f"largest_contact_force[{i}]": force for i, (force, _) in stabilizers},
        **{f"contact_share[{i}]": share for i, (_, share) in stabilizers},
        "saturation_share": summary.saturation_share,
        "ripples": wave.ripples,
        "wavelength": wave.wavelength if wave.ripples else nan,
        "amplitude": wave.amplitude if wave.ripples else nan,
        "growth": wave.growth,
        "state": list(State).index(wave.state),
    }


FIGURES = {  # unit and meaning
    "end_inclination": ("rad", "inclination at the end"),
    "build_rate": ("rad/m", "build rate, mean"),
    "largest_build_rate": ("rad/m", "build rate, largest over 30 m"),
    "largest_contact_force": ("N", "largest contact force"),
    "contact_share": ("", "share in contact"),
    "saturation_share": ("", "share with saturated bit tilt"),
    "ripples": ("", "1 if it ends rippling, else 0"),
    "wavelength": ("m", "ripple: wavelength"),
    "amplitude": ("rad", "ripple: amplitude of the inclination"),
    "growth": ("1/m", "ripple: change of the logarithm of the amplitude"),
    "state": ("", "ripple: " + ", ".join(f"{number} {state}" for number, state in enumerate(State))),
}


def run(
    study: Study,
    function: Function = key_figures,
    *,
    output: str | Path | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    progress: Callable[[float], None] | None = None,
    on_result: Callable[[Row], None] | None = None,
) -> "Dataset":
    """Apply a function to every case of a study.

    The results do not depend on where they are computed. With an `output`, they are in that file soon after they are
    there; a study that was stopped, even killed, goes on from what its file holds, and one that is complete is read. It
    may also grow: more draws, more values at the end of the first axis of a grid. Ctrl-C keeps what is done.

    Parameters
    ----------
    study
        The cases.
    function
        Of one case, at the top level of a module. Returns numbers by name.
    output
        A Parquet file, one row for each case, in order; nothing half-written is ever seen under that name.
    executor
        Where to compute, say ``dask.distributed.Client(…).get_executor()``; it is left open. None: on processes of
        this machine, see the module on how a script must start them. Workers may die; the cases they had are computed
        again.
    workers
        Number of those processes; None: one for each core.
    progress
        Called with the number of cases that are done.
    on_result
        Called with each new row, in order of completion: "case" (its number), the varied parameters, the results,
        "error".

    Returns
    -------
    xarray.Dataset
        A variable for each result and ``error``. Of a grid, its axes are the dimensions; else ``case`` is, and the
        varied parameters are coordinates along it. A case whose parameters are out of range, or whose function raises
        an ArithmeticError, RuntimeError, ValueError or Stopped, has nan for results and the message in ``error``; so
        has one that no worker survives.

    Raises
    ------
    InputError
        If the file cannot be read or holds another study; the message names the difference.
    BrokenExecutor
        If workers die and there has not been one result, or if the given executor is broken.
    Exception
        Any other that the function raises.
    """
    from xarray import Dataset  # here: if it is missing, the work would be for nothing

    table = _Table(study, function, None if output is None else Path(output))
    todo = {case: values for case, values in enumerate(map(tuple, study.values.tolist())) if case not in table.rows}
    done = len(study) - len(todo)
    if progress:
        progress(done)
    compute = partial(_outcome, function, study.case, study.names)
    try:
        with closing(work(compute, todo, executor, workers)) as finished:
            for batch in finished:
                for case, outcome in batch:
                    row = table.add(case, outcome)
                    if on_result:
                        on_result(row)
                done += len(batch)
                if batch and progress:
                    progress(done)
                table.save_now_and_then()
    finally:
        table.save()
    return Dataset(*_labelled(study, table))


def quantiles(results: "Dataset", q: Iterable[float] = (0.1, 0.5, 0.9)) -> "Dataset":
    """Quantiles of every result over all cases. Nan does not count: failed cases, the wavelength of a smooth hole."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "All-NaN slice", RuntimeWarning)
        return results.quantile(list(q), numeric_only=True, skipna=True, keep_attrs=True)


class Probability(NamedTuple):
    """An estimate and its confidence interval."""

    estimate: float
    low: float
    high: float


def probability(happened: "DataArray", confidence: float = 0.95) -> Probability:
    """The probability that a result of a sample is 1 rather than 0, with the exact interval of Clopper and Pearson.

    Failed cases, nan, do not count; without any that does, the estimate is nan.
    """
    from scipy.stats import binomtest

    known = happened.values[np.isfinite(happened.values)]
    if not known.size:
        return Probability(nan, 0.0, 1.0)
    interval = binomtest(int(known.sum()), known.size).proportion_ci(confidence)
    return Probability(float(known.mean()), float(interval.low), float(interval.high))


def _outcome(
    function: Function, case: Case, names: tuple[str, ...], values: tuple[float, ...]
) -> dict[str, float] | str:
    """In the worker: the results of one case, or why there are none. What numbers cannot cause is a bug and raised."""
    try:
        results = function(vary(case, dict(zip(names, values, strict=True))))
        return {name: float(result) for name, result in results.items()}
    except (ArithmeticError, RuntimeError, ValueError, Stopped) as error:
        return str(error) or type(error).__name__


class _Table:
    """The rows of a study by the number of their case, and the file that holds them, if there is to be one."""

    def __init__(self, study: Study, function: Function, path: Path | None) -> None:
        self._study = study
        self.identity = {
            "function": _name(function),
            "boreprop": version("boreprop"),
            "varied parameters": ", ".join(study.names),
        }
        self.case = dump_case(study.case)
        self.rows: dict[int, Row] = {}
        self.results: list[str] = []  # their names
        self._path = path
        self._unsaved, self._next_save = False, 0.0
        if path is not None:
            if path.suffix != ".parquet":
                raise InputError(f"{path}: must end in .parquet, got {path.suffix!r}")
            if path.exists():
                self._read(path)
            else:  # so that a file that cannot be written says so before the work
                self._unsaved = True
                self.save()
                self._next_save = 0.0  # the first time takes longer than the next ones

    def add(self, case: int, outcome: dict[str, float] | str | WorkerLost) -> Row:
        """The row that a case is now."""
        results = outcome if isinstance(outcome, dict) else {}
        taken = {"case", "error", *self._study.names} & set(results)
        if taken:
            raise InputError(f"{self.identity['function']}: must call no result {taken.pop()!r}, a column of the study")
        self.results += [name for name in results if name not in self.results]
        varied = dict(zip(self._study.names, self._study.values[case].tolist(), strict=True))
        row = {"case": case, **varied, **results, "error": None if isinstance(outcome, dict) else str(outcome)}
        self.rows[case] = row
        self._unsaved = True
        return row

    def columns(self, rows: list[Row]) -> dict[str, list[Any]]:
        """The results and errors of `rows`."""
        results = {name: [row.get(name, nan) for row in rows] for name in self.results}
        return {**results, "error": [row["error"] for row in rows]}

    def save_now_and_then(self) -> None:
        """Write the file if there is something new, and enough time has gone by to afford it."""
        if monotonic() >= self._next_save:
            self.save()

    def save(self) -> None:
        """Write the file if there is something new."""
        if self._path is None or not self._unsaved:
            return
        import pyarrow
        import pyarrow.parquet

        begin = thread_time()
        rows = [self.rows[case] for case in sorted(self.rows)]
        columns = {name: [row[name] for row in rows] for name in ("case", *self._study.names)} | self.columns(rows)
        types = {"case": pyarrow.int64(), "error": pyarrow.string()}
        schema = pyarrow.schema(
            [(name, types.get(name, pyarrow.float64())) for name in columns],
            metadata={STUDY_KEY: json.dumps(self.identity), CASE_KEY: self.case},
        )
        with replacing(self._path) as draft:
            pyarrow.parquet.write_table(pyarrow.table(columns, schema=schema), draft)
        self._unsaved = False
        self._next_save = monotonic() + (thread_time() - begin) / WRITING

    def _read(self, path: Path) -> None:
        """Take over the rows of the file, if it is of this study."""
        import pyarrow
        import pyarrow.parquet

        try:
            table = pyarrow.parquet.read_table(path)
        except (OSError, pyarrow.ArrowException) as error:
            raise InputError(f"{path}: must be a readable Parquet file, got: {error}") from error
        metadata = table.schema.metadata or {}
        if STUDY_KEY not in metadata:
            raise InputError(f"{path}: must be the file of a study, got columns {shown(table.column_names)}")
        theirs = json.loads(metadata[STUDY_KEY]) | _keys(metadata[CASE_KEY].decode())
        ours = self.identity | _keys(self.case)
        for name in ours | theirs:
            if theirs.get(name) != ours.get(name):
                self._refuse(name, theirs.get(name), ours.get(name))
        self.rows = {row["case"]: row for row in table.to_pylist()}
        for case, values in enumerate(self._study.values.tolist()):
            for name, value in zip(self._study.names, values, strict=True):
                if case in self.rows and self.rows[case][name] != value:
                    self._refuse(f"{name} of case {case}", self.rows[case][name], value)
        known = {"case", "error", *self._study.names}
        self.results = [name for name in table.column_names if name not in known]

    def _refuse(self, what: str, theirs: object, ours: object) -> None:
        raise InputError(f"{self._path}: {what}: must be {shown(theirs)}, as in the study it holds, got {shown(ours)}")


def _name(function: Any) -> str:
    """What a function is called, the same in every process."""
    if isinstance(function, partial):
        arguments = [repr(value) for value in function.args]
        arguments += [f"{name}={value!r}" for name, value in function.keywords.items()]
        return f"{_name(function.func)}({', '.join(arguments)})"
    return f"{function.__module__}.{function.__qualname__}" if hasattr(function, "__qualname__") else repr(function)


def _keys(case: str) -> dict[str, Any]:
    """What a case file says: "table.key" → value."""
    return {f"{table}.{key}": value for table, content in tomllib.loads(case).items() for key, value in content.items()}


def _labelled(study: Study, table: _Table) -> tuple[dict[str, Any], dict[str, Any], dict[str, str]]:
    """The variables, coordinates and attributes of a dataset of all rows."""
    columns = table.columns([table.rows[case] for case in range(len(study))])
    arrays: dict[str, NDArray[Any]] = {name: np.array(column) for name, column in columns.items()}
    arrays["error"] = np.array([error or "" for error in columns["error"]])
    axes = study.axes
    if axes is None:
        dimensions: tuple[str, ...] = ("case",)
        coordinates = {
            name: (dimensions, values, _attributes(name))
            for name, values in zip(study.names, study.values.T, strict=True)
        } | {"case": (dimensions, np.arange(len(study)), {})}
    else:
        dimensions = study.names
        coordinates = {name: ((name,), values, _attributes(name)) for name, values in axes.items()}
    shape = [len(coordinates[name][1]) for name in dimensions]
    variables = {name: (dimensions, array.reshape(shape), _attributes(name)) for name, array in arrays.items()}
    return variables, coordinates, {**table.identity, "case": table.case}


def _attributes(name: str) -> dict[str, str]:
    """Unit and meaning of a parameter or a key figure."""
    name = name.partition("[")[0]
    if name in FIGURES:
        unit, meaning = FIGURES[name]
    elif quantity := BY_NAME.get(name) or BY_NAME.get(parameter_of(name)):
        unit, meaning = "deg" if name.endswith("_deg") else quantity.unit, quantity.meaning
    else:
        return {}
    return {"units": unit, "long_name": meaning}

"""Studies: one function of many cases, computed on all cores or on a cluster, kept in a file as they come.

An engineer with an uncertain case asks what build rate to expect, and how likely the hole is to ripple::

    from scipy.stats import lognorm, norm
    from boreprop import load_case, probability, quantiles, sample, study

    if __name__ == "__main__":
        case = load_case("case.toml")
        uncertain = {"active_weight_on_bit": norm(60e3, 6e3), "stabilizer_clearance[1]": lognorm(0.2, scale=3e-3)}
        results = study(sample(case, uncertain, n=1000, seed=1), output="study.parquet")
        print(quantiles(results)["build_rate"].values, probability(results["ripples"]))

A researcher asks any function of a case over a grid::

    cases = grid(case, {"eta_pi": np.linspace(0.005, 0.2, 40), "rss_force": [0, 5e3, 1e4]})
    results = study(cases, rightmost_root)
    results["rightmost_root"].plot()

The worker processes import the script that starts them: it must do so under ``if __name__ == "__main__":``.
"""

import warnings
from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from contextlib import closing
from functools import partial
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...case.case import Case
from ...core.quantities import BY_NAME
from ...run.trajectory import Stopped
from ...run.workers import work
from .design import Study, parameter_of, vary
from .figures import FIGURES, Function, key_figures
from .table import Line, Table

if TYPE_CHECKING:
    from xarray import DataArray, Dataset


def study(
    cases: Study,
    function: Function = key_figures,
    *,
    output: str | Path | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    progress: Callable[[float], None] | None = None,
    on_result: Callable[[Line], None] | None = None,
) -> "Dataset":
    """Compute a function of every case.

    The results do not depend on where they are computed. With an `output`, they are in that file soon after they are
    there; a study that was stopped, even killed, goes on from what its file holds, and one that is complete is read. It
    may also grow: more draws, more values at the end of the first axis of a grid. Ctrl-C keeps what is done.

    Parameters
    ----------
    cases
        What `grid` or `sample` makes.
    function
        Of one case, at the top level of a module. Returns numbers by name.
    output
        A Parquet file, one line for each case, in order; nothing half-written is ever seen under that name.
    executor
        Where to compute, say ``dask.distributed.Client(…).get_executor()``; it is left open. None: on processes of
        this machine, see the module on how a script must start them. Workers may die; the cases they had are computed
        again.
    workers
        Number of those processes; None: one for each core.
    progress
        Called with the number of cases that are done.
    on_result
        Called with each new line of the table, in order of completion: "case" (its number), the varied parameters, the
        results, "error".

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

    table = Table(cases, function, None if output is None else Path(output))
    todo = {case: values for case, values in enumerate(map(tuple, cases.values.tolist())) if case not in table.lines}
    done = len(cases) - len(todo)
    if progress:
        progress(done)
    compute = partial(outcome, function, cases.case, cases.names)
    try:
        with closing(work(compute, todo, executor, workers)) as finished:
            for batch in finished:
                for case, result in batch:
                    line = table.add(case, result)
                    if on_result:
                        on_result(line)
                done += len(batch)
                if batch and progress:
                    progress(done)
                table.save_now_and_then()
    finally:
        table.save()
    return Dataset(*_labelled(cases, table))


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


def outcome(
    function: Function, case: Case, names: tuple[str, ...], values: tuple[float, ...]
) -> dict[str, float] | str:
    """In the worker: the results of one case, or why there are none. What numbers cannot cause is a bug and raised."""
    try:
        results = function(vary(case, dict(zip(names, values, strict=True))))
        return {name: float(result) for name, result in results.items()}
    except (ArithmeticError, RuntimeError, ValueError, Stopped) as error:
        return str(error) or type(error).__name__


def _labelled(cases: Study, table: Table) -> tuple[dict[str, Any], dict[str, Any], dict[str, str]]:
    """The variables, coordinates and attributes of a dataset of all lines of the table."""
    columns = table.columns([table.lines[case] for case in range(len(cases))])
    arrays: dict[str, NDArray[Any]] = {name: np.array(column) for name, column in columns.items()}
    arrays["error"] = np.array([error or "" for error in columns["error"]])
    axes = cases.axes
    if axes is None:
        dimensions: tuple[str, ...] = ("case",)
        coordinates = {
            name: (dimensions, values, _attributes(name))
            for name, values in zip(cases.names, cases.values.T, strict=True)
        } | {"case": (dimensions, np.arange(len(cases)), {})}
    else:
        dimensions = cases.names
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

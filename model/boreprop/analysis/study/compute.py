"""Studies: a function of many cases, computed on all cores or on a cluster, with the results kept in a file.

An engineer whose case is uncertain asks which build rate to expect, and how likely the hole is to ripple::

    from scipy.stats import lognorm, norm
    from boreprop import load_case, probability, quantiles, sample, study

    if __name__ == "__main__":
        case = load_case("case.toml")
        uncertain = {"active_weight_on_bit": norm(60e3, 6e3), "stabilizer_clearance[1]": lognorm(0.2, scale=3e-3)}
        results = study(sample(case, uncertain, n=1000, seed=1), output="study.parquet")
        print(quantiles(results)["build_rate"].values, probability(results["ripples"]))

A researcher computes any function of a case over a grid::

    cases = grid(case, {"eta_pi": np.linspace(0.005, 0.2, 40), "rss_force": [0, 5e3, 1e4]})
    results = study(cases, rightmost_root)
    results["rightmost_root"].plot()

The worker processes import the script that starts them, so it must call `study` under ``if __name__ == "__main__":``.
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

from ...core.quantities import BY_NAME
from ...run.workers import work
from .design import Study, parameter_of
from .figures import FIGURES, Function, key_figures, outcome
from .store import Line
from .table import Table

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
    """Compute a function of every case of a study.

    The results do not depend on where they are computed. With an `output`, new results are soon written to that file. A
    study that was stopped, or killed, continues from its file; the results of a complete study are read from it. A
    study may also grow: by more draws, or by more values at the end of the first axis of a grid. Ctrl-C keeps the
    results so far.

    Parameters
    ----------
    cases
        The cases, see `grid` and `sample`.
    function
        Takes a case and returns numbers by name. It must be defined at the top level of a module, or be a partial of
        such a function.
    output
        A .parquet or .csv file with one line for each case, in order; the case that is varied is in its metadata, or in
        a case file beside the CSV file. It is replaced as a whole, never half-written.
    executor
        Where to compute, for example ``dask.distributed.Client(…).get_executor()``; the caller closes it. None: on
        processes of this machine, which a script must start under ``if __name__ == "__main__":``. If a worker dies, the
        cases that it had are computed again.
    workers
        Number of processes on this machine; None: one for each core.
    progress
        Called with the number of cases that are done.
    on_result
        Called with each new line of the table, in order of completion: "case" (its number), the varied parameters, the
        results and "error".

    Returns
    -------
    xarray.Dataset
        A variable for each result, and ``error``. The dimensions are the axes of a grid. Otherwise there is one
        dimension, ``case``, and the varied parameters are coordinates along it. A case has nan for results and the
        message in ``error`` if its parameters are out of range, if the function raises an ArithmeticError,
        RuntimeError or ValueError, if it finds that a run cannot go on or no roots or spiral, or if every worker that
        tried it died.

    Raises
    ------
    InputError
        If the file cannot be read or holds another study; the message names the difference.
    BrokenExecutor
        If workers die before there is a single result, or if the given executor is broken.
    Exception
        Any other that the function raises.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from boreprop import grid, paper_case, study
    >>> def critical_weight(case):
    ...     return {"kilonewtons": 0.1467 * case.bha.force_scale / case.bit.lateral_steering_resistance / 1e3}
    >>> cases = grid(paper_case(), {"flexural_stiffness": [7e6, 8e6]})
    >>> with ThreadPoolExecutor() as threads:
    ...     results = study(cases, critical_weight, executor=threads)
    >>> results["kilonewtons"].values.round(1).tolist()
    [23.0, 26.3]
    """
    from xarray import Dataset  # imported first, so that no work is lost if it is missing

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
    """Compute quantiles of every result of a study over its cases.

    Parameters
    ----------
    results
        What `study` returns. Values that are nan are left out: those of failed cases, the wavelength of a smooth hole.
    q
        Probabilities, from 0 to 1.

    Returns
    -------
    xarray.Dataset
        For each result its quantiles along the dimension ``quantile``, in the unit of the result.
    """
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "All-NaN slice", RuntimeWarning)
        return results.quantile(list(q), numeric_only=True, skipna=True, keep_attrs=True)


class Probability(NamedTuple):
    """An estimate and its confidence interval."""

    estimate: float
    low: float
    high: float


def probability(happened: "DataArray", confidence: float = 0.95) -> Probability:
    """Estimate the probability that a result of a sample is 1 rather than 0.

    Parameters
    ----------
    happened
        A result of `study` that is 0 or 1 in each case, such as ``results["ripples"]``. Failed cases, nan, are left
        out.
    confidence
        Confidence of the interval, between 0 and 1.

    Returns
    -------
    Probability
        The share of ones, and the exact confidence interval of Clopper and Pearson (1934). If all cases failed, the
        estimate is nan and the interval is from 0 to 1.
    """
    from scipy.stats import binomtest

    finite = happened.values[np.isfinite(happened.values)]
    if not finite.size:
        return Probability(nan, 0.0, 1.0)
    interval = binomtest(int(finite.sum()), finite.size).proportion_ci(confidence)
    return Probability(float(finite.mean()), float(interval.low), float(interval.high))


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
    """The attributes of a parameter or a key figure in a dataset: its unit and meaning."""
    name = name.partition("[")[0]
    if name in FIGURES:
        unit, meaning = FIGURES[name]
    elif quantity := BY_NAME.get(name) or BY_NAME.get(parameter_of(name)):
        unit, meaning = "deg" if name.endswith("_deg") else quantity.unit, quantity.meaning
    else:
        return {}
    return {"units": unit, "long_name": meaning}

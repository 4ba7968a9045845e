"""The results of a study in a table and a sentence, in the units people use."""

from collections.abc import Iterable
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...analysis.study.compute import probability, quantiles
from ...units import BUILD_LENGTH, UNITS, Unit

if TYPE_CHECKING:
    from xarray import Dataset

DIGITS = ".4g"


def lines(results: "Dataset", q: Iterable[float]) -> list[tuple[str, ...]]:
    """The lines of a table: each a result and its quantiles `q`, with a note if not all cases that ran have it."""
    values = quantiles(results, q)
    table: list[tuple[str, ...]] = []
    for name, figure in values.data_vars.items():
        kind, _, number = str(name).partition("[")
        if kind in ("ripples", "state"):
            continue  # quantiles of a yes or no, or of a code, mean nothing
        si = figure.attrs.get("units", "")
        unit = UNITS.get(si) or _other(si)
        what = figure.attrs.get("long_name", kind) + (f", stabilizer {number[:-1]}" if number else "")
        what = what.replace(f"{BUILD_LENGTH:g} m", UNITS["m"].text(BUILD_LENGTH, ".3g"))
        table.append(
            (
                unit.heading(what) + _which(results, np.isfinite(results[name].values)),
                *(unit.number(value, DIGITS) if isfinite(value) else "–" for value in figure.values),
            )
        )
    return table


def _other(si: str) -> Unit:
    """How a unit is shown that no quantity has: one over a length, or a unit that somebody's own function names."""
    length = UNITS["m"]
    return Unit({}, f"1/{length.shown}", 1 / length.factor) if si == "1/m" else Unit({}, si)


def _which(results: "Dataset", finite: NDArray[np.bool_]) -> str:
    """Which cases have a finite value, in words; empty if these are all that did not fail."""
    ran = results["error"].values == ""
    if np.array_equal(finite, ran):
        return ""
    if finite.any() and np.array_equal(finite, results["ripples"].values == 1.0):
        return ", of the case that ripples" if finite.sum() == 1 else f", of the {finite.sum()} cases that ripple"
    return f", of {finite.sum()} of {ran.sum()} cases"


def as_plain(results: "Dataset", q: Iterable[float]) -> dict[str, object]:
    """A study as a document for JSON: how many cases there are and failed, and of each result its quantiles `q`."""
    errors = results["error"].values.ravel()
    failed = errors[errors != ""]
    values = quantiles(results, q)
    document: dict[str, object] = {
        "cases": errors.size,
        "failed": failed.size,
        "first_error": failed[0] if failed.size else None,
        "quantiles": values["quantile"].values,
        "figures": {str(name): figure.values for name, figure in values.data_vars.items() if name != "state"},
    }
    if "case" in results.dims and "ripples" in results:
        document["probability_of_rippling"] = probability(results["ripples"])
    return document


def outcome(results: "Dataset") -> str:
    """A sentence: how many cases there are, how many failed, and how many ripple; for a sample the probability."""
    errors = results["error"].values.ravel()
    failed = errors[errors != ""]
    parts = [f"{errors.size} cases"]
    if failed.size:
        parts.append(f"{failed.size} failed (the first: {failed[0]})")
        if failed.size == errors.size:
            return ", ".join(parts)
        parts.append(f"the figures are of the other {errors.size - failed.size}")
    if "case" in results.dims:
        ripples = probability(results["ripples"])
        parts.append(f"probability of rippling {ripples.estimate:.1%} ({ripples.low:.1%} to {ripples.high:.1%})")
    else:
        parts.append(f"{int(results['ripples'].sum())} ripple")
    return ", ".join(parts)

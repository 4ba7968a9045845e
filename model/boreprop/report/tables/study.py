"""A study in a table and a sentence, in the units people use."""

from collections.abc import Iterable
from math import degrees, isfinite
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...analysis.study.run import probability, quantiles
from ...units import BUILD_LENGTH

if TYPE_CHECKING:
    from xarray import Dataset

SHOWN = {  # SI unit: the unit to show it in and how many of those it is
    "rad": ("°", degrees(1.0)),
    "rad/m": (f"°/{BUILD_LENGTH:g} m", degrees(BUILD_LENGTH)),
    "N": ("kN", 1e-3),
}


def lines(results: "Dataset", q: Iterable[float]) -> list[tuple[str, ...]]:
    """The lines of a table: result, its quantiles `q` over the cases that have one; which, if not all that ran."""
    values = quantiles(results, q)
    table: list[tuple[str, ...]] = []
    for name, figure in values.data_vars.items():
        kind, _, number = str(name).partition("[")
        if kind in ("ripples", "state"):
            continue  # of a yes or no, and of a code, quantiles say nothing
        unit, factor = SHOWN.get(figure.attrs.get("units", ""), (figure.attrs.get("units", ""), 1.0))
        what = figure.attrs.get("long_name", kind) + (f", stabilizer {number[:-1]}" if number else "")
        table.append(
            (
                (f"{what} ({unit})" if unit else what) + _which(results, np.isfinite(results[name].values)),
                *(f"{factor * v:.4g}" if isfinite(v) else "–" for v in figure.values),
            )
        )
    return table


def _which(results: "Dataset", known: NDArray[np.bool_]) -> str:
    """Over which cases a figure is, if not over all that did not fail."""
    ran = results["error"].values == ""
    if np.array_equal(known, ran):
        return ""
    if known.any() and np.array_equal(known, results["ripples"].values == 1.0):
        return ", of the case that ripples" if known.sum() == 1 else f", of the {known.sum()} cases that ripple"
    return f", of {known.sum()} of {ran.sum()} cases"


def outcome(results: "Dataset") -> str:
    """How many cases there are, how many failed, and how many ripple: of a sample, the probability."""
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

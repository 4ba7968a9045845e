"""A study in a table and a sentence, in the units people use."""

from collections.abc import Iterable
from math import degrees, isfinite
from typing import TYPE_CHECKING

from .analysis.study import probability, quantiles
from .summary import BUILD_LENGTH

if TYPE_CHECKING:
    from xarray import Dataset

SHOWN = {  # SI unit: the unit to show it in and how many of those it is
    "rad": ("°", degrees(1.0)),
    "rad/m": (f"°/{BUILD_LENGTH:g} m", degrees(BUILD_LENGTH)),
    "N": ("kN", 1e-3),
}


def lines(results: "Dataset", q: Iterable[float]) -> list[tuple[str, ...]]:
    """The lines of a table: result, its quantiles `q` over the cases."""
    values = quantiles(results, q)
    table: list[tuple[str, ...]] = []
    for name, figure in values.data_vars.items():
        kind, _, number = str(name).partition("[")
        if kind == "ripples":
            continue  # of what is 0 or 1, quantiles say nothing
        unit, factor = SHOWN.get(figure.attrs.get("units", ""), (figure.attrs.get("units", ""), 1.0))
        what = figure.attrs.get("long_name", kind) + (f", stabilizer {number[:-1]}" if number else "")
        table.append(
            (
                f"{what} ({unit})" if unit else what,
                *(f"{factor * v:.4g}" if isfinite(v) else "–" for v in figure.values),
            )
        )
    return table


def verdict(results: "Dataset") -> str:
    """How many cases there are, how many failed, and how many ripple: of a sample, the probability."""
    errors = results["error"].values.ravel()
    failed = errors[errors != ""]
    parts = [f"{errors.size} cases"]
    if failed.size:
        parts.append(f"{failed.size} failed (the first: {failed[0]})")
    if "case" in results.dims:
        ripples = probability(results["ripples"])
        parts.append(f"probability of rippling {ripples.estimate:.1%} ({ripples.low:.1%} to {ripples.high:.1%})")
    else:
        parts.append(f"{int(results['ripples'].sum())} ripple")
    return ", ".join(parts)

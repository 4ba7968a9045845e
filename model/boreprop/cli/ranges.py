"""Parses ranges, lists and distributions given on the command line."""

from collections.abc import Callable, Iterable
from math import inf, nan
from typing import Any, TypeVar

import numpy as np

from ..analysis.study.design import Distribution
from ..arrays import Floats
from ..errors import InputError

T = TypeVar("T")

MOST_VALUES = 5000  # on an axis of a picture, which has fewer pixels

DISTRIBUTIONS: dict[str, tuple[str, Callable[..., tuple[float, ...]]]] = {
    "normal": ("norm", lambda mean, deviation: (mean, deviation)),
    "lognormal": ("lognorm", lambda median, deviation_of_log: (deviation_of_log, 0.0, median)),
    "uniform": ("uniform", lambda low, high: (low, high - low)),
    "triangular": ("triang", lambda low, mode, high: ((mode - low) / (high - low), low, high - low)),
}
"""Name → the name in scipy.stats, and a function from our arguments to those of scipy."""


def parse_range(option: str, text: str) -> Floats:
    """The evenly spaced values of a text START:STOP:COUNT; an `InputError` names the `option`."""
    try:
        start, stop, count = text.split(":")
        low, high, number = float(start), float(stop), int(count)
    except ValueError:
        low, high, number = nan, nan, 0
    if not (0 < low < high < inf and 2 <= number <= MOST_VALUES):
        constraint = f"START:STOP:COUNT with 0 < START < STOP and COUNT from 2 to {MOST_VALUES}"
        raise InputError(f"{option}: must be {constraint}, got {text!r}")
    return np.linspace(low, high, number)


def parse_each(parse: Callable[[str], tuple[str, T]], texts: Iterable[str]) -> dict[str, T]:
    """Parse each text with `parse_axis` or `parse_distribution`: name → value. `InputError` if a name comes twice."""
    found: dict[str, T] = {}
    for text in texts:
        name, value = parse(text)
        if name in found:
            raise InputError(f"{name}: must be given once, got {text!r} in addition")
        found[name] = value
    return found


def parse_axis(text: str) -> tuple[str, Floats]:
    """The name and the values of "NAME=START:STOP:COUNT", evenly spaced, or of "NAME=VALUE,VALUE,…"."""
    name, _, values = text.partition("=")
    try:
        if ":" not in values:
            return name, np.array([float(value) for value in values.split(",")])
        start, stop, count = values.split(":")
        return name, np.linspace(float(start), float(stop), int(count))
    except ValueError as error:
        raise InputError(f"--vary: must be NAME=START:STOP:COUNT or NAME=VALUE,VALUE,…, got {text!r}") from error


def parse_distribution(text: str) -> tuple[str, Distribution]:
    """The name and the distribution of "NAME=normal(MEAN,DEVIATION)" or another of `DISTRIBUTIONS`."""
    from scipy import stats  # imported here, since that takes longer than a small grid, which does not need it

    name, _, call = text.partition("=")
    kind, _, numbers = call.strip().partition("(")
    try:
        if kind not in DISTRIBUTIONS or not numbers.endswith(")"):
            raise ValueError
        scipy_name, scipy_arguments = DISTRIBUTIONS[kind]
        family: Any = getattr(stats, scipy_name)
        distribution: Distribution = family(*scipy_arguments(*map(float, numbers[:-1].split(","))))
        if not np.isfinite(distribution.ppf(0.5)):
            raise ValueError
    except (ArithmeticError, TypeError, ValueError) as error:
        forms = "normal(MEAN,DEVIATION), lognormal(MEDIAN,DEVIATION OF THE LOG), uniform(LOW,HIGH) or "
        raise InputError(f"--uncertain: must be NAME={forms}triangular(LOW,MODE,HIGH), got {text!r}") from error
    return name, distribution

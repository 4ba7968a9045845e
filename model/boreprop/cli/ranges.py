"""Values that are given as text: START:STOP:COUNT, lists, distributions."""

from collections.abc import Callable, Iterable
from math import inf, nan
from typing import TypeVar

import numpy as np

from ..analysis.study.design import Distribution
from ..arrays import Floats
from ..errors import InputError

T = TypeVar("T")

MOST_VALUES = 5000  # on an axis of a picture: more than its pixels


def parse_each(parse: Callable[[str], tuple[str, T]], texts: Iterable[str]) -> dict[str, T]:
    """What `parse_axis` or `parse_distribution` makes of each text, by name; `InputError` if a name comes twice."""
    found: dict[str, T] = {}
    for text in texts:
        name, value = parse(text)
        if name in found:
            raise InputError(f"{name}: must be varied once, got {text!r} besides")
        found[name] = value
    return found


def parse_range(option: str, text: str) -> Floats:
    """The values that START:STOP:COUNT stands for; `InputError` names the `option`."""
    try:
        start, stop, count = text.split(":")
        low, high, number = float(start), float(stop), int(count)
    except ValueError:
        low, high, number = nan, nan, 0
    if not (0 < low < high < inf and 2 <= number <= MOST_VALUES):
        constraint = f"START:STOP:COUNT with 0 < START < STOP and COUNT from 2 to {MOST_VALUES}"
        raise InputError(f"{option}: must be {constraint}, got {text!r}")
    return np.linspace(low, high, number)


def parse_axis(text: str) -> tuple[str, Floats]:
    """Name and values of "NAME=START:STOP:COUNT", evenly spaced, or "NAME=VALUE,VALUE,…"; `InputError` if neither."""
    name, _, values = text.partition("=")
    try:
        if ":" not in values:
            return name, np.array([float(value) for value in values.split(",")])
        start, stop, count = values.split(":")
        return name, np.linspace(float(start), float(stop), int(count))
    except ValueError as error:
        raise InputError(f"--vary: must be NAME=START:STOP:COUNT or NAME=VALUE,VALUE,…, got {text!r}") from error


def _normal(mean: float, deviation: float) -> Distribution:
    from scipy.stats import norm

    return norm(mean, deviation)


def _lognormal(median: float, deviation_of_log: float) -> Distribution:
    from scipy.stats import lognorm

    return lognorm(deviation_of_log, scale=median)


def _uniform(low: float, high: float) -> Distribution:
    from scipy.stats import uniform

    return uniform(low, high - low)


def _triangular(low: float, mode: float, high: float) -> Distribution:
    from scipy.stats import triang

    return triang((mode - low) / (high - low), low, high - low)


DISTRIBUTIONS: dict[str, Callable[..., Distribution]] = {
    "normal": _normal,
    "lognormal": _lognormal,
    "uniform": _uniform,
    "triangular": _triangular,
}


def parse_distribution(text: str) -> tuple[str, Distribution]:
    """Name and distribution of "NAME=normal(MEAN,DEVIATION)" or another of `DISTRIBUTIONS`; `InputError` if neither."""
    name, _, call = text.partition("=")
    kind, _, arguments = call.strip().partition("(")
    try:
        if kind not in DISTRIBUTIONS or not arguments.endswith(")"):
            raise ValueError
        distribution = DISTRIBUTIONS[kind](*map(float, arguments[:-1].split(",")))
        if not np.isfinite(distribution.ppf(0.5)):
            raise ValueError
    except (ArithmeticError, TypeError, ValueError) as error:
        forms = "normal(MEAN,DEVIATION), lognormal(MEDIAN,DEVIATION OF THE LOG), uniform(LOW,HIGH) or "
        raise InputError(f"--uncertain: must be NAME={forms}triangular(LOW,MODE,HIGH), got {text!r}") from error
    return name, distribution

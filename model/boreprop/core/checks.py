"""Checks of single values and of lists."""

from itertools import pairwise
from math import inf, isfinite

from .errors import ParameterError


def check_number(name: str, value: float, *, above: float = -inf, at_least: float = -inf, at_most: float = inf) -> None:
    """Raise `ParameterError` unless `value` is finite, > above, >= at_least and <= at_most."""
    if not isfinite(value):
        raise ParameterError(name, "must be a finite number", value)
    if value <= above:
        raise ParameterError(name, f"must be > {above:g}", value)
    if value < at_least:
        raise ParameterError(name, f"must be >= {at_least:g}", value)
    if value > at_most:
        raise ParameterError(name, f"must be <= {at_most:g}", value)


def check_increasing(name: str, values: tuple[float, ...]) -> None:
    """Raise `ParameterError` unless every value is finite and larger than the one before."""
    for value in values:
        check_number(name, value)
    for before, after in pairwise(values):
        if after <= before:
            raise ParameterError(name, "must increase", (before, after))

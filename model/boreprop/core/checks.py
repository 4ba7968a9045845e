"""Checks of single values and of lists."""

from itertools import pairwise
from math import inf, isfinite

from .errors import ParameterError
from .quantities import BY_NAME


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


def check_quantity(name: str, value: float | tuple[float, ...]) -> None:
    """Raise `ParameterError` unless a value, or each element, is in the range that the table of quantities gives."""
    quantity = BY_NAME[name]
    above, at_least, at_most = quantity.above, quantity.at_least, quantity.at_most
    if not isinstance(value, tuple):
        check_number(name, value, above=above, at_least=at_least, at_most=at_most)
    else:
        for i, element in enumerate(value, 1):
            check_number(f"{name}[{i}]", element, above=above, at_least=at_least, at_most=at_most)


def check_part(part: str, fields: object) -> None:
    """Raise `ParameterError` unless all that a part of a case has is in the ranges of the table of quantities."""
    for quantity in BY_NAME.values():
        if quantity.field and quantity.part == part:
            check_quantity(quantity.name, getattr(fields, quantity.attribute))


def check_increasing(name: str, values: tuple[float, ...]) -> None:
    """Raise `ParameterError` unless every value is finite and larger than the one before."""
    for value in values:
        check_number(name, value)
    for before, after in pairwise(values):
        if after <= before:
            raise ParameterError(name, "must increase", (before, after))

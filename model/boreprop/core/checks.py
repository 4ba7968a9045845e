"""Checks of single values and of lists."""

from itertools import pairwise
from math import inf, isfinite

from .errors import error_of
from .problems import Problem
from .quantities import BY_NAME, quantity_of


def checked_float(name: str, value: float, *, index: int = 0) -> float:
    """`value` as a float; `ParameterError` unless it is finite."""
    try:
        number = float(value)
    except OverflowError:  # an int with hundreds of digits
        number = inf if value > 0 else -inf
    if not isfinite(number):
        raise error_of(Problem("not a number", name, index, number))
    return number


def check_number(
    name: str, value: float, *, index: int = 0, above: float = -inf, at_least: float = -inf, at_most: float = inf
) -> None:
    """Raise `ParameterError` unless `value` is finite, > above, >= at_least and <= at_most."""
    checked_float(name, value, index=index)
    if value <= above:
        raise error_of(Problem("not above", name, index, value, limit=above))
    if value < at_least:
        raise error_of(Problem("too small", name, index, value, limit=at_least))
    if value > at_most:
        raise error_of(Problem("too large", name, index, value, limit=at_most))


def check_quantity(name: str, value: float | tuple[float, ...]) -> None:
    """Raise `ParameterError` unless a value, or each element, is in the range that the table of quantities gives."""
    quantity = BY_NAME[name]
    above, at_least, at_most = quantity.above, quantity.at_least, quantity.at_most
    if not isinstance(value, tuple):
        check_number(name, value, above=above, at_least=at_least, at_most=at_most)
    else:
        for index, element in enumerate(value, 1):
            check_number(name, element, index=index, above=above, at_least=at_least, at_most=at_most)


def check_value(name: str, value: float, index: int) -> None:
    """Raise `ParameterError` unless a value of a scalar name, entry `index` of a column, is in its range."""
    quantity = quantity_of(name)
    check_number(name, value, index=index, above=quantity.above, at_least=quantity.at_least, at_most=quantity.at_most)


def check_part(part: str, fields: object) -> None:
    """Raise `ParameterError` unless every quantity of a part of a case is in its range of the table of quantities."""
    for quantity in BY_NAME.values():
        if quantity.field and quantity.part == part and quantity.kind != "String":
            check_quantity(quantity.name, getattr(fields, quantity.attribute))


def check_increasing(name: str, values: tuple[float, ...]) -> None:
    """Raise `ParameterError` unless every value is finite and larger than the one before."""
    for value in values:
        check_number(name, value)
    for before, after in pairwise(values):
        if after <= before:
            raise error_of(Problem("not increasing", name, value=after, before=before))

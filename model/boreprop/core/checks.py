"""Checks of single values, of lists, and of what the fields of a part of a case hold."""

from dataclasses import fields
from itertools import pairwise
from math import inf, isfinite
from operator import index as whole
from types import NoneType
from typing import Any, get_args, get_origin

from .errors import ParameterError, error_of
from .problems import Problem
from .quantities import BY_NAME, QUANTITIES, quantity_of

NAMES = {quantity.field: quantity.name for quantity in QUANTITIES if quantity.field}
"""Field of a case → the name of what it holds."""


def take_fields(part: str, made: Any) -> None:
    """Make tuples of lists and arrays in the fields of a part of a case, and check that all are of the declared types.

    Raises `ParameterError` unless they are. What a text must be is for others to check.
    """
    for field in fields(made):
        name = NAMES.get(f"{part}.{field.name}".removeprefix("."), field.name)
        object.__setattr__(made, field.name, _of_kind(field.type, name, getattr(made, field.name)))


def numbers(name: str, values: Any) -> tuple[float, ...]:
    """A list, an array, … of numbers as a tuple; `ParameterError` if it is something else."""
    taken: tuple[float, ...] = _of_kind(tuple[float, ...], name, values)
    return taken


def some_numbers(name: str, values: Any) -> tuple[float, ...]:
    """`numbers`, of which there must be one at least."""
    taken = numbers(name, values)
    if not taken:
        raise ParameterError(name, "must be a list of at least one value", values)
    return taken


def _of_kind(kind: Any, name: str, value: Any) -> Any:
    """A value of a type, or one that can stand for it; `ParameterError` if it cannot."""
    if kind in (int, float):
        return _number(kind, name, value)
    if get_origin(kind) is tuple:
        of, *_ = get_args(kind)
        return tuple(_of_kind(of, f"{name}[{i}]", element) for i, element in enumerate(_list(of, name, value), 1))
    if NoneType in (kinds := get_args(kind)):
        return None if value is None else _of_kind(kinds[0], name, value)
    if kind is str:
        return str(value) if isinstance(value, str) else value
    if kind is bool and (isinstance(value, str) or value not in (False, True)):
        raise ParameterError(name, "must be True or False", value)
    if kind is not bool and not isinstance(value, kind):
        raise ParameterError(name, f"must be of the type {kind.__name__}", value)
    return value


def _number(kind: type, name: str, value: Any) -> float:
    """A number as an int, if that is its type or may be, else as a float."""
    if isinstance(value, int):
        return value
    try:
        if not isinstance(value, str):
            return whole(value) if kind is int and hasattr(value, "__index__") else float(value)
    except (TypeError, ValueError):
        pass
    raise ParameterError(name, "must be a number", value)


def _list(of: type, name: str, value: Any) -> tuple[Any, ...]:
    """What can be gone through, but for the letters of a text, as a tuple."""
    try:
        if not isinstance(value, str):
            return tuple(value)
    except TypeError:
        pass
    example = f", such as [{value!r}]" if isinstance(value, of) else " of numbers" if of is float else ""
    raise ParameterError(name, f"must be a list{example}", value)


def checked_float(name: str, value: float, *, index: int = 0) -> float:
    """`value` as a float; `ParameterError` unless it is a finite number."""
    try:
        number = float(_number(float, f"{name}[{index}]" if index else name, value))
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

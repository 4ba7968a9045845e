"""The little linear algebra that the core needs, on lists of rows."""

from collections.abc import Iterable
from math import copysign, inf
from operator import mul
from typing import TypeVar

Number = TypeVar("Number", float, complex)


def total(values: Iterable[float]) -> float:
    """Sum from left to right: the same in every Python, where from 3.12 on `sum` compensates for rounding."""
    result = 0.0
    for value in values:
        result += value
    return result


def dot(a: Iterable[float], b: Iterable[float]) -> float:
    """Sum of the products of two lists."""
    return total(map(mul, a, b))


def ratio(a: float, b: float) -> float:
    """a/b as in C, where division by zero gives an infinity or NaN."""
    return a / b if b else a * copysign(inf, b)


def inverse(matrix: list[list[Number]]) -> list[list[Number]]:
    """Inverse of a regular matrix by Gauss–Jordan elimination with pivoting."""
    size = len(matrix)
    rows = [list(row) + [1.0 if i == j else 0.0 for j in range(size)] for i, row in enumerate(matrix)]
    for column in range(size):
        pivot = max(range(column, size), key=lambda i: abs(rows[i][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        rows[column] = [value / rows[column][column] for value in rows[column]]
        for i in range(size):
            if i != column:
                factor = rows[i][column]
                rows[i] = [a - factor * b for a, b in zip(rows[i], rows[column], strict=True)]
    return [row[size:] for row in rows]

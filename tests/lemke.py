"""Lemke's method in whole numbers: what solves the paper's LCP (15) exactly, where the model takes another way."""

from fractions import Fraction
from math import lcm

Matrix = list[list[float]]


def lemke(M: Matrix, q: list[float]) -> list[float]:
    """Solve 0 ≤ z ⊥ Mz + q ≥ 0 by complementary pivoting, ties broken lexicographically (Cottle, Pang & Stone 1992).

    Returns z. Raises `ArithmeticError` on a secondary ray, which cannot happen for (15): with its last two rows scaled
    down M is positive semidefinite, and scaling rows does not change the problem.

    Exact, since a pivot is zero or not: without clearance every contact is degenerate, and close stabilizers make M
    singular but for a millionth, so that no tolerance tells a pivot from a rounding error.
    """
    size = len(q)
    artificial = 2 * size  # the columns are w, z, the artificial z_0 and the right-hand side
    rows = []
    for i, row in enumerate(M):
        exact = [Fraction(value) for value in (*row, q[i])]
        whole = lcm(*(value.denominator for value in exact))
        *z_part, right = (int(value * whole) for value in exact)
        rows.append([int(i == j) for j in range(size)] + [-m for m in z_part] + [-1, right])
    basis = list(range(size))
    leaving = min(range(size), key=lambda i: (rows[i][-1], -i))
    if rows[leaving][-1] >= 0:
        return [0.0] * size
    rows[leaving] = [-value for value in rows[leaving]]
    entering, divisor = artificial, 1  # the tableau is `rows` over `divisor`
    while True:
        divisor = pivot(rows, leaving, entering, divisor)
        basis[leaving], left_basis = entering, basis[leaving]
        if left_basis == artificial:
            break
        entering = left_basis + size if left_basis < size else left_basis - size
        candidates = [i for i in range(size) if rows[i][entering] > 0]
        if not candidates:
            raise ArithmeticError("the LCP has no solution that Lemke's method can reach (secondary ray)")
        for column in (-1, *range(size)):
            ratios = {i: Fraction(rows[i][column], rows[i][entering]) for i in candidates}
            candidates = [i for i in candidates if ratios[i] == min(ratios.values())]
            if column == -1 and artificial in (basis[i] for i in candidates):
                candidates = [i for i in candidates if basis[i] == artificial]
            if len(candidates) == 1:
                break
        (leaving,) = candidates
    z = [0.0] * size
    for i, variable in enumerate(basis):
        if size <= variable < artificial:
            z[variable - size] = float(Fraction(rows[i][-1], divisor))
    return z


def pivot(rows: list[list[int]], leaving: int, entering: int, divisor: int) -> int:
    """Make `entering` a unit column, all in whole numbers (Bareiss 1968): every division comes out even."""
    factor = rows[leaving][entering]
    for i, row in enumerate(rows):
        if i != leaving:
            own = row[entering]
            rows[i] = [(factor * a - own * b) // divisor for a, b in zip(row, rows[leaving], strict=True)]
    return factor

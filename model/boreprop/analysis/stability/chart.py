"""The stability chart, figure 6: the verdict on each mode over ηΠ and λ₂, by D-decomposition.

For one mode and one λ₂ the number of roots in the right half plane is known for ηΠ → ∞, and it changes only where roots
cross the imaginary axis. Those ηΠ have a closed form, so no roots need to be found.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import log
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...arrays import Floats
from ...case.case import Case
from ...core.checks import check_increasing, check_number, check_quantity, some_numbers
from ...core.errors import ParameterError
from ...core.system import BottomHoleAssembly
from ..lying import pressing_weight
from .any_beam import characteristic_of
from .characteristic import Characteristic
from .contacts import Contact, charted
from .roots import SMALLEST_ETA_PI, Verdict, touching_stabilizers

VERDICTS = tuple(Verdict)  # the index of a verdict is its code in a chart
STABLE, DRIFT, OSCILLATORY = range(3)
REAL_AXIS = np.concatenate([np.logspace(-7.0, -2.0, 16), np.arange(0.02, 3.0, 0.03), np.logspace(0.5, 4.0, 60)])
"""The ν > 0 between which real roots are located: two roots between neighbours are not seen. Dense where drifts are."""
SMALLEST_LAMBDA2 = 0.05  # no stabilizers are closer: even their blades are longer than a twentieth of ℓ₁
PAPERS_CRITICAL = 0.15  # ηΠ of the case study of the paper, rounded: a chart is drawn around it if no other is given
FROM, TO = 0.4, 2.4  # λ₂ of a chart, at least: about that of the second stabilizer in usual BHAs
COLUMNS, ROWS = 300, 200  # of a chart: its steps are finer than the pixels of its panels, and it takes seconds

Integers = NDArray[np.int64]


class Band(NamedTuple):
    """Bands along ηΠ: the ends between them, increasing, shape (k,), and the code of each band, shape (k + 1,)."""

    ends: Floats
    codes: Integers


@dataclass(frozen=True)
class Panel:
    """The verdicts on one mode.

    Parameters
    ----------
    contact
        The numbers of the stabilizers that touch.
    saturated
        Whether the bit tilt is at its limit.
    verdicts
        Codes of the verdicts, 0 stable, 1 drift, 2 oscillatory, shape (k, m): λ₂, then ηΠ.
    bands
        For each λ₂ the bands of equal verdict along ηΠ.
    doubling
        The drilled length in which a drift doubles, m, shape (k, m); nan where the verdict is not drift.
    characteristics
        The characteristic function for each λ₂.
    """

    contact: Contact
    saturated: bool
    verdicts: Integers
    bands: tuple[Band, ...]
    doubling: Floats
    characteristics: tuple[Characteristic, ...]


@dataclass(frozen=True)
class Chart:
    """The verdicts on several modes over ηΠ and λ₂.

    Parameters
    ----------
    eta_pi, lambda2
        The grid, both increasing, shape (m,) and (k,).
    inclination
        Inclination of the straight hole, rad.
    panels
        Two for each set of contacts: one with the bit tilt not saturated, then one with it saturated.
    """

    eta_pi: Floats
    lambda2: Floats
    inclination: float
    panels: tuple[Panel, ...]


def usual_grid(bha: BottomHoleAssembly, eta_pi: float, critical: float = PAPERS_CRITICAL) -> tuple[Floats, Floats]:
    """The ηΠ and λ₂ of a chart with room around the case, which is at `eta_pi`, and around the `critical` ηΠ.

    The largest values are at least four times the critical ηΠ, and one and a half times the ηΠ and λ₂ of the case.
    """
    lambda2 = lambda_2(bha)
    highest = max(4.0 * critical, 1.5 * eta_pi, COLUMNS * SMALLEST_ETA_PI)
    lowest = max(min(FROM, lambda2 / 1.5), SMALLEST_LAMBDA2)
    return (
        np.linspace(highest / COLUMNS, highest, COLUMNS),
        np.linspace(lowest, max(TO, 1.5 * lambda2), ROWS),
    )


def lambda_2(bha: BottomHoleAssembly) -> float:
    """λ₂, the distance from the first to the second stabilizer over ℓ₁.

    Raises
    ------
    ParameterError
        If there is no second stabilizer.
    """
    first, *others = bha.stabilizer_positions
    if not others:
        raise ParameterError("stabilizer_positions", "must hold at least 2 for a chart over λ₂", (first,))
    return (others[0] - first) / first


def _axis(name: str, values: ArrayLike, smallest: float) -> Floats:
    """The values along an axis of the chart, which increase from the smallest on."""
    axis = some_numbers(name, values)
    check_increasing(name, axis)
    check_number(name, axis[0], at_least=smallest)
    return np.array(axis, dtype=float)


def stability_chart(
    case: Case,
    eta_pi: ArrayLike,
    lambda2: ArrayLike,
    *,
    inclination: float | None = None,
    contacts: Sequence[Contact] | None = None,
    progress: Callable[[float], None] = lambda _: None,
) -> Chart:
    """Compute the verdict on modes of a straight hole over ηΠ and λ₂, as in figure 6 of the paper.

    λ₂ is the distance from the first to the second stabilizer over ℓ₁. Stabilizers beyond the second keep their
    distances from it. Stabilizers without clearance touch in every mode.

    Parameters
    ----------
    case
        The drilling system, of two stabilizers or more.
    eta_pi, lambda2
        The grid, both increasing, shape (m,) and (k,); ηΠ >= 1e-4 and λ₂ >= 0.05.
    inclination
        Inclination of the straight hole, rad; without it, that of the existing hole at the bit.
    contacts
        Sets of numbers of stabilizers that touch; each gives two panels. Without it, at most four sets that occur.
    progress
        Called with the fraction done.

    Returns
    -------
    Chart
        The verdicts, a panel for each mode.

    Raises
    ------
    ParameterError
        If there is one stabilizer only, or the grid breaks a constraint.

    Examples
    --------
    >>> import numpy as np
    >>> from boreprop import paper_case, stability_chart
    >>> chart = stability_chart(paper_case(), np.linspace(0.05, 0.2, 4), np.linspace(0.5, 1.5, 3), inclination=0.0)
    >>> chart.panels[0].contact, chart.panels[0].verdicts[1].tolist()
    ((1,), [2, 2, 0, 0])
    """
    bha, bit = case.bha, case.bit
    if inclination is None:
        inclination = case.survey.inclination[-1]
    lambda_2(bha)
    eta_pi, lambda2 = _axis("eta_pi", eta_pi, SMALLEST_ETA_PI), _axis("lambda2", lambda2, SMALLEST_LAMBDA2)
    check_quantity("inclination", inclination)
    weight = pressing_weight(case)
    modes = [
        (numbers, saturated)
        for numbers in (charted(bha, bit, inclination, weight_on_bit=weight) if contacts is None else contacts)
        for saturated in (False, True)
    ]
    panels = []
    for done, (numbers, saturated) in enumerate(modes):
        touching = touching_stabilizers(bha, numbers)
        characteristics, found = [], []
        for distance in lambda2.tolist():
            moved = respaced(bha, distance)
            characteristics.append(characteristic_of(moved, bit, touching, saturated, inclination, weight))
            found.append(verdicts_along(characteristics[-1], eta_pi))
            progress((done + len(found) / len(lambda2)) / len(modes))
        codes, bands, growth = zip(*found, strict=True)
        with np.errstate(divide="ignore"):
            doubling = log(2) / np.array(growth) * bha.length_scale
        panels.append(Panel(numbers, saturated, np.array(codes), bands, doubling, tuple(characteristics)))
    return Chart(eta_pi, lambda2, inclination, tuple(panels))


def respaced(bha: BottomHoleAssembly, lambda2: float) -> BottomHoleAssembly:
    """`bha` with the second stabilizer, and all beyond it, moved so that it is λ₂ from the first.

    The last of its sections is made as long as that needs.
    """
    first, second, *_ = bha.stabilizer_positions
    shift = first * (1.0 + lambda2) - second
    positions = (first, *(position + shift for position in bha.stabilizer_positions[1:]))
    if not bha.section_lengths:
        return replace(bha, stabilizer_positions=positions)
    missing = max(positions[-1] - sum(bha.section_lengths), 0.0)
    lengths = (*bha.section_lengths[:-1], bha.section_lengths[-1] + missing)
    return replace(bha, stabilizer_positions=positions, section_lengths=lengths)


def all_crossings(characteristic: Characteristic, smallest: float) -> tuple[Floats, Floats]:
    """The ηΠ >= `smallest` at which roots cross the imaginary axis, increasing, and the change in number to the right.

    The change is that of the number of roots in the right half plane as ηΠ grows beyond the crossing.
    """
    pairs = characteristic.crossings(smallest)
    at, change = pairs.eta_pi, 2 * pairs.direction
    b, c = characteristic.at_zero()
    if b and -c / b >= smallest:
        _, slope = characteristic(np.zeros(1, complex), -c / b)
        at, change = np.append(at, -c / b), np.append(change, -np.sign(b * slope.real))
    order = np.argsort(at)
    return at[order], change[order]


def unstable_roots(characteristic: Characteristic, eta_pi: Floats) -> tuple[Integers, Integers]:
    """The number of roots in the right half plane, and of the real ones among them, for each ηΠ (increasing)."""
    total = all_roots(characteristic, eta_pi, *all_crossings(characteristic, float(eta_pi[0])))
    return total, real_roots(characteristic, eta_pi, total)[0]


def all_roots(characteristic: Characteristic, eta_pi: Floats, at: Floats, change: Floats) -> Integers:
    """The number of roots in the right half plane for each ηΠ (increasing), given `all_crossings`."""
    to_come = np.append(np.cumsum(change[::-1])[::-1], 0.0)
    b, c = characteristic.at_zero()
    # as ηΠ → ∞ a single root stays near zero, on the side that the sign of P(0) decides
    number: Integers = np.rint(((b or c) < 0) - to_come[np.searchsorted(at, eta_pi)]).astype(int)
    return number


def real_roots(characteristic: Characteristic, eta_pi: Floats, total: Integers) -> tuple[Integers, Floats]:
    """The number of positive real roots, and an estimate of the largest (nan if there is none), for each ηΠ.

    `total` is the number of roots in the right half plane. If there is only one, it is real.
    """
    number, largest = total.copy(), np.full(len(eta_pi), np.nan)
    some = np.flatnonzero(total)
    if len(some):
        a, b, c = characteristic.on_real_axis(REAL_AXIS[:, None])
        value = (a * eta_pi[some] + b) * eta_pi[some] + c
        b_0, c_0 = characteristic.at_zero()
        if b_0 or c_0:
            value = np.vstack([b_0 * eta_pi[some] + c_0, value])
            nu = np.append(0.0, REAL_AXIS)
        else:
            nu = REAL_AXIS
        changes = (value[1:] > 0) != (value[:-1] > 0)
        count = np.count_nonzero(changes, axis=0)
        number[some] = np.where(total[some] == 1, 1, count)
        last, column = len(nu) - 2 - np.argmax(changes[::-1], axis=0), np.arange(len(some))
        before, after = value[last, column], value[last + 1, column]
        root = nu[last] + (nu[last + 1] - nu[last]) * before / (before - after)
        largest[some] = np.where(count > 0, root, np.where(total[some] == 1, 0.0, np.nan))
    return number, largest


def verdicts_along(characteristic: Characteristic, eta_pi: Floats) -> tuple[Integers, Band, Floats]:
    """The code of the verdict at each ηΠ (increasing), the bands of equal verdict, and the growth of a drift.

    The growth is per ℓ₁, and nan where the verdict is not drift.
    """
    at, change = all_crossings(characteristic, float(eta_pi[0]))
    between = np.clip(at, eta_pi[0], eta_pi[-1])
    every = np.append(eta_pi, (between[1:] + between[:-1]) / 2)  # so that no band between two crossings is missed
    order = np.argsort(every, kind="stable")
    x = every[order]
    total = all_roots(characteristic, x, at, change)
    real, growth = real_roots(characteristic, x, total)
    codes = np.where(total > real, OSCILLATORY, np.where(real > 0, DRIFT, STABLE))
    before = np.flatnonzero(codes[1:] != codes[:-1])
    # the verdict changes at a crossing, unless a pair in the right half plane becomes two real roots
    nearest = np.append(at, np.inf)[np.searchsorted(at, x[before])]
    ends = np.where(nearest <= x[before + 1], nearest, (x[before] + x[before + 1]) / 2)
    on_grid = order < len(eta_pi)
    bands = Band(ends, np.append(codes[before], codes[-1]))
    return codes[on_grid], bands, np.where(codes == DRIFT, growth, np.nan)[on_grid]

"""The stability chart, figure 6: the verdict of each mode over ηΠ and λ₂, by D-decomposition.

For one mode and one λ₂ the number of roots in the right half plane is known for ηΠ → ∞, and it changes only where roots
cross the imaginary axis. Those ηΠ have a closed form, so no root is ever looked for.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..core.assembly import BitRock, BottomHoleAssembly, ParameterError, Scaled, check_increasing, check_number, scale
from .characteristic import Characteristic, Floats
from .stability import SMALLEST_ETA_PI, Verdict, stabilizer_numbers, touching_stabilizers

VERDICTS = tuple(Verdict)  # by their codes in a chart
STABLE, DRIFT, OSCILLATORY = range(3)
REAL_AXIS = np.concatenate([np.logspace(-7.0, -2.0, 16), np.arange(0.02, 3.0, 0.03), np.logspace(0.5, 4.0, 60)])
SMALLEST_LAMBDA2 = 0.05

Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Panel:
    """The verdicts of one mode.

    Parameters
    ----------
    contact
        The stabilizers that touch, by number.
    saturated
        Whether the bit tilt is at its limit.
    verdicts
        Indices into `VERDICTS`, shape (len(lambda2), len(eta_pi)).
    characteristics
        The characteristic function for each λ₂.
    """

    contact: tuple[int, ...]
    saturated: bool
    verdicts: Integers
    characteristics: tuple[Characteristic, ...]


@dataclass(frozen=True)
class Chart:
    """Four modes over ηΠ (increasing) and λ₂: all non-ideal stabilizers in contact or none, tilt saturated or not."""

    eta_pi: Floats
    lambda2: Floats
    inclination: float  # of the straight hole, rad
    panels: tuple[Panel, ...]


def usual_grid(bha: BottomHoleAssembly, eta_pi: float) -> tuple[Floats, Floats]:
    """ηΠ and λ₂ of a chart that shows what matters, and the drilling system at `eta_pi` well inside."""
    lambda2 = lambda_2(bha)
    highest = max(0.6, 1.5 * eta_pi)
    return (
        np.linspace(highest / 300, highest, 300),
        np.linspace(max(min(0.4, lambda2 / 1.5), SMALLEST_LAMBDA2), max(2.4, 1.5 * lambda2), 200),
    )


def lambda_2(bha: BottomHoleAssembly) -> float:
    """λ₂, the distance from the first to the second stabilizer over ℓ₁.

    Raises
    ------
    ParameterError
        If there is no second one.
    """
    first, *others = bha.stabilizer_positions
    if not others:
        raise ParameterError("stabilizer_positions", "must hold at least 2 for a chart over λ₂", (first,))
    return (others[0] - first) / first


def stability_chart(
    bha: BottomHoleAssembly,
    bit: BitRock,
    eta_pi: Floats,
    lambda2: Floats,
    inclination: float = 0.0,
    progress: Callable[[float], None] = lambda _: None,
) -> Chart:
    """The verdicts of four modes over ηΠ and λ₂, the distance from the first to the second stabilizer over ℓ₁.

    Stabilizers beyond the second keep their distances from it. Those without clearance touch in every mode.

    Parameters
    ----------
    bha, bit
        The drilling system, of two stabilizers or more.
    eta_pi, lambda2
        The grid, both increasing.
    inclination
        Of the straight hole, rad.
    progress
        Called with the fraction done.

    Raises
    ------
    ParameterError
        If there is one stabilizer only, or the grid breaks a constraint.
    """
    lambda_2(bha)
    check_increasing("eta_pi", tuple(eta_pi.tolist()))
    check_number("eta_pi", float(eta_pi[0]), at_least=SMALLEST_ETA_PI)
    check_increasing("lambda2", tuple(lambda2.tolist()))
    check_number("lambda2", float(lambda2[0]), at_least=SMALLEST_LAMBDA2)
    check_number("inclination", inclination)
    n, scaled = len(bha.stabilizer_positions), scale(bha, bit)
    modes = [(numbers, saturated) for numbers in (range(1, n), range(0)) for saturated in (False, True)]
    panels: list[Panel] = []
    for numbers, saturated in modes:
        touching = touching_stabilizers(bha, numbers)
        characteristics, codes = [], []
        for distance in lambda2.tolist():
            characteristics.append(Characteristic.of(respaced(scaled, distance), touching, saturated, inclination))
            codes.append(verdict_codes(characteristics[-1], eta_pi))
            progress((len(panels) + len(codes) / len(lambda2)) / len(modes))
        panels.append(Panel(stabilizer_numbers(touching), saturated, np.array(codes), tuple(characteristics)))
    return Chart(eta_pi, lambda2, inclination, tuple(panels))


def respaced(scaled: Scaled, lambda2: float) -> Scaled:
    """`scaled` with the second stabilizer, and all beyond it, moved to λ₂ from the first."""
    shift = 1.0 + lambda2 - scaled.s[1]
    return replace(scaled, s=(1.0, *(s_i + shift for s_i in scaled.s[1:])))


def all_crossings(characteristic: Characteristic, smallest: float) -> tuple[Floats, Floats]:
    """ηΠ >= `smallest` where roots cross the imaginary axis, increasing, and how many more are to the right beyond."""
    pairs = characteristic.crossings(smallest)
    at, change = pairs.eta_pi, 2 * pairs.direction
    b, c = characteristic.at_zero()
    if b and -c / b >= smallest:
        _, slope = characteristic(np.zeros(1, complex), -c / b)
        at, change = np.append(at, -c / b), np.append(change, -np.sign(b * slope.real))
    order = np.argsort(at)
    return at[order], change[order]


def unstable_roots(characteristic: Characteristic, eta_pi: Floats) -> tuple[Integers, Integers]:
    """The number of roots in the right half plane, and of real ones among them, for each ηΠ (increasing)."""
    at, change = all_crossings(characteristic, float(eta_pi[0]))
    to_come = np.append(np.cumsum(change[::-1])[::-1], 0.0)
    b_0, c_0 = characteristic.at_zero()
    # ηΠ → ∞ leaves one root near zero, on the side that the sign of P(0) tells
    total = ((b_0 or c_0) < 0) - to_come[np.searchsorted(at, eta_pi)]
    total = np.rint(total).astype(int)
    real = total.copy()
    several = total > 1  # a single one is real
    if several.any():
        a, b, c = characteristic.on_real_axis(REAL_AXIS[:, None])
        x = eta_pi[several]
        positive = (a * x + b) * x + c > 0
        if b_0 or c_0:
            positive = np.vstack([b_0 * x + c_0 > 0, positive])
        real[several] = np.count_nonzero(positive[1:] != positive[:-1], axis=0)
    return total, real


def verdict_codes(characteristic: Characteristic, eta_pi: Floats) -> Integers:
    """The verdict for each ηΠ (increasing), as an index into `VERDICTS`."""
    total, real = unstable_roots(characteristic, eta_pi)
    return np.where(total > real, OSCILLATORY, np.where(real > 0, DRIFT, STABLE))

"""Local stability of a straight hole, section V: the roots of a mode, what they mean, and the critical ηΠ.

`rightmost_roots` and `crossings` of a `Characteristic` are dimensionless; `find_roots` and `critical_eta_pi` take the
drilling system in SI.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from math import pi
from typing import Protocol

import numpy as np

from ...arrays import Complexes, Floats
from ...case.case import Case
from ...core.checks import check_number, check_quantity
from ...core.errors import ParameterError
from ...core.system import BitRock, BottomHoleAssembly
from ...errors import InputError, RootsNotFound
from ..lying import pressing_weight
from .any_beam import characteristic_of
from .zeros import Strip, find_zeros

SMALLEST_ETA_PI = 1e-4  # smaller values would take too long: the number of roots right of an abscissa grows as 1/ηΠ
ABSCISSA = -0.5  # per ℓ₁: usually roots right of this are listed, …
DAMPING = 5.0  # … and for a long BHA those whose disturbance shrinks by less than e⁻⁵ over its length
MARGIN = 0.2  # 1/s_n: room left of the abscissa in which a contour can keep clear of the roots
MOST_ROOTS = 500_000  # more are refused, since finding them would take too long
NEUTRAL = 1e-9  # per ℓ₁: a root this close to the imaginary axis counts as on it
SMOOTH = 6.0  # 1/s_n: at larger Re ν the delayed terms are below e⁻⁶, and the grid may be coarser
SPACING = 0.5  # 1/s_n: of the first grid in the search for roots; with a coarser one more roots are missed at first


class Verdict(StrEnum):
    """What becomes of a small disturbance."""

    STABLE = "stable"  # there is no root in the right half plane
    DRIFT = "drift"  # there are only real ones
    OSCILLATORY = "oscillatory"  # there is a complex pair


@dataclass(frozen=True)
class Roots:
    """All roots of a mode right of an abscissa. The argument principle has confirmed that none is missing.

    Parameters
    ----------
    eta_pi
        ηΠ.
    contact
        The numbers of the stabilizers that touch.
    saturated
        Whether the bit tilt is at its limit.
    roots
        The roots ν, per ℓ₁, the rightmost first. Of each pair only the root with imaginary part > 0 is listed; a
        multiple root is repeated.
    """

    eta_pi: float
    contact: tuple[int, ...]
    saturated: bool
    roots: tuple[complex, ...]

    @property
    def verdict(self) -> Verdict:
        """What becomes of a small disturbance, by the roots in the right half plane."""
        return verdict(self.roots)


@dataclass(frozen=True)
class CriticalEtaPi:
    """The largest ηΠ with a complex pair on the imaginary axis, and the wave that the pair makes.

    Parameters
    ----------
    eta_pi
        ηΠ.
    active_weight_on_bit
        The active weight on bit at that ηΠ, N.
    frequency
        ω, per ℓ₁.
    wavelength
        2π/ω, m.
    """

    eta_pi: float
    active_weight_on_bit: float
    frequency: float
    wavelength: float


def find_roots(
    case: Case,
    eta_pi: float | None = None,
    *,
    contact: Iterable[int] = (),
    saturated: bool = False,
    inclination: float | None = None,
    abscissa: float | None = None,
) -> Roots:
    """Find all roots of a mode of a straight hole right of an abscissa: solve the characteristic equation (19).

    If there are none, the abscissa is moved to the left until there are.

    Parameters
    ----------
    case
        The drilling system.
    eta_pi
        ηΠ, at least 1e-4; without it, that of the case. An axial load stays the case's.
    contact
        Numbers of the stabilizers that touch, from 1; those without clearance always touch.
    saturated
        Whether the bit tilt is at its limit.
    inclination
        Inclination of the straight hole, rad; without it, that of the existing hole at the bit.
    abscissa
        The largest real part that is left out, per ℓ₁, at most 0; without it −0.5, or nearer to 0 for a long BHA.

    Returns
    -------
    Roots
        The roots ν of the growth e^{νξ} of a small disturbance, per ℓ₁, and the verdict on them.

    Raises
    ------
    ParameterError
        If a value is out of range.
    RootsNotFound
        If the argument principle counts more roots than are found.

    Examples
    --------
    >>> from boreprop import find_roots, paper_case
    >>> found = find_roots(paper_case(), contact=[1], inclination=0.0)
    >>> found.verdict, round(found.roots[0].imag, 3)
    (<Verdict.OSCILLATORY: 'oscillatory'>, 18.174)
    """
    if eta_pi is None:
        eta_pi = case.eta_pi
    if inclination is None:
        inclination = case.survey.inclination[-1]
    check_number("eta_pi", eta_pi, at_least=SMALLEST_ETA_PI)
    check_quantity("inclination", inclination)
    check_number("abscissa", abscissa or 0.0, at_most=0.0)
    touching = touching_stabilizers(case.bha, contact)
    weight = pressing_weight(case)
    characteristic = characteristic_of(case.bha, case.bit, touching, saturated, inclination, weight)
    roots = rightmost_roots(characteristic, eta_pi, abscissa)
    return Roots(eta_pi, stabilizer_numbers(touching), saturated, roots)


def critical_eta_pi(
    case: Case,
    *,
    contact: Iterable[int] | None = None,
    saturated: bool = False,
    inclination: float | None = None,
) -> CriticalEtaPi | None:
    """Find the largest ηΠ at which a complex pair of roots of a mode lies on the imaginary axis.

    At larger ηΠ the mode does not oscillate. The roots are those of section V, equation (19).

    Parameters
    ----------
    case
        The drilling system. Its active weight on bit has no influence but by the axial load, which stays the case's.
    contact
        Numbers of the stabilizers that touch; without it all non-ideal ones, the mode that makes a hole ripple.
    saturated
        Whether the bit tilt is at its limit.
    inclination
        Inclination of the straight hole, rad; without it, that of the existing hole at the bit.

    Returns
    -------
    CriticalEtaPi or None
        That ηΠ, as an active weight on bit too, and the wave at it; None if the mode oscillates at no ηΠ >= 1e-4.

    Raises
    ------
    ParameterError
        If a value is out of range.

    Examples
    --------
    >>> from boreprop import critical_eta_pi, paper_case
    >>> round(critical_eta_pi(paper_case(), inclination=0.0).eta_pi, 3)
    0.147
    """
    if inclination is None:
        inclination = case.survey.inclination[-1]
    check_quantity("inclination", inclination)
    return critical_of(case.bha, case.bit, contact, saturated, inclination, pressing_weight(case))


def critical_of(
    bha: BottomHoleAssembly,
    bit: BitRock,
    contact: Iterable[int] | None,
    saturated: bool,
    inclination: float,
    weight_on_bit: float = 0.0,
) -> CriticalEtaPi | None:
    """`critical_eta_pi` of a drilling system, with the weight on bit that loads it along its axis."""
    check_quantity("inclination", inclination)
    touching = touching_stabilizers(bha, range(1, len(bha.stabilizer_positions)) if contact is None else contact)
    characteristic = characteristic_of(bha, bit, touching, saturated, inclination, weight_on_bit)
    for smallest in (0.1, 0.01, 0.001, SMALLEST_ETA_PI):  # from above, since there are ever more crossings below
        crossings = characteristic.crossings(smallest)
        if len(crossings.eta_pi):
            eta_pi, frequency = float(crossings.eta_pi[-1]), float(crossings.omega[-1])
            weight = eta_pi * bha.force_scale / bit.lateral_steering_resistance
            return CriticalEtaPi(eta_pi, weight, frequency, 2 * pi / frequency * bha.length_scale)
    return None


def touching_stabilizers(bha: BottomHoleAssembly, numbers: Iterable[int]) -> tuple[int, ...]:
    """1 for each non-ideal stabilizer with one of `numbers` or without clearance, 0 for the others.

    Raises
    ------
    ParameterError
        If a number is not that of a non-ideal stabilizer.
    """
    wanted, last = set(numbers), len(bha.stabilizer_clearances)
    for number in wanted:
        if number not in range(1, last + 1):
            raise ParameterError("contact", f"must be the number of a non-ideal stabilizer; there are {last}", number)
    return tuple(int(i in wanted or not clearance) for i, clearance in enumerate(bha.stabilizer_clearances, 1))


def parse_contact(text: str) -> tuple[int, ...]:
    """The stabilizer numbers in a text such as "1,2"; `InputError` if it is not such a list."""
    try:
        return tuple(int(number) for number in text.split(",")) if text else ()
    except ValueError:
        raise InputError(f"--contact: must be numbers of stabilizers, separated by commas, got {text!r}") from None


def stabilizer_numbers(touching: tuple[int, ...]) -> tuple[int, ...]:
    """The numbers of the stabilizers that touch."""
    return tuple(i for i, touches in enumerate(touching, 1) if touches)


def verdict(roots: Iterable[complex]) -> Verdict:
    """The verdict on roots, which must include all those in the right half plane."""
    unstable = [root for root in roots if root.real > NEUTRAL]
    if any(root.imag for root in unstable):
        return Verdict.OSCILLATORY
    return Verdict.DRIFT if unstable else Verdict.STABLE


class Searched(Protocol):
    """A function whose zeros are roots: a `Characteristic`, or what is made of some."""

    @property
    def s(self) -> Floats:
        """The delays."""

    def __call__(self, nu: Complexes, eta_pi: float | Floats) -> tuple[Complexes, Complexes]:
        """The function and its derivative."""

    def on_grid(self, x: Floats, y: Floats, eta_pi: float) -> Complexes:
        """The function at x + iy; it may have further zeros."""

    def outline(self, eta_pi: float, abscissa: float) -> tuple[Floats, Floats]:
        """A bound on the zeros."""


def rightmost_roots(characteristic: Searched, eta_pi: float, abscissa: float | None = None) -> tuple[complex, ...]:
    """All roots with Re ν >= `abscissa` (<= 0), the rightmost first; if there are none, further left until there are.

    Of each pair only the root with imaginary part > 0 is listed; a multiple root is repeated.

    Raises
    ------
    ParameterError
        If there are too many roots right of the abscissa.
    RootsNotFound
        If the argument principle counts more roots than are found.
    """
    reach = float(characteristic.s[-1])
    if abscissa is None:
        abscissa = usual_abscissa(characteristic)
    frequencies, rightmost = characteristic.outline(eta_pi, abscissa - MARGIN / reach)
    if frequencies[-1] * reach > 2 * pi * MOST_ROOTS:
        raise ParameterError(
            "abscissa", f"must be nearer to 0: right of it lie too many roots at ηΠ = {eta_pi:g}", abscissa
        )
    try:
        roots = find_zeros(
            lambda nu: characteristic(nu, eta_pi),
            lambda x, y: characteristic.on_grid(x, y, eta_pi),
            Strip(abscissa, float(rightmost[0]), float(frequencies[-1])),
            MARGIN / reach,
            SPACING / reach,
            lambda y: float(rightmost[np.searchsorted(frequencies, y, side="right") - 1]),
            SMOOTH / reach,
        )
    except ArithmeticError as error:
        raise RootsNotFound(f"the roots at ηΠ = {eta_pi:.6g}: {error}; use a slightly different --eta-pi") from error
    roots = roots[roots.real >= abscissa]
    if not len(roots):
        return rightmost_roots(characteristic, eta_pi, abscissa + usual_abscissa(characteristic))
    return tuple(roots[np.lexsort([roots.imag, -roots.real])].tolist())


def usual_abscissa(characteristic: Searched) -> float:
    """The abscissa right of which roots are listed if none is given."""
    return max(ABSCISSA, -DAMPING / float(characteristic.s[-1]))

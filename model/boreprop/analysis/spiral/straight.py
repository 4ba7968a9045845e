"""Small spirals about a straight vertical hole, with all stabilizers on the wall all around and the tilt free.

They are those of the characteristic function of that mode with a bit that walks, see `stability.characteristic`. A
spiral to the left under a walk ϖ is the mirror image of one to the right under −ϖ.
"""

from math import pi
from typing import NamedTuple

import numpy as np

from ...arrays import Complexes, Floats
from ..stability.any_beam import AnyBeam
from ..stability.characteristic import Characteristic
from ..stability.roots import SMALLEST_ETA_PI, rightmost_roots, usual_abscissa

LARGEST_ETA_PI = (0.1, 0.01, 0.001, SMALLEST_ETA_PI)  # crossings are sought from so large ηΠ on, in turn


class Both:
    """The product P(ν) P̄(ν̄) for a bit that walks, real on the real axis as the search for zeros has it.

    Of its zeros in the upper half plane some are roots that wind to the right, the others conjugates of roots that wind
    to the left.
    """

    def __init__(self, right: Characteristic, left: Characteristic) -> None:
        self.right, self.left, self.s = right, left, right.s

    def __call__(self, nu: Complexes, eta_pi: float | Floats) -> tuple[Complexes, Complexes]:
        """The product and its derivative."""
        (P, P_slope), (R, R_slope) = self.right(nu, eta_pi), self.left(nu, eta_pi)
        return P * R, P_slope * R + P * R_slope

    def on_grid(self, x: Floats, y: Floats, eta_pi: float) -> Complexes:
        """The product times ν², at x + iy."""
        return self.right.on_grid(x, y, eta_pi) * self.left.on_grid(x, y, eta_pi)

    def outline(self, eta_pi: float, abscissa: float) -> tuple[Floats, Floats]:
        """A bound on the zeros, as that of a `Characteristic`."""
        (f, right), (g, left) = self.right.outline(eta_pi, abscissa), self.left.outline(eta_pi, abscissa)
        most = max(len(f), len(g))
        bounds = [np.pad(each, (0, most - len(each)), constant_values=abscissa) for each in (right, left)]
        return f if len(f) == most else g, np.maximum(*bounds)

    def is_right(self, root: complex, eta_pi: float) -> bool:
        """Whether a zero in the upper half plane is a root that winds to the right."""
        at = np.array([root])
        right, left = abs(self.right(at, eta_pi)[0][0]), abs(self.left(at, eta_pi)[0][0])
        return bool(right < left)


class Critical(NamedTuple):
    """The largest ηΠ at which a small spiral keeps itself up, and its ω."""

    eta_pi: float
    omega: float


def held(beam: AnyBeam, walk: float) -> Characteristic:
    """The characteristic function of a straight vertical hole with all stabilizers on the wall."""
    return beam.characteristic((1,) * (len(beam.s) - 1), walk=walk)


def critical(beam: AnyBeam, walk: float, longest: float) -> Critical | None:
    """The largest ηΠ at which a small spiral to the right keeps itself up; None if there is none above 1e-4.

    `longest` is the longest pitch that counts, in ℓ₁: a bit that walks also makes the whole hole drift around the
    vertical, in pitches of thousands of ℓ₁.
    """
    function = held(beam, walk)
    for smallest in LARGEST_ETA_PI:
        crossings = function.crossings(smallest)
        fast = np.flatnonzero(crossings.omega > 2 * pi / longest)
        if len(fast):
            return Critical(float(crossings.eta_pi[fast[-1]]), float(crossings.omega[fast[-1]]))
    return None


def rightmost(beam: AnyBeam, walk: float, eta_pi: float) -> complex:
    """The root farthest right of those whose disturbance winds to the right, per ℓ₁.

    Raises
    ------
    RootsNotFound
        As by `rightmost_roots`.
    """
    right = held(beam, walk)
    both = Both(right, held(beam, -walk)) if walk else None
    step = abscissa = usual_abscissa(right)
    while True:
        for root in rightmost_roots(both or right, eta_pi, abscissa):
            if root.imag > 0 and (both is None or both.is_right(root, eta_pi)):
                return root
        abscissa += step

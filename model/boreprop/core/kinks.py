"""The kinks ahead: where a stabilizer will pass a jump in a derivative of the hole's Y, and with it the solution."""

from bisect import insort
from collections.abc import Iterable
from itertools import takewhile
from math import factorial, inf
from typing import Any, NamedTuple

from .options import Options

SMOOTHEST_KINK = 3  # of the derivatives of Y: what a jump in a higher one does is small, and the error estimate sees it
MERGE = 1e-9  # ℓ₁: kinks closer than this are one. Far above the rounding of a place, far below any step worth taking


PASSED_Y = (0.0, 9.13e-3, 4.40e-4, 3.51e-5)
PASSED_THETA = (0.0, 7.17e-2, 6.09e-3, 7.31e-4)
# What a step of length h over a jump of 1 in derivative m of the delayed Y errs: in Y up to PASSED_Y[m] h^(m+1), in θ
# up to PASSED_THETA[m] h^m, by a gain of 1. Largest errors of the interpolation of (t − a)^m/m!, which begins at any a
# in [0, 1], between the Radau nodes, and of the integral of that.


def harm_of(h: float, theta_weight: float, many: bool) -> tuple[float, ...]:
    """What passing a kink does to a step of length `h`, per jump and gain, by the order of the kink.

    Errors of θ have this weight. It is no more than what a kink changes over twice the step, which counts where there
    are not many: before the law changes on the way. Such runs keep their steps to the last bit.
    """
    orders = range(SMOOTHEST_KINK + 1)
    changes = [(2 * h) ** (m + 1) / factorial(m + 1) for m in orders]
    if not many:
        return tuple(changes)
    errors = [h**m * max(PASSED_Y[m] * h, theta_weight * PASSED_THETA[m]) for m in orders]
    return tuple(map(min, changes, errors))


class Kink(NamedTuple):
    """At `xi` stabilizer `i` passes a jump of size `jump` in derivative `order` of the hole's Y."""

    xi: float
    order: int
    jump: float
    i: int


class Kinks:
    """The kinks ahead of the bit, in order: each jump in the hole comes back at ξ + s_i, once for every stabilizer.

    They count as many once the law has changed on the way.
    """

    def __init__(self, s: tuple[float, ...]) -> None:
        self.s, self.many = s, False
        self.ahead: list[Kink] = []
        self._last: tuple[float, int, float] = (-inf, 0, 0.0)  # jump added: where, in which derivative, its size

    def add_images(self, xi: float, order: int, jump: float) -> None:
        """Mark where the stabilizers will pass a jump at `xi` in a derivative of Y; jumps at one place add up."""
        if order > SMOOTHEST_KINK:
            return
        if (xi, order) == self._last[:2]:  # the inputs change once more where the bit is
            earlier = self._last[2]
            for i, s_i in enumerate(self.s):
                self.ahead.remove(Kink(xi + s_i, order, earlier, i))
            jump += earlier
        for i, s_i in enumerate(self.s):
            insort(self.ahead, Kink(xi + s_i, order, jump, i))
        self._last = xi, order, jump

    def kink_here(self, xi: float, shortest: float) -> int | None:
        """Take the kinks up to `xi` off the list; give the lowest derivative of Y that jumps at `xi` by them, if any.

        Derivative k of Y at a stabilizer acts on derivative k + 1 at the bit. A step may have to stop half way to a
        kink, and no step is shorter than `shortest`: a kink at less than twice that counts as met here.
        """
        near = max(MERGE, 2 * shortest)
        passed = list(takewhile(lambda kink: kink.xi - xi <= near, self.ahead))
        del self.ahead[: len(passed)]
        return min((kink.order + 1 for kink in passed if xi - kink.xi <= near), default=None)

    def next_kink(self, xi: float, h: float, gains: list[float], harm: tuple[float, ...], tolerance: float) -> float:
        """Where the next kink within `h` of `xi` lies that a step must not pass; inf if there is none.

        It may pass those that do it less harm than the tolerance; `gains` are those of the law.
        """
        for kink in self.ahead:
            if kink.xi >= xi + h:
                break
            if gains[kink.i] * kink.jump * harm[kink.order] > tolerance:
                return kink.xi
        return inf

    def reach(self, xi: float, h: float, gains: list[float], options: Options) -> tuple[float, float]:
        """The length of a step from `xi`, at most h, and how far the next kink is that such a step must not pass.

        Where there are many kinks, the length is halved until the step goes farther than to half of it: a shorter step
        may pass a kink that a longer one may not.
        """
        while True:
            harm = harm_of(h, options.theta_weight, self.many)
            to_kink = self.next_kink(xi, 2 * h, gains, harm, options.relative_tolerance) - xi
            if not self.many or to_kink > h / 2:
                return h, to_kink
            h /= 2

    def save(self) -> dict[str, Any]:
        """The kinks, as plain lists."""
        return {"ahead": self.ahead[:], "last": self._last, "many": self.many}

    def restore(self, state: dict[str, Any]) -> None:
        """Take over the kinks from `save`."""
        ahead: Iterable[tuple[float, int, float, int]] = state["ahead"]
        self.ahead = [Kink(*kink) for kink in ahead]
        self.many = state["many"]
        xi, order, jump = state["last"]
        self._last = xi, order, jump

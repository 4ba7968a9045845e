"""How long the next step of the integrator is tried, and what follows from its error."""

from dataclasses import dataclass

from . import radau
from .kinks import SMOOTHEST_KINK
from .modes import ROUNDING
from .step import Step

ORDER = radau.S + 1  # in the length of a trial, of its error
SAFETY = 0.85  # of the step that the error estimate asks for, so that few of the next ones are rejected
LARGEST_GROWTH = 8.0  # of a step over the last, as in RADAU5 (Hairer & Wanner, IV.8): an estimate reaches no farther
SMALLEST_GROWTH = 0.1  # of a trial over a rejected one, for the same reason
LEAST_ERROR = 1e-12  # of a trial, over the tolerance: it is not zero, and its growth is far above the largest
CLOSER = 8.0  # by this factor a step is tried shorter where each regime meets a bound before its first point, and the
# slack by which values may lie beyond their bounds at the points is made larger; 2 to 64 serve as well


@dataclass
class Plan:
    """How a step is tried, and tried again."""

    h: float  # its length
    resumed: float  # the length that may follow if a kink cuts it short
    order: int = ORDER  # in h, of the error of a trial that errs too much
    repeated: bool = False  # an earlier trial was no good: the next is never longer than planned
    switches: int = 0  # of the regime where it starts
    slack: float = ROUNDING  # by which its points may lie beyond a bound

    def shorten(self, h: float, error: float) -> None:
        """Try again, a trial of length `h` having erred too much."""
        self.h = self.resumed = h * max(growth(error, self.order), SMALLEST_GROWTH)
        self.repeated = True

    def look_closer(self, h: float) -> None:
        """Try again, each regime having met a bound before the first point."""
        self.h, self.repeated, self.switches = h, True, 0
        self.slack *= CLOSER


def first_plan(last: Step, kink: int | None, longest: float, many_kinks: bool) -> Plan:
    """The plan of the next step: as the last one left it, but after a kink no longer than `longest`.

    Where there are many kinks, it counts that the error behind one is of the transient there, of second order.
    """
    plan = Plan(last.next_h, last.next_h)
    if (kink is not None and kink <= SMOOTHEST_KINK) or last.end == last.xi:
        plan.h = min(plan.h, longest)
        if last.event is not None:
            plan.resumed = plan.h
        if many_kinks:
            plan.order = 2
    return plan


def growth(error: float, order: int = ORDER) -> float:
    """How much longer than a trial with this error, over the tolerance and of this order, the next one may be."""
    grown: float = max(error, LEAST_ERROR) ** (-1 / order)
    return SAFETY * grown

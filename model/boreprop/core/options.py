"""What steers the integrator, and what it says of its work."""

from dataclasses import dataclass
from typing import NamedTuple

from .checks import check_number, check_quantity
from .quantities import RELATIVE_TOLERANCE as RELATIVE_TOLERANCE


@dataclass(frozen=True)
class Options:
    """How the integrator takes its steps. The defaults serve every case; tests steer by the rest.

    Parameters
    ----------
    relative_tolerance
        Local error allowed in one step, relative to 1 rad and to ℓ₁; 1e-12 to 1e-2.
    largest_step
        ℓ₁. The default is the shortest delay, so a step never needs hole that is not yet drilled.
    smallest_step
        ℓ₁, from ξ = 1 on times ξ. The next position must differ from the last, and a double carries 16 digits; the
        default leaves four of them for the length of a step.
    layers
        First step after a kink, in relaxation lengths of θ. The transient that a kink starts has died out after 16 of
        them (e⁻¹⁶ = 1e-7), and of 4 to 64 it makes the reference cases try the fewest steps.
    theta_weight
        Weight of the error of θ, where that of Y counts whole: θ forgets an error within a relaxation length, Y
        carries it for the length of the BHA. At 1 the reference cases would try 1.4 times the steps.
    most_steps
        In one way to drill, so that a way without an end ends.

    Raises
    ------
    ParameterError
        If a value is out of range.
    """

    relative_tolerance: float = RELATIVE_TOLERANCE
    largest_step: float = 1.0
    smallest_step: float = 1e-12
    layers: float = 16.0
    theta_weight: float = 0.1
    most_steps: int = 2**18

    def __post_init__(self) -> None:
        check_quantity("relative_tolerance", self.relative_tolerance)
        check_number("largest_step", self.largest_step, above=0.0, at_most=1.0)
        check_number("smallest_step", self.smallest_step, at_least=1e-15)
        check_number("layers", self.layers, above=0.0)
        check_number("theta_weight", self.theta_weight, at_least=0.0)
        check_number("most_steps", self.most_steps, at_least=1)

    def shortest_step(self, xi: float) -> float:
        """The shortest step at `xi`, in ℓ₁."""
        return self.smallest_step * max(1.0, xi)


class Statistics(NamedTuple):
    """What the integrator has done since the start of the run."""

    accepted: int  # steps
    rejected: int  # trials that were repeated over a shorter length, since their error was too large
    events: int  # bounds met

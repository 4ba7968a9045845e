"""The options of the integrator, and the statistics of its work."""

from dataclasses import dataclass
from typing import NamedTuple

from .checks import check_number, check_quantity
from .quantities import RELATIVE_TOLERANCE as RELATIVE_TOLERANCE


@dataclass(frozen=True)
class Options:
    """How the integrator takes its steps. The defaults serve every case; other values are for tests.

    Parameters
    ----------
    relative_tolerance
        Local error allowed in one step, relative to 1 rad and to ℓ₁; 1e-12 to 1e-2.
    largest_step
        Length of the longest step, in ℓ₁. The default is the shortest delay, so that a step never needs hole that is
        not drilled yet.
    smallest_step
        Length of the shortest step, in ℓ₁; beyond ξ = 1 it is this times ξ. The next position must differ from the
        last one, and a double carries 16 digits: the default leaves four of them for the length of a step.
    layers
        Length of the longest first step after a kink, in relaxation lengths of θ. The transient that a kink starts has
        died out after 16 of them (e⁻¹⁶ = 1e-7), and with 16 the reference cases take the fewest trials among 4 to 64.
    theta_weight
        Weight of the error of θ in that of a step, in which the error of Y has weight 1: θ forgets an error within a
        relaxation length, whereas Y carries it for the length of the BHA. With a weight of 1 the reference cases would
        take 1.4 times the trials. In space it counts three times (`kernel/step.h`).
    most_steps
        Number of steps after which a call gives up, so that it ends even if asked for a length without end.

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
        """Length of the shortest step at `xi`, in ℓ₁."""
        return self.smallest_step * max(1.0, xi)


class Statistics(NamedTuple):
    """What the integrator has done since the start of the run."""

    accepted: int  # steps
    rejected: int  # trials that were repeated over a shorter length, since their error was too large
    events: int  # bounds met

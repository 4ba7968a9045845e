"""Sensors along the BHA: where they are, and how a survey instrument reads the inclination.

All lengths are over ℓ₁. A sensor with an interval reads where the bit has drilled 0, 1, 2, … intervals, under the
inputs that drilled up to there; in between its last reading is held. The noise of a reading depends on nothing but
seed, sensor and number of the reading, so that any run has it again.
"""

from math import cos, floor, log, pi, sqrt
from typing import NamedTuple

EARLY = 1e-9  # intervals: a reading is taken this much early, where lengths that a host has added up end on it
MOST_READINGS = 2.0**53  # beyond this, numbers of readings are no longer exact
GAMMA, MASK = 0x9E3779B97F4A7C15, 2**64 - 1


def mixed(state: int) -> int:
    """The number that the generator SplitMix64 gives next to this state (Steele, Lea & Flood, OOPSLA 2014)."""
    z = (state + GAMMA) & MASK
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return z ^ (z >> 31)


def share(bits: int) -> float:
    """The number between 0 and 1, never at either, that the upper half of 64 random bits and more make."""
    return ((bits >> 12) + 0.5) * 2.0**-52


def normal(seed: int, sensor: int, number: int) -> float:
    """The standard normal number of one reading of one sensor, both counted from 0, by Box and Muller."""
    first = mixed(mixed(mixed(seed) + sensor & MASK) + number & MASK)
    return sqrt(-2 * log(share(first))) * cos(2 * pi * share(mixed(first)))


class Sensor(NamedTuple):
    """Where a sensor is, how it reads, and the clearance of a centred body there."""

    s: float
    interval: float
    bias: float
    noise: float
    seed: int
    clearance: float

    def due(self, xi: float) -> int:
        """The number of the last reading that is due with the bit at `xi`, from 0 on."""
        return floor(min(xi / self.interval + EARLY, MOST_READINGS))

    def reads(self, inclination: float, sensor: int, number: int) -> float:
        """What it tells in a reading, itself being the one with this number."""
        return inclination + self.bias + (self.noise * normal(self.seed, sensor, number) if self.noise else 0.0)


class Sensed(NamedTuple):
    """The BHA at a sensor: its inclination, its offset from the axis of the hole, and the bending moment."""

    inclination: float
    offset: float
    moment: float


class Reading(NamedTuple):
    """The last reading of a sensor: its number, and the inclination that it told."""

    number: int = -1
    inclination: float = 0.0

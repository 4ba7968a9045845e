"""Searches the end of a run for a wave: in a plane in the inclination of the hole, in space in its direction."""

from collections.abc import Sequence
from enum import StrEnum
from math import inf, nan
from statistics import median
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from .waves import (
    ALMOST,
    FEWEST_ROWS,
    FEWEST_WAVES,
    LastWaves,
    even_rows,
    likeness,
    wavelength_in_rows,
    without_even_trend,
)

SHORTER = 4.0  # each window is shorter than the last by this factor, so that small short waves on long ones are found
SMALLEST_AMPLITUDE = np.radians(0.001)  # far above the error that the integrator leaves in a straight hole, 1e-10°
ALIKE = 0.5  # the autocorrelation at one wavelength from which a signal counts as a wave
ALIKE_SWITCHING = 0.2  # the same if each wave changes the mode, which noise does not: chaotic ripples have 0.25 to 0.6
NOISE = 4.5  # standard deviations, 1/√rows, of the autocorrelation of white noise: noise reaches this at no lag tried
STILL_ALIKE = 0.8  # times ALIKE: the autocorrelation that the last waves must have, or the wave has ended
AT_THE_END = 4  # waves at the end that decide whether a wave is still there, its size and whether it changes modes
MOST_WAVES = 10  # waves at the end from which the growth is determined, …
MOST_OF_LONGEST = 2.0  # … or as many as fit into this many of the longest waves, if more: ripples beat
FALLING = 0.03  # loss of size per wave: a wave that falls faster, to half within 23 waves, is dying
FALLING_IN_ONE_MODE = 1e-4  # the same for a wave that changes no mode, whose exponential decay is this well determined


class State(StrEnum):
    """What becomes of a wave at the end of a run."""

    NONE = "none"  # there is no wave
    DYING = "dying"
    LASTING = "lasting"
    GROWING = "growing"
    STEERED = "steered"  # there is a wave, but force or weight change too often to say whether it would last


class _Rows(NamedTuple):
    """Some rows of a run: drilled length, m, direction, rad, and modes, whole numbers, shape (rows, k)."""

    length: Floats
    direction: NDArray[Any]
    modes: NDArray[np.int_] | None

    def where(self, kept: NDArray[np.bool_] | slice) -> "_Rows":
        """The rows that a mask or a slice selects."""
        return _Rows(self.length[kept], self.direction[kept], None if self.modes is None else self.modes[kept])

    def even(self) -> "_Rows":
        """As many rows, evenly spaced, as `even_rows` gives; the modes are those of the last row before."""
        length = even_rows(self.length)
        last = np.searchsorted(self.length, length + ALMOST * (length[1] - length[0]), side="right") - 1
        modes = None if self.modes is None else self.modes[last]
        return _Rows(length, np.interp(length, self.length, self.direction), modes)


class Found(NamedTuple):
    """A wave that was found; the fields are those of `Rippling`, with the last of its waves and where they were seen.

    In space the waves are complex, and the amplitude is that along the longer axis of the ellipse.
    """

    state: State = State.NONE
    wavelength: float = nan
    amplitude: float = nan
    growth: float = nan
    switching: bool | None = None
    waves: LastWaves | None = None
    length: Floats | None = None
    direction: NDArray[Any] | None = None

    @property
    def ripples(self) -> bool:
        """Whether the wave lasts or grows."""
        return self.state in (State.LASTING, State.GROWING)


NOTHING = Found()


def search(
    length: Floats,
    direction: NDArray[Any],
    longest: float,
    modes: NDArray[np.int_] | None,
    inputs: Sequence[Floats],
) -> Found:
    """Search the end of a run for a wave, see `find_rippling`.

    The direction of the hole, rad, shape (rows,), is its inclination in a plane; in space it is complex, its parts to
    two sides, and the modes also tell to which side stabilizers and bit tilt are.
    """
    changed = np.zeros(max(len(length) - 1, 0), dtype=bool)
    for values in inputs:
        changed |= values[1:] != values[:-1]
    moved = np.ones(len(length), dtype=bool)  # of several rows at one length, only the last one is used
    np.greater(length[1:], length[:-1], out=moved[:-1])
    steady = int(np.count_nonzero(moved[: int(np.flatnonzero(changed)[-1]) + 1])) if changed.any() else 0
    rows = _Rows(length, direction, modes) if moved.all() else _Rows(length, direction, modes).where(moved)
    found = _search_rows(rows.where(slice(steady, None)), longest)
    if found.waves or not steady:
        return found
    found = _search_rows(rows, longest)
    return found._replace(state=State.STEERED) if found.ripples else NOTHING


def _search_rows(rows: _Rows, longest: float) -> Found:
    """The wave in windows at the end of some rows: the first holds five of the longest waves, the last few rows."""
    found, fewest = [NOTHING], int(FEWEST_WAVES * FEWEST_ROWS)
    if len(rows.length) < fewest:
        return NOTHING
    rows = rows.even()
    spacing = float(rows.length[1] - rows.length[0])
    count = int(min(len(rows.length), FEWEST_WAVES * longest / spacing + 1))
    followed = MOST_OF_LONGEST * count * spacing / FEWEST_WAVES
    while count >= fewest:
        found.append(_wave(rows, spacing, count, followed))
        count = int(count / SHORTER)
    return max(found, key=_weight)


def _weight(found: Found) -> tuple[bool, bool, float]:
    """A sort key: a wave that lasts comes before one that dies, and a large one before a small one."""
    there = found.waves is not None
    return found.ripples, there, found.amplitude if there else 0.0


def _wave(rows: _Rows, spacing: float, count: int, followed: float) -> Found:
    """The wave in the last `count` rows, followed back over `followed` m, or over ten waves if that is more."""
    length, direction = rows.length, rows.direction
    signal = without_even_trend(direction[-count:])
    if np.abs(signal).max() < SMALLEST_AMPLITUDE:
        return NOTHING
    period, alike = wavelength_in_rows(signal)
    enough = max(ALIKE, NOISE / np.sqrt(count - period)) if alike else inf
    if alike < enough and (rows.modes is None or alike < ALIKE_SWITCHING):
        return NOTHING
    wavelength = float(period * spacing)
    waves = LastWaves.of(length, direction, wavelength, max(MOST_WAVES, int(followed / wavelength)))
    if waves.count < FEWEST_WAVES - 1 or waves.sizes[-1] <= 0:
        return NOTHING
    irregular = max(likeness(waves.deviation, period), ALIKE_SWITCHING)
    height = waves.along(waves.axis).height()
    amplitude = height / 2 / irregular**0.5  # the mean of waves that differ is lower than each of them
    if amplitude < SMALLEST_AMPLITUDE:
        return NOTHING
    switching = _switching(rows, waves)
    if not switching and (alike < enough or not _still_there(waves, period)):
        return NOTHING
    growth, error = waves.growth()
    limit = FALLING_IN_ONE_MODE if switching is False else FALLING
    return Found(
        State.DYING if growth + error < -limit else State.GROWING if growth - error > limit else State.LASTING,
        wavelength,
        amplitude,
        growth / wavelength,
        switching,
        waves,
        length,
        direction,
    )


def _switching(rows: _Rows, waves: LastWaves) -> bool | None:
    """Whether a contact or the saturation changes in each of the last waves; None without modes."""
    if rows.modes is None:
        return None
    late = int(np.searchsorted(waves.wave[1:], waves.count - AT_THE_END))
    first = int(np.searchsorted(rows.length, waves.x[late]))
    modes = rows.modes[first : first + len(waves.x) - late]
    changes = np.bincount(waves.wave[late + 1 :], (modes[1:] != modes[:-1]).any(axis=1), waves.count)
    return bool(median(changes[-AT_THE_END:].tolist()) >= 1)


def _still_there(waves: LastWaves, period: float) -> bool:
    """Whether the last four waves, taken alone, still count as a wave."""
    late = waves.deviation[waves.place >= waves.count - AT_THE_END]
    enough = STILL_ALIKE * max(ALIKE, NOISE / max(len(late) - period, 1.0) ** 0.5)
    return bool(likeness(late, period) >= enough)

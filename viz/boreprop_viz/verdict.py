"""What is true of a hole at each drilled length, in words: its ripple, where it began and ended, and its plan.

A run is checked at points that its drilled length decides, so the words do not depend on how its rows come.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from boreprop.analysis.ellipse import Ellipse, Shape
from boreprop.analysis.hole_in_space import is_in_space
from boreprop.analysis.rippling import Rippling, find_rippling, last_wave, visible_waves
from boreprop.analysis.search import State
from boreprop.analysis.space import direction_of
from boreprop.analysis.summary import SHORT_WAVE
from boreprop.analysis.waves import large_until
from boreprop.case.case import Case
from boreprop.report.tables.stations import beside
from boreprop.report.tables.summary import ROUND, SHAPES
from boreprop.run.trajectory import Trajectory
from boreprop.units import SMALL_LENGTH, UNITS, Unit

from .source import between, joined

RECENT = 32.0  # half lengths of the BHA up to the bit that decide whether the hole ripples: five of the longest waves
EVERY = 1.0  # half lengths of the BHA from check to check: a ripple comes and goes over several
SELDOM = 4  # times as far to the next check while a ripple lasts: these checks cost most, and most find nothing new
NOTICEABLE = 0.15  # of an amplitude or a distance: a smaller change is not told
FADED = 0.5  # of an amplitude: a wave that dies out swings while it does, and is told again when it has fallen to this
STILL = 0.5  # of an amplitude: a ripple that is at least this large goes on while force or weight change
NEAR = 0.1  # m: a smaller change of the distance from the plan is not told
SO_FAR = "no ripple so far"
Kind = tuple[State, Shape | None]


class Saying(NamedTuple):
    """Words that hold from a row of a run on: its drilled length, m, its time, s (None if it has none), the words."""

    length: float
    time: float | None
    words: str


class Verdict:
    """Follows a run, and says what is true of it.

    A new state of the ripple, or in space a new shape, is told once two checks running have found it, or at the end of
    the run. While force or weight change too often to tell, a ripple counts as going on. Places are drilled lengths
    from an `origin`, m: with the measured depth of the start they are measured depths.
    """

    def __init__(self, case: Case, origin: float = 0.0) -> None:
        self.origin = origin
        self.every, self.reach = EVERY * case.bha.half_length, RECENT * case.bha.half_length
        self.rows: Trajectory | None = None  # the last rows, as far back as a check needs
        self.start, self.steps = 0.0, 1  # where the run starts, m, and how many steps from there the next check is
        self.checked = -np.inf  # the last row that was checked, m
        self.kind: Kind = (State.NONE, None)  # at the last check
        self.told = Rippling()  # the wave that was told last
        self.began: float | None = None  # from where on the present ripple has had half its size, m, …
        self.wound = np.nan  # … and from where on the present spiral has wound to its side, m
        self.ended: tuple[float, Rippling] | None = None  # a ripple that is over, until it is known where it ended
        self.past = ""  # the last ripple that is over, in words
        self.off_plan = 0.0  # the distance from the plan that was told last, m
        self.beyond = 0.0  # by how much the BHA was told to leave the hole, m
        self.hidden = 0.0  # the longest wave that was told to be too short for its rows, m
        self.ripple, self.unseen, self.plan, self.sag, self.said = SO_FAR, "", "", "", ""  # in words

    @property
    def next(self) -> float:
        """The drilled length of the next check, m."""
        return self.start + self.steps * self.every

    def follow(self, rows: Trajectory) -> list[Saying]:
        """Take the next rows of the run, at least one; returns what there is to say up to the last of them."""
        sayings = []
        if self.rows is None:
            self.start = float(rows["drilled_length"][0])
            first = between(rows, self.start, self.start)
            self._see_plan(first)
            self._see_sag(first)
            sayings += self._say(first)
        else:
            rows = joined(self.rows, rows)
        length = rows["drilled_length"]
        while self.next < length[-1]:  # so that no further row will come at the length of the check
            recent = between(rows, self.next - self.reach, self.next)
            if recent.row_count and recent["drilled_length"][-1] > self.checked:
                self._check(recent)
                sayings += self._say(recent)
            self.steps += SELDOM if self.kind[0] is self.told.state is State.LASTING else 1
        self.rows = between(rows, length[-1] - self.reach, np.inf)
        return sayings

    def end(self, how: str = "", why: str = "") -> list[Saying]:
        """Check the last rows, and say where, `how` and `why` the run ended, if early; returns what else is to say."""
        if self.rows is None:
            return []
        self._check(self.rows, sure=True)
        if self.ripple == SO_FAR:
            self.ripple = "no ripple"
        return self._say(
            self.rows, f"; {how} at {UNITS['m'].text(self.origin + self.checked)}{': ' * bool(why)}{why}" if how else ""
        )

    def _say(self, recent: Trajectory, end: str = "") -> list[Saying]:
        """What is to be said from the last of some rows on: nothing if it was said already."""
        words = f"{self.ripple}{self.unseen}{self.plan}{self.sag}{end}"
        if words == self.said:
            return []
        self.said = words
        time = float(recent["time"][-1]) if "time" in recent else None
        return [Saying(float(recent["drilled_length"][-1]), time, words)]

    def _check(self, recent: Trajectory, sure: bool = False) -> None:
        """Look at the last rows, and find words for what has changed noticeably."""
        wave = find_rippling(recent) if is_in_space(recent) else last_wave(recent)
        going_on = self.began is not None and wave.amplitude > STILL * self.told.amplitude
        if wave.state is State.STEERED and going_on:
            wave = replace(wave, state=State.LASTING)
        before, self.checked = self.checked, float(recent["drilled_length"][-1])
        confirmed, self.kind = sure or _kind(wave) == self.kind, _kind(wave)
        if sure or (confirmed and (self.kind != _kind(self.told) or _changed(wave, self.told))):
            self._tell(replace(find_rippling(recent), state=wave.state), recent)
        self._see_spacing(recent)
        self._see_plan(recent, sure)
        self._see_sag(between(recent, before, np.inf))

    def _tell(self, wave: Rippling, recent: Trajectory) -> None:
        """Put a wave into words that was found in the last rows."""
        before, self.told = self.told, wave
        if wave.ripples:
            first = float(recent["drilled_length"][0])
            self.began = _beginning(self.began, wave.since, first + wave.wavelength)
            if wave.ellipse is not None:
                wound = self.wound if _kind(wave)[1] is _kind(before)[1] else None
                self.wound = _beginning(wound, wave.ellipse.since, first + 2 * wave.wavelength)
            what = "growing" if wave.state is State.GROWING else "rippling"
            self.ripple = f"{what} since {self._place(self.began)}: {self._waves(wave)}"
            return
        if self.began is not None:
            self.ended, self.past = (self.began, before), f"; rippling from {self._place(self.began)}"
            self.began = None
        if self.ended is not None and (end := _end(recent, *self.ended)) is not None:
            self.ended, self.past = None, f"{self.past} to {self._place(end)}"
        now = {
            State.NONE: "no ripple" if self.past else SO_FAR,
            State.DYING: f"dying out: {_plain_waves(wave)}",
            State.STEERED: f"{_plain_waves(wave)}, but force or weight change too often to tell",
        }
        self.ripple = now[wave.state] + self.past

    def _waves(self, wave: Rippling) -> str:
        """The waves of a ripple in words; in space with their shape, and where a spiral began to wind."""
        ellipse = wave.ellipse
        if ellipse is None or ellipse.shape in (Shape.PLANE, Shape.UNCLEAR):
            return _plain_waves(wave) + (SHAPES[ellipse.shape] if ellipse else "")
        winding = f"{SHAPES[ellipse.shape].removeprefix(', ')} since {self._place(self.wound)}"
        size = rounded(wave.amplitude, UNITS["rad"])
        return f"{winding}, pitch {_long(wave)}, {_radius(ellipse)}, ±{size}"

    def _place(self, length: float) -> str:
        """A drilled length, m, in words."""
        return UNITS["m"].text(self.origin + length, ".0f")

    def _see_spacing(self, recent: Trajectory) -> None:
        """Look how far apart some rows are, and put it into words if they hide short waves."""
        hidden, _ = visible_waves(recent["drilled_length"])
        if hidden <= SHORT_WAVE * self.every / EVERY:
            self.hidden, self.unseen = 0.0, ""
        elif abs(hidden - self.hidden) > NOTICEABLE * self.hidden:
            self.hidden = hidden
            self.unseen = f"; waves under {rounded(hidden, UNITS['m'])} would not show between these rows"

    def _see_plan(self, recent: Trajectory, sure: bool = False) -> None:
        """Look how far the last of some rows is off the plan, and put it into words if that has changed noticeably."""
        distance = float(recent["distance_from_plan"][-1]) if "distance_from_plan" in recent else np.nan
        if np.isnan(distance):
            self.plan = ""
        elif sure or not self.plan or abs(distance - self.off_plan) > max(NEAR, NOTICEABLE * abs(self.off_plan)):
            self.off_plan = distance
            self.plan = f"; {_beside_plan(recent)}" if abs(distance) > NEAR / 2 else "; on the plan"

    def _see_sag(self, recent: Trajectory) -> None:
        """Look whether the axis of the BHA leaves the hole in some rows, where the model does not hold."""
        if "beyond_wall" not in recent or not recent.row_count:
            return
        row = int(recent["beyond_wall"].argmax())
        beyond, at = float(recent["beyond_wall"][row]), UNITS["m"].text(recent["beyond_wall_at"][row])
        if beyond <= 0.0:
            self.beyond, self.sag = 0.0, ""
        elif not self.sag or abs(beyond - self.beyond) > NOTICEABLE * self.beyond:
            self.beyond = beyond
            by = rounded(beyond, SMALL_LENGTH)
            self.sag = f"; {at} behind the bit the axis of the BHA leaves the hole, by {by}: the model does not hold"


def _beside_plan(rows: Trajectory) -> str:
    """How far the hole is off its plan at the last of some rows, in words."""
    distance = float(rows["distance_from_plan"][-1])
    if "distance_from_plan_high" not in rows:
        return f"{beside(distance, '.1f')} of the plan"
    off = f"{UNITS['m'].text(distance, '.1f')} off the plan"
    high, right = (float(rows[f"distance_from_plan_{side}"][-1]) for side in ("high", "right"))
    if np.isnan(high):  # which a vertical plan does not have
        return off
    return f"{off}, {beside(high, '.1f')}, {beside(right, '.1f', ('right', 'left'))}"


def _kind(wave: Rippling) -> Kind:
    """What kind of wave it is; the shape is that of a ripple in space."""
    return wave.state, wave.ellipse.shape if wave.ripples and wave.ellipse else None


def _beginning(before: float | None, found: float, known: float) -> float:
    """Where something began, m: as found, unless that is where the rows begin, before the length `known`, m."""
    return found if before is None or found > known else before


def _plain_waves(wave: Rippling) -> str:
    """The length of waves, and how far the direction and the axis of the hole swing in them."""
    return (
        f"waves of {_long(wave)}, ±{rounded(wave.amplitude, UNITS['rad'])}, "
        f"±{rounded(wave.axis_amplitude, SMALL_LENGTH)}"
    )


def _long(wave: Rippling) -> str:
    return rounded(wave.wavelength, UNITS["m"], digits=3)


def _radius(ellipse: Ellipse) -> str:
    """The radius of a hole that winds, or the semi-axes of its ellipse if that is not round."""
    major = rounded(ellipse.major, SMALL_LENGTH)
    if ellipse.minor > ROUND * ellipse.major:
        return f"radius {major}"
    return f"±{major} by ±{rounded(ellipse.minor, SMALL_LENGTH)}"


def _end(recent: Trajectory, began: float, ripple: Rippling) -> float | None:
    """Where a ripple that is over fell to half its size, m; None if it has not yet."""
    rows = between(recent, began + 2 * ripple.wavelength, np.inf)
    length = rows["drilled_length"]
    if not len(length):
        return None
    least = ripple.amplitude / 2 / 2**0.5  # as a root mean square
    direction = direction_of(rows) if is_in_space(rows) else rows["borehole_inclination"]
    end = large_until(length, direction, ripple.wavelength, least)
    return end if end < length[-1] else None


def _changed(wave: Rippling, told: Rippling) -> bool:
    """Whether the amplitude of a wave is noticeably another than was told of it; without a wave it is nan."""
    if wave.state is State.DYING:
        return wave.amplitude < FADED * told.amplitude
    return abs(wave.amplitude - told.amplitude) > NOTICEABLE * told.amplitude


def rounded(value: float, unit: Unit, digits: int = 2) -> str:
    """A value with some digits in the unit in which it is shown, and the unit."""
    return f"{float(f'{unit.factor * value:.{digits}g}'):.15g} {unit.shown}"

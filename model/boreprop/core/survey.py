"""The existing hole."""

from bisect import bisect_left
from dataclasses import dataclass
from math import acos, atan2, cos, hypot, sin

from .checks import check_increasing, check_part, checked_float, take_fields
from .errors import ParameterError
from .problems import CONSTRAINTS

NO_TURN = 1e-9  # rad: directions that differ by less are the same
ROUNDING = 1e-6  # m: depths that differ by less are equal, but for a conversion from feet


@dataclass(frozen=True)
class Survey:
    """The existing hole: inclination at measured depths, linear in between, straight above the first station.

    Parameters
    ----------
    measured_depth
        Stations along the hole, m, increasing, at least one. The last one is the bit at the start of the run.
    inclination
        Inclination at each station, rad, within ±π.
    azimuth
        Azimuth at each station, rad, from north over east, which says where the vertical plane of the inclination is;
        empty: the hole lies in one plane. Between stations the hole then turns along the great circle.

    Raises
    ------
    ParameterError
        If a value is no finite number, an inclination is beyond ±π or an azimuth beyond ±2π, the depths do not
        increase, or the counts differ.
    """

    measured_depth: tuple[float, ...]
    inclination: tuple[float, ...]
    azimuth: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        take_fields("survey", self)
        if not self.measured_depth:
            raise ParameterError("measured_depth", CONSTRAINTS["no station"][0], self.measured_depth)
        check_increasing("measured_depth", self.measured_depth)
        if len(self.inclination) != len(self.measured_depth):
            raise ParameterError(
                "inclination",
                f"must hold one value per measured_depth, {len(self.measured_depth)} in all",
                self.inclination,
            )
        if len(self.azimuth) not in (0, len(self.measured_depth)):
            constraint = f"must hold one value per measured_depth, {len(self.measured_depth)} in all"
            raise ParameterError("azimuth", constraint, self.azimuth)
        check_part("survey", self)

    @property
    def turns(self) -> bool:
        """Whether the hole leaves its vertical plane: its azimuth is not the same wherever it is inclined."""
        inclined = zip(self.azimuth, self.inclination, strict=False)
        return len({azimuth for azimuth, inclination in inclined if inclination != 0.0}) > 1

    def with_bit_at(self, bit_depth: float) -> "Survey":
        """The existing hole where the bit is at a given depth: this survey, cut there or extended straight to there.

        Parameters
        ----------
        bit_depth
            Measured depth of the bit, m. Before the last station the inclination is interpolated there, and what lies
            beyond is left out. Beyond it the inclination is that of the last station.

        Returns
        -------
        Survey
            A survey whose last station is the bit.

        Raises
        ------
        ParameterError
            If the bit is not finite or lies before the first station.

        Examples
        --------
        >>> from boreprop import Survey
        >>> survey = Survey((100.0, 200.0), (0.0, 0.1))
        >>> survey.with_bit_at(150.0)
        Survey(measured_depth=(100.0, 150.0), inclination=(0.0, 0.05), azimuth=())
        >>> survey.with_bit_at(230.0)
        Survey(measured_depth=(100.0, 200.0, 230.0), inclination=(0.0, 0.1, 0.1), azimuth=())
        """
        bit, depths, inclinations = checked_float("bit_depth", bit_depth), self.measured_depth, self.inclination
        if bit < depths[0] - ROUNDING:
            constraint = f"must be >= {depths[0]:.9g}, the first station of the survey"
            raise ParameterError("bit_depth", constraint, bit_depth)
        before = bisect_left(depths, bit - ROUNDING)  # how many stations lie before the bit
        share = 1.0
        if 0 < before < len(depths):
            share = min((bit - depths[before - 1]) / (depths[before] - depths[before - 1]), 1.0)
        around = inclinations[max(before - 1, 0)], inclinations[min(before, len(depths) - 1)]
        at_bit = (1.0 - share) * around[0] + share * around[1]
        if self.azimuth:
            return self._in_space_with_bit_at(bit, before, share)
        return Survey((*depths[:before], bit), (*inclinations[:before], at_bit))

    def _in_space_with_bit_at(self, bit: float, before: int, share: float) -> "Survey":
        """The same in space, with the bit at a share of the way from station `before` − 1 to `before`."""
        last = len(self.azimuth) - 1
        a, b = max(before - 1, 0), min(before, last)
        at_bit = between((self.inclination[a], self.azimuth[a]), (self.inclination[b], self.azimuth[b]), share)
        inclination, azimuth = (
            (*column[:before], at) for column, at in zip((self.inclination, self.azimuth), at_bit, strict=True)
        )
        return Survey((*self.measured_depth[:before], bit), inclination, azimuth)


Angles = tuple[float, float]  # inclination and azimuth


def direction(inclination: float, azimuth: float) -> tuple[float, float, float]:
    """North, east and down of a direction."""
    return sin(inclination) * cos(azimuth), sin(inclination) * sin(azimuth), cos(inclination)


def between(start: Angles, end: Angles, share: float) -> Angles:
    """The direction at a share of the way from one to another along the great circle."""
    if share == 1.0:
        return end
    a, b = direction(*start), direction(*end)
    turn = acos(max(min(sum(p * q for p, q in zip(a, b, strict=True)), 1.0), -1.0))
    if sin(turn) < NO_TURN:
        return start
    of_a, of_b = sin((1.0 - share) * turn) / sin(turn), sin(share * turn) / sin(turn)
    north, east, down = (of_a * p + of_b * q for p, q in zip(a, b, strict=True))
    sideways = hypot(north, east)
    return atan2(sideways, down), atan2(east, north) if sideways > NO_TURN else end[1]

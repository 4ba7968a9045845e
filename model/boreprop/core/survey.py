"""The existing hole."""

from bisect import bisect_left
from dataclasses import dataclass

from .checks import check_increasing, check_part, checked_float
from .errors import ParameterError
from .problems import CONSTRAINTS

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

    Raises
    ------
    ParameterError
        If a value is not finite, an inclination is beyond ±π, the depths do not increase, or the counts differ.
    """

    measured_depth: tuple[float, ...]
    inclination: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.measured_depth:
            raise ParameterError("measured_depth", CONSTRAINTS["no station"][0], self.measured_depth)
        check_increasing("measured_depth", self.measured_depth)
        if len(self.inclination) != len(self.measured_depth):
            raise ParameterError(
                "inclination",
                f"must hold one value per measured_depth, {len(self.measured_depth)} in all",
                self.inclination,
            )
        check_part("survey", self)

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
        Survey(measured_depth=(100.0, 150.0), inclination=(0.0, 0.05))
        >>> survey.with_bit_at(230.0)
        Survey(measured_depth=(100.0, 200.0, 230.0), inclination=(0.0, 0.1, 0.1))
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
        return Survey((*depths[:before], bit), (*inclinations[:before], at_bit))

"""The existing hole."""

from dataclasses import dataclass

from .checks import check_increasing, check_part
from .errors import ParameterError
from .problems import CONSTRAINTS


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

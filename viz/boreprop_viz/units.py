"""The units in which the pictures show quantities. The one table of units of the viewer."""

from dataclasses import dataclass
from math import pi

from boreprop.units import BUILD_LENGTH


@dataclass(frozen=True)
class Unit:
    """How values of one SI unit are shown.

    Parameters
    ----------
    shown
        The unit to show values in.
    factor
        How many of that unit the SI unit is.
    digits
        Format of a number in that unit.
    """

    shown: str
    factor: float = 1.0
    digits: str = ".4g"

    def number(self, value: float, digits: str = "") -> str:
        """An SI value as a number of the shown unit, in this format or the usual one."""
        return f"{self.factor * value:{digits or self.digits}}"

    def text(self, value: float, digits: str = "") -> str:
        """The same with the unit."""
        return f"{self.number(value, digits)} {self.shown}"


UNITS = {  # SI unit, as the table of quantities spells it
    "N": Unit("kN", 1e-3, ".1f"),
    "m/s": Unit("m/h", 3600.0, ".1f"),
    "rad": Unit("°", 180 / pi, ".2f"),
    "rad/m": Unit(f"°/{BUILD_LENGTH:g} m", BUILD_LENGTH * 180 / pi, "+.2f"),
}

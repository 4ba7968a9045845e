"""For each SI unit: its base units, and the unit and number format in which people read it.

A quantity is in SI units everywhere else. Whatever is shown to people is converted and formatted here.
"""

from dataclasses import dataclass
from math import pi

BUILD_LENGTH = 30.0  # m: build rates are given in degrees per 30 m


@dataclass(frozen=True)
class Unit:
    """How values of one SI unit are shown.

    Parameters
    ----------
    base
        The SI unit as a product of base units: base unit → exponent.
    shown
        The unit in which values are shown.
    factor
        The value in the shown unit is this factor times the SI value.
    digits
        Format specification of a value in the shown unit.
    ascii
        The shown unit as FMI spells it; empty if it is the SI unit itself.
    """

    base: dict[str, int]
    shown: str
    factor: float = 1.0
    digits: str = ".4g"
    ascii: str = ""

    def number(self, value: float, digits: str = "") -> str:
        """An SI value converted to the shown unit, formatted with `digits` or, if that is empty, as usual."""
        return f"{self.factor * value:{digits or self.digits}}"

    def text(self, value: float, digits: str = "") -> str:
        """The text of `number`, followed by the unit."""
        return f"{self.number(value, digits)} {self.shown}".rstrip()

    def heading(self, what: str) -> str:
        """What values are of, followed by the unit in brackets."""
        return f"{what} ({self.shown})" if self.shown else what


UNITS = {  # SI unit, as the table of quantities spells it
    "": Unit({}, ""),
    "m": Unit({"m": 1}, "m", digits=".1f"),
    "N": Unit({"kg": 1, "m": 1, "s": -2}, "kN", 1e-3, ".1f", ascii="kN"),
    "N/m": Unit({"kg": 1, "s": -2}, "N/m"),
    "N.m": Unit({"kg": 1, "m": 2, "s": -2}, "kN·m", 1e-3, ".1f", ascii="kN.m"),
    "N.m2": Unit({"kg": 1, "m": 3, "s": -2}, "kN·m²", 1e-3, ascii="kN.m2"),
    "m/s": Unit({"m": 1, "s": -1}, "m/h", 3600.0, ".1f", ascii="m/h"),
    "rad": Unit({"rad": 1}, "°", 180 / pi, ".2f", ascii="deg"),
    "rad/m": Unit(
        {"rad": 1, "m": -1}, f"°/{BUILD_LENGTH:g} m", BUILD_LENGTH * 180 / pi, "+.2f", ascii=f"deg/{BUILD_LENGTH:g}m"
    ),
}
SMALL_LENGTH = Unit({"m": 1}, "mm", 1e3, ".3g")  # for clearances and for the ripple of the hole axis

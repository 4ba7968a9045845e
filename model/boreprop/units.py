"""For each SI unit: its base units, and the unit and number format in which people read it.

A quantity is in SI units everywhere else. Whatever is shown to people is converted and formatted here, and whatever
they write with a unit, such as "6 3/4 in", is read here.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import inf, pi
from unicodedata import normalize

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
    "kg/m3": Unit({"kg": 1, "m": -3}, "kg/m³"),
    "N.m2": Unit({"kg": 1, "m": 3, "s": -2}, "kN·m²", 1e-3, ascii="kN.m2"),
    "m/s": Unit({"m": 1, "s": -1}, "m/h", 3600.0, ".1f", ascii="m/h"),
    "rad": Unit({"rad": 1}, "°", 180 / pi, ".2f", ascii="deg"),
    "rad/m": Unit(
        {"rad": 1, "m": -1}, f"°/{BUILD_LENGTH:g} m", BUILD_LENGTH * 180 / pi, "+.2f", ascii=f"deg/{BUILD_LENGTH:g}m"
    ),
}
SMALL_LENGTH = Unit({"m": 1}, "mm", 1e3, ".3g")  # for clearances and for the ripple of the hole axis

INCH, FOOT, POUND_FORCE = 0.0254, 0.3048, 4.4482216152605  # m, m, N; exact
POUND, GALLON = 0.45359237, 231 * INCH**3  # kg, m³ of a US gallon; exact
STANDARD_GRAVITY = 9.80665  # m/s²

FIELD_UNITS = {  # SI unit → how it is shown in field units, where that is not as in `UNITS`
    "m": Unit({"m": 1}, "ft", 1 / FOOT, ".1f"),
    "N": Unit({"kg": 1, "m": 1, "s": -2}, "klbf", 1e-3 / POUND_FORCE, ".2f"),
    "rad/m": Unit({"rad": 1, "m": -1}, "°/100 ft", 100 * FOOT * 180 / pi, "+.2f"),
}
FIELD_SMALL_LENGTH = Unit({"m": 1}, "in", 1 / INCH, ".3g")


@contextmanager
def field_units() -> Iterator[None]:
    """While this is entered, `UNITS` are those of the field: ft, klbf, °/100 ft."""
    usual = dict(UNITS)
    UNITS.update(FIELD_UNITS)
    try:
        yield
    finally:
        UNITS.update(usual)


def small_length() -> Unit:
    """The unit in which small lengths are shown: `SMALL_LENGTH`, or its like in field units."""
    return FIELD_SMALL_LENGTH if UNITS["m"] is FIELD_UNITS["m"] else SMALL_LENGTH


WRITTEN: tuple[dict[str, float], ...] = (  # a dictionary a dimension: unit, in lower case → its SI value
    {
        "m": 1.0,
        "mm": 1e-3,
        "cm": 1e-2,
        "km": 1e3,
        **dict.fromkeys(("in", "inch", "inches", '"'), INCH),
        **dict.fromkeys(("ft", "foot", "feet", "'"), FOOT),
    },
    {
        "n": 1.0,
        "kn": 1e3,
        "dan": 10.0,
        **dict.fromkeys(("t", "tf"), 1e3 * STANDARD_GRAVITY),
        **dict.fromkeys(("lbf", "lb", "lbs"), POUND_FORCE),
        **dict.fromkeys(("klbf", "klb", "klbs", "kip", "kips"), 1e3 * POUND_FORCE),
    },
    {
        "kg/m3": 1.0,
        **dict.fromkeys(("sg", "g/cm3", "g/cc", "kg/l"), 1e3),
        **dict.fromkeys(("ppg", "lb/gal", "lbm/gal"), POUND / GALLON),
        **dict.fromkeys(("pcf", "lb/ft3", "lbm/ft3"), POUND / FOOT**3),
    },
    {"°": pi / 180, "deg": pi / 180, "rad": 1.0},
    {"": 1.0, "%": 1e-2},
)
_AMOUNT = re.compile(
    r"""(?P<sign>[+-]?) \s*
        (?: (?: (?P<whole>\d{1,9}) [\s-]+ )? (?P<above>\d{1,9}) \s*/\s* (?P<below>\d{1,9})  # 6 3/4, 6-3/4, 1/32
          | (?P<decimal> (?: \d+\.?\d* | \.\d+ ) (?: e[+-]?\d+ )? ) )
        \s* (?P<unit> [^\d\s.,;+-]\S* )?""",
    re.VERBOSE,
)
_VULGAR_FRACTION = re.compile("[¼-¾⅐-⅞]")
_ALIKE = str.maketrans("⁄−“”’″′", '/-""\'"\'')


def read_amounts(text: str, unit: str) -> tuple[float, ...]:
    """Amounts that people write, such as "8.5 in", "6 3/4 in" or "12, 41 ft", converted to `unit`.

    Parameters
    ----------
    text
        Numbers, each with or without a unit, between commas or semicolons. A fraction may follow a whole number. A
        number without a unit takes that of the number behind it; if no number has one, all are in `unit`.
    unit
        One of `WRITTEN`, in upper or lower case; superscripts may be plain digits.

    Raises
    ------
    ValueError
        If the text is anything else, a unit is none of the dimension of `unit`, the last number alone lacks its unit,
        or a number is not finite.

    Examples
    --------
    >>> from boreprop.units import read_amounts
    >>> read_amounts("6 3/4 in", "in")
    (6.75,)
    >>> read_amounts("10, 20 ft", "m")
    (3.048, 6.096)
    """
    known = next(units for units in WRITTEN if _plain(unit) in units)
    parts = [_AMOUNT.fullmatch(part.strip()) for part in re.split("[,;]", _plain(text))]
    behind = (parts[-1]["unit"] if parts[-1] else None) or ""
    if not behind and not any(part and part["unit"] for part in parts):
        behind = _plain(unit)
    amounts: list[float] = []
    for part in reversed(parts):
        behind = (part["unit"] if part else None) or behind
        if part is None or behind not in known or int(part["below"] or 1) == 0:
            raise ValueError(text)
        if part["decimal"]:
            size = float(part["decimal"])
        else:
            size = int(part["whole"] or 0) + int(part["above"]) / int(part["below"])
        amount = size * known[behind] / known[_plain(unit)]
        if amount == inf:
            raise ValueError(text)
        amounts.insert(0, -amount if part["sign"] == "-" else amount)
    return tuple(amounts)


def _plain(text: str) -> str:
    """`text` in lower case, with plain digits, signs and marks of inches and feet."""
    text = _VULGAR_FRACTION.sub(lambda found: f" {normalize('NFKC', found[0])}", text.strip())
    return normalize("NFKC", text.translate(_ALIKE)).lower().translate(_ALIKE)

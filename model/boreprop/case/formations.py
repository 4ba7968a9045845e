"""What the bit meets: formations, [[formation]] in a case file, and its wear, [bit.wear]."""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import degrees, radians
from pathlib import Path
from typing import Any

from ..core.checks import check_number, check_quantity, take_fields
from ..core.errors import ParameterError
from ..core.ground import Wear
from ..core.quantities import BY_NAME, ROCK
from ..errors import InputError, shown

DEPTHS = ("measured_depth", "true_vertical_depth")
KEYS = {BY_NAME[name].key.partition(".")[2]: name for name in ROCK}
"""The keys of a formation besides its depth → the inputs that they give."""


ATTRIBUTES = {name: BY_NAME[name].attribute for name in ROCK}


@dataclass(frozen=True)
class Formation:
    """What bit and rock are like from a depth on; what is None stays as it is above.

    Parameters
    ----------
    measured_depth
        Where it begins along the hole, m; None with a true vertical depth.
    lateral_steering_resistance, angular_steering_resistance, tilt_limit
        As of a `BitRock`.
    true_vertical_depth
        Where it begins, m, in place of the measured depth: the bit is in it wherever it is at or below this depth.

    Raises
    ------
    ParameterError
        If a value is out of range, none of the three is given, or not just one of the depths.
    """

    measured_depth: float | None
    lateral_steering_resistance: float | None = None
    angular_steering_resistance: float | None = None
    tilt_limit: float | None = None
    true_vertical_depth: float | None = None

    def __post_init__(self) -> None:
        take_fields("bit", self)
        given = [name for name in DEPTHS if getattr(self, name) is not None]
        if len(given) != 1:
            raise ParameterError(DEPTHS[0], f"must be given, or {DEPTHS[1]}, and not both", None)
        check_number(given[0], self.depth)
        if not self.values:
            raise ParameterError("lateral_steering_resistance", f"must be given, or another of {', '.join(KEYS)}", None)
        for name, value in self.values.items():
            check_quantity(name, value)

    @property
    def depth(self) -> float:
        """Where it begins, m, by whichever depth is given."""
        depth = self.true_vertical_depth if self.measured_depth is None else self.measured_depth
        assert depth is not None
        return depth

    @cached_property
    def values(self) -> dict[str, float]:
        """The inputs that it gives, by name."""
        given = {name: getattr(self, attribute) for name, attribute in ATTRIBUTES.items()}
        return {name: value for name, value in given.items() if value is not None}

    def without(self, name: str) -> "Formation | None":
        """The same without one of the inputs; None if it gives no other."""
        if name not in self.values:
            return self
        if len(self.values) == 1:
            return None
        nothing: dict[str, Any] = {ATTRIBUTES[name]: None}
        return replace(self, **nothing)


def lift_formations(document: dict[str, Any], source: Path) -> tuple[Formation, ...]:
    """Take the tables [[formation]] out of the document that a case file is.

    Raises
    ------
    InputError
        If one lacks its depth, has an unknown key, or a value that is no number or out of range.
    """
    tables = document.pop("formation", [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"{source}: formation: must be tables [[formation]], got {shown(tables)}")
    return tuple(_formation(table, f"{source}: formation[{k}]") for k, table in enumerate(tables, 1))


def _formation(table: dict[str, Any], where: str) -> Formation:
    _check_table(table, (*DEPTHS, *KEYS), where)
    depths = {key: float(table[key]) for key in DEPTHS if key in table}
    if len(depths) != 1:
        constraint = f"must be given, or {DEPTHS[1]}, and not both"
        raise InputError(f"{where}.{DEPTHS[0]}: {constraint}, got {shown(depths) if depths else 'nothing'}")
    values = {
        ATTRIBUTES[name]: radians(table[key]) if key.endswith("_deg") else float(table[key])
        for key, name in KEYS.items()
        if key in table
    }
    try:
        return Formation(**{DEPTHS[0]: None} | depths | values)
    except ParameterError as error:
        key = next((key for key, name in KEYS.items() if name == error.name), error.name)
        constraint = "must be > 0, <= 90" if key.endswith("_deg") else error.constraint
        raise InputError(f"{where}.{key}: {constraint}, got {shown(table.get(key))}") from error


def _check_table(table: dict[str, Any], keys: tuple[str, ...], where: str) -> None:
    for key, value in table.items():
        if key not in keys:
            raise InputError(f"{where}.{key}: must be one of {', '.join(keys)}, got {shown(value)}")
        if type(value) not in (int, float):
            raise InputError(f"{where}.{key}: must be a number, got {shown(value)}")


def lift_wear(document: dict[str, Any], source: Path) -> Wear | None:
    """Take the table [bit.wear] out of the document that a case file is; None if there is none.

    Raises
    ------
    InputError
        If it lacks a key, has an unknown one, or a value that is no number or out of range.
    """
    bit = document.get("bit")
    table = bit.pop("wear", None) if isinstance(bit, dict) else None
    where, keys = f"{source}: bit.wear", tuple(field.name for field in fields(Wear))
    if table is None:
        return None
    if not isinstance(table, dict):
        raise InputError(f"{where}: must be a table with {' and '.join(keys)}, got {shown(table)}")
    _check_table(table, keys, where)
    for key in keys:
        if key not in table:
            raise InputError(f"{where}.{key}: must be given, got nothing")
    try:
        return Wear(**{key: float(value) for key, value in table.items()})
    except ParameterError as error:
        raise InputError(f"{where}.{error.name}: {error.constraint}, got {shown(error.value)}") from error


def formations_in_file(formations: tuple[Formation, ...]) -> list[dict[str, float]]:
    """The tables [[formation]] of a case file."""
    return [
        {name: depth for name in DEPTHS if (depth := getattr(formation, name)) is not None}
        | {
            key: file_degrees(formation.values[name]) if key.endswith("_deg") else formation.values[name]
            for key, name in KEYS.items()
            if name in formation.values
        }
        for formation in formations
    ]


def file_degrees(angle: float) -> float:
    """An angle, rad, in degrees that read back as the same angle, short if they can be."""
    short = round(degrees(angle), 10)
    return short if radians(short) == angle else degrees(angle)

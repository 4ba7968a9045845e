"""Formations, [[formation]] in a case file: what bit and rock are like from a depth on."""

from dataclasses import dataclass, replace
from math import degrees, radians
from pathlib import Path
from typing import Any

from ..core.checks import check_number, check_quantity
from ..core.errors import ParameterError
from ..core.quantities import BY_NAME, ROCK
from ..errors import InputError, shown

DEPTH = "measured_depth"
KEYS = {BY_NAME[name].key.partition(".")[2]: name for name in ROCK}
"""The keys of a formation besides its depth → the inputs that they give."""


@dataclass(frozen=True)
class Formation:
    """What bit and rock are like from a measured depth on; what is None stays as it is above.

    Parameters
    ----------
    measured_depth
        Where it begins, m.
    lateral_steering_resistance, angular_steering_resistance, tilt_limit
        As of a `BitRock`.

    Raises
    ------
    ParameterError
        If a value is out of range, or none of the three is given.
    """

    measured_depth: float
    lateral_steering_resistance: float | None = None
    angular_steering_resistance: float | None = None
    tilt_limit: float | None = None

    def __post_init__(self) -> None:
        check_number(DEPTH, self.measured_depth)
        if not self.values:
            raise ParameterError("lateral_steering_resistance", f"must be given, or another of {', '.join(KEYS)}", None)
        for name, value in self.values.items():
            check_quantity(name, value)

    @property
    def values(self) -> dict[str, float]:
        """The inputs that it gives, by name."""
        given = {name: getattr(self, BY_NAME[name].attribute) for name in ROCK}
        return {name: value for name, value in given.items() if value is not None}

    def without(self, name: str) -> "Formation | None":
        """The same without one of the inputs; None if it gives no other."""
        if name not in self.values:
            return self
        if len(self.values) == 1:
            return None
        nothing: dict[str, Any] = {BY_NAME[name].attribute: None}
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
    for key, value in table.items():
        if key != DEPTH and key not in KEYS:
            raise InputError(f"{where}.{key}: must be one of {', '.join((DEPTH, *KEYS))}, got {shown(value)}")
        if type(value) not in (int, float):
            raise InputError(f"{where}.{key}: must be a number, got {shown(value)}")
    if DEPTH not in table:
        raise InputError(f"{where}.{DEPTH}: must be given, got nothing")
    values = {KEYS[key]: radians(v) if key.endswith("_deg") else float(v) for key, v in table.items() if key != DEPTH}
    try:
        return Formation(float(table[DEPTH]), **{BY_NAME[name].attribute: value for name, value in values.items()})
    except ParameterError as error:
        key = next((key for key, name in KEYS.items() if name == error.name), error.name)
        constraint = "must be > 0, <= 90" if key.endswith("_deg") else error.constraint
        raise InputError(f"{where}.{key}: {constraint}, got {shown(table.get(key))}") from error


def formations_in_file(formations: tuple[Formation, ...]) -> list[dict[str, float]]:
    """The tables [[formation]] of a case file."""
    return [
        {DEPTH: formation.measured_depth}
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

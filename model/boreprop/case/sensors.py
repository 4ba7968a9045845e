"""The sensors of a BHA in a case file, [[sensor]], and how much room the body has at them."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate
from pathlib import Path
from typing import Any

from ..core.system import BottomHoleAssembly
from ..errors import InputError, shown

KEYS = ("position", "interval", "bias_deg", "noise_deg", "seed", "body_clearance")
CLOSE = 1e-9  # m: a sensor this close to the end of a section is at it


def lift_sensors(document: dict[str, Any], source: Path) -> None:
    """Put columns "sensor" in the place of the tables [[sensor]] of the document that a case file is.

    Raises
    ------
    InputError
        If one lacks its position, has an unknown key, a value that is no number, or noise without an interval.
    """
    if "sensor" not in document:
        return
    tables = document["sensor"]
    if not isinstance(tables, list) or not tables or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"{source}: sensor: must be tables [[sensor]], got {shown(tables)}")
    rows = [_row(table, f"{source}: sensor[{k}]") for k, table in enumerate(tables, 1)]
    document["sensor"] = {key: [row[key] for row in rows] for key in KEYS}


def _row(table: dict[str, Any], where: str) -> dict[str, Any]:
    for key, value in table.items():
        if key not in KEYS:
            raise InputError(f"{where}.{key}: must be one of {', '.join(KEYS)}, got {shown(value)}")
        if type(value) is not int and (type(value) is not float or key == "seed"):
            kind = "whole number" if key == "seed" else "number"
            raise InputError(f"{where}.{key}: must be a {kind}, got {shown(value)}")
    if "position" not in table:
        raise InputError(f"{where}.position: must be given, got nothing")
    if table.get("noise_deg") and not table.get("interval"):
        constraint = "must be given with noise_deg, the drilled length from reading to reading"
        raise InputError(f"{where}.interval: {constraint}, got {shown(table.get('interval', 'nothing'))}")
    return {key: table.get(key, 0 if key == "seed" else 0.0) for key in KEYS}


def sensors_in_file(columns: dict[str, list[Any]]) -> list[dict[str, Any]]:
    """The tables [[sensor]] of columns; what is 0, but the position, is left out."""
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    return [{key: value for key, value in row.items() if key == "position" or value} for row in rows]


def with_clearances(bha: BottomHoleAssembly, hole_diameter: float) -> BottomHoleAssembly:
    """The same BHA, with the clearance of its body at each sensor that has none, in a hole of a diameter, m."""
    if all(bha.sensor_body_clearances):
        return bha
    clearances = (
        clearance or max(hole_diameter - _diameter(bha, position), 0.0) / 2
        for position, clearance in zip(bha.sensor_positions, bha.sensor_body_clearances, strict=True)
    )
    return replace(bha, sensor_body_clearances=tuple(clearances))


def _diameter(bha: BottomHoleAssembly, position: float) -> float:
    """The outer diameter there, at a step that of the larger side, m; 0 if it is not known."""
    ends: Sequence[float] = (0.0, *accumulate(bha.section_lengths))
    around = [
        diameter
        for start, end, diameter in zip(ends, ends[1:], bha.section_outer_diameters, strict=False)
        if start - CLOSE <= position <= end + CLOSE
    ]
    return max(around, default=0.0)

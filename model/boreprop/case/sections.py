"""The sections of a beam in a case file, [[bha.section]]."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import InputError, shown
from .collar import STEEL_DENSITY, buoyant_weight, flexural_stiffness

BY_SHAPE = {"outer_diameter", "inner_diameter"}
BY_NUMBERS = {"flexural_stiffness", "distributed_weight"}
KEYS = {"length", "density", *BY_SHAPE, *BY_NUMBERS}
OF_UNIFORM_BEAM = ("flexural_stiffness", "distributed_weight")  # keys of [bha] that the section at the bit gives


def lift_sections(document: dict[str, Any], source: Path) -> None:
    """Put columns "section" in the place of the tables [[bha.section]] of a document, if it has any.

    Parameters
    ----------
    document
        The document that a case file is. It gets a table "section" of columns length, outer_diameter (0 where it is not
        given), flexural_stiffness and distributed_weight, and [bha] the numbers of the section at the bit.
    source
        The case file.

    Raises
    ------
    InputError
        If a section lacks a key, or has an unknown one, one that another gives already, or a diameter that cannot be.
    """
    bha = document.get("bha")
    if not isinstance(bha, dict) or "section" not in bha:
        return
    sections = bha.pop("section")
    if not isinstance(sections, list) or not sections or not all(isinstance(one, dict) for one in sections):
        raise InputError(f"{source}: bha.section: must be tables [[bha.section]], got {shown(sections)}")
    for key in OF_UNIFORM_BEAM:
        if key in bha:
            raise InputError(f"{source}: bha.{key}: must be left out beside [[bha.section]], got {shown(bha[key])}")
    rows = [_row(section, bha, f"{source}: bha.section[{k}]") for k, section in enumerate(sections, 1)]
    document["section"] = {key: [row[key] for row in rows] for key in rows[0]}
    bha |= {key: rows[0][key] for key in OF_UNIFORM_BEAM}


def _row(section: Mapping[str, Any], bha: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Length, outer diameter, stiffness and weight of a section."""
    for key in section:
        if key not in KEYS:
            raise InputError(f"{where}.{key}: must be one of {', '.join(sorted(KEYS))}, got {shown(section[key])}")
    given = set(section) - {"length", "density"}
    if "length" not in section:
        raise InputError(f"{where}.length: must be given, got nothing")
    if BY_NUMBERS <= given and "inner_diameter" not in given and "density" not in section:
        return {"length": section["length"], "outer_diameter": section.get("outer_diameter", 0.0)} | {
            key: section[key] for key in OF_UNIFORM_BEAM
        }
    if given != BY_SHAPE:
        constraint = "must hold outer_diameter and inner_diameter, or flexural_stiffness and distributed_weight"
        raise InputError(f"{where}: {constraint}, got {', '.join(sorted(given)) or 'neither'}")
    outer, inner = (_number(section[key], f"{where}.{key}") for key in ("outer_diameter", "inner_diameter"))
    if not 0 <= inner < outer:
        raise InputError(f"{where}.inner_diameter: must be >= 0 and < outer_diameter = {outer:g}, got {inner:g}")
    if "mud_density" not in bha:
        raise InputError(f"{where}: must have bha.mud_density beside it (kg/m³; 0 in air), got nothing")
    mud = _number(bha["mud_density"], f"{where.partition(': bha')[0]}: bha.mud_density")
    density = _number(section.get("density", STEEL_DENSITY), f"{where}.density")
    return {
        "length": section["length"],
        "outer_diameter": outer,
        "flexural_stiffness": flexural_stiffness(outer, inner),
        "distributed_weight": buoyant_weight(outer, inner, mud, density),
    }


def _number(value: Any, where: str) -> float:
    if type(value) in (int, float):
        return float(value)
    raise InputError(f"{where}: must be a number, got {shown(value)}")


def sections_in_file(columns: dict[str, list[Any]]) -> list[dict[str, Any]]:
    """The tables [[bha.section]] of columns; an outer diameter of 0 is left out."""
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    return [{key: value for key, value in row.items() if key != "outer_diameter" or value} for row in rows]

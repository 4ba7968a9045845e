"""The parts of the pages that are made from the code, as Markdown: tables of quantities, and the commands.

A page has a line ``<!-- made: variables output -->`` where the text belongs; see `sphinx_parts`.
"""

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import degrees
from typing import Any

import typer
from typer.cli import get_docs_for_click

import boreprop.cli.app
import boreprop_fmu.cli
import boreprop_viz.cli
from boreprop.case.messages import TABLES
from boreprop.cli.lazy import load_command
from boreprop.core.quantities import QUANTITIES, Quantity

PROGRAMS: dict[str, Any] = {
    "boreprop": boreprop.cli.app,
    "boreprop-fmu": boreprop_fmu.cli,
    "boreprop-view": boreprop_viz.cli,
}
NUMBERS = {"n": "[1…n]", "n-1": "[1…n−1]", "sections": "[1…]", "points": "[1…]", "sensors": "[1…]"}
NUMBERS |= {"space n-1": "[1…n−1]", "space sensors": "[1…]"}
ONLY = dict.fromkeys(("sections", "stepped"), "only with sections")
ONLY |= dict.fromkeys(("points", "body"), "only with body_contact") | {"axial": "only with axial_load"}
ONLY |= {"sensors": "only with [[sensor]]", "space sensors": "only with [[sensor]], in space"}
ONLY["space body"] = "only with body_contact, in space"


def variables(role: str) -> str:
    """The table of all quantities with a role: "input", "output" or "parameter"."""
    head = ["name", "unit", "symbol", "equation", "what it is", "type", "accepted"]
    return _table(
        head,
        (
            [f"`{q.name}{NUMBERS.get(q.size, '')}`", _unit(q), q.symbol, q.equation, _meaning(q), q.kind, q.range]
            for q in QUANTITIES
            if q.role == role
        ),
    )


def case_keys() -> str:
    """The table of all keys of a case file, with the units that they have there."""
    head = ["key", "unit", "symbol", "what it is", "accepted"]
    chosen = [_as_in_files(quantity) for quantity in QUANTITIES if quantity.key]
    keys = sorted(chosen, key=lambda quantity: (*TABLES, "sensor").index(quantity.key.partition(".")[0]))
    return _table(head, ([f"`{q.key}`", _unit(q), q.symbol, q.meaning, q.range] for q in keys))


def commands(program: str) -> str:
    """A section for each command of a program, as its own help has it."""
    return "\n".join(_sections(program))


def _sections(program: str) -> Iterator[str]:
    module = PROGRAMS[program]
    for name in getattr(module, "COMMANDS", [""]):  # boreprop-view has no commands below it
        command = load_command(name, module.COMMANDS) if name else typer.main.get_command(module.app)
        call = f"{program} {name}".rstrip()
        text = get_docs_for_click(obj=command, ctx=typer.Context(command, info_name=call), name=call)
        yield re.sub(r"^# `(.+)`$", r"### \1", text, count=1, flags=re.MULTILINE)


def _unit(quantity: Quantity) -> str:
    """Its unit as people write it: FMI writes N.m2 for N·m²."""
    return quantity.unit.replace(".", "·").replace("m2", "m²")


def _meaning(quantity: Quantity) -> str:
    """What it is, and of which drilling systems only."""
    only = ONLY.get(quantity.size)
    return f"{quantity.meaning} ({only})" if only else quantity.meaning


def _as_in_files(quantity: Quantity) -> Quantity:
    """A quantity as case files have it: sections are below [bha] there, and angles in degrees."""
    quantity = replace(quantity, key=re.sub(r"^section\.", "bha.section.", quantity.key))
    if not quantity.key.endswith("_deg"):
        return quantity
    above, at_least, at_most = map(degrees, (quantity.above, quantity.at_least, quantity.at_most))
    return replace(quantity, unit="°", above=above, at_least=at_least, at_most=at_most)


def _table(head: list[str], lines: Iterable[list[str]]) -> str:
    cells = [[cell.replace("|", r"\|").replace("*", r"\*") for cell in line] for line in (head, *lines)]
    cells.insert(1, ["---"] * len(head))
    return "\n".join(f"| {' | '.join(line)} |" for line in cells)

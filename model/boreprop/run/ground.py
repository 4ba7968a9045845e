"""What the case of a run says of each of its rows: bit and rock there, clearances, and how blunt the bit is."""

from collections.abc import Mapping

import numpy as np

from ..arrays import Floats
from ..case.case import Case
from ..core.quantities import CLEARANCES, ROCK, values_of
from .course import course_of

STEADY = ("rss_force", "active_weight_on_bit", *ROCK, *CLEARANCES)
"""The columns that are constant while a wave sustains itself."""

CLOSE = 1e-9  # m: a row this little before a change is on it, and has the values after it


def rock_in_layers(case: Case, formation: Floats) -> dict[str, Floats]:
    """The rock of rows in these formations by true vertical depth, by name: what is not the same in all of them."""
    ground, columns = case.ground, dict[str, Floats]()
    assert ground is not None
    own, layer = values_of("bit", ground.bit), formation.astype(np.intp)
    rocks = np.array(ground.numbers[-len(ground.rock) * len(ROCK) :]).reshape(-1, len(ROCK))
    for name, values in zip(ROCK, rocks.T, strict=True):
        rock = np.where(values == 0.0, own[name], values)
        if (rock != rock[0]).any():
            columns[name] = rock[layer]
    return columns


def on_rows(case: Case, run: Mapping[str, Floats], name: str) -> Floats:
    """One of η, χ, ψ* or a clearance at each row of a run, (rows,), by its scalar name.

    It is the column of that name where the run has one; else what the case says of the drilled length, and of the depth
    for formations by true vertical depth. Where the rows have no depth, formations are taken for what is at the start.
    """
    if name in run:
        return run[name]
    length = run["drilled_length"]
    if case.in_layers and name in ROCK and case.ground is not None:
        number = run.get("formation")
        if number is None and "true_vertical_depth" in run:
            tops = np.array(case.ground.tops)
            number = np.searchsorted(tops, run["true_vertical_depth"] + CLOSE, side="right").astype(float)
        if number is not None:
            rock = rock_in_layers(case, number)
            if name in rock:
                return rock[name]
    course = course_of(case)
    if name not in course.names:
        return np.full(len(length), (values_of("bha", case.bha) | values_of("bit", case.bit))[name])
    piece = (np.searchsorted(course.starts, length + CLOSE, side="right") - 1).astype(np.intc)
    return course.column(name, length, piece)


def blunt_weight(case: Case, length: Floats) -> Floats:
    """The weight G that the flats of the worn bit bear at drilled lengths, N."""
    if case.wear is None:
        return np.zeros(len(length))
    return np.minimum(case.wear.weight_per_metre * length, case.wear.largest_weight)


def largest_along(case: Case, name: str) -> float:
    """The largest value that one of η, χ, ψ* has anywhere along a case."""
    scheduled = dict(case.inputs.inputs).get(name, ()) if case.inputs else ()
    in_formations = [formation.values[name] for formation in case.formations if name in formation.values]
    return max([values_of("bit", case.bit)[name], *scheduled, *in_formations])

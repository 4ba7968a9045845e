"""BHAs as they are built, for the tests: the references of tests/reference_bha, and random ones."""

import json
from collections.abc import Iterator
from dataclasses import replace
from itertools import accumulate
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.core.errors import ParameterError
from boreprop.core.system import BottomHoleAssembly
from boreprop.kernel.binding import lie

FOLDER = Path(__file__).parent / "reference_bha"
CASES: dict[str, dict[str, Any]] = json.loads((FOLDER / "cases.json").read_text(encoding="utf-8"))["cases"]


def reference_bha(name: str) -> BottomHoleAssembly:
    """The BHA of a reference trajectory."""
    case = CASES[name]
    lengths, stiffnesses, weights, diameters = map(tuple, zip(*case["sections"], strict=True))
    ends = list(accumulate(lengths))
    body = [diameters[int(np.searchsorted(ends, s - 1e-9))] for s in case["body_points"]]
    return BottomHoleAssembly(
        tuple(case["stabilizers"]),
        tuple(case["clearances"]),
        case["rss"],
        weights[0],
        stiffnesses[0],
        section_lengths=lengths,
        section_distributed_weights=weights,
        section_flexural_stiffnesses=stiffnesses,
        section_outer_diameters=diameters,
        body_point_positions=tuple(case["body_points"]),
        body_point_clearances=tuple((case["hole_diameter"] - diameter) / 2 for diameter in body),
        end_deflection=case["end_offset"],
        axial_load=case["axial"],
    )


def with_points(bha: BottomHoleAssembly, points: list[float], clearance: float) -> BottomHoleAssembly:
    """The same with points of the body in one section."""
    return replace(
        bha,
        section_lengths=(bha.stabilizer_positions[-1],),
        section_distributed_weights=(bha.distributed_weight,),
        section_flexural_stiffnesses=(bha.flexural_stiffness,),
        section_outer_diameters=(0.0,),
        body_point_positions=tuple(points),
        body_point_clearances=(clearance,) * len(points),
    )


def bearable(bha: BottomHoleAssembly, inclination: float) -> float:
    """The weight on bit under which a BHA buckles, N."""
    supports = len(bha.stabilizer_positions) + len(bha.body_point_positions)
    try:
        lie(bha, np.zeros((1, supports)), np.zeros(1), np.zeros(1), weight_on_bit=1e15, inclination=inclination)
    except ParameterError as error:
        return error.problem.limit if error.problem else 0.0
    raise AssertionError("nothing bears so much")


def in_sections(case: Case, lengths: tuple[float, ...], stiffnesses: tuple[float, ...]) -> Case:
    """The case with a beam in sections of these stiffnesses."""
    count = len(lengths)
    bha = replace(
        case.bha,
        section_lengths=lengths,
        section_flexural_stiffnesses=stiffnesses,
        section_distributed_weights=(case.bha.distributed_weight,) * count,
        section_outer_diameters=(0.0,) * count,
    )
    return replace(case, bha=bha)


def rows(name: str) -> Iterator[dict[str, float]]:
    """The rows of a reference trajectory."""
    table = np.genfromtxt(FOLDER / f"{name}.csv", delimiter=",", names=True, deletechars="")
    for row in table:
        yield dict(zip(table.dtype.names or (), map(float, row), strict=True))


@st.composite
def built(draw: st.DrawFn, *, axial: bool = False, points: int = 0) -> BottomHoleAssembly:
    """Up to four stabilizers on one to four sections, with as many points on the body as asked for."""
    spans = draw(st.lists(st.floats(0.5, 20.0), min_size=1, max_size=4))
    stabilizers = tuple(accumulate(spans))
    reach = stabilizers[-1]
    count = draw(st.integers(1, 4))
    shares = np.array(draw(st.lists(st.floats(0.2, 1.0), min_size=count, max_size=count)))
    lengths = tuple((shares / shares.sum() * reach * 1.001).tolist())
    stiffnesses = tuple(draw(st.lists(st.floats(2e6, 5e7), min_size=count, max_size=count)))
    weights = tuple(draw(st.lists(st.floats(300.0, 3000.0), min_size=count, max_size=count)))
    places = tuple((reach * (np.arange(points) + 0.5) / points).tolist())
    return BottomHoleAssembly(
        stabilizers,
        tuple(draw(st.lists(st.floats(0.0, 5e-3), min_size=len(spans) - 1, max_size=len(spans) - 1))),
        draw(st.floats(0.1, 1.0)) * min(stabilizers[0], 3.0),
        weights[0],
        stiffnesses[0],
        section_lengths=lengths,
        section_distributed_weights=weights,
        section_flexural_stiffnesses=stiffnesses,
        section_outer_diameters=(0.0,) * count,
        body_point_positions=places,
        body_point_clearances=(draw(st.floats(5e-3, 5e-2)),) * points,
        axial_load=axial,
    )

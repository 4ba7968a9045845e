"""What a body that may touch the wall, but does not, costs a run: CPU time over that without it, interleaved.

python benchmarks/body.py
"""

from dataclasses import replace

import numpy as np
from ground import EXAMPLES, compare

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.run.simulate import simulate

LENGTH, POINTS = 1500.0, 20  # m
CLEARANCE, NEAR = 0.1, 0.01  # m: of points far from the wall; how near others come to it


def with_body(case: Case, clearance: float) -> Case:
    """The case with points along its BHA that have a clearance, m."""
    first, *_, last = case.bha.stabilizer_positions
    positions = tuple(np.linspace(0.35 * first, last - 0.3, POINTS).tolist())
    return replace(
        case,
        bha=replace(case.bha, body_point_positions=positions, body_point_clearances=POINTS * (clearance,)),
    )


def distance(case: Case) -> float:
    """How near the body comes to the wall, m; it must not touch."""
    run = simulate(case)
    if run["body_contact_force"].any() or not run["wall_distance"].all():
        raise AssertionError("the body must not touch the wall, got a force on it")
    return float(run["wall_distance"].min())


def beside(title: str, case: Case) -> None:
    """Print what points cost a case."""
    far = with_body(case, CLEARANCE)
    near = with_body(case, CLEARANCE - distance(far) + NEAR)
    compare(
        title, case, {f"{POINTS} points to {1e3 * distance(each):.0f} mm from the wall": each for each in (far, near)}
    )


def main() -> None:
    """Print the ratios."""
    for name in ("paper_case", "build_section"):
        case = replace(load_case(EXAMPLES / f"{name}.toml"), length=LENGTH)
        beside(name, case)
        beside(f"{name} in space", replace(case, dimensions=3))


if __name__ == "__main__":
    main()

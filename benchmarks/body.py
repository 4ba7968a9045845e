"""What a body that may touch the wall, but does not, costs a run: CPU time over that without it, interleaved.

python benchmarks/body.py
"""

from dataclasses import replace
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.run.simulate import SAMPLE_INTERVAL, simulate

EXAMPLES = Path(__file__).parents[1] / "examples"
LENGTH, POINTS, ROUNDS = 1500.0, 20, 15  # m
INTERVALS = (1.0, SAMPLE_INTERVAL)  # m
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


def seconds(case: Case, interval: float) -> float:
    """CPU time of a run with rows at an interval, m, in s."""
    begin = process_time()
    simulate(case, sample_interval=interval, engine="native")
    return process_time() - begin


def compare(case: Case, title: str) -> None:
    """Print what points cost a case."""
    far = with_body(case, CLEARANCE)
    near = with_body(case, CLEARANCE - distance(far) + NEAR)
    cases = {f"{1e3 * distance(each):.0f} mm": each for each in (far, near)}
    for interval in INTERVALS:
        ratios: dict[str, list[float]] = {label: [] for label in cases}
        for _ in range(ROUNDS):
            alone = seconds(case, interval)
            for label, each in cases.items():
                ratios[label].append(seconds(each, interval) / alone)
        print(f"{title}, rows of {interval:g} m, {case.length:g} m, {1e3 * alone:.1f} ms of CPU without a body")
        for label, some in ratios.items():
            print(f"    {POINTS} points that come to {label} from the wall: {median(some):.2f} times that")


def main() -> None:
    """Print the ratios."""
    for name in ("paper_case", "build_section"):
        case = replace(load_case(EXAMPLES / f"{name}.toml"), length=LENGTH)
        compare(case, name)
        compare(replace(case, dimensions=3), f"{name} in space")


if __name__ == "__main__":
    main()

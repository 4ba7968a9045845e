"""What layers, wear and clearances cost a run: CPU time over that without them, interleaved.

python benchmarks/ground.py
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.formations import Formation
from boreprop.case.inputs import InputSchedule
from boreprop.core.ground import Wear
from boreprop.run.simulate import SAMPLE_INTERVAL, simulate

EXAMPLES = Path(__file__).parents[1] / "examples"
LENGTH, LAYERS, ROUNDS = 3000.0, 1000, 15
INTERVALS = (1.0, SAMPLE_INTERVAL)  # m
SHARES = (0.7, 1.0, 1.4)  # of its own η that the rock has from layer to layer


def layered(case: Case) -> Case:
    """The case in layers that it meets one after the other, along its own way without them."""
    run = simulate(case, sample_interval=1.0)
    depth, eta = run["true_vertical_depth"], case.bit.lateral_steering_resistance
    tops = np.linspace(0.0, float(depth[np.argmax(np.abs(depth))]), LAYERS + 1)[1:]
    shares = np.random.default_rng(1).choice(SHARES, LAYERS)
    layers = [
        Formation(None, eta * share, true_vertical_depth=top) for top, share in zip(np.sort(tops), shares, strict=True)
    ]
    return replace(case, formations=tuple(layers))


def opening(case: Case) -> Case:
    """The case with a clearance that opens a hundred times."""
    clearances = np.linspace(1.0, 2.0, 101) * case.bha.stabilizer_clearances[0]
    inputs = InputSchedule(tuple(np.linspace(0.0, 2900.0, 101)), (("stabilizer_clearance[1]", tuple(clearances)),))
    return replace(case, inputs=inputs)


def seconds(case: Case, interval: float) -> float:
    """CPU time of a run with rows at an interval, m, in s."""
    begin = process_time()
    simulate(case, sample_interval=interval, engine="native")
    return process_time() - begin


def compare(title: str, case: Case, others: dict[str, Case]) -> None:
    """Print how many times the CPU time of a case others take, medians by label, with rows at each interval."""
    for interval in INTERVALS:
        ratios: dict[str, list[float]] = {label: [] for label in others}
        for _ in range(ROUNDS):
            alone = seconds(case, interval)
            for label, other in others.items():
                ratios[label].append(seconds(other, interval) / alone)
        print(
            f"{title}, rows of {interval:g} m, {case.length:g} m, {1e3 * alone:.1f} ms of CPU without anything of this"
        )
        for label, some in ratios.items():
            print(f"    {label}: {median(some):.2f} times that")


def main() -> None:
    """Print the ratios."""
    changed: dict[str, Callable[[Case], Case]] = {
        f"{LAYERS} layers": layered,
        "wear": lambda case: replace(case, wear=Wear(case.active_weight_on_bit / 1e4, case.active_weight_on_bit / 4)),
        "a clearance that opens 100 times": opening,
    }
    for name in ("paper_case", "build_section"):
        case = replace(load_case(EXAMPLES / f"{name}.toml"), length=LENGTH)
        compare(name, case, {label: change(case) for label, change in changed.items()})


if __name__ == "__main__":
    main()

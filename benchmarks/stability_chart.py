"""The stability chart of the paper's case beside eigenvalues of a pseudospectral matrix, in one run.

    python benchmarks/stability_chart.py

The chart has 300 × 200 points in four modes. The matrix has the fewest Chebyshev nodes of a ladder whose verdicts are
those of the chart next to the boundaries and at random points of all four, but for points with a root so near to the
imaginary axis that the matrix cannot tell; its time is taken at random points. A matrix that finds as many unstable
roots as there are takes more nodes: the second comparison.
"""

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.ndimage import maximum_filter, minimum_filter

from boreprop.analysis.stability.chart import (
    DRIFT,
    OSCILLATORY,
    STABLE,
    Chart,
    Panel,
    respaced,
    stability_chart,
    usual_grid,
)
from boreprop.analysis.stability.roots import rightmost_roots
from boreprop.case.paper import paper_case
from boreprop.core.system import eta_pi, scale

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from pseudospectral import LinearMode

ROUNDS = 5
SAMPLE = 100  # points of each mode
NODES = (12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768)
ON_THE_AXIS = 1e-6
CASE = paper_case()

Point = tuple[int, int]
Judge = Callable[[np.ndarray], int]


def verdict(roots: np.ndarray) -> int:
    """The code of the verdict on roots."""
    unstable = roots[roots.real > ON_THE_AXIS]
    if (abs(unstable.imag) > ON_THE_AXIS).any():
        return OSCILLATORY
    return DRIFT if len(unstable) else STABLE


def unstable(roots: np.ndarray) -> int:
    """How many roots are unstable."""
    return int((roots.real > ON_THE_AXIS).sum())


def chart() -> Chart:
    """Ours."""
    bha, bit = CASE.bha, CASE.bit
    return stability_chart(CASE, *usual_grid(bha, eta_pi(bha, bit, CASE.active_weight_on_bit)), inclination=0.0)


def eigenvalues(made: Chart, panel: Panel, point: Point, nodes: int) -> np.ndarray:
    """Of the matrix at a point of a panel."""
    moved = scale(respaced(CASE.bha, float(made.lambda2[point[0]])), CASE.bit)
    mode = LinearMode.of(moved, (len(panel.contact),), panel.saturated, made.inclination)
    return mode.roots(float(made.eta_pi[point[1]]), nodes)


def all_roots(made: Chart, panel: Panel, point: Point) -> np.ndarray:
    """Every root right of −0.1, or the next."""
    upper = np.array(rightmost_roots(panel.characteristics[point[0]], float(made.eta_pi[point[1]]), -0.1))
    return np.concatenate([upper, upper[upper.imag > 0].conj()])


def points(choice: np.ndarray) -> list[Point]:
    """The points that are chosen."""
    return [(int(i), int(j)) for i, j in np.argwhere(choice)]


def fewest_nodes(made: Chart, panel: Panel, judge: Judge, rng: np.random.Generator) -> int:
    """On which the matrix and the roots are judged alike in one panel."""
    codes = panel.verdicts
    near = maximum_filter(codes, 3) != minimum_filter(codes, 3)
    left = points(near) + points(rng.random(codes.shape) < SAMPLE / codes.size)
    expected = {point: all_roots(made, panel, point) for point in left}
    left = [point for point in left if abs(expected[point].real).min() > ON_THE_AXIS]
    assert all(verdict(expected[point]) == codes[point] for point in left)
    for nodes in NODES:
        left = [point for point in left if judge(eigenvalues(made, panel, point, nodes)) != judge(expected[point])]
        if not left:
            return nodes
    raise AssertionError(f"{len(left)} points are judged otherwise")


def seconds(function: Callable[[], object]) -> float:
    """CPU time of one call."""
    begin = process_time()
    function()
    return process_time() - begin


def main() -> None:
    """Print a table."""
    table = Table("", "nodes", "µs per point", "ours is faster by", title=f"{ROUNDS} rounds")
    made, rng = chart(), np.random.default_rng(1)
    size = sum(panel.verdicts.size for panel in made.panels)
    anywhere = points(rng.random(made.panels[0].verdicts.shape) < SAMPLE * len(made.panels) / size)
    ladder = {
        name: max(fewest_nodes(made, panel, judge, rng) for panel in made.panels)
        for name, judge in (("equal verdicts", verdict), ("equal numbers of unstable roots", unstable))
    }

    def theirs(nodes: int) -> None:
        for panel in made.panels:
            for point in anywhere:
                eigenvalues(made, panel, point, nodes)

    looked_at = len(anywhere) * len(made.panels)
    for name, nodes in ladder.items():
        pairs = [(seconds(chart) / size, seconds(partial(theirs, nodes)) / looked_at) for _ in range(ROUNDS)]
        mine, other = (1e6 * median(times) for times in zip(*pairs, strict=True))
        ratio = median(b / a for a, b in pairs)
        table.add_row(f"chart, {size} points", "", f"{mine:.2f} ({1e-6 * mine * size:.2f} s)", "")
        table.add_row(f"eigenvalues, {name}", str(nodes), f"{other:.0f}", f"{ratio:.0f}")
    Console(width=120).print(table)


if __name__ == "__main__":
    main()

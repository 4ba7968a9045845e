"""The law in space beside the planar law, and beside a fixed-step RK4 that numba compiles: CPU time, interleaved.

    python benchmarks/space.py

RK4 is hard-coded for two stabilizers (rk4_space.py). Errors are those of the bit's axis, north and down, against the
reference trajectories in tests/reference_spatial. RK4 takes the coarsest of the grids that reaches our error.
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import cos, sin
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np
from rk4_space import rk4

from boreprop.core.options import RELATIVE_TOLERANCE
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.binding import NativeDrilling

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from reference.spatial import CASES, read_reference
from space_runs import SpatialCase, referred

LENGTH, PAIRS = 60.0, 9  # ℓ₁
GRIDS = [round(50 * 2 ** (k / 4)) * 10 for k in range(29)]  # steps for each ℓ₁; rows of the references are on them
TOLERANCES = (RELATIVE_TOLERANCE, 1e-8)
SPIRALS = ("spiral", "walk_spiral")


def in_space(case: SpatialCase, tolerance: float = RELATIVE_TOLERANCE) -> None:
    """Drill a case in space."""
    case.advance(case.begin(relative_tolerance=tolerance), LENGTH)


def in_the_plane(case: SpatialCase) -> None:
    """Drill it in the plane, without what is across it."""
    drilling = NativeDrilling(
        BottomHoleAssembly(case.s, case.y_star, case.Delta, case.w, 1 / 3),
        BitRock(1.0, case.epsilon, case.psi_star),
        Survey(tuple(xi - case.stations[0] for xi in case.stations), case.inclination),
        active_weight_on_bit=case.eta_pi,
    )
    drilling.advance(LENGTH, 0.0, case.eta_pi)


def our_error(name: str, tolerance: float) -> float:
    """The largest error of ours over the rows of a reference."""
    rows = read_reference(name)
    found = []
    for row in referred(name).rows(rows["xi"].tolist(), relative_tolerance=tolerance):
        inclination, azimuth = row["bit_inclination"], row["bit_azimuth"]
        found.append([sin(inclination) * cos(azimuth), cos(inclination)])
    return float(abs(np.array(found) - np.column_stack([rows["d_n"], rows["d_d"]])).max())


def rk4_error(name: str, m: int) -> float:
    """That of RK4 with m steps per ℓ₁."""
    rows = read_reference(name)
    found = rk4(CASES[name], CASES[name]["length"], m)[np.rint(rows["xi"] * m).astype(int)]
    return float(abs(found - np.column_stack([rows["d_n"], rows["d_d"]])).max())


def seconds(call: Callable[[], object]) -> float:
    """CPU time of a call."""
    begin = process_time()
    call()
    return process_time() - begin


def ratio(one: Callable[[], object], other: Callable[[], object]) -> tuple[float, float]:
    """The least CPU time of one, and how many times that of it the other takes: the median of pairs."""
    pairs = [(seconds(one), seconds(other)) for _ in range(PAIRS)]
    return min(a for a, _ in pairs), median(b / a for a, b in pairs)


def beside_rk4(name: str, tolerance: float) -> None:
    """Print how much faster ours is than RK4 with the same error."""
    case, error = referred(name), our_error(name, tolerance)
    for m in GRIDS:
        other = rk4_error(name, m)
        if other <= error:
            break
    took, times = ratio(partial(in_space, case, tolerance), partial(rk4, CASES[name], LENGTH, m))
    print(f"{name}, tolerance {tolerance:g}: error {error:.1e} in {1e3 * took:.1f} ms; ", end="")
    print(f"{times:.0f} times faster than RK4 with h = 1/{m}, error {other:.1e}")


def main() -> None:
    """Print the ratios."""
    ripple = SpatialCase()
    for name, case in {"ripple, nothing across": ripple, **{name: referred(name) for name in SPIRALS}}.items():
        planar = replace(case, inclination=ripple.inclination, stations=ripple.stations)
        took, times = ratio(partial(in_the_plane, planar), partial(in_space, case))
        print(f"{name}, {LENGTH:g} ℓ₁: {1e3 * took * times:.1f} ms, {times:.1f} times the planar law's ripple")
    for name in SPIRALS:
        for tolerance in TOLERANCES:
            beside_rk4(name, tolerance)


if __name__ == "__main__":
    main()

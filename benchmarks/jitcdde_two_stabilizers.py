"""The opponent of the native kernel: the model for two stabilizers in JiTCDDE, which compiles it to C.

    python benchmarks/jitcdde_two_stabilizers.py

prints what JiTCDDE reaches for a range of tolerances. Its method is Bogacki–Shampine 3(2) with a cubic Hermite past.
Contact and saturation are clips, written with Abs; events are left to its step control. Of about 1200 random settings
on fig7_psi_2deg, and scans around the fastest, none with an error below 1e-6 was more than a tenth faster than these:

- compiled with JiTCDDE's own flags (-O3 -ffast-math -march=native); each delayed value and each intermediate result is
  a helper and so computed once, which is four times as fast as the plain expressions;
- the past is exact: between stations the survey's Y is a parabola;
- the jump of Y' at the start is left to `adjust_diff`. `step_on_discontinuities`, its steps on ξ = 1, 2, … done by
  hand, `integrate_blindly` at first, or nothing at all: none is faster at the same error;
- JiTCDDE has one absolute tolerance for all states, so θ is weighted: it forgets an error, Y does not;
- a relative tolerance, a largest step and the thresholds of the step control gain nothing, a safety factor of 0.95
  instead of 0.9 gains a little.

Between tolerances of 2e-9 and 5e-10 the error jumps about between 2e-7 and 2e-6: now and then an event falls badly.
Coarse tolerances save less than half of the time, as stability then limits the steps.
"""

from contextlib import chdir
from itertools import pairwise
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np
from jitcdde import jitcdde, t, y
from symengine import Abs, Symbol, sin

from boreprop.core.beam import Beam
from boreprop.core.system import Scaled

TOLERANCE = 1.5e-9  # error in Y below 1e-6
WEIGHT = 0.03  # of θ; of Y: 1
SAFETY = 0.95
START = 4e-8  # of ℓ₁: over this last bit of the past Y' goes over to its new value
FIRST_STEP = 1e-4


def compiled(case: dict[str, Any]) -> Any:
    """The model of one of the reference cases with two stabilizers, as machine code; F_RSS = 0."""
    s_1, s_2 = 1.0, sum(case["lambda"])
    y_star, eta_pi = case["y_star"][0], case["eta_pi"]
    scaled = Scaled((s_1, s_2), (y_star,), case["delta"], case["w"], case["epsilon"], case["psi_star"])
    beam = Beam(scaled)
    theta, Y = y(0) / WEIGHT, y(1)
    Y_1, Y_2, gravity, e_2, q, F, F_0 = map(Symbol, ("Y_1", "Y_2", "gravity", "e_2", "q", "F", "F_0"))

    def clip(value: Any, limit: float) -> Any:
        return (Abs(value + limit) - Abs(value - limit)) / 2

    helpers = [
        (Y_1, y(1, t - s_1)),
        (Y_2, y(1, t - s_2)),
        (gravity, sin((Y - Y_1) / s_1)),
        (e_2, Y - Y_2 - s_2 * theta),
        (q, Y - Y_1 - s_1 * theta + beam.delta_e[0] * e_2 + beam.delta_g[0] * gravity),
        (F, (clip(q, y_star) - q) / beam.K_inv[0][0]),
        (F_0, beam.F0_e * e_2 + beam.F0_F[0] * F + beam.F0_g * gravity),
    ]
    M = beam.M_e * e_2 + beam.M_F[0] * F + beam.M_g * gravity
    rates = [WEIGHT * M / (case["epsilon"] * eta_pi), theta - clip(F_0 / eta_pi, case["psi_star"])]
    # nothing is forgotten, so that the error can be measured after the run; that costs no time
    max_delay = s_2 + case["length"]
    dde = jitcdde(rates, n=2, helpers=helpers, delays=[s_1, s_2], max_delay=max_delay, verbose=False)
    with TemporaryDirectory() as folder, chdir(folder):  # here setuptools would read our pyproject.toml
        dde.compile_C(simplify=False)
    return dde


def seconds(dde: Any, case: dict[str, Any], tolerance: float = TOLERANCE) -> float:
    """Time of one run; neither compiling nor laying out the past counts."""
    xi, inclination = case["survey_xi"], case["survey_inc"]
    Y = [0.0]
    for (a, inc_a), (b, inc_b) in pairwise(zip(xi, inclination, strict=True)):
        Y.append(Y[-1] + (b - a) * (inc_a + inc_b) / 2)
    dde.purge_past()
    for at, Y_at, Theta in zip(xi, Y, inclination, strict=True):
        dde.add_past_point(at, [WEIGHT * inclination[-1], Y_at - Y[-1]], [0.0, Theta])
    dde.set_integration_parameters(atol=tolerance, rtol=0.0, first_step=FIRST_STEP, safety_factor=SAFETY)
    begin = process_time()
    dde.adjust_diff(START)
    dde.integrate(case["length"])
    return process_time() - begin


def error(dde: Any, rows: np.ndarray) -> float:
    """Largest error in Y of the last run over the rows of the reference."""
    return float(np.abs(dde.get_state().get_state(rows["xi"])[:, 1] - rows["Y"]).max())


def main() -> None:
    """Print error, time and anchors (accepted steps) of the rippling case for each tolerance."""
    name = "fig7_psi_2deg"
    case, rows = CASES[name], reference(name)
    dde = compiled(case)
    for tolerance in (1e-6, 1e-7, 1e-8, 3e-9, 2e-9, 1.5e-9, 1.2e-9, 1e-9, 9e-10, 8e-10, 7e-10, 6e-10, 5e-10, 1e-10):
        least = min(seconds(dde, case, tolerance) for _ in range(5))
        anchors = len(dde.get_state())
        print(f"{name}, tolerance {tolerance:.1e}: error in Y {error(dde, rows):.1e}, {least:.4f} s, {anchors} anchors")


if __name__ == "__main__":
    import sys
    from pathlib import Path

    sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
    from reference_cases import CASES, reference

    main()

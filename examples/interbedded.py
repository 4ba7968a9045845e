"""Where a tangent through hard and soft layers drops angle, and what force holds it: tables and a picture.

python examples/interbedded.py out/interbedded.png
"""

import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from boreprop import Case, Schedule, Trajectory, load_case, simulate, steady_response

LARGEST_FORCE = 30e3  # N
PIECES = 3  # of a layer in which the force may change, since the bit becomes blunter on the way

Values = NDArray[np.float64]


def holding_force(case: Case, run: Trajectory, row: int) -> float:
    """The steering force, N, under which the hole goes straight on in the rock, and with the bit, of a row of a run."""
    eta = run["lateral_steering_resistance"][row]
    here = replace(
        case,
        bit=replace(
            case.bit,
            lateral_steering_resistance=eta,
            angular_steering_resistance=run["angular_steering_resistance"][row],
        ),
        active_weight_on_bit=run["eta_pi"][row] * case.bha.force_scale / eta,  # what wear leaves
        formations=(),
    )

    def build_rate(force: float) -> float:
        return steady_response(here, force, case.survey.inclination[-1]).build_rate

    return float(brentq(build_rate, -LARGEST_FORCE, LARGEST_FORCE, xtol=1.0))


def held(case: Case, run: Trajectory) -> Case:
    """The case with the force that holds it, from layer to layer, as the run without force has met them."""
    changes = np.flatnonzero(np.diff(run["formation"])) + 1
    ends = np.array([0, *changes, run.row_count])
    rows = np.unique(np.concatenate([np.linspace(a, b, PIECES, endpoint=False) for a, b in pairwise(ends)]).astype(int))
    middles = np.append((rows[1:] + rows[:-1]) // 2, (rows[-1] + run.row_count) // 2)
    forces = tuple(round(holding_force(case, run, row), -1) for row in middles)
    return replace(case, schedule=Schedule(tuple(run["drilled_length"][rows]), forces))


def dropped(run: Trajectory) -> dict[int, float]:
    """What each formation changes the inclination by, degrees per 30 m: number → rate."""
    inclination, number = np.degrees(run["borehole_inclination"]), run["formation"]
    rates = {}
    for one in np.unique(number):
        rows = np.flatnonzero(number == one)
        length = run["drilled_length"][rows[-1]] - run["drilled_length"][rows[0]]
        rates[int(one)] = 30.0 * (inclination[rows[-1]] - inclination[rows[0]]) / length
    return rates


def draw(case: Case, runs: dict[str, Trajectory], picture: Path) -> None:
    """Inclinations and the force over true vertical depth, hard layers shaded."""
    figure, (angles, forces) = plt.subplots(1, 2, sharey=True, figsize=(9.0, 6.0), width_ratios=(2, 1))
    tops = [formation.depth for formation in case.formations]
    worn = runs["worn bit, no force"]
    end = case.true_vertical_depth + worn["true_vertical_depth"][-1]
    for formation, bottom in zip(case.formations, (*tops[1:], end), strict=True):
        eta = formation.lateral_steering_resistance or 0.0
        for axes in (angles, forces):
            axes.axhspan(formation.depth, bottom, color="0.5", alpha=min(eta / 100.0, 1.0) * 0.7, linewidth=0)
    for label, run in runs.items():
        depth = case.true_vertical_depth + run["true_vertical_depth"]
        angles.plot(np.degrees(run["borehole_inclination"]), depth, label=label)
        forces.plot(run["rss_force"] / 1e3, depth)
    angles.set(
        xlabel="inclination of the hole, °", ylabel="true vertical depth, m", ylim=(end, case.true_vertical_depth)
    )
    forces.set(xlabel="steering force, kN")
    angles.legend(loc="upper left")
    figure.suptitle("Hard (dark) and soft (light) layers")
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


def main(picture: Path) -> None:
    """Drill, print and draw."""
    case = load_case(Path(__file__).with_name("interbedded.toml"))
    worn = simulate(case)
    runs = {
        "sharp bit, no force": simulate(replace(case, wear=None)),
        "worn bit, no force": worn,
        "worn bit, held": simulate(held(case, worn)),
    }
    print("formation  η     " + "  ".join(f"{label:>20}" for label in runs) + "   (°/30 m)")
    rates = {label: dropped(run) for label, run in runs.items()}
    for number in rates["worn bit, no force"]:
        eta = worn["lateral_steering_resistance"][np.flatnonzero(worn["formation"] == number)[0]]
        print(f"{number:9}  {eta:<4g}  " + "  ".join(f"{rate[number]:20.2f}" for rate in rates.values()))
    force = runs["worn bit, held"]["rss_force"]
    print(f"the force that holds it: {force.min():.0f} to {force.max():.0f} N")
    for label, run in runs.items():
        print(f"{label}: ends at {np.degrees(run['borehole_inclination'][-1]):.2f}°")
    draw(case, runs, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]))

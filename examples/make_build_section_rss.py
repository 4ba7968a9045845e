"""Find the steering forces of the build section: for each stand, the one that ends it on the planned inclination.

Writes build_section_rss.csv anew; the case file, which refers to it, has to find the old one.
"""

from csv import writer
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from boreprop.case.file import load_case
from boreprop.case.tables import read_survey
from boreprop.core.drilling import Drilling

HERE = Path(__file__).parent
STAND = 28.0  # m, three joints: one downlink a stand
LARGEST_FORCE = 30e3  # N
RESOLUTION = 500.0  # N


def main() -> None:
    """Design the schedule and write it."""
    case, plan = load_case(HERE / "build_section.toml"), read_survey(HERE / "build_section_plan.csv")
    weight = case.active_weight_on_bit
    drilling = Drilling(case.bha, case.bit, case.survey, active_weight_on_bit=weight)

    def drill(force: float, length: float) -> float:
        """Drill on to `length` and return how far the hole is above the plan there, rad."""
        drilling.advance(length, force, weight)
        planned = np.interp(plan.measured_depth[0] + length, plan.measured_depth, plan.inclination)
        return float(drilling.outputs()["borehole_inclination"] - planned)

    def try_out(force: float, length: float) -> float:
        """Like `drill`, but stay where we are."""
        state = drilling.save()
        miss = drill(force, length)
        drilling.restore(state)
        return miss

    schedule = []
    for start, end in pairwise([*np.arange(0.0, case.length - STAND, STAND).tolist(), case.length]):
        force = brentq(try_out, -LARGEST_FORCE, LARGEST_FORCE, args=(end,), xtol=RESOLUTION / 10)
        force = RESOLUTION * round(force / RESOLUTION)
        drill(force, end)
        schedule.append((f"{start:g}", f"{force:g}"))
    with (HERE / "build_section_rss.csv").open("w", newline="", encoding="utf-8") as file:
        writer(file, lineterminator="\n").writerows([("drilled_length", "force"), *schedule])


if __name__ == "__main__":
    main()

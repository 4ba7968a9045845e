"""Draw runs of the closed loop against the plan: ``python picture.py PICTURE.png RUN.csv …``."""

from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from matplotlib.figure import Figure

from boreprop.case.tables import read_survey
from boreprop.cli import console
from boreprop.cli.lazy import new_app
from boreprop.replacing import replacing
from boreprop.report.figures.paper import COLOURS
from boreprop.run.results import read_trajectory

PLAN = Path(__file__).parents[1] / "build_section_plan.csv"
TOLERANCE = 0.5  # deg, to be kept after the first SETTLING m
SETTLING = 60.0

app = new_app("Draw runs of the closed loop.")


@app.command()
def picture(
    output: Annotated[Path, typer.Argument(metavar="PICTURE.png", help="The picture.")],
    runs: Annotated[list[Path], typer.Argument(metavar="RUN.csv …", help="Result files of run.py, at most four.")],
) -> None:
    """Inclination, its error, force and active weight on bit over the drilled length."""
    console.check_output(output, (".png",))
    plan = read_survey(PLAN)
    figure = Figure(figsize=(9, 9), layout="constrained")
    inclination, error, force, weight = figure.subplots(4, 1, sharex=True, height_ratios=(3, 3, 2, 1.2))
    drilled = np.subtract(plan.measured_depth, plan.measured_depth[0])
    for panel in (inclination, error, force, weight):
        panel.grid(alpha=0.3)
    inclination.plot(drilled, np.degrees(plan.inclination), "k--", linewidth=1, zorder=9, label="plan")
    for path, colour, layer in zip(runs, COLOURS, range(len(runs), 0, -1), strict=False):
        run, style = read_trajectory(path), {"color": colour, "zorder": 2 + layer, "linewidth": 1.2}
        length, angle = run["drilled_length"], np.degrees(run["borehole_inclination"])
        inclination.plot(length, angle, **style, label=path.stem.replace("_", " "))
        error.plot(length, angle - np.interp(length, drilled, np.degrees(plan.inclination)), **style)
        force.step(length, run["rss_force"] / 1e3, where="pre", **style)
        weight.step(length, run["active_weight_on_bit"] / 1e3, where="pre", **style)
    for bound in (-TOLERANCE, TOLERANCE):
        error.plot([SETTLING, drilled[-1]], [bound, bound], "k:", linewidth=1)
    inclination.legend(frameon=False, loc="lower right")
    inclination.set_ylabel("borehole inclination (°)")
    error.set_ylabel("inclination − plan (°)")
    force.set_ylabel("steering force (kN)")
    weight.set_ylabel("active weight\non bit (kN)")
    weight.set_ylim(0, 70)
    weight.set_xlabel("drilled length (m)")
    weight.set_xlim(0, drilled[-1])
    with replacing(output) as draft:
        figure.savefig(draft, format="png", dpi=110)
    print(output)


if __name__ == "__main__":
    console.execute(app)

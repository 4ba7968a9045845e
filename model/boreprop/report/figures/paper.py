"""The paper's figures 6, 7 and 8."""

from collections.abc import Callable
from itertools import count
from math import degrees, radians
from pathlib import Path

from matplotlib.figure import Figure

from ...analysis.stability.chart import stability_chart, usual_grid
from ...case.case import Case
from ...case.paper import LENGTH_SCALE, paper_case
from ...core.quantities import quantity_of
from ...run.simulate import simulate
from ...run.trajectory import Trajectory
from ...units import UNITS
from . import stability as stability_figure
from .drawing import COLOURS, multiple, save

ROWS_PER_LENGTH_SCALE = 50  # about 70 rows in a wave, which make a smooth curve
COLUMNS = {
    "borehole_inclination": "borehole inclination Θ",
    "bit_inclination": "bit inclination θ",
    "stabilizer_force[1]": "contact force $F_{ℓ1} − F_{u1}$",
}


def figure_7_cases() -> dict[str, Case]:
    """Bit tilt limits ψ* = 2°, 1°, 0.5°, 0.1° at y* = 10⁻³."""
    return {f"ψ* = {limit:g}°": paper_case(tilt_limit=radians(limit)) for limit in (2.0, 1.0, 0.5, 0.1)}


def figure_8_cases() -> dict[str, Case]:
    """Clearances y* = 1, 1.5, 2 · 10⁻³ at ψ* = 2°."""
    return {f"y* = {1e3 * clearance:g} · 10⁻³": paper_case(clearance=clearance) for clearance in (1e-3, 1.5e-3, 2e-3)}


def draw(runs: dict[str, Trajectory], title: str) -> Figure:
    """Draw inclinations and contact force over the drilled length, a curve for each run."""
    figure = Figure(figsize=(10, 8), layout="constrained")
    figure.suptitle(title)
    panels = figure.subplots(3, 1, sharex=True)
    for panel, (column, label) in zip(panels, COLUMNS.items(), strict=True):
        unit = UNITS[quantity_of(column).unit]
        panel.set_ylabel(unit.heading(label))
        panel.grid(alpha=0.3)
        for (name, run), colour in zip(runs.items(), COLOURS, strict=False):
            xi = run["drilled_length"] / LENGTH_SCALE
            panel.plot(xi, unit.factor * run[column], color=colour, linewidth=1.1, label=name)
    panels[-1].set_xlabel(f"drilled length ξ (in ℓ₁ = {LENGTH_SCALE:g} m)")
    panels[-1].set_xlim(0, xi[-1])
    metres = panels[0].secondary_xaxis("top", functions=multiple(LENGTH_SCALE))
    metres.set_xlabel("drilled length (m)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(runs))
    return figure


def make_figure_6(output: Path) -> None:
    """Draw the stability chart of a vertical hole."""
    case = paper_case()
    grid = usual_grid(case.bha, case.eta_pi)
    save(stability_figure.draw(stability_chart(case, *grid, inclination=0.0), case), output)


def make_figures(output: Path, progress: Callable[[float], None] = lambda _: None) -> None:
    """Draw the paper's figures 6, 7 and 8 as ``figure_6.png`` … in `output`, the last two from simulations.

    `progress` is called with the fraction done.
    """
    turn = degrees(paper_case().survey.inclination[-1])
    setting = f"ηΠ = 0.01, no steering, ε = 0.1, existing hole vertical, {turn:g}° at its end"
    wanted = {
        "figure_7": (figure_7_cases(), f"Bit tilt limit: {setting}, y* = 10⁻³"),
        "figure_8": (figure_8_cases(), f"Stabilizer clearance: {setting}, ψ* = 2°"),
    }
    total = 1 + sum(len(cases) for cases, _ in wanted.values())
    done = count(1)
    make_figure_6(output / "figure_6.png")
    progress(next(done) / total)
    for name, (cases, title) in wanted.items():
        runs = {}
        for label, case in cases.items():
            runs[label] = simulate(case, sample_interval=LENGTH_SCALE / ROWS_PER_LENGTH_SCALE)
            progress(next(done) / total)
        save(draw(runs, title), output / f"{name}.png")

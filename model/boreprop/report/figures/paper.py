"""The paper's figures 6, 7 and 8."""

from collections.abc import Callable, Iterable, Sequence
from itertools import chain, count
from math import degrees, radians
from pathlib import Path

from matplotlib.artist import Artist
from matplotlib.axes import Axes
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
    "bit_tilt": "bit tilt ψ",
    "stabilizer_force[1]": "contact force $F_{ℓ1} − F_{u1}$",
}
ROW, MARGINS = 2.6, 1.6  # height of a row of panels, of the margins, inches


def figure_7_cases() -> dict[str, Case]:
    """Bit tilt limits ψ* = 2°, 1°, 0.5°, 0.1° at y* = 10⁻³."""
    return {f"ψ* = {limit:g}°": paper_case(tilt_limit=radians(limit)) for limit in (2.0, 1.0, 0.5, 0.1)}


def figure_8_cases() -> dict[str, Case]:
    """Clearances y* = 1, 1.5, 2 · 10⁻³ at ψ* = 2°."""
    return {f"y* = {1e3 * clearance:g} · 10⁻³": paper_case(clearance=clearance) for clearance in (1e-3, 1.5e-3, 2e-3)}


def setting() -> str:
    """What figures 7 and 8 have in common, and which part of that the paper does not print."""
    turn = degrees(paper_case().survey.inclination[-1])
    return (
        "ηΠ = 0.01, no steering. The paper does not print ε and the existing hole; chosen here: ε = 0.1, and\n"
        f"a hole that is vertical and turns to {turn:g}° over the last ℓ₁. Another hole may ripple where this does not."
    )


def draw(runs: dict[str, Trajectory], title: str, columns: Sequence[str], *, apart: bool = False) -> Figure:
    """Draw `columns`, some of `COLUMNS`, over the drilled length, a curve for each run.

    The runs share panels, the first one lowest, or have a column of panels each if they are drawn `apart`.
    """
    figure = Figure(figsize=(10, ROW * len(columns) + MARGINS), layout="constrained")
    figure.suptitle(title)
    across = len(runs) if apart else 1
    panels = figure.subplots(len(columns), across, sharex=True, sharey="row", squeeze=False)
    for row, column in zip(panels, columns, strict=True):
        unit = UNITS[quantity_of(column).unit]
        row[0].set_ylabel(unit.heading(COLUMNS[column]))
        for k, ((name, run), colour) in enumerate(zip(runs.items(), COLOURS, strict=False)):
            xi = run["drilled_length"] / LENGTH_SCALE
            row[k % across].plot(xi, unit.factor * run[column], color=colour, linewidth=1.1, label=name)
    for panel in panels.flat:
        panel.grid(alpha=0.3)
        panel.set_xlim(0, xi[-1])
    for panel in panels[0]:
        panel.secondary_xaxis("top", functions=multiple(LENGTH_SCALE)).set_xlabel("drilled length (m)")
    for panel in panels[-1]:
        panel.set_xlabel(f"drilled length ξ (in ℓ₁ = {LENGTH_SCALE:g} m)")
    figure.legend(*_curves(panels[0]), loc="outside lower center", ncols=len(runs))
    return figure


def _curves(panels: Iterable[Axes]) -> tuple[list[Artist], list[str]]:
    """The curves of all panels and their names, for a legend."""
    handles, names = zip(*(panel.get_legend_handles_labels() for panel in panels), strict=True)
    return [*chain(*handles)], [*chain(*names)]


def make_figure_6(output: Path) -> None:
    """Draw the stability chart of a vertical hole."""
    case = paper_case()
    grid = usual_grid(case.bha, case.eta_pi)
    save(stability_figure.draw(stability_chart(case, *grid, inclination=0.0), case), output)


def make_figures(output: Path, progress: Callable[[float], None] = lambda _: None) -> None:
    """Draw the paper's figures 6, 7 and 8 as ``figure_6.png`` … in `output`, the last two from simulations.

    `progress` is called with the fraction done.
    """
    wanted = {
        "figure_7": (figure_7_cases(), "Figure 7: limit ψ* of the bit tilt, at y* = 10⁻³", [*COLUMNS], False),
        "figure_8": (
            figure_8_cases(),
            "Figure 8: clearance y* of the stabilizer, at ψ* = 2°",
            ["borehole_inclination", "bit_inclination", "stabilizer_force[1]"],
            True,
        ),
    }
    total = 1 + sum(len(cases) for cases, *_ in wanted.values())
    done = count(1)
    make_figure_6(output / "figure_6.png")
    progress(next(done) / total)
    for name, (cases, title, columns, apart) in wanted.items():
        runs = {}
        for label, case in cases.items():
            runs[label] = simulate(case, sample_interval=LENGTH_SCALE / ROWS_PER_LENGTH_SCALE)
            progress(next(done) / total)
        save(draw(runs, f"{title}\n{setting()}", columns, apart=apart), output / f"{name}.png")

"""The paper's figures: the right cases, the right curves, files that are pictures."""

from math import degrees
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from matplotlib.lines import Line2D

from boreprop.case.paper import LENGTH_SCALE
from boreprop.report.figures.paper import COLUMNS, draw, figure_7_cases, figure_8_cases, make_figures, setting
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory


def test_figure_7_varies_the_tilt_limit_and_figure_8_the_clearance() -> None:
    assert [degrees(case.bit.tilt_limit) for case in figure_7_cases().values()] == pytest.approx([2.0, 1.0, 0.5, 0.1])
    clearances = [case.bha.stabilizer_clearances[0] / LENGTH_SCALE for case in figure_8_cases().values()]
    assert clearances == pytest.approx([1e-3, 1.5e-3, 2e-3])


IN_PEOPLE_S_UNITS = {
    "borehole_inclination": 180 / np.pi,
    "bit_inclination": 180 / np.pi,
    "bit_tilt": 180 / np.pi,
    "stabilizer_force[1]": 1e-3,
}


@pytest.fixture(scope="module")
def runs() -> dict[str, Trajectory]:
    """The beginnings of the runs of figure 8."""
    return {name: simulate(case, sample_interval=0.5, length=20.0) for name, case in figure_8_cases().items()}


def assert_curve(line: Line2D, run: Trajectory, column: str) -> None:
    assert line.get_ydata() == pytest.approx(IN_PEOPLE_S_UNITS[column] * run[column])
    assert line.get_xdata() == pytest.approx(run["drilled_length"] / LENGTH_SCALE)


def test_curves_are_those_of_the_runs_in_degrees_and_kilonewtons(runs: dict[str, Trajectory]) -> None:
    panels = draw(runs, "title", [*COLUMNS]).axes
    for panel, column in zip(panels, COLUMNS, strict=True):
        for run, line in zip(runs.values(), panel.lines, strict=True):
            assert_curve(line, run, column)


def test_runs_that_are_drawn_apart_hide_none_of_each_other(runs: dict[str, Trajectory]) -> None:
    panels = np.array(draw(runs, "title", [*COLUMNS], apart=True).axes, dtype=object).reshape(-1, len(runs))
    for row, column in zip(panels, COLUMNS, strict=True):
        for panel, run in zip(row, runs.values(), strict=True):
            [line] = panel.lines
            assert_curve(line, run, column)
            assert panel.get_ylim() == row[0].get_ylim()  # so that they can be compared


def test_the_figures_say_which_part_of_their_setting_is_not_the_paper_s() -> None:
    assert "does not print ε and the existing hole; chosen here: ε = 0.1" in setting()
    assert "turns to 0.5° over the last ℓ₁" in setting()


def test_the_files_are_pictures_with_something_on_them(tmp_path: Path) -> None:
    seen: list[float] = []
    make_figures(tmp_path, seen.append)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["figure_6.png", "figure_7.png", "figure_8.png"]
    for path in tmp_path.iterdir():
        assert imread(path)[..., :3].std() > 0.05
    assert seen[-1] == 1.0

"""The paper's figures: the right cases, the right curves, files that are pictures."""

from math import degrees
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from boreprop.case.paper import LENGTH_SCALE
from boreprop.report.figures.paper import draw, figure_7_cases, figure_8_cases, make_figures
from boreprop.run.simulate import simulate


def test_figure_7_varies_the_tilt_limit_and_figure_8_the_clearance() -> None:
    assert [degrees(case.bit.tilt_limit) for case in figure_7_cases().values()] == pytest.approx([2.0, 1.0, 0.5, 0.1])
    clearances = [case.bha.stabilizer_clearances[0] / LENGTH_SCALE for case in figure_8_cases().values()]
    assert clearances == pytest.approx([1e-3, 1.5e-3, 2e-3])


def test_curves_are_those_of_the_runs_in_degrees_and_kilonewtons() -> None:
    runs = {name: simulate(case, sample_interval=0.5, length=20.0) for name, case in figure_8_cases().items()}
    panels = draw(runs, "title").axes[:3]
    for run, lines in zip(runs.values(), zip(*(panel.lines for panel in panels), strict=True), strict=True):
        for line, name, factor in zip(
            lines, ("borehole_inclination", "bit_inclination", "stabilizer_force[1]"), (180 / np.pi, 180 / np.pi, 1e-3),
            strict=True,
        ):  # fmt: skip
            assert line.get_ydata() == pytest.approx(factor * run[name])
            assert line.get_xdata() == pytest.approx(run["drilled_length"] / LENGTH_SCALE)


def test_the_files_are_pictures_with_something_on_them(tmp_path: Path) -> None:
    seen: list[float] = []
    make_figures(tmp_path, seen.append)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["figure_6.png", "figure_7.png", "figure_8.png"]
    for path in tmp_path.iterdir():
        assert imread(path)[..., :3].std() > 0.05
    assert seen[-1] == 1.0

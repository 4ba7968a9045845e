"""The examples that drill in space do what their files and the gallery say of them."""

import numpy as np
import pytest

from boreprop.case.file import load_case
from boreprop.run.simulate import simulate
from places import EXAMPLES


def test_the_hole_that_is_steered_to_the_right_turns_to_the_east_and_drops() -> None:
    run = simulate(load_case(EXAMPLES / "turning.toml"), sample_interval=2.0)
    azimuth, inclination = np.degrees(run["borehole_azimuth"]), np.degrees(run["borehole_inclination"])
    assert (np.diff(azimuth[::10]) > 0.0).all()  # over 20 m, which is more than what is left of the force's setting in
    assert azimuth[-1] == pytest.approx(90.0, abs=6.0)
    assert inclination[-1] == pytest.approx(36.0, abs=1.0)


def test_the_ripple_of_a_bit_that_walks_becomes_a_spiral_of_that_size() -> None:
    run = simulate(load_case(EXAMPLES / "spiral.toml"), sample_interval=0.1)
    direction = np.tan(run["borehole_inclination"]) * np.exp(1j * run["borehole_azimuth"])
    winding = np.unwrap(np.angle(direction - direction.mean()))
    last = run["drilled_length"] > 100.0
    turns = (winding[last][-1] - winding[last][0]) / (2 * np.pi)
    assert np.ptp(run["drilled_length"][last]) / turns == pytest.approx(5.1, abs=0.05)  # > 0: to the right
    position = (run["north"] + 1j * run["east"])[last]
    line = np.polynomial.polynomial.polyfit(run["drilled_length"][last], position, 1)
    wide = 2 * np.abs(position - line[0] - line[1] * run["drilled_length"][last])
    assert np.median(wide) == pytest.approx(43e-3, abs=1e-3)
    early = np.abs(direction - direction.mean())[(run["drilled_length"] > 55.0) & ~last]
    assert np.abs(early / early.mean() - 1.0).max() < 0.15  # of a constant size from 55 m on

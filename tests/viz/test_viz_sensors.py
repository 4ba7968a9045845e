"""The curves of sensors in a recording."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz.record import record
from boreprop_viz.scales import choose_scales
from boreprop_viz.style import PLOTS
from rrd import read

SENSED = {"sensor_inclination": 180 / np.pi, "sensor_bending_moment": 1e-3, "sensor_clearance": 1e3}


def run_of(case: Case, count: int) -> Trajectory:
    positions = tuple(np.linspace(0.0, 7.0, count).tolist())
    bha = replace(case.bha, sensor_positions=positions, sensor_intervals=(2.0,) * count)
    return simulate(replace(case, bha=bha), length=20.0, sample_interval=0.5)


@pytest.mark.parametrize("runs", [1, 2])
def test_each_sensor_has_its_curves(case: Case, tmp_path: Path, runs: int) -> None:
    run, path = run_of(case, 8), tmp_path / "run.rrd"
    record({f"run {k}": run for k in range(runs)} if runs > 1 else run, save=path)
    for name, factor in SENSED.items():
        for i in (1, 8):
            entity = f"plots/{name}/{name}_{i}" if runs == 1 else f"plots/{name}/run_0/{name}_{i}"
            shown = read(path, entity, "Scalars:scalars")
            np.testing.assert_allclose(
                [shown[tick][0] for tick in sorted(shown)], factor * run[f"{name}[{i}]"], rtol=1e-4, atol=1e-3
            )


def test_without_sensors_there_are_no_plots_of_them(case: Case) -> None:
    for count in (0, 2):
        scales = choose_scales([run_of(case, count)], whole=True, section=np.zeros((1, 2)))
        assert (SENSED.keys() <= scales.ranges.keys()) == bool(count)
        assert bool(SENSED.keys() & scales.ranges.keys()) == bool(count)
    assert PLOTS.keys() >= SENSED.keys()


def test_in_space_a_sensor_has_an_azimuth(case: Case, tmp_path: Path) -> None:
    bha = replace(case.bha, sensor_positions=(2.0, 5.0))
    turned = replace(case, bha=bha, survey=replace(case.survey, azimuth=(0.5, 0.6, 0.7)))
    run, path = simulate(turned, length=6.0, sample_interval=0.5), tmp_path / "run.rrd"
    record(run, save=path)
    shown = read(path, "plots/sensor_azimuth/sensor_azimuth_2", "Scalars:scalars")
    azimuths = [shown[tick][0] for tick in sorted(shown)]
    np.testing.assert_allclose(azimuths, np.degrees(run["sensor_azimuth[2]"]), rtol=1e-4)

"""The layout that a recording brings along."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rerun.chunk import RrdReader

from boreprop.case.case import Case
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz import live
from boreprop_viz.record import record

RIPPLE = 50.0  # beyond which a range must be that of the ripple, mm


def time_panel(path: Path) -> dict[str, Any]:
    """The values that each layout in a recording gives the time panel."""
    reader = RrdReader(path)
    layout = reader.blueprints()[0]
    panel = {}
    for chunk in reader.stream(store=layout).filter(content="/time_panel"):
        batch = chunk.to_record_batch()
        for component in batch.schema.names:
            if component.startswith("TimePanelBlueprint:"):
                [panel[component.partition(":")[2]]] = batch.column(component).to_pylist()[-1]
    return panel


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    return tmp_path / "run.rrd"


def with_time(run: Trajectory, rate: float) -> Trajectory:
    """The run at a rate of penetration, m/s, after an hour of something else."""
    return replace(run, columns={"time": 3600.0 + run["drilled_length"] / rate} | run.columns)


@pytest.mark.parametrize("rate", [None, 0.01, 2.0])
def test_a_run_is_played_in_half_a_minute(case: Case, saved: Path, rate: float | None) -> None:
    run = simulate(replace(case, length=30.0), sample_interval=1.0)
    record(run if rate is None else with_time(run, rate), save=saved)
    panel = time_panel(saved)
    assert panel["fps"] * panel["playback_speed"] == pytest.approx(30_000.0 / 30.0)  # ticks per second
    if rate is not None:
        assert panel["playback_speed"] == pytest.approx(30.0 / rate / 30.0)  # seconds per second


def test_of_several_runs_the_longest_is(case: Case, saved: Path) -> None:
    runs = [simulate(replace(case, length=length), sample_interval=1.0) for length in (3.0, 60.0)]
    record({"short": with_time(runs[0], 1e-3), "long": with_time(runs[1], 1.0)}, save=saved)
    panel = time_panel(saved)
    assert panel["fps"] * panel["playback_speed"] == pytest.approx(2000.0)
    assert panel["playback_speed"] == pytest.approx(100.0)


@pytest.mark.parametrize("rate", [0.5, 0.0])
def test_a_live_run_is_expected_to_be_as_long_as_its_case(case: Case, saved: Path, rate: float) -> None:
    run = simulate(replace(case, length=2.0), sample_interval=1.0)
    first = dict(zip(run, np.column_stack(list(run.values()))[0].tolist(), strict=True))
    with live(replace(case, length=600.0), save=saved) as view:
        view.send(**first | {"time": 0.0, "rate_of_penetration": rate})
    panel = time_panel(saved)
    assert panel["fps"] * panel["playback_speed"] == pytest.approx(600_000.0 / 30.0)
    assert panel["playback_speed"] == pytest.approx(600.0 / (rate or 1.0) / 30.0)


def test_a_run_of_one_row_has_a_layout_too(case: Case, saved: Path) -> None:
    run = simulate(replace(case, length=1.0))
    record(Trajectory({name: column[:1] for name, column in run.items()} | {"time": np.zeros(1)}, case), save=saved)
    panel = time_panel(saved)
    assert panel["fps"] > 0.0
    assert panel["playback_speed"] > 0.0


def test_at_its_end_the_plots_of_a_live_run_have_those_ranges_of_the_stored_one(
    case: Case, saved: Path, tmp_path: Path
) -> None:
    run = simulate(replace(case, length=20.0), sample_interval=0.5)
    record(run, save=tmp_path / "stored.rrd")
    with live(run.case or case, save=saved) as view:
        for time, row in enumerate(np.column_stack(list(run.values())).tolist()):
            view.send(time=time, **dict(zip(run, row, strict=True)))
    assert len(plot_ranges(tmp_path / "stored.rrd")) >= 6
    assert plot_ranges(saved) == plot_ranges(tmp_path / "stored.rrd")


def plot_ranges(path: Path) -> set[tuple[float, float]]:
    """The ranges of all plots in the layouts, but that of the ripple, which is that of a ripple to be expected."""
    reader = RrdReader(path)
    chunks = [chunk.to_record_batch() for layout in reader.blueprints() for chunk in reader.stream(store=layout)]
    columns = [chunk.column("ScalarAxis:range") for chunk in chunks if "ScalarAxis:range" in chunk.schema.names]
    found = {tuple(span) for column in columns for [span] in column.to_pylist()}
    return {span for span in found if abs(span[0]) < RIPPLE}

"""The data of a recording, where and as the page on the viewer says."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rerun.chunk import RrdReader

from boreprop.case.case import Case
from boreprop.core.survey import Survey
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz.record import record
from places import ROOT

PAGE = (ROOT / "docs" / "viewer.md").read_text()
UNIT = re.compile(r"\(([^()]+)\)$")


@pytest.fixture(scope="module")
def run(case: Case) -> Trajectory:
    run = simulate(replace(case, length=20.0), sample_interval=0.1)
    time = 2.0 * run["drilled_length"]
    return replace(run, columns=run.columns | {"time": time, "rate_of_penetration": np.full(run.row_count, 0.5)})


@pytest.fixture(scope="module")
def recorded(run: Trajectory, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("query") / "run.rrd"
    record(run, plan=Survey((0.0, 100.0), (0.0, 0.0)), save=path)
    return path


def documented() -> dict[str, str]:
    """The paths of curves on the page, and their units."""
    rows = re.findall(r"^\| (`/plots/.*) \| .* \| (.*) \|$", PAGE, re.MULTILINE)
    return {path: unit for paths, unit in rows for path in re.findall("`(.*?)`", paths)}


def units_of(recording: Path) -> dict[str, str]:
    """The paths of curves in a recording, and the units of their series."""
    units = {}
    for chunk in RrdReader(recording).stream().filter(components="SeriesLines:names"):
        [[name]] = chunk.to_record_batch().column("SeriesLines:names").to_pylist()
        found = UNIT.search(name)
        assert found, name
        units[chunk.entity_path] = found[1]
    return units


def test_the_page_names_every_curve_with_the_unit_that_its_series_has(
    recorded: Path, case: Case, tmp_path: Path
) -> None:
    record(simulate(replace(case, length=20.0), dimensions=3), save=tmp_path / "space.rrd")
    assert units_of(recorded) | units_of(tmp_path / "space.rrd") == documented()


def test_the_query_of_the_page_gives_the_run(recorded: Path, run: Trajectory, case: Case) -> None:
    pytest.importorskip("datafusion")
    [code] = re.findall(r"```python\n(import rerun.*?)```", PAGE, re.DOTALL)
    names: dict[str, Any] = {}
    exec(code.replace("out/run.rrd", str(recorded)), names)
    table = names["table"]
    shown = np.stack(table["/plots/inclination/borehole_inclination:Scalars:scalars"].dropna())[:, 0]
    np.testing.assert_allclose(shown, np.degrees(run["borehole_inclination"]), atol=5.1e-5)
    depth = table["measured_depth_mm"].to_numpy()[-run.row_count :]
    np.testing.assert_array_equal(depth, np.rint(1000 * (case.survey.measured_depth[-1] + run["drilled_length"])))

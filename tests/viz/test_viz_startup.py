"""What the viewer's command loads: Rerun is slow enough."""

import subprocess
import sys
from pathlib import Path

import pytest

from boreprop.case.file import load_case
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate

pytest.importorskip("rerun")
pytest.importorskip("pandas")


def test_a_run_is_drawn_without_pandas_scipy_matplotlib_and_fmpy(tmp_path: Path, paper_case: Path) -> None:
    write_trajectory(simulate(load_case(paper_case), length=1.0), tmp_path / "run.csv")
    command = [sys.executable, "-X", "importtime", "-m", "boreprop_viz.cli", "run.csv", "--save", "run.rrd"]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    # pandas itself is in the list, because pyarrow asks for it; what it consists of is not
    loaded = {line.rpartition("|")[2].strip() for line in result.stderr.splitlines()}
    assert "rerun" in loaded
    assert not [name for name in loaded if name.startswith(("pandas.", "scipy", "matplotlib", "fmpy", "xarray"))]


def test_pandas_can_be_loaded_after_the_viewer() -> None:
    script = """
import sys
from boreprop_viz.without_pandas import skip_pandas_check
finders = list(sys.meta_path)
skip_pandas_check()
assert sys.meta_path == finders and "pandas" not in sys.modules
import pandas, pyarrow
assert pyarrow.table({"a": [1]}).to_pandas().equals(pandas.DataFrame({"a": [1]}))
"""
    subprocess.run([sys.executable, "-c", script], check=True)

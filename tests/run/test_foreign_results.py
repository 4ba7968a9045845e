"""Result files that other tools write: whatever stands before and behind a name, the columns of a borehole are read."""

import csv
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.core.quantities import INPUTS, OUTPUTS, scalar_names
from boreprop.errors import InputError
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from forking import run_script
from numbered_runs import columns
from places import EXAMPLES


def test_a_file_of_fmpy_is_read(tmp_path: Path) -> None:
    from fmpy.util import write_csv

    names = ["time", "rate_of_penetration", "drilled_length", "stabilizer_force[1]", "stabilizer_force[2]", "setpoint"]
    table = np.array([(0, 1, 0, 5, 6, 7), (0.1, 1, 0.1, 5.5, 6.5, 7.5)], dtype=[(name, np.float64) for name in names])
    write_csv(str(tmp_path / "fmpy.csv"), table)
    assert '"stabilizer_force[1]"' in (tmp_path / "fmpy.csv").read_text()
    run = read_trajectory(tmp_path / "fmpy.csv")
    assert set(run.columns) == {*names} - {"setpoint"}
    for name in run.columns:
        np.testing.assert_array_equal(run[name], table[name])


def in_a_process(script: str, *arguments: Path) -> None:
    """Run a Python script in a process of its own, as FMUs need; it is put beside the last of its arguments."""
    path = arguments[-1].with_suffix(".py")
    path.write_text(script, encoding="utf-8")
    done = run_script([path, *arguments], ("fmpy.simulation", "fmpy.ssp.simulation"))
    assert done.returncode == 0, done.stdout + done.stderr


def assert_is_the_simulation(run: Trajectory, case: Case, digits: int) -> None:
    """Every output there is, at 0.1 m, to that many digits."""
    expected = simulate(case, sample_interval=0.1, length=20.0)
    for name in scalar_names(OUTPUTS, expected.n):
        size = float(np.abs(expected[name]).max())
        np.testing.assert_allclose(run[name], expected[name], rtol=10.0**-digits, atol=1e-9 * size, err_msg=name)


FMPY = """
import sys
from fmpy import simulate_fmu
from fmpy.util import write_csv
write_csv(sys.argv[2], simulate_fmu(sys.argv[1], stop_time=20.0, output_interval=0.1))
"""


def test_a_run_of_our_fmu_in_fmpy_is_read(case: Case, fmu: Path, tmp_path: Path) -> None:
    in_a_process(FMPY, fmu, tmp_path / "fmpy.csv")
    run = read_trajectory(tmp_path / "fmpy.csv", case)
    assert set(run.columns) == {"time", *scalar_names(OUTPUTS, 2)}  # fmpy records outputs only
    assert_is_the_simulation(run, case, digits=12)


LIBCOSIM = """
import sys
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave
execution = CosimExecution.from_step_size(100_000_000)
execution.add_local_slave(CosimLocalSlave(fmu_path=sys.argv[1], instance_name="borehole"))
observer = CosimObserver.create_to_dir(sys.argv[2])
execution.add_observer(observer)
for _ in range(200):
    assert execution.step()
"""


def test_a_run_of_our_fmu_in_libcosim_is_read(case: Case, fmu: Path, tmp_path: Path) -> None:
    pytest.importorskip("libcosimpy")
    in_a_process(LIBCOSIM, fmu, tmp_path)
    [file] = tmp_path.glob("borehole_*.csv")
    run = read_trajectory(file, case)
    assert set(run.columns) == {"time", *scalar_names(INPUTS + OUTPUTS, 2)}
    assert_is_the_simulation(run, case, digits=5)  # its file has six, the last one rounded


FMPY_SSP = """
import sys
from types import SimpleNamespace
from fmpy.ssp.simulation import simulate_ssp
from fmpy.util import write_csv
plan = SimpleNamespace(parameters=[SimpleNamespace(name="controller.build_length", value=1.0)])  # it reads none itself
write_csv(sys.argv[2], simulate_ssp(sys.argv[1], stop_time=3.0, step_size=0.5, parameter_set=plan))
"""


def test_of_a_system_in_fmpy_the_borehole_is_read_and_not_what_also_takes_its_length(tmp_path: Path) -> None:
    ssp, file = tmp_path / "loop.ssp", tmp_path / "loop.csv"
    make = [sys.executable, str(EXAMPLES / "closed_loop" / "make_ssp.py"), str(ssp)]
    subprocess.run(make, check=True, capture_output=True, timeout=120)
    in_a_process(FMPY_SSP, ssp, file)
    assert {"borehole.drilled_length", "controller.drilled_length"} < set(
        next(csv.reader(file.read_text().splitlines()))
    )
    run = read_trajectory(file)
    assert list(run.columns) == ["time", "rss_force", "drilled_length", "sensor_inclination[1]"]
    np.testing.assert_array_equal(run["drilled_length"], run["time"] + 0.5)  # fmpy's rows have the time before the step


@pytest.mark.parametrize("quote", ["", '"'], ids=["up to 3.0", "after 3.0"])
def test_a_file_in_omsimulators_format_is_read(quote: str, tmp_path: Path) -> None:
    # as its CSVWriter writes: a space before each number but the first, %.12g, a time for each side of an event
    names = ["drilled_length", "bit_inclination", "stabilizer_force[1]", "stabilizer_contact[1]"]
    headings = ["time", "model.root.controller.rss_force", *(f"model.root.borehole.{name}" for name in names)]
    rows = [(0, 7, 0, 1 / 3, 0, 0), (0.1, 7, 0.1, 1 / 3, 0, 0), (0.1, 8, 0.1, 1 / 3, -2e4 / 3, -1)]
    lines = [",".join(f"{quote}{heading}{quote}" for heading in headings)]
    lines += [", ".join(f"{value:.12g}" for value in row) for row in rows]
    (tmp_path / "oms.csv").write_text("\n".join(lines) + "\n")
    run = read_trajectory(tmp_path / "oms.csv")
    assert list(run.columns) == ["time", *names]
    for k, name in enumerate(["time", "", *names]):
        if name:
            np.testing.assert_allclose(run[name], [row[k] for row in rows], rtol=1e-11)


paths = st.lists(st.from_regex(r"[A-Za-z_][\w $,\[\]-]{0,6}", fullmatch=True), min_size=0, max_size=3).map(".".join)


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
@given(columns=columns(), component=paths, behind=st.sampled_from(["", " [12 real output]", " [3 Integer output]"]))
@settings(max_examples=50, deadline=None)
def test_what_stands_before_and_behind_a_name_changes_nothing(
    suffix: str, columns: dict[str, np.ndarray], component: str, behind: str
) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    before = f"{component}." if component else ""
    table = {f"{before}{name}{behind}": column for name, column in columns.items()}
    table = {"other.rss_force": -columns["rss_force"], "Time": columns["drilled_length"], **table}
    with TemporaryDirectory() as directory:
        file = Path(directory) / f"run{suffix}"
        if suffix == ".csv":
            with file.open("w", newline="", encoding="utf-8") as opened:
                writer = csv.writer(opened)
                writer.writerow(table)
                writer.writerows(zip(*(column.tolist() for column in table.values()), strict=True))
        else:
            pq.write_table(pa.table(table), file)
        back = read_trajectory(file)
    assert list(back.columns) == ["time", *columns]
    for name, column in columns.items():
        np.testing.assert_array_equal(back[name], column)


@given(
    columns=columns(),
    separator=st.sampled_from([";", "\t"]),
    mark=st.sampled_from(".,"),
    encoding=st.sampled_from(["utf-8-sig", "utf-16", "cp1252"]),
)
@settings(max_examples=50, deadline=None)
def test_a_run_that_a_spreadsheet_has_saved_is_the_same_run(
    columns: dict[str, np.ndarray], separator: str, mark: str, encoding: str
) -> None:
    rows = zip(*(map(repr, column.tolist()) for column in columns.values()), strict=True)
    lines = [separator.join([*columns, "αβ °"[2 * (encoding == "cp1252") :]])]
    lines += [separator.join([*(cell.replace(".", mark) for cell in row), "°"]) for row in rows]
    lines.insert(1, separator * len(columns))
    with TemporaryDirectory() as directory:
        file = Path(directory) / "run.csv"
        file.write_bytes("\r\n".join(lines).encode(encoding))
        back = read_trajectory(file)
    assert list(back.columns) == list(columns)
    for name, column in columns.items():
        np.testing.assert_array_equal(back[name], column)


def test_a_unit_behind_a_name_is_not_skipped(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("drilled_length,bit_tilt [deg]\n0,1\n")
    assert list(read_trajectory(tmp_path / "run.csv").columns) == ["drilled_length"]


@pytest.mark.parametrize(
    "names",
    [
        ["a.drilled_length", "b.drilled_length"],
        ["a.drilled_length", "a.bit_tilt", "b.drilled_length", "b.bit_inclination"],
        ["drilled_length", "b.drilled_length"],
    ],
)
def test_two_boreholes_in_a_file_are_refused_by_name(tmp_path: Path, names: list[str]) -> None:
    file = tmp_path / "run.csv"
    file.write_text(",".join(names) + "\n" + ",".join("0" for _ in names) + "\n")
    found = ", ".join(name for name in names if "drilled_length" in name)
    with pytest.raises(InputError) as caught:
        read_trajectory(file)
    assert str(caught.value) == f"{file}: must have a single borehole with all its outputs, got several: {found}"


def test_columns_of_other_components_may_hold_anything(tmp_path: Path) -> None:
    (tmp_path / "system.csv").write_text("time,controller.mode,drilled_length\n0,hold,0\n1,,1\n")
    assert list(read_trajectory(tmp_path / "system.csv").columns) == ["time", "drilled_length"]


def test_inputs_of_an_fmu_run_are_kept(tmp_path: Path) -> None:
    names = ["time", *(variable.name for variable in INPUTS if variable.count(2)), "drilled_length"]
    (tmp_path / "run.csv").write_text(",".join(names) + "\n" + ",".join(map(str, range(len(names)))) + "\n")
    assert list(read_trajectory(tmp_path / "run.csv").columns) == names

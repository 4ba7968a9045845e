"""Result files: every number comes back, with its case, and a write that fails changes nothing."""

import csv
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from boreprop.case.case import Case
from boreprop.core.errors import TableError
from boreprop.core.quantities import BY_NAME, INPUTS, OUTPUTS, scalar_names
from boreprop.errors import InputError
from boreprop.run import results
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from places import EXAMPLES


def is_integer(scalar_name: str) -> bool:
    return BY_NAME[scalar_name.partition("[")[0]].kind == "Integer"


@pytest.fixture
def trajectory(case: Case) -> Trajectory:
    """A run of the paper's case with a number of its own in every cell."""
    columns = {name: np.arange(5) / 7 + k for k, name in enumerate(scalar_names(OUTPUTS, 2))}
    return Trajectory(
        {k: np.array([0.0, 1.0, -1.0, 0.0, 1.0]) if is_integer(k) else v for k, v in columns.items()}, case
    )


@st.composite
def columns(draw: st.DrawFn) -> dict[str, np.ndarray]:
    n, rows = draw(st.integers(1, 6)), draw(st.integers(1, 5))
    numbers = st.floats(allow_nan=False, allow_infinity=False)
    modes = st.sampled_from([-1.0, 0.0, 1.0])
    names = scalar_names((BY_NAME["rss_force"], *OUTPUTS), n)
    return {name: draw(arrays(np.float64, rows, elements=modes if is_integer(name) else numbers)) for name in names}


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
@given(columns=columns())
@settings(max_examples=50, deadline=None)
def test_every_number_comes_back(suffix: str, columns: dict[str, np.ndarray]) -> None:
    with TemporaryDirectory() as directory:
        file = Path(directory) / f"run{suffix}"
        write_trajectory(Trajectory(columns), file)
        back = read_trajectory(file)
    assert list(back.columns) == list(columns)
    assert back.case is None
    for name, column in columns.items():
        assert back[name].dtype == np.float64
        np.testing.assert_array_equal(back[name], column)


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_file_carries_its_case(trajectory: Trajectory, tmp_path: Path, suffix: str) -> None:
    write_trajectory(trajectory, tmp_path / f"run{suffix}")
    assert read_trajectory(tmp_path / f"run{suffix}").case == trajectory.case


def test_a_case_given_comes_before_the_files_own(trajectory: Trajectory, case: Case, tmp_path: Path) -> None:
    write_trajectory(trajectory, tmp_path / "run.csv")
    (tmp_path / "run.case.toml").write_text("not even TOML")
    assert read_trajectory(tmp_path / "run.csv", case).case is case
    with pytest.raises(InputError, match=r"run\.case\.toml: must be TOML"):
        read_trajectory(tmp_path / "run.csv")


def test_a_run_without_a_case_does_not_inherit_the_case_of_the_run_that_it_replaces(
    trajectory: Trajectory, tmp_path: Path
) -> None:
    write_trajectory(trajectory, tmp_path / "run.csv")
    write_trajectory(Trajectory(trajectory.columns), tmp_path / "run.csv")
    assert read_trajectory(tmp_path / "run.csv").case is None


def test_the_number_of_stabilizers_and_their_columns_in_order(trajectory: Trajectory) -> None:
    without_case = Trajectory(dict(reversed(trajectory.columns.items())))
    assert (trajectory.n, without_case.n, trajectory.row_count) == (2, 2, 5)
    inclinations = without_case.stack("average_inclination")
    np.testing.assert_array_equal(inclinations[:, 0], trajectory["average_inclination[1]"])
    np.testing.assert_array_equal(inclinations[:, 1], trajectory["average_inclination[2]"])
    assert without_case.stack("stabilizer_force").shape == (5, 1)
    one = Trajectory({"drilled_length": np.zeros(5), "average_inclination[1]": np.zeros(5)})
    assert one.stack("stabilizer_force").shape == (5, 0)


def test_a_missing_column_is_named(trajectory: Trajectory) -> None:
    with pytest.raises(InputError, match="must have a column 'stabilizer_force\\[2\\]', got drilled_length, "):
        trajectory["stabilizer_force[2]"]


def test_numpy_reads_the_csv_file(trajectory: Trajectory, tmp_path: Path) -> None:
    write_trajectory(trajectory, tmp_path / "run.csv")
    table = np.genfromtxt(tmp_path / "run.csv", names=True, delimiter=",", deletechars="")
    assert table.dtype.names == tuple(trajectory.columns)
    for name, column in trajectory.columns.items():
        np.testing.assert_array_equal(table[name], column)


def test_integers_are_written_as_integers(trajectory: Trajectory, tmp_path: Path) -> None:
    write_trajectory(trajectory, tmp_path / "run.csv")
    header, first, *_ = (tmp_path / "run.csv").read_text().splitlines()
    cells = dict(zip(header.split(","), first.split(","), strict=True))
    assert {name for name, cell in cells.items() if cell == "0"} == {"stabilizer_contact[1]", "bit_tilt_saturation"}


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
    """Run a Python script in a process of its own, as FMUs need."""
    command = [sys.executable, "-c", script, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", timeout=120)
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
from fmpy.ssp.simulation import simulate_ssp
from fmpy.util import write_csv
write_csv(sys.argv[2], simulate_ssp(sys.argv[1], stop_time=3.0, step_size=0.5))
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
    assert list(run.columns) == ["time", "rss_force", "drilled_length", "average_inclination[2]"]
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
    assert str(caught.value) == f"{file}: must have drilled_length of one borehole, got {found}"


def test_columns_of_other_components_may_hold_anything(tmp_path: Path) -> None:
    (tmp_path / "system.csv").write_text("time,controller.mode,drilled_length\n0,hold,0\n1,,1\n")
    assert list(read_trajectory(tmp_path / "system.csv").columns) == ["time", "drilled_length"]


def test_inputs_of_an_fmu_run_are_kept(tmp_path: Path) -> None:
    names = ["time", *(variable.name for variable in INPUTS), "drilled_length"]
    (tmp_path / "run.csv").write_text(",".join(names) + "\n" + ",".join("01234") + "\n")
    assert list(read_trajectory(tmp_path / "run.csv").columns) == names


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("drilled_length,bit_tilt\n0,1\n1\n", ":3: must have 2 values like the header, got 1"),
        ("drilled_length,bit_tilt\n0,1\n1,2,3\n", ":3: must have 2 values like the header, got 3"),
        ("drilled_length,bit_tilt\n0,high\n", ":2: bit_tilt: must be a finite number, got 'high'"),
        ("drilled_length,bit_tilt\n0,nan\n", ":2: bit_tilt: must be a finite number, got 'nan'"),
        ("time,bit_tilt\n0,1\n", ": must have a column 'drilled_length', got ['time', 'bit_tilt']"),
        ("drilled_length\n", ": must have at least one row, got none"),
        ("", ": must have a column 'drilled_length', got []"),
    ],
)
def test_a_wrong_csv_file_is_named_with_the_line_and_the_value(tmp_path: Path, content: str, message: str) -> None:
    file = tmp_path / "run.csv"
    file.write_text(content)
    with pytest.raises((InputError, TableError)) as caught:
        read_trajectory(file)
    assert str(caught.value) == f"{file}{message}"


def test_a_case_with_another_number_of_stabilizers_is_refused(
    trajectory: Trajectory, case: Case, tmp_path: Path
) -> None:
    columns = dict(trajectory.columns)
    del columns["average_inclination[2]"]
    write_trajectory(Trajectory(columns), tmp_path / "run.csv")
    with pytest.raises(InputError, match="average_inclination: must have 2 columns like its case, got 1"):
        read_trajectory(tmp_path / "run.csv", case)


def test_a_wrong_parquet_file_is_named(tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    file = tmp_path / "run.parquet"
    for content, message in [
        ({"time": [0.0]}, "must have a column 'drilled_length', got ['time']"),
        ({"drilled_length": ["a"]}, "drilled_length: must hold numbers, got string"),
        ({"drilled_length": [0.0, None]}, "drilled_length: row 2: must be a finite number, got nan"),
    ]:
        pq.write_table(pa.table(content), file)
        with pytest.raises(InputError) as caught:
            read_trajectory(file)
        assert str(caught.value) == f"{file}: {message}"
    file.write_bytes(b"drilled_length\n0\n")
    with pytest.raises(InputError, match=r"run\.parquet: must be a readable Parquet file, got: "):
        read_trajectory(file)


def test_a_run_is_a_mapping_from_names_to_columns(trajectory: Trajectory) -> None:
    assert isinstance(trajectory, Mapping)
    assert (list(trajectory), len(trajectory)) == (list(trajectory.columns), len(trajectory.columns))
    assert dict(trajectory.items()).keys() == dict(trajectory).keys() == trajectory.columns.keys()
    assert "drilled_length" in trajectory
    assert "depth" not in trajectory
    assert trajectory.get("depth") is None
    with pytest.raises(InputError, match=r"^the run must have a column 'depth', got "):
        trajectory["depth"]


def test_a_run_is_told_in_a_line(trajectory: Trajectory) -> None:
    told = repr(replace(trajectory, stopped="the bit turns over", engine="native"))
    length = trajectory["drilled_length"][-1]
    assert told == (
        f"<Trajectory: {len(trajectory)} columns, {trajectory.row_count} rows over {length:g} m, native engine, "
        "stopped before its end>"
    )
    assert repr(Trajectory(trajectory.columns)).endswith(" m, case not known>")


@pytest.mark.parametrize("name", ["run.csv", "run.parquet"])
@pytest.mark.parametrize("engine", ["native", None])
def test_a_file_says_which_engine_computed_the_run(
    trajectory: Trajectory, tmp_path: Path, name: str, engine: str | None
) -> None:
    write_trajectory(replace(trajectory, engine=engine), tmp_path / name)
    assert read_trajectory(tmp_path / name).engine == engine


def test_a_name_that_is_neither_csv_nor_parquet_is_refused(trajectory: Trajectory, tmp_path: Path) -> None:
    for use in (lambda path: write_trajectory(trajectory, path), read_trajectory):
        with pytest.raises(InputError, match=r"run\.txt: must end in \.csv or \.parquet, got '\.txt'"):
            use(tmp_path / "run.txt")
    assert not list(tmp_path.iterdir())


def test_without_pyarrow_parquet_says_what_to_install(
    trajectory: Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(InputError, match=r"run\.parquet: .* pip install 'boreprop\[study\]'"):
        write_trajectory(trajectory, tmp_path / "run.parquet")
    assert not list(tmp_path.iterdir())


def test_a_csv_write_that_fails_changes_nothing(trajectory: Trajectory, tmp_path: Path) -> None:
    write_trajectory(trajectory, tmp_path / "run.csv")
    before = {file: file.read_bytes() for file in tmp_path.iterdir()}
    shorter = {**trajectory.columns, "eta_pi": trajectory["eta_pi"][:-1]}
    with pytest.raises(ValueError, match="shorter"):
        write_trajectory(Trajectory(shorter, trajectory.case), tmp_path / "run.csv")
    assert {file: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_a_case_that_cannot_be_written_leaves_the_old_run(
    trajectory: Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object, **_run: object) -> str:
        raise OSError("disk full")

    write_trajectory(trajectory, tmp_path / "run.csv")
    before = {file: file.read_bytes() for file in tmp_path.iterdir()}
    monkeypatch.setattr(results, "dump_case", fail)
    trajectory.columns["eta_pi"][:] = 9.0
    for name in ("run.csv", "run.parquet"):
        with pytest.raises(OSError, match="disk full"):
            write_trajectory(trajectory, tmp_path / name)
    assert {file: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_a_parquet_write_that_fails_half_way_leaves_no_file(
    trajectory: Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def half_write(table: object, where: Path) -> None:
        where.write_bytes(b"PAR1")
        raise KeyboardInterrupt

    monkeypatch.setattr("pyarrow.parquet.write_table", half_write)
    with pytest.raises(KeyboardInterrupt):
        write_trajectory(trajectory, tmp_path / "run.parquet")
    assert not list(tmp_path.iterdir())

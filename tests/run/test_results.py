"""Result files: every number comes back, with its case, and a write that fails changes nothing."""

import sys
import tracemalloc
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings

from boreprop.case.case import Case
from boreprop.core.errors import TableError
from boreprop.errors import InputError
from boreprop.run import results
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.trajectory import Trajectory
from numbered_runs import columns


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


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("drilled_length,bit_tilt\n0,1\n1\n", ":3: must have 2 values like the header, got 1"),
        ("drilled_length,bit_tilt\n0,1\n1,2,3\n", ":3: must have 2 values like the header, got 3"),
        ("drilled_length,bit_tilt\n0,high\n", ":2: bit_tilt: must be a finite number, got 'high'"),
        ("drilled_length,bit_tilt\n0,nan\n", ":2: bit_tilt: must be a finite number, got 'nan'"),
        ("time,bit_tilt\n0,1\n", ": must have a column 'drilled_length' (m), got ['time', 'bit_tilt']"),
        ("drilled_length\n", ": must have at least one row, got none"),
        ("", ": must have a column 'drilled_length' (m), got []"),
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
        ({"time": [0.0]}, "must have a column 'drilled_length' (m), got ['time']"),
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
    def fail(*_: object, **__: object) -> str:
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


def test_a_long_csv_file_is_written_row_by_row_in_little_memory(tmp_path: Path) -> None:
    rows = 12 * results.BLOCK + 1
    values = np.random.default_rng(1).normal(size=(5, rows))
    names = ("drilled_length", "bit_tilt", "bit_inclination", "bit_moment", "displacement")
    tracemalloc.start()
    write_trajectory(Trajectory(dict(zip(names, values, strict=True))), tmp_path / "run.csv")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    lines = [",".join(map(repr, row)) for row in values.T.tolist()]
    assert (tmp_path / "run.csv").read_bytes() == "".join(f"{line}\n" for line in (",".join(names), *lines)).encode()
    assert peak < values.nbytes

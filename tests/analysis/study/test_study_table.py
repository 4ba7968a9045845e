"""The file of a study: it grows, and refuses to become another."""

import os
import re
from collections.abc import Callable
from concurrent.futures import Executor
from functools import partial
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import study_functions
from boreprop.analysis.study.compute import study
from boreprop.analysis.study.design import Study, grid
from boreprop.analysis.study.store import read
from boreprop.case.file import load_case
from boreprop.case.paper import paper_case
from boreprop.errors import InputError
from boreprop.report.tables.study import lines
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate
from study_functions import calls, counted, numbered, weight

parquet = pytest.importorskip("pyarrow.parquet")
either_file = pytest.mark.parametrize("name", ["study.parquet", "study.csv"])


def test_the_file_is_a_table_of_the_cases_in_order(tmp_path: Path) -> None:
    path = tmp_path / "study.parquet"
    results = study(numbered(6), study_functions.first_slow, output=path, workers=2)
    table = parquet.read_table(path).to_pydict()
    assert list(table) == ["case", "active_weight_on_bit", "weight", "square", "error"]
    assert table["case"] == list(range(6))
    assert table["square"] == [1.0, 4.0, 9.0, 16.0, 25.0, 36.0]
    np.testing.assert_array_equal(table["weight"], results["weight"])
    assert os.listdir(tmp_path) == ["study.parquet"]


@either_file
def test_a_study_that_grows_computes_what_is_new(tmp_path: Path, name: str) -> None:
    path, function = tmp_path / name, partial(counted, tmp_path, 0.0)
    study(numbered(4), function, output=path, workers=1)
    seen: list[float] = []
    results = study(numbered(6), function, output=path, workers=1, progress=seen.append)
    assert list(results["square"]) == [1.0, 4.0, 9.0, 16.0, 25.0, 36.0]
    assert sorted(calls(tmp_path)) == [1, 2, 3, 4, 5, 6]
    assert seen[0] == 4
    assert list(study(numbered(3), function, output=path)["weight"]) == [1.0, 2.0, 3.0]
    assert len(read(path).lines) == 6


def test_a_csv_file_is_a_table_with_its_case_beside_it(tmp_path: Path, thread: Executor) -> None:
    cases = grid(paper_case(), {"active_weight_on_bit": [1e3, 0.0, -1.0, 0.1 + 0.2]})
    study(cases, lambda case: {"twice": 2 * case.active_weight_on_bit}, output=tmp_path / "study.csv", executor=thread)
    message = "active_weight_on_bit: must be > 0, got {}"
    assert (tmp_path / "study.csv").read_text(encoding="utf-8").splitlines() == [
        "case,active_weight_on_bit,twice,error",
        "0,1000.0,2000.0,",
        f'1,0.0,,"{message.format(0.0)}"',
        f'2,-1.0,,"{message.format(-1.0)}"',
        "3,0.30000000000000004,0.6000000000000001,",
    ]
    assert load_case(tmp_path / "study.case.toml") == paper_case()
    assert sorted(os.listdir(tmp_path)) == ["study.case.toml", "study.csv"]


def test_either_file_gives_the_same_back(tmp_path: Path, thread: Executor) -> None:
    for name in ("study.csv", "study.parquet"):
        study(numbered(5), study_functions.divided, output=tmp_path / name, executor=thread)
    one, other = (read(tmp_path / name) for name in ("study.csv", "study.parquet"))
    assert (one.columns, one.identity) == (other.columns, other.identity)
    np.testing.assert_equal(one.lines, other.lines)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda path: path.with_name("study.case.toml").unlink(), "study.csv: must be the file of a study, with study"),
        (lambda path: path.write_text("case,error\n0\n"), "study.csv:2: must have 2 values like the header, got 1"),
        (lambda path: path.write_text("case,x,error\n0,y,\n"), "study.csv:2: x: must be a number, got 'y'"),
        (lambda path: path.write_text("case;error\n0;\n"), "study.csv: must be the file of a study, got columns "),
        (lambda path: path.write_text(""), "study.csv: must be the file of a study, with study.case.toml beside it"),
        (lambda path: path.write_bytes(b"\xff\xfe"), "study.csv: must be the file of a study, with study.case.toml "),
        (lambda path: path.with_name("study.case.toml").write_text("[bha]"), "study.case.toml: must be a case that bo"),
    ],
)
def test_a_csv_file_that_was_changed_is_refused(
    tmp_path: Path, thread: Executor, change: Callable[[Path], object], message: str
) -> None:
    path = tmp_path / "study.csv"
    study(numbered(2), weight, output=path, executor=thread)
    change(path)
    with pytest.raises(InputError, match=re.escape(message)):
        study(numbered(2), weight, output=path, executor=thread)


@pytest.mark.parametrize(
    ("other", "function", "named"),
    [
        (
            lambda: numbered(3),
            study_functions.divided,
            r"function: .*study_functions\.weight.*study_functions\.divided",
        ),
        (lambda: grid(paper_case(), {"active_weight_on_bit": [1.0, 2.5]}), weight, "of case 1: must be 2.0 .*got 2.5"),
        (lambda: grid(paper_case(), {"rss_force": [1.0]}), weight, "varied parameters: .*got 'rss_force'"),
        (lambda: grid(paper_case(1.0), {"active_weight_on_bit": [1.0]}), weight, r"bit.tilt_limit_deg: must be 2.0"),
    ],
    ids=["function", "values", "parameters", "case"],
)
@either_file
def test_another_study_in_the_file_is_refused_with_what_differs(
    tmp_path: Path, thread: Executor, name: str, other: Callable[[], Study], function: Any, named: str
) -> None:
    path = tmp_path / name
    study(numbered(3), weight, output=path, executor=thread)
    before = path.read_bytes()
    with pytest.raises(InputError, match=f"{name}: .*{named}"):
        study(other(), function, output=path, executor=thread)
    assert path.read_bytes() == before


def test_arguments_of_a_function_are_part_of_the_study(tmp_path: Path, thread: Executor) -> None:
    path = tmp_path / "study.parquet"
    study(numbered(2), partial(counted, tmp_path, 0.0), output=path, executor=thread)
    with pytest.raises(InputError, match=r"function: .*0\.0\).*0\.001\)"):
        study(numbered(2), partial(counted, tmp_path, 0.001), output=path, executor=thread)


def test_a_file_of_something_else_is_refused(tmp_path: Path) -> None:
    write_trajectory(simulate(paper_case(), length=1.0), tmp_path / "run.parquet")
    (tmp_path / "text.parquet").write_text("text")
    for name, message in (
        ("run.parquet", "of a study"),
        ("text.parquet", "readable"),
        ("study.xlsx", "end in .csv or"),
    ):
        with pytest.raises(InputError, match=f"{name}: must .*{message}"):
            study(numbered(2), weight, output=tmp_path / name)


@pytest.mark.parametrize(
    ("errors", "ripples", "wavelength", "expected"),
    [
        (["", "", ""], [1.0, 1.0, 1.0], [1.0, 2.0, 3.0], ("", "")),
        (["", "", ""], [1.0, 0.0, 1.0], [1.0, nan, 3.0], ("", ", of the 2 cases that ripple")),
        (["", "", ""], [0.0, 0.0, 0.0], [nan, nan, nan], ("", ", of 0 of 3 cases")),
        (["bad", "", ""], [nan, 0.0, 1.0], [nan, nan, 3.0], ("", ", of the case that ripples")),
        (["", "", ""], [1.0, 1.0, 1.0], [1.0, nan, 3.0], ("", ", of 2 of 3 cases")),
    ],
    ids=["all", "some", "none", "failed", "unknown"],
)
def test_a_line_over_a_part_of_the_cases_says_which(
    errors: list[str], ripples: list[float], wavelength: list[float], expected: tuple[str, str]
) -> None:
    build_rate = [nan if error else 1.0 for error in errors]
    figures = {"build_rate": build_rate, "ripples": ripples, "wavelength": wavelength, "error": errors}
    results = xarray.Dataset({name: ("case", np.array(values)) for name, values in figures.items()})
    (build, _, _), (wave, _, _) = lines(results, (0.1, 0.9))
    assert (build, wave) == (f"build_rate{expected[0]}", f"wavelength{expected[1]}")

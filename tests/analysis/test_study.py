"""Studies: their cases, what comes out, and that they end complete whatever dies on the way."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from functools import partial
from io import BytesIO
from math import nan, radians
from pathlib import Path
from pickle import PicklingError
from typing import Any

import numpy as np
import psutil
import pytest
import scipy.stats
import xarray

import study_functions
from boreprop.analysis.study.compute import probability, quantiles, study
from boreprop.analysis.study.design import Study, grid, sample, vary
from boreprop.analysis.study.figures import FIGURES, key_figures
from boreprop.analysis.study.table import Line
from boreprop.analysis.summary import summarize
from boreprop.case.paper import paper_case
from boreprop.case.parameters import parameters
from boreprop.cli.ranges import parse_axis, parse_distribution, parse_each
from boreprop.core.system import eta_pi
from boreprop.errors import InputError
from boreprop.report.tables.study import lines, outcome
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.workers import work
from conftest import Command
from places import TESTS
from study_functions import calls, counted, numbered, weight

parquet = pytest.importorskip("pyarrow.parquet")

UNCERTAIN = {
    "active_weight_on_bit": scipy.stats.norm(1600.0, 300.0),
    "stabilizer_clearance[1]": scipy.stats.lognorm(0.3, scale=3e-3),
}
posix = pytest.mark.skipif(os.name != "posix", reason="kills with signals")


@pytest.fixture
def thread() -> Any:
    """An executor whose functions need not be importable."""
    with ThreadPoolExecutor(1) as executor:
        yield executor


# the cases


@pytest.mark.parametrize("name", parameters(paper_case()))
def test_a_varied_parameter_changes_and_no_other(name: str) -> None:
    case = paper_case()
    before = parameters(case)
    value = 1.01 * before[name] + (name == "rss_force")
    assert parameters(vary(case, {name: value})) == {**before, name: value}


def test_eta_pi_is_reached_by_the_weight_with_the_other_values_in_place() -> None:
    case = vary(paper_case(), {"eta_pi": 0.05, "lateral_steering_resistance": 20.0, "stabilizer_position[1]": 3.0})
    assert eta_pi(case.bha, case.bit, case.active_weight_on_bit) == pytest.approx(0.05)
    assert case.bit.lateral_steering_resistance == 20.0


def test_the_tilt_limit_can_be_given_in_degrees() -> None:
    assert vary(paper_case(), {"bit_tilt_limit_deg": 1.5}).bit.tilt_limit == radians(1.5)


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["stabilizer_clearance[2]"], r"must be one of .*stabilizer_clearance\[1\].*, got 'stabilizer_clearance\[2\]'"),
        (["bit_tilt"], "must be one of .*, got 'bit_tilt'"),
        (["eta_pi", "active_weight_on_bit"], "active_weight_on_bit: must be varied under one name, got eta_pi, active"),
    ],
)
def test_names_that_cannot_be_varied_are_refused_before_anything_is_computed(names: list[str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        grid(paper_case(), {name: [1.0] for name in names})


@pytest.mark.parametrize("axis", [[], [[1.0]], 1.0])
def test_an_axis_must_be_a_list(axis: Any) -> None:
    with pytest.raises(InputError, match="eta_pi: must be a list"):
        grid(paper_case(), {"eta_pi": axis})


def test_a_grid_has_an_axis() -> None:
    with pytest.raises(InputError, match="at least one axis"):
        grid(paper_case(), {})


def test_a_sample_follows_its_distributions() -> None:
    values = sample(paper_case(), UNCERTAIN, 2000, seed=1).values
    for column, distribution in zip(values.T, UNCERTAIN.values(), strict=True):
        assert scipy.stats.kstest(column, distribution.cdf).pvalue > 0.01
    assert abs(np.mean(np.prod(scipy.stats.zscore(values), axis=1))) < 0.06  # their correlation


def test_a_sample_follows_from_its_seed() -> None:
    first, again, other = (sample(paper_case(), UNCERTAIN, 20, seed).values for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    assert not np.isin(first, other).any()


def test_a_larger_sample_of_more_parameters_keeps_the_draws() -> None:
    small = sample(paper_case(), UNCERTAIN, 20, seed=1)
    more = {"rss_force": scipy.stats.norm(), **UNCERTAIN}
    assert np.array_equal(sample(paper_case(), more, 30, seed=1).values[:20, 1:], small.values)


def test_a_distribution_that_draws_no_numbers_is_refused() -> None:
    with pytest.raises(InputError, match="eta_pi: must be drawn from a distribution of finite numbers, got nan"):
        sample(paper_case(), {"eta_pi": scipy.stats.norm(1.0, -1.0)}, 5, seed=1)


def test_an_axis_as_text() -> None:
    axes = parse_each(parse_axis, ["eta_pi=0.1:0.2:3", "stabilizer_clearance[1]=1e-3,2e-3"])
    assert {name: list(axis) for name, axis in axes.items()} == {
        "eta_pi": pytest.approx([0.1, 0.15, 0.2]),
        "stabilizer_clearance[1]": [1e-3, 2e-3],
    }


@pytest.mark.parametrize(
    ("text", "mean", "deviation"),
    [
        ("normal(60e3,6e3)", 60e3, 6e3),
        ("uniform(2, 4)", 3.0, 2 / 12**0.5),
        ("triangular(0,1,2)", 1.0, 1 / 6**0.5),
        ("lognormal(2,0.5)", 2 * np.exp(0.125), 2 * np.exp(0.125) * np.sqrt(np.exp(0.25) - 1)),
    ],
)
def test_a_distribution_as_text(text: str, mean: float, deviation: float) -> None:
    parsed: tuple[str, Any] = parse_distribution(f"eta_pi={text}")
    name, distribution = parsed
    assert name == "eta_pi"
    assert distribution.mean() == pytest.approx(mean)
    assert distribution.std() == pytest.approx(deviation)


# what comes out


def test_a_grid_is_labelled_by_its_axes() -> None:
    eta_pis, clearances = [0.05, 0.01, 0.02], [2e-3, 1e-3]
    cases = grid(paper_case(), {"eta_pi": eta_pis, "stabilizer_clearance[1]": clearances})
    results = study(cases, weight)
    assert dict(results.sizes) == {"eta_pi": 3, "stabilizer_clearance[1]": 2}
    assert list(results["eta_pi"]) == eta_pis
    assert results["stabilizer_clearance[1]"].attrs["units"] == "m"
    for x in eta_pis:
        expected = x * 3 * 7.2e6 / 3.66**2 / 10.0
        assert results["weight"].sel(eta_pi=x).values == pytest.approx([expected] * 2)
    assert (results["error"] == "").all()


def test_a_grid_puts_each_result_at_its_values(thread: Executor) -> None:
    cases = grid(paper_case(), {"rss_position": [0.5, 0.6], "active_weight_on_bit": [1.0, 2.0, 3.0]})
    results = study(cases, lambda case: {"sum": case.bha.rss_position + case.active_weight_on_bit}, executor=thread)
    np.testing.assert_array_equal(results["sum"], results["rss_position"] + results["active_weight_on_bit"])


def test_results_are_the_same_wherever_they_are_computed(tmp_path: Path, thread: Executor) -> None:
    cases = sample(replace(paper_case(), length=30.0), UNCERTAIN, 12, seed=3)
    two = study(cases, workers=2)
    assert two["build_rate"].to_series().nunique() == 12
    for other in (
        study(cases, workers=1),
        study(cases, executor=thread),
        study(cases, output=tmp_path / "study.parquet", workers=2),
        study(cases, output=tmp_path / "study.parquet"),  # read
    ):
        xarray.testing.assert_identical(two, other)


def test_key_figures_are_the_summary_of_a_run() -> None:
    case = replace(paper_case(), length=40.0)
    summary = summarize(simulate(case))
    figures = key_figures(case)
    assert figures["build_rate"] == summary.build_rate
    assert figures["largest_contact_force[1]"] == summary.largest_contact_force[0]
    assert figures["ripples"] == summary.rippling.ripples
    assert {name.partition("[")[0] for name in figures} == set(FIGURES)


def test_cases_that_fail_are_rows_with_the_message(tmp_path: Path) -> None:
    results = study(numbered(5), study_functions.divided, output=tmp_path / "study.parquet", workers=1)
    assert list(results["error"]) == ["", "", "float division by zero", "", ""]
    np.testing.assert_array_equal(results["inverse"], [-0.5, -1.0, np.nan, 1.0, 0.5])
    table = parquet.read_table(tmp_path / "study.parquet").to_pydict()
    assert table["error"] == [None, None, "float division by zero", None, None]
    np.testing.assert_array_equal(table["inverse"], results["inverse"])


def test_a_study_of_which_every_case_fails_says_so() -> None:
    for cases in (
        grid(paper_case(), {"stabilizer_clearance[1]": [-1e-3, -2e-3]}),
        sample(paper_case(), {"stabilizer_clearance[1]": scipy.stats.uniform(-2e-3, 1e-3)}, n=2, seed=1),
    ):
        results = study(cases, workers=1)
        assert lines(results, [0.5]) == []
        assert outcome(results).startswith(
            "2 cases, 2 failed (the first: stabilizer_clearance[1]: must be >= 0, got -0.00"
        )


def test_cases_out_of_range_are_rows_with_the_message() -> None:
    results = study(grid(paper_case(), {"stabilizer_clearance[1]": [-1e-3, 1e-3]}), weight, workers=1)
    assert "must be >= 0, got -0.001" in results["error"].item(0)
    assert np.isnan(results["weight"].item(0))
    assert results["weight"].item(1) > 0.0


def test_a_bug_is_raised() -> None:
    with pytest.raises(TypeError, match="unsupported operand"):
        study(numbered(3), study_functions.buggy, workers=1)


def test_a_function_that_no_worker_could_import_is_refused() -> None:
    with pytest.raises((AttributeError, PicklingError), match="pickle"):
        study(numbered(3), lambda case: {}, workers=1)


def test_a_result_must_not_be_called_like_a_parameter(thread: Executor) -> None:
    with pytest.raises(InputError, match="must name its results otherwise than the study's own columns, got 'active"):
        study(numbered(3), study_functions.named_like_a_parameter, executor=thread)


def test_rows_are_told_of_in_order_of_completion() -> None:
    rows: list[Line] = []
    done: list[float] = []
    study(numbered(6), study_functions.first_slow, workers=2, on_result=rows.append, progress=done.append)
    assert sorted(row["case"] for row in rows) == [0, 1, 2, 3, 4, 5]
    assert rows[-1] == {"case": 0, "active_weight_on_bit": 1.0, "weight": 1.0, "square": 1.0, "error": None}
    assert (done[0], done[-1]) == (0, 6)
    assert done == sorted(done)


def test_quantiles_leave_failed_cases_out() -> None:
    results = study(numbered(5), study_functions.divided, workers=1)
    found = quantiles(results, (0.5, 1.0))
    assert list(found["inverse"]) == [0.0, 1.0]


def test_the_probability_has_the_interval_of_clopper_and_pearson() -> None:
    happened = xarray.DataArray([1.0] * 3 + [0.0] * 7 + [np.nan])
    estimate, low, high = probability(happened)
    assert estimate == 0.3
    # the tails of the binomial distribution beyond what was seen
    assert scipy.stats.binom.sf(2, 10, low) == pytest.approx(0.025)
    assert scipy.stats.binom.cdf(3, 10, high) == pytest.approx(0.025)


def test_nothing_known_is_no_probability() -> None:
    estimate, low, high = probability(xarray.DataArray([np.nan]))
    assert np.isnan(estimate)
    assert (low, high) == (0.0, 1.0)


# the file


def test_the_file_is_a_table_of_the_cases_in_order(tmp_path: Path) -> None:
    path = tmp_path / "study.parquet"
    results = study(numbered(6), study_functions.first_slow, output=path, workers=2)
    table = parquet.read_table(path).to_pydict()
    assert list(table) == ["case", "active_weight_on_bit", "weight", "square", "error"]
    assert table["case"] == list(range(6))
    assert table["square"] == [1.0, 4.0, 9.0, 16.0, 25.0, 36.0]
    np.testing.assert_array_equal(table["weight"], results["weight"])
    assert os.listdir(tmp_path) == ["study.parquet"]


def test_a_study_that_grows_computes_what_is_new(tmp_path: Path) -> None:
    path, function = tmp_path / "study.parquet", partial(counted, tmp_path, 0.0)
    study(numbered(4), function, output=path, workers=1)
    seen: list[float] = []
    results = study(numbered(6), function, output=path, workers=1, progress=seen.append)
    assert list(results["square"]) == [1.0, 4.0, 9.0, 16.0, 25.0, 36.0]
    assert sorted(calls(tmp_path)) == [1, 2, 3, 4, 5, 6]
    assert seen[0] == 4
    assert list(study(numbered(3), function, output=path)["weight"]) == [1.0, 2.0, 3.0]
    assert parquet.read_table(path).num_rows == 6


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
def test_another_study_in_the_file_is_refused_with_what_differs(
    tmp_path: Path, thread: Executor, other: Callable[[], Study], function: Any, named: str
) -> None:
    path = tmp_path / "study.parquet"
    study(numbered(3), weight, output=path, executor=thread)
    before = path.read_bytes()
    with pytest.raises(InputError, match=f"study.parquet: .*{named}"):
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
    for name, message in (("run.parquet", "of a study"), ("text.parquet", "readable"), ("study.csv", "end in .parq")):
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


# what dies on the way


def rows_in(path: Path) -> list[int]:
    """The cases in a study's file."""
    if not path.exists():
        return []
    cases: list[int] = parquet.read_table(BytesIO(path.read_bytes()))["case"].to_pylist()  # of one file, not of two
    return cases


def wait_for(condition: Callable[[], bool]) -> None:
    """Return when it holds; fails after a minute."""
    end = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


@posix
@pytest.mark.slow
def test_a_killed_study_resumes_where_it_stopped(tmp_path: Path) -> None:
    path = tmp_path / "study.parquet"
    killed = subprocess.Popen([sys.executable, study_functions.__file__, str(tmp_path)])
    wait_for(lambda: len(rows_in(path)) >= 6)
    processes = psutil.Process(killed.pid).children(recursive=True)
    killed.kill()
    killed.wait()
    assert not psutil.wait_procs(processes, timeout=60)[1]  # no worker outlives it
    done, called = rows_in(path), calls(tmp_path)
    assert 6 <= len(done) < 60
    assert len(called) - len(done) <= 8  # in flight: two chunks a worker, and what had come in since the last writing

    results = study(numbered(60), partial(counted, tmp_path, 0.1), output=path, workers=2)
    assert list(results["weight"]) == list(range(1, 61))
    later = calls(tmp_path)[len(called) :]
    assert sorted(later) == [case + 1 for case in range(60) if case not in done]


@posix
def test_a_study_ends_complete_though_a_worker_is_killed(tmp_path: Path) -> None:
    results = study(numbered(40), partial(study_functions.die_once, tmp_path), workers=2)
    assert (tmp_path / "died").exists()
    assert list(results["weight"]) == list(range(1, 41))
    assert (results["error"] == "").all()
    called = calls(tmp_path)
    assert len(called) <= 40 + 2 * 2 * 12  # twice at most what two workers had before them, chunks of a dozen


@posix
def test_a_case_that_kills_every_worker_is_the_only_one_to_fail() -> None:
    results = study(numbered(20), study_functions.die_at_5, workers=2)
    assert list(np.flatnonzero(results["error"] != "")) == [4]
    assert "terminated" in results["error"].item(4)
    assert list(results["weight"].dropna("active_weight_on_bit")) == [*range(1, 5), *range(6, 21)]


@posix
def test_workers_that_never_give_a_result_end_the_study() -> None:
    with pytest.raises(BrokenProcessPool):
        study(numbered(2), study_functions.die, workers=1)


@posix
@pytest.mark.slow
def test_a_study_on_a_dask_cluster_ends_complete_though_a_worker_is_killed(tmp_path: Path, paper_case: Path) -> None:
    pytest.importorskip("distributed")
    output, cases = tmp_path / "study.parquet", 300
    command = [sys.executable, *map(str, (TESTS / "study_on_dask.py", paper_case, output, cases))]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    before, killed = map(int, done.stdout.split()[-2:])
    assert before < cases
    assert not psutil.pid_exists(killed)
    table = parquet.read_table(output).to_pydict()
    assert table["case"] == list(range(cases))
    assert table["error"] == [None] * cases


@posix
def test_ctrl_c_keeps_what_is_done_and_leaves_no_process(tmp_path: Path, paper_case: Path) -> None:
    command = [sys.executable, "-m", "boreprop.cli.app", "study", str(paper_case), "--output", "study.parquet"]
    child = subprocess.Popen(
        [*command, "--vary", "eta_pi=0.005:0.02:500", "--workers", "2"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    wait_for(lambda: len(rows_in(tmp_path / "study.parquet")) >= 2)
    processes = psutil.Process(child.pid).children(recursive=True)
    os.killpg(child.pid, signal.SIGINT)  # as a terminal does
    _, stderr = child.communicate(timeout=60)
    assert child.returncode == 130
    assert stderr.count("\n") == 1
    assert "study.parquet: keeps" in stderr
    assert 2 <= len(rows_in(tmp_path / "study.parquet")) < 500
    assert not psutil.wait_procs(processes, timeout=60)[1]
    assert os.listdir(tmp_path) == ["study.parquet"]


# the workers


class Counting(ThreadPoolExecutor):
    """Counts what is submitted."""

    submitted = 0

    def submit(self, *call: Any, **options: Any) -> Future[Any]:
        self.submitted += 1
        return super().submit(*call, **options)


def test_quick_items_go_together_and_slow_ones_alone() -> None:
    with Counting(1) as executor:
        quick = [pair for done in work(abs, dict.fromkeys(range(20_000), -1), executor) for pair in done]
        assert sorted(quick) == [(key, 1) for key in range(20_000)]
        assert executor.submitted < 5000
        executor.submitted = 0
        slow = [pair for done in work(time.sleep, dict.fromkeys(range(4), 0.3), executor) for pair in done]
        assert (len(slow), executor.submitted) == (4, 4)


def test_closing_cancels_what_has_not_begun() -> None:
    begun: list[float] = []

    def note(item: float) -> None:
        begun.append(item)
        time.sleep(0.05)

    with ThreadPoolExecutor(1) as executor:
        results = work(note, dict.fromkeys(range(200), 1.0), executor)
        next(results)
        results.close()
    assert len(begun) < 20


# the command


def test_the_command_over_a_grid(command: Command, tmp_path: Path, paper_text: str) -> None:
    (tmp_path / "case.toml").write_text(paper_text.replace("= 219.6", "= 30.0"), encoding="utf-8")
    axes = ["--vary", "eta_pi=0.01:0.02:2", "--vary", "bit_tilt_limit_deg=1,2,95"]
    result = command("boreprop", "study", "case.toml", *axes, "--output", "study.parquet", "--workers", "1")
    assert result.stderr == ""
    assert "median" in result.stdout
    assert "6 cases, 2 failed (the first: bit_tilt_limit: must be <= " in result.stdout
    assert "the figures are of the other 4, " in result.stdout
    assert parquet.read_table(tmp_path / "study.parquet")["bit_tilt_limit_deg"].to_pylist() == [1.0, 2.0, 95.0] * 2


def test_the_command_of_uncertain_parameters(command: Command, tmp_path: Path, paper_text: str) -> None:
    (tmp_path / "case.toml").write_text(paper_text.replace("= 219.6", "= 100.0"), encoding="utf-8")
    arguments = ["--uncertain", "active_weight_on_bit=normal(1600,100)", "--sample", "6", "--seed", "4"]
    result = command("boreprop", "study", "case.toml", *arguments, "--output", "study.parquet", "--workers", "1")
    assert (result.returncode, result.stderr) == (0, "")
    assert "study.parquet: 6 cases, probability of rippling 100.0% (54.1% to 100.0%)" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ([], ("--vary, --uncertain: exactly one", "neither")),
        (["--vary", "eta_pi=1", "--uncertain", "rss_force=normal(0,1)"], ("--vary, --uncertain: exactly one", "both")),
        (["--vary", "eta_pi=1:2"], ("--vary", "START:STOP:COUNT", "'eta_pi=1:2'")),
        (["--vary", "eta_pi"], ("--vary", "START:STOP:COUNT", "'eta_pi'")),
        (["--vary", "eta_pi=1", "--vary", "eta_pi=2"], ("eta_pi: must be given once", "'eta_pi=2'")),
        (["--vary", "weight=1"], ("must be one of", "active_weight_on_bit", "'weight'")),
        (["--uncertain", "eta_pi=gauss(1,2)"], ("--uncertain", "normal(", "'eta_pi=gauss(1,2)'")),
        (["--uncertain", "eta_pi=normal(1)"], ("--uncertain", "normal(", "'eta_pi=normal(1)'")),
        (["--uncertain", "eta_pi=normal(1,-2)"], ("--uncertain", "normal(", "'eta_pi=normal(1,-2)'")),
        (["--uncertain", "eta_pi=triangular(1,1,1)"], ("--uncertain", "triangular(", "'eta_pi=triangular(1,1,1)'")),
        (["--uncertain", "eta_pi=normal(1,2)", "--sample", "0"], ("--sample", "0")),
        (["--vary", "eta_pi=1", "--workers", "0"], ("--workers", "0")),
        (["--vary", "eta_pi=1", "--workers", "1", "--dask", "tcp://a:1"], ("--workers", "--dask", "1")),
        (["--vary", "eta_pi=1", "--dask", "nobody://a:1"], ("--dask", "Dask scheduler", "'nobody://a:1'")),
    ],
)
def test_wrong_arguments_of_the_command(
    command: Command, tmp_path: Path, paper_case: Path, arguments: list[str], named: tuple[str, ...]
) -> None:
    result = command("boreprop", "study", paper_case, "--output", "study.parquet", *arguments)
    assert (result.returncode, result.stdout) == (2, "")
    assert len(result.stderr.splitlines()) == 1, result.stderr
    for name in named:
        assert name in result.stderr
    assert not list(tmp_path.iterdir())

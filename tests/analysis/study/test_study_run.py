"""A study's results: their labels, the same wherever they are computed, and what failed."""

from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from pickle import PicklingError

import numpy as np
import pytest
import scipy.stats
import xarray

import study_functions
from boreprop.analysis.study.compute import probability, quantiles, study
from boreprop.analysis.study.design import grid, sample
from boreprop.analysis.study.figures import FIGURES, IN_SPACE, key_figures
from boreprop.analysis.study.store import Line
from boreprop.analysis.summary import summarize
from boreprop.case.paper import paper_case
from boreprop.errors import InputError
from boreprop.report.tables.study import lines, outcome
from boreprop.run.simulate import simulate
from studies import UNCERTAIN
from study_functions import numbered, weight

parquet = pytest.importorskip("pyarrow.parquet")


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
    assert {name.partition("[")[0] for name in figures} == set(FIGURES) - set(IN_SPACE)


@pytest.mark.usefixtures("kernel")
def test_in_space_there_is_an_azimuth_at_the_end() -> None:
    case = paper_case()
    survey = replace(case.survey, inclination=(0.5,) * 3, azimuth=(1.0,) * 3)
    figures = key_figures(replace(case, survey=survey, length=20.0))
    assert figures["end_azimuth"] == pytest.approx(1.0)
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
    with pytest.raises((AttributeError, PicklingError), match=r"pickle|local object"):
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

"""Off bottom, as while a pipe is connected: no weight, no progress, and the hole waits. In a process of its own."""

from functools import partial
from pathlib import Path

import pytest
from fmpy import read_model_description

from boreprop.case.case import Case
from boreprop.core.drilling import Drilling
from flavours import Flavour, both_flavours
from scenarios import report

host = partial(report, "fmu_off_bottom_host")


def under(case: Case, rss_force: float) -> dict[str, float]:
    """The outputs after the 4 m that the scenarios drill before a connection, with the pads at a force there."""
    drilling = Drilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    drilling.advance(4.0, 8e3, 2e3)
    drilling.advance(4.0, rss_force, 2e3)
    return drilling.outputs()


@both_flavours
@pytest.mark.parametrize("pads", ["8e3", "0"])
def test_nothing_moves_and_the_outputs_are_those_of_the_last_weight(case: Case, fmu: Path, pads: str) -> None:
    _, waiting, _ = host("life", fmu, pads)
    expected = {**under(case, float(pads)), "eta_pi": 0.0}
    for row in waiting:
        assert row == pytest.approx(expected, rel=1e-9, abs=1e-12)


@both_flavours
def test_drilling_goes_on_as_if_it_had_never_stopped(fmu: Path) -> None:
    before, after = host("life", fmu)
    stopped, *_, resumed = host("life", fmu, "8e3", "0", "-5e3")
    assert stopped == before
    for row, expected in zip(resumed, after, strict=True):
        assert row == pytest.approx(expected, rel=1e-10, abs=1e-10)


@both_flavours
def test_a_host_may_send_zeros_first(fmu: Path) -> None:
    waiting, drilled = host("zeros_first", fmu, "true")
    [], expected = host("zeros_first", fmu, "false")
    assert {row["drilled_length"] for row in waiting} == {0.0}
    for row, of_expected in zip(drilled, expected, strict=True):
        assert row == pytest.approx(of_expected, rel=1e-10, abs=1e-10)


@both_flavours
def test_progress_without_weight_is_discarded_with_its_reason(fmu: Path) -> None:
    status, (level, category, line), next_row = host("progress_without_weight", fmu)
    assert (status, level, category) == ("discard", 2, "logStatusDiscard")
    assert line == "active_weight_on_bit: must be > 0 where rate_of_penetration is > 0, got 0.0"
    assert next_row["drilled_length"] == pytest.approx(4.1)


@both_flavours
def test_pads_at_no_number_are_discarded_there_too_and_no_output_is_shown(fmu: Path) -> None:
    status, shown, next_row = host("bad_pads", fmu)
    assert (status, shown) == ("discard", None)
    assert next_row["drilled_length"] == pytest.approx(4.1)


@both_flavours
def test_a_state_saved_off_bottom_goes_on_alike(fmu: Path) -> None:
    there, here = host("through_a_state", fmu)
    assert there == here


@both_flavours
def test_the_description_allows_no_weight(fmu: Path, flavour: Flavour) -> None:
    variables = {v.name: v for v in read_model_description(fmu).modelVariables}
    assert float(variables["active_weight_on_bit"].min) == 0.0

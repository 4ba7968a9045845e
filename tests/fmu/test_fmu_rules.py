"""The rules of the standard: which calls may be made when, what is logged and how, what a host may say of a run."""

import json
from pathlib import Path
from typing import Any

import pytest

from boreprop.core.quantities import PARAMETERS, scalar_names
from flavours import LOGGED, Flavour, both_flavours
from scenarios import play

OK: tuple[str, list[Any]] = ("ok", [])


def host(scenario: str, fmu: Path) -> tuple[Any, str]:
    """What a scenario of fmu_rules_host.py gives, and what went to stderr."""
    done = play("fmu_rules_host", scenario, fmu)
    return json.loads(done.stdout), done.stderr


@pytest.fixture(scope="module")
def answers(fmu: Path) -> dict[str, Any]:
    """The answers to all that the standard has rules for, from one process."""
    reports, stderr = host("fine_print", fmu)
    return {**reports, "stderr": stderr}


def assert_refused(answer: Any, status: str, message: str) -> None:
    """One line was logged, with the status of the call."""
    [(level, category, line)] = answer[1]
    assert answer[0] == status
    assert (level, category) == LOGGED["error" if status == "ok" else status]  # pythonfmu can only log an error
    assert line.startswith(message)


@both_flavours
def test_calls_out_of_order_are_refused(flavour: Flavour, answers: dict[str, Any]) -> None:
    early, leave, enter, step, again, late, put, length = answers["wrong_order"]
    assert_refused(early, flavour.wrong_step, "fmi2DoStep: must be called in another phase, got instantiated")
    assert_refused(leave, flavour.wrong_call, "fmi2ExitInitializationMode: must be called in another phase, got inst")
    assert_refused(enter, flavour.wrong_call, "fmi2EnterInitializationMode: must be called in another phase, got step")
    if flavour.after_bad_call == "discard":
        assert_refused(step, "discard", "fmi2EnterInitializationMode: must be called in another phase, got stepping (b")
        assert tuple(again) == OK
    else:
        assert tuple(step) == OK
        assert_refused(again, "error", "current_time: must be 1.0, where the last step ended, got 0.0")
    assert_refused(late, flavour.wrong_step, "fmi2DoStep: must be called in another phase, got terminated")
    assert_refused(put, flavour.wrong_call, "fmi2SetReal: must be called in another phase, got terminated")
    assert length == 1.0


@both_flavours
def test_a_fixed_parameter_set_while_stepping_is_refused_with_all_of_its_call(
    flavour: Flavour, answers: dict[str, Any]
) -> None:
    (put, step, next_step), unchanged = answers["fixed_parameter"]
    assert_refused(put, flavour.wrong_call, "rss_position: must not change after initialization, got 0.5")
    if flavour.after_bad_call == "discard":
        assert_refused(
            step, "discard", "rss_position: must not change after initialization, got 0.5 (before this step)"
        )
    else:
        assert tuple(step) == OK
    assert tuple(next_step) == OK
    assert unchanged


@both_flavours
def test_no_step_ends_beyond_the_stop_time(flavour: Flavour, answers: dict[str, Any]) -> None:
    too_far, up_to_it, beyond, rounding = answers["stop_time"]
    assert_refused(too_far, flavour.wrong_step, "current_time + step_size: must be <= 1, got 1.5")
    assert up_to_it == ["ok"] * 10
    assert_refused(beyond, flavour.wrong_step, "current_time + step_size: must be <= 1, got 1.0999")
    assert rounding == "ok"


@both_flavours
def test_a_step_begins_where_the_last_one_ended(flavour: Flavour, answers: dict[str, Any]) -> None:
    (first, repeated, gapped, onward, behind), length = answers["points"]
    assert (tuple(first), tuple(onward), tuple(behind)) == (OK, OK, OK)
    assert_refused(repeated, flavour.wrong_step, "current_time: must be 1.0, where the last step ended, got 0.0")
    assert_refused(gapped, flavour.wrong_step, "current_time: must be 1.0, where the last step ended, got 1.5")
    assert length == pytest.approx(3.0, rel=0, abs=1e-9)


@both_flavours
def test_the_hosts_tolerance_is_taken_unless_it_is_loose_or_the_parameter_is_set(answers: dict[str, Any]) -> None:
    taken, loose, kept, own, restored, matters = answers["tolerance"]
    assert taken == [1e-9, 1e-5, 1e-7]
    [(level, category, line)] = loose[1]
    assert (loose[0], level, category) == ("ok", *LOGGED["warning"])
    assert line == "tolerance: must be 1e-12 to 1e-05, got 0.001; relative_tolerance stays 1e-07"
    assert (kept, own, restored) == (1e-7, 1e-8, 1e-8)
    assert matters


@both_flavours
def test_errors_are_logged_whatever_the_host_has_asked_for(flavour: Flavour, answers: dict[str, Any]) -> None:
    assert_refused(answers["silent"], flavour.wrong_call, "value reference: must be 0 to ")


@both_flavours
def test_signs_that_mean_something_to_a_logger_are_escaped(answers: dict[str, Any]) -> None:
    [(_, _, line)] = answers["signs"][1]
    assert line.startswith("no/Well ##7, ##r0##, 5%%.csv: must be a readable CSV file")


@both_flavours
def test_what_keeps_an_fmu_from_starting_goes_to_stderr_once(answers: dict[str, Any]) -> None:
    lines = answers["stderr"].splitlines()
    told = lines[lines.index("begin") + 1 : lines.index("end")]
    assert told == ["Borehole: flexural_stiffness: must be > 0, got -1.0"]


@both_flavours
def test_instances_leave_the_hosts_path_of_modules_alone(answers: dict[str, Any]) -> None:
    assert answers["path"] == [0, False]


def test_an_interpreter_without_ctypes_runs_it_all_the_same(fmu: Path) -> None:
    (same, refused), _ = host("without_ctypes", fmu)
    assert same
    assert_refused(refused, "discard", "current_time: must be 0.7, where the last step ended, got 0.0")


@both_flavours
def test_every_bound_that_the_description_gives_is_accepted(answers: dict[str, Any]) -> None:
    bounded, refused = answers["bounds"]
    unbounded = {"survey_file"}
    assert set(bounded) == set(scalar_names(PARAMETERS, 2)) - unbounded
    assert refused == {}

"""Schedules of all inputs in case files and CSV files, and steering as tools log it."""

import itertools
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.file import dump_case, files_named, load_case, parse_case
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.case.parameters import parameters, with_parameters
from boreprop.case.schedules import force_schedule
from boreprop.case.tables import read_inputs
from boreprop.core.errors import ParameterError
from boreprop.errors import InputError
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.simulate import simulate

SOURCE = "case.toml"


def with_tables(paper_text: str, drilling: str, rss: str = "", weight: str = "") -> str:
    """The paper's case with more in [drilling], another [rss], and another line for the weight."""
    text = paper_text.partition("[rss]")[0].replace("active_weight_on_bit = 1612.469", weight)
    return text.replace("[hole]", f"{drilling}\n[hole]") + rss


INLINE = (
    "[drilling.schedule]\ndrilled_length = [0, 10]\nactive_weight_on_bit = [2e3, 4e3]\nrate_of_penetration = [1, 2]\n"
)


def test_inputs_stand_in_the_case_file(paper_text: str) -> None:
    case = parse_case(with_tables(paper_text, INLINE), SOURCE)
    weights, rates = ("active_weight_on_bit", (2e3, 4e3)), ("rate_of_penetration", (1.0, 2.0))
    assert case.inputs == InputSchedule((0.0, 10.0), (weights, rates))
    assert case.active_weight_on_bit == 2e3
    assert case.schedule == Schedule()
    linear = parse_case(with_tables(paper_text, 'interpolation = "linear"\n' + INLINE), SOURCE)
    assert linear.inputs == replace(case.inputs, interpolation="linear")


@pytest.mark.parametrize("interpolation", ["held", "linear"])
def test_inputs_stand_in_a_file_by_depth_in_the_units_of_the_rig(
    paper_text: str, tmp_path: Path, interpolation: str
) -> None:
    rows = f"1;0;2.5;0;18\n2;{10 / 0.3048:.12f};7.5;1000;36\n3;{30 / 0.3048:.12f};5;0;9\n".replace(".", ",")
    header = "time;measured_depth_ft;active_weight_on_bit_kN;rss_force_lbf;rate_of_penetration_m_h\n"
    (tmp_path / "log.csv").write_text(header + rows)
    drilling = f'schedule = "log.csv"\ninterpolation = "{interpolation}"'
    (tmp_path / SOURCE).write_text(with_tables(paper_text, drilling))
    case = load_case(tmp_path / SOURCE)
    assert case.inputs is not None
    share = 0.732 if interpolation == "linear" else 0.0  # the bit starts at 7.32 m of 10
    assert case.inputs.drilled_length == pytest.approx((0.0, 2.68, 22.68))
    found = dict(case.inputs.inputs)
    assert found["active_weight_on_bit"] == pytest.approx((2500.0 + share * 5000.0, 7500.0, 5000.0))
    assert found["rate_of_penetration"][1:] == pytest.approx((0.01, 0.0025))
    assert case.schedule.rss_force == pytest.approx((share * 4448.2216152605, 4448.2216152605, 0.0))
    assert case.schedule.interpolation == interpolation
    assert case.active_weight_on_bit == found["active_weight_on_bit"][0]
    assert files_named(tmp_path / SOURCE) == [tmp_path / "log.csv"]


def test_inputs_in_a_file_may_be_called_as_in_a_case_file(tmp_path: Path) -> None:
    by_name, by_key = tmp_path / "name.csv", tmp_path / "key.csv"
    by_name.write_text(
        "drilled_length,rss_force,rss_toolface_deg,bit_tilt_limit_deg,bit_walk_angle_deg\n0,8e3,90,1,2\n"
    )
    by_key.write_text("drilled_length,force_kN,toolface_deg,tilt_limit_deg,walk_angle_deg\n0,8,90,1,2\n")
    assert read_inputs(by_key) == read_inputs(by_name)
    assert read_inputs(by_key)[0] == Schedule((0.0,), (8e3,), rss_toolface=(radians(90),))


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
@pytest.mark.parametrize("interpolation", ["held", "linear"])
def test_schedules_are_kept_with_a_run(paper_text: str, tmp_path: Path, suffix: str, interpolation: str) -> None:
    rss = f'[rss]\ndrilled_length = [0, 3]\nforce = [0, 2e3]\ninterpolation = "{interpolation}"\n'
    case = parse_case(with_tables(paper_text, f'interpolation = "{interpolation}"\n' + INLINE, rss), SOURCE)
    run = simulate(case, length=15.0, sample_interval=0.5)
    write_trajectory(run, tmp_path / f"run.{suffix}")
    kept = read_trajectory(tmp_path / f"run.{suffix}")
    assert kept.case == case
    np.testing.assert_array_equal(kept["active_weight_on_bit"], run["active_weight_on_bit"])
    assert dump_case(parse_case(dump_case(case), "elsewhere.toml")) == dump_case(case)


@pytest.mark.parametrize(
    ("drilling", "rss", "message"),
    [
        ('interpolation = "cubic"', "", "drilling.interpolation: must be held or linear, got 'cubic'"),
        ("", '[rss]\nschedule = "x"\ninterpolation = 1', "rss.interpolation: must be text in quotes, got 1"),
        ("schedule = 3", "", "drilling.schedule: must be text in quotes, got 3"),
        (
            "[drilling.schedule]\ndrilled_length = [0]\n",
            "",
            "drilling.schedule: must hold either drilled_length or measured_depth, and any of rss_force",
        ),
        (
            "[drilling.schedule]\ndrilled_length = [0]\nweight = [1]\n",
            "",
            "drilling.schedule: must hold either drilled_length or measured_depth, and any of rss_force",
        ),
        (
            "[drilling.schedule]\ndrilled_length = [0]\nactive_weight_on_bit = [0]\n",
            "",
            "drilling.schedule.active_weight_on_bit[1]: must be > 0, got 0.0",
        ),
        (
            "[drilling.schedule]\ndrilled_length = [0]\nactive_weight_on_bit = [true]\n",
            "",
            "drilling.schedule.active_weight_on_bit[1]: must be a valid number, got True",
        ),
        (
            "[drilling.schedule]\ndrilled_length = [0]\nrate_of_penetration = [0]\n",
            "",
            "drilling.schedule.rate_of_penetration[1]: must be > 0, got 0.0",
        ),
        (
            "[drilling.schedule]\ndrilled_length = [1]\nrss_force = [0]\n",
            "",
            "drilling.schedule.drilled_length: must start at 0, got (1.0,)",
        ),
        (
            "[drilling.schedule]\nmeasured_depth = [8]\nrss_force = [0]\n",
            "",
            "drilling.schedule.measured_depth: must start at 7.32 or before, where the bit starts, got (8.0,)",
        ),
        (
            "[drilling.schedule]\ndrilled_length = [0]\nrss_force = [0, 1]\n",
            "",
            "drilling.schedule.rss_force: must hold one value per drilled_length, 1 in all, got (0.0, 1.0)",
        ),
        (
            "[drilling.schedule]\ndrilled_length = [0]\nrss_force = [0]\n",
            "[rss]\ndrilled_length = [0]\nforce = [0]\n",
            "rss: must be left out where drilling.schedule gives rss_force, got both",
        ),
    ],
)
def test_what_is_wrong_with_a_schedule_is_said(paper_text: str, drilling: str, rss: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_case(with_tables(paper_text, drilling, rss, "active_weight_on_bit = 1612.469"), SOURCE)
    assert str(caught.value).startswith(f"{SOURCE}: {message}")


def test_a_weight_is_given_once(paper_text: str) -> None:
    with pytest.raises(InputError, match=r"drilling\.active_weight_on_bit: must be left out, or 2000\.0 as .*got 1612"):
        parse_case(with_tables(paper_text, INLINE, weight="active_weight_on_bit = 1612.469"), SOURCE)
    case = parse_case(with_tables(paper_text, INLINE, weight="active_weight_on_bit = 2e3"), SOURCE)
    assert case == parse_case(with_tables(paper_text, INLINE), SOURCE)
    force = "[drilling.schedule]\ndrilled_length = [0]\nrss_force = [7]\n"
    with pytest.raises(InputError, match=r"drilling\.active_weight_on_bit: must be given, got nothing"):
        parse_case(with_tables(paper_text, force), SOURCE)
    only_force = parse_case(with_tables(paper_text, force, weight="active_weight_on_bit = 1612.469"), SOURCE)
    assert (only_force.inputs, only_force.schedule.rss_force) == (None, (7.0,))


def test_a_file_without_any_input_is_refused(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text("drilled_length,hook_load\n0,1\n")
    with pytest.raises(InputError, match=r"log\.csv: must have a column 'rss_force' or 'active_weight_on_bit' or "):
        read_inputs(tmp_path / "log.csv")


def test_a_parameter_takes_the_place_of_its_schedule(paper_text: str) -> None:
    case = parse_case(with_tables(paper_text, INLINE), SOURCE)
    assert parameters(case)["active_weight_on_bit"] == 2e3
    changed = with_parameters(case, {"active_weight_on_bit": 5e3})
    assert changed.inputs == InputSchedule((0.0, 10.0), (("rate_of_penetration", (1.0, 2.0)),))
    assert set(simulate(changed, length=15.0)["active_weight_on_bit"]) == {5e3}
    assert with_parameters(case, {"rss_position": 0.5}).inputs == case.inputs


# steering as tools log it


shares = st.lists(st.tuples(st.floats(0.0, 1.0), st.sampled_from([0.0, 180.0, 360.0, -180.0])), min_size=1)


@given(st.floats(0.0, 5e4), shares)
def test_a_tool_pushes_up_or_down_for_its_share_of_the_time(full: float, log: list[tuple[float, float]]) -> None:
    duty, toolface = zip(*log, strict=True)
    columns = {"drilled_length": tuple(map(float, range(len(log)))), "duty": duty, "toolface_deg": toolface}
    schedule = force_schedule(columns, None, "held", full)
    up = np.cos(np.radians(toolface))
    np.testing.assert_allclose(schedule.rss_force, full * np.array(duty) * up, rtol=1e-12)
    assert not schedule.steers_in_space


def steering(rest: str) -> str:
    return f"[rss]\nfull_force = 2e4\n{rest}\n"


@pytest.mark.parametrize("place", ["inline", "file"])
@pytest.mark.parametrize("length", ["drilled_length", "measured_depth"])
def test_duty_and_toolface_give_the_force(paper_text: str, tmp_path: Path, place: str, length: str) -> None:
    starts = [0.0, 5.0, 9.0] if length == "drilled_length" else [1.0, 12.32, 16.32]
    columns = {length: starts, "duty": [0.5, 1.0, 0.25], "toolface_deg": [0, 180, 0]}
    rest = "\n".join(f"{key} = {values}" for key, values in columns.items())
    if place == "file":
        rows = itertools.chain([columns], zip(*columns.values(), strict=True))
        (tmp_path / "log.csv").write_text("\n".join(",".join(map(str, row)) for row in rows))
        rest = 'schedule = "log.csv"'
    case = parse_case(with_tables(paper_text, "", steering(rest), "active_weight_on_bit = 2e3"), tmp_path / SOURCE)
    assert case.schedule.drilled_length == pytest.approx((0.0, 5.0, 9.0))
    assert case.schedule.rss_force == (1e4, -2e4, 5e3)


@pytest.mark.parametrize(
    ("rest", "message"),
    [
        ("drilled_length = [0]\nduty = [65]\ntoolface_deg = [0]", "rss.duty[1]: must be <= 1, got 65.0"),
        (
            "drilled_length = [0]\nduty = [1]\ntoolface_deg = [0, 0]",
            "rss.toolface_deg: must hold one value per duty, 1 in all, got (0.0, 0.0)",
        ),
        (
            "drilled_length = [0]\nforce = [0]",
            "rss.full_force: must be given with duty and toolface_deg, and only w",
        ),
        ("drilled_length = [0]\nduty = [0]", "rss: must hold either drilled_length and force, or "),
    ],
)
def test_what_is_wrong_with_steering_is_said(paper_text: str, rest: str, message: str) -> None:
    text = with_tables(paper_text, "", steering(rest), "active_weight_on_bit = 2e3")
    with pytest.raises(InputError) as caught:
        parse_case(text, SOURCE)
    assert str(caught.value).startswith(f"{SOURCE}: {message}")
    with pytest.raises(InputError, match=r"rss\.full_force: must be given with duty and toolface_deg"):
        parse_case(
            text.replace("full_force = 2e4\n", "").replace(rest, "drilled_length=[0]\nduty=[1]\ntoolface_deg=[0]"),
            SOURCE,
        )


def test_the_whole_weight_is_named_by_its_own_key_beside_a_schedule(paper_text: str) -> None:
    text = with_tables(paper_text, "weight_on_bit = 1e3\n" + INLINE)
    with pytest.raises(InputError, match=r"case.toml: drilling.weight_on_bit: must be >= 2000, got 1000.0"):
        parse_case(text, SOURCE)


def test_a_negative_force_and_one_of_another_kind_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"full_force: must be >= 0, got -1\.0"):
        force_schedule({"drilled_length": (0.0,), "duty": (1.0,), "toolface_deg": (0.0,)}, None, "held", -1.0)
    with pytest.raises(ParameterError, match="interpolation: must be held or linear, got 'spline'"):
        Schedule((0.0,), (0.0,), "spline")


def test_a_case_made_in_python_checks_its_schedules(case: Case) -> None:
    with pytest.raises(ParameterError, match=r"active_weight_on_bit\[2\]: must be > 0, got -1"):
        replace(case, inputs=InputSchedule((0.0, 1.0), (("active_weight_on_bit", (1.0, -1.0)),)))


def test_the_whole_weight_which_is_held_bears_what_drills_up_to_the_next_entry() -> None:
    """Before, rows decided: a run was refused where one lay beyond the place at which the active weight passed it."""
    weights = ("active_weight_on_bit", (2e3, 3e3)), ("weight_on_bit", (2.5e3, 4e3))
    assert InputSchedule((0.0, 10.0), weights).inputs == weights
    with pytest.raises(ParameterError, match=r"weight_on_bit\[1\]: must be >= 3000, got 2500\.0"):
        InputSchedule((0.0, 10.0), weights, "linear")

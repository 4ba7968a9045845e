"""Bit and rock by depth: [[formation]] in a case file, and their columns in its schedule."""

from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.case.file import dump_case, load_case, parse_case
from boreprop.case.formations import Formation
from boreprop.case.inputs import InputSchedule
from boreprop.case.paper import paper_case
from boreprop.case.parameters import parameters, with_parameters
from boreprop.errors import InputError
from boreprop.run.simulate import simulate

LAYERS = """
[[formation]]
measured_depth = 0.0
tilt_limit_deg = 1.5

[[formation]]
measured_depth              = 12.0
lateral_steering_resistance = 20.0

[[formation]]
measured_depth              = 20.0
angular_steering_resistance = 0.5
tilt_limit_deg              = 0.25
"""


def with_text(text: str) -> Case:
    """The paper's case, its bit at 7.32 m, with more text in its file."""
    return parse_case(dump_case(paper_case()) + text, Path("case.toml"))


def test_a_formation_holds_from_its_depth_on_and_changes_what_it_gives() -> None:
    run = simulate(with_text(LAYERS), length=16.0, sample_interval=0.01)
    depth = run["drilled_length"] + 7.32
    assert run["lateral_steering_resistance"].tolist() == np.where(depth < 12.0 - 1e-6, 10.0, 20.0).tolist()
    assert run["angular_steering_resistance"].tolist() == np.where(depth < 20.0 - 1e-6, 1.0, 0.5).tolist()
    limit = np.where(depth < 20.0 - 1e-6, radians(1.5), radians(0.25))
    assert run["bit_tilt_limit"].tolist() == limit.tolist()


def test_formations_are_a_schedule_by_depth(engine: str) -> None:
    rock = (("lateral_steering_resistance", (10.0, 20.0, 20.0)), ("bit_tilt_limit", (radians(1.5),) * 2 + (0.004,)))
    scheduled = replace(paper_case(), inputs=InputSchedule((0.0, 12.0 - 7.32, 20.0 - 7.32), rock))
    layers = (Formation(7.0, tilt_limit=radians(1.5)), Formation(12.0, 20.0), Formation(20.0, tilt_limit=0.004))
    case = replace(paper_case(), formations=layers)
    assert case.bit == scheduled.bit
    one, other = (simulate(c, engine=engine, length=16.0, sample_interval=0.5) for c in (case, scheduled))
    for name in other:
        assert one[name].tolist() == other[name].tolist()


def test_the_bit_starts_in_the_last_of_thin_layers_that_begin_millimetres_below_it(engine: str) -> None:
    rock = {-0.001: 15.0, 0.001: 20.0, 0.003: 30.0, 2.0: 40.0}
    layers = tuple(Formation(None, eta, true_vertical_depth=top) for top, eta in rock.items())
    run = simulate(replace(paper_case(), formations=layers), engine=engine, length=4.0, sample_interval=0.5)
    expected = np.where(run["true_vertical_depth"] < 2.0, 30.0, 40.0)
    assert run["lateral_steering_resistance"].tolist() == expected.tolist()
    assert set(expected) == {30.0, 40.0}


def test_a_case_with_formations_is_written_and_read_back() -> None:
    case = with_text(LAYERS)
    assert parse_case(dump_case(case), Path("again.toml")) == case


def test_a_parameter_takes_the_place_of_what_formations_say_of_it() -> None:
    case = with_parameters(with_text(LAYERS), {"lateral_steering_resistance": 7.0, "bit_tilt_limit": 0.01})
    assert case.formations == (Formation(20.0, angular_steering_resistance=0.5),)
    assert parameters(case)["lateral_steering_resistance"] == 7.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[formation]\nmeasured_depth = 1.0", "formation: must be tables [[formation]], got"),
        (
            "[[formation]]\ntilt_limit_deg = 1.0",
            "formation[1].measured_depth: must be given, or true_vertical_depth, and not both, got nothing",
        ),
        (
            "[[formation]]\nmeasured_depth = 1.0",
            "formation[1].lateral_steering_resistance: must be given, or another of",
        ),
        ("[[formation]]\nmeasured_depth = 1.0\nhardness = 3", "formation[1].hardness: must be one of measured_depth, "),
        ("[[formation]]\nmeasured_depth = 1.0\ntilt_limit_deg = 'a'", "formation[1].tilt_limit_deg: must be a number"),
        ("[[formation]]\nmeasured_depth = 1.0\ntilt_limit_deg = -1", "tilt_limit_deg: must be > 0, <= 90, got -1"),
        (
            "[[formation]]\nmeasured_depth = 1.0\nlateral_steering_resistance = 0.0",
            "formation[1].lateral_steering_resistance: must be > 0, got 0.0",
        ),
        (LAYERS.replace("20.0", "9.0"), "formation: measured_depth: must increase, got"),
    ],
)
def test_a_formation_that_cannot_be_is_refused_with_its_key(text: str, message: str) -> None:
    with pytest.raises(InputError) as refused:
        with_text("\n" + text)
    assert f"case.toml: {message}" in str(refused.value) or message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_formations_and_a_schedule_of_the_same_property_are_refused() -> None:
    inputs = InputSchedule((0.0, 5.0), (("bit_tilt_limit", (0.01, 0.02)),))
    with pytest.raises(InputError, match="bit_tilt_limit: must be given by formations or a schedule, not by both"):
        parse_case(dump_case(replace(paper_case(), inputs=inputs)) + LAYERS, Path("case.toml"))


def test_a_schedule_in_a_file_has_columns_of_bit_and_rock(tmp_path: Path) -> None:
    text = dump_case(paper_case()).replace("lateral_steering_resistance = 10.0\n", "")
    text = text.replace("tilt_limit_deg = 2.0\n", "").replace("[drilling]\n", '[drilling]\nschedule = "log.csv"\n')
    (tmp_path / "case.toml").write_text(text)
    header = "measured_depth,lateral_steering_resistance,bit_tilt_limit_deg\n"
    (tmp_path / "log.csv").write_text(header + "0,10,2\n10,25,0.5\n")
    case = load_case(tmp_path / "case.toml")
    assert case.bit == paper_case().bit
    assert case.inputs == InputSchedule(
        (0.0, 10.0 - 7.32),
        (("lateral_steering_resistance", (10.0, 25.0)), ("bit_tilt_limit", (radians(2.0), radians(0.5)))),
    )


def test_a_bit_that_is_not_that_of_the_schedule_at_the_start_is_refused() -> None:
    text = dump_case(paper_case()).replace(
        "[drilling]\n", "[drilling]\nschedule = {drilled_length = [0.0], bit_tilt_limit_deg = [1.0]}\n"
    )
    with pytest.raises(InputError, match=r"bit.tilt_limit_deg: must be left out, or 1.0 as drilling.schedule has it"):
        parse_case(text, Path("case.toml"))


def test_a_scheduled_limit_that_no_number_of_degrees_gives_is_read_back() -> None:
    inputs = InputSchedule((0.0, 5.0), (("bit_tilt_limit", (0.00884345491329861, 0.01)),))
    case = replace(paper_case(), inputs=inputs)
    assert parse_case(dump_case(case), Path("case.toml")) == case


DEEP = """
[[formation]]
true_vertical_depth         = 990.0
lateral_steering_resistance = 20.0

[[formation]]
true_vertical_depth = 1010.0
tilt_limit_deg      = 0.25
"""
WEAR = "[bit.wear]\nweight_per_metre = 30.0\nlargest_weight = 500.0\n"


def deep(text: str = DEEP) -> Case:
    """The paper's case, its bit at a true vertical depth of 1000 m, with more text in its file."""
    return parse_case(dump_case(replace(paper_case(), true_vertical_depth=1000.0)) + text, Path("case.toml"))


def test_formations_by_true_vertical_depth_count_from_that_of_the_bit() -> None:
    case = deep()
    assert case.ground is not None
    assert case.ground.tops == (-10.0, 10.0)
    assert case.ground.rock == ((0.0, 0.0, 0.0), (20.0, 0.0, 0.0), (20.0, 0.0, radians(0.25)))
    assert case.bit.lateral_steering_resistance == 20.0  # at the start
    assert "true_vertical_depth = 1000.0" in dump_case(case)


@pytest.mark.parametrize("text", [DEEP, WEAR, WEAR + DEEP])
def test_a_case_with_ground_is_written_and_read_back(text: str) -> None:
    case = deep(text)
    assert case.ground is not None
    assert parse_case(dump_case(case), Path("again.toml")) == case
    assert parse_case(dump_case(case), Path("again.toml")).ground == case.ground


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (DEEP + LAYERS, "formation: true_vertical_depth: must be given of all formations, or of none, got (990.0, "),
        (DEEP.replace("990.0", "1015.0"), "formation: true_vertical_depth: must increase, got (1015.0, 1010.0)"),
        (DEEP.replace("990.0", "'a'"), "formation[1].true_vertical_depth: must be a number, got 'a'"),
        (
            DEEP.replace("= 990.0", "= 990.0\nmeasured_depth = 5.0"),
            "formation[1].measured_depth: must be given, or true_vertical_depth, and not both, got ",
        ),
        (WEAR.replace("500.0", "0.0"), "bit.wear.largest_weight: must be > 0, got 0.0"),
        (WEAR.replace("500.0", "true"), "bit.wear.largest_weight: must be a number, got True"),
        (WEAR.replace("largest_weight = 500.0\n", ""), "bit.wear.largest_weight: must be given, got nothing"),
        (WEAR + "gauge = 1.0\n", "bit.wear.gauge: must be one of weight_per_metre, largest_weight, got 1.0"),
    ],
)
def test_ground_that_cannot_be_is_refused_with_its_key(text: str, message: str) -> None:
    with pytest.raises(InputError) as refused:
        deep("\n" + text)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_wear_that_is_no_table_is_refused() -> None:
    text = dump_case(paper_case()).replace("[bit]\n", "[bit]\nwear = 3.0\n")
    with pytest.raises(
        InputError, match=r"bit\.wear: must be a table with weight_per_metre and largest_weight, got 3\.0"
    ):
        parse_case(text, Path("case.toml"))


def test_a_true_vertical_depth_that_is_no_number_is_refused() -> None:
    text = dump_case(paper_case()).replace("[hole]\n", '[hole]\ntrue_vertical_depth = "deep"\n')
    with pytest.raises(InputError, match=r"hole\.true_vertical_depth: must be a valid number, got 'deep'"):
        parse_case(text, Path("case.toml"))


SCHEDULE = '[drilling]\nschedule = {drilled_length = [0.0, 5.0], "stabilizer_clearance[1]" = [0.00366, 0.008]}\n'


def test_clearances_are_columns_of_a_schedule(tmp_path: Path) -> None:
    inline = parse_case(dump_case(paper_case()).replace("[drilling]\n", SCHEDULE), Path("case.toml"))
    text = dump_case(paper_case()).replace("[drilling]\n", '[drilling]\nschedule = "log.csv"\n')
    (tmp_path / "case.toml").write_text(text)
    (tmp_path / "log.csv").write_text("measured_depth,stabilizer_clearance[1]\n0,3.66e-3\n12.32,8e-3\n")
    clearances = ("stabilizer_clearance[1]", (3.66e-3, 8e-3))
    assert inline.inputs == InputSchedule((0.0, 5.0), (clearances,))
    assert load_case(tmp_path / "case.toml").inputs == InputSchedule((0.0, 5.0), (clearances,))
    assert parse_case(dump_case(inline), Path("again.toml")) == inline
    assert with_parameters(inline, {"stabilizer_clearance[1]": 1e-3}).inputs is None


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        (
            "0.00366, 0.008",
            "0.001, 0.008",
            r"bha.stabilizer_clearances\[1\]: must be 0.001 as drilling.schedule has it",
        ),
        ("0.00366, 0.008", "0.00366, -1.0", r"stabilizer_clearance\[1\]\[2\]: must be >= 0"),
        ("clearance[1]", "clearance[2]", r"stabilizer_clearance\[2\]: must be of one of the 1 non-ideal stabilizers"),
        ("0.00366, 0.008", "0.00366, 'a'", r"stabilizer_clearance\[1\].*must be a valid number, got 'a'"),
    ],
)
def test_clearances_that_cannot_be_are_refused(before: str, after: str, message: str) -> None:
    text = dump_case(paper_case()).replace("[drilling]\n", SCHEDULE.replace(before, after))
    with pytest.raises(InputError, match=message):
        parse_case(text, Path("case.toml"))


def test_clearances_as_wide_as_the_hole_are_refused(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(
        dump_case(paper_case()).replace("[drilling]\n", SCHEDULE.replace("0.008", "0.2"))
    )
    message = r"drilling.schedule.stabilizer_clearance\[1\]: must be < bit.diameter/2 = 0.10795, got 0.2"
    with pytest.raises(InputError, match=message):
        load_case(tmp_path / "case.toml")

"""Completion: a column that is taken away comes back, from formulas that the run was not made with."""

from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from boreprop.case.case import Case
from boreprop.case.formations import Formation
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.core.ground import Wear
from boreprop.core.quantities import BY_NAME, OUTPUTS, scalar_names
from boreprop.core.survey import Survey
from boreprop.core.system import BottomHoleAssembly
from boreprop.errors import InputError
from boreprop.run.completion import FORCE_ROUNDING, complete
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory

Array = NDArray[np.float64]

STEERED = Schedule((0.0, 5.5, 12.0, 17.0), (0.0, 3000.0, -1234.5678912, 0.0))


def variable(scalar_name: str) -> str:
    return scalar_name.partition("[")[0]


def without(run: Trajectory, *variables: str) -> Trajectory:
    return Trajectory({name: c for name, c in run.columns.items() if variable(name) not in variables}, run.case)


def only(run: Trajectory, *variables: str) -> Trajectory:
    return Trajectory({name: c for name, c in run.columns.items() if variable(name) in variables}, run.case)


@pytest.fixture(scope="module")
def runs(case: Case) -> dict[int, Trajectory]:
    """By the number of stabilizers, runs under a force that changes, with contacts and saturation that come and go."""
    bhas = {
        2: case.bha,
        3: BottomHoleAssembly((3.0, 6.5, 11.0), (2e-3, 4e-3), 0.5, 1100.0, 8e6),
    }
    return {n: simulate(replace(case, bha=bha, schedule=STEERED), length=20.0) for n, bha in bhas.items()}


@pytest.fixture(scope="module")
def interbedded(case: Case) -> list[Trajectory]:
    """Runs in rock by depth or by length, with a bit that becomes blunt and clearances that open."""
    layers = (
        Formation(None, 20.0, tilt_limit=0.01, true_vertical_depth=5.0),
        Formation(None, 6.0, tilt_limit=0.003, true_vertical_depth=12.0),
    )
    clearances = ("stabilizer_clearance[1]", (3.66e-3, 0.0, 8e-3))
    rock = ("lateral_steering_resistance", (10.0, 25.0, 5.0)), ("bit_tilt_limit", (0.02, 0.004, 0.01))
    worn = replace(case, schedule=STEERED, wear=Wear(30.0, 400.0))
    opening = InputSchedule((0.0, 6.3, 13.0), (clearances,))
    return [
        simulate(each, length=20.0)
        for each in (
            replace(worn, inputs=opening, formations=layers),
            replace(worn, inputs=InputSchedule((0.0, 6.3, 13.0), (*rock, clearances))),
        )
    ]


def test_what_follows_of_a_row_is_that_of_its_rock_bit_and_clearances(interbedded: list[Trajectory]) -> None:
    changing = ("lateral_steering_resistance", "bit_tilt_limit", "stabilizer_clearance")  # as in files of other tools
    for run in interbedded:
        for missing in (
            ("eta_pi",),
            ("active_weight_on_bit",),
            ("bit_tilt", "borehole_inclination", "bit_tilt_saturation"),
            ("stabilizer_force", "stabilizer_contact"),
        ):
            completed = complete(without(run, *missing, *changing))
            for name in run:
                if variable(name) in missing:
                    scale = max(1.0, float(np.abs(run[name]).max()))
                    np.testing.assert_allclose(completed[name], run[name], rtol=0, atol=1e-8 * scale, err_msg=name)


# Row by row


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("balance", ["bit_lateral_force", "bit_moment"])
def test_the_force_follows_from_either_balance_to_its_rounding(
    runs: dict[int, Trajectory], n: int, balance: str
) -> None:
    run = runs[n]
    assert run.case is not None
    forces = only(run, "drilled_length", "bit_inclination", "average_inclination", "stabilizer_force", balance)
    error = complete(forces)["rss_force"] - run["rss_force"]
    assert np.abs(error).max() <= FORCE_ROUNDING * run.case.bha.force_scale / 2
    assert set(error[np.isin(run["rss_force"], [0.0, 3000.0])]) == {0.0}  # so no force is none, and one held is level


def test_no_force_is_none_in_a_file_of_twelve_digits_too(runs: dict[int, Trajectory]) -> None:
    run = without(runs[2], "rss_force")
    written = {name: np.array([float(f"{value:.12g}") for value in column]) for name, column in run.columns.items()}
    force = complete(Trajectory(written, run.case))["rss_force"]
    assert set(force[runs[2]["rss_force"] == 0.0]) == {0.0}


def test_a_force_on_the_last_stabilizer_is_not_made_up(case: Case) -> None:
    bha = BottomHoleAssembly((5.0,), (), 5.0, 1100.0, 8e6)
    run = simulate(replace(case, bha=bha), length=1.0)
    assert "rss_force" not in complete(without(run, "rss_force")).columns


# of each group as many may go as leave the rest to follow from
GROUPS = (
    (("rss_force", "bit_lateral_force", "bit_moment"), 2),
    (("bit_inclination", "borehole_inclination", "bit_tilt"), 1),
    (("active_weight_on_bit", "eta_pi"), 1),
    (("stabilizer_contact", "stabilizer_deflection", "bit_tilt_saturation"), 3),
)


@given(
    n=st.sampled_from([2, 3]),
    gone=st.tuples(*(st.lists(st.sampled_from(group), max_size=most, unique=True) for group, most in GROUPS)),
    without_contacts=st.booleans(),
)
@settings(max_examples=60, deadline=None)
def test_what_is_taken_away_comes_back(
    runs: dict[int, Trajectory], n: int, gone: tuple[list[str], ...], without_contacts: bool
) -> None:
    run, case = runs[n], runs[n].case
    assert case is not None
    removed = [name for names in gone for name in names]
    if without_contacts and "rss_force" not in removed:
        removed.append("stabilizer_force")
    back = complete(without(run, *removed))
    # a rounded force carries its rounding on: in the paper's numbers all that follows from it is of order one
    scales = {"N": case.bha.force_scale, "N.m": case.bha.force_scale * case.bha.length_scale, "rad": 1.0, "": 1.0}
    for name, column in run.columns.items():
        scale = scales.get(BY_NAME[variable(name)].unit, case.bha.length_scale)
        np.testing.assert_allclose(back[name], column, rtol=0.0, atol=FORCE_ROUNDING * scale, err_msg=name)


def test_the_tilt_follows_from_the_lateral_force(runs: dict[int, Trajectory]) -> None:
    run = runs[2]
    assert set(run["bit_tilt_saturation"]) == {-1.0, 0.0, 1.0}
    back = complete(without(run, "borehole_inclination", "bit_tilt", "bit_tilt_saturation"))
    for name in ("bit_tilt", "borehole_inclination", "bit_tilt_saturation"):
        np.testing.assert_allclose(back[name], run[name], rtol=0.0, atol=1e-12)


def test_in_a_file_of_six_digits_a_tilt_is_at_its_limit_where_it_was(runs: dict[int, Trajectory]) -> None:
    run = without(runs[2], "bit_tilt", "bit_tilt_saturation")
    written = {name: np.array([float(f"{value:.6g}") for value in column]) for name, column in run.columns.items()}
    back = complete(Trajectory(written, run.case))
    np.testing.assert_array_equal(back["bit_tilt_saturation"], runs[2]["bit_tilt_saturation"])


# Along the hole


@pytest.fixture
def arc(case: Case) -> Trajectory:
    """A hole at constant curvature, existing and drilled; only what it is made of and what must be there."""
    curvature, length = 0.01, np.linspace(0.0, 50.0, 26)
    survey = Survey((0.0, 30.0), (0.5 - 30.0 * curvature, 0.5))
    hole = {"drilled_length": length, "borehole_inclination": 0.5 + curvature * length}
    rest = {name: np.zeros(length.size) for name in ("bit_tilt", "stabilizer_force[1]")}
    return Trajectory(hole | rest, replace(case, survey=survey))


def test_in_an_arc_the_hole_is_exact(arc: Trajectory) -> None:
    back, length = complete(arc), arc["drilled_length"]
    behind = (3.66 / 2, 3.66 + 3.66 / 2)  # m, to the middle between bit and stabilizers
    for i, middle in enumerate(behind, 1):
        expected = 0.5 + 0.01 * (length - middle)
        np.testing.assert_allclose(back[f"average_inclination[{i}]"], expected, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(back["borehole_curvature"], 0.01, rtol=0.0, atol=1e-14)
    end = 0.5 + 0.01 * length
    np.testing.assert_allclose(back["displacement"], (cos(0.5) - np.cos(end)) / 0.01, rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(back["true_vertical_depth"], (np.sin(end) - sin(0.5)) / 0.01, rtol=0.0, atol=1e-11)


def test_above_the_survey_the_hole_is_straight(arc: Trajectory, case: Case) -> None:
    run = Trajectory(arc.columns, replace(case, survey=Survey((0.0,), (0.2,))))
    back = complete(run)
    assert back["average_inclination[2]"][0] == pytest.approx(0.2, abs=1e-14)
    assert back["borehole_curvature"][0] == pytest.approx((0.5 - 0.2) / 3.66)


def test_where_the_inclination_jumps_the_hole_has_a_corner(arc: Trajectory, case: Case) -> None:
    # as a tool writes an event: the row before it and the row after it at one length
    columns = {
        "drilled_length": np.array([0.0, 1.0, 1.0, 3.0]),
        "borehole_inclination": np.array([0.0, 0.0, 0.3, 0.3]),
        "bit_tilt": np.zeros(4),
        "stabilizer_force[1]": np.zeros(4),
    }
    back = complete(Trajectory(columns, replace(case, survey=Survey((0.0,), (0.0,)))))
    np.testing.assert_allclose(back["displacement"], [0.0, 0.0, 0.0, 2 * sin(0.3)], atol=1e-15)
    np.testing.assert_allclose(back["true_vertical_depth"], [0.0, 1.0, 1.0, 1 + 2 * cos(0.3)], atol=1e-15)
    np.testing.assert_allclose(back["average_inclination[1]"], [0.0, 0.0, 0.0, 0.3 * 2 / 3.66], atol=1e-15)


def test_a_run_whose_first_row_is_on_its_way_starts_from_the_survey(arc: Trajectory) -> None:
    later = Trajectory({name: column[1:] for name, column in arc.columns.items()}, arc.case)
    whole, rest = complete(arc), complete(later)
    for name in ("displacement", "true_vertical_depth", "average_inclination[2]"):
        np.testing.assert_allclose(rest[name], whole[name][1:], rtol=0.0, atol=1e-12)


def test_the_hole_of_a_run_is_good_to_a_centimetre_and_its_averages_to_a_tenth_of_a_degree(
    runs: dict[int, Trajectory],
) -> None:
    run = runs[2]  # in the first half metre the bit turns by four degrees and back: rows 0.1 m apart hardly show it
    back = complete(without(run, "average_inclination", "displacement", "true_vertical_depth"))
    for name in ("displacement", "true_vertical_depth"):
        assert np.abs(back[name] - run[name]).max() < 0.01
    for i in (1, 2):
        error = back[f"average_inclination[{i}]"] - run[f"average_inclination[{i}]"]
        assert np.degrees(np.abs(error).max()) < 0.1


def test_no_force_is_made_from_averages_that_are_not_exact(runs: dict[int, Trajectory]) -> None:
    back = complete(without(runs[2], "average_inclination", "rss_force"))
    assert "average_inclination[1]" in back.columns
    assert "rss_force" not in back.columns


@pytest.mark.parametrize(
    ("time", "length", "rate"),
    [
        ([0, 1, 2, 4], [0, 1, 3, 3], [1, 2, 0, 0]),
        ([0, 1, 1, 2, 4], [0, 1, 1, 3, 3], [1, 2, 2, 0, 0]),
        ([0, 0, 2, 2, 2], [0, 0, 1, 1, 1], [0.5, 0.5, 0.5, 0.5, 0.5]),
        ([20.0 * k for k in range(9)], [0.1 * k for k in range(9)], [0.005] * 9),
        ([5, 5, 5], [0, 0, 0], None),
        ([5], [0], None),
    ],
)
def test_the_rate_of_penetration_is_that_of_the_rows_to_come(
    case: Case, time: list[float], length: list[float], rate: list[float] | None
) -> None:
    names = ("bit_inclination", *(f"average_inclination[{i}]" for i in (1, 2)), "stabilizer_force[1]")
    columns = {name: np.zeros(len(time)) for name in names}
    columns |= {"time": np.array(time, float), "drilled_length": np.array(length, float)}
    back = complete(Trajectory(columns, case)).columns.get("rate_of_penetration")
    assert (None if back is None else back.tolist()) == rate


# What is there, and what is not


def test_columns_that_are_there_stay_as_they_are_and_come_first(runs: dict[int, Trajectory]) -> None:
    run = without(runs[3], "rss_force", "displacement", "stabilizer_contact")
    columns = {name: np.full(run.row_count, 0.01) for name in run.columns if name != "average_inclination[2]"}
    columns["drilled_length"] = run["drilled_length"]
    back = complete(Trajectory(columns, run.case))
    assert list(back.columns)[: len(columns)] == list(columns)
    assert all(back[name] is column for name, column in columns.items())
    assert set(back.columns) >= {*scalar_names(OUTPUTS, 3)}


def test_what_nothing_determines_stays_missing(runs: dict[int, Trajectory]) -> None:
    run = only(runs[2], "drilled_length", "bit_inclination", "average_inclination", "stabilizer_force")
    assert set(complete(run).columns) == {*run.columns, "stabilizer_contact[1]"}


@pytest.mark.parametrize(
    ("gone", "named"),
    [
        (["drilled_length"], "drilled_length"),
        (["bit_inclination", "bit_tilt", "bit_lateral_force"], "bit_inclination"),
        (["average_inclination", "borehole_inclination", "bit_tilt", "bit_lateral_force"], r"average_inclination\[1\]"),
        (["stabilizer_force", "rss_force"], r"stabilizer_force\[1\]"),
    ],
)
def test_what_must_be_there_is_named(runs: dict[int, Trajectory], gone: list[str], named: str) -> None:
    with pytest.raises(InputError, match=f"^the run must have a column '{named}', got "):
        complete(without(runs[2], *gone))


def test_without_a_case_nothing_can_be_said(runs: dict[int, Trajectory]) -> None:
    with pytest.raises(InputError, match="must come with its case, got none: give it with --case or --fmu"):
        complete(Trajectory(runs[2].columns))

"""A body that comes to the wall while it drills, and a BHA that stands by its contacts alone."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beams_as_built import with_points
from boreprop import paper_case
from boreprop.arrays import Floats
from boreprop.core.errors import CannotContinue, ParameterError
from boreprop.core.options import Options
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.binding import NativeDrilling, lie

pytestmark = pytest.mark.usefixtures("kernel")
PAPER = paper_case()


def drilled(bha: BottomHoleAssembly, tilt_limit: float, largest_step: float) -> Floats:
    """Inclination of the bit and largest force on the body, N, every 0.1 m of a hole that ripples."""
    run = NativeDrilling(
        bha,
        replace(PAPER.bit, tilt_limit=tilt_limit),
        PAPER.survey,
        active_weight_on_bit=PAPER.active_weight_on_bit,
        options=replace(Options(1e-8), largest_step=largest_step),
    )
    table = []
    for length in np.linspace(0.1, 10.0, 100).tolist():
        run.advance(length, 0.0, PAPER.active_weight_on_bit)
        outputs = run.outputs()
        table.append((outputs["bit_inclination"], outputs["body_contact_force"]))
    return np.array(table)


@given(
    points=st.lists(st.integers(1, 68), min_size=1, max_size=20, unique=True).map(sorted),
    clearance=st.floats(5e-3, 6e-2),
    tilt_limit=st.floats(0.003, 0.035),
)
def test_no_touch_is_missed_between_the_ends_of_steps(points: list[int], clearance: float, tilt_limit: float) -> None:
    """Steps of 4 cm see every one. A body that touches the wall turns the hole, which would show from there on."""
    bha = with_points(PAPER.bha, [0.5 + 0.1 * k + 1e-3 for k in points], clearance)
    usual, fine = (drilled(bha, tilt_limit, largest) for largest in (1.0, 0.01))
    np.testing.assert_allclose(usual[:, 0], fine[:, 0], atol=1e-5)
    np.testing.assert_allclose(usual[:, 1], fine[:, 1], atol=30.0)


def pressed(
    stabilizers: tuple[float, ...], clearances: tuple[float, ...], weight: float, force: float, largest: float = 1.0
) -> NativeDrilling:
    """Two metres of a hole at 17° under more weight than the BHA bears without its stabilizers."""
    uniform = BottomHoleAssembly(stabilizers, clearances, 0.5, 1000.0, 1e7, axial_load=True)
    bha = with_points(uniform, (stabilizers[-1] * (np.arange(8) + 0.4) / 8).tolist(), 0.03)
    survey, bit = Survey((0.0, stabilizers[-1] + 10.0), (0.3, 0.3)), BitRock(20.0, 1.0, 0.02)
    options = replace(Options(), largest_step=largest)
    run = NativeDrilling(
        bha, bit, survey, active_weight_on_bit=1e4, weight_on_bit=weight, rss_force=force, options=options
    )
    run.advance(2.0, force, 1e4, weight_on_bit=weight)
    return run


def test_a_touch_is_seen_where_a_point_comes_by_the_start_of_the_step() -> None:
    """There the hole that it passes turns sharply: it is at the wall just before, and not at the end of the step."""
    usual, fine = (pressed((13.0, 33.0, 40.0), (5e-3, 5e-3), 532e3, 5e3, largest).outputs() for largest in (1.0, 0.01))
    assert usual["bit_lateral_force"] == pytest.approx(fine["bit_lateral_force"], abs=0.1)


def test_a_force_that_hardly_changes_moves_nothing_where_there_are_other_ways_to_lie() -> None:
    run = pressed((10.0, 20.0), (1e-2,), 1.033e6, -5e3)
    before = run.outputs()["bit_lateral_force"]
    run.advance(2.0, -5e3 + 1e-3, 1e4, weight_on_bit=1.033e6)
    assert run.outputs()["bit_lateral_force"] == pytest.approx(before, abs=0.1)


SLENDER = BottomHoleAssembly((2.0, 14.0, 26.0), (2e-3, 2e-3), 0.5, 800.0, 4e6, axial_load=True)


def borne(bha: BottomHoleAssembly) -> float:
    """The weight on bit under which a BHA buckles with its stabilizers held, N."""
    with pytest.raises(ParameterError) as refused:
        lie(
            bha,
            np.zeros((1, len(bha.stabilizer_positions))),
            np.zeros(1),
            np.zeros(1),
            weight_on_bit=1e12,
            inclination=0.3,
        )
    assert refused.value.problem
    return refused.value.problem.limit


def slender(weight_on_bit: float, rss_force: float, bha: BottomHoleAssembly = SLENDER) -> NativeDrilling:
    """Sixty metres of a hole at 17°."""
    survey, bit, active = Survey((0.0, 26.0, 40.0), (0.3, 0.3, 0.3)), BitRock(10.0, 1.0, 0.02), weight_on_bit / 3
    run = NativeDrilling(
        bha, bit, survey, active_weight_on_bit=active, weight_on_bit=weight_on_bit, rss_force=rss_force
    )
    run.advance(60.0, rss_force, active, weight_on_bit=weight_on_bit)
    return run


def test_a_bha_that_comes_free_where_it_would_buckle_is_refused_with_what_it_would_bear() -> None:
    without_second = replace(SLENDER, stabilizer_positions=(2.0, 26.0), stabilizer_clearances=(2e-3,))
    limit = borne(without_second)
    assert limit < 1.6e5 < borne(SLENDER)
    with pytest.raises(CannotContinue, match=r"at 12\.\d* m the BHA comes free of the wall at a stabilizer") as stopped:
        slender(1.6e5, -1e4)
    assert stopped.value.problem.limit == pytest.approx(limit, rel=1e-5)
    assert slender(0.9 * limit, -1e4).drilled_length == 60.0


def test_the_load_under_which_a_bha_would_buckle_without_its_stabilizers_is_one_like_others() -> None:
    """Held at the last stabilizer only, it answers no force there."""
    critical = borne(replace(SLENDER, stabilizer_positions=(26.0,), stabilizer_clearances=()))
    at, near = (slender(critical * factor, 0.0).outputs() for factor in (1.0, 1.0 + 1e-7))
    for name, value in at.items():
        assert value == pytest.approx(near[name], rel=1e-5, abs=1e-6), name


def test_a_long_string_on_the_wall_at_many_points_drills_on() -> None:
    """Of these supports a matrix of their compliances has a condition number of 1e9 and more."""
    bha = replace(
        with_points(
            BottomHoleAssembly((1.5, 25.0, 60.0), (1e-3, 2e-3), 0.5, 400.0, 1.5e6),
            [2.0 + 0.5 * k + 1e-3 for k in range(110)],
            0.02,
        ),
        axial_load=True,
    )
    run = slender(2e4, 3e3, bha)
    assert run.outputs()["wall_distance"] == pytest.approx(0.0, abs=1e-9)
    assert run.outputs()["body_contact_force"] > 100.0
    assert run.statistics.accepted < 4_000


def lying_down(largest_step: float) -> float:
    """Inclination of the bit where a limp string, off the wall at first, has drilled down onto it along its length."""
    bha = with_points(
        BottomHoleAssembly((20.0, 40.0), (0.0,), 0.5, 1500.0, 1e6), [1.0 + 0.37 * k for k in range(100)], 0.01
    )
    survey, options = Survey((0.0, 40.0, 50.0), (0.0, 0.0, 0.01)), replace(Options(1e-8), largest_step=largest_step)
    run = NativeDrilling(bha, BitRock(10.0, 1.0, 0.02), survey, active_weight_on_bit=2e4, options=options)
    run.advance(1.0, 0.0, 2e4)
    return float(run.outputs()["bit_inclination"])


def test_a_step_along_which_more_points_come_to_the_wall_than_there_is_room_for_is_taken_shorter() -> None:
    """Once the first ones lie on the wall, they keep the others off it."""
    assert lying_down(1.0) == pytest.approx(lying_down(1e-3), abs=1e-7)


def test_more_contacts_than_there_is_room_for_are_too_crowded_and_not_buckling() -> None:
    points = [1.0 + 0.37 * k for k in range(100)]
    bha = with_points(BottomHoleAssembly((20.0, 40.0), (0.0,), 0.5, 1500.0, 1e4), points, 0.01)
    with pytest.raises(CannotContinue, match="more than 58 supports touch the wall"):
        lie(bha, np.zeros((1, len(points) + 2)), np.zeros(1), np.ones(1))
    with pytest.raises(CannotContinue, match="more than 58 supports touch the wall"):
        NativeDrilling(bha, BitRock(10.0, 1.0, 0.02), Survey((0.0, 40.0), (1.5, 1.5)), active_weight_on_bit=2e4)


def test_a_weight_that_grows_on_the_way_beyond_what_the_bha_bears_is_refused_with_the_limit() -> None:
    run, limit = slender(5e4, 0.0), borne(SLENDER)
    with pytest.raises(ParameterError, match=r"^weight_on_bit: must be < .*, where the BHA buckles") as refused:
        run.advance(70.0, 0.0, 5e4 / 3, weight_on_bit=1.001 * limit)
    assert refused.value.problem
    assert refused.value.problem.limit == pytest.approx(limit, rel=1e-6)
    run.advance(61.0, 0.0, 5e4 / 3, weight_on_bit=5e4)

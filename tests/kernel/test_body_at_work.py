"""A body that comes to the wall while it drills, and a BHA that stands by its contacts alone."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boreprop import paper_case
from boreprop.arrays import Floats
from boreprop.core.errors import CannotContinue, ParameterError
from boreprop.core.options import Options
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.binding import NativeDrilling, lie

pytestmark = pytest.mark.usefixtures("kernel")
PAPER = paper_case()


def with_points(bha: BottomHoleAssembly, points: list[float], clearance: float) -> BottomHoleAssembly:
    """The same with points of the body in one section."""
    return replace(
        bha,
        section_lengths=(bha.stabilizer_positions[-1],),
        section_distributed_weights=(bha.distributed_weight,),
        section_flexural_stiffnesses=(bha.flexural_stiffness,),
        section_outer_diameters=(0.0,),
        body_point_positions=tuple(points),
        body_point_clearances=(clearance,) * len(points),
    )


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

"""Systems in which a contact or a saturation that nearly grazes its bound stopped version 0.1: none stops any more."""

from dataclasses import replace

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.core.errors import ParameterError
from boreprop.core.system import BottomHoleAssembly
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped
from fuzz_engines import SPACES, draw, examine
from near_bit import FIELD, NEAR_BIT, near_bit_case
from reference_cases import start

pytestmark = pytest.mark.usefixtures("kernel")

# a touch within one relaxation length, at 7.27 m; a kink 1e-9 ahead, nearer than the shortest step, at 1373 m
GRAZING = {
    "pos": [0.994, 5.679, 10.739, 20.199], "y": [0.002, 0.00337, 0.00144], "rss": 0.497, "EI": 1.88e7,
    "W": 3196.0, "psi": 0.589, "inc": 0.0,
}  # fmt: skip
FAR_DOWN = {
    "pos": [0.881, 8.278, 16.104, 22.661], "y": [0.002, 0.0009, 0.00281], "rss": 0.44, "EI": 3.43e7,
    "W": 5340.0, "psi": 1.274, "inc": 0.0,
}  # fmt: skip


def assert_both_engines_agree(case: Case, tolerance: float = 1e-7) -> None:
    python, native = (
        simulate(case, sample_interval=case.length / 100, relative_tolerance=tolerance, engine=engine)
        for engine in ("python", "native")
    )
    for name, column in native.columns.items():
        np.testing.assert_allclose(python[name], column, rtol=1e-7, atol=1e-9 * np.abs(column).max(), err_msg=name)


def test_each_near_bit_bha_that_stopped_drills_on() -> None:
    assert len(NEAR_BIT["fails"]) == 30
    for entry in NEAR_BIT["fails"]:
        assert simulate(near_bit_case(entry), sample_interval=15.0, engine="native").row_count == 101


def test_the_case_file_that_stopped_drills_on() -> None:
    assert simulate(load_case(FIELD / "fail.toml"), sample_interval=5.0, engine="native").row_count == 101


def test_a_touch_shorter_than_the_first_point_of_a_step_is_the_same_in_both_engines() -> None:
    assert_both_engines_agree(near_bit_case(GRAZING, 12.0))


def test_what_comes_after_such_a_touch_does_not_depend_on_the_tolerance() -> None:
    loose, tight = (
        simulate(near_bit_case(GRAZING, 9.0), relative_tolerance=tolerance, engine="native")
        for tolerance in (1e-7, 1e-11)
    )
    np.testing.assert_allclose(loose["bit_inclination"], tight["bit_inclination"], atol=1e-6)


def test_a_kink_nearer_than_the_shortest_step_far_down_the_hole_is_passed() -> None:
    assert simulate(near_bit_case(FAR_DOWN, 1400.0), sample_interval=14.0, engine="native").row_count == 101


def test_python_passes_a_kink_nearer_than_the_shortest_step() -> None:
    """As far down the hole, with shorter steps forbidden instead."""
    model = start("steering_two_stabilizers", smallest_step=1e-6)
    model.advance(5.0)
    model.steer(model.F_rss + 1e-3, model.eta_pi)
    model.advance(5.0 + 4e-6)
    model.steer(model.F_rss - 3e-3, model.eta_pi)
    model.advance(9.0)
    assert model.xi == 9.0


def test_rows_far_apart_take_no_more_memory_than_there_is() -> None:
    """In a steep hole the origin of Y moves every few metres, and the pieces of the hole with it."""
    steep = near_bit_case(
        {"pos": [0.919, 9.769, 19.19, 23.699], "y": [0.002, 0.00355, 0.00076], "rss": 0.459, "EI": 7.95e6}
        | {"W": 680.0, "psi": 0.777, "inc": 103.0},
        1200.0,
    )
    far, near = (simulate(steep, sample_interval=interval, engine="native") for interval in (1200.0, 100.0))
    assert far["borehole_inclination"][-1] == near["borehole_inclination"][-1]


@pytest.mark.parametrize("space", SPACES)
def test_random_systems_do_not_fail_and_both_engines_agree(space: str) -> None:
    for number in range(120):
        case, _ = draw(space, 19, number)
        if case.length > 1e3:
            continue
        found = examine(space, 19, number, number < 6)
        assert found.fault is None, number


@pytest.mark.parametrize("positions", [(3.66, 3.6601, 3.6602, 7.32), (3.66, 3.669), (0.005, 7.32)])
def test_stabilizers_closer_than_a_centimetre_are_refused(positions: tuple[float, ...]) -> None:
    why = "stabilizer_position: must be at least 0.01 m from each other and from the bit, got "
    with pytest.raises(ParameterError, match=why):
        BottomHoleAssembly(positions, (1e-3,) * (len(positions) - 1), 0.0, 1080.0, 7.2e6)


def test_a_centimetre_is_enough_whatever_rounding_makes_of_it(case: Case) -> None:
    near = BottomHoleAssembly((0.01, 4.34, 4.35, 9.0), (1e-3, 1e-3, 1e-3), 0.0, 1080.0, 7.2e6)
    assert near.stabilizer_positions[2] - near.stabilizer_positions[1] < 0.01
    assert_both_engines_agree(replace(case, bha=replace(near, stabilizer_positions=(3.0, 4.34, 4.35, 9.0)), length=9.0))


def test_the_engines_say_the_same_where_the_bit_turns_over(case: Case) -> None:
    pushed = replace(case, schedule=replace(case.schedule, rss_force=(1e9,)))
    messages = {engine: message(pushed, engine) for engine in ("python", "native")}
    assert messages["python"] == messages["native"]
    for word in ("the bit turns over at ", " m: ", "beyond a full turn", "rss_force", "active_weight_on_bit"):
        assert word in messages["native"]


def message(case: Case, engine: str) -> str:
    with pytest.raises(Stopped) as caught:
        simulate(case, engine=engine)
    return str(caught.value)

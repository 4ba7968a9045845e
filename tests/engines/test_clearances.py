"""Clearances that change along a run, on either engine."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.case.paper import paper_case
from boreprop.core.errors import ParameterError
from boreprop.core.options import Options
from boreprop.run.engines import start
from boreprop.run.simulate import simulate

PAPER = replace(paper_case(), length=24.0, schedule=Schedule((0.0, 4.0), (4e3, -2e3)))
ROUNDING = 1e-12  # m


def opening(*clearances: float, lengths: tuple[float, ...] = (0.0, 6.0, 13.3)) -> Case:
    """The paper's case with clearances of its first stabilizer from some lengths on."""
    return replace(PAPER, inputs=InputSchedule(lengths, (("stabilizer_clearance[1]", clearances),)))


@settings(max_examples=8)
@given(clearances=st.tuples(*[st.sampled_from([0.0, 1e-4, 1e-3, 3.66e-3, 1e-2])] * 3))
def test_each_row_obeys_the_clearance_that_it_has(engine: str, clearances: tuple[float, ...]) -> None:
    """0 ≤ F_ℓ ⊥ y* + δ ≥ 0 and 0 ≤ F_u ⊥ y* − δ ≥ 0, (7) and (8)."""
    run = simulate(opening(*clearances), engine=engine, sample_interval=0.05)
    y_star, delta, F = (run[f"stabilizer_{name}[1]"] for name in ("clearance", "deflection", "force"))
    piece = np.searchsorted((6.0 - 1e-6, 13.3 - 1e-6), run["drilled_length"], side="right")
    assert y_star.tolist() == np.array(clearances)[piece].tolist()
    assert (np.abs(delta) <= y_star + ROUNDING).all()
    touching = F != 0.0
    np.testing.assert_allclose(delta[touching], -np.sign(F[touching]) * y_star[touching], atol=ROUNDING)


@pytest.mark.usefixtures("kernel")
def test_engines_agree_on_clearances_that_change() -> None:
    case = opening(1e-3, 0.0, 8e-3)
    native, python = (simulate(case, engine=engine, sample_interval=0.25) for engine in ("native", "python"))
    for name in native:
        scale = max(1.0, float(np.abs(python[name]).max()))
        np.testing.assert_allclose(native[name], python[name], rtol=0, atol=1e-9 * scale, err_msg=name)


def test_rows_lie_anywhere_while_clearances_change(engine: str) -> None:
    case = opening(1e-3, 4e-3, 8e-3)
    few, many = (simulate(case, engine=engine, sample_interval=interval) for interval in (1.0, 0.125))
    for name in few:
        scale = max(1.0, float(np.abs(many[name]).max()))
        np.testing.assert_allclose(few[name], many[name][::8], rtol=0, atol=1e-9 * scale, err_msg=name)


def test_the_curvature_is_that_of_the_rows_though_clearances_change(engine: str) -> None:
    """Θ of one ℓ₁ ago was drilled with other clearances."""
    run = simulate(opening(1e-3, 4e-3, 8e-3), engine=engine, sample_interval=0.183)
    back = 20  # rows in ℓ₁ = 3.66 m
    turn = (run["borehole_inclination"][back:] - run["borehole_inclination"][:-back]) / 3.66
    np.testing.assert_allclose(run["borehole_curvature"][back:], turn, atol=2e-6)  # as a slope of the hole


def test_clearances_that_do_not_change_leave_every_bit(engine: str) -> None:
    plain, scheduled = (
        simulate(case, engine=engine, sample_interval=0.5) for case in (PAPER, opening(3.66e-3, 3.66e-3, 3.66e-3))
    )
    for name in plain:
        assert plain[name].tolist() == scheduled[name].tolist()


def test_a_state_keeps_its_clearances(engine: str) -> None:
    original, other = (start(PAPER, engine, Options()) for _ in range(2))
    original.advance(5.0, 2e3, 2e3)
    original.change_clearances((9e-3,))
    original.advance(9.1, 2e3, 2e3)
    other.restore(original.save())
    for run in (original, other):
        run.advance(14.0, 2e3, 2e3)
        run.change_clearances((1e-3,))
        run.advance(16.0, 2e3, 2e3)
    assert original.outputs() == other.outputs()


@pytest.mark.parametrize("clearances", [(-1e-3,), (float("nan"),), (1e-3, 1e-3)])
def test_bad_clearances_are_refused_and_change_nothing(engine: str, clearances: tuple[float, ...]) -> None:
    run = start(PAPER, engine, Options())
    run.advance(5.0, 2e3, 2e3)
    before = run.outputs()
    with pytest.raises(ParameterError, match="stabilizer_clearance"):
        run.change_clearances(clearances)
    assert run.outputs() == before

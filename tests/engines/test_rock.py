"""Bit and rock that change along the way, on either engine: they enter the law and its bounds only."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.case.paper import paper_case
from boreprop.core.drilling import Drilling
from boreprop.core.options import Options
from boreprop.core.system import BitRock
from boreprop.run.engines import Engine, start
from boreprop.run.simulate import simulate

CASE = replace(paper_case(), length=25.0, schedule=Schedule((0.0, 4.0), (2e3, -1e3)))
LENGTHS = (0.0, 6.5, 15.1)
HARDER = (1.0, 0.4, 2.5)  # factors on η
COLUMNS = ("bit_inclination", "borehole_inclination", "bit_tilt", "stabilizer_force[1]", "displacement")


def rock(case: Case, **factors: tuple[float, ...]) -> Case:
    """The case with properties of bit and rock that are so many times its own at `LENGTHS`."""
    own = {
        "lateral_steering_resistance": case.bit.lateral_steering_resistance,
        "angular_steering_resistance": case.bit.angular_steering_resistance,
        "bit_tilt_limit": case.bit.tilt_limit,
        "active_weight_on_bit": case.active_weight_on_bit,
    }
    inputs = tuple((name, tuple(own[name] * factor for factor in row)) for name, row in factors.items())
    return replace(case, inputs=InputSchedule(LENGTHS, inputs))


INTERBEDDED = rock(
    CASE,
    lateral_steering_resistance=HARDER,
    angular_steering_resistance=(1.0, 1.3, 0.7),
    bit_tilt_limit=(1.0, 0.2, 0.6),
)
assert INTERBEDDED.inputs is not None
GRADUAL = replace(INTERBEDDED, inputs=replace(INTERBEDDED.inputs, interpolation="linear"))
HELD_OR_LINEAR = pytest.mark.parametrize("case", [INTERBEDDED, GRADUAL], ids=["held", "linear"])


@settings(max_examples=6)
@given(resistance=st.tuples(*[st.sampled_from([0.25, 0.5, 1.0, 2.0, 4.0])] * 3))
def test_more_resistance_is_more_weight_to_all_digits(engine: str, resistance: tuple[float, ...]) -> None:
    drilled = [
        simulate(case, engine=engine, length=18.0, sample_interval=0.5)
        for case in (
            rock(CASE, lateral_steering_resistance=resistance, angular_steering_resistance=resistance),
            rock(CASE, active_weight_on_bit=resistance),
        )
    ]
    for name in (*COLUMNS, "eta_pi", "bit_moment"):
        assert drilled[0][name].tolist() == drilled[1][name].tolist()


@HELD_OR_LINEAR
@pytest.mark.usefixtures("kernel")
def test_engines_agree_on_rock_that_changes(case: Case) -> None:
    native, python = (simulate(case, engine=engine, sample_interval=0.25) for engine in ("native", "python"))
    for name in COLUMNS:
        scale = max(1.0, float(np.abs(python[name]).max()))
        np.testing.assert_allclose(native[name], python[name], rtol=0, atol=1e-9 * scale, err_msg=name)


def test_rows_lie_anywhere_in_rock_that_changes(engine: str) -> None:
    few, many = (simulate(INTERBEDDED, engine=engine, sample_interval=interval) for interval in (1.0, 0.125))
    for name in COLUMNS:
        scale = max(1.0, float(np.abs(many[name]).max()))
        np.testing.assert_allclose(few[name], many[name][::8], rtol=0, atol=1e-9 * scale, err_msg=name)


def test_tighter_tolerances_lead_to_the_same_hole(engine: str) -> None:
    usual, tight = (
        simulate(INTERBEDDED, engine=engine, sample_interval=0.5, relative_tolerance=tolerance)
        for tolerance in (1e-7, 1e-10)
    )
    assert usual["bit_inclination"] == pytest.approx(tight["bit_inclination"], abs=2e-6)


@HELD_OR_LINEAR
def test_the_tilt_obeys_the_rock_where_the_bit_is(engine: str, case: Case) -> None:
    """ψ = clip(F_0/(ηΠ), −ψ*, ψ*) with the η and ψ* of the row, (10) and (11)."""
    run = simulate(case, engine=engine, sample_interval=0.1)
    eta_pi = run["lateral_steering_resistance"] * run["active_weight_on_bit"] / CASE.bha.force_scale
    assert run["eta_pi"] == pytest.approx(eta_pi, rel=1e-12)
    limit = run["bit_tilt_limit"]
    tilt = np.clip(run["bit_lateral_force"] / CASE.bha.force_scale / eta_pi, -limit, limit)
    assert run["bit_tilt"] == pytest.approx(tilt, abs=1e-12)
    assert set(run["bit_tilt_saturation"]) == {-1.0, 0.0, 1.0}


@pytest.mark.parametrize(("case", "length"), [(INTERBEDDED, 20.0), (GRADUAL, 5.0)], ids=["held", "linear"])
def test_the_bit_turns_by_the_ratio_of_the_row(engine: str, case: Case, length: float) -> None:
    """εηΠ θ' = M, (17)."""
    run = simulate(case, engine=engine, sample_interval=0.001, length=length)
    scale = run["angular_steering_resistance"] * run["active_weight_on_bit"] * CASE.length_scale**2
    turn = np.gradient(run["bit_inclination"], run["drilled_length"])
    smooth = np.ones(len(turn), bool)
    for change in (0.0, 4.0, *LENGTHS[1:]):
        smooth &= np.abs(run["drilled_length"] - change) > 0.05
    moment = -run["bit_moment"][smooth]
    off = np.abs(moment - (scale * turn)[smooth])
    assert np.quantile(off, 0.9) < 1e-3 * np.abs(moment).max()  # the rest is where kinks come back


CHANGES = {
    "nothing": {},
    "force": {"rss_force": (2e3, -3e3, 1e3)},
    "weight": {"active_weight_on_bit": (2e3, 3e3, 1e3)},
    "rock": {"bit_tilt_limit": (0.02, 0.01, 0.03)},
    "clearance": {"stabilizer_clearance[1]": (2e-3, 3e-3, 4e-3)},
}


def drilled(engine: str, changed: str) -> Engine:
    """A run of three legs in which this input, and no other, changes from leg to leg."""
    values = CHANGES[changed]
    run = start(CASE, engine, Options())
    for k, length in enumerate((*LENGTHS[1:], 40.0)):
        if "stabilizer_clearance[1]" in values:
            run.change_clearances((values["stabilizer_clearance[1]"][k],))
        force, weight, limit = (
            values.get(name, (own,) * 3)[k]
            for name, own in (
                ("rss_force", 2e3),
                ("active_weight_on_bit", CASE.active_weight_on_bit),
                ("bit_tilt_limit", CASE.bit.tilt_limit),
            )
        )
        run.advance(length, force, weight, bit=replace(CASE.bit, tilt_limit=limit))
    return run


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize("changed", CHANGES)
def test_both_engines_take_the_same_steps_whatever_changes(changed: str) -> None:
    python, native = (drilled(engine, changed).statistics for engine in ("python", "native"))
    assert python == native


@pytest.mark.parametrize("changed", CHANGES)
def test_kinks_are_many_once_the_law_has_changed_which_the_force_alone_does_not_make_it(changed: str) -> None:
    run = drilled("python", changed)
    assert isinstance(run, Drilling)
    assert run.integrator.kinks.many == (changed not in ("nothing", "force"))


def test_a_state_saved_in_other_rock_goes_on_as_if_nothing_had_been(engine: str) -> None:
    def begun() -> Engine:
        return start(CASE, engine, Options())

    own = CASE.bit
    soft = BitRock(0.4 * own.lateral_steering_resistance, own.angular_steering_resistance, 0.3 * own.tilt_limit)
    original, other = begun(), begun()
    original.advance(5.0, 2e3, 2e3)
    original.advance(9.1, 2e3, 2e3, bit=soft)
    other.restore(original.save())
    for run in (original, other):
        run.advance(14.0, 2e3, 2e3, bit=soft)
        run.advance(16.0, 2e3, 2e3)
    assert original.outputs() == other.outputs()
    assert original.statistics == other.statistics


def test_a_run_has_columns_of_the_rock_that_changes_only(engine: str) -> None:
    run = simulate(rock(CASE, bit_tilt_limit=HARDER), engine=engine, length=10.0, sample_interval=5.0)
    assert run["bit_tilt_limit"].tolist() == [CASE.bit.tilt_limit * factor for factor in (1.0, 1.0, 0.4)]
    assert "lateral_steering_resistance" not in run

"""Layers of rock by true vertical depth, and the wear of the bit, on either engine."""

from dataclasses import replace
from math import cos, nan, pi, radians
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.formations import Formation
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.case.paper import paper_case
from boreprop.core.errors import ParameterError
from boreprop.core.ground import Wear
from boreprop.core.options import Options
from boreprop.core.survey import Survey
from boreprop.run.engines import start
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped, Trajectory

PAPER = paper_case()
COLUMNS = ("bit_inclination", "borehole_inclination", "bit_tilt", "stabilizer_force[1]", "displacement", "eta_pi")
AT_START = 1000.0  # m of true vertical depth


def inclined(degrees: float, **changed: Any) -> Case:
    """The paper's case at an inclination."""
    survey = Survey((0.0, 20.0), (radians(degrees), radians(degrees)))
    return replace(PAPER, survey=survey, true_vertical_depth=AT_START, length=20.0, **changed)


def layer(depth: float, eta: float = 10.0, chi: float | None = None, tilt: float | None = None) -> Formation:
    """A formation `depth` below the start."""
    return Formation(None, eta, chi, tilt, true_vertical_depth=AT_START + depth)


def assert_same(one: Trajectory, other: Trajectory, every: int = 1, within: float = 1e-9) -> None:
    """All columns are the same, but for rounding."""
    for name in one:
        scale = max(1.0, float(np.abs(one[name]).max()))
        np.testing.assert_allclose(one[name], other[name][::every], rtol=0, atol=within * scale, err_msg=name)


LAYERED = inclined(
    70.0,
    formations=(layer(-1.0, 20.0, tilt=0.01), layer(1.7, 5.0), layer(3.1, 25.0, 2.0)),
    schedule=Schedule((0.0, 6.0), (5e3, -3e3)),
    wear=Wear(20.0, 250.0),
)


@settings(max_examples=15)
@given(
    degrees=st.floats(0.0, 150.0),
    force=st.floats(-1e4, 1e4),
    depths=st.lists(st.floats(-9.0, 9.0), min_size=1, max_size=8, unique=True).map(sorted),
    etas=st.lists(st.sampled_from([5.0, 10.0, 20.0]), min_size=8, max_size=8),
)
def test_the_bit_is_in_the_layer_of_its_depth(
    engine: str, degrees: float, force: float, depths: list[float], etas: list[float]
) -> None:
    depths = [depth for k, depth in enumerate(depths) if not k or depth - depths[k - 1] > 0.5]
    formations = tuple(layer(depth, eta) for depth, eta in zip(depths, etas, strict=False))
    case = inclined(degrees, formations=formations, schedule=Schedule((0.0,), (force,)))
    run = simulate(case, engine=engine, length=10.0, sample_interval=0.05)
    depth = run["true_vertical_depth"]
    number = np.searchsorted(depths, depth, side="right")
    clear = np.abs(depth[:, None] - depths).min(axis=1) > 0.011  # just beyond a boundary the bit stays for 0.01 m
    assert run["formation"][clear].tolist() == number[clear].tolist()


@pytest.mark.parametrize("degrees", [0.0, 35.0, 130.0])
def test_a_bit_that_goes_straight_meets_a_layer_where_its_measured_depth_says(engine: str, degrees: float) -> None:
    """Without weight and force nothing turns the bit until a stabilizer is loaded: z = L cos Θ exactly.

    Contacts are located within 10⁻¹² ℓ₁, which forces feel some thousand times.
    """
    down = cos(radians(degrees))
    lengths, etas = (0.77, 3.33, 7.97), (25.0, 4.0, 15.0)
    formations = tuple(layer(length * down, eta) for length, eta in zip(lengths, etas, strict=True))
    if down < 0.0:  # from a third layer into others above it, and at last above them all, where it is as at the start
        formations = tuple(layer(length * down, eta) for length, eta in zip(lengths, (30.0, *etas), strict=False))[::-1]
        etas = (*etas[:2], 30.0)
    light = replace(PAPER.bha, distributed_weight=0.0)
    layered = inclined(degrees, bha=light, formations=formations, schedule=Schedule((0.0, 10.0), (0.0, 3e3)))
    first = layered.bit.lateral_steering_resistance
    met = InputSchedule((0.0, *lengths), (("lateral_steering_resistance", (first, *etas)),))
    scheduled = replace(layered, formations=(), inputs=met)
    one, other = (simulate(case, engine=engine, sample_interval=0.1) for case in (layered, scheduled))
    for name in COLUMNS:
        scale = max(1.0, float(np.abs(other[name]).max()))
        bar = 1e-8 if "force" in name else 1e-9
        np.testing.assert_allclose(one[name], other[name], rtol=0, atol=bar * scale, err_msg=name)


@pytest.mark.usefixtures("kernel")
def test_engines_agree_on_layers_and_wear() -> None:
    native, python = (simulate(LAYERED, engine=engine, sample_interval=0.25) for engine in ("native", "python"))
    assert set(native["formation"]) == {1.0, 2.0, 3.0}
    assert_same(native, python, within=2e-8)  # rounding moves a boundary by 1e-13 m, and with it the ends of steps


def test_rows_lie_anywhere_in_layers(engine: str) -> None:
    few, many = (simulate(LAYERED, engine=engine, sample_interval=interval) for interval in (1.0, 0.0625))
    assert_same(few, many, 16)


def test_a_resistance_that_is_scheduled_changes_evenly_through_layers_and_wear(engine: str) -> None:
    lengths, etas = (0.0, 8.0, 20.0), (10.0, 30.0, 5.0)
    ramp = InputSchedule(lengths, (("lateral_steering_resistance", etas),), "linear")
    chis = ((1.7, 0.4), (3.1, 2.0))
    layers = tuple(replace(layer(depth, chi=chi), lateral_steering_resistance=None) for depth, chi in chis)
    case = replace(LAYERED, formations=layers, inputs=ramp)
    run, few = (simulate(case, engine=engine, sample_interval=interval) for interval in (0.125, 1.0))
    eta, blunt = np.interp(run["drilled_length"], lengths, etas), np.minimum(20.0 * run["drilled_length"], 250.0)
    np.testing.assert_allclose(run["lateral_steering_resistance"], eta, rtol=1e-12)
    weight = run["active_weight_on_bit"] - blunt
    np.testing.assert_allclose(run["eta_pi"], eta * weight / case.bha.force_scale, rtol=1e-12)
    assert set(run["formation"]) == {0.0, 1.0, 2.0}
    assert_same(few, run, 8)


def test_no_layer_stands_in_for_what_changes_along_the_way(engine: str) -> None:
    """Not where it has the value for which one does, either."""
    run = start(LAYERED, engine, Options(), LAYERED.ground)
    eta = LAYERED.bit.lateral_steering_resistance
    run.advance(4.0, 5e3, 2e3, lateral_steering_resistance_slope=0.5)
    assert run.outputs()["eta_pi"] == pytest.approx((eta + 2.0) * (2e3 - 80.0) / LAYERED.bha.force_scale, rel=1e-12)


def test_a_run_has_the_rock_of_each_row(engine: str) -> None:
    """ηΠ = η (W − G)/F* and ψ = clip(F_0/(ηΠ), −ψ*, ψ*) with what the columns say of the row, (3), (10) and (11)."""
    run = simulate(LAYERED, engine=engine, sample_interval=0.05)
    blunt = np.minimum(20.0 * run["drilled_length"], 250.0)
    eta_pi = run["lateral_steering_resistance"] * (run["active_weight_on_bit"] - blunt) / LAYERED.bha.force_scale
    np.testing.assert_allclose(run["eta_pi"], eta_pi, rtol=1e-12)
    tilt = run["bit_lateral_force"] / LAYERED.bha.force_scale / eta_pi
    np.testing.assert_allclose(run["bit_tilt"], np.clip(tilt, -0.01, 0.01), atol=1e-12)
    eta, chi = np.array([nan, 20.0, 5.0, 25.0]), np.array([nan, 1.0, 1.0, 2.0])
    number = run["formation"].astype(int)
    assert run["lateral_steering_resistance"].tolist() == eta[number].tolist()
    assert run["angular_steering_resistance"].tolist() == chi[number].tolist()
    assert "bit_tilt_limit" not in run  # it is the same everywhere


def test_wear_is_a_weight_that_falls_evenly_and_then_stays(engine: str) -> None:
    weight = PAPER.active_weight_on_bit
    falling = InputSchedule((0.0, 9.0), (("active_weight_on_bit", (weight, weight - 450.0)),), "linear")
    force = Schedule((0.0, 5.0), (0.0, 2e3))
    worn = replace(PAPER, length=20.0, schedule=force, wear=Wear(50.0, 450.0))
    scheduled = replace(PAPER, length=20.0, schedule=force, inputs=falling)
    one, other = (simulate(case, engine=engine, sample_interval=0.5) for case in (worn, scheduled))
    for name in COLUMNS:
        scale = max(1.0, float(np.abs(other[name]).max()))
        np.testing.assert_allclose(one[name], other[name], rtol=0, atol=1e-9 * scale, err_msg=name)


@settings(max_examples=15)
@given(rate=st.floats(10.0, 200.0), worn=st.floats(0.3, 9.0))
@example(rate=101.2, worn=6.2)  # where rate times length is not quite the largest weight
def test_calls_take_no_steps_of_their_own_before_and_after_the_bit_is_worn(
    engine: str, rate: float, worn: float
) -> None:
    case = replace(PAPER, wear=Wear(rate, rate * worn / 1.5))
    few, many = (start(case, engine, Options(), case.ground) for _ in range(2))
    few.advance(8.0, 0.0, PAPER.active_weight_on_bit)
    for k in range(1, 33):
        many.advance(0.25 * k, 0.0, PAPER.active_weight_on_bit)
    assert few.statistics == many.statistics


def test_a_worn_bit_without_weight_stops_where_nothing_is_left(engine: str) -> None:
    weight = PAPER.active_weight_on_bit
    with pytest.raises(Stopped, match="from 8 m on the flats of the worn bit bear all of the active weight") as stopped:
        simulate(replace(PAPER, wear=Wear(weight / 8.0, 2 * weight)), engine=engine, length=20.0, sample_interval=0.5)
    assert stopped.value.trajectory is not None
    assert stopped.value.trajectory["drilled_length"][-1] == 7.5


def test_layers_thinner_than_what_the_bit_stays_in_one_are_passed_together(engine: str) -> None:
    """Straight down, where depths are lengths: it stays in the second one for a centimetre, and is beyond all then."""
    case = inclined(0.0, formations=tuple(layer(1.0 + 0.003 * k, 5.0 + k) for k in range(4)))
    run = simulate(case, engine=engine, length=1.1, sample_interval=0.005)
    at = run["drilled_length"]
    assert run["formation"].tolist() == np.select([at < 1.0 - 1e-9, at < 1.01 - 1e-9], [0.0, 1.0], 4.0).tolist()


@pytest.mark.usefixtures("kernel")
def test_errors_in_layers_are_below_the_tolerance() -> None:
    """At an inclination at which the sine that goes with the weight is curved most."""
    case = replace(inclined(85.0, formations=LAYERED.formations), schedule=Schedule((0.0, 6.0), (-2e4, 2e4)))
    usual, tight = (simulate(case, sample_interval=0.25, relative_tolerance=each) for each in (1e-7, 1e-11))
    assert np.ptp(tight["bit_inclination"]) > 0.02
    assert np.abs(usual["bit_inclination"] - tight["bit_inclination"]).max() < 1e-7


def test_along_a_boundary_the_bit_changes_layers_only_now_and_then(engine: str) -> None:
    """A bit that each rock turns into the other one would go to and fro without end."""
    case = inclined(88.571, formations=(layer(0.01821, 50.0),), schedule=Schedule((0.0,), (12858.0,)))
    soft_above = replace(case, bit=replace(case.bit, lateral_steering_resistance=1.0))
    run = simulate(soft_above, engine=engine, length=8.0, sample_interval=0.001)
    ways = np.diff(np.flatnonzero(np.diff(run["formation"])))
    assert ways.min() in (10, 11)  # rows: it leaves again as soon as it may


@settings(max_examples=10)
@given(saved=st.floats(0.1, 12.0), further=st.floats(0.1, 6.0))
def test_a_state_saved_in_a_layer_goes_on_as_if_nothing_had_been(engine: str, saved: float, further: float) -> None:
    original, other = (start(LAYERED, engine, Options(), LAYERED.ground) for _ in range(2))
    original.advance(saved, 5e3, 1600.0)
    other.restore(original.save())
    for run in (original, other):
        run.advance(saved + further, 2e3, 1600.0)
    assert original.outputs() == other.outputs()
    assert original.statistics == other.statistics


def test_layers_stand_in_for_the_rock_at_the_start_only(engine: str) -> None:
    """Other rock that is given takes their place, as that of an FMU's host does."""
    run = start(LAYERED, engine, Options(), LAYERED.ground)
    own = LAYERED.bit
    run.advance(8.0, 0.0, 1600.0, bit=replace(own, lateral_steering_resistance=12.0))
    weight = 1600.0 - 160.0
    assert run.outputs()["eta_pi"] == pytest.approx(12.0 * weight / LAYERED.bha.force_scale, rel=1e-12)
    run.advance(8.0, 0.0, 1600.0, bit=own)
    eta = {1: 20.0, 2: 5.0, 3: 25.0}[int(run.outputs()["formation"])]
    assert run.outputs()["eta_pi"] == pytest.approx(eta * weight / LAYERED.bha.force_scale, rel=1e-12)


def test_inputs_of_a_call_that_was_refused_are_new_when_they_come_again(engine: str) -> None:
    case = replace(LAYERED, wear=None)
    refused, other = (start(case, engine, Options(), case.ground) for _ in range(2))
    for run in (refused, other):
        run.advance(4.0, 5e3, 1600.0)
    with pytest.raises(ParameterError, match="drilled_length"):
        refused.advance(3.9, -3e3, 1600.0)
    for run in (refused, other):
        run.advance(4.001, -3e3, 1600.0)
    assert refused.outputs() == other.outputs()


def test_a_call_that_fails_in_layers_changes_nothing(engine: str) -> None:
    run = start(replace(LAYERED, wear=None), engine, Options(most_steps=40), replace(LAYERED, wear=None).ground)
    run.advance(2.0, 5e3, 1600.0)
    before = run.outputs()
    with pytest.raises(Exception, match="more than 40 steps"):
        run.advance(500.0, 5e3, 1600.0)
    assert run.outputs() == before
    assert pi > run.outputs()["bit_inclination"] > 0

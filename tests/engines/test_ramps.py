"""Inputs that are linear in the drilled length, on either engine: the limit of ever finer stairs, wherever rows lie."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import pi
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.case.paper import paper_case
from boreprop.core.errors import CannotContinue, ParameterError
from boreprop.core.options import Options
from boreprop.core.quantities import ACTING, IN_SPACE_ONLY, ROCK, fields_of, values_of
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.run.course import acting, course_of
from boreprop.run.engines import DRILLING, Engine, start
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped, Trajectory

LENGTH, ENTRIES = 20.0, np.array([0.0, 7.0, 13.0, 16.0])
WATCHED = ("bit_inclination", "average_inclination[1]", "displacement")


FORCE, WEIGHT = np.array([0.0, 3e3, -1e3, 2e3]), np.array([2e3, 8e3, 1e3, 5e3])
ROCK_RAMPS = {
    "lateral_steering_resistance": np.array([10.0, 25.0, 6.0, 8.0]),
    "angular_steering_resistance": np.array([1.0, 0.6, 2.0, 1.5]),
    "bit_tilt_limit": np.array([0.03, 2e-3, 0.02, 5e-4]),
}
EVERYTHING = {"active_weight_on_bit": WEIGHT, **ROCK_RAMPS}


def ramps(case: Case, force: Any, inputs: Mapping[str, Any] = EVERYTHING, stairs: int = 0) -> Case:
    """A case under a force, N, and other inputs at `ENTRIES`, linear in between; or held in the middle of stairs."""
    lengths = ENTRIES
    if stairs:
        lengths = np.linspace(0.0, LENGTH, stairs, endpoint=False)
        middle = lengths + LENGTH / stairs / 2
        force = np.interp(middle, ENTRIES, force)
        inputs = {name: np.interp(middle, ENTRIES, values) for name, values in inputs.items()}
    entries, how = tuple(lengths.tolist()), "held" if stairs else "linear"
    others = InputSchedule(entries, tuple((name, tuple(values)) for name, values in inputs.items()), how)
    return replace(case, schedule=Schedule(entries, tuple(force), how), inputs=others)


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize(
    ("force", "inputs"),
    [
        (FORCE, {"active_weight_on_bit": WEIGHT}),
        (0 * FORCE, {"active_weight_on_bit": WEIGHT}),
        (FORCE, {"active_weight_on_bit": 0 * WEIGHT + 2e3}),
        *((0 * FORCE, {name: values}) for name, values in ROCK_RAMPS.items()),
        (FORCE, EVERYTHING),
    ],
    ids=["F and W", "W", "F", "η", "χ", "ψ*", "all"],
)
def test_a_ramp_is_the_limit_of_ever_finer_stairs(case: Case, force: Any, inputs: Any) -> None:
    def drill(stairs: int) -> Trajectory:
        given_ = ramps(case, force, inputs, stairs)
        return simulate(given_, length=LENGTH, relative_tolerance=1e-9, engine="native")

    run, coarse, fine = drill(0), drill(50), drill(800)
    for name in WATCHED:
        far, near = (np.abs(stairs[name] - run[name]).max() for stairs in (coarse, fine))
        assert near < 0.05 * far, name  # their square: 1/256, but for events
        assert near < 1e-5, name


@pytest.mark.parametrize("name", ["lateral_steering_resistance", "bit_tilt_limit"])
def test_tighter_tolerances_lead_to_the_same_hole_under_ramps(engine: str, case: Case, name: str) -> None:
    given_ = ramps(case, FORCE, {name: ROCK_RAMPS[name]})
    usual, tight = (
        simulate(given_, length=LENGTH, sample_interval=0.5, relative_tolerance=tolerance, engine=engine)
        for tolerance in (1e-7, 1e-10)
    )
    assert usual["bit_inclination"] == pytest.approx(tight["bit_inclination"], abs=2e-6)


def test_rock_that_hardens_evenly_is_a_weight_that_grows_evenly(engine: str, case: Case) -> None:
    """Both multiply ηΠ and χΠ, and nothing else."""
    shares = np.array([1.0, 3.0, 0.5, 2.5])
    rock = {name: shares * ROCK_RAMPS[name][0] for name in ROCK[:2]}
    drilled_ = [
        simulate(ramps(case, FORCE, inputs), length=LENGTH, sample_interval=0.5, engine=engine)
        for inputs in (rock, {"active_weight_on_bit": shares * case.active_weight_on_bit})
    ]
    for output in (*WATCHED, "bit_tilt", "stabilizer_force[1]", "eta_pi"):
        scale = max(1.0, float(np.abs(drilled_[1][output]).max()))
        np.testing.assert_allclose(drilled_[0][output], drilled_[1][output], rtol=0, atol=1e-9 * scale, err_msg=output)


@st.composite
def cases(draw: st.DrawFn) -> Case:
    n = draw(st.integers(1, 3))
    spans = draw(st.lists(st.floats(2.0, 9.0), min_size=n, max_size=n))
    positions = tuple(np.cumsum(spans).tolist())
    angles = draw(st.lists(st.floats(0.0, pi / 2), min_size=2, max_size=2))
    force = st.floats(-2e4, 2e4)
    weight = st.floats(3.0, 5.0).map(lambda exponent: 10.0**exponent)
    how = draw(st.sampled_from(["held", "linear"])), draw(st.sampled_from(["held", "linear"]))
    entries = tuple(ENTRIES.tolist())
    weights = tuple(draw(st.lists(weight, min_size=4, max_size=4)))
    ranges = {ROCK[0]: st.floats(3.0, 60.0), ROCK[1]: st.floats(0.3, 3.0), ROCK[2]: st.floats(2e-3, 0.05)}
    some = draw(st.sets(st.sampled_from(ROCK)))
    rock = [(name, tuple(draw(st.lists(ranges[name], min_size=4, max_size=4)))) for name in ROCK if name in some]
    return Case(
        bha=BottomHoleAssembly(
            positions,
            tuple(draw(st.lists(st.floats(0.0, 5e-3), min_size=n - 1, max_size=n - 1))),
            draw(st.floats(0.0, 1.0)) * positions[0],
            draw(st.floats(0.0, 2e3)),
            draw(st.floats(2e6, 5e7)),
        ),
        bit=BitRock(*(draw(ranges[name]) for name in ROCK)),
        bit_diameter=0.2159,
        active_weight_on_bit=weights[0],
        length=LENGTH,
        survey=Survey((0.0, 20.0), tuple(angles)),
        schedule=Schedule(entries, tuple(draw(st.lists(force, min_size=4, max_size=4))), how[0]),
        inputs=InputSchedule(entries, (("active_weight_on_bit", weights), *rock), how[1]),
    )


def drilled(case: Case, engine: str, interval: float) -> Trajectory:
    try:
        return simulate(case, sample_interval=interval, engine=engine)
    except Stopped as stopped:
        return cast(Trajectory, stopped.trajectory)


@pytest.mark.usefixtures("kernel")
@given(cases())
@settings(max_examples=25)
def test_both_engines_drill_the_same_hole_under_ramps(case: Case) -> None:
    ours, other = (drilled(case, engine, 0.5) for engine in ("native", "python"))
    assert ours.row_count == other.row_count
    for name in ours:
        scale = max(1.0, float(np.abs(other[name]).max()))
        np.testing.assert_allclose(ours[name], other[name], rtol=0, atol=1e-7 * scale, err_msg=name)


@pytest.mark.usefixtures("kernel")
@given(cases(), st.floats(0.01, 3.0))
@settings(max_examples=25)
def test_rows_lie_anywhere_without_a_trace(case: Case, interval: float) -> None:
    few, many = drilled(case, "native", 4 * interval), drilled(case, "native", interval)
    for name in few:
        scale = max(1.0, float(np.abs(many[name]).max()))
        np.testing.assert_allclose(few[name], many[name][::4][: few.row_count], rtol=0, atol=1e-9 * scale, err_msg=name)


def legs(case: Case, ends: np.ndarray) -> Iterator[tuple[float, dict[str, Any]]]:
    """The legs to these lengths and to where the course bends: where each ends, and what `advance` is given for it."""
    course = course_of(case)
    stops = np.union1d(ends, course.starts[1:])
    begins = np.append(0.0, stops[:-1])
    pieces = (np.searchsorted(course.starts, begins, side="right") - 1).astype(np.intc)
    inputs, which = acting(course, begins, pieces)
    for end, values in zip(stops.tolist(), inputs[which].tolist(), strict=True):
        given_ = dict(zip(ACTING, values, strict=True))
        bit = BitRock(**fields_of("bit", given_, case.structure))
        own = {name: value for name, value in given_.items() if name not in (*ROCK, *IN_SPACE_ONLY)}
        yield end, own | {"bit": bit}


def test_a_state_saved_on_a_ramp_goes_on_as_if_nothing_had_been(engine: str, case: Case) -> None:
    ramp = ramps(case, FORCE)

    def begun() -> Engine:
        return start(ramp, engine, Options())

    whole, halves = begun(), begun()
    stops = list(legs(ramp, np.array([9.3, 11.0, LENGTH])))
    for length, given_ in stops:
        whole.advance(length, **given_)
        halves.advance(length, **given_)
        again = begun()
        again.restore(halves.save())
        halves = again
    assert halves.outputs() == whole.outputs()
    assert halves.statistics == whole.statistics


def test_the_integrator_does_not_restart_where_a_ramp_goes_on(engine: str, case: Case) -> None:
    ramp = ramps(case, FORCE)
    counts = []
    for ends in (np.array([LENGTH]), np.linspace(0.01, LENGTH, 500)):
        run = start(ramp, engine, Options())
        for length, given_ in legs(ramp, ends):
            run.advance(length, **given_)
        counts.append(run.statistics)
    assert counts[0] == counts[1]


def test_what_acts_at_the_bit_is_on_its_ramp(engine: str, case: Case) -> None:
    run = simulate(ramps(case, FORCE), length=LENGTH, engine=engine)
    expected = np.interp(run["drilled_length"], ENTRIES, WEIGHT)
    np.testing.assert_allclose(run["active_weight_on_bit"], expected, rtol=1e-12)
    for name, values in ROCK_RAMPS.items():
        np.testing.assert_allclose(run[name], np.interp(run["drilled_length"], ENTRIES, values), rtol=1e-12)
    eta_pi = run["lateral_steering_resistance"] * expected / case.bha.force_scale
    np.testing.assert_allclose(run["eta_pi"], eta_pi, rtol=1e-12)
    np.testing.assert_allclose(run["rss_force"], np.interp(run["drilled_length"], ENTRIES, FORCE), atol=1e-8)


@pytest.mark.parametrize(
    ("given_", "message"),
    [
        ({"rss_force_slope": float("nan")}, "rss_force_slope: must be a finite number, got nan"),
        ({"active_weight_on_bit_slope": float("inf")}, "active_weight_on_bit_slope: must be a finite number, got inf"),
        ({"bit_tilt_limit_slope": float("nan")}, "bit_tilt_limit_slope: must be a finite number, got nan"),
        (
            {"lateral_steering_resistance_slope": 1e308},
            r"change of eta_pi over stabilizer_position\[1\]: must be a fin",
        ),
    ],
)
def test_a_slope_that_is_no_number_is_refused_and_nothing_moves(
    engine: str, given_: dict[str, Any], message: str
) -> None:
    case = paper_case()
    run = DRILLING[engine](case.bha, case.bit, case.survey, active_weight_on_bit=2e3)
    run.advance(1.0, 0.0, 2e3)
    before = run.outputs()
    with pytest.raises(ParameterError, match=message):
        run.advance(2.0, 0.0, 2e3, **given_)
    assert run.outputs() == before


def test_a_slope_of_what_has_none_is_refused(engine: str, case: Case) -> None:
    run = start(case, engine, Options())
    with pytest.raises(TypeError, match=r"rss_toolface_slope: must be one of rss_force_slope, "):
        run.advance(1.0, 0.0, 2e3, rss_toolface_slope=1.0)  # type: ignore[call-arg]


@pytest.mark.parametrize("name", ["active_weight_on_bit", *ROCK])
def test_what_is_on_its_way_below_zero_stops_before(engine: str, case: Case, name: str) -> None:
    run = start(replace(case, active_weight_on_bit=2e3), engine, Options())
    first = {"active_weight_on_bit": 2e3, **values_of("bit", case.bit)}[name]
    slope: Any = {f"{name}_slope": -first / 5.0}
    with pytest.raises(CannotContinue, match=r"too short|not finite|too many"):
        run.advance(10.0, 0.0, 2e3, **slope)
    assert run.drilled_length == 0.0
    run.advance(4.9, 0.0, 2e3, **slope)
    assert run.outputs()["eta_pi"] > 0.0

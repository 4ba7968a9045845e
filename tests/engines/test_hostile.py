"""Numbers that make no sense: each engine refuses them by name, moves nothing, and says what the other says."""

from dataclasses import replace
from itertools import accumulate
from math import inf, nan, nextafter, pi
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.core.errors import CannotContinue, ParameterError
from boreprop.core.options import Options
from boreprop.core.problems import DERIVED
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.run.engines import DRILLING, Engine

FINITE = "must be a finite number"


def drilling(engine: str, case: Case, **changed: Any) -> Engine:
    given = {"active_weight_on_bit": case.active_weight_on_bit, "rss_force": 0.0} | changed
    survey = given.pop("survey", case.survey)
    return DRILLING[engine](case.bha, case.bit, survey, **given)


def assert_names(error: ParameterError, name: str, constraint: str, value: float) -> None:
    assert (error.name, error.constraint) == (name, constraint)
    assert repr(error.value) == repr(value)
    assert str(error) == f"{name}: {constraint}, got {value!r}"
    assert error.problem
    assert (error.problem.name, repr(error.problem.value)) == (name, repr(value))


BAD_INPUTS = [
    *(("rss_force", value, FINITE) for value in (nan, inf, -inf)),
    *(("active_weight_on_bit", value, FINITE) for value in (nan, inf, -inf)),
    *(("active_weight_on_bit", value, "must be > 0") for value in (0.0, -0.0, -1e4)),
]


@pytest.mark.parametrize(("name", "value", "constraint"), BAD_INPUTS)
def test_a_bad_input_is_refused_at_the_start(engine: str, case: Case, name: str, value: float, constraint: str) -> None:
    with pytest.raises(ParameterError) as refused:
        drilling(engine, case, **{name: value})
    assert_names(refused.value, name, constraint, value)


@pytest.mark.parametrize(
    ("name", "value", "constraint"),
    [
        *BAD_INPUTS,
        *(("drilled_length", value, FINITE) for value in (nan, inf, -inf)),
        ("drilled_length", 2.999, "must be >= 3"),
        ("drilled_length", -1e300, "must be >= 3"),
    ],
)
def test_a_bad_input_on_the_way_is_refused_and_moves_nothing(
    engine: str, case: Case, name: str, value: float, constraint: str
) -> None:
    run = drilling(engine, case)
    leg: dict[str, Any] = {"drilled_length": 3.0, "rss_force": 0.0, "active_weight_on_bit": case.active_weight_on_bit}
    run.advance(**leg)
    before, outputs = repr(list(run.save())), run.outputs()
    with pytest.raises(ParameterError) as refused:
        run.advance(**leg | {"drilled_length": 4.0} | {name: value})
    assert_names(refused.value, name, constraint, value)
    assert (repr(list(run.save())), run.outputs()) == (before, outputs)


def test_a_huge_way_takes_too_many_steps(engine: str, case: Case) -> None:
    run = drilling(engine, case)
    with pytest.raises(CannotContinue) as caught:
        run.advance(1e300, 0.0, case.active_weight_on_bit)
    assert str(caught.value).startswith("from 0 m on, more than 262144 steps of the integrator would be needed")


@pytest.mark.parametrize(
    ("changed", "name"),
    [
        ({"active_weight_on_bit": 1e308}, "eta_pi"),
        ({"active_weight_on_bit": 5e-324}, "eta_pi"),
        ({"survey": Survey((-1e-320, 0.0), (0.0, 0.1))}, DERIVED["station_rate"]),
    ],
)
def test_what_follows_from_a_number_out_of_range_is_named(
    engine: str, case: Case, changed: dict[str, Any], name: str
) -> None:
    hard = replace(case, bit=replace(case.bit, lateral_steering_resistance=1e6))
    weak = {"active_weight_on_bit": 5e-324} == changed
    with pytest.raises(ParameterError) as refused:
        drilling(engine, case if weak else hard, **changed)
    assert refused.value.name == name


def test_a_state_from_which_nothing_can_start_is_refused(engine: str, case: Case) -> None:
    long = replace(case.bha, stabilizer_positions=(3.66, 366e3), distributed_weight=1e305)
    with pytest.raises(ParameterError) as refused:
        drilling(engine, replace(case, bha=long))
    assert str(refused.value) == "parameters: must give a finite state where the run starts, got nan"


def test_a_hole_that_is_inclined_by_more_than_a_half_turn_is_refused(engine: str, case: Case) -> None:
    beyond = nextafter(pi, inf)
    for inclination in (beyond, -beyond):
        survey = SimpleNamespace(measured_depth=(0.0, 5.0), inclination=(0.5, inclination))
        with pytest.raises(ParameterError, match=r"^inclination\[2\]: must be [<>]= -?3\.14159 rad, got -?3\.14"):
            drilling(engine, case, survey=survey if engine == "native" else Survey(**vars(survey)))
    drilling(engine, case, survey=Survey((0.0, 5.0), (-pi, pi)))


# both say the same


def hostile(usual: float) -> st.SearchStrategy[float]:
    """A usual number, or one of any size."""
    return st.one_of(st.just(usual), st.floats(-320.0, 308.0).map(lambda power: 10.0**power))


@st.composite
def hostile_runs(draw: st.DrawFn) -> dict[str, Any]:
    first, *gaps = (draw(hostile(3.0)) for _ in range(draw(st.integers(1, 3))))
    positions = tuple(accumulate([first, *gaps]))
    try:
        return {
            "bha": BottomHoleAssembly(
                positions,
                tuple(draw(hostile(1e-3)) for _ in gaps),
                first * draw(st.floats(0.0, 1.0)),
                draw(hostile(1e3)),
                draw(hostile(1e7)),
            ),
            "bit": BitRock(draw(hostile(10.0)), draw(hostile(1.0)), min(draw(hostile(0.02)), 1.0)),
            "survey": Survey((0.0, draw(hostile(5.0))), (min(draw(hostile(0.5)), pi), min(draw(hostile(0.5)), pi))),
            "inputs": (draw(hostile(1e3)), draw(hostile(1e4))),
            "next_inputs": (-draw(hostile(1e3)), draw(hostile(1e4))),
        }
    except ParameterError:
        reject()


def answer(engine: str, run: dict[str, Any]) -> tuple[str, str, float]:
    """The problem that an engine has, its sentence, and where the bit is then."""
    force, weight = run["inputs"]
    length, place = run["bha"].length_scale, -1.0
    try:
        drilling = DRILLING[engine](
            run["bha"], run["bit"], run["survey"], active_weight_on_bit=weight, rss_force=force, options=Options()
        )
        for k in range(3):  # steps that may be 1e-12 ℓ₁ short
            place = drilling.drilled_length
            drilling.advance(1e-9 * k * length, *run["next_inputs"])
    except (ParameterError, CannotContinue) as error:
        return f"{type(error).__name__} {error.problem!r}", str(error), place
    return "", "", drilling.drilled_length


@pytest.mark.usefixtures("kernel")
@settings(max_examples=200)
@given(hostile_runs())
def test_both_engines_say_the_same_of_numbers_that_make_no_sense(run: dict[str, Any]) -> None:
    assert answer("native", run) == answer("python", run)

"""The engines against each other: the same numbers along the same runs, but for rounding."""

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.inputs import Schedule
from boreprop.core.sensors import Sensor
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped
from engine_runs import begin, legs_of, start
from reference_cases import CASES
from systems import scaled_systems

AGREEMENT = 1e-9  # relative
Legs = list[tuple[float, float, float]]  # to this ξ, under this F_RSS and this ηΠ


pytestmark = pytest.mark.usefixtures("kernel")


class Both:
    """The same run with either engine."""

    def __init__(self, scaled: Scaled, survey: Survey, F_rss: float, eta_pi: float, **options: float) -> None:
        self.python, self.native = (
            begin(engine, scaled, survey, F_rss, eta_pi, **options) for engine in ("python", "native")
        )

    def advance(self, *leg: float) -> None:
        self.python.advance(*leg)
        self.native.advance(*leg)
        self.assert_same()

    def assert_same(self) -> None:
        expected = self.python.outputs()
        found = self.native.outputs()
        assert list(found) == list(expected)
        for name, value in expected.items():
            if name.startswith("stabilizer_contact") and abs(expected[name.replace("contact", "force")]) < 1e-12:
                continue  # held on both sides without a load: the sign of a rounding error
            assert found[name] == pytest.approx(value, rel=AGREEMENT, abs=1e-11), name


@pytest.mark.parametrize("name", CASES)
def test_both_take_the_same_steps_along_a_reference_case(name: str) -> None:
    runs = [start(engine, name) for engine in ("python", "native")]
    for xi, force, _ in legs_of(name):
        if xi > 20.0:
            break
        for run in runs:
            run.advance(xi, force, CASES[name]["eta_pi"])
    python, native = (run.statistics for run in runs)
    assert python == native
    assert min(python) > 0


@st.composite
def crooked_runs(draw: st.DrawFn) -> tuple[Scaled, Survey, Legs]:
    """Random systems in crooked holes under changing inputs."""
    scaled = draw(scaled_systems())
    shares = st.sampled_from([0.0, scaled.s[0] / scaled.s[-1], 1.0]) | st.floats(0.0, 1.0)
    sensors = st.builds(
        lambda share, interval, seed: Sensor(share * scaled.s[-1], interval, 0.01, 1e-3 * (interval > 0), seed, 0.02),
        shares,
        st.just(0.0) | st.floats(0.01, 3.0),
        st.integers(0, 2**31 - 1),
    )
    scaled = replace(scaled, sensors=tuple(draw(st.lists(sensors, max_size=3))))
    depths = np.cumsum([0.0, *(draw(st.floats(0.05, 2.0)) for _ in range(draw(st.integers(0, 8))))])
    first = draw(st.floats(0.0, 1.5))
    survey = Survey(tuple(depths.tolist()), tuple(first + draw(st.floats(-0.03, 0.03)) for _ in depths))
    ends = np.cumsum([draw(st.floats(1e-3, 2.0)) for _ in range(draw(st.integers(1, 5)))])
    forces, weights = st.floats(-0.01, 0.01), st.floats(5e-3, 0.3)
    return scaled, survey, [(end, draw(forces), draw(weights)) for end in ends.tolist()]


@settings(max_examples=150)
@given(crooked_runs(), st.sampled_from([1e-9, 1e-7, 1e-5]))
def test_random_runs_give_the_same_numbers(run: tuple[Scaled, Survey, Legs], tolerance: float) -> None:
    scaled, survey, legs = run
    both = Both(scaled, survey, legs[0][1], legs[0][2], relative_tolerance=tolerance)
    for leg in legs:
        both.advance(*leg)


def test_changes_of_input_at_one_place_are_one_kink() -> None:
    both = Both(Scaled((1.0, 2.0), (1e-3,), 0.2, 2e-3, 0.1, 0.03), Survey((0.0,), (0.5,)), 0.0, 0.05)
    for force in (0.002, -0.001, 0.004, 0.001):
        both.advance(0.7, force, 0.05)
    size = len(both.native.save())
    both.advance(0.7, 0.003, 0.05)
    assert len(both.native.save()) == size
    both.advance(5.0, 0.003, 0.05)


def test_a_hole_of_many_pieces_is_kept_whole(case: Case) -> None:
    changing = Schedule(
        tuple((0.002 * np.arange(4000)).tolist()), tuple((500.0 * (-1.0) ** np.arange(4000)).tolist())
    )  # a change every 2 mm: 1800 pieces over the length of the BHA
    agitated = replace(case, schedule=changing, length=8.0)
    assert_same_runs(agitated, 0.05)


def test_a_long_way_down_an_inclined_hole_moves_the_origin_alike(case: Case) -> None:
    horizontal = replace(case, survey=Survey((0.0,), (pi / 2,)), length=600.0)
    assert_same_runs(horizontal, 3.0)


@pytest.mark.parametrize("name", ["paper_case", "build_section"])
def test_simulate_gives_the_same_with_either_engine(name: str, paper_case: Path) -> None:
    assert_same_runs(load_case(paper_case.with_name(f"{name}.toml")), 0.1)


def assert_same_runs(case: Case, sample_interval: float) -> None:
    expected = simulate(case, sample_interval=sample_interval, engine="python")
    found = simulate(case, sample_interval=sample_interval, engine="native")
    assert list(found.columns) == list(expected.columns)
    assert found.case == expected.case
    for name, values in expected.columns.items():
        np.testing.assert_allclose(found[name], values, rtol=AGREEMENT, atol=1e-12 * np.abs(values).max(), err_msg=name)


def test_a_run_that_stops_says_the_same(case: Case) -> None:
    bent = replace(case, schedule=Schedule((0.0, 3.3), (0.0, 1e9)))
    messages = []
    for engine in ("python", "native"):
        with pytest.raises(Stopped) as caught:
            simulate(bent, engine=engine)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]

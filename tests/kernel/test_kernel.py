"""The kernel in C against the core in Python: the same numbers."""

import ctypes
import os
import re
import shutil
import subprocess
import sys
from ast import literal_eval
from collections.abc import Iterator
from dataclasses import replace
from itertools import accumulate
from math import pi, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from boreprop.case.case import Case, Schedule
from boreprop.case.file import load_case
from boreprop.case.paper import paper_case
from boreprop.case.parameters import parameters
from boreprop.core.drilling import Drilling
from boreprop.core.errors import CannotContinue, ParameterError
from boreprop.core.options import Options
from boreprop.core.quantities import OUTPUTS, scalar_names
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly, Scaled
from boreprop.kernel import binding
from boreprop.kernel.binding import NativeDrilling
from boreprop.kernel.compiler import library_path
from boreprop.kernel.generate import SYSTEM
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped
from conftest import Command
from places import ROOT
from reference_cases import CASES, reference
from systems import scaled_systems

AGREEMENT = 1e-9  # relative
Legs = list[tuple[float, float, float]]  # to this ξ, under this F_RSS and this ηΠ


pytestmark = pytest.mark.usefixtures("kernel")


class Drilled:
    """The same run in Python and in C, in units where ℓ₁ = 1 m and F* = 1 N."""

    def __init__(self, scaled: Scaled, survey: Survey, F_rss: float, eta_pi: float, tolerance: float = 1e-7) -> None:
        bha = BottomHoleAssembly(scaled.s, scaled.y_star, scaled.Delta, scaled.w, 1 / 3)
        bit = BitRock(1.0, scaled.epsilon, scaled.psi_star)
        inputs = {"active_weight_on_bit": eta_pi, "rss_force": F_rss}
        self.python = Drilling(bha, bit, survey, **inputs, options=Options(tolerance))
        self.native = NativeDrilling(bha, bit, survey, **inputs, relative_tolerance=tolerance)

    def advance(self, *leg: float) -> str | None:
        failure = None
        try:
            self.python.advance(*leg)
        except CannotContinue as error:
            failure = str(error)
        assert self.native.advance(*leg) == failure
        return failure

    def assert_same(self) -> None:
        expected = self.python.outputs()
        found = self.native.outputs()
        assert list(found) == list(expected)
        for name, value in expected.items():
            if name.startswith("stabilizer_contact") and abs(expected[name.replace("contact", "force")]) < 1e-12:
                continue  # held on both sides without a load: the sign of a rounding error
            assert found[name] == pytest.approx(value, rel=AGREEMENT, abs=1e-11), name


def legs_of(name: str) -> Iterator[tuple[float, float]]:
    """Where a reference case has a row or changes its force, and the force up to there."""
    breaks, values = CASES[name]["force_breaks"], CASES[name]["force_values"]
    stops = sorted({*reference(name)["xi"].tolist(), *breaks[1:]})
    for xi in stops:
        yield xi, values[max(sum(b < xi for b in breaks) - 1, 0)]


@pytest.mark.parametrize("name", CASES)
def test_every_reference_case_gives_the_same_numbers(name: str) -> None:
    p = CASES[name]
    scaled = Scaled(
        tuple(np.cumsum(p["lambda"]).tolist()), tuple(p["y_star"]), p["delta"], p["w"], p["epsilon"], p["psi_star"]
    )
    survey = Survey(tuple(xi - p["survey_xi"][0] for xi in p["survey_xi"]), tuple(p["survey_inc"]))
    run = Drilled(scaled, survey, p["force_values"][0], p["eta_pi"])
    for xi, force in legs_of(name):
        assert run.advance(xi, force, p["eta_pi"]) is None
        run.assert_same()
    assert run.python.statistics == pytest.approx(tuple(run.native.step()[5:]))
    assert run.python.statistics.rejected > 0
    assert run.python.statistics.events > 0


@st.composite
def runs(draw: st.DrawFn) -> tuple[Scaled, Survey, Legs]:
    """Random systems in crooked holes under changing inputs."""
    scaled = draw(scaled_systems())
    depths = np.cumsum([0.0, *(draw(st.floats(0.05, 2.0)) for _ in range(draw(st.integers(0, 8))))])
    first = draw(st.floats(0.0, 1.5))
    survey = Survey(tuple(depths.tolist()), tuple(first + draw(st.floats(-0.03, 0.03)) for _ in depths))
    ends = np.cumsum([draw(st.floats(1e-3, 2.0)) for _ in range(draw(st.integers(1, 5)))])
    forces, weights = st.floats(-0.01, 0.01), st.floats(5e-3, 0.3)
    return scaled, survey, [(end, draw(forces), draw(weights)) for end in ends.tolist()]


@settings(max_examples=150, deadline=None)
@given(runs(), st.sampled_from([1e-9, 1e-7, 1e-5]))
def test_random_runs_give_the_same_numbers(run: tuple[Scaled, Survey, Legs], tolerance: float) -> None:
    scaled, survey, legs = run
    both = Drilled(scaled, survey, legs[0][1], legs[0][2], tolerance)
    for leg in legs:
        assert both.advance(*leg) is None
        both.assert_same()


def test_a_hole_of_many_pieces_is_kept_whole(case: Case) -> None:
    changing = Schedule(
        tuple((0.002 * np.arange(4000)).tolist()), tuple((500.0 * (-1.0) ** np.arange(4000)).tolist())
    )  # a change every 2 mm: 1800 pieces over the length of the BHA
    agitated = replace(case, schedule=changing, length=8.0)
    assert_same_runs(agitated, 0.05)


def test_a_survey_of_more_stations_than_a_memory_usually_holds_is_taken_whole() -> None:
    """One every 5 mm beside the whole BHA, which is twenty times as long as its first span."""
    depths = tuple(0.005 * k for k in range(4400))
    survey = Survey(depths, tuple(0.5 + 0.1 * sin(depth) for depth in depths))
    run = Drilled(Scaled((1.0, 20.0), (1e-3,), 0.2, 2e-3, 0.1, 0.03), survey, 0.0, 0.05)
    run.assert_same()
    assert run.advance(0.02, 0.001, 0.05) is None
    run.assert_same()


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


@pytest.mark.parametrize(("to", "force"), [(40.0, 1e9), (1e9, 0.0)])
def test_a_failure_moves_nothing(case: Case, to: float, force: float) -> None:
    values: dict[str, Any] = {"active_weight_on_bit": case.active_weight_on_bit}
    run = NativeDrilling(case.bha, case.bit, case.survey, **values)
    assert run.advance(10.0, 100.0, case.active_weight_on_bit) is None
    before, outputs = run.save(), run.outputs()
    failure = run.advance(to, force, case.active_weight_on_bit)
    assert failure is not None
    assert ("turns over" if force else "must take at most 262144 steps") in failure
    np.testing.assert_array_equal(run.save(), before)
    assert run.outputs() == outputs
    assert run.advance(11.0, 100.0, case.active_weight_on_bit) is None


def test_what_goes_wrong_is_told_as_in_python(case: Case) -> None:
    bent = replace(case, schedule=Schedule((0.0, 3.3), (0.0, 1e9)))
    messages = []
    for engine in ("python", "native"):
        with pytest.raises(Stopped) as caught:
            simulate(bent, engine=engine)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]


def test_going_on_from_a_state_is_bit_identical(case: Case) -> None:
    def run() -> NativeDrilling:
        return NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)

    first, second = run(), run()
    assert first.advance(70.0, 300.0, 5e4) is None
    state = first.save()
    assert first.advance(90.0, -300.0, 5e4) is None
    second.restore(state)
    assert second.drilled_length == 70.0
    assert second.advance(90.0, -300.0, 5e4) is None
    np.testing.assert_array_equal(first.save(), second.save())


def test_going_back_forgets_the_inputs_since(case: Case) -> None:
    run, same = (
        NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
        for _ in range(2)
    )
    for one in (run, same):
        assert one.advance(20.0, 300.0, 5e4) is None
    state = run.save()
    assert run.advance(21.0, -4000.0, 9e4) is None
    run.restore(state)
    for one in (run, same):
        assert one.advance(60.0, 300.0, 5e4) is None
    np.testing.assert_array_equal(run.save(), same.save())


def test_a_failure_after_the_memory_has_grown_moves_nothing(case: Case) -> None:
    run = NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    weight = case.active_weight_on_bit
    assert run.advance(7.0, 0.0, weight) is None
    before = run.save()
    failure = run.advance(1e5, 0.0, weight)  # it ripples: some 44 steps for each of 27 000 ℓ₁
    assert failure == "step: must take at most 262144 steps of the integrator, got more"
    np.testing.assert_array_equal(run.save(), before)


def test_changes_of_input_at_one_place_are_one_kink(case: Case) -> None:
    run = Drilled(Scaled((1.0, 2.0), (1e-3,), 0.2, 2e-3, 0.1, 0.03), Survey((0.0,), (0.5,)), 0.0, 0.05)
    for force in (0.002, -0.001, 0.004, 0.001):
        assert run.advance(0.7, force, 0.05) is None
        run.assert_same()
    size = len(run.native.save())
    assert run.advance(0.7, 0.003, 0.05) is None
    assert len(run.native.save()) == size
    assert run.advance(5.0, 0.003, 0.05) is None
    run.assert_same()


@given(st.data())
def test_numbers_that_are_no_state_are_refused_and_change_nothing(case: Case, data: st.DataObject) -> None:
    run = NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    run.advance(9.0, 300.0, 5e4)
    good = run.save()
    bad = good.copy()
    where = data.draw(st.integers(0, len(bad) - 1))
    bad[where] = data.draw(st.sampled_from([np.nan, np.inf, -np.inf])) if where else -1.0
    for state in (bad, good[:-1], np.append(good, 0.0), good[:3], good[:0]):
        with pytest.raises(ParameterError, match=r"^state: must be one of this system, got "):
            run.restore(state)
        np.testing.assert_array_equal(run.save(), good)


@given(st.floats(max_value=-1e-300, allow_infinity=False))
def test_a_number_in_a_message_reads_back_as_the_same(value: float) -> None:
    given = parameters(paper_case()) | {"flexural_stiffness": value, "relative_tolerance": 1e-7}
    values, survey = np.array([given[name] for name in scalar_names(SYSTEM, 2)]), np.zeros(1)
    why = ctypes.create_string_buffer(binding.MESSAGE)
    assert not binding.library().boreprop_start(2, values, 1, survey, survey, binding.Inputs(0.0, 0.0, 1.0), why)
    name, _, written = why.value.decode().rpartition(", got ")
    assert name == "flexural_stiffness: must be > 0"
    assert float(written) == value


@pytest.mark.parametrize(("forces", "rows", "lacking"), [(1, [0, 1], 0), (2, [0, 2], 0), (2, [0], 0), (2, [0, 1], 1)])
def test_arrays_that_do_not_fit_are_refused(case: Case, forces: int, rows: list[int], lacking: int) -> None:
    columns = len(scalar_names(OUTPUTS, 2))
    run = NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    with pytest.raises(ValueError, match=rf"must (be 2, of a table of 2|have {columns} columns), got "):
        run.follow(np.array([1.0, 2.0]), np.zeros(forces), 5e4, rows, np.empty((2, columns - lacking)))


# what happens where it is not


SIMULATE = """
import sys
from boreprop.case.file import load_case
from boreprop.run.simulate import simulate
trajectory = simulate(load_case(sys.argv[1]), length=30.0, engine="native")
print({name: values.tolist() for name, values in trajectory.columns.items()})
"""
ENGINE = "from boreprop.run.engines import engine; print(engine())"


class Elsewhere:
    """A copy of the model without a kernel, in processes of its own."""

    def __init__(self, folder: Path) -> None:
        self.model = folder / "model"
        ignored = shutil.ignore_patterns("__pycache__", "boreprop_kernel.*")
        shutil.copytree(ROOT / "model", self.model, ignore=ignored)

    def python(self, *words: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
        variables = os.environ | {"PYTHONPATH": str(self.model)} | environment
        return subprocess.run([sys.executable, *words], env=variables, capture_output=True, text=True, check=False)


@pytest.fixture
def elsewhere(tmp_path: Path) -> Elsewhere:
    return Elsewhere(tmp_path)


def test_without_the_kernel_python_is_used_and_asking_for_it_says_what_helps(
    elsewhere: Elsewhere, paper_case: Path
) -> None:
    assert elsewhere.python("-c", ENGINE).stdout == "python\n"
    said = elsewhere.python("-c", SIMULATE, paper_case).stderr
    assert re.search(r"must be built, got no boreprop_kernel\.\w+: .* python -m boreprop.kernel$", said)


def test_a_kernel_older_than_its_sources_is_not_used(elsewhere: Elsewhere, paper_case: Path) -> None:
    folder = elsewhere.model / "boreprop" / "kernel"
    shutil.copy(library_path(), folder)
    (folder / "newer.h").write_text("/* which the library does not know */")
    assert elsewhere.python("-c", ENGINE).stdout == "python\n"
    said = elsewhere.python("-c", SIMULATE, paper_case).stderr
    assert "must be made from the sources beside it, got an older one" in said


def test_an_integrator_for_more_components_gives_the_same_to_the_last_bit(
    elsewhere: Elsewhere, paper_case: Path
) -> None:
    elsewhere.python("-m", "boreprop.kernel", CFLAGS="-DCOMPONENTS=4").check_returncode()
    here = simulate(load_case(paper_case), length=30.0, engine="native").columns
    assert literal_eval(elsewhere.python("-c", SIMULATE, paper_case).stdout) == {
        name: values.tolist() for name, values in here.items()
    }


def test_an_engine_that_there_is_none_is_refused(case: Case) -> None:
    with pytest.raises(ParameterError, match="engine: must be auto, native or python, got 'fortran'"):
        simulate(case, engine="fortran")


def test_the_command_simulates_with_the_kernel(command: Command, paper_case: Path, tmp_path: Path) -> None:
    for engine in ("python", "native"):
        done = command("boreprop", "simulate", paper_case, "--output", f"{engine}.csv", "--engine", engine)
        assert done.returncode == 0, done.stderr
    python, native = (read_trajectory(tmp_path / f"{engine}.csv") for engine in ("python", "native"))
    for name in python.columns:
        np.testing.assert_allclose(native[name], python[name], rtol=AGREEMENT, atol=1e-12, err_msg=name)


# numbers that make no sense


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
            "survey": Survey((0.0, draw(hostile(5.0))), (draw(hostile(0.5)), draw(hostile(0.5)))),
            "inputs": (draw(hostile(1e3)), draw(hostile(1e4))),
            "next_inputs": (-draw(hostile(1e3)), draw(hostile(1e4))),
        }
    except ParameterError:
        reject()


def answers(engine: Any, run: dict[str, Any]) -> str | list[str | None]:
    force, weight = run["inputs"]
    try:
        drilling = engine(run["bha"], run["bit"], run["survey"], active_weight_on_bit=weight, rss_force=force)
        length = run["bha"].length_scale
        # in steps that may be 1e-12 ℓ₁ short
        return [drilling.advance(1e-9 * k * length, *run["next_inputs"]) for k in range(3)]
    except ParameterError as error:
        return str(error)


@settings(max_examples=200, deadline=None)
@given(hostile_runs())
def test_both_engines_say_the_same_of_numbers_that_make_no_sense(run: dict[str, Any]) -> None:
    assert answers(NativeDrilling, run) == answers(Drilling, run)

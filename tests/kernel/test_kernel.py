"""What is of the compiled library itself: its memory, its saved states, its arrays, and where it is not there."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.core.errors import CannotContinue, ParameterError
from boreprop.core.quantities import OUTPUTS, scalar_names
from boreprop.kernel.binding import NativeDrilling
from boreprop.kernel.compiler import library_path
from boreprop.run.engines import held
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from conftest import Command
from places import ROOT

AGREEMENT = 1e-9  # relative


pytestmark = pytest.mark.usefixtures("kernel")


def test_a_failure_after_the_memory_has_grown_moves_nothing(case: Case) -> None:
    run = NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    weight = case.active_weight_on_bit
    run.advance(7.0, 0.0, weight)
    before = run.save()
    with pytest.raises(CannotContinue, match=r"^from 7 m on, more than 262144 steps"):
        run.advance(1e5, 0.0, weight)  # it ripples: some 44 steps for each of 27 000 ℓ₁
    np.testing.assert_array_equal(run.save(), before)


@given(st.data())
def test_numbers_that_are_no_state_are_refused_and_change_nothing(case: Case, data: st.DataObject) -> None:
    run = NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    run.advance(9.0, 300.0, 5e4)
    good = run.save()
    bad = good.copy()
    where = data.draw(st.integers(0, len(bad) - 1))
    bad[where] = data.draw(st.sampled_from([np.nan, np.inf, -np.inf])) if where else -1.0
    for state in (bad, good[:-1], np.append(good, 0.0), good[:3], good[:0]):
        with pytest.raises(ParameterError, match=r"^state: must be a valid saved state of this system, got "):
            run.restore(state)
        np.testing.assert_array_equal(run.save(), good)


@pytest.mark.parametrize(("forces", "rows", "lacking"), [(1, [0, 1], 0), (2, [0, 2], 0), (2, [0], 0), (2, [0, 1], 1)])
def test_arrays_that_do_not_fit_are_refused(case: Case, forces: int, rows: list[int], lacking: int) -> None:
    columns = len(scalar_names(OUTPUTS, 2))
    run = NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    with pytest.raises(
        ValueError,
        match=rf"must (hold 2 times rss_force, .* like lengths, and rows below 2|have {columns} columns), got ",
    ):
        run.follow(np.array([1.0, 2.0]), held(forces, 0.0, 5e4, run.bit), rows, np.empty((2, columns - lacking)))


@pytest.mark.parametrize("which", [[0, 1], [-1, 0], [0]])
def test_legs_under_inputs_that_are_not_given_are_refused(case: Case, which: list[int]) -> None:
    run = NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    table, inputs = np.empty((0, len(scalar_names(OUTPUTS, 2)))), held(1, 0.0, 5e4, run.bit)
    with pytest.raises(ValueError, match=r"^inputs, rows: must hold 2 times rss_force, "):
        run.follow(np.array([1.0, 2.0]), inputs, [-1, -1], table, np.array(which, dtype=np.intc))


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

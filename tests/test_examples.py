"""The examples do what their files and the README say of them."""

from dataclasses import replace
from math import pi, radians
from pathlib import Path

import numpy as np
import pytest

from boreprop.analysis.rippling import find_rippling
from boreprop.case import Case, load_case, read_survey
from boreprop.core.hole import Survey
from boreprop.results import Trajectory
from boreprop.simulation import simulate

EXAMPLES = Path(__file__).parents[1] / "examples"
INCH = 0.0254


@pytest.fixture(scope="module")
def case() -> Case:
    return load_case(EXAMPLES / "build_section.toml")


@pytest.fixture(scope="module")
def run(case: Case) -> Trajectory:
    return simulate(case, sample_interval=0.1)


def holding(run: Trajectory) -> np.ndarray:
    """Borehole inclination, degrees, where the build and what it left behind the bit are past."""
    return np.degrees(run["borehole_inclination"][run["drilled_length"] > 450.0])


def ripple(run: Trajectory, case: Case) -> float:
    """Peak to peak of the inclination about its mean over two ℓ₁, degrees, in the hold."""
    rows = round(2 * case.bha.length_scale / run["drilled_length"][1])
    mean = np.lib.stride_tricks.sliding_window_view(holding(run), rows).mean(axis=1)
    return float(np.ptp(holding(run)[rows // 2 :][: len(mean)] - mean))


def ripples(run: Trajectory, case: Case) -> bool:
    return find_rippling(run["drilled_length"], run["borehole_inclination"], case.bha.length_scale).ripples


def test_the_build_section_starts_and_ends_with_the_plan(case: Case) -> None:
    plan = read_survey(EXAMPLES / "build_section_plan.csv")
    assert case.survey.measured_depth[-1] == plan.measured_depth[0]
    assert case.survey.inclination[-1] == plan.inclination[0]
    assert case.survey.measured_depth[-1] + case.length == plan.measured_depth[-1]
    assert case.survey.measured_depth[-1] - case.survey.measured_depth[0] >= case.bha.stabilizer_positions[-1]


def test_the_schedule_follows_the_plan(run: Trajectory) -> None:
    plan = read_survey(EXAMPLES / "build_section_plan.csv")
    measured_depth = plan.measured_depth[0] + run["drilled_length"]
    error = run["borehole_inclination"] - np.interp(measured_depth, plan.measured_depth, plan.inclination)
    assert np.degrees(np.abs(error).max()) < 1.5


def test_the_forces_are_what_pads_can_give_and_a_driller_can_send(case: Case) -> None:
    assert max(map(abs, case.schedule.rss_force)) <= 30e3
    assert all(force % 100.0 == 0.0 for force in case.schedule.rss_force)
    assert min(np.diff(case.schedule.drilled_length)) >= 10.0


def test_the_assembly_is_the_collar_that_the_case_file_names(case: Case) -> None:
    outer, inner = 8.25 * INCH, 2.8125 * INCH
    assert case.bha.flexural_stiffness == pytest.approx(206e9 * pi / 64 * (outer**4 - inner**4), rel=1e-3)
    weight = pi / 4 * (outer**2 - inner**2) * (7850.0 - 1280.0) * 9.81
    assert case.bha.distributed_weight == pytest.approx(weight, rel=1e-3)


def test_the_build_section_does_not_ripple(case: Case, run: Trajectory) -> None:
    assert ripple(run, case) < 0.05
    assert not ripples(run, case)


@pytest.mark.parametrize("dogleg_deg", [-1.0, 1.0])
def test_a_dogleg_in_its_existing_hole_does_not_start_a_ripple(case: Case, dogleg_deg: float) -> None:
    (*above, end), start = case.survey.measured_depth, case.survey.inclination[0]
    bent = Survey((*above, end - case.bha.length_scale, end), (start, start, start + radians(dogleg_deg)))
    run = simulate(replace(case, survey=bent), sample_interval=0.1)
    assert ripple(run, case) < 0.05
    assert not ripples(run, case)


def test_a_quarter_of_the_weight_makes_it_ripple(case: Case) -> None:
    run = simulate(replace(case, active_weight_on_bit=case.active_weight_on_bit / 4), sample_interval=0.1)
    assert ripple(run, case) > 0.5
    assert ripples(run, case)


def test_the_case_of_the_paper_ripples() -> None:
    paper = load_case(EXAMPLES / "paper_case.toml")
    run = simulate(paper)
    found = find_rippling(run["drilled_length"], run["borehole_inclination"], paper.bha.length_scale)
    assert found.wavelength == pytest.approx(1.386 * paper.bha.length_scale, rel=0.01)

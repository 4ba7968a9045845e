"""The examples do what their files and the README say of them."""

from dataclasses import replace
from math import degrees, pi, radians
from runpy import run_path

import numpy as np
import pytest

from boreprop.analysis.rippling import find_rippling
from boreprop.analysis.stability.roots import Roots, critical_eta_pi, find_roots
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.tables import read_survey
from boreprop.core.drilling import Drilling
from boreprop.core.survey import Survey
from boreprop.core.system import eta_pi
from boreprop.run.engines import engine
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from places import EXAMPLES

INCH = 0.0254
README = (EXAMPLES / "README.md").read_text(encoding="utf-8")


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
    assert not find_rippling(run).ripples


@pytest.mark.parametrize("dogleg_deg", [-1.0, 1.0])
def test_a_dogleg_in_its_existing_hole_does_not_start_a_ripple(case: Case, dogleg_deg: float) -> None:
    (*above, end), start = case.survey.measured_depth, case.survey.inclination[0]
    bent = Survey((*above, end - case.bha.length_scale, end), (start, start, start + radians(dogleg_deg)))
    run = simulate(replace(case, survey=bent), sample_interval=0.1)
    assert ripple(run, case) < 0.05
    assert not find_rippling(run).ripples


def test_a_quarter_of_the_weight_makes_it_ripple(case: Case) -> None:
    run = simulate(replace(case, active_weight_on_bit=case.active_weight_on_bit / 4), sample_interval=0.1)
    assert ripple(run, case) > 0.5
    assert find_rippling(run).ripples


def miss(case: Case) -> np.ndarray:
    """How far a run of the schedule is from the plan, row by row, degrees."""
    run, plan = simulate(case, engine=engine()), read_survey(EXAMPLES / "build_section_plan.csv")
    planned = np.interp(plan.measured_depth[0] + run["drilled_length"], plan.measured_depth, plan.inclination)
    return np.degrees(run["borehole_inclination"] - planned)


def test_the_readme_of_the_examples_has_the_numbers_of_the_run(case: Case, run: Trajectory) -> None:
    own, light = miss(case), replace(case, active_weight_on_bit=case.active_weight_on_bit / 2)
    loose = replace(case, bha=replace(case.bha, stabilizer_clearances=(3.2e-3, 6.4e-3)))
    forces, contacts = np.abs(run.stack("stabilizer_force")).max(axis=0), run.stack("stabilizer_contact") != 0
    said = (
        f"within {np.abs(own).max():.2f}° (",
        f"{np.sqrt((own**2).mean()):.2f}° root mean square",
        f"{forces[0] / 1e3:.1f} kN at stabilizer 1 (in contact over {100 * contacts[:, 0].mean():.0f} % of the length)",
        f"{forces[1] / 1e3:.1f} kN at stabilizer 2 (all of it)",
        f"within ±{np.degrees(np.abs(run['bit_tilt']).max()):.2f}°, never at its limit",
        f"half the active weight on bit: by up to {np.abs(miss(light)).max():.1f}°",
        f"clearances doubled: by up to {np.abs(miss(loose)).max():.1f}°",
    )
    assert [text for text in said if text not in README] == []
    assert contacts[:, 1].all()
    assert not run["bit_tilt_saturation"].any()


def test_a_jump_of_the_force_turns_the_hole_by_what_the_readme_says(case: Case) -> None:
    drilling = Drilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit, rss_force=2e3)
    drilling.advance(50.0, 2e3, case.active_weight_on_bit)
    before = drilling.outputs()
    drilling.advance(50.0, 3e3, case.active_weight_on_bit)
    jump = degrees(drilling.outputs()["borehole_inclination"] - before["borehole_inclination"])
    assert (before["stabilizer_contact[1]"], before["stabilizer_contact[2]"]) == (1, 1)
    assert f"turns the hole at once by {jump:.3f}° per kN" in README


def test_the_stability_of_the_build_section_is_what_the_readme_says(case: Case) -> None:
    def found(at: float, inclination: float) -> Roots:
        return find_roots(case, at, contact=(1, 2), inclination=inclination)

    start, end = case.survey.inclination[-1], radians(53.43)
    own = eta_pi(case.bha, case.bit, case.active_weight_on_bit)
    weight = case.active_weight_on_bit / own
    assert (found(0.1289, start).verdict, found(0.129, start).verdict) == ("oscillatory", "stable")
    critical = critical_eta_pi(case, contact=(1, 2), inclination=start)
    assert critical is not None
    told = f"ηΠ = 0.1289 ({critical.eta_pi * weight / 1e3:.1f} kN; wavelength {critical.wavelength:.1f} m)"
    assert told in " ".join(README.split())
    for contact in ((), (1,), (2,)):
        for saturated in (False, True):
            other = critical_eta_pi(case, contact=contact, saturated=saturated, inclination=end)
            assert other is None or other.eta_pi < 0.037
    assert f"below 0.037 ({0.037 * weight / 1e3:.1f} kN)" in README
    slow = [found(own, inclination).roots[0].real for inclination in (start, end)]
    assert f"(−{-slow[0]:.4f} per 4.3 m at 26.37°, −{-slow[1]:.4f} at 53.43°)" in README


def test_the_case_of_the_paper_ripples() -> None:
    paper = load_case(EXAMPLES / "paper_case.toml")
    run = simulate(paper)
    found = find_rippling(run)
    assert found.wavelength == pytest.approx(1.386 * paper.bha.length_scale, rel=0.01)


def test_interbedded_drops_in_soft_rock_and_with_a_blunt_bit_and_a_force_by_layers_holds_it() -> None:
    """What docs/gallery.md says of it."""
    script = run_path(str(EXAMPLES / "interbedded.py"))
    case = load_case(EXAMPLES / "interbedded.toml")
    worn = simulate(case)
    held = script["held"](case, worn)
    rates = [script["dropped"](run) for run in (simulate(replace(case, wear=None)), worn, simulate(held))]
    sharp, blunt, straight = (np.array([rate[number] for number in range(1, 9)]) for rate in rates)
    soft, hard = [1, 3, 6], [0, 2, 5, 7]
    assert sharp[soft] == pytest.approx(-0.4, abs=0.05)
    assert sharp[hard] == pytest.approx(-0.05, abs=0.02)
    assert (np.diff(blunt[hard]) < 0.0).all()
    assert blunt[7] == pytest.approx(-0.3, abs=0.05)
    assert np.abs(straight).max() < 0.1
    assert degrees(simulate(held)["borehole_inclination"][-1]) == pytest.approx(45.0, abs=0.2)
    forces = held.schedule.rss_force
    assert [round(force / 1e3, 1) for force in (min(forces), max(forces), forces[-1])] == [0.6, 2.3, 1.8]
    last_soft = worn["formation"] == 7
    assert worn["eta_pi"][last_soft].max() == pytest.approx(0.07, abs=0.005)
    waves = np.degrees(worn["borehole_inclination"][last_soft])
    assert np.ptp(waves[-60:]) > 4 * np.ptp(waves[60:120])  # they grow

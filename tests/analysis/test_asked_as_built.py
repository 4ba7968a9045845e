"""What is asked of BHAs as they are built, outside of the kernel: steering, shape in the hole, summary, completion."""

from dataclasses import replace
from math import degrees, nan, radians

import numpy as np
import pytest

from boreprop.analysis.hole import hole_of
from boreprop.analysis.lying import _Steady, steady_lie
from boreprop.analysis.sag import BeamInHole, largest_sag, steady_sag
from boreprop.analysis.search import State
from boreprop.analysis.steering import build_rate_curve, responses_as_built, steady_response
from boreprop.analysis.summary import summarize
from boreprop.analysis.tipping import drill_until_steady
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.inputs import Schedule
from boreprop.core.errors import ParameterError
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock
from boreprop.report.tables.sag import steadily_outside
from boreprop.report.tables.steering_as_built import summarize_as_built
from boreprop.report.tables.summary import lines
from boreprop.run.completion import complete
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from places import EXAMPLES

pytestmark = pytest.mark.usefixtures("kernel")
FOOT = 0.3048


def pendulum() -> Case:
    return load_case(EXAMPLES / "pendulum.toml")


def in_one_section(case: Case) -> Case:
    """The same beam, as a single section: no longer the paper's to any command."""
    bha = case.bha
    section = replace(
        bha,
        section_lengths=(bha.stabilizer_positions[-1],),
        section_distributed_weights=(bha.distributed_weight,),
        section_flexural_stiffnesses=(bha.flexural_stiffness,),
        section_outer_diameters=(0.0,),
    )
    return replace(case, bha=section)


@pytest.fixture(scope="module")
def drilled(kernel: None) -> Trajectory:
    return simulate(pendulum(), sample_interval=0.25)


@pytest.mark.parametrize(("inclination", "published"), [(20.0, -2.9515), (30.0, -3.2430), (40.0, -3.4813)])
def test_the_pendulum_of_the_examples_drops_as_published(inclination: float, published: float) -> None:
    """Where the handbooks' bit drills: without a moment, as easily sideways as ahead, with all of the weight."""
    case = pendulum()
    free = replace(case, bit=BitRock(1.0, 1e-6, radians(10.0)), active_weight_on_bit=case.weight_on_bit)
    found = steady_response(free, 0.0, radians(inclination))
    assert degrees(found.build_rate) * 100 * FOOT == pytest.approx(published, rel=0.04)
    assert found.body_contact_force > 0.0


def test_the_pendulum_of_the_examples_drops_when_it_is_drilled(drilled: Trajectory) -> None:
    assert degrees(drilled["borehole_inclination"][-1]) == pytest.approx(10.3, abs=1.0)


@pytest.mark.parametrize("inclination", [0.1, 1.2])
def test_a_beam_in_one_section_is_steered_as_the_papers(inclination: float) -> None:
    case = load_case(EXAMPLES / "build_section.toml")
    forces = np.linspace(-40e3, 40e3, 9).tolist()
    for found, force in zip(responses_as_built(in_one_section(case), forces, inclination), forces, strict=True):
        expected = steady_response(case, force, inclination)
        assert found.build_rate == pytest.approx(expected.build_rate, abs=1e-9)
        assert found.bit_tilt == pytest.approx(expected.bit_tilt, abs=1e-8)
        assert found.bit_tilt_saturation == expected.bit_tilt_saturation
        assert found.stabilizer_contact == expected.stabilizer_contact
        assert found.stabilizer_force == pytest.approx(expected.stabilizer_force, abs=0.5)
        assert found.stabilizer_deflection == pytest.approx(expected.stabilizer_deflection, abs=1e-7)


def test_bracketing_finds_what_newtons_method_finds() -> None:
    case, forces = pendulum(), np.array([-1e4, 0.0, 5e3])
    found, steady = steady_lie(case, forces, radians(20.0)), _Steady(case, radians(20.0), gravity=True)
    for row, force in enumerate(forces):
        tilt, turn = steady.bracketed(float(force))
        assert tilt == pytest.approx(found.tilt[row], abs=1e-7)
        assert turn / case.length_scale == pytest.approx(found.curvature[row], abs=1e-8)


def test_a_long_run_ends_in_the_steady_response() -> None:
    """Near the horizontal, where the weight hardly changes along the arc, under a force that makes no ripple."""
    case, force, start = pendulum(), 8e3, radians(83.0)
    across = replace(case, bha=replace(case.bha, axial_load=False), weight_on_bit=0.0)
    horizontal = replace(across, survey=Survey((0.0, 60.0), (start, start)), schedule=Schedule((0.0,), (force,)))
    run = simulate(replace(horizontal, length=200.0), sample_interval=5.0)
    end = {name: float(values[-1]) for name, values in run.items()}
    expected = steady_response(across, force, end["average_inclination[1]"])
    assert end["borehole_curvature"] == pytest.approx(expected.build_rate, rel=5e-3)
    assert end["bit_tilt"] == pytest.approx(expected.bit_tilt, rel=5e-3)
    assert end["stabilizer_force[1]"] == pytest.approx(expected.stabilizer_force[0], rel=0.05)
    assert end["body_contact_position"] == expected.body_contact_position
    assert end["body_contact_force"] == pytest.approx(expected.body_contact_force, rel=0.03)


def test_the_force_that_holds_does_not_turn_the_hole() -> None:
    summary = summarize_as_built(pendulum())
    [holding] = summary.holding
    assert abs(holding.build_rate) < 1e-3 * abs(summary.free.build_rate)
    assert summary.free.rss_force == 0.0


def test_in_the_hole_the_body_lies_on_the_wall_where_the_run_says(drilled: Trajectory) -> None:
    case = pendulum()
    beam = BeamInHole(case)
    hole = hole_of(drilled, case.survey, beam.stabilizer[-1])
    hole_axis = beam.hole_axis(drilled, hole, beam.s)
    bha_axis, forces = beam.bha_axis(drilled, hole_axis)
    at, n = beam.at_supports, beam.stabilizer.size
    offset, clearance = (bha_axis - hole_axis)[:, at[n:]], np.array(case.bha.body_point_clearances)
    assert np.abs(offset).max() <= clearance.max() + 1e-9
    np.testing.assert_allclose(np.abs(offset)[forces != 0.0], clearance[0], atol=1e-9)
    np.testing.assert_allclose(
        (bha_axis - hole_axis)[:, at[: n - 1]], drilled.stack("stabilizer_deflection"), atol=1e-9
    )
    largest = np.abs(forces).argmax(axis=1)
    same = np.isclose(beam.s[at[n:]][largest], drilled["body_contact_position"])
    assert same.mean() > 0.95
    worst = np.abs(forces).max(axis=1) - np.abs(drilled["body_contact_force"])
    assert np.sqrt(np.mean(worst**2)) < 0.05 * np.abs(drilled["body_contact_force"]).mean()


def test_a_beam_in_one_section_hangs_as_the_papers() -> None:
    case = load_case(EXAMPLES / "build_section.toml")
    run = simulate(replace(case, length=60.0), sample_interval=2.0)
    paper, built = BeamInHole(case), BeamInHole(in_one_section(case))
    hole_axis = paper.hole_axis(run, hole_of(run, case.survey, 21.5), paper.s)
    np.testing.assert_allclose(
        built.bha_axis(run, hole_axis)[0], paper.bha_axis(run, hole_axis)[0], atol=1e-7, rtol=1e-6
    )
    response = steady_response(case, 9000.0, 0.5)
    expected, found = (steady_sag(each, response, 0.5) for each in (case, in_one_section(case)))
    assert found.offset == pytest.approx(expected.offset, rel=1e-5)


def test_an_axial_load_that_changes_from_row_to_row_bends_each_as_its_own() -> None:
    case = replace(pendulum(), bha=replace(pendulum().bha, body_point_positions=(), body_point_clearances=()))
    sags = {
        weight: largest_sag(simulate(replace(case, weight_on_bit=weight), length=1.0, sample_interval=0.5))
        for weight in (60e3, 110e3)
    }
    runs = [simulate(replace(case, weight_on_bit=weight), length=1.0, sample_interval=0.5) for weight in sags]
    joined = Trajectory({name: np.concatenate([run[name] for run in runs]) for name in runs[0]}, case)
    assert abs(sags[110e3].offset) > 1.02 * abs(sags[60e3].offset)
    assert largest_sag(joined).offset == pytest.approx(sags[110e3].offset, rel=1e-6)


def test_the_summary_says_where_the_body_touches(drilled: Trajectory) -> None:
    body = summarize(drilled).body_contact
    assert body is not None
    most = int(np.abs(drilled["body_contact_force"]).argmax())
    assert body.share > 0.95
    assert body.largest_force == pytest.approx(abs(drilled["body_contact_force"][most]))
    assert body.position == drilled["body_contact_position"][most]
    table = dict(lines(summarize(drilled)))
    assert f"{body.position:.1f} m behind the bit" in table["body: largest contact force"]
    assert "warning" not in table


def test_a_table_says_nothing_of_a_spread_that_too_few_waves_have_not(drilled: Trajectory) -> None:
    summary = summarize(drilled)
    wave = replace(summary.rippling, state=State.DYING, spread=nan)
    table = dict(lines(replace(summary, rippling=wave)))
    assert "ripple of the hole axis" in table
    assert "ripple, from wave to wave" not in table


def test_where_the_wall_bears_the_body_there_is_no_warning_of_sag() -> None:
    case = pendulum()
    bare = replace(case, bha=replace(case.bha, body_point_positions=(), body_point_clearances=()))
    assert steadily_outside(case) == ""
    assert "beyond its wall" in steadily_outside(bare)


def test_columns_that_need_no_beam_are_completed(drilled: Trajectory) -> None:
    dropped = {
        "borehole_inclination",
        "eta_pi",
        "displacement",
        "true_vertical_depth",
        "bit_moment",
        "stabilizer_contact",
    }
    left = Trajectory({name: drilled[name] for name in drilled if name.partition("[")[0] not in dropped}, drilled.case)
    completed = complete(left)
    for name in ("borehole_inclination", "eta_pi", "stabilizer_contact[1]", "displacement"):
        np.testing.assert_allclose(completed[name], drilled[name], atol=1e-3)
    assert "bit_moment" not in completed


def test_the_search_for_ripples_presses_the_bha_with_all_of_the_weight() -> None:
    case = replace(pendulum(), weight_on_bit=110e3)
    run, _ = drill_until_steady(case)
    same = simulate(case, length=20.0, sample_interval=0.1)
    np.testing.assert_allclose(run["borehole_inclination"][:201], same["borehole_inclination"], atol=1e-6)


def test_what_needs_the_papers_beam_says_what_does_not() -> None:
    with pytest.raises(ParameterError, match="roots, stability and spiral, got 'section, axial_load, body_contact'"):
        build_rate_curve(pendulum(), 0.3, 1e4)

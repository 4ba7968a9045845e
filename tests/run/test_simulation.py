"""`simulate` in SI units against the dimensionless reference, its rows, its schedule, and the summary of its runs."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from boreprop.analysis.rippling import Rippling
from boreprop.analysis.search import State
from boreprop.analysis.summary import summarize
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.inputs import Schedule
from boreprop.case.paper import LENGTH_SCALE, paper_case
from boreprop.core.errors import ParameterError
from boreprop.core.quantities import INPUTS, OUTPUTS, ROCK, scalar_names
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.report.tables.summary import lines, whether_it_ripples
from boreprop.run.simulate import simulate
from places import EXAMPLES
from reference_cases import reference

F_STAR = 3 * 7.2e6 / LENGTH_SCALE**2


def inclined(inclination_deg: float, schedule: Schedule) -> Case:
    """The paper's BHA with a wide clearance in a straight inclined hole, well away from rippling."""
    return replace(
        paper_case(clearance=0.1),
        bit=BitRock(10.0, 1.0, radians(2.0)),
        active_weight_on_bit=0.05 * F_STAR,
        survey=Survey((0.0,), (radians(inclination_deg),)),
        schedule=schedule,
        length=60.0,
    )


def test_the_paper_case_in_metres_and_newtons_is_the_reference() -> None:
    rows = reference("fig7_psi_2deg")
    run = simulate(paper_case(), sample_interval=0.02 * LENGTH_SCALE, relative_tolerance=1e-9)
    assert run["drilled_length"] == pytest.approx(rows["xi"] * LENGTH_SCALE)
    assert run["bit_inclination"] == pytest.approx(rows["theta"], abs=1e-7)
    assert run["borehole_inclination"] == pytest.approx(rows["Theta"], abs=1e-5)
    assert run["bit_tilt"] == pytest.approx(rows["psi"], abs=1e-5)
    assert run["stabilizer_force[1]"] == pytest.approx(rows["F_1"] * F_STAR, abs=1e-7 * F_STAR)
    assert run["bit_lateral_force"] == pytest.approx(rows["F_0"] * F_STAR, abs=1e-7 * F_STAR)
    # ⟨Θ⟩ over the last ℓ₁ is the change of Y
    Y = rows["Y"]
    assert run["average_inclination[1]"][50:] == pytest.approx(Y[50:] - Y[:-50], abs=1e-7)
    assert run["average_inclination[2]"][100:] == pytest.approx(Y[50:-50] - Y[:-100], abs=1e-7)


def test_the_example_file_is_the_paper_case() -> None:
    example, built = load_case(EXAMPLES / "paper_case.toml"), paper_case()
    assert example.bha == built.bha
    assert example.bit == built.bit
    assert example.survey == built.survey
    assert example.active_weight_on_bit == pytest.approx(built.active_weight_on_bit, rel=1e-6)
    assert example.length == pytest.approx(built.length)


def test_columns_are_the_inputs_and_outputs_of_the_table() -> None:
    run = simulate(paper_case(), length=1.0)
    names = scalar_names(INPUTS, 2) + scalar_names(OUTPUTS, 2)
    assert list(run.columns) == [name for name in names if name not in ("rate_of_penetration", *ROCK)]


def test_moment_and_tilt_obey_the_bit_rock_law() -> None:
    """Eq. (9): F_0 = ηΠ ψ where the tilt is not saturated, M_0 = −εηΠ θ'."""
    run = simulate(inclined(30.0, Schedule((0.0,), (5000.0,))), sample_interval=0.01)
    free = run["bit_tilt_saturation"] == 0
    stiffness = run["eta_pi"][0] * F_STAR
    assert run["bit_lateral_force"][free] == pytest.approx(stiffness * run["bit_tilt"][free], rel=1e-9)
    slope = np.gradient(run["bit_inclination"], run["drilled_length"])
    expected = -0.1 * stiffness * LENGTH_SCALE * slope * LENGTH_SCALE
    assert run["bit_moment"][50:-1] == pytest.approx(expected[50:-1], rel=5e-3, abs=2.0)


def test_the_path_is_the_integral_of_the_inclination() -> None:
    run = simulate(inclined(30.0, Schedule((0.0,), (5000.0,))), sample_interval=0.01)
    s, Theta = run["drilled_length"], run["borehole_inclination"]
    assert run["displacement"][-1] == pytest.approx(np.trapezoid(np.sin(Theta), s), abs=1e-5)
    assert run["true_vertical_depth"][-1] == pytest.approx(np.trapezoid(np.cos(Theta), s), abs=1e-5)


def test_curvature_is_the_change_of_inclination_over_the_last_length_scale() -> None:
    run = simulate(inclined(30.0, Schedule((0.0,), (5000.0,))), sample_interval=LENGTH_SCALE / 100)
    Theta = run["borehole_inclination"]
    expected = (Theta[200:] - Theta[100:-100]) / LENGTH_SCALE
    assert run["borehole_curvature"][200:] == pytest.approx(expected, abs=1e-6)


def test_rows_do_not_depend_on_the_sample_interval() -> None:
    case = inclined(30.0, Schedule((0.0, 20.0), (5000.0, -3000.0)))
    fine, coarse = simulate(case, sample_interval=0.5), simulate(case, sample_interval=5.0)
    for name in coarse.columns:
        assert np.array_equal(coarse[name], fine[name][::10]), name


def test_a_row_on_a_change_of_force_holds_what_comes_after_it() -> None:
    run = simulate(inclined(30.0, Schedule((0.0, 20.0), (5000.0, -3000.0))), sample_interval=1.0)
    assert list(run["rss_force"][19:22]) == [5000.0, -3000.0, -3000.0]
    jump = run["borehole_inclination"][20] - run["borehole_inclination"][19]
    assert jump < -1e-3  # Θ jumps with the force
    assert abs(run["bit_inclination"][20] - run["bit_inclination"][19]) < 1e-3  # θ does not


def test_changes_of_force_between_rows_are_not_lost() -> None:
    pulses = Schedule((0.0, 20.2, 20.6), (5000.0, -30000.0, 5000.0))
    with_pulse = simulate(inclined(30.0, pulses), sample_interval=1.0)
    without = simulate(inclined(30.0, Schedule((0.0,), (5000.0,))), sample_interval=1.0)
    assert np.array_equal(with_pulse["bit_inclination"][:21], without["bit_inclination"][:21])
    assert abs(with_pulse["bit_inclination"][21] - without["bit_inclination"][21]) > 5e-5


def test_rows_are_multiples_of_the_interval_up_to_the_length() -> None:
    run = simulate(paper_case(), sample_interval=0.1, length=1.0)
    assert np.array_equal(run["drilled_length"], np.arange(11) * 0.1)


def test_a_positive_force_builds_inclination() -> None:
    pushed = simulate(inclined(30.0, Schedule((0.0,), (5000.0,))))
    pulled = simulate(inclined(30.0, Schedule((0.0,), (-5000.0,))))
    assert pushed["borehole_inclination"][-1] > pulled["borehole_inclination"][-1] + 0.01


def test_progress_reaches_the_end() -> None:
    seen: list[float] = []
    simulate(paper_case(), length=20.0, progress=seen.append)
    assert seen == sorted(seen)
    assert 50 <= len(seen) <= 200
    assert seen[-1] > 19.0


def test_one_stabilizer_drills_without_contact_columns() -> None:
    bha = BottomHoleAssembly((3.66,), (), 0.6, 1080.0, 7.2e6)
    run = simulate(replace(paper_case(), bha=bha), length=10.0)
    assert "stabilizer_force[1]" not in run.columns
    assert np.isfinite(run["borehole_inclination"]).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"length": -1.0}, "length: must be > 0, got -1.0"),
        ({"sample_interval": 0.0}, "sample_interval: must be > 0, got 0.0"),
        ({"relative_tolerance": 1.0}, "relative_tolerance: must be <= 0.01, got 1.0"),
    ],
)
def test_arguments_out_of_range_are_refused(arguments: dict[str, float], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        simulate(paper_case(), **arguments)  # type: ignore[arg-type]


def test_summary_of_a_rippling_run() -> None:
    case = paper_case()
    run = simulate(case, sample_interval=0.05)
    summary = summarize(run)
    late = run["drilled_length"] > 150.0
    assert summary.rippling.wavelength == pytest.approx(1.386 * LENGTH_SCALE, rel=0.005)
    assert summary.contact_share[0] == pytest.approx(np.mean(run["stabilizer_contact[1]"] != 0), abs=1e-3)
    assert summary.largest_contact_force[0] == pytest.approx(np.abs(run["stabilizer_force[1]"][late]).max(), rel=0.01)
    assert 0.7 < summary.saturation_share < 0.9
    told = dict(lines(summary))
    assert told["ripple of the hole axis"] == f"±{1e3 * summary.rippling.axis_amplitude:.3g} mm"
    assert told["modes of a wave"].startswith("1 lower −ψ* 45%\n")


def test_summary_of_a_steered_run() -> None:
    run = simulate(inclined(30.0, Schedule((0.0,), (5000.0,))), sample_interval=0.1)
    summary = summarize(run)
    change = run["average_inclination[1]"][-1] - radians(30.0)  # ℓ₁ is half of this BHA
    assert summary.start_inclination == pytest.approx(radians(30.0))
    assert summary.build_rate == pytest.approx(change / 60.0, rel=1e-3)
    assert not summary.rippling.ripples
    assert summary.saturation_share == pytest.approx(np.mean(run["bit_tilt_saturation"] != 0), abs=2e-3)
    assert summary.drilled_length == pytest.approx(60.0)
    turns = run["average_inclination[1]"][300:] - run["average_inclination[1]"][:-300]  # over 30 m each
    assert summary.largest_build_rate == pytest.approx(turns[np.argmax(np.abs(turns))] / 30.0, rel=1e-3)


@pytest.mark.parametrize(
    ("interval", "length", "hidden"),
    [
        (0.1, 219.6, ""),
        (1.0, 219.0, "under 8 m: take rows closer together (--sample-interval)"),
        (0.1, 12.0, "over 2.4 m: drill further (--length)"),
    ],
)
def test_a_summary_says_which_waves_the_rows_cannot_show(interval: float, length: float, hidden: str) -> None:
    summary = summarize(simulate(paper_case(), sample_interval=interval, length=length))
    assert summary.hidden_waves == hidden
    assert ("waves that would not show" in dict(lines(summary))) is bool(hidden)


@pytest.mark.parametrize(
    ("wave", "words"),
    [
        (Rippling(), "no"),
        (
            Rippling(State.DYING, 5.0, 0.01, growth=-np.log(10.0) / 80.0),
            "no, dying out over 80 m: waves 5.00 m long",
        ),
        (Rippling(State.LASTING, 5.0, 0.01, growth=0.0), "yes: 5.00 m long"),
        (
            Rippling(State.GROWING, 5.0, 0.01, growth=0.1),
            "yes, growing: 5.00 m long",
        ),
        (
            Rippling(State.STEERED, 5.0, 0.01, growth=0.0),
            "no, but force or weight change too often to tell: waves 5.00 m long",
        ),
    ],
    ids=[*State],
)
def test_what_becomes_of_a_wave_in_words(wave: Rippling, words: str) -> None:
    assert whether_it_ripples(wave) == words


def test_a_case_of_numpy_numbers_runs_like_one_of_floats(case: Case) -> None:
    survey = replace(case.survey, inclination=tuple(np.array(case.survey.inclination)))
    bha = replace(case.bha, flexural_stiffness=np.float64(case.bha.flexural_stiffness))
    run, same = (simulate(c, length=10.0) for c in (case, replace(case, survey=survey, bha=bha)))
    for name, column in run.columns.items():
        np.testing.assert_allclose(same[name], column, rtol=1e-9, atol=1e-9)

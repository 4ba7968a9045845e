"""How far the beam is from the axis of the hole, against a published assembly, a textbook and the model itself."""

from dataclasses import replace
from math import degrees, radians
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

from boreprop.analysis.hole import hole_of
from boreprop.analysis.sag import BeamInHole, largest_sag, steady_sag
from boreprop.analysis.steering import steady_response
from boreprop.analysis.summary import summarize
from boreprop.case.case import Case
from boreprop.case.file import dump_case, load_case
from boreprop.case.inputs import Schedule
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.report.tables.steering import lines as steering_lines
from boreprop.report.tables.steering import summarize as summarize_steering
from boreprop.report.tables.summary import lines
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_fmu.pack.documentation import page
from conftest import Command
from places import EXAMPLES, ROOT

# a published assembly that drops: 7 × 2¾ in collars, stabilizers of full gauge at 45, 75 and 165 ft, a hole of 9 in
PENDULUM = Case(
    bha=BottomHoleAssembly((13.716, 22.86, 50.292), (0.0, 0.0), 0.3, 1332.9, 9.575e6),
    bit=BitRock(1e6, 1e4, radians(89.0)),
    bit_diameter=0.2286,
    active_weight_on_bit=89e3,
    length=1.0,
    survey=Survey((1000.0, 1100.0), (radians(20.0), radians(20.0))),
    schedule=Schedule((0.0,), (0.0,)),
)


def test_a_beam_between_two_stabilizers_hangs_as_in_a_textbook() -> None:
    """Between its last two supports, as a continuous beam, whose moments follow from Clapeyron's three-moment rule."""
    spans, w = np.array([13.716, 9.144, 27.432]), 1332.9 * np.sin(radians(20.0))
    matrix = np.zeros((3, 3))  # moments at the bit, where the slope is zero, and at both stabilizers
    matrix[0, :2] = 2 * spans[0], spans[0]
    for i in (1, 2):
        matrix[i, i - 1 : i + 1] = spans[i - 1], 2 * (spans[i - 1] + spans[i])
    matrix[1, 2] = spans[1]
    load = -w / 4 * np.array([spans[0] ** 3, spans[0] ** 3 + spans[1] ** 3, spans[1] ** 3 + spans[2] ** 3])
    moment = np.linalg.solve(matrix, load)[2]
    x = np.linspace(
        0.0, spans[2], 2001
    )  # from the second stabilizer, where the moment is, to the hinge at the last one
    simple = w * x * (spans[2] ** 3 - 2 * spans[2] * x**2 + x**3) / 24
    held = moment * x * (spans[2] - x) * (2 * spans[2] - x) / (6 * spans[2])
    expected = (simple + held).max() / 9.575e6
    sag = largest_sag(simulate(PENDULUM, sample_interval=0.5))
    assert sag.offset == pytest.approx(-expected, rel=5e-3)
    assert sag.offset == pytest.approx(-0.189, abs=0.002)
    assert sag.outside


@pytest.mark.parametrize(("name", "largest"), [("paper_case", 0.05), ("build_section", 0.0112)])
def test_the_examples_stay_inside_their_holes(name: str, largest: float) -> None:
    sag = largest_sag(simulate(load_case(EXAMPLES / f"{name}.toml")))
    assert abs(sag.offset) == pytest.approx(largest, rel=0.02)
    assert not sag.outside


def test_at_the_stabilizers_it_is_the_deflection_of_the_model() -> None:
    case = load_case(EXAMPLES / "build_section.toml")
    response = steady_response(case, 5000.0, 0.5)
    beam = BeamInHole(case)
    e = -beam.s * response.bit_tilt - beam.s**2 * response.build_rate / 2
    forces = {f"stabilizer_force[{i}]": np.array([force]) for i, force in enumerate(response.stabilizer_force, 1)}
    loads = {"rss_force": np.array([5000.0]), "average_inclination[1]": np.array([0.5])} | forces
    bent, _ = beam.bent(Trajectory(loads, case), e[None])
    at = np.searchsorted(beam.s, beam.stabilizer)
    np.testing.assert_allclose((e + bent[0])[at], [*response.stabilizer_deflection, 0.0], atol=1e-9)


def test_a_hole_that_turns_evenly_hangs_as_the_steering_response_says() -> None:
    """Without weight, which would change along the arc."""
    example = load_case(EXAMPLES / "build_section.toml")
    case = replace(
        example,
        bha=replace(example.bha, distributed_weight=0.0),
        schedule=Schedule((0.0,), (9000.0,)),
        length=400.0,
    )
    run = simulate(case, sample_interval=0.25)
    response, beam = steady_response(case, 9000.0, 0.0), BeamInHole(case)
    last = Trajectory({name: values[-1:] for name, values in run.columns.items()}, run.case)
    hole = hole_of(run, case.survey, beam.stabilizer[-1])
    hole_axis = beam.hole_axis(last, hole, beam.s)
    found = (beam.bha_axis(last, hole_axis)[0] - hole_axis)[0]
    assert last["bit_tilt"][0] == pytest.approx(response.bit_tilt, rel=1e-3)
    assert found[np.argmax(np.abs(found))] == pytest.approx(steady_sag(case, response, 0.0).offset, rel=2e-3)


def test_summary_and_steering_warn_with_place_and_amount() -> None:
    [warning] = [text for what, text in lines(summarize(simulate(PENDULUM, sample_interval=0.5))) if what == "warning"]
    assert warning.startswith("37.4 m behind the bit the axis of the BHA is 188 mm")
    assert "below that of the hole" in warning
    assert "74.1 mm beyond its wall" in warning
    steering = replace(PENDULUM, bit=BitRock(0.001, 1e-5, radians(89.0)))
    warnings = [text for what, text in steering_lines(summarize_steering(steering)) if what == "warning"]
    assert any("behind the bit the axis of the BHA is" in text for text in warnings)


def test_the_pages_say_how_fast_such_an_assembly_drops(case: Case) -> None:
    """For −2.952 °/100 ft as published: the curvature at which the bit has no side force."""
    unresisting = replace(PENDULUM, bit=BitRock(0.001, 1e-5, radians(89.0)))
    rate = degrees(30.0 * steady_response(unresisting, 0.0, radians(20.0)).build_rate)
    said = f"drops {-rate:.1f} °/30 m"
    assert said == "drops 6.0 °/30 m"
    assert 2.952 / 100 / 0.3048 * 30 == pytest.approx(2.9, abs=0.05)
    assert f"{said}, where 2.9 °/30 m are published" in (ROOT / "docs" / "limits.md").read_text(encoding="utf-8")
    assert f"{said} here for 2.9 °/30 m" in page(case, "Borehole", "native", {})


def test_nothing_is_said_of_a_bha_inside_its_hole() -> None:
    case = load_case(EXAMPLES / "build_section.toml")
    run = simulate(case, sample_interval=1.0)
    said = dict(lines(summarize(run))) | dict(steering_lines(summarize_steering(case)))
    assert "warning" not in said


def test_an_fmu_of_such_a_bha_says_so_when_it_is_built_and_on_its_page(command_here: Command, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(dump_case(PENDULUM))
    built = command_here("boreprop-fmu", "build", "case.toml", "--output", "x.fmu", "--runtime", "python")
    assert built.returncode == 0
    assert "\nwarning: case.toml: 37.4 m behind the bit the axis of the BHA is 1" in f"\n{built.stderr}"
    with ZipFile(tmp_path / "x.fmu") as fmu:
        page = fmu.read("documentation/index.html").decode()
    assert "Of this case, drilled on steadily: 37.4 m behind the bit" in page


def test_an_fmu_of_another_bha_says_nothing_of_it(command_here: Command, tmp_path: Path) -> None:
    example = EXAMPLES / "build_section.toml"
    built = command_here("boreprop-fmu", "build", example, "--output", "x.fmu", "--runtime", "python")
    assert (built.returncode, built.stderr) == (0, "")
    with ZipFile(tmp_path / "x.fmu") as fmu:
        assert "Of this case" not in fmu.read("documentation/index.html").decode()

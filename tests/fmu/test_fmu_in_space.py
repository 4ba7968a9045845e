"""Native FMUs of cases in space: the run of `simulate`, states, derivatives and errors."""

from dataclasses import replace
from functools import partial
from math import pi, radians
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest
from test_fmu_c_host import COMPILER

from beams_as_built import with_points
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.core.quantities import INPUTS, OUTPUTS, scalar_names
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from boreprop_fmu.host.drive import FmuRun
from boreprop_fmu.pack.build import build_fmu
from boreprop_fmu.pack.documentation import assumptions, page
from conftest import Command, Pack
from flavours import NATIVE
from fmu_host import Instance, instance
from native_fmu import refused
from places import EXAMPLES
from scenarios import report

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")
host = partial(report, "fmu_host")


@pytest.fixture(scope="module")
def steered(case: Case) -> Case:
    """The paper's case in a hole that turns, steered to sides, with sensors; the bit walks to the left, then right."""
    return replace(
        case,
        bha=replace(case.bha, sensor_positions=(5.0, 2.0), sensor_intervals=(0.0, 3.3), sensor_noises=(0.0, 1e-3)),
        bit=replace(case.bit, walk_angle=radians(-3.0)),
        length=30.0,
        survey=Survey((0.0, 5.0, 12.0), (0.2, 0.25, 0.3), (0.1, 0.2, 0.4)),
        schedule=Schedule((0.0, 9.9, 17.0), (3e3, 6e3, 2e3), "held", (0.4, 1.7, -2.0), ("gravity", "north", "frame")),
        inputs=InputSchedule((0.0, 5.0), (("bit_walk_angle", (radians(-3.0), radians(4.0))),)),
    )


@pytest.fixture(scope="module")
def borehole(steered: Case, pack: Pack) -> Path:
    return pack(steered, NATIVE)


@pytest.fixture
def one(borehole: Path):  # type: ignore[no-untyped-def]
    with instance(str(borehole)) as made:
        yield made


@pytest.mark.parametrize("step", [0.37, 2.2])
def test_an_fmu_drills_what_simulate_drills(
    steered: Case, borehole: Path, command: Command, tmp_path: Path, step: float
) -> None:
    done = command("boreprop-fmu", "run", borehole, "--output", "run.csv", "--step", str(step))
    assert done.returncode == 0, done.stderr
    run, expected = read_trajectory(tmp_path / "run.csv"), simulate(steered, sample_interval=step)
    for name in [*scalar_names(OUTPUTS, steered.structure), "rss_toolface", "bit_walk_angle"]:
        scale = max(1.0, float(np.abs(expected[name]).max()))
        np.testing.assert_allclose(run[name], expected[name], rtol=0, atol=1e-9 * scale, err_msg=name)


def test_an_fmu_has_the_body_on_the_wall_that_simulate_has(
    steered: Case, pack: Pack, command: Command, tmp_path: Path
) -> None:
    points = [0.5 + 0.5 * k for k in range(13) if k != 6]
    case = replace(steered, bha=with_points(steered.bha, points, 8e-3), length=6.0)
    done = command("boreprop-fmu", "run", pack(case, NATIVE), "--output", "run.csv", "--step", "0.7")
    assert done.returncode == 0, done.stderr
    run, expected = read_trajectory(tmp_path / "run.csv"), simulate(case, sample_interval=0.7)
    for name in scalar_names(OUTPUTS, case.structure):
        scale = max(1.0, float(np.abs(expected[name]).max()))
        np.testing.assert_allclose(run[name], expected[name], rtol=0, atol=1e-7 * scale, err_msg=name)
    assert (np.abs(run["body_contact_force_right"]) > 1.0).any()


def test_its_description_has_the_table_s_variables(steered: Case, borehole: Path) -> None:
    with instance(str(borehole)) as made:
        own = set(made.variables)
        types = {name: made.variables[name].type for name in ("rss_toolface", "toolface_reference")}
    assert set(scalar_names(INPUTS + OUTPUTS, steered.structure)) <= own
    assert types == {"rss_toolface": "Real", "toolface_reference": "Integer"}


def test_states_in_space_are_saved_and_restored(borehole: Path, tmp_path: Path) -> None:
    first, restored, deserialized = host("rollback", borehole, tmp_path / "state")
    assert first == restored == deserialized
    assert len({row["bit_azimuth"] for row in first}) > 1


def test_a_reset_instance_begins_anew(one: Instance) -> None:
    one.initialize()
    first = one.steps(4, 1.5)
    one.slave.reset()
    one.initialize()
    assert one.steps(4, 1.5) == first


def difference(one: Instance, name: str, step: float) -> dict[str, float]:
    value = one.get(name)
    one.set_names({name: value + step})
    above = one.row()
    one.set_names({name: value - step})
    below = one.row()
    one.set_names({name: value})
    return {output: (above[output] - below[output]) / (2 * step) for output in one.outputs}


@pytest.mark.parametrize(
    ("name", "step"),
    [("rss_force", 5.0), ("rss_toolface", 1e-4), ("active_weight_on_bit", 0.5), ("bit_walk_angle", 1e-4)],
)
def test_derivatives_by_inputs_are_difference_quotients(one: Instance, name: str, step: float) -> None:
    one.initialize(rss_force=5e3, rss_toolface=1.0)
    one.steps(3, 3.0)
    outputs = [output for output in one.outputs if one.variables[output].type == "Real"]
    references = [one.variables[output].valueReference for output in outputs]
    before, row = one.steps(0, 1.0), one.row()
    found = one.slave.getDirectionalDerivative(references, [one.variables[name].valueReference], [1.0])
    assert one.row() == row, before
    expected = difference(one, name, step)
    for output, value in zip(outputs, found, strict=True):
        assert value == pytest.approx(expected[output], rel=1e-4, abs=1e-7 * max(1.0, abs(row[output]))), output


SMOOTH = ("bit_inclination", "bit_azimuth", "average_inclination[1]", "average_inclination[2]", "north", "east",
          "displacement", "true_vertical_depth")  # fmt: skip


@pytest.mark.parametrize("turns", [0.0, 4e4])
def test_derivatives_in_time_are_difference_quotients(one: Instance, turns: float) -> None:
    one.initialize(rss_force=turns, rss_toolface=1.2, relative_tolerance=1e-9)
    one.steps(5, 1.3)
    step = 1e-3
    before = one.row()
    one.steps(1, step)
    references = [one.variables[name].valueReference for name in SMOOTH]
    found = one.slave.getRealOutputDerivatives(references, [1] * len(references))
    after = one.steps(1, step)[-1]
    for name, value in zip(SMOOTH, found, strict=True):
        assert value == pytest.approx((after[name] - before[name]) / (2 * step), rel=1e-4, abs=1e-7), name


def test_a_wrong_reference_is_refused_where_it_is_used(one: Instance) -> None:
    one.initialize()
    one.slave.setInteger([one.variables["toolface_reference"].valueReference], [3])
    with refused(one, "toolface_reference: must be <= 2, got 3", status=2):
        one.slave.doStep(0.0, 1.0)


@pytest.mark.parametrize(
    ("degrees", "told"),
    [
        ({"rss_toolface": 90.0}, "rss_toolface: must be <= 6.28319 rad, got 90.0"),
        ({"rss_toolface": -45.0}, "rss_toolface: must be >= -6.28319 rad, got -45.0"),
        ({"bit_walk_angle": 5.0}, "bit_walk_angle: must be <= 1.55334 rad, got 5.0"),
        ({"bit_tilt_limit": 2.0}, "bit_tilt_limit: must be <= 1.5708 rad, got 2.0"),
    ],
)
def test_an_angle_in_degrees_discards_the_step(one: Instance, degrees: dict[str, Any], told: str) -> None:
    one.initialize()
    right = {name: one.get(name) for name in degrees}
    one.set_names(degrees)
    with refused(one, told, status=2):
        one.slave.doStep(0.0, 1.0)
    one.set_names(right)
    one.slave.doStep(0.0, 1.0)


def test_a_bias_in_degrees_is_refused(one: Instance) -> None:
    one.set_names({"sensor_bias[1]": -5.0})
    with refused(one, "sensor_bias[1]: must be >= -3.14159 rad, got -5.0"):
        one.initialize()


def test_a_survey_file_may_have_azimuths(one: Instance, tmp_path: Path) -> None:
    path = tmp_path / "survey.csv"
    path.write_text("measured_depth,azimuth_deg,inclination_deg\n0,300,10\n40,310,10\n")
    one.initialize(survey_file=str(path))
    assert one.get("bit_azimuth") == pytest.approx(radians(310.0) - 2 * pi)
    one.slave.reset()
    path.write_text("measured_depth,azimuth_deg,inclination_deg\n0,300,10\n40,361,10\n")
    with refused(one, f"{path}:3: azimuth_deg: must be between -360 and 360, got '361' (survey_file)"):
        one.initialize(survey_file=str(path))
    one.slave.reset()
    path.write_text("measured_depth,azimuth,inclination_deg\n0,300,10\n40,310,10\n")
    with refused(
        one, f"{path}: must have the column 'azimuth_deg' (degrees), or none of it, got 'azimuth' (survey_fil"
    ):
        one.initialize(survey_file=str(path))


def test_its_page_says_of_the_case_what_holds_for_it(case: Case, steered: Case) -> None:
    planar, space = (page(one, "Borehole", "native", {}) for one in (case, steered))
    for text in ("a borehole in a vertical plane", "nothing holds the beam", "and the hole is planar"):
        assert text in planar
    assert "a borehole in space" in space
    assert "planar" not in space
    built = load_case(EXAMPLES / "pendulum.toml")
    assert assumptions(replace(built, dimensions=3)) == (
        "Friction and torque are left out, and the rock is the same in every direction."
    )


def test_a_python_fmu_of_a_case_in_space_names_the_native_runtime(steered: Case, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="must be native for a case in space, got 'python': use --runtime native"):
        build_fmu(steered, tmp_path / "x.fmu", runtime="python")
    assert not (tmp_path / "x.fmu").exists()


def test_a_fmu_of_the_plane_refuses_a_toolface(case: Case, steered: Case, pack: Pack) -> None:
    with pytest.raises(InputError, match="must be made of a case in space for a toolface"):
        FmuRun(pack(case, NATIVE), steered.schedule)


def test_a_binary_for_the_plane_refuses_a_case_in_space(borehole: Path, case: Case, pack: Pack, tmp_path: Path) -> None:
    mixed = tmp_path / "mixed.fmu"
    with ZipFile(borehole) as space, ZipFile(pack(case, NATIVE)) as plane, ZipFile(mixed, "w") as made:
        for name in space.namelist():
            made.writestr(name, (plane if name.startswith("binaries/") else space).read(name))
    with pytest.raises(Exception, match=r"[Ii]nstantiate"), instance(str(mixed)):
        pass

"""The system-level example: controller and borehole as an SSP, on three importers, along the plan."""

import subprocess
import sys
import zipfile
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from hashlib import sha256
from importlib.util import module_from_spec, spec_from_file_location
from math import inf, nan
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fmpy import read_model_description
from fmpy.ssp.ssd import read_ssd
from fmpy.validation import validate_fmu
from numpy.typing import NDArray

from boreprop.case.file import load_case
from boreprop.case.tables import read_survey
from boreprop.core.drilling import Drilling
from boreprop.core.quantities import INPUTS, quantity_of, scalar_names
from boreprop.run.results import read_trajectory
from boreprop.run.trajectory import Trajectory
from forking import run_script
from places import EXAMPLES

CLOSED_LOOP = EXAMPLES / "closed_loop"
PLAN = read_survey(EXAMPLES / "build_section_plan.csv")
CASE = load_case(EXAMPLES / "build_section.toml")
SETTLED = 60.0  # m


def has_ecos() -> bool:
    """Whether ecospy is here, and the library that its binary wants (Debian: libtbb12)."""
    return subprocess.run([sys.executable, "-c", "import ecospy"], capture_output=True).returncode == 0


ecos = pytest.mark.skipif(not has_ecos(), reason="no ecospy, or no libtbb.so.12 for it")


def script(name: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    return run_script([CLOSED_LOOP / name, *map(str, arguments)], ("numpy", "fmpy.simulation", "fmpy.ssp.simulation"))


def make_ssp(path: Path, *arguments: object) -> Path:
    done = script("make_ssp.py", path, *arguments)
    assert done.returncode == 0, done.stderr
    return path


@pytest.fixture(scope="module")
def ssp(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_ssp(tmp_path_factory.mktemp("closed_loop") / "closed_loop.ssp", "--runtime", "python")


def edited(ssp: Path, old: str, new: str) -> Path:
    """A copy of an SSP, with other text in its structure."""
    path = ssp.with_name("edited.ssp")
    with zipfile.ZipFile(ssp) as before, zipfile.ZipFile(path, "w") as after:
        for name in before.namelist():
            content = before.read(name)
            after.writestr(name, content.replace(old.encode(), new.encode()) if name.endswith(".ssd") else content)
    return path


@pytest.fixture(scope="module")
def unpacked(ssp: Path) -> Path:
    with zipfile.ZipFile(ssp) as archive:
        archive.extractall(ssp.parent)
    return ssp.parent


def drill(ssp: Path, importer: str, half_weight_at: float | None = None) -> Trajectory:
    path = ssp.with_suffix(f".{importer}.{half_weight_at}.csv")
    disturbance = [] if half_weight_at is None else ["--half-weight-at", half_weight_at]
    done = script("run.py", ssp, "--output", path, "--importer", importer, *disturbance)
    assert done.returncode == 0, done.stderr
    return read_trajectory(path)


Run = Callable[[float | None], Trajectory]


@pytest.fixture(scope="module")
def run(ssp: Path) -> Run:
    """A run on fmpy, with half the active weight on bit from a length on: made once."""
    return cache(partial(drill, ssp, "fmpy"))


@pytest.fixture
def controller() -> Any:
    """The slave as a Python object, with a plan that holds 1 rad, a gain of 1 N/mrad and a limit of 100 N."""
    spec = spec_from_file_location("closed_loop_controller", CLOSED_LOOP / "controller.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    slave = module.InclinationController(instance_name="controller")
    slave.start_inclination, slave.build_length = 1.0, 1.0
    slave.proportional_gain, slave.force_limit = 1e3, 100.0
    slave.enter_initialization_mode()
    slave.next_survey = 0.0
    return slave


def survey(controller: Any, drilled_length: float, inclination: float) -> float:
    """The force after a step that begins there."""
    controller.drilled_length, controller.inclination = drilled_length, inclination
    assert controller.do_step(drilled_length, 0.5)
    return float(controller.rss_force)


def error_deg(drilled_length: NDArray[np.float64], inclination: NDArray[np.float64]) -> NDArray[np.float64]:
    """Inclination less the plan's, degrees."""
    return np.degrees(
        inclination - np.interp(PLAN.measured_depth[0] + drilled_length, PLAN.measured_depth, PLAN.inclination)
    )


def worst_deg(run: Trajectory) -> float:
    """Largest error after the first metres, degrees."""
    error = error_deg(run["drilled_length"], run["borehole_inclination"])
    return float(np.abs(error[run["drilled_length"] > SETTLED]).max())


# the SSP


def test_the_ssp_is_valid_and_so_are_its_fmus(ssp: Path, unpacked: Path) -> None:
    elements = read_ssd(ssp, validate=True).system.elements  # against the standard's XSD; raises
    assert {element.name for element in elements} == {"borehole", "controller"}
    assert [validate_fmu(str(unpacked / element.source)) for element in elements] == [[], []]


def test_its_connectors_and_parameters_are_variables_of_the_fmus_with_those_units(ssp: Path, unpacked: Path) -> None:
    system = read_ssd(ssp).system
    variables = {
        element.name: {v.name: v for v in read_model_description(unpacked / element.source).modelVariables}
        for element in system.elements
    }
    for element in system.elements:
        for connector in element.connectors:
            assert variables[element.name][connector.name].causality == connector.kind
        for binding in element.parameterBindings:
            for parameter in binding.parameterValues[0].parameters:
                variable = variables[element.name][parameter.name]
                assert (variable.causality, variable.unit) == ("parameter", parameter.unit)
    for c in system.connections:
        start, end = variables[c.startElement][c.startConnector], variables[c.endElement][c.endConnector]
        assert (start.causality, end.causality) == ("output", "input")
        assert start.unit == end.unit


def test_the_plan_in_it_is_the_plan_of_the_example(ssp: Path) -> None:
    [bindings] = [e.parameterBindings for e in read_ssd(ssp).system.elements if e.name == "controller"]
    given = SimpleNamespace(**{p.name: float(p.value) for p in bindings[0].parameterValues[0].parameters})
    (start, end, _), (before, after, _) = PLAN.measured_depth, PLAN.inclination
    assert given.start_inclination == before
    assert given.build_length == pytest.approx(end - start, abs=1e-9)
    assert given.build_rate == pytest.approx((after - before) / (end - start), rel=1e-12)
    assert (given.sensor_distance,) == CASE.bha.sensor_positions
    assert (given.survey_interval,) == CASE.bha.sensor_intervals


def test_the_controllers_module_is_named_after_its_content(unpacked: Path) -> None:
    with zipfile.ZipFile(unpacked / "resources" / "InclinationController.fmu") as fmu:
        module = fmu.read("resources/slavemodule.txt").decode()
        assert module == f"controller_{sha256(fmu.read(f'resources/{module}.py')).hexdigest()[:16]}"


# the runs


def test_libcosim_gives_the_same(ssp: Path, run: Run) -> None:
    pytest.importorskip("libcosimpy")
    ours, theirs = run(600.0), drill(ssp, "libcosim", 600.0)
    assert list(ours.columns) == list(theirs.columns)
    for name, column in ours.columns.items():
        np.testing.assert_allclose(theirs[name], column, rtol=1e-12, atol=1e-12, err_msg=name)


def same_hole(theirs: Trajectory, ours: Trajectory) -> None:
    """Ecos passes outputs on before they can be read: what answers to the force at once is that of the next step."""
    names = [name for name in ours.columns if name not in ("time", *scalar_names(INPUTS, 0))]
    names = [name for name in names if not {"rss_force", "active_weight_on_bit"} & set(quantity_of(name).follows)]
    assert {"bit_inclination", "average_inclination[1]", "displacement"} <= set(names)
    for name in names:
        np.testing.assert_allclose(theirs[name], ours[name], rtol=1e-10, atol=1e-10, err_msg=name)
    np.testing.assert_allclose(theirs["rss_force"][:-1], ours["rss_force"][1:], rtol=1e-9)


@ecos
def test_ecos_drills_the_same_hole(ssp: Path, run: Run) -> None:
    same_hole(drill(ssp, "ecos", 600.0), run(600.0))


@ecos
@pytest.mark.usefixtures("binaries")
def test_so_does_the_native_fmu_in_ecos(ssp: Path, run: Run) -> None:
    native = make_ssp(ssp.with_name("native.ssp"), "--runtime", "native")
    same_hole(drill(native, "ecos", 200.0), run(200.0))


def test_the_ssp_may_change_the_bha(ssp: Path) -> None:
    run = drill(edited(ssp, 'value="1.923e7"', 'value="1.5e7"'), "fmpy")
    bha = replace(CASE.bha, flexural_stiffness=1.5e7)
    assert run.case is not None
    assert run.case.bha == bha
    drilling = Drilling(bha, CASE.bit, CASE.survey, active_weight_on_bit=CASE.active_weight_on_bit)
    for k in range(200):
        drilling.advance(run["drilled_length"][k], run["rss_force"][k], CASE.active_weight_on_bit)
        assert drilling.outputs()["borehole_inclination"] == pytest.approx(run["borehole_inclination"][k], abs=1e-12)


def test_without_a_plan_the_controller_refuses_to_run(ssp: Path) -> None:
    no_plan = edited(ssp, '"build_length"><ssv:Real value="418.59"', '"build_length"><ssv:Real value="0"')
    done = script("run.py", no_plan, "--output", no_plan.with_suffix(".csv"))
    assert done.returncode == 2
    reason, error = done.stderr.splitlines()
    assert reason.startswith("controller: plan: must be given by the parameters start_inclination (rad), build_rate")
    assert "controller: at 0 s" in error
    assert not no_plan.with_suffix(".csv").exists()


@pytest.mark.parametrize("half_weight_at", [None, 600.0, 200.0])
def test_the_hole_follows_the_plan(run: Run, half_weight_at: float | None) -> None:
    trajectory = run(half_weight_at)
    assert trajectory["drilled_length"][-1] == CASE.length
    assert worst_deg(trajectory) < 0.5


@pytest.mark.parametrize("half_weight_at", [600.0, 200.0])
def test_it_recovers_from_the_loss_of_weight(run: Run, half_weight_at: float) -> None:
    trajectory = run(half_weight_at)
    lost = trajectory["drilled_length"] > half_weight_at
    expected = np.where(lost, 0.5, 1.0) * CASE.active_weight_on_bit
    np.testing.assert_array_equal(trajectory["active_weight_on_bit"], expected)
    assert abs(error_deg(trajectory["drilled_length"], trajectory["borehole_inclination"])[-1]) < 0.1


@pytest.mark.parametrize(("half_weight_at", "at_least"), [(600.0, 0.3), (200.0, 2.0)])
def test_without_the_loop_the_loss_of_weight_leads_astray(run: Run, half_weight_at: float, at_least: float) -> None:
    undisturbed, full = run(None), CASE.active_weight_on_bit
    drilling = Drilling(CASE.bha, CASE.bit, CASE.survey, active_weight_on_bit=full)
    inclination = []
    for length, force in zip(undisturbed["drilled_length"], undisturbed["rss_force"], strict=True):
        drilling.advance(length, force, full / 2 if length > half_weight_at else full)
        inclination.append(drilling.outputs()["borehole_inclination"])
    error = error_deg(undisturbed["drilled_length"], np.array(inclination))
    assert np.abs(error[undisturbed["drilled_length"] > half_weight_at]).max() > at_least


def test_the_force_changes_only_after_a_survey(run: Run) -> None:
    trajectory = run(600.0)
    begins = trajectory["drilled_length"][1:][np.diff(trajectory["rss_force"]) != 0.0] - 0.5
    assert len(begins) > 80
    np.testing.assert_array_equal(begins % 10.0, 0.5)  # m: the survey, and one communication step
    assert np.abs(trajectory["rss_force"]).max() < 15e3


def test_it_can_be_watched_beside_the_plan(ssp: Path, run: Run) -> None:
    pytest.importorskip("rerun")
    from rrd import read

    saved = ssp.with_suffix(".rrd")
    done = script("run.py", ssp, "--output", ssp.with_name("watched.csv"), "--save", saved)
    assert (done.returncode, done.stderr) == (0, "")
    depth = PLAN.measured_depth[0] + run(None)["drilled_length"]
    for curve, expected in (
        ("borehole_inclination", run(None)["borehole_inclination"]),
        ("0_plan", np.interp(depth, PLAN.measured_depth, PLAN.inclination)),
    ):
        shown = read(saved, f"plots/inclination/{curve}", "Scalars:scalars", "simulation_time")
        np.testing.assert_allclose([shown[time][0] for time in sorted(shown)], np.degrees(expected), atol=1e-4)


# the controller


def test_its_integral_does_not_wind_up_at_the_limit(controller: Any) -> None:
    for k in range(100):
        assert survey(controller, 10.0 * k, 0.0) == 100.0  # 1 rad short: wants 1000 N
    assert survey(controller, 1000.0, 1.05) < 0.0  # at once, when the hole has come out too high


def test_its_integral_makes_good_a_lasting_error(controller: Any) -> None:
    forces = [survey(controller, 10.0 * k, 0.99) for k in range(16)]
    assert forces[0] == pytest.approx(10.0)
    assert forces[15] == pytest.approx(20.0)  # after 150 m as much again


def test_it_looks_at_surveys_only(controller: Any) -> None:
    force = survey(controller, 0.0, 0.99)
    assert [survey(controller, length, 0.5) for length in (0.5, 5.0, 9.5)] == [force] * 3
    assert survey(controller, 10.0 - 1e-9, 0.5) == 100.0


def test_its_state_is_complete(controller: Any) -> None:
    for k in range(5):
        survey(controller, 10.0 * k, 0.99)
    state = controller._fmu_state_from_bytes(controller._fmu_state_to_bytes(controller._get_fmu_state()))
    onward = [survey(controller, 50.0 + 2.5 * k, 0.98) for k in range(20)]
    controller._set_fmu_state(state)
    assert [survey(controller, 50.0 + 2.5 * k, 0.98) for k in range(20)] == onward


@pytest.mark.parametrize(
    ("name", "value"),
    [("inclination", nan), ("drilled_length", inf), ("survey_interval", 0.0), ("steering_response", 0.0)],
)
def test_a_bad_value_discards_the_step_and_names_it(controller: Any, name: str, value: float) -> None:
    good, force = getattr(controller, name), controller.rss_force
    setattr(controller, name, value)
    controller.enter_initialization_mode()
    assert not controller.do_step(0.0, 0.5)
    assert controller.log_queue[-1].msg.startswith(f"{name}: must be ")
    assert controller.rss_force == force
    setattr(controller, name, good)
    assert controller.do_step(0.0, 0.5)


# bad input


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["nowhere.ssp", "--output", "{}/run.csv"], "nowhere.ssp"),
        ([__file__, "--output", "{}/run.csv"], "must be an SSP"),
        ([__file__, "--output", "{}/run.txt"], "must end in .csv or .parquet"),
        ([__file__, "--output", "{}/run.csv", "--half-weight-at", "-1"], "must be a number > 0, got '-1'"),
    ],
)
def test_bad_input_is_one_line(tmp_path: Path, arguments: list[str], reason: str) -> None:
    done = script("run.py", *(argument.format(tmp_path) for argument in arguments))
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert reason in done.stderr
    assert not list(tmp_path.iterdir())

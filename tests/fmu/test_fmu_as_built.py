"""FMUs of BHAs as they are built: the native flavour drills what `simulate` drills, the Python one refuses them."""

from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import fromstring
from zipfile import ZipFile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beams_as_built import CASES, built, reference_bha
from boreprop.case.case import Case
from boreprop.case.file import dump_case
from boreprop.case.inputs import InputSchedule
from boreprop.case.packed import read_packed_case
from boreprop.core.quantities import OUTPUTS, followed, quantity_of, scalar_names
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.binding import NativeDrilling
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from conftest import Command, Pack, assert_refused
from flavours import NATIVE
from fmu_host import instance
from native_fmu import refused

pytestmark = pytest.mark.usefixtures("kernel")
NAME = "fulcrum_20deg"


@pytest.fixture(scope="module")
def fulcrum() -> Case:
    """Fifteen metres of the reference case, with more weight on bit after six."""
    given = CASES[NAME]
    [[_, _, active, weight]] = given["schedule"]
    return Case(
        reference_bha(NAME),
        BitRock(given["eta"], given["chi"], given["psi_star"]),
        given["hole_diameter"],
        active,
        15.0,
        Survey((0.0, 100.0), tuple(given["hole_inclination"])),
        weight_on_bit=weight,
        inputs=InputSchedule((0.0, 6.1), (("weight_on_bit", (weight, 1.4 * weight)),)),
    )


def test_an_fmu_drills_what_simulate_drills(fulcrum: Case, pack: Pack, command: Command, tmp_path: Path) -> None:
    done = command("boreprop-fmu", "run", pack(fulcrum, NATIVE), "--output", "run.csv", "--step", "0.5")
    assert done.returncode == 0, done.stderr
    run = read_trajectory(tmp_path / "run.csv")
    expected = simulate(fulcrum, sample_interval=0.5)
    for name in scalar_names(OUTPUTS, fulcrum.bha.structure):
        scale = max(1.0, float(np.abs(expected[name]).max()))
        np.testing.assert_allclose(run[name], expected[name], rtol=0, atol=1e-9 * scale, err_msg=name)
    assert np.abs(run["body_contact_force"]).max() > 1e3
    constant = simulate(replace(fulcrum, inputs=None), sample_interval=0.5)
    assert np.abs(run["bit_inclination"] - constant["bit_inclination"]).max() > 1e-5


def test_its_description_has_what_the_bha_has(fulcrum: Case, pack: Pack) -> None:
    fmu = pack(fulcrum, NATIVE)
    with ZipFile(fmu) as archive:
        description = fromstring(archive.read("modelDescription.xml"))
    causality = {v.attrib["name"]: v.attrib["causality"] for v in description.iterfind(".//ScalarVariable")}
    assert causality["weight_on_bit"] == "input"
    assert causality["section_length[1]"] == causality["body_point_position[45]"] == "parameter"
    assert causality["wall_distance"] == "output"
    assert "flexural_stiffness" not in causality
    assert read_packed_case(fmu) == fulcrum


def test_too_much_weight_discards_the_step(fulcrum: Case, pack: Pack, command: Command, tmp_path: Path) -> None:
    (tmp_path / "heavy.csv").write_text("drilled_length,weight_on_bit\n0,1e5\n3,1e6\n")
    done = command("boreprop-fmu", "run", pack(fulcrum, NATIVE), "--output", "run.csv", "--schedule", "heavy.csv")
    assert done.returncode != 0
    assert "weight_on_bit: must be < 480" in done.stderr
    assert "buckles" in done.stderr


def test_derivatives_by_the_load_along_the_bha_are_refused(fulcrum: Case, pack: Pack) -> None:
    with instance(str(pack(fulcrum, NATIVE))) as one:
        one.initialize()
        tilt, weight = (one.variables[name].valueReference for name in ("bit_tilt", "weight_on_bit"))
        with refused(one, "weight_on_bit: must not be given here: derivatives by the load along the BHA are not known"):
            one.slave.getDirectionalDerivative([tilt], [weight], [1.0])


def test_the_python_flavour_is_refused_with_the_one_that_has_it(
    fulcrum: Case, command: Command, tmp_path: Path
) -> None:
    (tmp_path / "case.toml").write_text(dump_case(fulcrum))
    refused = command("boreprop-fmu", "build", "case.toml", "--runtime", "python", "--output", "a.fmu")
    assert_refused(refused, "runtime", "native", "section")
    assert not (tmp_path / "a.fmu").exists()


ROCK = ("lateral_steering_resistance", "angular_steering_resistance", "bit_tilt_limit")


@given(bha=built(axial=True, points=4), weight=st.sampled_from([0.0, 2e4]), force=st.floats(-3e4, 3e4))
def test_what_changes_at_once_with_an_input_is_said_to_depend_on_it(
    bha: BottomHoleAssembly, weight: float, force: float
) -> None:
    """Among others on the active weight, which loads the BHA along its axis where weight_on_bit is 0."""
    reach = bha.stabilizer_positions[-1]
    survey = Survey((0.0, reach, reach + 5.0), (0.5, 0.5, 0.51))
    acting = {
        "rss_force": force,
        "active_weight_on_bit": 1e4,
        "weight_on_bit": weight,
        **dict(zip(ROCK, (10.0, 1.0, 0.02), strict=True)),
    }

    def outputs(values: dict[str, float]) -> dict[str, float | int]:
        run = NativeDrilling(
            bha,
            BitRock(*(values[name] for name in ROCK)),
            survey,
            active_weight_on_bit=values["active_weight_on_bit"],
            weight_on_bit=values["weight_on_bit"],
            rss_force=values["rss_force"],
        )
        return run.outputs()

    before = outputs(acting)
    for name, value in acting.items():
        for output, after in outputs(acting | {name: 1.1 * value + (name == "weight_on_bit") * 3e4}).items():
            if after != before[output]:
                assert name in followed(quantity_of(output), bha.structure), (output, name)


def test_its_forces_are_said_to_depend_on_the_active_weight(fulcrum: Case, pack: Pack) -> None:
    with ZipFile(pack(fulcrum, NATIVE)) as archive:
        description = fromstring(archive.read("modelDescription.xml"))
    names = [scalar.attrib["name"] for scalar in description.findall("ModelVariables/ScalarVariable")]
    [unknown] = [
        one
        for one in description.findall("ModelStructure/Outputs/Unknown")
        if names[int(one.attrib["index"]) - 1] == "bit_lateral_force"
    ]
    sources = {names[int(index) - 1] for index in unknown.attrib["dependencies"].split()}
    assert sources == {"rss_force", "active_weight_on_bit", "weight_on_bit"}

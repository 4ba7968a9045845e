"""FMUs of BHAs as they are built: the native flavour drills what `simulate` drills, the Python one refuses them."""

from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import fromstring
from zipfile import ZipFile

import numpy as np
import pytest

from beams_as_built import CASES, reference_bha
from boreprop.case.case import Case, InputSchedule
from boreprop.case.file import dump_case
from boreprop.case.packed import read_packed_case
from boreprop.core.quantities import OUTPUTS, scalar_names
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock
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

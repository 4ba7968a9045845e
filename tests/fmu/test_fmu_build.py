"""The FMU as a file: what it contains and says. It is not run here."""

import os
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import pytest
from fmpy.validation import validate_fmu

from boreprop.case.case import Case
from boreprop.case.packed import CASE_FILE, read_packed_case
from boreprop.core.quantities import BY_NAME, VARIABLES, scalar_names
from boreprop.core.system import BottomHoleAssembly
from boreprop.errors import InputError, ParameterError
from boreprop_fmu.host.drive import FmuRun
from flavours import Flavour, both_flavours, build_to_read


@pytest.fixture(scope="module")
def description(fmu: Path) -> Element:
    with zipfile.ZipFile(fmu) as archive:
        return fromstring(archive.read("modelDescription.xml"))


@both_flavours
@pytest.mark.parametrize("n", [1, 2, 6])
def test_fmpy_finds_no_fault_in_the_description(flavour: Flavour, case: Case, tmp_path: Path, n: int) -> None:
    bha = BottomHoleAssembly(tuple(3.0 * i for i in range(1, n + 1)), (1e-3,) * (n - 1), 0.5, 1e3, 7e6)
    made = build_to_read(replace(case, bha=bha), tmp_path / "Borehole.fmu", flavour)
    assert validate_fmu(str(made)) == []


@both_flavours
def test_every_variable_of_the_table_is_declared_with_its_role_unit_and_bounds(description: Element) -> None:
    scalars = description.findall("ModelVariables/ScalarVariable")
    assert [scalar.get("name") for scalar in scalars] == scalar_names(VARIABLES, 2)
    for scalar in scalars:
        quantity = BY_NAME[scalar.attrib["name"].partition("[")[0]]
        typed = scalar.find(quantity.kind)
        assert typed is not None
        assert scalar.get("causality") == quantity.role
        assert scalar.attrib["description"].startswith(quantity.meaning)
        assert quantity.symbol in scalar.attrib["description"]
        if quantity.kind == "Real":
            assert typed.get("unit") == (quantity.unit or "1")
        least = float(typed.get("min", "-inf"))
        if quantity.name == "active_weight_on_bit":
            assert least == 0.0  # off bottom
        else:  # above: FMI cannot say it
            assert least == quantity.at_least or quantity.above < least < quantity.above + 0.1
        assert float(typed.get("max", "inf")) == quantity.at_most


@both_flavours
def test_units_are_products_of_powers_of_si_base_units(description: Element) -> None:
    expected = {
        "N": "kg m s-2",
        "kg/m3": "kg m-3",
        "N.m": "kg m2 s-2",
        "N.m2": "kg m3 s-2",
        "N/m": "kg s-2",
        "m/s": "m s-1",
        "rad/m": "m-1 rad",
    }
    for unit in description.findall("UnitDefinitions/Unit"):
        base = unit.find("BaseUnit")
        assert base is not None
        powers = " ".join(k + (v if v != "1" else "") for k, v in sorted(base.items()))
        assert powers == expected.get(unit.attrib["name"], unit.attrib["name"].replace("1", ""))


@both_flavours
def test_a_display_value_is_what_an_engineer_expects(description: Element) -> None:
    factors = {
        display.attrib["name"]: float(display.attrib["factor"])
        for display in description.iterfind("UnitDefinitions/Unit/DisplayUnit")
    }
    one_degree = 0.017453292519943295
    assert factors["deg"] * one_degree == pytest.approx(1.0)
    assert factors["deg/30m"] * 3 * one_degree / 30 == pytest.approx(3.0)
    assert factors["m/h"] * 20 / 3600 == pytest.approx(20.0)
    assert factors["kN"] * 2500 == pytest.approx(2.5)


@both_flavours
def test_start_values_are_those_of_the_case(description: Element, case: Case) -> None:
    start = {
        scalar.attrib["name"]: typed.attrib["start"]
        for scalar in description.findall("ModelVariables/ScalarVariable")
        for typed in scalar
        if "start" in typed.attrib
    }
    assert float(start["stabilizer_position[2]"]) == case.bha.stabilizer_positions[1]
    assert float(start["stabilizer_clearance[1]"]) == case.bha.stabilizer_clearances[0]
    assert float(start["bit_tilt_limit"]) == case.bit.tilt_limit
    assert float(start["active_weight_on_bit"]) == case.active_weight_on_bit
    assert float(start["rate_of_penetration"]) == 1.0
    assert start["survey_file"] == ""
    assert set(start) == set(scalar_names(tuple(v for v in VARIABLES if v.role != "output"), 2))


@both_flavours
def test_the_default_experiment_drills_the_length_of_the_case(description: Element, case: Case) -> None:
    experiment = description.find("DefaultExperiment")
    assert experiment is not None
    assert float(experiment.attrib["stopTime"]) == case.length


@both_flavours
def test_hosts_may_use_states_and_many_instances_and_need_no_tool(flavour: Flavour, description: Element) -> None:
    capabilities = description.find("CoSimulation")
    assert capabilities is not None
    assert capabilities.get("needsExecutionTool") == "false"
    assert capabilities.get("canGetAndSetFMUstate") == capabilities.get("canSerializeFMUstate") == "true"
    assert capabilities.get("canBeInstantiatedOnlyOncePerProcess") == "false"
    assert (capabilities.get("canInterpolateInputs") == "true") == flavour.interpolates


@both_flavours
def test_the_case_comes_back_out_of_the_fmu(fmu: Path, case: Case) -> None:
    assert read_packed_case(fmu) == case


@both_flavours
def test_two_builds_are_the_same_bytes_in_any_process(
    flavour: Flavour, fmu: Path, paper_case: Path, tmp_path: Path
) -> None:
    program = "import sys; from boreprop_fmu.pack.build import *; from boreprop import load_case\n"
    program += "build_fmu(load_case(sys.argv[1]), Path(sys.argv[2]), runtime=sys.argv[3])"
    again = tmp_path / "again.fmu"
    command = [sys.executable, "-c", program, str(paper_case), str(again), flavour.runtime]
    subprocess.run(command, check=True, env={**os.environ, "PYTHONHASHSEED": "7"})
    assert again.read_bytes() == fmu.read_bytes()


@both_flavours
def test_another_case_is_another_fmu_with_the_same_code(
    flavour: Flavour, fmu: Path, case: Case, tmp_path: Path
) -> None:
    other = build_to_read(replace(case, length=2 * case.length), tmp_path / "other.fmu", flavour)
    with zipfile.ZipFile(fmu) as a, zipfile.ZipFile(other) as b:
        guids = [fromstring(archive.read("modelDescription.xml")).get("guid") for archive in (a, b)]
        assert guids[0] != guids[1]
        packed = [name for name in a.namelist() if name.startswith(("resources/", "sources/"))]
        assert {name for name in packed if a.read(name) != b.read(name)} == {CASE_FILE, flavour.numbers}


@both_flavours
def test_nothing_is_left_behind_when_the_file_cannot_be_written(flavour: Flavour, case: Case, tmp_path: Path) -> None:
    (tmp_path / "taken.fmu").mkdir()
    with pytest.raises(OSError, match="taken"):
        build_to_read(case, tmp_path / "taken.fmu", flavour)
    assert [path.name for path in tmp_path.iterdir()] == ["taken.fmu"]


@both_flavours
def test_an_fmu_without_our_names_is_refused(fmu: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(fmu) as archive, zipfile.ZipFile(tmp_path / "other.fmu", "w") as other:
        other.writestr("modelDescription.xml", archive.read("modelDescription.xml").replace(b"rss_force", b"pad_force"))
    with pytest.raises(InputError, match=r"other.fmu: must have a variable 'rss_force', got pad_force, "):
        FmuRun(tmp_path / "other.fmu")


@pytest.mark.parametrize(("step", "stop"), [(None, 1e300), (1e-300, None)])
def test_more_steps_than_there_are_times_are_refused(
    case: Case, tmp_path: Path, flavour: Flavour, step: float | None, stop: float | None
) -> None:
    fmu = build_to_read(case, tmp_path / "Borehole.fmu", flavour)
    with pytest.raises(ParameterError, match="step: must be >= "):
        FmuRun(fmu, step=step, stop=stop)

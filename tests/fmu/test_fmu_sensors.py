"""Sensors of FMUs: what `simulate` reads, however long the steps are; a seed that a host may choose; their states."""

import json
from dataclasses import replace
from itertools import product
from math import radians
from pathlib import Path
from xml.etree.ElementTree import fromstring
from zipfile import ZipFile

import numpy as np
import pytest
from test_fmu import host
from test_fmu_description import dependencies, followers

from boreprop.case.case import Case
from boreprop.case.inputs import Schedule
from boreprop.case.packed import read_packed_case
from boreprop.case.parameters import with_parameters
from boreprop.core.quantities import OUTPUTS, quantity_of, scalar_names
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from conftest import Command, Pack
from flavours import NATIVE, Flavour, both_flavours
from fmu_host import instance

SENSED = ("sensor_inclination", "sensor_bending_moment", "sensor_clearance")


@pytest.fixture(scope="module")
def sensed(case: Case) -> Case:
    """The paper's case with a bare sensor and an instrument, and a force that changes on a reading."""
    bha = replace(
        case.bha,
        sensor_positions=(5.0, 2.0),
        sensor_intervals=(0.0, 3.3),
        sensor_biases=(0.0, radians(0.1)),
        sensor_noises=(0.0, radians(0.05)),
        sensor_seeds=(0, 12),
    )
    return replace(case, bha=bha, length=30.0, schedule=Schedule((0.0, 9.9, 17.0), (0.0, 3e3, -2e3)))


@both_flavours
@pytest.mark.parametrize("step", [0.37, 2.2])
def test_an_fmu_reads_what_simulate_reads(
    sensed: Case, flavour: Flavour, pack: Pack, command: Command, tmp_path: Path, step: float
) -> None:
    done = command("boreprop-fmu", "run", pack(sensed, flavour), "--output", "run.csv", "--step", str(step))
    assert done.returncode == 0, done.stderr
    run, expected = read_trajectory(tmp_path / "run.csv"), simulate(sensed, sample_interval=step)
    assert run.stack("sensor_inclination").shape == (run.row_count, 2)
    for name in scalar_names(OUTPUTS, sensed.bha.structure):
        scale = max(1.0, float(np.abs(expected[name]).max()))
        np.testing.assert_allclose(run[name], expected[name], rtol=0, atol=1e-9 * scale, err_msg=name)
    assert len(np.unique(run["sensor_inclination[2]"])) == 1 + int(run["drilled_length"][-1] / 3.3 + 1e-9)


@both_flavours
def test_a_host_may_choose_the_seed(sensed: Case, flavour: Flavour, pack: Pack) -> None:
    fmu, told = pack(sensed, flavour), "sensor_inclination[2]"
    for seed in (12, 13):
        _, after = host("initial", fmu, json.dumps({"sensor_seed[2]": seed}))
        other = simulate(with_parameters(sensed, {"sensor_seed[2]": seed}), length=0.1)
        assert after[told] == pytest.approx(other[told][0], abs=1e-14)


@both_flavours
def test_its_states_hold_the_last_readings(sensed: Case, flavour: Flavour, pack: Pack, tmp_path: Path) -> None:
    first, restored, deserialized = host("rollback", pack(sensed, flavour), tmp_path / "state")
    assert len({row["sensor_inclination[2]"] for row in first}) > 1
    assert first == restored == deserialized


@both_flavours
def test_its_description_has_the_sensors_with_whole_numbers_as_seeds(
    sensed: Case, flavour: Flavour, pack: Pack
) -> None:
    fmu = pack(sensed, flavour)
    with ZipFile(fmu) as archive:
        description = fromstring(archive.read("modelDescription.xml"))
    variables = {v.attrib["name"]: v for v in description.iterfind(".//ScalarVariable")}
    [seed] = variables["sensor_seed[2]"]
    assert (seed.tag, seed.attrib["start"], seed.attrib["max"]) == ("Integer", "12", "2147483647")
    assert variables["sensor_seed[2]"].attrib["causality"] == "parameter"
    assert {variables[f"{name}[2]"].attrib["causality"] for name in SENSED} == {"output"}
    assert read_packed_case(fmu) == sensed


def test_what_sensors_depend_on_at_the_start_is_what_differences_show(sensed: Case, pack: Pack) -> None:
    with ZipFile(pack(sensed, NATIVE)) as archive:
        declared = dependencies(fromstring(archive.read("modelDescription.xml")), "InitialUnknowns")
    found: dict[str, set[str]] = {}
    for clearance, force in product((2e-4, 0.2), (100.0, 3e4)):
        values = {"stabilizer_clearance[1]": clearance}
        for name, outputs in followers(with_parameters(sensed, values), force).items():
            for output in outputs:
                found.setdefault(output, set()).add(name)
    for name in SENSED:
        seen = {quantity_of(one).name for k in (1, 2) for one in found[f"{name}[{k}]"]}
        assert seen == {quantity_of(one).name for k in (1, 2) for one in declared[f"{name}[{k}]"]}


@pytest.mark.parametrize("force", [0.0, 3e3, -2e4])
def test_derivatives_by_the_force_are_difference_quotients(sensed: Case, pack: Pack, force: float) -> None:
    with instance(str(pack(sensed, NATIVE))) as one:
        one.initialize(rss_force=force)
        one.steps(3, 7.0)
        names = [f"{name}[{k}]" for name in SENSED for k in (1, 2)]
        known, unknown = [one.variables["rss_force"].valueReference], [one.variables[n].valueReference for n in names]
        given = dict(zip(names, one.slave.getDirectionalDerivative(unknown, known, [1.0]), strict=True))
        rows = []
        for change in (-1.0, 1.0):
            one.set(rss_force=force + change)
            rows.append(one.row())
        for name in names:
            difference = (rows[1][name] - rows[0][name]) / 2
            assert given[name] == pytest.approx(difference, rel=1e-5, abs=1e-9), name
        assert given["sensor_inclination[2]"] == 0.0  # held until the next reading
        assert given["sensor_inclination[1]"] != 0.0

"""FMUs in layers of rock, with a bit that becomes blunt and clearances that open: exactly what `simulate` drills."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.case.formations import Formation
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.core.ground import Wear
from boreprop.core.quantities import OUTPUTS, scalar_names
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from conftest import Command, Pack
from flavours import NATIVE, Flavour, both_flavours
from fmu_host import instance
from scenarios import report

LENGTH = 21.0
CLEARANCE = "stabilizer_clearance[1]"


@pytest.fixture(scope="module")
def layered(case: Case) -> Case:
    """The paper's case through layers, with wear, and nothing that a host would have to give."""
    return replace(
        case,
        length=LENGTH,
        true_vertical_depth=1000.0,
        formations=(
            Formation(None, 8.0, true_vertical_depth=990.0),
            Formation(None, 20.0, true_vertical_depth=1005.0),
            Formation(None, None, 0.5, 0.01, true_vertical_depth=1012.3),
        ),
        wear=Wear(30.0, 400.0),
    )


@pytest.fixture(scope="module")
def opening(layered: Case) -> Case:
    """The same with forces, and with clearances that open."""
    return replace(
        layered,
        schedule=Schedule((0.0, 4.0), (2e3, -1e3)),
        inputs=InputSchedule((0.0, 6.3, 15.0), ((CLEARANCE, (1e-3, 0.0, 8e-3)),)),
    )


def act(fmu: Path, *actions: list[object]) -> list[Any]:
    """What the actions of fmu_host.py give."""
    answers: list[Any] = report("fmu_host", "act", fmu, json.dumps(actions))
    return answers


def assert_on_row(row: dict[str, float], run: Trajectory, index: int) -> None:
    """A row of an FMU is that of a run, within 1e-9."""
    for name, value in row.items():
        assert value == pytest.approx(run[name][index], rel=0, abs=1e-9 * max(1.0, np.abs(run[name]).max())), name


@pytest.mark.usefixtures("kernel")
@both_flavours
def test_the_command_drills_what_simulate_does(
    opening: Case, flavour: Flavour, pack: Pack, command: Command, tmp_path: Path
) -> None:
    done = command("boreprop-fmu", "run", pack(opening, flavour), "--output", "run.csv", "--step", "1.5")
    assert done.returncode == 0, done.stderr
    run = read_trajectory(tmp_path / "run.csv")
    assert run.case == opening
    expected = simulate(opening, sample_interval=1.5)
    inputs = ("rss_force", "lateral_steering_resistance", "bit_tilt_limit", CLEARANCE)
    for name in (*inputs, *scalar_names(OUTPUTS, opening.structure)):
        scale = max(1.0, float(np.abs(expected[name]).max()))
        np.testing.assert_allclose(run[name], expected[name], rtol=0, atol=1e-9 * scale, err_msg=name)


@pytest.mark.usefixtures("kernel")
@both_flavours
def test_layers_and_wear_need_no_host_and_do_not_depend_on_its_steps(
    layered: Case, flavour: Flavour, pack: Pack
) -> None:
    sizes = (0.25, 5.25, 0.5, 7.0, 0.25, 6.75)
    actions: list[list[object]] = []
    for size in sizes:
        actions += [["step", size], ["row"]]
    answers = act(pack(layered, flavour), *actions)
    assert answers[::2] == ["ok"] * len(sizes)
    expected = simulate(layered, sample_interval=0.25)
    for row, length in zip(answers[1::2], np.cumsum(sizes), strict=True):
        assert_on_row(row, expected, round(length / 0.25))


@both_flavours
def test_rock_that_the_host_gives_takes_the_place_of_layers(layered: Case, flavour: Flavour, pack: Pack) -> None:
    """Until it gives the start value again; η of the layer where the bit is then 20."""
    own = {"lateral_steering_resistance": 12.0}
    *_, given, _, start = act(
        pack(layered, flavour),
        ["step", 6.0],
        ["set", own],
        ["row"],
        ["set", {"lateral_steering_resistance": 8.0}],
        ["row"],
    )
    per_eta = (layered.active_weight_on_bit - 30.0 * 6.0) / layered.bha.force_scale
    assert layered.bit.lateral_steering_resistance == 8.0
    assert (given["formation"], start["formation"]) == (2, 2)
    assert given["eta_pi"] == pytest.approx(12.0 * per_eta, rel=1e-12)
    assert start["eta_pi"] == pytest.approx(20.0 * per_eta, rel=1e-12)


@pytest.mark.usefixtures("kernel")
@both_flavours
def test_a_clearance_may_be_set_between_steps_and_no_other_parameter(
    layered: Case, flavour: Flavour, pack: Pack
) -> None:
    """A step that is discarded takes no clearance over."""
    answers = act(
        pack(layered, flavour),
        ["step", 5.0],
        ["set", {CLEARANCE: 9e-3}],
        ["step", 4.0],
        ["set", {CLEARANCE: -1.0}],
        ["step", 3.0],
        ["set", {CLEARANCE: 2e-3, "rss_force": 1e300}],
        ["step", 3.0],
        ["set", {CLEARANCE: 2e-3, "rss_force": 0.0}],
        ["step", 3.0],
        ["row"],
        ["set", {"rss_position": 0.5}],
    )
    row, refused = answers[-2:]
    statuses = [answer for answer in answers if isinstance(answer, str)]
    assert statuses[:9] == ["ok", "ok", "ok", "ok", "discard", "ok", "discard", "ok", "ok"]
    assert refused == flavour.wrong_call
    opened = InputSchedule((0.0, 5.0, 9.0), ((CLEARANCE, (*layered.bha.stabilizer_clearances, 9e-3, 2e-3)),))
    assert_on_row(row, simulate(replace(layered, inputs=opened), sample_interval=1.0), 12)


@both_flavours
def test_a_state_keeps_layer_and_clearance(layered: Case, flavour: Flavour, pack: Pack) -> None:
    further: list[list[object]] = [["step", 7.0], ["row"]]
    answers = act(
        pack(layered, flavour),
        ["step", 5.5],
        ["set", {CLEARANCE: 9e-3}],
        ["step", 1.0],
        ["save"],
        *further,
        ["set", {CLEARANCE: 1e-3}],
        ["step", 3.0],
        ["back"],
        *further,
    )
    first, second = (answer for answer in answers if isinstance(answer, dict))
    assert first == second
    assert first["formation"] == 3


def test_sensitivities_are_those_of_the_layer_and_of_the_blunt_bit(layered: Case, pack: Pack) -> None:
    """Of ηΠ = η (W − G)/F*; of a rock input that a layer stands in for outputs are independent."""
    with instance(str(pack(layered, NATIVE))) as one:
        one.initialize()
        assert one.step(8.0) == "ok"

        def gain(output: str, given: str) -> float:
            references = [[one.variables[name].valueReference] for name in (output, given)]
            return float(one.slave.getDirectionalDerivative(*references, [1.0])[0])

        scale, blunt = layered.bha.force_scale, 30.0 * 8.0
        assert gain("eta_pi", "active_weight_on_bit") == pytest.approx(20.0 / scale, rel=1e-12)
        assert gain("eta_pi", "lateral_steering_resistance") == 0.0
        assert gain("borehole_inclination", "lateral_steering_resistance") == 0.0
        one.set(lateral_steering_resistance=12.0)
        weight = layered.active_weight_on_bit - blunt
        assert gain("eta_pi", "lateral_steering_resistance") == pytest.approx(weight / scale, rel=1e-12)
        assert gain("eta_pi", "active_weight_on_bit") == pytest.approx(12.0 / scale, rel=1e-12)

"""Derivatives that the native FMU gives: of outputs in time, and by inputs. Checked against differences."""

from pathlib import Path
from xml.etree.ElementTree import fromstring
from zipfile import ZipFile

import pytest
from test_fmu_c_host import COMPILER

from fmu_host import Instance
from native_fmu import refused

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")

SMOOTH = ("drilled_length", "bit_inclination", "average_inclination[1]", "average_inclination[2]", "displacement",
          "true_vertical_depth")  # fmt: skip
FORCES = (0.0, 3e3, -2e4, 6e4)


def by_input(one: Instance, unknown: list[str], name: str, change: float = 1.0) -> dict[str, float]:
    known = [one.variables[name].valueReference]
    references = [one.variables[output].valueReference for output in unknown]
    return dict(zip(unknown, one.slave.getDirectionalDerivative(references, known, [change]), strict=True))


def real_outputs(one: Instance) -> list[str]:
    return [name for name in one.outputs if one.variables[name].type == "Real"]


def modes(row: dict[str, float]) -> list[float]:
    return [value for name, value in row.items() if "contact" in name or name == "bit_tilt_saturation"]


@pytest.mark.parametrize("force", FORCES)
@pytest.mark.parametrize(
    ("name", "step"),
    [
        ("rss_force", 1.0),
        ("active_weight_on_bit", 0.1),
        ("lateral_steering_resistance", 1e-3),
        ("bit_tilt_limit", 1e-6),
    ],
)
def test_by_an_input_it_is_the_difference_quotient_within_the_regime(
    one: Instance, force: float, name: str, step: float
) -> None:
    one.initialize(rss_force=force)
    one.steps(3, 7.0)
    value, row = one.get(name), one.row()
    given = by_input(one, real_outputs(one), name)
    one.set_names({name: value + step})
    above = one.row()
    one.set_names({name: value - step})
    below = one.row()
    assert modes(above) == modes(below) == modes(row)
    for output, derivative in given.items():
        difference = (above[output] - below[output]) / (2 * step)
        assert derivative == pytest.approx(difference, rel=1e-5, abs=1e-9 * max(1.0, abs(row[output]))), output


def test_all_kinds_of_regime_were_among_them(one: Instance) -> None:
    one.initialize()
    seen = set()
    for force in FORCES:
        one.slave.reset()
        one.initialize(rss_force=force)
        seen.add(tuple(modes(one.steps(3, 7.0)[-1])))
    assert len(seen) > 2


def test_what_an_output_does_not_follow_at_once_has_no_derivative(one: Instance) -> None:
    one.initialize()
    assert by_input(one, list(SMOOTH), "rss_force") == dict.fromkeys(SMOOTH, 0.0)
    assert set(by_input(one, real_outputs(one), "rate_of_penetration").values()) == {0.0}


def test_a_change_of_several_inputs_is_the_sum(one: Instance) -> None:
    one.initialize(rss_force=3e3)
    one.steps(2, 5.0)
    references = [one.variables[name].valueReference for name in ("rss_force", "active_weight_on_bit")]
    [together] = one.slave.getDirectionalDerivative([one.variables["bit_tilt"].valueReference], references, [2.0, 3.0])
    apart = [by_input(one, ["bit_tilt"], name, change)["bit_tilt"]
             for name, change in (("rss_force", 2.0), ("active_weight_on_bit", 3.0))]  # fmt: skip
    assert together == pytest.approx(sum(apart), rel=1e-12)


def in_time(one: Instance, *names: str) -> list[float]:
    references = [one.variables[name].valueReference for name in names]
    return list(one.slave.getRealOutputDerivatives(references, [1] * len(references)))


@pytest.mark.parametrize("force", FORCES)
@pytest.mark.parametrize("rate", [1.0, 0.01])
def test_in_time_it_is_the_difference_quotient(one: Instance, force: float, rate: float) -> None:
    one.initialize(rss_force=force, rate_of_penetration=rate, relative_tolerance=1e-11)
    one.steps(3, 7.0 / rate)
    before, size = one.row(), 2e-3 / rate
    one.steps(1, size)
    given = in_time(one, *SMOOTH)
    [after] = one.steps(1, size)
    for name, derivative in zip(SMOOTH, given, strict=True):
        difference = (after[name] - before[name]) / (2 * size)
        # θ' = M/(εηΠ) makes some thousand times of the integrator's error in θ
        assert derivative == pytest.approx(difference, rel=1e-5, abs=1e-7 * rate), name


def test_off_bottom_nothing_changes_in_time(one: Instance) -> None:
    one.initialize(rss_force=3e3)
    one.steps(3, 7.0)
    one.set(active_weight_on_bit=0.0, rate_of_penetration=0.0)
    assert set(in_time(one, *SMOOTH)) == {0.0}
    assert by_input(one, ["eta_pi"], "active_weight_on_bit") == {"eta_pi": 0.0}
    assert by_input(one, ["bit_lateral_force"], "rss_force")["bit_lateral_force"] != 0.0


def test_wrong_calls_are_refused(one: Instance) -> None:
    one.initialize()
    reference = {name: one.variables[name].valueReference for name in ("bit_tilt", "rss_force", "rss_position")}
    with refused(one, "bit_tilt: must be an output that cannot jump to have a derivative"):
        in_time(one, "bit_tilt")
    with refused(one, "bit_tilt: order of the derivative: must be 1, got 2"):
        one.slave.getRealOutputDerivatives([reference["bit_tilt"]], [2])
    with refused(one, "rss_force: must be an output here, got an input"):
        in_time(one, "rss_force")
    with refused(one, "rss_position: must be an input here, got a parameter"):
        by_input(one, ["bit_tilt"], "rss_position")
    with refused(one, "stabilizer_contact[1]: must be used as Integer, got 'Real'"):
        by_input(one, ["stabilizer_contact[1]"], "rss_force")
    assert one.step(1.0) == "ok"


def test_the_description_says_so(borehole: Path) -> None:
    with ZipFile(borehole) as archive:
        simulation = fromstring(archive.read("modelDescription.xml")).find("CoSimulation")
    assert simulation is not None
    assert simulation.get("providesDirectionalDerivative") == "true"
    assert simulation.get("maxOutputDerivativeOrder") == "1"

"""Sensors along the BHA, and survey instruments that read them."""

from collections.abc import Sequence
from dataclasses import replace
from math import degrees, radians
from typing import Any

import numpy as np
import pytest
from scipy import stats

from boreprop.arrays import Floats
from boreprop.case.case import Case
from boreprop.core.errors import ParameterError
from boreprop.core.sensors import mixed, normal
from boreprop.core.system import scale
from boreprop.run.engines import DRILLING, Engine
from element_beam import ElementBeam
from engine_runs import loads_of

FORCE = 3e3  # N
ONCE = (0.0, 1.3, 3.66, 5.0, 7.32)  # m behind the bit


def begin(case: Case, engine: str, positions: Sequence[float], **instrument: Any) -> Engine:
    """The engine at the start of a case whose BHA has sensors."""
    instruments: dict[str, Any] = {f"sensor_{name}": (value,) * len(positions) for name, value in instrument.items()}
    bha = replace(case.bha, sensor_positions=tuple(positions), **instruments)
    return DRILLING[engine](bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit, rss_force=FORCE)


def drill(run: Engine, case: Case, length: float, force: float = FORCE) -> dict[str, float | int]:
    run.advance(length, force, case.active_weight_on_bit)
    return run.outputs()


def along(run: Engine, case: Case, lengths: Sequence[float], name: str = "sensor_inclination[1]") -> list[float]:
    return [drill(run, case, length)[name] for length in lengths]


# where the beam is, and how it is bent


@pytest.mark.parametrize("length", [0.0, 7.0, 31.0])
def test_inclination_moment_and_clearance_are_those_of_a_finite_element_beam(
    case: Case, engine: str, length: float
) -> None:
    run, room = begin(case, engine, ONCE, body_clearances=0.03), 0.03
    found, scaled = drill(run, case, length), scale(case.bha, case.bit)
    l1, F_star = case.bha.length_scale, case.bha.force_scale
    loads = loads_of(scaled, found, FORCE / F_star)
    contact = [found["stabilizer_force[1]"] / F_star]
    for i, s in enumerate(ONCE, 1):
        elements = ElementBeam(scaled, loads, contact, s / l1)
        slope, moment = elements.bent(s / l1)
        assert found[f"sensor_inclination[{i}]"] == pytest.approx(found["bit_inclination"] - slope, abs=1e-11)
        assert found[f"sensor_bending_moment[{i}]"] == pytest.approx(moment * F_star * l1, abs=1e-6)
        if s in case.bha.stabilizer_positions:
            offset = (loads.e[case.bha.stabilizer_positions.index(s)] + elements.at(s / l1)) * l1
            assert found[f"sensor_clearance[{i}]"] == pytest.approx(room - abs(offset), abs=1e-11)


def test_at_the_bit_a_sensor_is_the_bit(case: Case, engine: str) -> None:
    found = drill(begin(case, engine, [0.0], body_clearances=0.02), case, 20.0)
    assert found["sensor_inclination[1]"] == found["bit_inclination"]
    assert found["sensor_bending_moment[1]"] == found["bit_moment"]
    assert found["sensor_clearance[1]"] == 0.02


def test_at_a_stabilizer_on_the_wall_the_body_is_off_by_the_clearance_of_the_blades(case: Case, engine: str) -> None:
    run = begin(case, engine, case.bha.stabilizer_positions, body_clearances=0.03)
    found = drill(run, case, 20.0)
    assert found["stabilizer_contact[1]"] != 0
    assert found["sensor_clearance[1]"] == pytest.approx(0.03 - case.bha.stabilizer_clearances[0], abs=1e-12)
    assert found["sensor_clearance[2]"] == pytest.approx(0.03, abs=1e-12)  # the last one is centred
    assert found["sensor_bending_moment[2]"] == pytest.approx(0.0, abs=1e-6)  # and hinged


def test_sensors_leave_the_run_as_it_is_to_the_bit(case: Case, engine: str) -> None:
    without, with_sensors = begin(case, engine, []), begin(case, engine, ONCE, intervals=0.7)
    for length in np.linspace(0.0, 40.0, 23):
        expected, found = drill(without, case, float(length)), drill(with_sensors, case, float(length))
        assert {name: found[name] for name in expected} == expected
    assert with_sensors.statistics == without.statistics


# readings


def test_an_instrument_reads_every_so_many_metres_and_holds_the_last_reading(case: Case, engine: str) -> None:
    lengths = [0.0, 1.0, 3.999, 4.0, 4.1, 7.9, 8.0, 11.999]
    truth = along(begin(case, engine, [3.0]), case, [0.0, 4.0, 8.0])
    readings = along(begin(case, engine, [3.0], intervals=4.0), case, lengths)
    assert readings == [truth[0]] * 3 + [truth[1]] * 3 + [truth[2]] * 2


def test_readings_do_not_depend_on_where_a_run_stops_on_its_way(case: Case, engine: str) -> None:
    often, seldom = (begin(case, engine, [3.0, 5.0], intervals=2.3) for _ in "ab")
    along(often, case, np.linspace(0.0, 29.0, 211).tolist())
    for i in (1, 2):
        expected = along(seldom, case, [29.0], f"sensor_inclination[{i}]")
        assert drill(often, case, 29.0)[f"sensor_inclination[{i}]"] == expected[0]
    straight = begin(case, engine, [3.0])
    [truth] = along(straight, case, [12 * 2.3])
    assert drill(seldom, case, 29.0)["sensor_inclination[1]"] == pytest.approx(truth, abs=1e-14)


def test_a_reading_is_of_the_force_that_drilled_up_to_there(case: Case, engine: str) -> None:
    run, truth = begin(case, engine, [1.0], intervals=5.0), begin(case, engine, [1.0])
    before, after = drill(truth, case, 5.0), drill(truth, case, 5.0, -FORCE)
    assert abs(before["sensor_inclination[1]"] - after["sensor_inclination[1]"]) > 1e-5
    drill(run, case, 5.0)
    assert drill(run, case, 5.0, -FORCE)["sensor_inclination[1]"] == before["sensor_inclination[1]"]


def test_lengths_that_a_host_has_added_up_reach_a_reading(case: Case, engine: str) -> None:
    run, length = begin(case, engine, [3.0], intervals=1.0), 0.0
    for _ in range(10):
        length += 0.1
    assert length < 1.0
    first = along(begin(case, engine, [3.0]), case, [1.0])
    assert along(run, case, [length]) == pytest.approx(first, abs=1e-12)


def test_steps_of_the_integrator_pass_no_reading_by(case: Case, engine: str) -> None:
    run, other = (begin(case, engine, [3.0], intervals=0.25) for _ in "ab")
    for _ in range(40):
        run.step()
        told = drill(other, case, run.drilled_length)["sensor_inclination[1]"]
        assert run.outputs()["sensor_inclination[1]"] == pytest.approx(told, abs=1e-14)


def test_bias_is_added_with_and_without_an_interval(case: Case, engine: str) -> None:
    for interval in (0.0, 2.0):
        [truth] = along(begin(case, engine, [3.0], intervals=interval), case, [9.0])
        [biased] = along(begin(case, engine, [3.0], intervals=interval, biases=0.01), case, [9.0])
        assert biased == pytest.approx(truth + 0.01, abs=1e-15)


def test_each_reading_has_noise_of_its_own_that_its_seed_gives_again(case: Case, engine: str) -> None:
    noise, lengths = radians(0.1), np.arange(0.0, 200.0, 0.5).tolist()
    truth = np.array(along(begin(case, engine, [3.0], intervals=0.5), case, lengths))

    def errors(seed: int, name: str = "sensor_inclination[1]") -> Floats:
        run = begin(case, engine, [3.0, 3.0], intervals=0.5, noises=noise, seeds=seed)
        told: Floats = np.array(along(run, case, lengths, name)) - truth
        return told

    first = errors(3)
    np.testing.assert_array_equal(first, errors(3))
    others = [errors(4), errors(3, "sensor_inclination[2]")]
    for other in others:
        assert abs(np.corrcoef(first, other)[0, 1]) < 0.2
    assert all(stats.kstest(values / noise, "norm").pvalue > 1e-3 for values in (first, *others))
    expected = [noise * normal(3, 0, number) for number in range(len(lengths))]
    np.testing.assert_allclose(first, expected, atol=1e-14)


def test_a_saved_run_keeps_its_last_reading(case: Case, engine: str) -> None:
    instrument = {"intervals": 4.0, "noises": 1e-3, "seeds": 9}
    run, other = (begin(case, engine, [3.0], **instrument) for _ in "ab")
    drill(run, case, 9.0)
    state = run.save()
    onward = along(run, case, [9.5, 11.0, 12.0, 13.0])
    other.restore(state)
    assert along(other, case, [9.5, 11.0, 12.0, 13.0]) == onward
    run.restore(state)
    assert along(run, case, [9.5, 11.0, 12.0, 13.0]) == onward


def test_after_a_run_that_fails_readings_are_those_before(case: Case, engine: str) -> None:
    run = begin(case, engine, [3.0], intervals=1.0)
    told = drill(run, case, 2.5)
    with pytest.raises(Exception, match=r"turns over|too short|finite"):
        drill(run, case, 500.0, 3e6)
    assert drill(run, case, 2.5) == told


def test_both_engines_read_the_same(case: Case, kernel: None) -> None:
    lengths = np.linspace(0.0, 60.0, 61).tolist()
    native, python = (
        np.array(along(begin(case, engine, [5.0], intervals=3.0, noises=1e-2, seeds=2**31 - 1), case, lengths))
        for engine in ("native", "python")
    )
    assert degrees(np.abs(native - python).max()) < 1e-11


# noise


def test_the_generator_is_splitmix64() -> None:
    """The numbers that its authors' code gives from the seed 1234567."""
    state, numbers = 1234567, []
    for _ in range(3):
        numbers.append(mixed(state))
        state = (state + 0x9E3779B97F4A7C15) % 2**64
    assert numbers == [6457827717110365317, 3203168211198807973, 9817491932198370423]


def test_its_normal_numbers_are_normal_for_any_seed_sensor_and_reading() -> None:
    for numbers in (
        [normal(0, 0, number) for number in range(4000)],
        [normal(seed, 0, 0) for seed in range(4000)],
        [normal(seed, sensor, number) for seed in range(20) for sensor in range(8) for number in range(25)],
    ):
        assert stats.kstest(numbers, "norm").pvalue > 1e-3
        assert abs(np.corrcoef(numbers[1:], numbers[:-1])[0, 1]) < 0.06


# what is refused


@pytest.mark.parametrize(
    ("sensors", "message"),
    [
        ({"sensor_positions": (7.33,)}, "sensor_position[1]: must be <= 7.32, got 7.33"),
        ({"sensor_positions": (1.0, -0.1)}, "sensor_position[2]: must be >= 0, got -0.1"),
        ({"sensor_positions": (1.0,), "sensor_noises": (0.1,)}, "sensor_interval[1]: must be > 0, got 0.0"),
        ({"sensor_positions": (1.0,), "sensor_seeds": (0.5,)}, "sensor_seed[1]: must be a whole number, got 0.5"),
        ({"sensor_positions": (1.0,), "sensor_seeds": (2**31,)}, "sensor_seed[1]: must be <= 2.14748e+09"),
        ({"sensor_positions": (1.0,), "sensor_biases": (1.0, 2.0)}, "sensor_bias: must hold one value per sensor"),
        ({"sensor_positions": (1.0,) * 9}, "sensor_position: must hold at most 8 values"),
    ],
)
def test_sensors_that_cannot_be_are_refused(case: Case, sensors: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError) as refused:
        replace(case.bha, **sensors)
    assert str(refused.value).startswith(message)

"""The native FMU under inputs that change along a step."""

from math import nan, radians

import pytest
from test_fmu_c_host import COMPILER

from fmu_host import Instance
from native_fmu import DISCARD, ramp, refused

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")


def test_a_ramp_of_the_rate_drills_its_integral(one: Instance) -> None:
    one.initialize(rate_of_penetration=2.0)
    ramp(one, rate_of_penetration=-0.3)
    assert one.step(4.0) == "ok"
    assert one.get("drilled_length") == pytest.approx(2.0 * 4 - 0.3 * 4**2 / 2, rel=1e-15)
    assert one.get("rate_of_penetration") == pytest.approx(0.8)
    assert one.step(1.0) == "ok"  # the derivative acted over one step
    assert one.get("drilled_length") == pytest.approx(5.6 + 0.8, rel=1e-15)


def test_the_length_of_a_ramp_is_not_forgotten_when_its_first_rate_comes_back(one: Instance) -> None:
    one.initialize(rate_of_penetration=1.0)
    ramp(one, rate_of_penetration=1.0)
    assert one.step(1.0) == "ok"
    one.set(rate_of_penetration=1.0)
    assert one.step(1.0) == "ok"
    assert one.get("drilled_length") == pytest.approx(1.5 + 1.0, rel=1e-15)


@pytest.mark.parametrize(
    ("name", "start", "end"),
    [
        ("rss_force", 1e3, -2e3),
        ("active_weight_on_bit", 1500.0, 2500.0),
        ("lateral_steering_resistance", 8.0, 25.0),
        ("angular_steering_resistance", 2.0, 0.5),
        ("bit_tilt_limit", 2e-2, 2e-3),
    ],
)
def test_a_ramp_is_the_limit_of_many_small_steps(one: Instance, name: str, start: float, end: float) -> None:
    def drill(steps: int) -> dict[str, float]:
        """Held at the middle of each of so many steps over 8 m, and at the end for another one."""
        one.slave.reset()
        one.initialize(relative_tolerance=1e-9)
        for k in range(steps):
            one.set_names({name: start + (end - start) * (k + 0.5) / steps})
            assert one.step(8.0 / steps) == "ok"
        one.set_names({name: end})
        assert one.step(1.0) == "ok"
        return one.row()

    coarse, fine = drill(40), drill(640)
    one.slave.reset()
    one.initialize(**{name: start}, relative_tolerance=1e-9)
    ramp(one, **{name: (end - start) / 8.0})
    assert one.step(8.0) == "ok"
    assert one.get(name) == pytest.approx(end, rel=1e-14)
    assert one.step(1.0) == "ok"
    row = one.row()
    for output in ("bit_inclination", "average_inclination[1]", "displacement"):
        error = abs(fine[output] - row[output])
        assert error < 1e-3 * abs(row[output]), output
        assert error < 0.2 * abs(coarse[output] - row[output]), output  # second order: 1/256, but for events


def test_ramps_cut_anywhere_are_one_ramp(one: Instance) -> None:
    rows = []
    for steps in (1, 7):
        one.slave.reset()
        one.initialize(rss_force=1e3)
        for _ in range(steps):
            ramp(one, rss_force=250.0, lateral_steering_resistance=1.0, bit_tilt_limit=-2e-3)
            assert one.step(14.0 / steps) == "ok"
        rows.append(one.row())
    assert rows[0] == pytest.approx(rows[1], rel=1e-6, abs=1e-9)


def test_a_ramp_to_a_bad_value_moves_nothing_and_half_of_it_is_good(one: Instance) -> None:
    one.initialize()
    one.set(active_weight_on_bit=2000.0)
    ramp(one, active_weight_on_bit=-1500.0, rss_force=10.0)
    before = one.state()
    with refused(one, "active_weight_on_bit: must be > 0, got -1000.0", DISCARD):
        one.slave.doStep(0.0, 2.0)
    assert one.state() == before
    assert one.step(1.0) == "ok"
    assert (one.get("active_weight_on_bit"), one.get("rss_force")) == (500.0, 10.0)


def test_a_step_that_fails_on_its_way_up_a_ramp_moves_nothing(one: Instance) -> None:
    one.initialize()
    one.steps(3, 0.5)
    ramp(one, active_weight_on_bit=10.0, rss_force=1e9)  # turns the bit over, some metres on
    before = one.state()
    with refused(one, "the bit turns over", DISCARD):
        one.slave.doStep(1.5, 40.0)
    assert one.state() == before


def test_a_weight_fades_with_the_rate_until_the_bit_is_off_bottom_and_comes_back(one: Instance) -> None:
    one.initialize(rate_of_penetration=1.0, active_weight_on_bit=2000.0)
    for sign, weight in ((-1.0, 0.0), (1.0, 2000.0)):
        ramp(one, rate_of_penetration=sign / 4, active_weight_on_bit=sign * 500.0)
        assert one.step(4.0) == "ok"
        assert one.get("active_weight_on_bit") == weight
        row = one.row()
        assert row["eta_pi"] == pytest.approx(weight / 1612.469 * 0.01, rel=1e-6)
        assert abs(row["bit_tilt"]) <= radians(2.0)
    assert one.get("drilled_length") == pytest.approx(4.0, rel=1e-12)


def test_derivatives_that_make_no_sense_are_refused(one: Instance) -> None:
    one.initialize()
    force, tilt = (one.variables[name].valueReference for name in ("rss_force", "bit_tilt"))
    with refused(one, "bit_tilt: must be an input to have a derivative"):
        one.slave.setRealInputDerivatives([tilt], [1], [1.0])
    with refused(one, "rss_force: order of the derivative: must be 1, got 2"):
        one.slave.setRealInputDerivatives([force], [2], [1.0])
    with refused(one, "rss_force: derivative: must be a finite number, got nan"):
        one.slave.setRealInputDerivatives([force, force], [1, 1], [1.0, nan])
    assert one.step(1.0) == "ok"
    assert one.get("rss_force") == 0.0

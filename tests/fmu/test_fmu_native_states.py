"""States of the native FMU that are kept, spoilt and taken over again."""

from ctypes import byref, c_size_t
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest
from fmpy.fmi2 import fmi2FMUstate
from test_fmu_c_host import COMPILER

from boreprop.core.quantities import INPUTS, VARIABLES, scalar_names
from fmu_host import Instance
from native_fmu import ramp, refused

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")


def spoilt(state: bytes) -> dict[str, bytes]:
    format_, guid, size, checksum = state.split(b"\n", 1)[0].split()
    return {
        "nothing": b"",
        "cut": state[:-1],
        "longer": state + b"\0",
        "version": state.replace(format_, format_[:-1] + b"1"),
        "guid": state.replace(guid, guid[::-1]),
        "size": state.replace(size, b"%d" % (int(size) + 1), 1),
        "checksum": state.replace(checksum, checksum[::-1]),
        "body": state[:-100] + bytes([state[-100] ^ 1]) + state[-99:],
    }


def test_a_state_that_is_not_whole_and_its_own_is_refused_and_changes_nothing(one: Instance) -> None:
    one.initialize(rss_force=1e3)
    one.steps(5, 0.9)
    state = one.state()
    assert state.startswith(b"boreprop-native-fmu-state-7 " + one.description.guid.encode())
    for content in spoilt(state).values():
        with refused(one, "state: must be one of this FMU, boreprop-native-fmu-state-7 "):
            one.set_state(content)
        assert one.state() == state


def test_what_no_run_can_have_saved_is_refused_though_its_checksum_is_right(one: Instance) -> None:
    one.initialize()
    one.steps(5, 0.9)
    state = one.state()
    head, body = state.split(b"\n", 1)
    run = 9 + len(INPUTS) + len(scalar_names(VARIABLES, 2))  # where the numbers of the run begin
    for at, number in (
        (0, 3.0),
        (6, nan),
        (8, 1e300),
        (8, nan),
        (run, nan),
        (run + 1, -1.0),
        (run + 15, -1.0),
        (run + 25, inf),
    ):
        spoilt_body = body[: 8 * at] + np.array([number], "<f8").tobytes() + body[8 * at + 8 :]
        checksum = 0xCBF29CE484222325
        for byte in spoilt_body:
            checksum = (checksum ^ byte) * 0x100000001B3 & (2**64 - 1)
        with refused(one, "state: must be "):
            one.set_state(b"%s%016x\n" % (head[:-16], checksum) + spoilt_body)
        assert one.state() == state
    assert one.step(1.0) == "ok"


def test_a_state_says_in_which_phase_it_was_taken(one: Instance) -> None:
    instantiated = one.state()
    stepping = one.initialize().state()
    one.slave.terminate()
    one.set_state(stepping)
    assert one.step(1.0) == "ok"
    one.set_state(instantiated)
    one.set(rss_position=0.7)
    assert one.initialize().get("rss_position") == 0.7


def test_a_state_goes_on_after_a_reset_with_other_parameters_inputs_and_survey(one: Instance, tmp_path: Path) -> None:
    (tmp_path / "survey.csv").write_text("measured_depth,inclination_deg\n0,3\n9,4\n")
    one.set_names({"survey_file": str(tmp_path / "survey.csv"), "stabilizer_clearance[1]": 2e-3})
    one.initialize(rss_force=2e3, rate_of_penetration=0.7)
    one.steps(5, 0.9)
    ramp(one, rss_force=100.0)
    state, time = one.state(), one.time
    rows = one.steps(5, 1.1)
    (tmp_path / "survey.csv").unlink()
    one.slave.reset()
    one.set_state(state)
    one.time = time
    assert one.steps(5, 1.1) == rows
    assert one.get("survey_file").decode() == str(tmp_path / "survey.csv")


def test_a_state_goes_on_in_the_rock_that_it_was_saved_in(one: Instance) -> None:
    one.initialize(rss_force=2e3)
    one.steps(3, 0.9)
    one.set(lateral_steering_resistance=25.0, angular_steering_resistance=0.7, bit_tilt_limit=0.005)
    one.steps(2, 0.9)
    state, time = one.state(), one.time
    rows = one.steps(5, 1.1)
    one.set(lateral_steering_resistance=6.0, bit_tilt_limit=0.03)
    one.steps(2, 0.9)
    one.set_state(state)
    one.time = time
    assert one.steps(5, 1.1) == rows
    assert one.get("lateral_steering_resistance") == 25.0


def test_a_kept_state_may_be_taken_over_again_and_freed_twice(one: Instance) -> None:
    one.initialize()
    kept = fmi2FMUstate()
    for k in range(3):
        one.slave.fmi2GetFMUstate(one.slave.component, byref(kept))
        one.step(1.0 + k)
    one.slave.fmi2SetFMUstate(one.slave.component, kept)
    assert one.get("drilled_length") == 3.0
    size = c_size_t()
    one.slave.fmi2SerializedFMUstateSize(one.slave.component, kept, byref(size))
    with refused(one, f"size: must be at least {size.value}, got {size.value - 1}"):
        one.slave.fmi2SerializeFMUstate(one.slave.component, kept, (b" " * size.value), size.value - 1)
    for _ in range(2):
        one.slave.fmi2FreeFMUstate(one.slave.component, byref(kept))

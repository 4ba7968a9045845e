"""The native FMU as a host calls it, rightly and wrongly."""

from ctypes import byref
from math import inf, isnan, nan
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    defaultCallbacks,
    fmi2CallbackFunctions,
    fmi2Real,
    fmi2StepFinishedTYPE,
    fmi2ValueReference,
)
from test_fmu_c_host import COMPILER

from boreprop.core.quantities import VARIABLES, scalar_names
from fmu_host import Instance
from native_fmu import DISCARD, refused

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")


def test_a_wrong_call_is_an_error_and_the_instance_goes_on(one: Instance) -> None:
    slave, component = one.slave, one.slave.component
    with refused(one, "fmi2DoStep: must be called in another phase, got instantiated"):
        slave.doStep(0.0, 1.0)
    with refused(one, "fmi2Terminate: must be called in another phase, got instantiated"):
        slave.terminate()
    one.initialize()
    count = len(scalar_names(VARIABLES, 2))
    with refused(one, f"value reference: must be 0 to {count - 1}, got {count}"):
        slave.getReal([count])
    with refused(one, "survey_file: must be used as String, got 'Real'"):
        slave.getReal([one.variables["survey_file"].valueReference])
    with refused(one, "stabilizer_contact[1]: must be used as Integer, got 'Boolean'"):
        slave.setBoolean([one.variables["stabilizer_contact[1]"].valueReference], [True])
    with refused(one, "bit_tilt: must not be set, it is an output, got 1.0"):
        one.set(bit_tilt=1.0)
    with refused(one, "bit_tilt_saturation: must not be set, it is an output, got 1"):
        slave.setInteger([one.variables["bit_tilt_saturation"].valueReference], [1])
    with refused(one, "rss_position: must not change after initialization, got 0.5"):
        one.set(rss_position=0.5)
    with refused(one, "survey_file: must not change after initialization, got 'there.csv'"):
        one.set(survey_file="there.csv")
    with refused(one, "fmi2GetReal: must be given addresses to read from and write to, got NULL"):
        slave.fmi2GetReal(component, None, 1, None)
    with refused(one, "fmi2EnterInitializationMode: must be called in another phase, got stepping"):
        slave.enterInitializationMode()
    with refused(one, "fmi2CancelStep: must not be called, no step is ever pending"):
        slave.cancelStep()
    one.set(rss_position=one.get("rss_position"))
    assert one.step(1.0) == "ok"
    slave.terminate()
    with refused(one, "fmi2SetReal: must be called in another phase, got terminated"):
        one.set(rss_force=1.0)
    assert one.get("drilled_length") == 1.0


def test_setting_is_all_or_nothing(one: Instance) -> None:
    one.initialize()
    with refused(one, "eta_pi: must not be set"):
        one.slave.setReal([one.variables[name].valueReference for name in ("rss_force", "eta_pi")], [7.0, 1.0])
    assert one.get("rss_force") == 0.0


def test_another_guid_is_no_instance(one: Instance) -> None:
    one.slave.guid = "{another}"
    with pytest.raises(Exception, match="instantiate"):
        one.slave.instantiate(loggingOn=True)


def test_the_status_of_a_discarded_step_can_be_asked_for(one: Instance) -> None:
    one.initialize(time=10.0)
    assert one.step(0.5) == "ok"
    one.set(rss_force=nan)
    assert one.step(0.5) == "discard"
    assert one.slave.getRealStatus(2) == 10.5
    assert one.slave.getBooleanStatus(3) is True  # fmpy would try the same step for ever
    with refused(one, "fmi2GetStringStatus: must be asked for a status that this FMU has", DISCARD):
        one.slave.getStringStatus(1)
    one.set(rss_force=0.0)
    assert one.step(0.5) == "ok"
    assert one.slave.getBooleanStatus(3) is False


def test_fmpy_ends_where_a_step_is_discarded(borehole: Path) -> None:
    signals = np.array(
        [(0.0, 1.0), (4.0, 1.0), (4.0, -1.0), (9.0, -1.0)], [("time", float), ("rate_of_penetration", float)]
    )
    result = fmpy.simulate_fmu(str(borehole), stop_time=9.0, output_interval=1.0, input=signals, timeout=20.0)
    assert result["time"][-1] == 4.0


def test_outputs_that_cannot_be_computed_are_nan_and_an_error_logged_once(one: Instance) -> None:
    one.initialize()
    one.set(rss_force=inf)
    reference, value = fmi2ValueReference(one.variables["bit_inclination"].valueReference), fmi2Real(0.0)
    with refused(one, "rss_force: must be a finite number, got inf"):
        one.slave.fmi2GetReal(one.slave.component, byref(reference), 1, byref(value))
    assert isnan(value.value)
    with pytest.raises(FMICallException):
        one.get("bit_inclination")
    assert len(one.log) == 1
    one.set(rss_force=0.0)
    assert one.get("bit_inclination") == one.row()["bit_inclination"]


def test_bad_parameters_are_an_error_until_a_reset(one: Instance) -> None:
    one.set(flexural_stiffness=-1.0)
    message = "flexural_stiffness: must be > 0, got -1.0"
    with refused(one, message):
        one.initialize()
    for _ in range(2):
        with refused(one, message):
            one.slave.doStep(0.0, 1.0)
    one.slave.reset()
    assert one.initialize().step(1.0) == "ok"


def test_errors_are_logged_always_and_discards_where_they_are_wanted(one: Instance) -> None:
    def logged() -> list[str]:
        one.log.clear()
        with pytest.raises(FMICallException):
            one.slave.getReal([99])
        assert one.step(nan) == "discard"
        return [category for _, category, _ in one.log]

    one.initialize()
    both = ["logStatusError", "logStatusDiscard"]
    assert logged() == both
    for on, categories, expected in (
        (False, [], both[:1]),
        (True, both[:1], both[:1]),
        (True, both[1:], both),
        (False, both[1:], both[:1]),
        (True, ["logAll"], both),
        (True, [], both),
    ):
        one.slave.setDebugLogging(on, categories)
        assert logged() == expected
    with refused(one, "category: must be logStatusError, logStatusDiscard or logStatusWarning, got 'logEvents'"):
        one.slave.setDebugLogging(True, ["logEvents"])


def test_a_discard_that_no_log_shows_goes_to_stderr_once(one: Instance, capfd: pytest.CaptureFixture[str]) -> None:
    def said(on: bool) -> str:
        one.slave.reset()
        one.initialize(active_weight_on_bit=0.0)
        one.slave.setDebugLogging(on, [])
        assert [one.step(1.0), one.step(1.0)] == ["discard", "discard"]
        return capfd.readouterr().err.partition(": ")[2]

    assert said(False) == "active_weight_on_bit: must be > 0 where rate_of_penetration is > 0, got 0.0\n"
    assert said(True) == ""


def test_setting_texts_is_all_or_nothing(one: Instance) -> None:
    [survey, other] = [one.variables[name].valueReference for name in ("survey_file", "rss_force")]
    with refused(one, "rss_force: must be used as Real, got 'String'"):
        one.slave.setString([survey, other], ["a.csv", "b.csv"])
    assert one.get("survey_file") == b""


def test_a_host_that_adds_up_its_steps_reaches_the_stop_time(one: Instance) -> None:
    one.slave.setupExperiment(startTime=0.0, stopTime=1000.0)
    one.slave.enterInitializationMode()
    one.slave.exitInitializationMode()
    one.time = 0.0
    assert one.step(999.9 + 1e-6) == "ok"  # what rounding may come to in a very long run
    assert one.step(0.1) == "ok"


def test_a_completed_step_is_told_to_a_host_that_asks(one: Instance) -> None:
    told: list[int] = []
    callbacks = fmi2CallbackFunctions(
        logger=defaultCallbacks.logger,
        allocateMemory=defaultCallbacks.allocateMemory,
        freeMemory=defaultCallbacks.freeMemory,
        stepFinished=fmi2StepFinishedTYPE(lambda _, status: told.append(status)),
    )
    one.slave.fmi2FreeInstance(one.slave.component)
    one.slave.instantiate(callbacks=callbacks)
    one.initialize()
    assert (one.step(1.0), one.step(-1.0), one.step(1.0)) == ("ok", "discard", "ok")
    assert told == [0, 0]


def test_standing_still_under_changing_inputs_costs_no_memory(one: Instance) -> None:
    one.initialize(rate_of_penetration=0.0)
    sizes = []
    for force in range(300):
        one.set(rss_force=float(force))
        one.get("bit_tilt")
        assert one.step(0.1) == "ok"
        sizes.append(len(one.state()))
    assert sizes[-1] == sizes[0]

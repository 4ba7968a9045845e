"""The slave inside the FMU: values in, `Drilling` on, values out. No physics.

`build_fmu` packs this file into the core and renames that package after its content: the embedded interpreter finds
modules by name, process-wide, and an FMU must run its own code only. Everything is imported here, at the top: the
directory an FMU was unpacked in may be gone before the process ends.

pythonfmu makes fmi2Fatal of an exception in any callback; to discard a step is its only other way to say no. So no
exception leaves a callback. Bad input is logged, the step discarded, nothing has moved, and the next step with good
input works. A call that must not be made is logged, does nothing, and the next step is discarded.
"""

import json
from collections.abc import Callable
from math import inf, isclose, nan, radians
from pathlib import Path
from typing import Any
from zlib import crc32

from pythonfmu.enums import Fmi2Status
from pythonfmu.fmi2slave import Fmi2Slave

from boreprop.core.checks import check_number, check_quantity
from boreprop.core.columns import read_columns
from boreprop.core.drilling import Drilling
from boreprop.core.errors import BorepropError, ParameterError, TableError
from boreprop.core.ground import ground_of
from boreprop.core.options import Options
from boreprop.core.quantities import MOST_DRILLED, VARIABLES, Quantity, Structure, columns_of, fields_of
from boreprop.core.sag import Watch
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop_fmu.python.process import forget, give_ctrl_c_back, open_log, write_to_user

STATE_FORMAT = "boreprop-fmu-state-8"
INSTANTIATED, INITIALIZATION, STEPPING, TERMINATED = "instantiated", "initialization", "stepping", "terminated"
BEFORE_THE_END = (INSTANTIATED, INITIALIZATION, STEPPING)
TIGHTEST, LOOSEST = 1e-12, 1e-5  # tolerance that a host may choose: some choose 1e-3 always, too coarse for a hole
NOTHING: dict[str, Any] = {"Real": nan, "Integer": 0, "Boolean": False, "String": ""}  # the value of what has none


class SlaveError(BorepropError):
    """The slave cannot do what it was asked. One line that says why."""


class Borehole(Fmi2Slave):  # type: ignore[misc]
    """A borehole being drilled: the RSS force, the active weight on bit and the rate of penetration in, `OUTPUTS` out.

    Value references count the scalar names of `VARIABLES`. ``resources/fmu.json`` gives the start value of every input
    and parameter, the packed survey and the FMU's guid.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        give_ctrl_c_back()
        forget(self.resources)
        packed = json.loads(Path(self.resources, "fmu.json").read_text(encoding="utf-8"))
        self.guid: str = packed["guid"]
        logger, place = kwargs.get("logger"), packed["log_switch"]
        self._log_switch = logger + place if logger and place else None
        self._structure = Structure(*packed["structure"])
        self._ground = packed["ground"] and ground_of(packed["ground"])
        self._survey = Survey(**{name: tuple(values) for name, values in packed["survey"].items()})
        self._scalars = [(name, quantity) for quantity in VARIABLES for name in quantity.names(self._structure)]
        self._given: dict[str, Any] = packed["start"]  # inputs and parameters
        self._weight: float = self._given["active_weight_on_bit"]  # the last that drilled, N
        self._chosen: set[str] = set()  # those of them that have been set
        self._outputs = self._nothing()
        self._stale = True  # the outputs are not those of the present hole under the present inputs
        self._phase = INSTANTIATED
        self._drilling: Drilling | None = None
        self._fault = ""  # why the state is not to be trusted until a good one is set
        self._refused = ""  # what was wrong with a call since the last step
        self._line = self._told = ""  # the last lines that went to the log and to stderr
        self._time, self._stop = 0.0, inf  # where the last step ended, and where none may end beyond
        self._watch = Watch(packed["bit_diameter"] / 2)
        self._anchor = (0.0, 0.0, nan)  # since this time, from this drilled length, at this rate of penetration

    # What a master calls

    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        """Start at this time; end by that time; be as exact as that, unless the parameter for it has been set."""
        self._call("fmi2SetupExperiment", (INSTANTIATED,), self._set_up, start_time, stop_time, tolerance)

    def enter_initialization_mode(self) -> None:
        """From here on an experiment cannot be set up."""
        self._call("fmi2EnterInitializationMode", (INSTANTIATED,), self._go_on_to, INITIALIZATION)

    def exit_initialization_mode(self) -> None:
        """From here on parameters are fixed."""
        if not self._call("fmi2ExitInitializationMode", (INITIALIZATION,), self._go_on_to, STEPPING):
            return
        self._stale = False  # whether it goes well or not: the log says it once
        if not self._safely(self._refresh):
            self._tell_why_it_cannot_start()

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Drill on for `step_size` seconds. False (fmi2Discard): nothing has moved, the log says why."""
        done = self._safely(self._step, current_time, step_size, status=Fmi2Status.discard)
        self._refused = ""
        if not done and self._phase == STEPPING:
            self._tell_why_it_cannot_start()
        return done

    def terminate(self) -> None:
        """From here on values can be read only."""
        self._call("fmi2Terminate", (STEPPING,), self._go_on_to, TERMINATED)

    def get_real(self, vrs: list[int]) -> list[float]:
        """Values of Real variables; NaN where there is none."""
        return self._get(vrs, "Real")

    def get_integer(self, vrs: list[int]) -> list[int]:
        """Values of Integer variables; 0 where there is none."""
        return self._get(vrs, "Integer")

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        """There are no Boolean variables."""
        return self._get(vrs, "Boolean")

    def get_string(self, vrs: list[int]) -> list[str]:
        """Values of String variables."""
        return self._get(vrs, "String")

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        """Take inputs and parameters over, all or none; they are checked when they are used."""
        self._call("fmi2SetReal", BEFORE_THE_END, self._set, vrs, values, "Real")

    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        """Take parameters over, all or none."""
        self._call("fmi2SetInteger", BEFORE_THE_END, self._set, vrs, values, "Integer")

    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        """There are no Boolean variables."""
        self._call("fmi2SetBoolean", BEFORE_THE_END, self._set, vrs, values, "Boolean")

    def set_string(self, vrs: list[int], values: list[str]) -> None:
        """Take parameters over, all or none."""
        self._call("fmi2SetString", BEFORE_THE_END, self._set, vrs, values, "String")

    def _get_fmu_state(self) -> bytes:
        """Everything that evolves, in its serialized form: a copy by nature."""
        kept: list[bytes] = []
        self._safely(lambda: kept.append(self._save()))
        return kept[0] if kept else b""

    def _set_fmu_state(self, state: bytes) -> None:
        """Go back to `state`. After a state that is not this FMU's, every step is discarded until a good one comes."""
        if not self._safely(self._restore, state):
            self._distrust("got a bad one before")

    @staticmethod
    def _fmu_state_to_bytes(state: bytes) -> bytes:
        return state

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> bytes:
        return state

    # What is done then; these raise

    def _nothing(self) -> dict[str, Any]:
        return {name: NOTHING[quantity.kind] for name, quantity in self._scalars if quantity.role == "output"}

    def _go_on_to(self, phase: str) -> None:
        self._phase = phase

    def _set_up(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        check_number("start_time", start_time)
        self._time, self._stop = start_time, inf if stop_time is None else stop_time
        if tolerance is None or "relative_tolerance" in self._chosen:
            return
        if TIGHTEST <= tolerance <= LOOSEST:
            self._given["relative_tolerance"] = tolerance
            self._drilling, self._stale = None, True
        else:
            told = f"tolerance: must be {TIGHTEST:g} to {LOOSEST:g}, got {tolerance!r}"
            self._log(f"{told}; relative_tolerance stays {self._given['relative_tolerance']!r}", Fmi2Status.warning)

    def _bit(self) -> BitRock:
        """Bit and rock as they are given."""
        return BitRock(**fields_of("bit", self._given, self._structure))

    def _build(self, survey: Survey) -> Drilling:
        given = self._given
        return Drilling(
            BottomHoleAssembly(**fields_of("bha", given, self._structure)),
            self._bit(),
            survey,
            active_weight_on_bit=given["active_weight_on_bit"] or self._weight,
            rss_force=given["rss_force"],
            options=Options(given["relative_tolerance"]),
            ground=self._ground,
        )

    def _read_survey(self) -> Survey:
        path = self._given["survey_file"]
        if not path:
            return self._survey
        try:
            measured_depth, inclination_deg = read_columns(path, columns_of("hole"))
            return Survey(measured_depth, tuple(map(radians, inclination_deg)))
        except TableError as error:  # begins with the path
            raise SlaveError(f"{error} (survey_file)") from error
        except ParameterError as error:
            raise SlaveError(f"{path}: {error} (survey_file)") from error

    def _ready(self) -> Drilling:
        """The drilling system, made when it is first needed."""
        if self._fault:
            raise SlaveError(self._fault)
        if self._drilling is None:
            self._drilling = self._build(self._read_survey())
        return self._drilling

    def _check_step(self, current_time: float, step_size: float) -> None:
        """Raise unless the step begins where the last one ended, and ends by the stop time."""
        if self._phase != STEPPING:
            raise SlaveError(f"fmi2DoStep: must be called in another phase, got {self._phase}")
        if self._refused:
            raise SlaveError(f"{self._refused} (before this step)")
        check_number("step_size", step_size, above=0.0)
        if current_time != self._time:
            check_number("current_time", current_time)
            if not isclose(current_time, self._time, rel_tol=1e-14, abs_tol=1e-9 * step_size):  # hosts add up
                raise ParameterError("current_time", f"must be {self._time!r}, where the last step ended", current_time)
        end = current_time + step_size
        if end > self._stop and end > self._stop + 1e-9 * max(abs(self._stop), step_size):  # hosts add up
            check_number("current_time + step_size", end, at_most=self._stop)

    def _step(self, current_time: float, step_size: float) -> None:
        self._check_step(current_time, step_size)
        given, anchor = self._given, self._anchor
        rate, weight = given["rate_of_penetration"], given["active_weight_on_bit"]
        if rate != anchor[2]:
            check_quantity("rate_of_penetration", rate)
        if weight == 0.0 and rate > 0.0:
            raise ParameterError("active_weight_on_bit", "must be > 0 where rate_of_penetration is > 0", weight)
        drilling = self._ready()
        if rate != anchor[2]:
            anchor = (current_time, drilling.drilled_length, rate)
        # from the anchor, so that rounding does not add up from step to step
        drilled_length = max(anchor[1] + rate * (current_time + step_size - anchor[0]), drilling.drilled_length)
        check_number("drilled_length", drilled_length)
        check_number("step_size * rate_of_penetration", drilled_length - drilling.drilled_length, at_most=MOST_DRILLED)
        if weight == 0.0:  # off bottom, as while a pipe is connected: nothing moves
            check_quantity("rss_force", given["rss_force"])
            self._bit()
        else:
            drills = drilled_length > drilling.drilled_length
            self._advance(drilling, drilled_length, weight)
            self._weight, self._stale = weight if drills else self._weight, True
        self._time, self._anchor = current_time + step_size, anchor
        if warning := self._watch.look(drilling):
            self._log(warning, Fmi2Status.warning)
            open_log(self._log_switch)  # else few would hear of it: hosts leave logging off

    def _advance(self, drilling: Drilling, length: float, weight: float) -> None:
        clearances = fields_of("bha", self._given, self._structure)["stabilizer_clearances"]
        drilling.advance_with(clearances, length, self._given["rss_force"], weight, bit=self._bit())

    def _refresh(self) -> None:
        """Outputs of the present hole under the present inputs.

        Off bottom they are those of the last weight that drilled, but for ηΠ, and only looked at: the run goes on as if
        it had never stopped.
        """
        drilling, weight = self._ready(), self._given["active_weight_on_bit"]
        before = None if weight else drilling.save()
        self._advance(drilling, drilling.drilled_length, weight or self._weight)
        self._outputs = drilling.outputs()
        if before:
            drilling.restore(before)
            self._outputs["eta_pi"] = 0.0
        self._stale = False

    def _scalar(self, reference: int, kind: str) -> tuple[str, Quantity]:
        if not 0 <= reference < len(self._scalars):
            raise ParameterError("value reference", f"must be 0 to {len(self._scalars) - 1}", reference)
        name, quantity = self._scalars[reference]
        if quantity.kind != kind:
            raise ParameterError(name, f"must be used as {quantity.kind}", kind)
        return name, quantity

    def _get(self, references: list[int], kind: str) -> list[Any]:
        values = [NOTHING[kind]] * len(references)
        if not self._safely(self._read, references, kind, values):
            self._refused = self._line
        return values

    def _read(self, references: list[int], kind: str, values: list[Any]) -> None:
        for index, reference in enumerate(references):
            name, quantity = self._scalar(reference, kind)
            if quantity.role == "output":
                if self._stale:
                    self._stale = False  # whether it goes well or not: the log says it once
                    if not self._safely(self._refresh):
                        self._outputs = self._nothing()
                values[index] = self._outputs[name]
            else:
                values[index] = self._given[name]

    def _set(self, references: list[int], values: list[Any], kind: str) -> None:
        given, new = self._given, {}
        stepping = self._phase == STEPPING
        for reference, value in zip(references, values, strict=True):
            name, quantity = self._scalar(reference, kind)
            if quantity.role == "output":
                raise ParameterError(name, "must not be set, it is an output", value)
            if value is None:
                raise ParameterError(name, "must be text", value)
            if stepping and quantity.role == "parameter" and not quantity.tunable and value != given[name]:
                raise ParameterError(name, "must not change after initialization", value)
            new[name] = value
        changed = [name for name, value in new.items() if value != given[name]]
        if changed:
            given.update(new)
            self._stale = True
        if not stepping:
            self._chosen.update(new)
            self._drilling = None if changed else self._drilling

    def _save(self) -> bytes:
        state = {
            "given": self._given,
            "chosen": sorted(self._chosen),
            "weight": self._weight,
            "phase": self._phase,
            "fault": self._fault,
            "refused": self._refused,
            "time": self._time,
            "anchor": self._anchor,
            "drilling": self._drilling and self._drilling.save(),
        }
        return self._seal(json.dumps(state, separators=(",", ":")).encode())

    def _seal(self, state: bytes) -> bytes:
        return f"{STATE_FORMAT} {self.guid} {crc32(state):08x}\n".encode() + state

    def _restore(self, sealed: bytes) -> None:
        state_bytes = sealed.partition(b"\n")[2]
        if sealed != self._seal(state_bytes):
            raise SlaveError(f"state: must be one of this FMU, {STATE_FORMAT} {self.guid}, got {sealed[:80]!r}")
        state = json.loads(state_bytes)
        self._given, self._chosen, self._weight = state["given"], set(state["chosen"]), state["weight"]
        self._phase, self._fault, self._refused = state["phase"], state["fault"], state["refused"]
        self._outputs, self._stale = self._nothing(), True
        self._time, self._anchor = state["time"], tuple(state["anchor"])
        self._drilling = None
        self._watch.look_soon()
        if state["drilling"]:
            self._drilling = self._build(self._survey)  # any: the hole is in the state
            self._drilling.restore(state["drilling"])

    # What becomes of errors

    def _call(self, function: str, phases: tuple[str, ...], action: Callable[..., None], *arguments: Any) -> bool:
        """Do what a master asks for if it may ask for it in this phase. If not, the next step is discarded."""
        done = self._phase in phases
        if done:
            done = self._safely(action, *arguments)
        else:
            self._log(f"{function}: must be called in another phase, got {self._phase}", Fmi2Status.error)
        if not done:
            self._refused = self._line
        return done

    def _safely(self, action: Callable[..., None], *arguments: Any, status: Fmi2Status = Fmi2Status.error) -> bool:
        """Do it; log why not."""
        try:
            action(*arguments)
        except BorepropError as error:
            self._log(str(error), status)
            return False
        except Exception as error:  # nobody foresaw it, so nobody knows what has moved
            self._distrust(f"got {type(error).__name__}: {error}")
            self._log(self._fault, status)
            return False
        return True

    def _distrust(self, reason: str) -> None:
        """Discard every step from now on, until a good state is set or the instance reset."""
        self._fault = f"state: must be set to a good one or reset, {reason}"
        self._outputs = self._nothing()

    def _log(self, line: str, status: Fmi2Status) -> None:
        self._line = line
        # a logger formats its message like printf, and a host may put the names of variables for #r0#
        message = line.replace("%", "%%").replace("#", "##")
        self.log(message, status, f"logStatus{status.name.capitalize()}")
        if status is not Fmi2Status.warning:
            open_log(self._log_switch)

    def _tell_why_it_cannot_start(self) -> None:
        """To stderr as well: hosts seldom show the log, and this flavour cannot fail."""
        if self._drilling is None and self._line != self._told:
            write_to_user(f"{self.instance_name}: {self._line}")
            self._told = self._line

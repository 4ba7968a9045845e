"""The FMU that needs no Python: what it contains, and what FMI 2.0 asks of it beyond what both flavours do."""

import subprocess
import zipfile
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import byref, c_size_t
from dataclasses import replace
from math import degrees, inf, isnan, nan
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import canonicalize, fromstring, tostring

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2FMUstate, fmi2Real, fmi2ValueReference
from fmpy.validation import validate_fmu
from test_fmu_c_host import COMPILER

from boreprop.case.case import Case
from boreprop.core.columns import read_columns
from boreprop.core.errors import TableError
from boreprop.core.quantities import VARIABLES, scalar_names
from boreprop.core.system import BottomHoleAssembly
from boreprop.errors import InputError
from boreprop.kernel.compiler import host_platform
from boreprop_fmu.host.drive import drive
from boreprop_fmu.host.instance import open_instance, read_description
from boreprop_fmu.pack.build import build_fmu
from boreprop_fmu.pack.native import FMI_HEADERS
from conftest import Pack
from flavours import NATIVE, PYTHON
from fmu_host import Instance, instance

DISCARD, ERROR = 2, 3

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")


@pytest.fixture(scope="module")
def borehole(case: Case, pack: Pack) -> Path:
    """The paper's case as machine code for this machine."""
    return pack(case, NATIVE)


@pytest.fixture
def one(borehole: Path) -> Iterator[Instance]:
    """An instance of it."""
    with instance(str(borehole)) as made:
        yield made


def contents(fmu: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(fmu) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def stacked(n: int) -> BottomHoleAssembly:
    return BottomHoleAssembly(tuple(3.0 * i for i in range(1, n + 1)), (1e-3,) * (n - 1), 0.5, 1e3, 7e6)


@contextmanager
def refused(one: Instance, message: str, status: int = ERROR) -> Iterator[None]:
    """What is done inside ends with a status and logs one line that begins like this."""
    one.log.clear()
    with pytest.raises(FMICallException) as caught:
        yield
    [(level, category, line)] = one.log
    assert (caught.value.status, level, category) == (status, 3, "logStatusError")
    assert line.startswith(message)


def ramp(one: Instance, **derivatives: float) -> None:
    references = [one.variables[name].valueReference for name in derivatives]
    one.slave.setRealInputDerivatives(references, [1] * len(references), list(derivatives.values()))


# what is in it


def test_both_flavours_describe_themselves_alike(case: Case, pack: Pack, borehole: Path) -> None:
    roots = [fromstring(contents(path)["modelDescription.xml"]) for path in (pack(case, PYTHON), borehole)]
    interpolates = []
    for root in roots:
        del root.attrib["guid"]
        simulation = root.find("CoSimulation")
        assert simulation is not None
        interpolates.append(simulation.attrib.pop("canInterpolateInputs"))
        for files in simulation.findall("SourceFiles"):
            simulation.remove(files)
    assert interpolates == ["false", "true"]
    python, native = (canonicalize(tostring(root), strip_text=True) for root in roots)
    assert python == native


def test_the_table_is_in_the_order_that_the_c_code_counts_on() -> None:
    roles = [variable.role for variable in VARIABLES]
    assert roles == sorted(roles, key=("input", "output", "parameter").index)
    assert [variable.name for variable in VARIABLES if variable.kind == "String"] == ["survey_file"]
    assert not any(variable.kind == "Integer" and variable.role != "output" for variable in VARIABLES)


@pytest.mark.parametrize("n", [1, 2, 6])
def test_the_sources_are_valid_and_compile_without_a_warning(case: Case, tmp_path: Path, n: int) -> None:
    path = build_fmu(replace(case, bha=stacked(n)), tmp_path / "Borehole.fmu", runtime="native", platforms=())
    assert validate_fmu(str(path)) == []
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path)
    command = [
        str(COMPILER),
        "-Wall",
        "-Wextra",
        "-Werror",
        "-shared",
        "-fPIC",
        "-I",
        "sources",
        "sources/fmi2.c",
        "-lm",
    ]
    subprocess.run([*command, "-o", "Borehole.so"], cwd=tmp_path, check=True)


def test_the_headers_of_fmi_are_those_of_the_installed_package(borehole: Path) -> None:
    packed = contents(borehole)
    assert all(b"Modelica Association" in packed[f"sources/{name}"] for name in FMI_HEADERS)
    folder = Path(build_fmu.__code__.co_filename).parent
    assert not any(folder.rglob("fmi2Functions.h"))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"runtime": "java"}, "runtime: must be python or native, got 'java'"),
        ({"platforms": ["linux64"]}, "platforms: must be left out for the runtime python, got linux64"),
        ({"runtime": "native", "platforms": ["linux64", "amiga"]}, "platforms: must be among linux64, .*, got 'amiga'"),
        ({"compiler": "own"}, "compiler: must be left out for the runtime python, got 'own'"),
        ({"runtime": "native", "compiler": "gcc"}, "compiler: must be ziglang or own, got 'gcc'"),
        (
            {"runtime": "native", "compiler": "own", "platforms": ["win64"]},
            "platforms: must be left out for this machine's own compiler, got win64",
        ),
    ],
)
def test_a_flavour_that_there_is_not_is_refused(
    case: Case, tmp_path: Path, arguments: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        build_fmu(case, tmp_path / "Borehole.fmu", **arguments)
    assert list(tmp_path.iterdir()) == []


def test_the_command_says_what_is_inside(command: Any, paper_case: Path, tmp_path: Path) -> None:
    arguments = ["--output", "Borehole.fmu", "--runtime", "native", "--platforms", "none"]
    done = command("boreprop-fmu", "build", paper_case, *arguments)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("Borehole.fmu: 0.0")
    assert done.stdout.endswith(" MB, native: C sources\n")


def test_the_compiler_of_this_machine_may_be_asked_for(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CC", str(COMPILER))
    monkeypatch.setenv("CFLAGS", "-Dnext_character=compiled_here")
    build_fmu(case, tmp_path / "Borehole.fmu", runtime="native", compiler="own")
    binary = contents(tmp_path / "Borehole.fmu")[f"binaries/{host_platform()}/Borehole.so"]
    assert b"compiled_here" in binary


def test_a_compiler_that_fails_is_not_replaced_by_another(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("ziglang")
    (tmp_path / "taken").write_text("a file where zig wants a folder")
    monkeypatch.setenv("ZIG_GLOBAL_CACHE_DIR", str(tmp_path / "taken"))
    with pytest.raises(InputError, match=r"fmi2\.c: must compile with zig, got: "):
        build_fmu(case, tmp_path / "Borehole.fmu", runtime="native")
    assert [path.name for path in tmp_path.iterdir()] == ["taken"]


# calls that are wrong


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
    with refused(one, "fmi2GetRealOutputDerivatives: must not be called"):
        slave.getRealOutputDerivatives([4], [1])
    with refused(one, "fmi2GetDirectionalDerivative: must not be called"):
        slave.getDirectionalDerivative([4], [0], [1.0])
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


# logging


def test_only_what_is_wanted_is_logged(one: Instance) -> None:
    def lines() -> int:
        one.log.clear()
        with pytest.raises(FMICallException):
            one.slave.getReal([99])
        return len(one.log)

    assert lines() == 1
    one.slave.setDebugLogging(False, [])
    assert lines() == 0
    one.slave.setDebugLogging(True, ["logStatusError"])
    assert lines() == 1
    with refused(one, "category: must be logStatusError, got 'logEvents'"):
        one.slave.setDebugLogging(True, ["logEvents"])
    one.slave.setDebugLogging(False, ["logStatusError"])
    assert lines() == 0


# derivatives of inputs


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


def start_with_stop(one: Instance, stop: float) -> None:
    one.slave.reset()
    one.slave.setupExperiment(startTime=0.0, stopTime=stop)
    one.slave.enterInitializationMode()
    one.slave.exitInitializationMode()
    one.time = 0.0


def test_no_step_ends_beyond_the_stop_time(one: Instance) -> None:
    start_with_stop(one, 1.0)
    with refused(one, "current_time + step_size: must be <= 1, got 1.5"):
        one.slave.doStep(0.0, 1.5)
    assert [one.step(0.1) for _ in range(10)] == ["ok"] * 10
    with refused(one, "current_time + step_size: must be <= 1, got "):
        one.slave.doStep(one.time, 0.1)
    one.slave.reset()
    assert one.initialize().step(1.5) == "ok"


def test_a_host_that_adds_up_its_steps_reaches_the_stop_time(one: Instance) -> None:
    start_with_stop(one, 1000.0)
    one.time = 999.9 + 1e-6  # what rounding may come to in a very long run
    assert one.step(0.1) == "ok"


def test_standing_still_under_changing_inputs_costs_no_memory(one: Instance) -> None:
    one.initialize(rate_of_penetration=0.0)
    sizes = []
    for force in range(300):
        one.set(rss_force=float(force))
        one.get("bit_tilt")
        assert one.step(0.1) == "ok"
        sizes.append(len(one.state()))
    assert sizes[-1] == sizes[0]


@pytest.mark.parametrize(("name", "start", "end"), [("rss_force", 1e3, -2e3), ("active_weight_on_bit", 1500.0, 2500.0)])
def test_a_ramp_is_the_limit_of_many_small_steps(one: Instance, name: str, start: float, end: float) -> None:
    def drill(steps: int) -> dict[str, float]:
        """Held at the middle of each of so many steps over 8 m."""
        one.slave.reset()
        one.initialize()
        for k in range(steps):
            one.set_names({name: start + (end - start) * (k + 0.5) / steps})
            assert one.step(8.0 / steps) == "ok"
        one.set_names({name: end})
        return one.row()

    coarse, fine = drill(40), drill(160)
    one.slave.reset()
    one.initialize(**{name: start})
    ramp(one, **{name: (end - start) / 8.0})
    assert one.step(8.0) == "ok"
    assert one.get(name) == end
    row = one.row()
    for output in ("bit_inclination", "average_inclination[1]", "displacement"):
        error = abs(fine[output] - row[output])
        assert error < 1e-3 * abs(row[output]), output
        assert error < 0.2 * abs(coarse[output] - row[output]), output  # second order: a sixteenth


def test_ramps_cut_anywhere_are_one_ramp(one: Instance) -> None:
    rows = []
    for steps in (1, 7):
        one.slave.reset()
        one.initialize(rss_force=1e3)
        for _ in range(steps):
            ramp(one, rss_force=250.0)
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


def test_a_step_that_fails_on_its_way_up_the_stairs_moves_nothing(one: Instance) -> None:
    one.initialize()
    one.steps(3, 0.5)
    ramp(one, active_weight_on_bit=10.0, rss_force=1e9)  # turns the bit over, some metres on
    before = one.state()
    with refused(one, "the bit turns over", DISCARD):
        one.slave.doStep(1.5, 40.0)
    assert one.state() == before


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


# states


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
    assert state.startswith(b"boreprop-native-fmu-state-3 " + one.description.guid.encode())
    for content in spoilt(state).values():
        with refused(one, "state: must be one of this FMU, boreprop-native-fmu-state-3 "):
            one.set_state(content)
        assert one.state() == state


def test_what_no_run_can_have_saved_is_refused_though_its_checksum_is_right(one: Instance) -> None:
    one.initialize()
    one.steps(5, 0.9)
    state = one.state()
    head, body = state.split(b"\n", 1)
    run = 10 + len(scalar_names(VARIABLES, 2))  # where the numbers of the run begin
    for at, number in ((0, 3.0), (9, 1e300), (9, nan), (run, nan), (run + 1, -1.0), (run + 19, inf)):
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


# survey files


def written(path: Path, content: bytes) -> str:
    path.write_bytes(content)
    return str(path)


@pytest.mark.parametrize(
    "content",
    [
        b"measured_depth,inclination_deg\n0,1\n4,2.5\n10,4\n",
        b"\xef\xbb\xbfmeasured_depth,inclination_deg\r\n0,1\r\n\r\n4,2.5\r\n10,4",
        b'name,inclination_deg,measured_depth\n"a, ""b""\n",1,0\nc,2.5,4\nd,+4e0,1.0e+1\n',
        b'\n inclination_deg ,"measured_depth"\n"1" , .0\n2.5," 4 "\n0.4e1,10.\n',
        b"measured_depth,inclination_deg\r0,1\r4,2.500000000000000000000000000000000000000000000000000001\r10,4\r",
    ],
)
def test_a_survey_file_is_read_as_in_python(one: Instance, tmp_path: Path, content: bytes) -> None:
    path = written(tmp_path / "vermessung ü.csv", content)
    assert read_columns(path, ("measured_depth", "inclination_deg")) == [(0.0, 4.0, 10.0), (1.0, 2.5, 4.0)]
    one.initialize(survey_file=path)
    row = one.row()
    assert degrees(row["bit_inclination"]) == pytest.approx(4.0, rel=1e-15)
    assert degrees(row["average_inclination[1]"]) == pytest.approx((4.0 + 4.0 - 3.66 * 0.25) / 2, rel=1e-12)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"depth,inclination\n1,2\n",
        b"measured_depth,inclination_deg\n2,0\n3\n",
        b"measured_depth,inclination_deg\n2,0\n\n3,1,2\n",
        b"measured_depth,inclination_deg\n2,steep\n",
        b"measured_depth,inclination_deg\n2,\n",
        b"measured_depth,inclination_deg\n2,nan\n",
        b"measured_depth,inclination_deg\n1e999,0\n",
        b'measured_depth,inclination_deg\n"1,5",0\n',
        b"measured_depth,inclination_deg\n0x10,0\n",
    ],
)
def test_a_bad_survey_file_is_refused_in_the_same_words(one: Instance, tmp_path: Path, content: bytes) -> None:
    path = written(tmp_path / "survey.csv", content)
    with pytest.raises(TableError) as expected:
        read_columns(path, ("measured_depth", "inclination_deg"))
    with refused(one, f"{expected.value} (survey_file)"):
        one.initialize(survey_file=path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"measured_depth,inclination_deg\n2,0\n1,0\n", "measured_depth: must increase, got (2.0, 1.0) (survey_file)"),
        (b"measured_depth,inclination_deg\n", "measured_depth: must hold at least one station, got () (survey_file)"),
        (bytes(range(256)), "must be a readable CSV file, got: bytes that are no UTF-8 text (survey_file)"),
        (b"measured_depth\0", "must be a readable CSV file, got: bytes that are no UTF-8 text (survey_file)"),
    ],
)
def test_a_survey_that_is_none_is_refused(one: Instance, tmp_path: Path, content: bytes, message: str) -> None:
    path = written(tmp_path / "survey.csv", content)
    with refused(one, f"{path}: {message}"):
        one.initialize(survey_file=path)


def test_a_file_that_cannot_be_read_is_refused(one: Instance, tmp_path: Path) -> None:
    for path, reason in ((tmp_path, "Is a directory"), (tmp_path / "missing", "No such file or directory")):
        with refused(one, f"{path}: must be a readable CSV file, got: {reason} (survey_file)"):
            one.initialize(survey_file=str(path))
        one.slave.reset()


@pytest.mark.slow
def test_binaries_for_other_platforms_are_what_their_folders_say(case: Case, tmp_path: Path) -> None:
    pytest.importorskip("ziglang")
    done: list[float] = []
    machines = {"linux64": 0x3E, "aarch64-linux": 0xB7}  # e_machine of ELF
    fmu = tmp_path / "Borehole.fmu"
    build_fmu(case, fmu, runtime="native", platforms=list(machines), progress=done.append)
    for platform, machine in machines.items():
        binary = contents(fmu)[f"binaries/{platform}/Borehole.so"]
        assert (binary[:4], int.from_bytes(binary[18:20], "little")) == (b"\x7fELF", machine)
    assert done == [1, 2]


def test_a_folder_of_any_name_will_do(borehole: Path, command: Any, tmp_path: Path, monkeypatch: Any) -> None:
    (tmp_path / "tü %").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tü %"))
    done = command("boreprop-fmu", "run", borehole, "--output", "run.csv")
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(host_platform() != "linux64", reason="renames the binary for linux64")
def test_on_arm_the_binary_for_arm_is_run(borehole: Path, tmp_path: Path) -> None:
    moved = tmp_path / "Borehole.fmu"
    with zipfile.ZipFile(moved, "w") as archive:
        for name, content in contents(borehole).items():
            archive.writestr(name.replace("linux64", "aarch64-linux"), content)
    with pytest.raises(InputError, match="must load on this machine, got: Cannot find shared library"):
        drive(moved, step=10.0)
    here = open_instance(moved, read_description(moved), deque(), start=0.0, stop=1.0, platform="aarch64-linux")
    with here as slave:
        slave.exitInitializationMode()
        slave.doStep(0.0, 1.0)
        [drilled] = slave.getReal([scalar_names(VARIABLES, 2).index("drilled_length")])
    assert drilled == 1.0

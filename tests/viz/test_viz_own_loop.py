"""The live view of one's own loop: what is sent is drawn, whatever becomes of the loop, the disk or the viewer."""

import json
import os
import signal
import subprocess
import sys
import warnings
import zipfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any, NamedTuple

import numpy as np
import pytest
from rerun.chunk import RrdReader

from boreprop.case.case import Case
from boreprop.case.file import dump_case
from boreprop.case.inputs import Schedule
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz import live, sinks
from boreprop_viz.source import gather
from boreprop_viz.stream import RunStream
from boreprop_viz.style import DECIMALS
from forking import run_script, start
from rrd import read, stacked, static
from viewers import rerun, signals, sound, until

Row = dict[str, Any]

IN_TWENTY_LINES = """
import sys
import fmpy
from fmpy.fmi2 import FMU2Slave
import boreprop_viz

path, save = sys.argv[1:]
description = fmpy.read_model_description(path)
variables = [v for v in description.modelVariables if v.causality in ("input", "output")]
number = {v.name: v.valueReference for v in variables}
modules = description.coSimulation.modelIdentifier
fmu = FMU2Slave(guid=description.guid, unzipDirectory=fmpy.extract(path), modelIdentifier=modules, instanceName="b")
fmu.instantiate()
fmu.setupExperiment(startTime=0.0)
fmu.enterInitializationMode()
fmu.exitInitializationMode()
with boreprop_viz.live(path, save=save) as view:
    for k in range(81):
        values = {v.name: (fmu.getInteger if v.type == "Integer" else fmu.getReal)([number[v.name]])[0] for v in variables}
        view.send(time=0.5 * k, **values)
        fmu.setReal([number["rss_force"]], [3000.0 if values["drilled_length"] < 20.0 else -2000.0])
        fmu.doStep(0.5 * k, 0.5)
fmu.terminate()
"""  # noqa: E501

ROUNDED = 0.51 * 10.0**-DECIMALS  # what the plots leave out


def test_a_loop_of_twenty_lines_around_an_fmu_is_drawn(case: Case, fmu: Path, tmp_path: Path) -> None:
    saved = tmp_path / "loop.rrd"
    done = run_script(["-c", IN_TWENTY_LINES, fmu, saved])
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert sound(saved)
    expected = simulate(
        replace(case, schedule=Schedule((0.0, 20.0), (3000.0, -2000.0))), length=40.0, sample_interval=0.5
    )
    bit = read(saved, "vertical_section/bit", "Points2D:positions")
    assert list(bit) == list(range(0, 40001, 500))
    positions = np.column_stack((expected["displacement"], expected["true_vertical_depth"]))
    np.testing.assert_allclose(np.array(list(bit.values()))[:, 0], positions, atol=1e-5)
    moments = read(saved, "plots/rss_force/rss_force", "Scalars:scalars", "simulation_time")
    forces = [moments[tick] for tick in sorted(moments)]
    np.testing.assert_allclose(np.ravel(forces), [0.0] + [3.0] * 40 + [-2.0] * 40)


@pytest.fixture(scope="module")
def run(case: Case) -> Trajectory:
    """A run of half a metre a second, of which rows are sent here."""
    steered = replace(case, schedule=Schedule((0.0, 4.0), (5000.0, -3000.0)), length=10.0)
    run = simulate(steered, sample_interval=0.1)
    return replace(run, columns={"time": 2 * run["drilled_length"]} | run.columns)


@pytest.fixture(scope="module")
def rows(run: Trajectory) -> list[Row]:
    """The rows of the run."""
    return [dict(zip(run, values, strict=True)) for values in np.column_stack(list(run.values())).tolist()]


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    return tmp_path / "saved.rrd"


@pytest.fixture
def old(saved: Path) -> Path:
    """A file that is there already."""
    saved.write_text("old")
    return saved


def drilled(path: Path) -> list[int]:
    """The ticks at which a recording has a bit."""
    return sorted(read(path, "vertical_section/bit", "Points2D:positions"))


def ticks(rows: list[Row]) -> list[int]:
    return [round(1000 * row["drilled_length"]) for row in rows]


def test_values_of_all_stabilizers_may_come_together(run: Trajectory, rows: list[Row], saved: Path) -> None:
    quantities = {name.partition("[")[0] for name in run}
    assert run.case
    with live(run.case, save=saved) as view:
        for row in rows:
            together: Row = {
                quantity: row[quantity]
                if quantity in row
                else [v for n, v in row.items() if n.startswith(f"{quantity}[")]
                for quantity in quantities
            }
            view.send(**together | {"eta_pi": np.float32(row["eta_pi"]), "bit_tilt": np.array(row["bit_tilt"])})
    for name, scale in (("stabilizer_force", 1e-3), ("bit_lateral_force", 1e-3)):
        curve = "stabilizer_force/stabilizer_force_1" if name == "stabilizer_force" else f"{name}/{name}"
        found = stacked(saved, f"plots/{curve}", "Scalars:scalars")[:, 0]
        expected = run["stabilizer_force[1]"] if name == "stabilizer_force" else run[name]
        np.testing.assert_allclose(found, scale * expected, atol=ROUNDED)


def test_what_each_row_determines_may_be_left_out(run: Trajectory, rows: list[Row], saved: Path) -> None:
    needed = ("time", "drilled_length", "displacement", "true_vertical_depth", "rss_force", "active_weight_on_bit")
    angles = ("bit_inclination", "bit_tilt", "average_inclination[1]", "average_inclination[2]")
    assert run.case
    with live(run.case, save=saved) as view:
        for row in rows:
            view.send(**{name: row[name] for name in (*needed, *angles)})
    for curve, expected in (
        ("inclination/borehole_inclination", np.degrees(run["borehole_inclination"])),
        ("stabilizer_force/stabilizer_force_1", run["stabilizer_force[1]"] / 1000),
        ("bit_lateral_force/bit_lateral_force", run["bit_lateral_force"] / 1000),
    ):
        np.testing.assert_allclose(stacked(saved, f"plots/{curve}", "Scalars:scalars")[:, 0], expected, atol=ROUNDED)
    words = read(saved, "modes/stabilizer_1", "StateChange:state")
    contact = dict(zip(ticks(rows), run["stabilizer_contact[1]"].tolist(), strict=True))
    pairs = {(contact[tick], word) for tick, [word] in words.items()}
    assert len(pairs) == len({word for _, word in pairs}) == len(set(contact.values())) > 1


@pytest.mark.parametrize(("kind", "name"), [("case", "run"), ("file", "drilled"), ("fmu", "Borehole")])
def test_the_case_comes_as_such_or_in_a_file(
    run: Trajectory, rows: list[Row], saved: Path, fmu: Path, kind: str, name: str
) -> None:
    assert run.case
    file = saved.with_name("drilled.toml")
    file.write_text(dump_case(run.case))
    given: dict[str, Case | str | Path] = {"case": run.case, "file": file, "fmu": str(fmu)}
    with live(given[kind], save=saved) as view:
        view.send(**rows[0])
    [store] = RrdReader(saved).recordings()
    assert store.application_id.startswith(f"boreprop: {name} ")


def test_the_plan_is_drawn(run: Trajectory, rows: list[Row], saved: Path) -> None:
    assert run.case
    start = run.case.survey.measured_depth[-1]
    plan = saved.with_name("plan.csv")
    plan.write_text(f"measured_depth,inclination_deg\n{start},0\n{start + 20.0},0\n")
    with live(run.case, plan, save=saved) as view:
        for row in rows[:3]:
            view.send(**row)
    [[strip]] = static(saved, "vertical_section/plan", "LineStrips2D:strips")
    np.testing.assert_allclose(strip[-1], [0.0, 20.0], atol=1e-4)


# What is wrong with a row is said when it is sent


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"displacement": None}, "must have a column 'displacement'"),
        ({"average_inclination[2]": None}, r"must have a column 'average_inclination\[2\]'"),
        ({"borehole_inclination": None, "bit_inclination": None}, "must have a column 'bit_inclination'"),
        ({"bit_inclinaton": 0.1}, "send: must be given time and inputs and outputs of the FMU alone, got 'bit_incl"),
        ({"stabilizer_force[2]": 0.1}, r"outputs of the FMU alone, got 'stabilizer_force\[2\]'"),
        ({"stabilizer_force": [1.0, 2.0]}, r"stabilizer_force: must have 1 values, got the shape \(2,\)"),
        ({"bit_tilt": [0.1, 0.1]}, r"bit_tilt: must have 1 values, got the shape \(2,\)"),
        ({"bit_tilt": "steep"}, "bit_tilt: must be a number, or one for each stabilizer, got 'steep'"),
        ({"bit_tilt": float("nan")}, "bit_tilt: must be a finite number, got nan at 0 s"),
        ({"time": float("inf")}, "time: must be a finite number, got inf"),
    ],
)
def test_a_first_row_that_cannot_be_drawn_is_refused(
    run: Trajectory, rows: list[Row], old: Path, change: Row, message: str
) -> None:
    row = {name: value for name, value in (rows[0] | change).items() if value is not None}
    assert run.case
    with pytest.raises(InputError, match=message) as caught, live(run.case, save=old) as view:
        view.send(**row)
    assert "\n" not in str(caught.value)
    assert old.read_text() == "old"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rss_force": None}, "send: must be given the same values each time, got a difference in rss_force"),
        ({"stabilizer_force": [1.0], "stabilizer_force[1]": None, "bit_tilt": float("nan")}, "bit_tilt: must be a fin"),
        ({"drilled_length": 0.05}, "drilled_length: must not decrease, got 0.05 after 0.1"),
        ({"time": 0.1}, "time: must not decrease, got 0.1 after 0.2"),
    ],
)
def test_so_is_a_later_one_and_the_loop_may_go_on(
    run: Trajectory, rows: list[Row], saved: Path, change: Row, message: str
) -> None:
    assert run.case
    with live(run.case, save=saved) as view:
        view.send(**rows[0])
        view.send(**rows[1])
        with pytest.raises(InputError, match=message):
            view.send(**{name: value for name, value in (rows[2] | change).items() if value is not None})
        view.send(**rows[2])
    assert drilled(saved) == ticks(rows[:3])
    with pytest.raises(InputError, match=r"send: must be called inside the with block, got a row at 0\.6 s after its"):
        view.send(**rows[3])


def test_while_the_bit_stands_still_the_rows_differ_in_time(run: Trajectory, rows: list[Row], saved: Path) -> None:
    assert run.case
    with live(run.case, save=saved) as view:
        for seconds in range(10):
            view.send(**rows[5] | {"time": float(seconds), "rss_force": 8000.0 * (-1) ** seconds})
    shown = read(saved, "plots/rss_force/rss_force", "Scalars:scalars", "simulation_time")
    assert [shown[tick] for tick in sorted(shown)] == [[8.0 * (-1) ** seconds] for seconds in range(10)]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "spawn, serve, connect, save: one must be given, got none"),
        ({"spawn": True, "serve": True}, "spawn, serve, connect: at most one must be given, got 2"),
        ({"save": "run.csv"}, "run.csv: must end in .rrd, got '.csv'"),
        ({"save": "nowhere/run.rrd"}, "must be in a directory that can be written to"),
        ({"save": "run.rrd", "case_or_fmu": "run.csv"}, "run.csv: must be a case, or end in .toml or .fmu, got '.csv'"),
        ({"save": "run.rrd", "plan": Survey((100.0, 200.0), (0.0, 0.0))}, "measured_depth of the plan: must include"),
    ],
)
def test_an_argument_that_cannot_be_used_is_named(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: Row, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    given: Row = {"case_or_fmu": case} | arguments
    with pytest.raises(InputError, match=message), live(**given):
        raise AssertionError
    assert not list(tmp_path.iterdir())


def test_an_fmu_without_a_case_is_refused(tmp_path: Path, fmu: Path) -> None:
    foreign = tmp_path / "Foreign.fmu"
    with zipfile.ZipFile(fmu) as ours, zipfile.ZipFile(foreign, "w") as theirs:
        theirs.writestr("modelDescription.xml", ours.read("modelDescription.xml"))
    with pytest.raises(InputError, match=r"Foreign\.fmu: must hold a case"), live(foreign, save=tmp_path / "run.rrd"):
        raise AssertionError


# The end


class OwnError(Exception):
    """Something that goes wrong in the loop."""


@pytest.mark.parametrize("kind", [OwnError, KeyboardInterrupt])
def test_after_an_exception_the_file_has_all_that_was_sent(
    run: Trajectory, rows: list[Row], old: Path, kind: type[BaseException], capsys: pytest.CaptureFixture[str]
) -> None:
    error = kind("in the loop")
    assert run.case
    with pytest.raises(kind) as caught, live(run.case, save=old) as view:  # noqa: PT012
        for row in rows:
            view.send(**row)
        raise error
    assert caught.value is error
    assert (error.__cause__, error.__context__) == (None, None)
    assert sound(old)
    assert drilled(old) == ticks(rows)
    verdict = read(old, "verdict", "TextDocument:text")
    assert {OwnError: "stopped at 17.3 m: OwnError: in the loop", KeyboardInterrupt: "interrupted at 17.3 m"}[
        kind
    ] in verdict[max(verdict)][0]
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("kind", [OwnError, KeyboardInterrupt, None])
def test_without_a_row_the_old_file_stays(
    case: Case, old: Path, kind: type[BaseException] | None, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(kind or InputError) as caught, live(case, save=old):  # noqa: PT012
        if kind:
            raise kind
    message = "send: must be called at least once in the with block, got no row to draw"
    assert message in (capsys.readouterr().err if kind else str(caught.value))
    assert old.read_text() == "old"
    assert list(old.parent.iterdir()) == [old]


class Held(NamedTuple):
    """Nothing is drawn before `go_on` is set; `arrived` is set when there is something to draw."""

    arrived: Event
    go_on: Event


@pytest.fixture
def held(monkeypatch: pytest.MonkeyPatch) -> Iterator[Held]:
    held, send = Held(Event(), Event()), RunStream.send

    def wait(stream: RunStream, stretch: Any) -> Any:
        held.arrived.set()
        assert held.go_on.wait(60.0)
        return send(stream, stretch)

    monkeypatch.setattr(RunStream, "send", wait)
    yield held
    held.go_on.set()


def test_the_loop_goes_on_while_nothing_can_be_drawn(run: Trajectory, rows: list[Row], saved: Path, held: Held) -> None:
    assert run.case
    with live(run.case, save=saved) as view:
        for row in rows:
            view.send(**row)
        held.go_on.set()  # the loop has come to its end before anything is drawn
    assert drilled(saved) == ticks(rows)


def test_who_cannot_wait_for_the_rest_gets_what_is_drawn(
    run: Trajectory, rows: list[Row], saved: Path, held: Held, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert run.case
    with pytest.raises(KeyboardInterrupt), live(run.case, save=saved) as view:  # noqa: PT012
        for row in rows:
            view.send(**row)
        assert held.arrived.wait(60.0)
        join = view._thread.join

        def interrupted() -> None:
            monkeypatch.setattr(view._thread, "join", go_on)
            raise KeyboardInterrupt

        def go_on() -> None:
            held.go_on.set()
            join()

        monkeypatch.setattr(view._thread, "join", interrupted)
    assert sound(saved)
    assert drilled(saved) == [0]


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> Event:
    """A disk that is full after the first row; set when that was found."""
    found, send = Event(), RunStream.send

    def fail(stream: RunStream, stretch: Any) -> Any:
        if stream.hole is not None:
            found.set()
            raise OSError("the disk is full")
        return send(stream, stretch)

    monkeypatch.setattr(RunStream, "send", fail)
    return found


def test_a_full_disk_is_an_error_at_the_end(run: Trajectory, rows: list[Row], old: Path, broken: Event) -> None:
    steps = 0
    assert run.case
    with pytest.raises(OSError, match="the disk is full"), live(run.case, save=old) as view:  # noqa: PT012
        for row in rows[:10]:
            view.send(**row)
        assert broken.wait(60.0)
        for row in rows[10:]:
            view.send(**row)
            steps += 1
    assert steps == len(rows) - 10
    assert old.read_text() == "old"


def test_it_does_not_hide_an_exception_of_the_loop(
    run: Trajectory, rows: list[Row], old: Path, broken: Event, capsys: pytest.CaptureFixture[str]
) -> None:
    error = OwnError("in the loop")
    assert run.case
    with pytest.raises(OwnError) as caught, live(run.case, save=old) as view:  # noqa: PT012
        for row in rows:
            view.send(**row)
        broken.wait(60.0)
        raise error
    assert caught.value is error
    assert capsys.readouterr().err == "warning: the disk is full\n"
    assert old.read_text() == "old"


@signals
def test_a_viewer_that_is_there_gets_all_rows(run: Trajectory, rows: list[Row], tmp_path: Path) -> None:
    seen = tmp_path / "seen.rrd"

    def all_there() -> bool:
        with warnings.catch_warnings(), suppress(ValueError, RuntimeError):  # no recording yet, half a chunk
            warnings.filterwarnings("ignore", message="RRD file has no footer")
            return drilled(seen) == ticks(rows)
        return False

    assert run.case
    with rerun("--save", seen) as (_, address):
        with live(run.case, connect=address) as view:
            for row in rows:
                view.send(**row)
        assert until(all_there)


@signals
def test_the_loop_goes_on_when_the_viewer_is_gone(
    run: Trajectory,
    rows: list[Row],
    saved: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sinks, "PATIENCE", 2.0)
    assert run.case
    with rerun("--serve-grpc") as (viewer, address), live(run.case, connect=address, save=saved) as view:
        for row in rows:
            view.send(**row)
            if row is rows[50]:
                viewer.kill()
                viewer.wait()
    assert drilled(saved) == ticks(rows)
    [warning] = [line for line in capfd.readouterr().err.splitlines() if line.startswith("warning: ")]
    assert "may not have received all data" in warning


@signals
def test_control_c_in_the_loop_of_a_script_keeps_what_was_sent(
    run: Trajectory, tmp_path: Path, rows: list[Row], saved: Path
) -> None:
    assert run.case
    (tmp_path / "case.toml").write_text(dump_case(run.case))
    (tmp_path / "rows.json").write_text(json.dumps(rows))
    program = """
import json, time
import boreprop_viz
with boreprop_viz.live("case.toml", save="saved.rrd") as view:
    for row in json.load(open("rows.json")):
        view.send(**row)
    print("sent", flush=True)
    time.sleep(60.0)
"""
    loop = start(["-c", program], cwd=tmp_path)
    try:
        assert loop.stdout
        assert loop.stdout.readline() == b"sent\n"
        os.kill(loop.pid, signal.SIGINT)
        _, said = loop.communicate()
    finally:
        loop.kill()
    assert loop.returncode == -signal.SIGINT
    assert said.splitlines()[-1] == b"KeyboardInterrupt"
    assert b"boreprop_viz" not in said  # the traceback is that of the loop alone
    assert drilled(saved) == ticks(rows)


def test_a_pause_of_the_loop_shows_all_rows_before_it() -> None:
    taken = gather([[0.0], None, [1.0], [2.0], None], batch=10)
    assert next(taken) == [[0.0]]
    assert list(taken) == [[[1.0], [2.0]]]


def test_the_package_alone_does_not_load_rerun() -> None:
    script = "import sys, boreprop_viz; print('rerun' in sys.modules, 'numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]

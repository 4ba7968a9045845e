"""What the viewer draws: results of any tool, and FMUs that drill while it draws."""

import os
import signal
import sysconfig
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.case.inputs import Schedule
from boreprop.core.quantities import OUTPUTS, scalar_names
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_fmu.pack.build import build_fmu
from boreprop_viz.record import record
from boreprop_viz.source import paced
from conftest import Command
from forking import run_script, start
from rrd import read, stacked, static

LIVE = """
import sys
from boreprop_fmu.host.drive import FmuRun
from boreprop_viz.record import Drawing
from boreprop_viz.sinks import open_recording
from boreprop_viz.record import record
from boreprop_viz.source import live, stored

fmu, now, then = sys.argv[1:]
with open_recording(save=now) as rec:
    Drawing.of([live("live", FmuRun(fmu, step=0.25, stop=60.0), batch=50)]).draw(rec)
with open_recording(save=then) as rec:
    Drawing.of([stored("stored", FmuRun(fmu, step=0.25, stop=60.0).trajectory(), batch=50)]).draw(rec)
"""


def test_a_run_is_drawn_alike_while_its_fmu_drills_and_afterwards(fmu: Path, tmp_path: Path) -> None:
    live, stored = tmp_path / "live.rrd", tmp_path / "stored.rrd"
    done = run_script(["-c", LIVE, fmu, live, stored])
    assert done.returncode == 0, done.stderr
    for entity, component in (
        ("vertical_section/drilled_hole", "LineStrips2D:strips"),
        ("bit_frame/walls", "LineStrips2D:strips"),
        ("bit_frame/tilt/bit_axis", "LineStrips2D:strips"),
        ("plots/build_rate/build_rate", "Scalars:scalars"),
        ("plots/ripple/ripple", "Scalars:scalars"),
        ("modes/stabilizer_1", "StateChange:state"),
    ):
        now, then = read(live, entity, component), read(stored, entity, component)
        assert list(now) == list(then)
        for tick, values in then.items():
            if component == "StateChange:state":
                assert now[tick] == values
            else:
                np.testing.assert_allclose(now[tick], values, atol=1e-4)


def test_the_command_drills_an_fmu_under_a_schedule(command: Command, fmu: Path, tmp_path: Path) -> None:
    (tmp_path / "forces.csv").write_text("drilled_length,force\n0,1000\n2,-3000\n")
    done = command(
        "boreprop-view", fmu, "--schedule", "forces.csv", "--step", "0.5", "--stop", "4", "--save", "live.rrd"
    )
    assert (done.returncode, done.stderr) == (0, "")
    shown = stacked(tmp_path / "live.rrd", "plots/rss_force/rss_force", "Scalars:scalars")[:, 0]
    np.testing.assert_allclose(shown, [1.0] * 4 + [-3.0] * 5)


class Clock:
    """A clock that stands still but for what one waits and does."""

    def __init__(self) -> None:
        self.now = 100.0

    def tell(self) -> float:
        return self.now

    def wait(self, seconds: float) -> None:
        assert seconds > 0.0
        self.now += seconds


def test_a_paced_row_comes_when_it_is_due() -> None:
    clock = Clock()
    given = []
    for row in paced([[7.0, 20.0], [7.0, 21.0], None, [7.0, 21.0], [7.0, 25.0]], 1, 2.0, clock.tell, clock.wait):
        given.append((clock.now, row))
        if len(given) == 1:
            clock.now += 5.0  # the viewer starts
    assert given == [
        (100.0, [7.0, 20.0]),
        (105.5, [7.0, 21.0]),
        (105.5, None),
        (105.5, [7.0, 21.0]),
        (107.5, [7.0, 25.0]),
    ]


def test_who_is_late_does_not_wait_and_catches_up() -> None:
    clock = Clock()
    given = []
    for row in paced([[0.0], [1.0], [2.0], [3.0]], 0, 1.0, clock.tell, clock.wait):
        given.append((clock.now, row))
        clock.now += 1.75 * (row == [1.0])  # drilling takes long
    assert given == [(100.0, [0.0]), (101.0, [1.0]), (102.75, [2.0]), (103.0, [3.0])]


def test_the_command_keeps_a_pace(command: Command, fmu: Path, tmp_path: Path) -> None:
    done = command("boreprop-view", fmu, "--step", "0.5", "--stop", "4", "--pace", "1e3", "--save", "live.rrd")
    assert (done.returncode, done.stderr) == (0, "")
    assert list(read(tmp_path / "live.rrd", "vertical_section/bit", "Points2D:positions")) == list(range(0, 4001, 500))


def test_ctrl_c_ends_a_live_run_with_130_and_keeps_what_was_drilled(case: Case, tmp_path: Path) -> None:
    fmu = build_fmu(replace(case, length=100_000.0), tmp_path / "long.fmu")
    running = start([Path(sysconfig.get_path("scripts"), "boreprop-view"), fmu, "--save", tmp_path / "live.rrd"])
    try:
        deadline = time.monotonic() + 60.0
        while not any(path.stat().st_size > 1_000_000 for path in tmp_path.glob(".*live.rrd")):
            assert running.poll() is None
            assert time.monotonic() < deadline
            time.sleep(0.05)
        os.kill(running.pid, signal.SIGINT)
        printed, said = running.communicate()
    finally:
        running.kill()
    assert (running.returncode, printed, said) == (130, b"", b"")
    drilled = read(tmp_path / "live.rrd", "vertical_section/bit", "Points2D:positions")
    assert list(drilled) == list(range(0, 100 * len(drilled), 100))
    assert len(drilled) > 100


def test_the_vertical_section_grows_with_a_live_run_that_leaves_it(case: Case, tmp_path: Path) -> None:
    steep = replace(case, length=10.0, survey=replace(case.survey, inclination=(1.2, 1.2, 1.2)))
    fmu = build_fmu(steep, tmp_path / "short.fmu")
    program = """
import sys
from boreprop_fmu.host.drive import FmuRun
from boreprop_viz.record import record
record({"live": FmuRun(sys.argv[1], step=0.5, stop=200.0)}, save=sys.argv[2])
"""
    done = run_script(["-c", program, fmu, tmp_path / "live.rrd"])
    assert done.returncode == 0, done.stderr
    grids = static(tmp_path / "live.rrd", "vertical_section/grid", "LineStrips2D:strips")  # from side to side
    sides = [max(x for line in grid for x, _ in line) for grid in grids if grid]
    bit = stacked(tmp_path / "live.rrd", "vertical_section/bit", "Points2D:positions")[-1, 0]
    assert sides[0] < bit[0] < sides[-1]
    assert 2 <= len(sides) <= 5


def test_a_result_file_with_outputs_alone_is_drawn_with_the_pads_force(
    case: Case, command: Command, tmp_path: Path
) -> None:
    forces = Schedule((0.0, 10.0, 20.0), (0.0, 3000.0, -2000.0))
    run = simulate(replace(case, length=30.0, schedule=forces), sample_interval=0.5)
    outputs = {name: run[name] for name in scalar_names(OUTPUTS, 2)}
    foreign = {"time": run["drilled_length"]} | {f"model.root.borehole.{name}": c for name, c in outputs.items()}
    lines = [
        ",".join(f'"{name}"' for name in foreign),
        *(",".join(map(repr, row)) for row in zip(*(c.tolist() for c in foreign.values()), strict=True)),
    ]
    (tmp_path / "foreign.csv").write_text("\n".join(lines) + "\n")
    write_trajectory(run, tmp_path / "own.csv")
    done = command("boreprop-view", "foreign.csv", "--case", "own.case.toml", "--save", "foreign.rrd")
    assert (done.returncode, done.stderr) == (0, "")
    shown = stacked(tmp_path / "foreign.rrd", "plots/rss_force/rss_force", "Scalars:scalars")[:, 0]
    np.testing.assert_allclose(shown, run["rss_force"] / 1000, atol=1e-6)
    command("boreprop-view", "own.csv", "--save", "own.rrd")
    for entity in ("bit_frame/bha", "bit_frame/walls"):
        ours, theirs = (stacked(tmp_path / f"{name}.rrd", entity, "LineStrips2D:strips") for name in ("own", "foreign"))
        np.testing.assert_allclose(theirs, ours, atol=1e-5)


def test_what_fmpy_wrote_is_drawn_with_the_case_in_the_fmu(command: Command, fmu: Path, tmp_path: Path) -> None:
    written = command(
        "fmpy", "simulate", fmu, "--stop-time", "20", "--output-interval", "0.5", "--output-file", "fmpy.csv"
    )
    assert written.returncode == 0, written.stderr
    done = command("boreprop-view", "fmpy.csv", "--fmu", fmu, "--save", "fmpy.rrd")
    assert (done.returncode, done.stderr) == (0, "")
    assert list(read(tmp_path / "fmpy.rrd", "bit_frame/bha", "LineStrips2D:strips")) == list(range(0, 20001, 500))


@pytest.mark.parametrize("missing", ["bit_inclination", "average_inclination[2]"])
def test_a_run_without_what_a_picture_needs_is_refused(
    case: Case, command_here: Command, tmp_path: Path, missing: str
) -> None:
    run = simulate(replace(case, length=2.0))
    kept = {n: c for n, c in run.columns.items() if n not in (missing, "bit_tilt", "borehole_inclination")}
    write_trajectory(Trajectory(kept, run.case), tmp_path / "run.csv")
    done = command_here("boreprop-view", "run.csv", "--save", "run.rrd")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: run.csv: ")
    assert missing.partition("[")[0] in done.stderr
    assert not (tmp_path / "run.rrd").exists()


def test_a_lane_that_does_not_change_is_logged_again_now_and_then(case: Case, tmp_path: Path) -> None:
    heavy = simulate(replace(case, active_weight_on_bit=16 * case.active_weight_on_bit), length=200.0)
    record(heavy, save=tmp_path / "heavy.rrd")
    logged = read(tmp_path / "heavy.rrd", "modes/tilt", "StateChange:state")
    assert {word for [word] in logged.values()} == {"–"}
    assert max(np.diff([*sorted(logged), 200_000])) <= 10_000 * case.bha.half_length + 100

"""A recording is read back and compared with the run."""

import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rerun.chunk import RrdReader

from boreprop.case import Case, InputError, Schedule, load_case
from boreprop.results import Trajectory, write_trajectory
from boreprop.simulation import simulate
from boreprop_viz import record as recording
from boreprop_viz.record import record
from boreprop_viz.scene import Array, BitFrame
from boreprop_viz.style import scales
from conftest import Command

LENGTH = 40.0


@pytest.fixture(scope="module")
def case(paper_case: Path) -> Case:
    forces = Schedule((0.0, 10.0, 20.0), (0.0, 3000.0, -2000.0))
    return replace(load_case(paper_case), length=LENGTH, schedule=forces)


@pytest.fixture(scope="module")
def run(case: Case) -> Trajectory:
    return simulate(case, sample_interval=LENGTH / 300)


@pytest.fixture(scope="module")
def recorded(run: Trajectory, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recording") / "run.rrd"
    record(run, save=path)
    return path


def read(path: Path, entity: str, component: str) -> dict[int, list[Any]]:
    """What an entity's component holds at each tick of the timeline."""
    chunks = (
        RrdReader(path).stream().filter(content=f"/{entity}", components=component, has_timeline="drilled_length_mm")
    )
    batches = [chunk.to_record_batch() for chunk in chunks]
    return {
        tick: value
        for batch in batches
        for tick, value in zip(
            batch.column("drilled_length_mm").to_pylist(), batch.column(component).to_pylist(), strict=True
        )
    }


def stacked(path: Path, entity: str, component: str) -> Array:
    return np.array(list(read(path, entity, component).values()), dtype=float)


def test_the_timeline_is_the_drilled_length_in_millimetres(recorded: Path, run: Trajectory) -> None:
    ticks = list(read(recorded, "bit_frame/bha", "LineStrips2D:strips"))
    assert ticks == np.rint(1000 * run["drilled_length"]).astype(int).tolist()
    assert ticks[-1] == 1000 * LENGTH


def test_the_drilled_hole_is_the_path_of_the_bit(recorded: Path, run: Trajectory) -> None:
    pieces = stacked(recorded, "vertical_section/drilled_hole", "LineStrips2D:strips")[:, 0]
    bit = np.column_stack((run["displacement"], run["true_vertical_depth"]))
    np.testing.assert_allclose(pieces[:, 0], bit[:-1], atol=1e-5)
    np.testing.assert_allclose(pieces[:, 1], bit[1:], atol=1e-5)


def test_the_walls_are_a_hole_radius_from_the_axis_times_the_factor(
    recorded: Path, run: Trajectory, case: Case
) -> None:
    factor = scales(run, case).lateral
    axis = stacked(recorded, "bit_frame/hole_axis", "LineStrips2D:strips")[:, 0]
    walls = stacked(recorded, "bit_frame/walls", "LineStrips2D:strips")
    for side, wall in ((-1.0, walls[:, 0]), (1.0, walls[:, 1])):
        np.testing.assert_allclose(wall[..., 0] - axis[..., 0], side * factor * case.bit_diameter / 2, atol=1e-5)
        np.testing.assert_array_equal(wall[..., 1], axis[..., 1])


def test_the_blades_have_their_clearance_from_the_wall(recorded: Path, run: Trajectory, case: Case) -> None:
    blades = stacked(recorded, "bit_frame/stabilizers", "LineStrips2D:strips")
    widths = (blades[:, :, 1, 0] - blades[:, :, 0, 0]) / scales(run, case).lateral
    clearances = np.array([*case.bha.stabilizer_clearances, 0.0])
    np.testing.assert_allclose(widths, np.tile(case.bit_diameter - 2 * clearances, (len(run), 1)), atol=1e-6)
    np.testing.assert_allclose(-blades[0, :, 0, 1], case.bha.stabilizer_positions, rtol=1e-6)


@pytest.mark.parametrize(("entity", "column"), [("contact_force/1", "stabilizer_force[1]"), ("rss_force", "rss_force")])
def test_an_arrow_is_drawn_only_where_there_is_a_force_and_is_as_long_as_it(
    recorded: Path, run: Trajectory, case: Case, entity: str, column: str
) -> None:
    arrows = read(recorded, f"bit_frame/{entity}", "Arrows2D:vectors")
    labels = read(recorded, f"bit_frame/{entity}", "Arrows2D:labels")
    drawn = np.array([sum((vector[0] for vector in vectors), 0.0) for vectors in arrows.values()])
    np.testing.assert_allclose(drawn * scales(run, case).newtons_per_metre, run[column], rtol=1e-6)
    forces = dict(zip(arrows, run[column], strict=True))
    assert {tick for tick, vectors in arrows.items() if vectors} == {tick for tick, force in forces.items() if force}
    assert {len(vectors) for vectors in arrows.values()} == {0, 1}
    for tick, force in forces.items():
        assert labels[tick] == ([f"{abs(force) / 1000:.3g} kN"] if force else [])


def test_a_contact_force_ends_at_its_contact_point_on_the_wall(recorded: Path, case: Case) -> None:
    tips = {}
    for tick, vectors in read(recorded, "bit_frame/contact_force/1", "Arrows2D:vectors").items():
        tips[tick] = np.array(vectors)
    for tick, origins in read(recorded, "bit_frame/contact_force/1", "Arrows2D:origins").items():
        tips[tick] = tips[tick] + np.array(origins)
    places = read(recorded, "bit_frame/contact_point/1", "Points2D:positions")
    walls = read(recorded, "bit_frame/walls", "LineStrips2D:strips")
    at = BitFrame(case).at_stabilizer[0]
    touching = [tick for tick, place in places.items() if place]
    assert touching
    for tick in touching:
        np.testing.assert_allclose(tips[tick], places[tick], atol=1e-5)
        on_wall = [np.allclose(places[tick][0], wall[at], atol=1e-5) for wall in walls[tick]]
        assert sum(on_wall) == 1


@pytest.mark.parametrize(
    ("entity", "column", "factor"),
    [
        ("inclination/bit_inclination", "bit_inclination", 180 / np.pi),
        ("inclination/borehole_inclination", "borehole_inclination", 180 / np.pi),
        ("bit_tilt/bit_tilt", "bit_tilt", 180 / np.pi),
        ("stabilizer_force/stabilizer_force_1", "stabilizer_force[1]", 1e-3),
        ("rss_force/rss_force", "rss_force", 1e-3),
    ],
)
def test_a_plot_shows_degrees_and_kilonewtons(
    recorded: Path, run: Trajectory, entity: str, column: str, factor: float
) -> None:
    shown = stacked(recorded, f"plots/{entity}", "Scalars:scalars")[:, 0]
    np.testing.assert_allclose(shown, factor * run[column], rtol=1e-14)


def test_the_plot_of_the_bit_tilt_shows_its_limits(recorded: Path, case: Case) -> None:
    for side, limit in (("lower", -case.bit.tilt_limit), ("upper", case.bit.tilt_limit)):
        ends = read(recorded, f"plots/bit_tilt/{side}_limit", "Scalars:scalars")
        assert (min(ends), max(ends)) == (0, 1000 * LENGTH)
        np.testing.assert_allclose(list(ends.values()), np.degrees(limit))


def test_what_is_drawn_does_not_depend_on_the_batches(
    recorded: Path, run: Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recording, "BATCH", 37)
    record(run, save=tmp_path / "other.rrd")
    for entity in ("vertical_section/drilled_hole", "vertical_section/bha", "bit_frame/walls", "bit_frame/bha"):
        other = stacked(tmp_path / "other.rrd", entity, "LineStrips2D:strips")
        np.testing.assert_allclose(other, stacked(recorded, entity, "LineStrips2D:strips"), atol=1e-5)


def test_rerun_finds_the_file_whole(recorded: Path) -> None:
    verified = subprocess.run(
        [sys.executable, "-m", "rerun", "rrd", "verify", recorded], capture_output=True, text=True, timeout=60
    )
    assert verified.returncode == 0, verified.stderr


def test_a_run_that_stands_still_is_drawn(run: Trajectory, tmp_path: Path) -> None:
    twice = Trajectory({name: np.repeat(column, 2) for name, column in run.columns.items()}, run.case)
    record(twice, save=tmp_path / "twice.rrd")
    pieces = stacked(tmp_path / "twice.rrd", "vertical_section/drilled_hole", "LineStrips2D:strips")
    assert len(pieces) == len(run) - 1


def test_a_recording_replaces_the_old_file_only_when_it_is_whole(run: Trajectory, tmp_path: Path) -> None:
    path = tmp_path / "run.rrd"
    path.write_text("old")

    def fail(_: float) -> None:
        assert path.read_text() == "old"
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        record(run, save=path, progress=fail)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"drilled_length": [0.0, 1.0, 0.5]}, "drilled_length: row 3: must not decrease, got 0.5"),
        ({"drilled_length": [0.0, 1.0]}, "must have a column"),
    ],
)
def test_a_run_that_cannot_be_drawn_is_refused(
    case: Case, tmp_path: Path, columns: dict[str, list[float]], message: str
) -> None:
    broken = Trajectory({name: np.array(column) for name, column in columns.items()}, case)
    with pytest.raises(InputError, match=message):
        record(broken, save=tmp_path / "run.rrd")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("address", ["nowhere", "rerun+http://127.0.0.1:1/proxy"])
def test_an_address_without_a_viewer_is_refused(run: Trajectory, tmp_path: Path, address: str) -> None:
    with pytest.raises(ConnectionError, match=f"must listen at .* got {re.escape(repr(address))}"):
        record(run, save=tmp_path / "run.rrd", connect=address)
    assert not list(tmp_path.iterdir())


def test_the_command_draws_a_run_with_the_case_that_stands_beside_it(
    command: Command, run: Trajectory, tmp_path: Path
) -> None:
    write_trajectory(run, tmp_path / "run.csv")
    done = command("boreprop-view", "run.csv", "--save", "run.rrd")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith(f"run.rrd: {len(run)} rows, ")
    shown = stacked(tmp_path / "run.rrd", "plots/bit_tilt/bit_tilt", "Scalars:scalars")[:, 0]
    np.testing.assert_array_equal(shown, np.degrees(run["bit_tilt"]))


def test_the_command_runs_a_case_file(command: Command, paper_text: str, tmp_path: Path) -> None:
    (tmp_path / "short.toml").write_text(paper_text.replace("= 219.6", "= 2.0"), encoding="utf-8")
    done = command("boreprop-view", "short.toml", "--save", "short.rrd")
    assert (done.returncode, done.stderr) == (0, "")
    assert max(read(tmp_path / "short.rrd", "vertical_section/bit", "Points2D:positions")) == 2000


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["run.csv", "--save", "run.rrd"], "run.csv: the run must have its case, got none"),
        (["run.csv", "--save", "run.png"], "run.png: must end in .rrd, got '.png'"),
        (["run.xlsx", "--save", "run.rrd"], "run.xlsx: must end in .csv, .parquet or .toml, got '.xlsx'"),
        (["run.csv", "--spawn", "--serve"], "--spawn, --serve and --connect: must be at most one, got 2"),
        (["run.csv", "--case", "a.toml", "--fmu", "b.fmu"], "--case and --fmu: must be at most one, got both"),
        (["run.csv", "--case", "no.toml"], "no.toml: must be a readable TOML file, got: No such file or directory"),
        (["a.toml", "--case", "b.toml"], "a.toml: must be a run to be given a case, got a case file"),
    ],
)
def test_bad_input_is_one_line_and_leaves_no_file(
    command: Command, run: Trajectory, tmp_path: Path, arguments: list[str], error: str
) -> None:
    write_trajectory(replace(run, case=None), tmp_path / "run.csv")
    done = command("boreprop-view", *arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"error: {error}")
    assert done.stderr.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["run.csv"]

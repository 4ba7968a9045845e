"""A recording is read back and compared with the run."""

import re
import subprocess
import sys
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest

from boreprop.analysis.axis import axis_ripple
from boreprop.analysis.hole import bit_positions
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz.record import Drawing, record
from boreprop_viz.scales import Scales, choose_scales
from boreprop_viz.scene import Array, BitFrame
from boreprop_viz.sinks import open_recording
from boreprop_viz.source import stored
from conftest import Command
from forking import run_script
from rrd import held, read, stacked, static

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


@pytest.fixture(scope="module")
def scales(run: Trajectory) -> Scales:
    return choose_scales([run], whole=True, section=np.zeros((1, 2)))


def test_the_timeline_is_the_drilled_length_in_millimetres(recorded: Path, run: Trajectory) -> None:
    ticks = list(read(recorded, "bit_frame/bha", "LineStrips2D:strips"))
    assert ticks == np.rint(1000 * run["drilled_length"]).astype(int).tolist()
    assert ticks[-1] == 1000 * LENGTH


def test_measured_depth_is_a_timeline_where_the_runs_share_a_start(
    recorded: Path, run: Trajectory, case: Case, tmp_path: Path
) -> None:
    start = case.survey.measured_depth[-1]
    depth = read(recorded, "plots/ripple/ripple", "Scalars:scalars", "measured_depth_mm")
    assert list(depth) == [
        tick + round(1000 * start) for tick in read(recorded, "plots/ripple/ripple", "Scalars:scalars")
    ]
    deeper = replace(case, survey=Survey((0.0, start + 1.0), (0.0, 0.0)))
    record({"a": run, "b": simulate(deeper, length=1.0)}, save=tmp_path / "two.rrd")
    assert read(tmp_path / "two.rrd", "bit_frame/a/bha", "LineStrips2D:strips")
    assert not read(tmp_path / "two.rrd", "bit_frame/a/bha", "LineStrips2D:strips", "measured_depth_mm")


def test_a_run_that_stands_still_goes_on_in_simulation_time(run: Trajectory, tmp_path: Path) -> None:
    still = {name: np.append(column, np.full(9, column[-1])) for name, column in run.columns.items()}
    seconds = np.arange(run.row_count + 9) / 2
    still |= {"time": seconds, "rss_force": np.append(run["rss_force"], 1000.0 * np.arange(9))}
    record(Trajectory(still, run.case), save=tmp_path / "still.rrd")
    forces = read(tmp_path / "still.rrd", "plots/rss_force/rss_force", "Scalars:scalars", "simulation_time")
    assert list(forces) == [timedelta(seconds=second) for second in seconds.tolist()]
    np.testing.assert_allclose(list(forces.values())[-9:], np.arange(9.0)[:, None])
    # what was drilled earlier and is drawn only now has the time at which it was drilled
    ripple, at = "plots/ripple/ripple", "simulation_time"
    drilled = read(tmp_path / "still.rrd", ripple, "Scalars:scalars")
    expected = np.interp(list(drilled), 1000 * run["drilled_length"], seconds[: run.row_count])
    shown = [moment.total_seconds() for moment in read(tmp_path / "still.rrd", ripple, "Scalars:scalars", at)]
    np.testing.assert_allclose(shown, expected, atol=0.01)


def test_the_walls_are_a_hole_radius_from_the_axis_times_the_factor(
    recorded: Path, run: Trajectory, scales: Scales, case: Case
) -> None:
    low, high = stacked(recorded, "bit_frame/walls", "LineStrips2D:strips").transpose(1, 0, 2, 3)
    np.testing.assert_allclose(high[..., 0] - low[..., 0], scales.lateral * case.bit_diameter, atol=1e-5)
    np.testing.assert_array_equal(high[..., 1], low[..., 1])
    # the axis in between, at the stabilizers: lateral coordinates that the averages ⟨Θ⟩_i give
    averages, spans = run.stack("average_inclination"), np.diff(case.bha.stabilizer_positions, prepend=0.0)
    mean = averages @ spans / spans.sum()
    axis = ((low + high) / 2)[:, BitFrame(case).at_stabilizer, 0] / scales.lateral
    np.testing.assert_allclose(axis, -np.cumsum((averages - mean[:, None]) * spans, axis=1), atol=1e-6)


def test_the_axis_of_the_bit_is_tilted_against_the_hole_within_its_limits(
    recorded: Path, run: Trajectory, scales: Scales, case: Case
) -> None:
    def angles(thing: str) -> Array:
        lines = stacked(recorded, f"bit_frame/tilt/{thing}", "LineStrips2D:strips")
        across, ahead = np.moveaxis(lines[:, :, 1] - lines[:, :, 0], -1, 0)
        angle: Array = across / scales.lateral / ahead
        return angle

    bit, hole, limits = angles("bit_axis"), angles("hole_axis"), angles("limits")
    np.testing.assert_allclose((bit - hole)[:, 0], run["bit_tilt"], atol=1e-6)
    limit = case.bit.tilt_limit
    np.testing.assert_allclose(limits - hole, np.tile([-limit, limit], (run.row_count, 1)), atol=1e-6)
    ticks = read(recorded, "bit_frame/tilt/label", "Points2D:positions")
    labels = [label for [label] in held(recorded, "bit_frame/tilt/label", "Points2D:labels", ticks)]
    assert "ψ −0.00°" not in labels
    shown = [float(label.removeprefix("ψ ").removesuffix("°").replace("−", "-")) for label in labels]
    np.testing.assert_allclose(shown, np.degrees(run["bit_tilt"]), atol=0.0051)


def test_the_blades_have_their_clearance_from_the_wall(
    recorded: Path, run: Trajectory, case: Case, scales: Scales
) -> None:
    blades = stacked(recorded, "bit_frame/stabilizers", "LineStrips2D:strips")
    widths = (blades[:, :, 1, 0] - blades[:, :, 0, 0]) / scales.lateral
    clearances = np.array([*case.bha.stabilizer_clearances, 0.0])
    np.testing.assert_allclose(widths, np.tile(case.bit_diameter - 2 * clearances, (run.row_count, 1)), atol=1e-6)
    np.testing.assert_allclose(-blades[0, :, 0, 1], case.bha.stabilizer_positions, rtol=1e-6)


@pytest.mark.parametrize(
    ("entity", "column"),
    [
        ("contact_force/1", "stabilizer_force[1]"),
        ("rss_force", "rss_force"),
        ("bit_lateral_force", "bit_lateral_force"),
    ],
)
def test_an_arrow_is_drawn_only_where_there_is_a_force_and_is_as_long_as_it(
    recorded: Path, run: Trajectory, scales: Scales, entity: str, column: str
) -> None:
    arrows = read(recorded, f"bit_frame/{entity}", "Arrows2D:vectors")
    labels = held(recorded, f"bit_frame/{entity}/label", "Points2D:labels", arrows)
    beside = read(recorded, f"bit_frame/{entity}/label", "Points2D:positions")
    drawn = np.array([sum((vector[0] for vector in vectors), 0.0) for vectors in arrows.values()])
    np.testing.assert_allclose(drawn * scales.newtons_per_metre, run[column], rtol=1e-6)
    forces = dict(zip(arrows, run[column], strict=True))
    assert {tick for tick, vectors in arrows.items() if vectors} == {tick for tick, force in forces.items() if force}
    assert {len(vectors) for vectors in arrows.values()} <= {0, 1}
    for force, [label], places in zip(forces.values(), labels, beside.values(), strict=True):
        assert len(places) == (1 if force else 0)
        assert float(label.removesuffix(" kN")) == pytest.approx(abs(force) / 1000, rel=0.005, abs=0.005)


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
    np.testing.assert_allclose(shown, factor * run[column], atol=5.1e-5)


def test_the_plot_of_the_bit_tilt_shows_its_limits(recorded: Path, case: Case) -> None:
    for side, limit in (("lower", -case.bit.tilt_limit), ("upper", case.bit.tilt_limit)):
        ends = read(recorded, f"plots/bit_tilt/{side}_limit", "Scalars:scalars")
        assert (min(ends), max(ends)) == (0, 1000 * LENGTH)
        np.testing.assert_allclose(list(ends.values()), np.degrees(limit))


def test_limits_and_blades_are_those_of_the_rock_and_the_clearances_where_the_bit_is(
    case: Case, tmp_path: Path
) -> None:
    tilts, clearances = ("bit_tilt_limit", (0.02, 0.005)), ("stabilizer_clearance[1]", (3.66e-3, 1e-2))
    run = simulate(replace(case, inputs=InputSchedule((0.0, 15.0), (tilts, clearances))), sample_interval=1.0)
    record(run, save=tmp_path / "run.rrd")
    ends = read(tmp_path / "run.rrd", "plots/bit_tilt/upper_limit", "Scalars:scalars")
    assert list(ends) == [0, 14_000, 15_000, 1000 * LENGTH]
    np.testing.assert_allclose(np.ravel(list(ends.values())), np.degrees([0.02, 0.02, 0.005, 0.005]), atol=5.1e-5)
    blades = stacked(tmp_path / "run.rrd", "bit_frame/stabilizers", "LineStrips2D:strips")[
        :, 0, :, 0
    ]  # of the first one
    lateral = choose_scales([run], whole=True, section=np.zeros((1, 2))).lateral
    wide = case.bit_diameter - 2 * np.where(run["drilled_length"] < 15.0, 3.66e-3, 1e-2)
    np.testing.assert_allclose(np.abs(np.diff(blades, axis=1))[:, 0], lateral * wide, rtol=1e-5)


@pytest.mark.parametrize(
    ("lane", "column", "words"),
    [
        ("stabilizer_1", "stabilizer_contact[1]", {1: "L", -1: "H", 0: "–"}),
        ("tilt", "bit_tilt_saturation", {1: "+", -1: "−", 0: "–"}),
    ],
)
def test_a_lane_changes_where_the_mode_does(
    recorded: Path, run: Trajectory, lane: str, column: str, words: dict[int, str]
) -> None:
    ticks = np.rint(1000 * run["drilled_length"]).astype(int).tolist()
    shown = held(recorded, f"modes/{lane}", "StateChange:state", ticks)
    assert shown == [[words[int(mode)]] for mode in run[column]]
    logged = read(recorded, f"modes/{lane}", "StateChange:state")
    assert 2 < len(logged) < run.row_count


def test_the_ripple_is_shown_as_far_as_its_trend_is_known(recorded: Path, run: Trajectory, case: Case) -> None:
    shown = read(recorded, "plots/ripple/ripple", "Scalars:scalars")
    l1 = case.bha.length_scale
    assert 0 <= min(shown) < 1000 * l1 / 20
    assert 1000 * (LENGTH - 4.1 * l1) < max(shown) <= 1000 * (LENGTH - 4.0 * l1)
    length, ripple = axis_ripple(run["drilled_length"], bit_positions(run), l1)
    found = dict(zip(np.rint(1000 * length).astype(int).tolist(), 1000 * ripple, strict=True))
    np.testing.assert_allclose([shown[tick][0] for tick in found], list(found.values()), atol=1e-3)


def test_build_rate_and_dogleg_severity_of_an_evenly_curved_hole_are_its_curvature(case: Case, tmp_path: Path) -> None:
    curvature, length = np.radians(2.0) / 30, np.linspace(0.0, 60.0, 601)
    inclination = np.radians(20.0) + curvature * length
    bent = replace(case, survey=Survey((0.0, 60.0), (np.radians(16.0), np.radians(20.0))))
    columns = {
        "drilled_length": length,
        "bit_inclination": inclination,
        "borehole_inclination": inclination,
        "displacement": -(np.cos(inclination) - np.cos(inclination[0])) / curvature,
        "true_vertical_depth": (np.sin(inclination) - np.sin(inclination[0])) / curvature,
        "rss_force": np.zeros(601),
        "stabilizer_force[1]": np.zeros(601),
    }
    record(Trajectory(columns, bent), save=tmp_path / "bent.rrd")
    for curve in ("build_rate", "dogleg_severity"):
        shown = stacked(tmp_path / "bent.rrd", f"plots/build_rate/{curve}", "Scalars:scalars")
        np.testing.assert_allclose(shown, 2.0, atol=2e-3)


def test_the_plan_is_drawn_from_where_drilling_starts(run: Trajectory, case: Case, tmp_path: Path) -> None:
    start = case.survey.measured_depth[-1]
    plan = Survey((0.0, start + 20.0), (0.0, 0.2))
    record(run, plan=plan, save=tmp_path / "run.rrd")
    planned = read(tmp_path / "run.rrd", "plots/inclination/0_plan", "Scalars:scalars")
    slope = np.degrees(0.2) / (start + 20.0)
    for tick, [inclination] in planned.items():
        if tick <= 20000:
            assert inclination == pytest.approx(slope * (start + tick / 1000), abs=slope * 0.001)
        else:
            assert np.isnan(inclination)
    [[path]] = static(tmp_path / "run.rrd", "vertical_section/plan", "LineStrips2D:strips")
    points = np.array(path)
    steps = np.diff(points, axis=0)
    assert np.hypot(points[:, 0], points[:, 1]).min() < 1e-6
    np.testing.assert_allclose(np.hypot(*steps.T).sum(), start + 20.0, rtol=1e-4)
    np.testing.assert_allclose(np.arctan2(*steps[[0, -1]].T), [0.0, 0.2], atol=1e-3)


def test_whatever_the_runs_are_called_rerun_does_not_complain(run: Trajectory, tmp_path: Path) -> None:
    write_trajectory(run, tmp_path / "run.csv")
    program = """
import sys
from boreprop import read_trajectory
from boreprop_viz.record import record
run = read_trajectory("run.csv")
record({"ηΠ = 0.1, first": run, "a/b (2) & " + 200 * "c": run}, save="run.rrd")
"""
    done = run_script(["-c", program], cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_plan_that_ends_above_the_start_is_refused(run: Trajectory, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"plan: must include 7\.32 m, where drilling starts, got 0 to 5"):
        record(run, plan=Survey((0.0, 5.0), (0.0, 0.0)), save=tmp_path / "run.rrd")
    assert not list(tmp_path.iterdir())


def test_the_card_names_the_case_and_whether_it_ripples(tmp_path: Path, paper_case: Path) -> None:
    ripples = load_case(paper_case)
    more = replace(ripples, active_weight_on_bit=16 * ripples.active_weight_on_bit)
    record({"a": simulate(ripples), "b": simulate(more)}, save=tmp_path / "two.rrd")
    texts = read(tmp_path / "two.rrd", "verdict", "TextDocument:text")
    [verdicts] = texts[max(texts)]
    [[text]] = static(tmp_path / "two.rrd", "case", "TextDocument:text")
    assert "| **ηΠ** | **0.01** | **0.16** |" in text
    assert "| drilling straight, contact | 1 low | none |" in text
    assert "| drilling straight, roots | unstable, oscillates | stable |" in text
    assert "| its critical ηΠ | 0.1468 = 23.7 kN | none |" in text
    assert "| critical ηΠ, all touching | 0.1468 = 23.7 kN | 0.1468 = 23.7 kN |" in text
    facts = [line.split(" | ")[0].strip("| *") for line in text.splitlines() if line.startswith("| ")]
    assert facts.index("critical ηΠ, all touching") > facts.index("its critical ηΠ") > facts.index("ηΠ")
    assert "weight on bit" not in text.replace("active weight on bit", "")
    assert re.search(r"- \*\*a\*\* rippling since 24 m: waves of 5\.0\d m, ±2\.\d °, ±3\d mm", verdicts)
    assert "- **b** no ripple" in verdicts


def test_several_runs_are_drawn_over_each_other_each_under_its_name(
    run: Trajectory, case: Case, tmp_path: Path
) -> None:
    other = simulate(replace(case, active_weight_on_bit=2 * case.active_weight_on_bit), sample_interval=0.5)
    record({"first try": run, "other": other}, save=tmp_path / "two.rrd")
    for name, shown in (("first_try", run), ("other", other)):
        tilt = stacked(tmp_path / "two.rrd", f"plots/bit_tilt/{name}/bit_tilt", "Scalars:scalars")[:, 0]
        np.testing.assert_allclose(tilt, np.degrees(shown["bit_tilt"]), atol=5.1e-5)
        bit = stacked(tmp_path / "two.rrd", f"vertical_section/{name}/bit", "Points2D:positions")[:, 0]
        np.testing.assert_allclose(bit, bit_positions(shown), atol=1e-5)
    [key] = static(tmp_path / "two.rrd", "key/names", "Points2D:labels")
    assert key[:2] == ["first try", "other"]


def test_what_is_drawn_does_not_depend_on_the_batches(recorded: Path, run: Trajectory, tmp_path: Path) -> None:
    with open_recording(save=tmp_path / "other.rrd") as rec:
        Drawing.of([stored("run", run, batch=37)]).draw(rec)
    for entity in ("vertical_section/bha", "bit_frame/walls", "bit_frame/bha"):
        other = stacked(tmp_path / "other.rrd", entity, "LineStrips2D:strips")
        np.testing.assert_allclose(other, stacked(recorded, entity, "LineStrips2D:strips"), atol=1e-5)
    for entity in ("vertical_section/drilled_hole", "vertical_section/newly_drilled"):
        for component in ("LineStrips2D:strips", "LineStrips2D:colors"):
            assert read(tmp_path / "other.rrd", entity, component) == read(recorded, entity, component)
    strips, others = (read(path, "strip/hole", "LineStrips2D:strips") for path in (recorded, tmp_path / "other.rrd"))
    assert list(strips) == list(others)
    for end, strip in strips.items():
        np.testing.assert_allclose(strip, others[end], atol=1e-4)


def test_rerun_finds_the_file_whole(recorded: Path) -> None:
    verified = subprocess.run(
        [sys.executable, "-m", "rerun", "rrd", "verify", recorded], capture_output=True, text=True, timeout=60
    )
    assert verified.returncode == 0, verified.stderr


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


def test_the_command_draws_a_run_with_the_case_that_stands_beside_it(
    command: Command, run: Trajectory, tmp_path: Path
) -> None:
    write_trajectory(run, tmp_path / "run.csv")
    done = command("boreprop-view", "run.csv", "--save", "run.rrd")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith(f"run.rrd: {run.row_count} rows, ")
    shown = stacked(tmp_path / "run.rrd", "plots/bit_tilt/bit_tilt", "Scalars:scalars")[:, 0]
    np.testing.assert_allclose(shown, np.degrees(run["bit_tilt"]), atol=5.1e-5)


def test_the_command_runs_a_case_file(command: Command, paper_text: str, tmp_path: Path) -> None:
    (tmp_path / "short.toml").write_text(paper_text.replace("= 219.6", "= 2.0"), encoding="utf-8")
    done = command("boreprop-view", "short.toml", "--save", "short.rrd")
    assert (done.returncode, done.stderr) == (0, "")
    assert max(read(tmp_path / "short.rrd", "vertical_section/bit", "Points2D:positions")) == 2000


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["run.csv", "--save", "run.rrd"], "run.csv: the run must come with its case, got none"),
        (["run.csv", "--save", "run.png"], "run.png: must end in .rrd, got '.png'"),
        (["run.xlsx", "--save", "run.rrd"], "run.xlsx: must end in .csv, .parquet, .fmu or .toml, got '.xlsx'"),
        (["run.csv", "--spawn", "--serve"], "--spawn, --serve, --connect: at most one must be given, got 2"),
        (["run.csv", "--case", "a.toml", "--fmu", "b.fmu"], "--case, --fmu: at most one must be given, got both"),
        (["run.csv", "--case", "no.toml"], "no.toml: must be a readable TOML file, got: No such file or directory"),
        (["run.csv", "--step", "1"], "--step: must be given with an FMU to run, got run.csv"),
        (["run.csv", "--pace", "2"], "--pace: must be given with an FMU to run, got run.csv"),
        (["Borehole.fmu", "--pace", "0"], "Invalid value for '--pace': must be a number > 0, got '0'"),
        (["run.csv", "./run.csv", "run.csv"], "run.csv: must be given once, got it twice"),
        (["paper.toml", "--plan", "plan.csv", "--save", "x.rrd"], "plan.csv: measured_depth of the plan: must include"),
        (["a.toml", "--case", "b.toml"], "a.toml: must be a result file with --case or --fmu, got a case file"),
    ],
)
def test_bad_input_is_one_line_and_leaves_no_file(
    command_here: Command, run: Trajectory, paper_text: str, tmp_path: Path, arguments: list[str], error: str
) -> None:
    write_trajectory(replace(run, case=None), tmp_path / "run.csv")
    (tmp_path / "paper.toml").write_text(paper_text, encoding="utf-8")
    (tmp_path / "plan.csv").write_text("measured_depth,inclination_deg\n8510.5,26.37\n9884,53.43\n", encoding="utf-8")
    before = set(tmp_path.iterdir())
    done = command_here("boreprop-view", *arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"error: {error}")
    assert done.stderr.count("\n") == 1
    assert set(tmp_path.iterdir()) == before

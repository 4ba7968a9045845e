"""What the viewer shows of runs in space, against the rows of the run and arithmetic of its own."""

import math
from dataclasses import replace
from itertools import chain
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from boreprop.analysis.spiral.closed_form import spiral as closed_form
from boreprop.case.case import Case
from boreprop.case.file import dump_case
from boreprop.case.inputs import Schedule
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_fmu.pack.build import build_fmu
from boreprop_viz import live
from boreprop_viz.picture import SOFTWARE_DRIVERS, viewer
from boreprop_viz.record import Drawing, find_sources, record
from boreprop_viz.scales import Extremes
from boreprop_viz.scene import Bounds
from boreprop_viz.space_scales import SpaceScales
from boreprop_viz.space_scene import PLAY, Discs, contact_points, disc_places, tube
from boreprop_viz.style import BY_SEVERITY
from conftest import Command
from rrd import read, stacked, static

Array = NDArray[np.float64]
AZIMUTH = math.radians(70.0)


def spiral_case(case: Case) -> Case:
    """The paper's case with a bit that walks: its ripple becomes a spiral."""
    return replace(case, bit=replace(case.bit, walk_angle=math.radians(5.0)), length=70.0)


def turning_case(case: Case) -> Case:
    """A hole at 40° whose pads push to the right, later to the left."""
    inclination = math.radians(40.0)
    return replace(
        case,
        survey=Survey((0.0, 7.32), (inclination, inclination), (AZIMUTH, AZIMUTH)),
        schedule=Schedule((0.0, 20.0), (8e3, -8e3), rss_toolface=(math.pi / 2, math.pi / 2)),
        active_weight_on_bit=60e3,
        length=40.0,
    )


@pytest.fixture(scope="module")
def spiral(case: Case) -> Trajectory:
    return simulate(spiral_case(case), sample_interval=0.1)


@pytest.fixture(scope="module")
def turning(case: Case) -> Trajectory:
    return simulate(turning_case(case), sample_interval=0.1)


@pytest.fixture(scope="module")
def recorded(spiral: Trajectory, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("space") / "spiral.rrd"
    record(spiral, save=path)
    return path


@pytest.fixture(scope="module")
def recorded_turning(turning: Trajectory, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("space") / "turning.rrd"
    record(turning, save=path)
    return path


def places(run: Trajectory, length: Array) -> Array:
    """North, east and down of the bit of a run at drilled lengths."""
    columns = (run["north"], run["east"], run["true_vertical_depth"])
    return np.column_stack([np.interp(length, run["drilled_length"], column) for column in columns])


def severities(run: Trajectory, length: Array, half: float) -> Array:
    """Angle between the chords of a run over `half` and over that before, per metre, by minimum curvature."""
    here, before, first = (places(run, length - back) for back in (0.0, half, 2 * half))
    chords = [b - a for a, b in ((first, before), (before, here))]
    one, two = (np.arctan2(np.hypot(*chord[:, :2].T), chord[:, 2]) for chord in chords)
    a, b = (np.arctan2(chord[:, 1], chord[:, 0]) for chord in chords)
    haversine = np.sin((two - one) / 2) ** 2 + np.sin(one) * np.sin(two) * np.sin((b - a) / 2) ** 2
    angle: Array = 2 * np.arcsin(np.sqrt(haversine))
    return angle / half


def test_the_tube_lies_one_bit_radius_around_the_places_of_the_bit(spiral: Trajectory, recorded: Path) -> None:
    pieces = read(recorded, "hole/tube", "Mesh3D:vertex_positions")
    assert len(pieces) == 70.0 // 3.66
    for tick, vertices in pieces.items():
        rings = np.array(vertices, dtype=float).reshape(21, -1, 3)
        axis = places(spiral, np.linspace(tick / 1000 - 3.66, tick / 1000, 21))
        np.testing.assert_allclose(rings.mean(axis=1), axis, atol=1e-4)
        np.testing.assert_allclose(np.linalg.norm(rings - axis[:, None], axis=2), 0.2159 / 2, atol=1e-4)


def test_the_sides_of_a_tube_face_outwards_however_it_winds() -> None:
    turn = np.linspace(0.0, 12.0, 200)
    path = np.column_stack((3 * np.cos(turn), 3 * np.sin(turn), 0.2 * turn)).reshape(4, 50, 3)
    shown = tube(path, 0.5)
    for piece in range(4):
        corners = shown.vertices[piece][shown.triangles.astype(int)]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        outward = shown.normals[piece][shown.triangles.astype(int)].mean(axis=1)
        signs = np.sign(np.sum(across * outward, axis=1))
        assert np.all(signs == signs[0])
        axis = np.repeat(path[piece], 10, axis=0)
        np.testing.assert_allclose(shown.vertices[piece] - axis, 0.5 * shown.normals[piece], atol=1e-12)


def test_the_tube_has_the_colours_of_its_dogleg_severity(spiral: Trajectory, recorded: Path) -> None:
    labels = static(recorded, "vertical_section/severities/labels", "Points2D:labels")[0]
    bounds = [float(label) for label in labels[1:]]
    found = read(recorded, "hole/tube", "Mesh3D:vertex_colors")
    length = spiral["drilled_length"]
    own = math.degrees(30.0) * severities(spiral, length, 3.66)
    checked = 0
    for tick, colours in found.items():
        if tick < 4 * 3660:  # earlier the chords lie in the existing hole
            continue
        for at, colour in zip(np.linspace(tick / 1000 - 3.66, tick / 1000, 21), colours[::10], strict=True):
            largest = own[(length >= at - 3.66) & (length <= at + 1e-9)].max()
            if np.min(np.abs(np.array(bounds) - largest)) < 0.03 * largest:
                continue  # between two colours
            expected = BY_SEVERITY[int(np.searchsorted(bounds, largest))]
            assert [colour >> shift & 0xFF for shift in (24, 16, 8)] == list(expected)
            checked += 1
    assert checked > 100


def test_dogleg_severity_is_that_of_minimum_curvature(turning: Trajectory, recorded_turning: Path) -> None:
    curve = read(recorded_turning, "plots/build_rate/dogleg_severity", "Scalars:scalars")
    late = {tick: value[0] for tick, value in curve.items() if tick > 8000}
    expected = severities(turning, np.array(list(late)) / 1000, 3.66)
    np.testing.assert_allclose(list(late.values()), math.degrees(30.0) * expected, atol=2e-3)


def test_the_curves_of_the_ripple_are_as_large_as_the_spiral_in_closed_form(spiral: Trajectory, recorded: Path) -> None:
    assert spiral.case is not None
    found = closed_form(spiral.case, "right")
    north, east = (read(recorded, f"plots/ripple/{name}", "Scalars:scalars") for name in ("ripple", "ripple_east"))
    late = [tick for tick in north if tick > max(north) - 1000 * found.pitch]
    assert len(late) > 50
    away = np.array([(north[tick][0], east[tick][0]) for tick in late])
    assert np.hypot(*away.T).mean() == pytest.approx(1000 * found.radius, rel=0.02)
    turn = np.unwrap(np.arctan2(away[:, 1], away[:, 0]))
    assert turn[-1] - turn[0] == pytest.approx(2 * math.pi * (late[-1] - late[0]) / 1000 / found.pitch, rel=0.03)


def test_plan_view_and_vertical_section_show_the_places_of_the_bit(turning: Trajectory, recorded_turning: Path) -> None:
    north, east, down = (turning[name] for name in ("north", "east", "true_vertical_depth"))
    plan = stacked(recorded_turning, "plan_view/bit", "Points2D:positions").reshape(-1, 2)
    np.testing.assert_allclose(plan, np.column_stack((east, -north)), atol=1e-4)
    section = stacked(recorded_turning, "vertical_section/bit", "Points2D:positions").reshape(-1, 2)
    np.testing.assert_allclose(section[:, 1], down, atol=1e-4)
    reach = np.hypot(north, east)
    assert np.all(section[:, 0] <= reach + 1e-4)
    assert section[-1, 0] > 0.99 * reach[-1]  # the section lies where the hole goes


def test_a_run_in_a_plane_looks_in_its_section_as_it_does_in_the_plane(case: Case, tmp_path: Path) -> None:
    flat = replace(case, length=20.0)
    record(simulate(flat, sample_interval=0.5), save=tmp_path / "plane.rrd")
    record(simulate(flat, sample_interval=0.5, dimensions=3), save=tmp_path / "space.rrd")
    plane, space = (
        stacked(tmp_path / f"{name}.rrd", "vertical_section/bit", "Points2D:positions") for name in ("plane", "space")
    )
    np.testing.assert_allclose(space, plane, atol=1e-4)


@pytest.mark.parametrize("name", ["spiral", "turning"])
def test_blades_meet_the_wall_where_it_pushes_and_are_inside_elsewhere(
    name: str, request: pytest.FixtureRequest
) -> None:
    run: Trajectory = request.getfixturevalue(name)
    assert run.case is not None
    discs = Discs(run.case, run)
    high, right = run["stabilizer_force_high[1]"], run["stabilizer_force_right[1]"]
    touching = np.hypot(high, right) > 0.0
    assert touching.any()
    apart = np.linalg.norm(discs.middle[:, 0], axis=1)
    np.testing.assert_allclose(apart[touching], PLAY, rtol=1e-5)
    assert np.all(apart[~touching] <= PLAY * (1 + 1e-9))
    contact = contact_points(discs.force)[:, 0]
    assert np.all(np.isnan(contact[~touching]))
    farthest = discs.middle[:, 0] / PLAY  # of the blades towards the wall, if they are not bent inwards
    np.testing.assert_allclose(contact[touching], farthest[touching], atol=1e-5)
    pushed = np.sum(contact * np.column_stack((right, -high)), axis=1)[touching]
    assert np.all(pushed < 0.0)  # away from the wall


def test_the_tilt_is_at_the_edge_of_its_disc_where_it_is_at_its_limit(spiral: Trajectory) -> None:
    assert spiral.case is not None
    size = np.linalg.norm(Discs(spiral.case, spiral).tilt, axis=1)
    saturated = spiral["bit_tilt_saturation"] == 1
    np.testing.assert_allclose(size[saturated], 1.0, rtol=1e-6)
    assert np.all(size <= 1.0 + 1e-6)


def test_the_dial_shows_the_side_to_which_the_pads_push(recorded_turning: Path) -> None:
    vectors = read(recorded_turning, "across/rss_force", "Arrows2D:vectors")
    before, after = np.array(vectors[10_000][0]), np.array(vectors[30_000][0])
    assert before[0] > 0.0
    assert abs(before[1]) < 1e-6
    np.testing.assert_allclose(after, -before, atol=1e-6)
    origins = read(recorded_turning, "across/rss_force", "Arrows2D:origins")
    np.testing.assert_allclose(origins[10_000][0], disc_places(3)[2], atol=1e-6)


def test_up_the_screen_is_north_in_a_vertical_hole_and_the_high_side_in_another(
    recorded: Path, recorded_turning: Path
) -> None:
    words = [
        set(chain(*read(path, "across/upright", "Points2D:labels").values())) for path in (recorded, recorded_turning)
    ]
    assert words == [{"north"}, {"high side"}]


def test_live_a_run_in_space_is_drawn_as_it_is_when_it_is_stored(
    turning: Trajectory, recorded_turning: Path, tmp_path: Path
) -> None:
    assert turning.case is not None
    saved = tmp_path / "live.rrd"
    with live(turning.case, save=saved) as view:
        for row in range(turning.row_count):
            outputs = {name: float(values[row]) for name, values in turning.columns.items()}
            view.send(time=outputs["drilled_length"], **outputs)
    for entity, component in (
        ("hole/tube", "Mesh3D:vertex_positions"),
        ("plots/azimuth/borehole_azimuth", "Scalars:scalars"),
        ("across/trail/tilt", "Points2D:positions"),
    ):
        assert read(saved, entity, component) == read(recorded_turning, entity, component)


def test_the_command_simulates_a_case_in_space(command: Command, case: Case, tmp_path: Path) -> None:
    (tmp_path / "spiral.toml").write_text(dump_case(replace(spiral_case(case), length=12.0)), encoding="utf-8")
    done = command("boreprop-view", "spiral.toml", "--save", "spiral.rrd")
    assert done.returncode == 0, done.stderr
    expected = simulate(replace(spiral_case(case), length=12.0))["bit_inclination"][-1]
    inclination = read(tmp_path / "spiral.rrd", "plots/inclination/bit_inclination", "Scalars:scalars")
    assert inclination[12_000][0] == pytest.approx(math.degrees(expected), abs=1e-3)


def test_an_fmu_in_space_is_drawn_while_it_drills(command: Command, turning: Trajectory, tmp_path: Path) -> None:
    assert turning.case is not None
    fmu = build_fmu(replace(turning.case, length=12.0), tmp_path / "turning.fmu", runtime="native")
    done = command("boreprop-view", fmu, "--step", "0.5", "--save", "live.rrd")
    assert done.returncode == 0, done.stderr
    plan = read(tmp_path / "live.rrd", "plan_view/bit", "Points2D:positions")
    own = places(turning, np.array([12.0]))[0]
    np.testing.assert_allclose(plan[12_000][0], (own[1], -own[0]), atol=1e-4)


def test_several_runs_in_space_have_their_own_colours(spiral: Trajectory, turning: Trajectory, tmp_path: Path) -> None:
    saved = tmp_path / "two.rrd"
    record({"a": spiral, "b": turning}, save=saved)
    colours = [set(chain(*read(saved, f"hole/{name}/tube", "Mesh3D:vertex_colors").values())) for name in "ab"]
    assert [len(own) for own in colours] == [1, 1]
    assert colours[0] != colours[1]


def test_runs_in_the_plane_and_in_space_are_not_drawn_together(case: Case, spiral: Trajectory, tmp_path: Path) -> None:
    plane = simulate(replace(case, length=5.0))
    with pytest.raises(InputError, match=r"flat: must be a run in space like the others.*drilling.dimensions = 3"):
        record({"flat": plane, "spiral": spiral}, save=tmp_path / "x.rrd")


def test_a_plan_is_shown_from_all_sides_and_the_run_measured_against_it(turning: Trajectory, tmp_path: Path) -> None:
    """A straight plan in the direction in which the hole starts, without azimuths."""
    inclination, saved = math.radians(40.0), tmp_path / "plan.rrd"
    record(turning, plan=Survey((0.0, 100.0), (inclination, inclination)), save=saved)
    ahead = np.array([math.sin(inclination) * math.cos(AZIMUTH), math.sin(inclination) * math.sin(AZIMUTH)])
    end = (100.0 - 7.32) * np.append(ahead, math.cos(inclination))
    [path] = static(saved, "hole/plan", "LineStrips3D:strips")[0]
    np.testing.assert_allclose(path[-1], end, atol=1e-4)
    [path] = static(saved, "plan_view/plan", "LineStrips2D:strips")[0]
    np.testing.assert_allclose(path[-1], (end[1], -end[0]), atol=1e-4)
    bit = places(turning, np.array([40.0]))[0]
    along = bit @ end / np.linalg.norm(end)
    distance = math.sqrt(bit @ bit - along**2)
    right = bit[1] * math.cos(AZIMUTH) - bit[0] * math.sin(AZIMUTH)
    shown = {
        curve: read(saved, f"plots/{curve}", "Scalars:scalars")[40_000][0]
        for curve in (
            "distance_from_plan/distance_from_plan",
            "distance_from_plan/distance_from_plan_right",
            "azimuth/0_plan",
        )
    }
    assert list(shown.values()) == pytest.approx([distance, right, 70.0], abs=2e-4)
    [[listed]] = static(saved, "stations", "TextDocument:text")
    assert f"| {right:+.2f} |" in listed
    said = read(saved, "verdict", "TextDocument:text")[40_000][0]
    assert f"; {distance:.1f} m off the plan, " in said
    assert said.endswith(f", {abs(right):.1f} m {'right' if right > 0 else 'left'}")


def test_a_plan_without_azimuths_is_refused_where_runs_start_in_different_directions(
    spiral: Trajectory, turning: Trajectory, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"azimuth of the plan: must be given.*add a column azimuth_deg"):
        record({"a": spiral, "b": turning}, plan=Survey((0.0, 100.0), (0.0, 0.1)), save=tmp_path / "x.rrd")


def test_a_run_of_a_single_row_is_drawn(turning: Trajectory, tmp_path: Path) -> None:
    saved = tmp_path / "one.rrd"
    record(replace(turning, columns={name: values[:1] for name, values in turning.columns.items()}), save=saved)
    assert read(saved, "verdict", "TextDocument:text")[0][0].endswith("**run** no ripple")


@pytest.mark.slow
@pytest.mark.skipif(not SOFTWARE_DRIVERS, reason="no software Vulkan driver (Debian: mesa-vulkan-drivers, libvulkan1)")
def test_the_views_of_space_draw_something_and_complain_of_nothing(recorded_turning: Path) -> None:
    with viewer(recorded_turning, 720, 450) as shown:
        views = {view.origin.strip("/"): view for view in shown.views()}
        for origin in ("hole", "enlarged", "across", "plan_view", "vertical_section"):
            picture = np.asarray(shown.picture(views[origin]), dtype=int)
            assert np.mean(np.ptp(picture, axis=-1) > 40) > 1e-3, origin
            assert not shown.reports(views[origin]), origin
        assert not shown.warnings()


def test_azimuths_are_plotted_without_a_jump_and_only_where_they_say_something(turning: Trajectory) -> None:
    """A hole that walks through north, the same at 40° and at 2° of inclination."""
    azimuth = np.linspace(-0.5, 0.4, turning.row_count)
    north = np.mod(azimuth + math.pi, 2 * math.pi) - math.pi
    columns = turning.columns | {"borehole_azimuth": np.mod(north, 2 * math.pi), "bit_azimuth": north}
    space = SpaceScales(-0.2, Bounds((0.0, 1.0), (0.0, 1.0)), 1.0, 1.0, 1.0, 1, 0)
    shown = space.plotted(replace(turning, columns=columns))
    for axis in ("bit", "borehole"):
        np.testing.assert_allclose(shown[f"{axis}_azimuth"], azimuth + 2 * math.pi, atol=1e-12)
    columns["bit_inclination"] = np.full(turning.row_count, math.radians(2.0))
    assert np.isnan(space.plotted(replace(turning, columns=columns))["bit_azimuth"]).all()


def test_of_a_vertical_hole_no_azimuth_is_plotted_stored_or_live(spiral: Trajectory, tmp_path: Path) -> None:
    assert spiral.case is not None
    short = {name: values[:50] for name, values in spiral.columns.items()}
    stored = Drawing.of(find_sources(replace(spiral, columns=short)))
    assert "azimuth" not in stored.scales.ranges
    assert "inclination" in stored.scales.ranges
    extremes = Extremes(stored.scales.plots)
    extremes.take(stored.scales.plotted(stored.sources[0].beginning))
    live_scales = replace(stored.scales, ranges={**dict.fromkeys(stored.scales.ranges), "azimuth": None})
    assert set(extremes.complete(live_scales).ranges) == set(stored.scales.ranges)

"""The vertical section and the strip of a recording are compared with the run."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from boreprop.analysis.hole import bit_positions
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.core.survey import Survey
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz import live
from boreprop_viz.record import record
from boreprop_viz.scales import Scales, choose_scales
from boreprop_viz.scene import Array, section_bounds
from boreprop_viz.style import BY_RUN, BY_SEVERITY, GROUND
from places import EXAMPLES
from rrd import read, stacked, static

LENGTH, INTERVAL = 40.0, 0.25  # m: a row in every interval of which a point of the hole is drawn
STRIPS, COLOURS, POINTS = "LineStrips2D:strips", "LineStrips2D:colors", "Points2D:positions"
SECTION = "vertical_section"


@pytest.fixture(scope="module")
def case() -> Case:
    return replace(load_case(EXAMPLES / "paper_case.toml"), length=LENGTH)


@pytest.fixture(scope="module")
def run(case: Case) -> Trajectory:
    return simulate(case, sample_interval=INTERVAL)


@pytest.fixture(scope="module")
def recorded(run: Trajectory, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("section") / "run.rrd"
    record(run, save=path)
    return path


@pytest.fixture(scope="module")
def scales(run: Trajectory) -> Scales:
    return choose_scales([run], whole=True, section=bit_positions(run))


def ticks(run: Trajectory) -> list[int]:
    found: list[int] = np.rint(1000 * run["drilled_length"]).astype(int).tolist()
    return found


def shown_hole(recording: Path, tick: int) -> Array:
    """What the section shows of the drilled hole: the pieces up to the tick, and the newest strip."""
    pieces = [strip for end, [strip] in read(recording, f"{SECTION}/drilled_hole", STRIPS).items() if end <= tick]
    newest = read(recording, f"{SECTION}/newly_drilled", STRIPS)
    strips = [np.array(strip) for strip in [*pieces, *newest[max(end for end in newest if end <= tick)]]]
    for before, after in pairwise(strips):
        np.testing.assert_array_equal(after[0], before[-1])
    return np.concatenate([strips[0][:1], *(strip[1:] for strip in strips)])


def test_the_drilled_hole_is_the_path_of_the_bit(recorded: Path, run: Trajectory) -> None:
    """At every row, though a piece has many rows."""
    assert list(read(recorded, f"{SECTION}/newly_drilled", STRIPS)) == ticks(run)[1:]
    assert len(read(recorded, f"{SECTION}/drilled_hole", STRIPS)) < run.row_count / 10
    for row in (1, 2, 13, 14, 15, 16, 17, 150, run.row_count - 1):
        hole = shown_hole(recorded, ticks(run)[row])
        np.testing.assert_allclose(hole, bit_positions(run)[: row + 1], atol=1e-5)


def test_of_many_rows_a_part_is_drawn(case: Case, tmp_path: Path) -> None:
    run = simulate(case, length=4.0, sample_interval=0.01)
    record(run, save=tmp_path / "fine.rrd")
    hole, bit = shown_hole(tmp_path / "fine.rrd", 4000), bit_positions(run)
    assert len(hole) < run.row_count / 5
    np.testing.assert_allclose(hole[[0, -1]], bit[[0, -1]], atol=1e-5)
    np.testing.assert_allclose(np.interp(bit[:, 1], hole[:, 1], hole[:, 0]), bit[:, 0], atol=1e-3)


def test_of_few_rows_all_are_drawn(case: Case, tmp_path: Path) -> None:
    run = simulate(case, sample_interval=5.0)
    record(run, save=tmp_path / "coarse.rrd")
    np.testing.assert_allclose(shown_hole(tmp_path / "coarse.rrd", ticks(run)[-1]), bit_positions(run), atol=1e-5)


def test_a_run_that_stands_still_is_drawn(run: Trajectory, tmp_path: Path) -> None:
    twice = Trajectory({name: np.repeat(column, 2) for name, column in run.columns.items()}, run.case)
    record(twice, save=tmp_path / "twice.rrd")
    hole = shown_hole(tmp_path / "twice.rrd", ticks(run)[-1])
    np.testing.assert_allclose(hole[np.append(True, np.diff(hole, axis=0).any(axis=1))], bit_positions(run), atol=1e-5)


def test_the_hole_has_the_colour_of_its_largest_dogleg_severity_over_half_the_bha(recorded: Path, case: Case) -> None:
    shown = read(recorded, "plots/build_rate/dogleg_severity", "Scalars:scalars")
    severity = {tick: value for tick, [value] in shown.items()}
    bands = set()
    for thing in ("drilled_hole", "newly_drilled"):
        for end, [colour] in read(recorded, f"{SECTION}/{thing}", COLOURS).items():
            largest = max(value for tick, value in severity.items() if end - 1000 * case.bha.half_length <= tick <= end)
            bands.add(band := sum(largest >= limit for limit in (1.0, 2.0, 5.0, 10.0, 20.0)))
            assert tuple(colour.to_bytes(4, "big")[:3]) == BY_SEVERITY[band]
    assert len(bands) > 2


def test_the_key_says_which_dogleg_severity_a_colour_is(recorded: Path) -> None:
    [labels] = static(recorded, f"{SECTION}/severities/labels", "Points2D:labels")
    assert labels == ["dogleg °/30 m", "1", "2", "5", "10", "20"]
    [swatches] = static(recorded, f"{SECTION}/severities", STRIPS)
    [places] = static(recorded, f"{SECTION}/severities/labels", POINTS)
    upper = [swatch[1][1] for swatch in swatches[:-1]]  # the values are beside the ends of colours, in their order
    assert np.all(np.diff(upper) > 0.0)
    height = swatches[0][1][1] - swatches[0][0][1]
    np.testing.assert_allclose([y for _, y in places[1:]], np.array(upper) - height / 2, rtol=1e-4, atol=height / 20)


def test_the_colours_mean_the_same_before_the_run_is_known(run: Trajectory, scales: Scales) -> None:
    begun = Trajectory({name: column[:2] for name, column in run.columns.items()}, run.case)
    live = choose_scales([begun], whole=False, section=np.zeros((1, 2)))
    assert live.severities == scales.severities == (1.0, 2.0, 5.0, 10.0, 20.0)


def test_the_colours_of_dogleg_severity_are_told_apart_by_lightness() -> None:
    def luminance(colour: tuple[int, int, int]) -> float:
        """Of WCAG 2.2."""
        part = np.array(colour) / 255
        linear = np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)
        return float(linear @ [0.2126, 0.7152, 0.0722])

    lightness = np.array([116 * luminance(colour) ** (1 / 3) - 16 for colour in BY_SEVERITY])  # CIE L*
    assert np.diff(lightness).min() > 9.0
    assert (luminance(BY_SEVERITY[0]) + 0.05) / (luminance(GROUND) + 0.05) > 3.0


def test_several_holes_have_the_colours_of_their_runs(run: Trajectory, tmp_path: Path) -> None:
    record({"a": run, "b": run}, save=tmp_path / "two.rrd")
    for place, name in enumerate("ab"):
        assert not read(tmp_path / "two.rrd", f"{SECTION}/{name}/drilled_hole", COLOURS)
        [[colour]] = static(tmp_path / "two.rrd", f"{SECTION}/{name}/drilled_hole", COLOURS)
        assert tuple(colour.to_bytes(4, "big")[:3]) == BY_RUN[place]
    assert not static(tmp_path / "two.rrd", f"{SECTION}/severities", STRIPS)


def test_the_stabilizers_are_across_the_bha(recorded: Path, case: Case) -> None:
    blades = stacked(recorded, f"{SECTION}/stabilizers", STRIPS)
    bha = stacked(recorded, f"{SECTION}/bha", STRIPS)[:, 0]
    np.testing.assert_allclose(blades.mean(axis=2), bha[:, 1:], atol=1e-5)
    widths = np.linalg.norm(blades[:, :, 1] - blades[:, :, 0], axis=-1)
    clearances = np.array([*case.bha.stabilizer_clearances, 0.0])
    np.testing.assert_allclose(widths, np.tile(case.bit_diameter - 2 * clearances, (len(widths), 1)), atol=1e-5)


def test_contacts_are_on_the_wall_of_the_hole(recorded: Path, run: Trajectory, case: Case) -> None:
    contacts = read(recorded, f"{SECTION}/contacts", POINTS)
    assert [len(shown) for shown in contacts.values()] == (run["stabilizer_force[1]"] != 0.0).astype(int).tolist()
    fine = np.arange(0.0, LENGTH, 0.01)
    hole = np.column_stack([np.interp(fine, run["drilled_length"], axis) for axis in bit_positions(run).T])
    deep = 1000 * (case.bha.stabilizer_positions[0] + 1.0)  # where the first stabilizer is in the drilled hole
    for tick, shown in contacts.items():
        for contact in shown if tick > deep else []:
            distance = np.linalg.norm(hole - contact, axis=1).min()
            assert distance == pytest.approx(case.bit_diameter / 2, abs=0.003)
            assert np.sign(contact[0] - np.interp(contact[1], hole[:, 1], hole[:, 0])) == -np.sign(
                run["stabilizer_force[1]"][ticks(run).index(tick)]
            )


def test_the_section_shows_a_straight_hole_beside_the_key() -> None:
    down = section_bounds(np.array([[0.0, 0.0], [0.0, 1000.0]]), around=5.0)
    assert down.hold(np.array([[-5.0, -100.0], [5.0, 1100.0]]))
    assert down.x[1] > 0.3 * (down.x[1] - down.x[0])
    flat = section_bounds(np.array([[0.0, 0.0], [1000.0, 0.0]]), around=5.0)
    assert flat.hold(np.array([[-200.0, -5.0], [1100.0, 5.0]]))
    for bounds in (down, flat):
        assert (bounds.x[1] - bounds.x[0]) / (bounds.y[1] - bounds.y[0]) == pytest.approx(0.65)


def test_the_strip_is_the_ripple_over_the_measured_depth(recorded: Path, scales: Scales, case: Case) -> None:
    ripple = {tick: value for tick, [value] in read(recorded, "plots/ripple/ripple", "Scalars:scalars").items()}
    pieces = read(recorded, "strip/hole", STRIPS)
    path = np.concatenate([np.array(piece) for [piece] in pieces.values()])
    drilled = path[:, 1] - case.survey.measured_depth[-1]
    [lane] = scales.strip.lanes
    tick, height = np.array(list(ripple)), np.array(list(ripple.values())) / 1000
    shown = (path[:, 0] - lane) / scales.strip.lateral
    np.testing.assert_allclose(shown, np.interp(1000 * drilled, tick, height), atol=1e-4)
    at_all = np.interp(tick[tick <= 1000 * drilled[-1]] / 1000, drilled, shown)
    np.testing.assert_allclose(at_all, height[: len(at_all)], atol=3e-3)  # of waves of ±40 mm, whose crests are shown
    assert at_all.max() == pytest.approx(height[: len(at_all)].max(), abs=1e-4)
    assert drilled[0] == pytest.approx(0.0, abs=1e-5)
    assert max(ripple) / 1000 - drilled[-1] < scales.trend
    for end, [piece] in pieces.items():
        assert piece[-1][1] - case.survey.measured_depth[-1] == pytest.approx(end / 1000, abs=1e-3)
    assert scales.strip.bounds.hold(path)


def test_the_strips_of_several_runs_are_side_by_side(case: Case, run: Trajectory, tmp_path: Path) -> None:
    heavy = simulate(replace(case, active_weight_on_bit=2 * case.active_weight_on_bit), sample_interval=0.5)
    record({"a": run, "b": heavy}, save=tmp_path / "two.rrd")
    shown = [read(tmp_path / "two.rrd", f"strip/{name}/hole", STRIPS).values() for name in "ab"]
    left, right = ([x for [piece] in pieces for x, _ in piece] for pieces in shown)
    assert max(left) < min(right)


def test_what_is_drilled_beyond_the_end_widens_section_and_strip(scales: Scales, run: Trajectory) -> None:
    assert scales.hold(run)
    deeper = Trajectory(run.columns | {"drilled_length": 3 * run["drilled_length"]}, run.case)
    assert not scales.hold(deeper)
    assert scales.widened(deeper).hold(deeper)
    (top, bottom), (wider, deep) = scales.strip.bounds.y, scales.widened(deeper).strip.bounds.y
    begin = scales.strip.start
    assert (begin - wider) / (deep - wider) == pytest.approx((begin - top) / (bottom - top))  # the room for text
    below = Trajectory(run.columns | {"true_vertical_depth": 3 * run["true_vertical_depth"]}, run.case)
    assert not scales.hold(below)
    assert scales.widened(below).hold(below)


def test_of_a_run_that_begins_late_nothing_is_shown_before_its_beginning(run: Trajectory, tmp_path: Path) -> None:
    late = Trajectory({name: values[32:] for name, values in run.columns.items()}, run.case)
    record(late, save=tmp_path / "late.rrd")
    begin = late["drilled_length"][0]
    for entity in ("plots/ripple/ripple", "plots/bit_tilt/bit_tilt"):
        assert min(read(tmp_path / "late.rrd", entity, "Scalars:scalars")) >= round(1000 * begin)
    top = min(
        y for [strip] in read(tmp_path / "late.rrd", "strip/hole", "LineStrips2D:strips").values() for _, y in strip
    )
    [depths] = static(tmp_path / "late.rrd", "strip/grid/depth", "Points2D:labels")
    assert late.case
    assert min(top, *map(float, depths)) >= late.case.survey.measured_depth[-1] + begin


def test_the_depths_of_a_hole_of_centimetres_are_told_apart(run: Trajectory, tmp_path: Path) -> None:
    record(Trajectory({name: values[:1] for name, values in run.columns.items()}, run.case), save=tmp_path / "one.rrd")
    [depths] = static(tmp_path / "one.rrd", "strip/grid/depth", "Points2D:labels")
    assert len(set(depths)) == len(depths) > 1


def test_of_a_live_run_beyond_its_end_the_depths_fit_the_wider_view(
    run: Trajectory, case: Case, tmp_path: Path
) -> None:
    with live(replace(case, length=5.0), save=tmp_path / "long.rrd") as view:
        for time, row in enumerate(np.column_stack(list(run.columns.values())).tolist()):
            view.send(time=time, **dict(zip(run.columns, row, strict=True)))
    labels = list(read(tmp_path / "long.rrd", f"{SECTION}/depths", "Points2D:labels").values())
    places = list(read(tmp_path / "long.rrd", f"{SECTION}/depths", POINTS).values())
    start = case.survey.measured_depth[-1]
    shown = [float(label.removeprefix("MD ").removesuffix(" m")) for label in labels[-1]]
    step = shown[0]
    assert shown == list(np.arange(step, start + LENGTH + 1e-9, step))
    down = np.interp(np.array(shown) - start, run["drilled_length"], run["true_vertical_depth"])
    there = np.array(shown) > start
    np.testing.assert_allclose(np.array(places[-1])[there, 1], down[there], atol=1e-3)


def test_a_plan_is_drawn_for_each_start(case: Case, run: Trajectory, tmp_path: Path) -> None:
    survey = case.survey
    deeper = replace(case, survey=replace(survey, measured_depth=tuple(20.0 + md for md in survey.measured_depth)))
    plan = Survey((0.0, 100.0), (0.0, 1.0))
    record({"a": run, "b": replace(run, case=deeper)}, plan=plan, save=tmp_path / "plans.rrd")
    for name, start in (("a", survey.measured_depth[-1]), ("b", 20.0 + survey.measured_depth[-1])):
        curve = read(tmp_path / "plans.rrd", f"plots/inclination/0_plan/{name}/planned", "Scalars:scalars")
        expected = np.degrees((start + run["drilled_length"]) / 100.0)
        assert np.ravel(list(curve.values())) == pytest.approx(expected, abs=1e-3)
    [paths] = static(tmp_path / "plans.rrd", f"{SECTION}/plan", STRIPS)
    assert len(paths) == 2


def test_the_depths_are_beside_a_flat_hole_where_they_are(case: Case, tmp_path: Path) -> None:
    flat = replace(case, survey=replace(case.survey, inclination=(np.pi / 2,) * 3), length=300.0)
    run = simulate(flat, sample_interval=0.5)
    record(run, save=tmp_path / "flat.rrd")
    labels = list(read(tmp_path / "flat.rrd", f"{SECTION}/depths", "Points2D:labels").values())[-1]
    places = list(read(tmp_path / "flat.rrd", f"{SECTION}/depths", POINTS).values())[-1]
    for label, (x, _) in zip(labels[:2], places[:2], strict=True):
        length = float(label.removeprefix("MD ").removesuffix(" m")) - case.survey.measured_depth[-1]
        assert x == pytest.approx(np.interp(length, run["drilled_length"], run["displacement"]), abs=0.1)
    assert len({y for _, y in places}) == len(places) > 2

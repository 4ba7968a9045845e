"""What the viewer says of a run at each drilled length, against `find_rippling` of the run up to there."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from math import radians
from pathlib import Path

import numpy as np
import pytest
import rerun as rr

from boreprop.analysis.rippling import find_rippling
from boreprop.analysis.search import State
from boreprop.analysis.spiral.closed_form import spiral as closed_form
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.paper import paper_case
from boreprop.core.survey import Survey
from boreprop.errors import InputError
from boreprop.run.completion import axis_of
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz.record import Drawing, record
from boreprop_viz.source import between, live
from boreprop_viz.verdict import Saying, Verdict
from places import EXAMPLES
from rrd import read

START = paper_case().survey.measured_depth[-1]
SIZE = re.compile(r"waves of ([\d.]+) m, ±([\d.e-]+) °, ±([\d.e-]+) mm")


def pieces(run: Trajectory, rows: int) -> Iterator[Trajectory]:
    """A run cut into pieces of so many rows."""
    for first in range(0, run.row_count, rows):
        yield Trajectory({name: values[first : first + rows] for name, values in run.columns.items()}, run.case)


def say(run: Trajectory, rows: int = 100, origin: float = 0.0) -> list[Saying]:
    """What is said of a run that comes in pieces of so many rows."""
    assert run.case
    verdict = Verdict(run.case, origin)
    return [saying for piece in pieces(run, rows) for saying in verdict.follow(piece)] + verdict.end()


def heavier(case: Case, times: float, length: float) -> Trajectory:
    return simulate(replace(case, active_weight_on_bit=times * case.active_weight_on_bit), length=length)


@pytest.fixture(scope="module", params=["ripples", "heavier", "dies out", "steered"])
def run(request: pytest.FixtureRequest) -> Trajectory:
    """Runs that ripple, that do not, and that ripple under steering."""
    times = {"ripples": 1.0, "heavier": 2.0, "dies out": 4.0}
    if request.param in times:
        return heavier(paper_case(), times[request.param], 160.0)
    return heavier(load_case(EXAMPLES / "build_section.toml"), 0.1, 500.0)


def made_up(begins: float, ends: float, length: float) -> Trajectory:
    """A straight hole with waves of 5 m and ±1°, in which the contact changes, from one length to another."""
    s = np.arange(0.0, length, 0.1)
    there = np.clip((s - begins) / 5.0, 0.0, 1.0) * np.exp(-np.maximum(s - ends, 0.0))
    inclination = 0.5 + radians(1.0) * there * np.sin(2 * np.pi * s / 5.0)
    x, z = axis_of(s, inclination).T
    columns = {"drilled_length": s, "borehole_inclination": inclination, "displacement": x, "true_vertical_depth": z}
    contact = np.where(there > 0.01, np.sign(inclination - 0.5), 1.0)
    columns |= {"stabilizer_contact[1]": contact, "bit_tilt_saturation": np.zeros(len(s))}
    return Trajectory(columns, paper_case())


def test_what_is_said_is_found_in_the_whole_run_up_to_there(run: Trajectory) -> None:
    said = say(run)
    assert said[0] == Saying(0.0, None, "no ripple so far")
    for saying in said[1:]:
        found = find_rippling(between(run, -1.0, saying.length))
        size = SIZE.match(saying.words.rpartition(": ")[2])
        if size is None:
            assert found.state is State.NONE
            continue
        shown = [float(number) for number in size.groups()]
        actual = [found.wavelength, np.degrees(found.amplitude), 1e3 * found.axis_amplitude]
        assert shown == pytest.approx(actual, rel=0.06)  # two digits
        for words, state in (("growing", State.GROWING), ("dying", State.DYING), ("waves", State.STEERED)):
            assert saying.words.startswith(words) is (found.state is state and not saying.words.startswith("rippling"))


def test_the_last_words_are_those_of_the_summary(run: Trajectory) -> None:
    found, size = find_rippling(run), SIZE.search(say(run)[-1].words)
    shown = None if size is None else [float(number) for number in size.groups()]
    amplitudes = [float(f"{value:.2g}") for value in (np.degrees(found.amplitude), 1000 * found.axis_amplitude)]
    assert shown == (None if found.state is State.NONE else [float(f"{found.wavelength:.3g}"), *amplitudes])


def test_at_every_check_the_words_still_hold(run: Trajectory) -> None:
    said, every = say(run), run.case.bha.half_length if run.case else 0.0
    before = State.NONE
    for at in np.arange(every, run["drilled_length"][-1], every):
        found = find_rippling(between(run, -1.0, at))
        words = [saying.words for saying in said if saying.length <= at][-1]
        if found.state is before:  # twice running
            assert words.startswith("growing") is (found.state is State.GROWING)
            assert words.startswith("dying out") is (found.state is State.DYING)
            assert words.startswith("no ripple") is (found.state is State.NONE)
        if size := SIZE.search(words) if found.ripples and found.state is before else None:
            assert float(size[2]) == pytest.approx(np.degrees(found.amplitude), rel=0.16 / 0.84 + 0.06)
        before = found.state


def test_the_words_do_not_depend_on_how_the_rows_come(run: Trajectory) -> None:
    whole = say(run, run.row_count)
    assert say(run, 1) == say(run, 37) == whole


def test_words_change_only_where_something_has_changed_noticeably(run: Trajectory) -> None:
    for one, other in list(pairwise(say(run)))[:-1]:  # the last words are exact
        sizes = SIZE.search(one.words), SIZE.search(other.words)
        if one.words.split()[0] == other.words.split()[0] and sizes[0] and sizes[1]:
            assert abs(float(sizes[1][2]) / float(sizes[0][2]) - 1.0) > 0.1


def test_a_ripple_that_ends_is_told_with_where_it_began_and_ended() -> None:
    said = say(made_up(begins=60.0, ends=150.0, length=300.0))
    told = [saying for saying in said if "since" in saying.words]
    assert 60.0 < told[0].length < 60.0 + 6 * 5.0
    since = re.search(r"since (\d+) m: waves of 5 m, ±1 °, ±14 mm", told[-1].words)
    assert since
    assert float(since[1]) == pytest.approx(62.5, abs=5.0)  # where it has half its size
    over = re.fullmatch(rf"no ripple; rippling from {since[1]} m to (\d+) m", said[-1].words)
    assert over
    assert float(over[1]) == pytest.approx(150.0, abs=10.0)


def test_while_the_bit_stands_still_nothing_else_is_said(run: Trajectory) -> None:
    at = np.sort(np.append(np.arange(run.row_count), np.arange(0, run.row_count, 7)))
    time = np.arange(len(at)) / 2.0
    held = Trajectory({name: values[at] for name, values in run.columns.items()} | {"time": time}, run.case)
    said = say(held, 11)
    assert [(saying.length, saying.words) for saying in said] == [(s.length, s.words) for s in say(run)]
    for saying in said:  # from the last row at that length on: the earlier ones were not checked
        assert saying.time == time[np.flatnonzero(held["drilled_length"] == saying.length)[-1]]


def test_rows_farther_apart_than_the_checks_are_followed_too() -> None:
    sparse = simulate(paper_case(), length=200.0, sample_interval=10.0)
    unseen = "; waves under 80 m would not show between these rows"
    expected = ["no ripple so far", f"no ripple so far{unseen}", f"no ripple{unseen}"]
    assert [saying.words for saying in say(sparse, 3)] == expected


def test_the_end_says_how_the_run_ended() -> None:
    run = simulate(paper_case(), length=12.3)
    for how, why, words in (
        ("", "", "no ripple"),
        ("interrupted", "", "no ripple; interrupted at 12.3 m"),
        ("stopped", "no beam", "no ripple; stopped at 12.3 m: no beam"),
    ):
        verdict = Verdict(paper_case())
        verdict.follow(run)
        assert verdict.end(how, why) == [Saying(run["drilled_length"][-1], None, words)]
    assert Verdict(paper_case()).end("interrupted") == []  # of a run without a row there is nothing to say


class Replay:
    """A live run that gives the rows of a stored one, and then may fail."""

    def __init__(self, run: Trajectory, error: BaseException | None = None) -> None:
        self.run, self.error = run, error
        self.case, self.columns = run.case, list(run.columns)

    def __len__(self) -> int:
        return self.run.row_count

    def __iter__(self) -> Iterator[Sequence[float]]:
        yield from np.column_stack(list(self.run.columns.values())).tolist()
        if self.error:
            raise self.error


def words(path: Path) -> list[tuple[int, str]]:
    """The lines about the runs at the ticks of a recording, in order; of several texts at a tick the last holds."""
    texts = read(path, "verdict", "TextDocument:text")
    return [(tick, text.partition(":\n\n")[2]) for tick, [text] in sorted(texts.items())]


def test_a_live_run_says_what_the_stored_one_says(tmp_path: Path) -> None:
    run = simulate(paper_case(), length=60.0)
    record({"run": Replay(run)}, save=tmp_path / "live.rrd")
    record({"run": run}, save=tmp_path / "stored.rrd")
    assert words(tmp_path / "live.rrd") == words(tmp_path / "stored.rrd")
    expected = [(round(1000 * saying.length), f"- **run** {saying.words}") for saying in say(run, origin=START)]
    assert words(tmp_path / "live.rrd") == expected


@pytest.mark.parametrize(
    ("error", "end"),
    [(KeyboardInterrupt(), "interrupted at 37.3 m"), (InputError("no beam"), "stopped at 37.3 m: no beam")],
)
def test_a_run_that_does_not_reach_its_end_is_marked_so(tmp_path: Path, error: BaseException, end: str) -> None:
    run, path = simulate(paper_case(), length=30.0), tmp_path / "run.rrd"
    rec = rr.RecordingStream("test")
    rec.set_sinks(rr.FileSink(path))
    with pytest.raises(type(error)):
        Drawing.of([live("run", Replay(run, error), batch=10_000)]).draw(rec)
    rec.disconnect()
    tick, last = words(path)[-1]
    assert (tick, last.rpartition("; ")[2]) == (30_000, end)


@pytest.mark.filterwarnings("ignore:RRD file has no footer")
def test_a_recording_without_its_end_does_not_claim_to_be_drilling(tmp_path: Path) -> None:
    run, path = simulate(paper_case(), length=30.0), tmp_path / "run.rrd"
    rec = rr.RecordingStream("test")
    rec.set_sinks(rr.FileSink(path))
    drawn: list[list[tuple[int, str]]] = []

    def look(rows: float) -> None:
        rec.flush()
        drawn.append(words(path))  # as it would be left if the process were killed now

    Drawing.of([live("run", Replay(run), batch=100)]).draw(rec, look)
    rec.disconnect()
    assert drawn[-1][0] == (0, "- **run** as far as recorded: no ripple so far")
    assert all("as far as recorded" in said for _, said in drawn[-1])
    assert not any("as far as recorded" in said for _, said in words(path))


def test_a_stored_run_that_stopped_says_why(tmp_path: Path) -> None:
    run = replace(simulate(paper_case(), length=5.0), stopped="the hole curls up")
    record(run, save=tmp_path / "run.rrd")
    assert words(tmp_path / "run.rrd")[-1] == (5000, "- **run** no ripple; stopped at 12.3 m: the hole curls up")


def test_the_distance_from_the_plan_is_told(tmp_path: Path) -> None:
    run = simulate(paper_case(), length=60.0)
    plan = Survey((0.0, 60.0), (radians(2.0), radians(2.0)))  # the hole stays vertical; the plan ends at 52.68 m
    record(run, plan=plan, save=tmp_path / "run.rrd")
    said = dict(words(tmp_path / "run.rrd"))
    assert said[0] == "- **run** no ripple so far; on the plan"
    told = [(tick, found) for tick, text in said.items() if (found := re.search(r"; ([\d.]+) m low of the plan", text))]
    assert len(told) > 5
    for tick, found in told:
        assert float(found[1]) == pytest.approx(tick / 1000 * np.sin(radians(2.0)), rel=0.18, abs=0.15)
    assert "plan" not in said[60_000]


def test_of_several_runs_the_text_says_at_each_tick_what_holds_of_each(tmp_path: Path) -> None:
    runs = {"a": simulate(paper_case(), length=60.0), "b": heavier(paper_case(), 4.0, 50.0)}
    record(runs, save=tmp_path / "two.rrd")
    said = {name: say(run, origin=START) for name, run in runs.items()}
    shown = dict(words(tmp_path / "two.rrd"))
    assert set(shown) == {round(1000 * saying.length) for sayings in said.values() for saying in sayings}
    for tick, text in shown.items():
        latest = [[saying.words for saying in said[n] if round(1000 * saying.length) <= tick][-1] for n in "ab"]
        assert text == f"- **a** {latest[0]}\n- **b** {latest[1]}"


def test_waves_too_short_for_the_rows_are_named() -> None:
    run = simulate(paper_case(), length=60.0, sample_interval=0.1)
    apart = Trajectory({name: values[::10] for name, values in run.columns.items()}, run.case)
    assert "would not show" not in "".join(saying.words for saying in say(run))
    assert "; waves under 8 m would not show between these rows" in say(apart)[-1].words


WINDS = re.compile(r"a spiral to the (right|left) since (\d+) m, pitch ([\d.]+) m, radius (\d+) mm, ±[\d.]+ °")


@pytest.fixture(scope="module", params=["right", "left"])
def spiral(request: pytest.FixtureRequest) -> Trajectory:
    """A run whose ripple becomes a spiral, since its bit walks."""
    case = paper_case()
    walk = radians(5.0) if request.param == "right" else radians(-5.0)
    return simulate(replace(case, bit=replace(case.bit, walk_angle=walk)), length=90.0, sample_interval=0.2)


def test_of_a_spiral_the_words_say_to_which_side_how_wide_and_since_when(spiral: Trajectory) -> None:
    assert spiral.case
    side = "right" if spiral.case.bit.walk_angle > 0 else "left"
    expected, said = closed_form(spiral.case, side), say(spiral)
    told = WINDS.search(said[-1].words)
    assert told
    assert told[1] == side
    assert [float(told[3]), float(told[4])] == pytest.approx([expected.pitch, 1e3 * expected.radius], rel=0.03)
    # where it is said to begin, the bit goes through an ellipse that is a tenth as wide as it is long
    s, since = spiral["drilled_length"], float(told[2])
    turn = np.abs(s - since) < expected.pitch / 2
    across = np.column_stack((spiral["north"], spiral["east"]))[turn]
    across -= np.column_stack([np.polyval(np.polyfit(s[turn], part, 1), s[turn]) for part in across.T])
    major, minor = np.linalg.svd(across, compute_uv=False)
    assert 0.03 < minor / major < 0.3


def test_the_words_on_a_spiral_do_not_depend_on_how_its_rows_come(spiral: Trajectory) -> None:
    assert say(spiral, 41) == say(spiral, spiral.row_count)


def test_a_ripple_in_a_plane_is_told_so_in_space() -> None:
    """The same case in the plane and in space, which says of its waves that they lie in a plane."""
    run, other = (simulate(paper_case(), length=60.0, dimensions=dimensions) for dimensions in (2, 3))
    planar, spatial = say(run)[-1].words, say(other)[-1].words
    assert spatial.startswith("rippling since")
    assert spatial == f"{planar}, in a plane"


def test_a_ripple_that_ends_in_space_is_told_with_where_it_ended() -> None:
    """A made-up planar ripple to the east."""
    flat = made_up(begins=60.0, ends=150.0, length=300.0)
    columns = flat.columns | {
        "north": np.zeros(flat.row_count),
        "east": flat["displacement"],
        "borehole_azimuth": np.full(flat.row_count, np.pi / 2),
        "stabilizer_force_high[1]": flat["stabilizer_contact[1]"],
        "stabilizer_force_right[1]": np.zeros(flat.row_count),
        "bit_tilt_high": np.zeros(flat.row_count),
        "bit_tilt_right": np.zeros(flat.row_count),
    }
    expected, said = say(flat)[-1].words, say(Trajectory(columns, flat.case))[-1].words
    assert re.fullmatch(r"no ripple; rippling from \d+ m to \d+ m", said)
    shown, own = (list(map(float, re.findall(r"\d+", words))) for words in (said, expected))
    assert shown == pytest.approx(own, abs=1.0)

"""Recordings say what they are of, and several in one viewer keep each its own look."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import rerun as rr
from rerun.chunk import RrdReader
from rerun.experimental import ViewerClient

from boreprop.case.case import Case
from boreprop.case.file import parse_case
from boreprop.core.survey import Survey
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from boreprop_viz.picture import SOFTWARE_DRIVERS, environment
from boreprop_viz.record import Drawing, record
from boreprop_viz.source import stored
from rrd import read, static
from viewers import rerun, until

PLAN = Survey((0.0, 100.0), (0.0, 0.1))
NAMES = ("slim.csv", "wide + heavy")


@pytest.fixture(scope="module")
def runs(case: Case) -> dict[str, Trajectory]:
    """Runs of two holes so different in size that their bit frames are enlarged differently."""
    wide = replace(case, bit_diameter=2 * case.bit_diameter, active_weight_on_bit=2 * case.active_weight_on_bit)
    cases = replace(case, length=30.0), replace(wide, length=30.0)
    return {name: simulate(one, sample_interval=0.1) for name, one in zip(NAMES, cases, strict=True)}


@pytest.fixture(scope="module")
def alone(runs: dict[str, Trajectory], tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[str]]:
    """The titles of the views of each run in a viewer of its own."""
    return {name: titles_alone(run, tmp_path_factory.mktemp("alone")) for name, run in runs.items()}


def application(*runs: Trajectory, plan: Survey | None = None) -> str:
    return Drawing.of([stored(f"run {k}", run) for k, run in enumerate(runs)], plan).application


def test_recordings_that_look_alike_share_an_application_and_others_do_not(runs: dict[str, Trajectory]) -> None:
    slim, wide = runs.values()
    assert application(slim) == application(slim)
    assert len({application(slim), application(wide), application(slim, wide), application(slim, plan=PLAN)}) == 4


def test_a_recording_has_the_names_of_its_runs_and_their_cases(runs: dict[str, Trajectory], tmp_path: Path) -> None:
    record(runs, save=tmp_path / "two.rrd")
    [store] = RrdReader(tmp_path / "two.rrd").recordings()
    assert store.application_id.startswith("boreprop: slim-csv - wide - heavy ")
    [[name]] = static(tmp_path / "two.rrd", "__properties", "RecordingInfo:name")
    assert name == "slim.csv + wide + heavy"
    for run, expected in runs.items():
        entity = f"__properties/{rr.escape_entity_path_part(f'case {run}')}"
        [[text]] = static(tmp_path / "two.rrd", entity, "case_file")
        assert parse_case(text, "case") == expected.case
        [[weight]] = static(tmp_path / "two.rrd", entity, "active_weight_on_bit")
        assert expected.case
        assert weight == expected.case.active_weight_on_bit


@pytest.mark.slow
@pytest.mark.skipif(not SOFTWARE_DRIVERS, reason="no software Vulkan driver (Debian: mesa-vulkan-drivers, libvulkan1)")
@pytest.mark.parametrize("order", [NAMES, NAMES[::-1]])
@pytest.mark.parametrize("way", ["file", "connect"])
def test_each_of_two_recordings_in_one_viewer_keeps_its_look(
    runs: dict[str, Trajectory], alone: dict[str, list[str]], tmp_path: Path, order: tuple[str, str], way: str
) -> None:
    assert alone[NAMES[0]] != alone[NAMES[1]]
    with rerun("--headless", env=environment(str(tmp_path))) as (_, address):
        client = ViewerClient.connect(address)
        for name in order:
            show = {"file": opened, "connect": connected}[way]
            show(client, {name: runs[name]}, tmp_path)
            assert until(partial(shows, client, alone[name]))
        client.set_location(client.get_state().recordings[0].location)
        assert until(partial(shows, client, alone[order[0]]))


Show = Callable[[ViewerClient, dict[str, Trajectory], Path], None]


def opened(client: ViewerClient, run: dict[str, Trajectory], folder: Path) -> None:
    [name] = run
    record(run, save=folder / f"{name}.rrd")
    client.open(str(folder / f"{name}.rrd"))


def connected(client: ViewerClient, run: dict[str, Trajectory], folder: Path) -> None:
    record(run, connect=client.url)


def titles_alone(run: Trajectory, folder: Path) -> list[str]:
    """The titles of the views of a run in a viewer of its own."""
    with rerun("--headless", env=environment(str(folder))) as (_, address):
        client = ViewerClient.connect(address)
        opened(client, {"alone": run}, folder)
        return until(lambda: titles(client))


def titles(client: ViewerClient) -> list[str]:
    return sorted(view.name for view in client.get_state().views)


def shows(client: ViewerClient, expected: list[str]) -> bool:
    return titles(client) == expected


def test_runs_whose_names_differ_in_their_spaces_alone_are_drawn_apart(
    runs: dict[str, Trajectory], tmp_path: Path
) -> None:
    slim, wide = runs.values()
    record({"a b": slim, "a  b": wide, "a_b": slim, " ": wide}, save=tmp_path / "names.rrd")
    for part, expected in {"a_b": slim, "a_b_2": wide, "a_b_3": slim, "run": wide}.items():
        curve = read(tmp_path / "names.rrd", f"plots/bit_tilt/{part}/bit_tilt", "Scalars:scalars")
        assert np.ravel(list(curve.values())) == pytest.approx(np.degrees(expected["bit_tilt"]), abs=1e-4)


def test_a_name_is_shown_as_it_is_in_texts(runs: dict[str, Trajectory], tmp_path: Path) -> None:
    record(dict(zip(("a|b", "*c*"), runs.values(), strict=True)), save=tmp_path / "names.rrd")
    [[table]] = static(tmp_path / "names.rrd", "case", "TextDocument:text")
    assert table.startswith("|  | a\\|b | \\*c\\* |\n")
    texts = read(tmp_path / "names.rrd", "verdict", "TextDocument:text")
    assert all("**a\\|b**" in text and "**\\*c\\***" in text for [text] in texts.values())


def test_the_numbers_of_two_runs_at_one_place_do_not_cover_each_other(
    runs: dict[str, Trajectory], tmp_path: Path
) -> None:
    slim, _ = runs.values()
    record({"a": slim, "b": slim}, save=tmp_path / "twice.rrd")
    labels = [f"bit_frame/contact_force/1/{run}/label" for run in "ab"]
    places = [read(tmp_path / "twice.rrd", label, "Points2D:positions") for label in labels]
    apart = [other[1] - one[1] for one, other in zip(*map(drawn, places), strict=True)]
    top, bottom = Drawing.of([stored("a", slim)]).scales.frame.y
    assert min(apart) > 0.03 * (bottom - top)


def drawn(places: dict[int, list[tuple[float, float]]]) -> list[tuple[float, float]]:
    return [place for some in places.values() for place in some]

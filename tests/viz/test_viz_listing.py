"""The listing at survey stations in a recording, against that of the summary."""

from dataclasses import replace
from pathlib import Path

import pytest

from boreprop.analysis.plan import planned_hole
from boreprop.analysis.stations import list_stations
from boreprop.case.file import load_case
from boreprop.case.paper import paper_case
from boreprop.case.tables import read_survey
from boreprop.report.tables.stations import headings, lines
from boreprop.run.simulate import simulate
from boreprop_viz.record import record
from places import EXAMPLES
from rrd import static


def tables(path: Path) -> str:
    """The last text of the listing."""
    texts = static(path, "stations", "TextDocument:text")
    return str(texts[-1][0])


def cells(text: str, name: str) -> list[tuple[str, ...]]:
    """The lines of the table of a run, its heading first."""
    table = text.partition(f"**{name}**\n\n")[2].partition("\n\n")[0].splitlines()
    return [tuple(cell.strip() for cell in line.strip("|").split("|")) for line in table if "---" not in line]


def test_the_listing_is_that_of_the_summary_with_its_plan(tmp_path: Path) -> None:
    run = simulate(load_case(EXAMPLES / "build_section.toml"), length=200.0)
    plan = read_survey(EXAMPLES / "build_section_plan.csv")
    record(run, plan=plan, save=tmp_path / "run.rrd")
    expected = list_stations(run, 30.0, planned_hole(plan, 2594.0))
    heading, *rows = cells(tables(tmp_path / "run.rrd"), "run")
    assert heading == tuple(text.replace("\n", " ") for text in headings(expected))
    assert rows == lines(expected)
    assert len(rows) == 9


@pytest.mark.parametrize("spacing", [0.1, 0.3])
def test_a_ripple_does_not_show_in_the_listing_of_any_run(tmp_path: Path, spacing: float) -> None:
    ripples = simulate(paper_case(), length=120.0, sample_interval=spacing)
    heavier = simulate(replace(paper_case(), active_weight_on_bit=26e3), length=60.0, sample_interval=spacing)
    record({"a": ripples, "b": heavier}, save=tmp_path / "two.rrd")
    text = tables(tmp_path / "two.rrd")
    late = [float(row[1]) for row in cells(text, "a")[1:] if float(row[0]) > 60.0]
    assert max(late) - min(late) < 0.1
    assert cells(text, "a")[1:] == lines(list_stations(ripples, 30.0))
    assert cells(text, "b")[1:] == lines(list_stations(heavier, 30.0))

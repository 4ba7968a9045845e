"""Where the axis of a BHA leaves the hole, the FMU's log says so, once. In a process of its own."""

from dataclasses import replace
from functools import partial
from math import radians
from pathlib import Path

import pytest

from boreprop.analysis.sag import largest_sag
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.inputs import Schedule
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.report.tables.sag import outside_the_hole
from boreprop.run.simulate import simulate
from conftest import Command, Pack
from flavours import LOGGED, Flavour, both_flavours
from places import EXAMPLES
from scenarios import report

COLLARS = BottomHoleAssembly((13.716, 22.86, 50.292), (0.0, 0.0), 0.3, 1332.9, 9.575e6)  # 27 m of 7 in without a blade


def drops(inclination_deg: float, rss_force: float) -> Case:
    """An assembly with long collars in a hole of 9 in."""
    inclination = radians(inclination_deg)
    return Case(
        bha=COLLARS,
        bit=BitRock(20.0, 1.0, radians(2.0)),
        bit_diameter=0.2286,
        active_weight_on_bit=89e3,
        length=100.0,
        survey=Survey((0.0, 100.0), (inclination, inclination)),
        schedule=Schedule((0.0,), (rss_force,)),
    )


host = partial(report, "fmu_outside_host")


def told(case: Case, length: float) -> str:
    """What `boreprop summary` says of a run up to a length, whose largest sag is at its end."""
    sag = largest_sag(simulate(case, length=length, sample_interval=0.05))
    assert sag.drilled_length == pytest.approx(length)
    return outside_the_hole(sag)


@both_flavours
def test_collars_that_hang_through_the_wall_are_logged_once_in_the_words_of_the_summary(
    pack: Pack, flavour: Flavour
) -> None:
    case = drops(20.0, 0.0)
    [line] = host("along", pack(case, flavour), 120, 0.5, 0.0)
    assert line == [*LOGGED["warning"], told(case, 0.5)]
    assert line[2].startswith(
        "37.4 m behind the bit the axis of the BHA is 189 mm below that of the hole after 0.5 m, 74"
    )


@both_flavours
def test_a_bha_that_leaves_on_its_way_is_logged_where_it_is_seen_outside_first(pack: Pack, flavour: Flavour) -> None:
    case = drops(10.3, 20e3)
    [(*kind, line)] = host("along", pack(case, flavour), 400, 0.1, 20e3)
    length = float(line.partition("after ")[2].partition(" m")[0])
    assert tuple(kind) == LOGGED["warning"]
    assert 16.0 < length < 24.0  # rows of 0.25 m show it outside from 18 m on
    assert line == told(case, length)


@both_flavours
@pytest.mark.parametrize("name", ["paper_case", "build_section"])
def test_a_bha_inside_its_hole_is_not_logged(pack: Pack, flavour: Flavour, name: str) -> None:
    assert host("along", pack(load_case(EXAMPLES / f"{name}.toml"), flavour), 40, 2.0, 2e3) == []


@both_flavours
def test_who_goes_back_hears_it_once_and_who_starts_over_again(pack: Pack, flavour: Flavour) -> None:
    assert host("back_and_forth", pack(drops(20.0, 0.0), flavour)) == [1, 1, 1]


@both_flavours
def test_hosts_that_ask_for_no_log_hear_it_too(pack: Pack, flavour: Flavour) -> None:
    [(*kind, _)] = host("without_logging", pack(drops(20.0, 0.0), flavour))
    assert tuple(kind) == LOGGED["warning"]


@both_flavours
def test_the_command_that_runs_an_fmu_passes_it_on(
    pack: Pack, flavour: Flavour, command: Command, tmp_path: Path
) -> None:
    fmu = pack(replace(drops(20.0, 0.0), length=5.0), flavour)
    done = command("boreprop-fmu", "run", fmu, "--output", "run.csv")
    [line] = done.stderr.splitlines()
    assert (done.returncode, len(list(tmp_path.iterdir()))) == (0, 2)
    assert line.startswith(f"warning: {fmu}: 37.4 m behind the bit the axis of the BHA is 18")

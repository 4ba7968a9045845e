"""Table, picture and command of steering."""

import re
from dataclasses import replace
from math import degrees, radians
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from boreprop.analysis.rippling import find_rippling
from boreprop.analysis.steering import build_rate_curve, reversal, steady_response
from boreprop.analysis.summary import summarize as summary_of
from boreprop.case.case import Case
from boreprop.case.inputs import Schedule
from boreprop.case.paper import paper_case
from boreprop.core.modes import Modes
from boreprop.core.survey import Survey
from boreprop.core.system import scale
from boreprop.report.figures.steering import draw
from boreprop.report.tables.steering import lines, piece_lines, summarize, warnings
from boreprop.run.simulate import simulate
from conftest import Command
from places import EXAMPLES
from steering_cases import DEGREES_PER_30_M, saturating


def test_the_table_warns_near_and_beyond_the_reversal_and_where_the_tilt_is_at_its_limit(case: Case) -> None:
    scaled = scale(case.bha, case.bit)
    zero = reversal(scaled, Modes(scaled)[(0,)])
    weight = zero * case.bha.force_scale / case.bit.lateral_steering_resistance
    for part, where in ((0.7, ""), (0.9, "close to"), (1.1, "above")):
        curve = build_rate_curve(replace(case, active_weight_on_bit=part * weight), radians(60.0), 5e3)
        told = f"ηΠ is {where} {zero:.3g} ({weight / 1e3:.2f} kN of active weight on bit)"
        assert [told in text for text in warnings(curve, part * zero)] == ([True] if where else [])
    case = saturating(case)
    curve = build_rate_curve(case, radians(60.0), 16e3)
    assert [text.partition(" kN")[0] for text in warnings(curve, 0.558)] == ["-16.00 to +0.98", "+5.57 to +16.00"]


def test_the_table_has_the_numbers_in_kilonewtons_and_degrees(build_section: Case) -> None:
    summary = summarize(build_section, radians(53.43), 31e3)
    told = dict(lines(summary))
    assert told["force that holds the inclination"] == f"{summary.holding[0].rss_force / 1e3:+.2f} kN"
    free = summary.free.build_rate * DEGREES_PER_30_M
    assert told["build rate without force"] == f"{free:+.2f} °/30 m, on a wall: 1 low, 2 low"
    pieces = piece_lines(summary.curve)
    assert pieces[1][0] == "+15.20 to +18.29"
    assert [line[4] for line in pieces] == ["1 low, 2 low", "2 low", "1 high, 2 low"]
    weight_per_eta_pi = build_section.active_weight_on_bit / summary.eta_pi
    for line, piece in zip(pieces, summary.curve, strict=True):
        weight = piece.reversal_eta_pi * weight_per_eta_pi
        assert line[5] == f"{weight / 1e3:.4g} ({piece.reversal_eta_pi:.3g})"


def test_unless_told_the_table_is_for_the_end_of_the_hole(case: Case) -> None:
    curved = replace(case, survey=Survey((0.0, 30.0), (0.2, 0.6)))
    assert dict(lines(summarize(curved)))["inclination at which the weight acts"] == f"{degrees(0.6):.2f} °"
    assert dict(lines(summarize(curved, 0.4)))["inclination at which the weight acts"] == f"{degrees(0.4):.2f} °"


@pytest.mark.parametrize(
    ("forces", "limit"), [((0.0,), 30e3), ((0.0, -4e3, 3e3), 4e3), ((-50e3,), 50e3)], ids=["none", "small", "large"]
)
def test_unless_told_the_forces_are_those_of_the_schedule_or_thirty_kilonewtons(
    case: Case, forces: tuple[float, ...], limit: float
) -> None:
    near_bit = replace(case.bha, stabilizer_positions=(1.2, 7.32))
    schedule = Schedule(tuple(10.0 * k for k in range(len(forces))), forces)
    for bha in (case.bha, near_bit):
        curve = summarize(replace(case, bha=bha, schedule=schedule)).curve
        assert (curve[0].start.rss_force, curve[-1].end.rss_force) == pytest.approx((-limit, limit))


@pytest.mark.parametrize("inclination_deg", [0.0, 90.0, 180.0])
def test_where_gravity_leaves_nothing_out_the_table_prints_no_rounding(
    build_section: Case, inclination_deg: float
) -> None:
    told = dict(lines(summarize(build_section, radians(inclination_deg))))
    left_out = told["left out: gravity changes along the arc"]
    assert re.fullmatch(r"(less than 0\.01|up to \d+\.\d\d) °/30 m", left_out)
    assert "-0.00" not in " ".join(told.values())


def test_the_picture_is_of_the_curve_in_kilonewtons_and_degrees(build_section: Case) -> None:
    summary = summarize(build_section, radians(53.43), 31e3)
    rates, tilts = draw(summary).axes
    for panel, of, factor in ((rates, "build_rate", DEGREES_PER_30_M), (tilts, "bit_tilt", degrees(1.0))):
        drawn = [np.asarray(line.get_xydata()) for line in panel.lines]
        for piece in summary.curve:
            ends = [[end.rss_force / 1e3, factor * getattr(end, of)] for end in (piece.start, piece.end)]
            assert any(line.shape == (2, 2) and np.allclose(line, ends) for line in drawn)


def test_the_command_prints_the_table_and_draws_only_if_asked(command: Command, tmp_path: Path) -> None:
    case_file = EXAMPLES / "build_section.toml"
    result = command("boreprop", "steering", case_file, "--inclination-deg", "53.43")
    assert (result.returncode, result.stderr) == (0, "")
    assert "+2.15 kN" in result.stdout
    assert not list(tmp_path.iterdir())
    result = command("boreprop", "steering", case_file, "--force-limit", "20e3", "--output", "steering.png")
    assert (result.returncode, result.stderr) == (0, "")
    assert "±20.00 kN" in result.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["steering.png"]
    assert imread(tmp_path / "steering.png")[..., :3].std() > 0.05


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--output", "steering.pdf"), (".png", "'.pdf'")),
        (("--force-limit", "-5"), ("--force-limit", "> 0", "'-5'")),
        (("--inclination-deg", "400"), ("--inclination-deg", "from -180 to 180", "400")),
    ],
)
def test_the_command_refuses_a_wrong_argument(
    command_here: Command, tmp_path: Path, arguments: tuple[str, str], named: tuple[str, ...]
) -> None:
    result = command_here("boreprop", "steering", EXAMPLES / "build_section.toml", *arguments)
    assert (result.returncode, result.stdout, len(result.stderr.splitlines())) == (2, "", 1)
    for name in named:
        assert name in result.stderr
    assert not list(tmp_path.iterdir())


def test_forces_under_which_waves_grow_are_warned_of_and_the_hole_then_turns_more_slowly() -> None:
    summary = summarize(replace(paper_case(), survey=Survey((0.0,), (radians(3.5),))))
    assert [text for what, text in lines(summary) if what == "warning"] == [
        f"{forces} kN: waves grow there, and a hole that ripples turns at another rate, usually a lower one"
        for forces in ("-30.00 to +0.23", "+0.30 to +30.00")
    ]
    pushed = replace(paper_case(), survey=Survey((0.0,), (radians(3.5),)), schedule=Schedule((0.0,), (5e3,)))
    run = simulate(pushed)
    assert find_rippling(run).ripples
    steady = steady_response(pushed, 5e3, radians(3.5)).build_rate
    assert 0.75 * steady < summary_of(run).build_rate < 0.85 * steady

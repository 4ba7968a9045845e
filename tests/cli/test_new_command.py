"""The command `boreprop new`: from what an engineer knows to a case that is drilled."""

import os
import subprocess
import sys
from itertools import chain
from math import atan, degrees, pi
from pathlib import Path

import pytest
import typer

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.case.template import template
from boreprop.cli.app import COMMANDS
from boreprop.cli.lazy import load_command
from boreprop.cli.new import answer_all
from boreprop.cli.questions import QUESTIONS
from boreprop.run.results import read_trajectory
from conftest import Command, assert_refused

FIELD = {
    "--hole-size": "8 1/2 in",
    "--collar-outer": "6 3/4 in",
    "--collar-inner": "2.75 in",
    "--mud-weight": "10 ppg",
    "--stabilizers": "12, 41, 70 ft",
    "--under-gauge": "2/32 in, 1/8 in",
    "--rss-position": "2.5 ft",
    "--rss-force": "2 klbf",
    "--steerability": "0.05",
    "--gauge-length": "2 in",
    "--gauge-relief": "1/32 in",
    "--weight-on-bit": "20 klbf",
    "--bluntness": "40 %",
    "--inclination": "30 deg",
    "--measured-depth": "6600 ft",
    "--length": "300 ft",
}
SI = FIELD | {  # the same, but for rounding
    "--hole-size": "0.2159",
    "--collar-outer": "171.45 mm",
    "--collar-inner": "0.06985",
    "--mud-weight": "1198.264",
    "--stabilizers": "3.6576, 12.4968, 21.336",
    "--under-gauge": "1.5875 mm, 3.175 mm",
    "--rss-position": "0.762",
    "--rss-force": "8896.443",
    "--gauge-length": "50.8 mm",
    "--gauge-relief": "0.79375 mm",
    "--weight-on-bit": "88964.43",
    "--inclination": "30",
    "--measured-depth": "2011.68",
    "--length": "91.44",
}


def options(answers: dict[str, str], **changed: str | None) -> list[str]:
    """The command line of the answers, with those in `changed` (``hole_size="7 in"``; None leaves it out)."""
    answers = answers | {f"--{name.replace('_', '-')}": value for name, value in changed.items() if value is not None}
    left_out = {f"--{name.replace('_', '-')}" for name, value in changed.items() if value is None}
    return list(chain.from_iterable((name, value) for name, value in answers.items() if name not in left_out))


def numbers(case: Case) -> list[float]:
    """All numbers of a case."""
    bha, bit = case.bha, case.bit
    return [
        *bha.stabilizer_positions,
        *bha.stabilizer_clearances,
        bha.rss_position,
        bha.distributed_weight,
        bha.flexural_stiffness,
        bit.lateral_steering_resistance,
        bit.angular_steering_resistance,
        bit.tilt_limit,
        case.bit_diameter,
        case.active_weight_on_bit,
        case.length,
        *case.survey.measured_depth,
        *case.survey.inclination,
        *case.schedule.rss_force,
    ]


def test_the_case_has_what_a_calculator_gives(command_here: Command, tmp_path: Path) -> None:
    result = command_here("boreprop", "new", "my.toml", *options(FIELD))
    assert (result.returncode, result.stderr) == (0, "")
    case = load_case(tmp_path / "my.toml")
    assert case.bit_diameter == pytest.approx(0.2159)
    assert case.bha.stabilizer_positions == pytest.approx((3.6576, 12.4968, 21.336))
    assert case.bha.stabilizer_clearances == pytest.approx((0.79375e-3, 1.5875e-3))  # half of it on each side
    assert case.bha.flexural_stiffness == pytest.approx(206e9 * pi / 64 * (0.17145**4 - 0.06985**4))
    assert case.bha.distributed_weight == pytest.approx(101.5 / 0.3048 * 4.44822 * (1 - 10 / 65.5), rel=1e-3)
    assert case.bit.lateral_steering_resistance == pytest.approx(20.0)
    assert 0.01 <= case.bit.angular_steering_resistance / case.bit.lateral_steering_resistance <= 0.1
    assert degrees(case.bit.tilt_limit) == pytest.approx(degrees(atan(1 / 64 / 2)))
    assert case.active_weight_on_bit == pytest.approx(0.6 * 20e3 * 4.4482216)
    assert case.schedule.rss_force == pytest.approx((2e3 * 4.4482216,))
    assert case.survey.measured_depth == pytest.approx((2011.68 - 21.336, 2011.68))
    assert [degrees(angle) for angle in case.survey.inclination] == pytest.approx([30.0, 30.0])


def test_field_and_si_units_give_the_same_case(command_here: Command, tmp_path: Path) -> None:
    command_here("boreprop", "new", "field.toml", *options(FIELD))
    command_here("boreprop", "new", "si.toml", *options(SI))
    field, si = (numbers(load_case(tmp_path / name)) for name in ("field.toml", "si.toml"))
    assert field == pytest.approx(si, rel=1e-6)


def test_the_comments_say_what_was_answered(command_here: Command, tmp_path: Path) -> None:
    command_here("boreprop", "new", "my.toml", *options(FIELD))
    comments = "".join(line.partition("#")[2] for line in (tmp_path / "my.toml").read_text("utf-8").splitlines())
    assert not [answer for name, answer in FIELD.items() if name != "--inclination" and answer not in comments]


def test_the_case_is_steered_and_drilled_at_once(command: Command, tmp_path: Path) -> None:
    """Its build rate is that of the steering response, and of the order that such tools build."""
    assert command("boreprop", "new", "my.toml", *options(FIELD)).returncode == 0
    steering = command("boreprop", "steering", "my.toml")
    assert (steering.returncode, steering.stderr) == (0, "")
    result = command("boreprop", "simulate", "my.toml", "--output", "run.csv")
    assert (result.returncode, result.stderr) == (0, "")
    run = read_trajectory(tmp_path / "run.csv")
    built = degrees(run["borehole_inclination"][-1] - run["borehole_inclination"][len(run["drilled_length"]) // 2])
    assert 0.5 < built / (91.44 / 2) * 30.0 < 8.0
    assert abs(run["bit_tilt"]).max() <= atan(1 / 128) + 1e-9


SECTIONS = ("4 ft, 6 3/4 in, 2 in", "30 ft, 6 3/4 in, 2 13/16 in", "40 ft, 6 1/2 in, 2 13/16 in")


def stepped(*sections: str, **changed: str | None) -> list[str]:
    """The command line of a BHA in sections."""
    given = chain.from_iterable(("--section", section) for section in sections)
    return [*options(FIELD, collar_outer=None, collar_inner=None, **changed), *given]


def test_a_bha_in_sections_has_what_a_calculator_gives(command_here: Command, tmp_path: Path) -> None:
    result = command_here("boreprop", "new", "my.toml", *stepped(*SECTIONS))
    assert (result.returncode, result.stderr) == (0, "")
    case, inch, foot = load_case(tmp_path / "my.toml"), 0.0254, 0.3048
    bha = case.bha
    assert bha.section_lengths == pytest.approx((4 * foot, 30 * foot, 40 * foot))
    assert bha.section_outer_diameters == pytest.approx((6.75 * inch, 6.75 * inch, 6.5 * inch))
    for EI, outer, inner in zip(bha.section_flexural_stiffnesses, (6.75, 6.75, 6.5), (2, 2.8125, 2.8125), strict=True):
        assert pytest.approx(206e9 * pi / 64 * inch**4 * (outer**4 - inner**4)) == EI
    weight = 101.5 / foot * 4.44822 * (1 - 10 / 65.5)  # of 6 3/4 by 2 3/4 in, from a handbook
    assert bha.section_distributed_weights[1] == pytest.approx(weight, rel=0.01)
    assert bha.axial_load
    assert case.weight_on_bit == pytest.approx(20e3 * 4.4482216)
    assert bha.body_point_positions
    assert bha.body_point_clearances[0] == pytest.approx((8.5 - 6.75) / 2 * inch)
    text = (tmp_path / "my.toml").read_text("utf-8")
    assert all(section in text for section in SECTIONS)


@pytest.mark.usefixtures("kernel")
def test_a_bha_in_sections_is_drilled_and_told_of_at_once(command: Command) -> None:
    assert command("boreprop", "new", "my.toml", *stepped(*SECTIONS)).returncode == 0
    for words in (("simulate", "my.toml", "--output", "run.csv"), ("summary", "run.csv"), ("steering", "my.toml")):
        result = command("boreprop", *words)
        assert (result.returncode, result.stderr) == (0, ""), words


def test_one_section_is_the_collar_of_the_same_size(command_here: Command, tmp_path: Path) -> None:
    command_here("boreprop", "new", "one.toml", *stepped("100 ft, 6 3/4 in, 2.75 in"))
    command_here("boreprop", "new", "collar.toml", *options(FIELD))
    one, collar = (load_case(tmp_path / name) for name in ("one.toml", "collar.toml"))
    assert numbers(one) == pytest.approx(numbers(collar), rel=1e-8)


@pytest.mark.parametrize("stabilizers", ["3 ft, 90 ft", "1, 6, 120 m", "3, 20, 40, 60, 80, 100 ft"])
def test_bhas_of_any_length_have_no_more_points_on_the_body_than_fit(
    command_here: Command, tmp_path: Path, stabilizers: str
) -> None:
    changed = {"stabilizers": stabilizers, "under_gauge": "1/8 in"}
    result = command_here("boreprop", "new", "my.toml", *stepped("130 m, 6 3/4 in, 3 in", **changed))
    assert (result.returncode, result.stderr) == (0, "")
    assert 30 < len(load_case(tmp_path / "my.toml").bha.body_point_positions) <= 128


@pytest.mark.parametrize(
    ("sections", "changed", "named"),
    [
        (("9 m, 6 3/4 in",), {}, ("--section", "between commas", "'9 m, 6 3/4 in'")),
        (("9 kg, 6 3/4 in, 2 in",), {}, ("--section", "between commas", "'9 kg")),
        (("30, 6, 2 ft",), {}, ("--section", "and an outer diameter of", "have that of the next")),
        (("9 m, 9 in, 2 in",), {}, ("--section", "below the diameter of the hole")),
        (("30 m, 6 in, 7 in",), {}, ("--section", "inner diameter below the outer one")),
        (("9 m, 6 3/4 in, 2 in",), {}, ("--stabilizers", "must not lie beyond the sections, which reach to 9 m")),
        (("30 m, 6 in, 2 in",), {"collar_outer": "6 in"}, ("--collar-outer", "must be left out beside --section")),
        (("30 m, 6 in, 2 in",), {"under_gauge": "3 in"}, ("--under-gauge", "larger than the collar")),
        (("1 m, 6 in, 2 in",) * 25, {}, ("--section", "at most 24 times")),
    ],
)
def test_sections_that_cannot_be_are_named(
    command_here: Command, tmp_path: Path, sections: tuple[str, ...], changed: dict[str, str], named: tuple[str, ...]
) -> None:
    line = [*stepped(*sections), *options({}, **changed)]
    assert_refused(command_here("boreprop", "new", "my.toml", *line), *named)
    assert not list(tmp_path.iterdir())


def test_every_question_has_one_option_and_every_option_a_question() -> None:
    command = load_command("new", COMMANDS)
    declared = [option for parameter in command.params for option in parameter.opts if option.startswith("--")]
    assert sorted(declared) == sorted(["--force", "--section", *(question.option for question in QUESTIONS)])
    assert len({question.name for question in QUESTIONS}) == len(QUESTIONS)
    assert {question.option for question in QUESTIONS} == set(FIELD)


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda question: question.name)
def test_without_a_terminal_a_missing_option_is_named(command_here: Command, tmp_path: Path, question: object) -> None:
    name = str(question.name)  # type: ignore[attr-defined]
    result = command_here("boreprop", "new", "my.toml", *options(FIELD, **{name: None}))
    assert_refused(result, f"--{name.replace('_', '-')}: ", "must be given", "got nothing")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"hole_size": "8.5"}, ("--hole-size", "without a unit is in m", "'8.5'")),
        ({"hole_size": "big"}, ("--hole-size", "such as 8.5 in", "'big'")),
        ({"hole_size": "8.5 in, 9 in"}, ("--hole-size", "a number")),
        ({"hole_size": "6 1/8 in"}, ("--collar-outer", "less than the hole of 6 1/8 in", "'6 3/4 in'")),
        ({"collar_inner": "7 in"}, ("--collar-inner", "less than the outer diameter of 6 3/4 in", "'7 in'")),
        ({"mud_weight": "10"}, ("--mud-weight", "kg/m³", "'10'")),
        ({"mud_weight": "10 in"}, ("--mud-weight", "'10 in'")),
        ({"stabilizers": "12, 41 ft, 11 ft"}, ("--stabilizers", "must increase")),
        ({"stabilizers": "1,2,3,4,5,6,7"}, ("--stabilizers", "1 to 6")),
        ({"under_gauge": "1 mm, 2 mm, 3 mm"}, ("--under-gauge", "but the last, here 2")),
        ({"under_gauge": "3.2"}, ("--under-gauge", "without a unit is in m", "'3.2'")),
        ({"under_gauge": "2 in"}, ("--under-gauge", "larger than the collar")),
        ({"rss_position": "13 ft"}, ("--rss-position", "below the first stabilizer")),
        ({"rss_force": "20"}, ("--rss-force", "must be 0 or at least 100 N", "'20'")),
        ({"bluntness": "40"}, ("--bluntness", "with %", "'40'")),
        ({"weight_on_bit": "133"}, ("--weight-on-bit", "without a unit is in N", "'133'")),
        ({"inclination": "30 m"}, ("--inclination", "'30 m'")),
        ({"length": "0"}, ("--length", "'0'")),
    ],
)
def test_a_wrong_answer_is_refused_in_one_line(
    command_here: Command, tmp_path: Path, changed: dict[str, str], named: tuple[str, ...]
) -> None:
    assert_refused(command_here("boreprop", "new", "my.toml", *options(FIELD, **changed)), *named)
    assert not list(tmp_path.iterdir())


def test_a_file_is_replaced_only_when_told_to(command_here: Command, tmp_path: Path) -> None:
    file = tmp_path / "my.toml"
    file.write_text("mine", encoding="utf-8")
    assert_refused(command_here("boreprop", "new", "my.toml", *options(FIELD)), "my.toml", "--force")
    assert file.read_text(encoding="utf-8") == "mine"
    assert command_here("boreprop", "new", "my.toml", "--force", *options(FIELD)).returncode == 0
    assert load_case(file).length == pytest.approx(91.44)


def test_a_case_file_is_toml(command_here: Command) -> None:
    assert_refused(command_here("boreprop", "new", "my.csv", *options(FIELD)), ".toml")


@pytest.mark.parametrize(
    ("changed", "stations", "clearances"),
    [
        ({"stabilizers": "4 m", "under_gauge": None}, 2, 0),
        ({"stabilizers": "4 m", "under_gauge": "1/8 in"}, 2, 0),
        ({"under_gauge": "0"}, 2, 2),
        ({"measured_depth": "0"}, 1, 2),
        ({"measured_depth": "10 m"}, 2, 2),
        ({"rss_force": "0", "bluntness": "0", "inclination": "0"}, 2, 2),
        ({"rss_force": "-30 kN"}, 2, 2),
    ],
)
def test_unusual_answers_give_a_case_too(
    command_here: Command, tmp_path: Path, changed: dict[str, str | None], stations: int, clearances: int
) -> None:
    result = command_here("boreprop", "new", "my.toml", *options(FIELD, **changed))
    assert (result.returncode, result.stderr) == (0, "")
    case = load_case(tmp_path / "my.toml")
    assert (len(case.survey.measured_depth), len(case.bha.stabilizer_clearances)) == (stations, clearances)


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
def test_in_a_terminal_what_is_left_out_is_asked(command_here: Command, tmp_path: Path) -> None:
    """A wrong answer is asked for again; Return takes what is offered, here the usual collar of the hole."""
    import pty

    given = options(FIELD, hole_size=None, collar_outer=None, collar_inner=None, length=None)
    terminal, slave = pty.openpty()
    run = subprocess.Popen(
        [sys.executable, "-m", "boreprop.cli.app", "new", "asked.toml", *given],
        cwd=tmp_path,
        stdin=slave,
        stderr=slave,
        stdout=subprocess.PIPE,
    )
    os.close(slave)
    shown = b""
    for question, answer in [
        (b"Diameter of the hole", "8.5"),
        (b"Diameter of the hole", "12 1/4 in"),
        (b"Outer diameter", ""),
        (b"Inner diameter", ""),
        (b"Length to drill", "300 ft"),
    ]:
        seen = len(shown)
        while question not in shown[seen:] or not shown.rstrip().endswith(b":"):
            shown += os.read(terminal, 1000)
        os.write(terminal, f"{answer}\n".encode())
    printed, _ = run.communicate(timeout=60)
    os.close(terminal)
    assert (run.returncode, b"asked.toml" in printed) == (0, True)
    assert b"must be 0.05 to 1.2 m" in shown
    assert b"blades" not in shown  # what was given is not asked
    collar = {"hole_size": "12 1/4 in", "collar_outer": "8 1/4 in", "collar_inner": "2 13/16 in"}
    command_here("boreprop", "new", "given.toml", *options(FIELD, **collar))
    assert (tmp_path / "asked.toml").read_bytes() == (tmp_path / "given.toml").read_bytes()


@pytest.mark.parametrize("hole", ["4 3/4 in", "6 in", "8 1/2 in", "12 1/4 in", "17 1/2 in", "26 in"])
def test_the_usual_answers_go_together(hole: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Someone who answers with the size of the hole, and Return to all else, gets a case."""

    def prompt(text: str, default: str, err: bool) -> str:
        return hole if text.startswith("Diameter of the hole") else default

    monkeypatch.setattr(typer, "prompt", prompt)
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    answers = answer_all(dict.fromkeys(question.name for question in QUESTIONS))
    (tmp_path / "my.toml").write_text(template(answers), encoding="utf-8")
    case = load_case(tmp_path / "my.toml")
    assert 0.0 < answers["collar_outer"].value < case.bit_diameter
    assert degrees(case.bit.tilt_limit) < 1.0  # the paper: about 1° or less
    assert 5.0 <= case.bit.lateral_steering_resistance <= 100.0  # the paper's range

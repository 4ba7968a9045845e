"""The page that goes through the paper: its Python computes what its tables say."""

import re
import shlex
from collections.abc import Iterator
from math import degrees
from typing import Any, NamedTuple

import numpy as np
import pytest

from boreprop.arrays import Complexes
from boreprop.case.case import Case
from boreprop.core.beam import Beam
from boreprop.core.system import Scaled, scale
from conftest import Command
from places import ROOT

PAGE = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")
CODE = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
PROSE = re.sub(r"```python\n.*?```|^\|.*$|^#.*$", "", PAGE, flags=re.DOTALL | re.MULTILINE)
NAME = re.compile(r"(?:V|VI|VII|S)\d+")
NUMBER = re.compile(r"(?<![\w.\[(/])[−±]?\d+(?:\.\d+)?(?![\w)])")
VALUE = re.compile(rf"{NUMBER.pattern}|\b(?:yes|no|stable|drift|oscillatory)\b")
VERDICTS = ("reproduced", "depends on our choice of", "not quite")


class Line(NamedTuple):
    """A line of a table: its name, what it says, and what comes after that."""

    name: str
    value: str
    remark: str
    rest: str


def tables() -> Iterator[list[list[str]]]:
    """The tables of the page, each as lines of cells, the headings first."""
    for table in re.findall(r"(?:^\|.*\n)+", PAGE, re.MULTILINE):
        lines = [[cell.strip() for cell in line.strip("|\n").split("|")] for line in table.splitlines()]
        yield [lines[0], *lines[2:]]


def lines_of(last_heading: str) -> list[Line]:
    """The lines of all tables with a column of values and, after it, the last column."""
    return [
        Line(cells[0], cells[-2], cells[-1], " ".join(cells[:-1]))
        for headings, *body in tables()
        if headings[-2:] == ["boreprop", last_heading]
        for cells in body
    ]


STATEMENTS, FINDINGS = lines_of("verdict"), lines_of("it shows")
COMMANDS = next(body for headings, *body in tables() if headings[0] == "command")


def flat(value: Any) -> Iterator[Any]:
    """What is in nested lists, one after the other."""
    if isinstance(value, list | tuple):
        for part in value:
            yield from flat(part)
    else:
        yield value


def says(text: str, value: Any) -> bool:
    """Whether a text, a number or a word, is what was computed, in as many digits as it has."""
    if isinstance(value, bool | np.bool_):
        return text == ("yes" if value else "no")
    if isinstance(value, str):
        return text == value
    number = text.lstrip("±").replace("−", "-")
    return abs(float(number) - float(value)) <= 0.501 * 10.0 ** -len(number.partition(".")[2])


@pytest.fixture(scope="module")
def computed(kernel: None) -> dict[str, Any]:
    """What the Python of the page computes."""
    names: dict[str, Any] = {}
    for code in CODE:
        exec(compile(code, "docs/paper.md", "exec"), names)
    return names


def test_the_page_has_its_statements() -> None:
    assert [line.name for line in STATEMENTS] == [
        f"{section}{k}" for section, count in (("V", 6), ("VI", 23), ("VII", 3)) for k in range(1, count + 1)
    ]
    assert [line.name for line in FINDINGS] == [f"S{k}" for k in range(1, 10)]


@pytest.mark.parametrize("line", [*STATEMENTS, *FINDINGS], ids=lambda line: line.name)
def test_values_on_the_page_are_those_that_its_python_computes(line: Line, computed: dict[str, Any]) -> None:
    texts, values = VALUE.findall(line.value), [*flat(computed.get(line.name, []))]
    assert len(texts) == len(values), (line.value, values)
    assert all(map(says, texts, values)), (line.value, values)


def test_all_that_is_computed_is_on_the_page(computed: dict[str, Any]) -> None:
    assert {name for name in computed if NAME.fullmatch(name)} <= {line.name for line in (*STATEMENTS, *FINDINGS)}


@pytest.mark.parametrize("line", STATEMENTS, ids=lambda line: line.name)
def test_every_statement_has_a_verdict(line: Line) -> None:
    assert line.remark.startswith(VERDICTS)


def test_prose_and_verdicts_have_no_numbers_of_their_own() -> None:
    for line in (*STATEMENTS, *FINDINGS):
        assert set(NUMBER.findall(line.remark)) <= set(NUMBER.findall(line.rest)), line.remark
    assert not NUMBER.findall(re.sub(r"\(\d+\)", "", PROSE))


def test_what_had_to_be_chosen_is_so_in_the_paper_s_case(case: Case) -> None:
    lines = next(body for headings, *body in tables() if headings[0] == "what")
    chosen = {cells[0]: cells[2] for cells in lines}
    assert chosen["ε = χ/η"] == f"{case.bit.angular_steering_resistance / case.bit.lateral_steering_resistance:g}"
    assert chosen["last stabilizer"] == f"{case.bha.stabilizer_positions[-1]:g} m"
    depth, inclination = case.survey.measured_depth, [degrees(angle) for angle in case.survey.inclination]
    assert inclination[:-1] == [0.0] * (len(depth) - 1)
    turn = f"vertical, turning to {inclination[-1]:g}° over the last {depth[-1] - depth[-2]:g} m"
    assert chosen["existing hole"] == turn
    assert chosen["drilled length"] == f"{case.length / case.length_scale:g} ℓ₁"


@pytest.mark.parametrize(("arguments", "printed"), COMMANDS)
def test_commands_print_what_the_page_says(arguments: str, printed: str, command_here: Command) -> None:
    name, *rest = shlex.split(arguments.strip("`"))
    result = command_here(name, *(str(ROOT / word) if word.startswith("examples/") else word for word in rest))
    assert result.returncode == 0
    assert printed in " ".join(result.stdout.split())


def printed_matrix(nu: complex, scaled: Scaled, eta_pi: float) -> Complexes:
    """The matrix νI − Σ 𝒜_i e^{−νs_i} of (19) for the states θ, ⟨Θ⟩_1 … ⟨Θ⟩_n, without contact and saturation."""
    beam, n = Beam(scaled), len(scaled.s)
    shares, first = np.array(scaled.lambda_), np.eye(n)[0]
    M = np.append(-beam.M_e * scaled.s[-1], beam.M_e * shares + beam.M_g * first)  # Σ λ_k (⟨Θ⟩_k − θ) = e_n
    F_0 = np.append(-beam.F0_e * scaled.s[-1], beam.F0_e * shares + beam.F0_g * first)
    Theta = np.eye(n + 1)[0] - F_0 / eta_pi
    delays = np.exp(-nu * np.array([0.0, *scaled.s]))
    rates = np.array([M / (scaled.epsilon * eta_pi), *(np.outer((delays[:-1] - delays[1:]) / shares, Theta))])
    return np.asarray(nu * np.eye(n + 1) - rates)


def test_the_states_of_the_paper_have_a_root_at_zero_for_each_stabilizer(case: Case) -> None:
    scaled = scale(case.bha, case.bit)
    near, nearer = (abs(np.linalg.det(printed_matrix(nu, scaled, case.eta_pi))) for nu in (1e-4, 1e-5))
    assert np.log10(near / nearer) == pytest.approx(len(scaled.s), abs=1e-2)
    # and but for these it is a root of (19) that boreprop finds too
    assert abs(np.linalg.det(printed_matrix(-0.220693, scaled, case.eta_pi))) < 1e-3

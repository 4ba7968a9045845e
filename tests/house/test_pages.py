"""The documentation as files: every page has its place, and what is made from the code leaves nothing out.

``make docs`` builds it, executes the tutorials and checks all links.
"""

import re
import shlex
from typing import Any

import pytest
import typer

import boreprop
import tables_of_code
from boreprop.cli.lazy import load_command
from boreprop.core.quantities import QUANTITIES, VARIABLES
from places import ROOT

DOCS = ROOT / "docs"
PAGES = {path.relative_to(DOCS).with_suffix("").as_posix(): path.read_text("utf-8") for path in DOCS.rglob("*.md")}
MARK = re.compile(r"^<!-- made: (\w+) ?(\S*) -->$", re.MULTILINE)
OTHERS = ["README.md", "CONTRIBUTING.md", "examples/README.md", "examples/closed_loop/README.md"]


def test_every_page_has_a_place_in_the_contents() -> None:
    contents = re.findall(r"^```\{toctree\}\n(.+?)^```", PAGES["index"], re.MULTILINE | re.DOTALL)
    listed = [line for block in contents for line in block.splitlines() if line and not line.startswith(":")]
    assert sorted([*(re.sub(r".*<(.*)>", r"\1", line) for line in listed), "index"]) == sorted(PAGES)


def made(function: str) -> str:
    """What a page has that is made by a function, all of its calls together; as the pages ask for it."""
    calls = [mark for text in PAGES.values() for mark in MARK.findall(text) if mark[0] == function]
    return "\n".join(getattr(tables_of_code, name)(*filter(None, [argument])) for name, argument in calls)


def test_every_variable_is_in_a_table_with_its_unit_and_meaning() -> None:
    lines = {line.split("`")[1].partition("[")[0]: line for line in made("variables").splitlines() if "`" in line}
    assert list(lines) == [quantity.name for quantity in VARIABLES]
    for quantity in VARIABLES:
        assert f"| {quantity.unit.replace('N.m2', 'N·m²').replace('N.m', 'N·m')} |" in lines[quantity.name]
        assert quantity.meaning.replace("*", r"\*") in lines[quantity.name]


def test_every_key_of_a_case_file_is_in_the_table_in_degrees_where_it_says_so() -> None:
    lines = {line.split("`")[1]: line for line in made("case_keys").splitlines() if "`" in line}
    keys = {quantity.key for quantity in QUANTITIES if quantity.key}
    assert set(lines) == {f"bha.{key}" if key.startswith("section.") else key for key in keys}
    assert "| ° |" in lines["bit.tilt_limit_deg"]
    assert "<= 90 |" in lines["bit.tilt_limit_deg"]


def every_command() -> dict[str, Any]:
    """All commands by what one types, such as "boreprop simulate"."""
    found = {}
    for program, module in tables_of_code.PROGRAMS.items():
        for name in getattr(module, "COMMANDS", ()):
            found[f"{program} {name}"] = load_command(name, module.COMMANDS)
        if not hasattr(module, "COMMANDS"):
            found[program] = typer.main.get_command(module.app)
    return found


def options(command: Any) -> set[str]:
    return {name for parameter in command.params for name in parameter.opts if name.startswith("--")} | {"--help"}


@pytest.mark.parametrize(("call", "command"), every_command().items(), ids=lambda value: str(value)[:30])
def test_every_command_has_a_section_with_all_its_options(call: str, command: Any) -> None:
    section = made("commands").partition(f"### {call}\n")[2].partition("\n### ")[0]
    assert options(command) - {"--version"} <= set(re.findall(r"\* `(--[\w-]+)", section))


def test_every_public_name_is_on_the_page_of_the_api() -> None:
    listed = re.findall(r"^\.\. auto\w+:: (\w+)$", PAGES["api"], re.MULTILINE)
    assert sorted([*listed, "__version__"]) == sorted(boreprop.__all__)


def commands_on(text: str) -> list[list[str]]:
    """The command lines of boreprop in a text: in cells, on indented lines, and between backquotes in a sentence."""
    text = text.replace("\\\n", " ")
    cells = "\n".join(re.findall(r"^%%bash\n(.+?)^```", text, re.MULTILINE | re.DOTALL))
    call = r"boreprop(?:-\w+)? "
    lines = re.findall(f"^({call}.+)$", cells, re.MULTILINE) + re.findall(f"^ {{4}}({call}.+)$", text, re.MULTILINE)
    lines += [" ".join(found.split()) for found in re.findall(f"`({call}[^`]+)`", text)]
    return [shlex.split(line, comments=True) for line in lines]


@pytest.mark.parametrize("page", [*PAGES, *OTHERS])
def test_commands_on_pages_exist_with_their_options(page: str) -> None:
    text, commands = PAGES.get(page) or (ROOT / page).read_text("utf-8"), every_command()
    for words in commands_on(text):
        call = words[0] if words[0] in commands else " ".join(words[:2])
        assert call in commands, words
        assert {word.partition("=")[0] for word in words if word.startswith("--")} <= options(commands[call]), words


def test_installing_without_make_gives_the_commands_of_make_demo() -> None:
    recipe = (ROOT / "Makefile").read_text("utf-8").partition("\ndemo:")[2].partition("\n\n")[0]
    commands = re.findall(r"\$\(BIN\)/(boreprop\S* .+)", recipe)
    assert len(commands) >= 5
    assert not [command for command in commands if command not in PAGES["install"]]

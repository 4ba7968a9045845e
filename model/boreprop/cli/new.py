"""The command `boreprop new`."""

import sys
from collections.abc import Callable, Mapping, Sequence
from inspect import Parameter, signature
from os.path import lexists
from pathlib import Path
from typing import Annotated, Any

import typer

from ..case.file import parse_case
from ..case.template import Answer, template
from ..errors import InputError
from ..replacing import replacing
from . import console
from .questions import QUESTIONS, Question, read_sections


def _with_options(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command an option for each question, in place of its ``**given``."""
    declared = signature(command)
    options = [
        Parameter(
            question.name,
            Parameter.KEYWORD_ONLY,
            default=None,
            annotation=Annotated[
                str | None,
                typer.Option(
                    question.option, metavar="X", help=f"{question.in_words}, such as {question.offered({})}."
                ),
            ],
        )
        for question in QUESTIONS
    ]
    own = [parameter for parameter in declared.parameters.values() if parameter.kind is not Parameter.VAR_KEYWORD]
    command.__dict__["__signature__"] = declared.replace(parameters=[*own, *options])
    return command


@_with_options
def new_command(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file to write.")],
    force: Annotated[bool, typer.Option("--force", help="Replace the file if it exists.")] = False,
    section: Annotated[
        list[str] | None,
        typer.Option(
            metavar="LENGTH,OUTER,INNER",
            help="A section of the BHA, such as '9 m, 6 3/4 in, 2 13/16 in'; one option each, from the bit up, "
            "in place of the collars. Then the load along the BHA and contact of its body with the wall count, too.",
        ),
    ] = None,
    **given: str | None,
) -> None:
    """Write a case file, with comments, from what an engineer knows.

    Each option answers a question; in a terminal those left out are asked. Amounts may have units (8.5 in, 6 3/4 in,
    10.5 ppg, 1.25 sg, 30 klbf, 133 kN); the file is in SI units.
    """
    console.check_output(case_file, (".toml",))
    if not force and lexists(case_file):
        raise InputError(f"{case_file}: must not exist, got a file; give --force to replace it")
    text = template(answer_all(given, section or ()))
    parse_case(text, case_file)
    with replacing(case_file) as draft:
        draft.write_text(text, encoding="utf-8")
    print(f"{case_file}: next, boreprop steering {case_file}")


def answer_all(given: Mapping[str, str | None], section: Sequence[str] = ()) -> dict[str, Answer]:
    """The answers to `QUESTIONS`: those given as options, by name, and in a terminal those asked for.

    With the texts of --section they have `sections`, and no collars.

    Raises
    ------
    InputError
        If an answer is wrong, or is missing where there is no terminal.
    """
    read = {question.name: question.read(text) for question in QUESTIONS if (text := given[question.name]) is not None}
    in_terminal = sys.stdin.isatty() and sys.stderr.isatty()
    answers: dict[str, Answer] = {}
    if section:
        answers["sections"] = read_sections(section, read.get("hole_size"))
    for question in QUESTIONS:
        if question.needed and section and question.name.startswith("collar") and question.name in read:
            raise question.error("must be left out beside --section", read[question.name].text)
        if question.name in read:
            answers[question.name] = question.check(read[question.name], answers)
        elif question.needed and not question.needed(answers):
            continue
        elif not in_terminal:
            raise question.error(f"must be given, such as {question.offered(answers)}", "")
        else:
            answers[question.name] = ask(question, answers)
    return answers


def ask(question: Question, before: Mapping[str, Answer]) -> Answer:
    """Ask in the terminal until the answer is right."""
    while True:
        text: Any = typer.prompt(question.in_words, default=question.offered(before), err=True)
        try:
            return question.check(question.read(text), before)
        except InputError as error:
            print(str(error).removeprefix(f"{question.option}: "), file=sys.stderr)

"""Applications that import a command only when it is called, so that help and mistakes are answered fast."""

import sys
from collections.abc import Mapping
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

from .signs import written
from .version import Version


class Legible:
    """A command whose help is written with the characters that stdout takes."""

    def get_help(self, ctx: Any) -> str:
        """The help text, for Typer, which would write UTF-8 to a stdout that takes ASCII."""
        return written(super().get_help(ctx), sys.stdout.encoding)  # type: ignore[misc]


class Command(Legible, TyperCommand):
    """The class of every command: ``app.command(cls=Command)``."""


def new_app(description: str) -> typer.Typer:
    """An application to which one command is to be added; `console.execute` starts it."""
    return typer.Typer(help=description, add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


def new_group(description: str, commands: Mapping[str, tuple[str, str]]) -> typer.Typer:
    """An application with several commands.

    Parameters
    ----------
    description
        What the application does.
    commands
        Name of a command → the module in which it is the function ``name_command``, and a sentence that says what it
        does.
    """

    class Group(Legible, TyperGroup):
        def resolve_command(self, ctx: Any, args: list[str]) -> Any:
            name, _, rest = super().resolve_command(ctx, args)
            return name, load_command(name or "", commands), rest

    app = typer.Typer(
        cls=Group, help=description, add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False
    )
    app.callback()(_with_version)
    for name, (_, summary) in commands.items():
        app.command(name, short_help=summary)(_not_loaded_yet)
    return app


def load_command(name: str, commands: Mapping[str, tuple[str, str]]) -> Any:
    """Import the command of this name, with its options, from its module."""
    module, _ = commands[name]
    app = new_app("")
    app.command(name, cls=Command)(getattr(import_module(module), f"{name}_command"))
    return typer.main.get_command(app)


def _with_version(version: Version = False) -> None:
    pass


def _not_loaded_yet() -> None:
    pass

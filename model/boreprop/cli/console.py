"""The shell that the three commands share: commands that load when they are run, one-line errors, progress.

Bad input of any kind ends a command with exit status 2 and one line on stderr, a run that stops before its end with 3;
Ctrl-C ends it with 130.
"""

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer
from typer.core import TyperGroup

from ..errors import BorepropError, InputError

EXTRAS = {  # the extra that brings a package
    "matplotlib": "plot",
    "pyarrow": "study",
    "xarray": "study",
    "fmpy": "fmu",
    "pythonfmu": "fmu",
    "rerun": "viz",
    "libcosimpy": "dev",
}
INTERRUPTED = 130  # exit status after Ctrl-C
# help is plain text: rich would take as long to load as the rest
Application = partial(typer.Typer, add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(version("boreprop"))
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
]
"""The option --version of a command or callback: ``def command(version: Version = False)``."""


def one_command(function: Callable[..., None]) -> typer.Typer:
    """An application that is one command."""
    app = Application()
    app.command()(function)
    return app


def many_commands(description: str, commands: Mapping[str, tuple[str, str]]) -> typer.Typer:
    """An application of several commands, each imported when it is run.

    Parameters
    ----------
    description
        What the application is for.
    commands
        Name of a command → the module that has a function of that name, and the line about it in the help.
    """

    class Commands(TyperGroup):
        def list_commands(self, ctx: Any) -> list[str]:  # noqa: ARG002 - the context is of no use
            return list(commands)

        def get_command(self, ctx: Any, cmd_name: str) -> Any:  # noqa: ARG002
            if cmd_name not in commands:
                return None
            module, _ = commands[cmd_name]
            return typer.main.get_command(one_command(getattr(import_module(module), cmd_name)))

        def format_commands(self, ctx: Any, formatter: Any) -> None:  # noqa: ARG002
            with formatter.section("Commands"):
                formatter.write_dl([(name, line) for name, (_, line) in commands.items()])

    app = Application(help=description, cls=Commands)

    @app.callback()
    def with_version(version: Version = False) -> None:
        pass

    return app


def fail(message: str, status: int = 2) -> NoReturn:
    """End the process with this exit status and `message` as one line on stderr."""
    print("error:", " ".join(message.split()), file=sys.stderr)
    sys.exit(status)


def warn(message: str) -> None:
    """Tell of something that is not as asked, on one line of stderr; the command goes on."""
    print("warning:", " ".join(message.split()), file=sys.stderr)


def run(app: typer.Typer) -> NoReturn:
    """Run `app` on the process's arguments and exit: 0, 130 on Ctrl-C, with one line on stderr 2 or 3.

    2 stands for bad input, 3 for a run that stopped before its end.
    """
    try:
        sys.exit(app(standalone_mode=False))
    except typer.TyperException as error:
        context = getattr(error, "ctx", None)
        fail(error.format_message() + (f" (see {context.command_path} --help)" if context else ""))
    except BorepropError as error:
        fail(str(error), error.exit_status)
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package not in EXTRAS:
            raise  # a bug
        fail(f"{package} must be installed for this: pip install 'boreprop[{EXTRAS[package]}]', got: {error}")
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}" if error.filename else str(error))
    except (KeyboardInterrupt, typer.Abort):
        sys.exit(INTERRUPTED)


def check_output(path: str | Path, suffixes: tuple[str, ...] = ()) -> Path:
    """`path`, if a file of that name could be written: called before the work, so that the work is not for nothing.

    Raises
    ------
    InputError
        If the name does not end in one of `suffixes`, its directory cannot be written to, or it is a directory itself.
    """
    path = Path(path)
    if suffixes and path.suffix not in suffixes:
        raise InputError(f"{path}: must end in {' or '.join(suffixes)}, got {path.suffix!r}")
    if not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise InputError(f"{path}: must be in a directory that can be written to, got {str(path.parent)!r}")
    if path.is_dir():
        raise InputError(f"{path}: must be a file, got a directory")
    return path


@contextmanager
def progress(description: str, total: float) -> Iterator[Callable[[float], None]]:
    """A progress bar on stderr; yields the function that takes the amount completed so far, of `total`.

    Nothing is shown where stderr is not a terminal.
    """
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console  # here: it takes as long to load as a short run to drill
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(description, total=total)
        yield lambda completed: bar.update(task, completed=completed)

"""The shell that the three commands share: an application, one-line errors, progress.

Bad input of any kind ends a command with exit status 2 and one line on stderr, a run that stops before its end with 3;
Ctrl-C ends it with 130.
"""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.metadata import version
from math import inf, nan
from pathlib import Path
from typing import Annotated, Any, NoReturn

from ..core.errors import ParameterError, TableError
from ..core.quantities import BY_NAME
from ..errors import BorepropError, InputError, Stopped

EXTRAS = {  # the extra that brings a package
    "typer": "cli",
    "rich": "cli",
    "pydantic": "cli",
    "tomli_w": "cli",
    "matplotlib": "plot",
    "pyarrow": "parquet",
    "xarray": "study",
    "fmpy": "fmu",
    "pythonfmu": "fmu",
    "rerun": "viz",
    "rerun_notebook": "notebook",
    "libcosimpy": "dev",
}
STOPPED = 3  # exit status of a run that stopped before its end
COMMANDS = {"boreprop_viz": "viz", "boreprop_fmu": "fmu"}  # a command's package: its own extra, which brings [cli] too


def fail(message: str, status: int = 2) -> NoReturn:
    """End the process with this exit status and `message` as one line on stderr."""
    print("error:", " ".join(message.split()), file=sys.stderr)
    sys.exit(status)


def warn(message: str) -> None:
    """Tell of something that is not as asked, on one line of stderr; the command goes on."""
    print("warning:", " ".join(message.split()), file=sys.stderr)


def fail_without(error: ModuleNotFoundError) -> NoReturn:
    """`fail`, naming the extra that brings the missing package. Any other missing module is a bug and raised."""
    package = (error.name or "").partition(".")[0]
    if package not in EXTRAS:
        raise error
    extra = EXTRAS[package]
    if extra == "cli":
        extra = next((own for command, own in COMMANDS.items() if command in sys.modules), extra)
    fail(f"{package} must be installed for this: pip install 'boreprop[{extra}]', got: {error}")


try:
    import typer as typer  # for the commands' modules, which get it from here: what they need may not be installed
except ModuleNotFoundError as error:
    fail_without(error)

# click.ClickException, under whatever name this version of typer brings it
ClickException: Any = typer.BadParameter.mro()[2]


def _print_version(wanted: bool) -> None:
    if wanted:
        print(version("boreprop"))
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
]
"""The option --version of a command or callback: ``def command(version: Version = False)``."""


def positive(text: str) -> float:
    """Parse an option that takes a finite number > 0: ``typer.Option(parser=positive)``."""
    try:
        value = float(text)
    except ValueError:
        value = nan
    if not 0.0 < value < inf:
        raise typer.BadParameter(f"must be a number > 0, got {text!r}")
    return value


def tolerance(text: str) -> float:
    """Parse an option that takes a relative_tolerance in the range of the table of quantities."""
    allowed = BY_NAME["relative_tolerance"]
    value = positive(text)
    if not allowed.at_least <= value <= allowed.at_most:
        raise typer.BadParameter(f"must be {allowed.at_least:g} to {allowed.at_most:g}, got {text!r}")
    return value


Tolerance = Annotated[
    float | None,
    typer.Option(
        parser=tolerance, metavar="X", help="Local error of one step of the integrator, over 1 rad and ℓ₁, if not 1e-7."
    ),
]
"""The option --tolerance of a command that drills: ``tolerance: Tolerance = None``."""


def new_app(description: str) -> typer.Typer:
    """An application to add commands to; start it with `run`."""
    return typer.Typer(help=description, add_completion=False, pretty_exceptions_enable=False)


def run(app: typer.Typer) -> NoReturn:
    """Run `app` on the process's arguments and exit: 0, 130 on Ctrl-C, with one line on stderr 2 or 3.

    2 stands for bad input, 3 for a run that stopped before its end.
    """
    try:
        sys.exit(app(standalone_mode=False))
    except ClickException as error:
        context = getattr(error, "ctx", None)
        fail(error.format_message() + (f" (see {context.command_path} --help)" if context else ""))
    except (InputError, ParameterError, TableError) as error:
        fail(str(error))
    except Stopped as error:
        fail(str(error), STOPPED)
    except BorepropError as error:
        fail(str(error))
    except ModuleNotFoundError as error:
        fail_without(error)
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}" if error.filename else str(error))
    except (KeyboardInterrupt, typer.Abort):
        sys.exit(130)
    except RuntimeError as error:
        from ..kernel.binding import KernelError  # not before: these bring numpy
        from ..kernel.compiler import CompilerError

        if not isinstance(error, (KernelError, CompilerError)):
            raise
        fail(str(error))


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

    Nothing is shown, and rich is not even loaded, where stderr is not a terminal.
    """
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(description, total=total)
        yield lambda completed: bar.update(task, completed=completed)

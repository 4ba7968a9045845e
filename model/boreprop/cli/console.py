"""One-line errors, exit statuses and progress bars, for all three commands.

Bad input of any kind ends a command with one line on stderr and exit status 2, a run that stops early with exit status
3, and Ctrl-C with 130. Whatever ends a command, drafts and temporary folders are removed.
"""

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal, NoReturn

import typer

from ..endings import endings_like_interrupt
from ..errors import BorepropError, InputError
from .signs import write_plainly

BAD_INPUT, INTERRUPTED = 2, 130  # exit statuses
EXTRAS = {  # package → the extra that installs it
    "matplotlib": "plot",
    "pyarrow": "study",
    "xarray": "study",
    "fmpy": "fmu",
    "pythonfmu": "fmu",
    "rerun": "viz",
}


def execute(app: typer.Typer) -> NoReturn:
    """Execute `app` with the arguments of the process, and exit."""
    write_plainly()
    try:
        with endings_like_interrupt():
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
                fail(f"{package} must be installed for this, got: {error}; pip install 'boreprop[{EXTRAS[package]}]'")
            except OSError as error:
                fail(f"{error.filename}: {error.strerror}" if error.filename else str(error))
    except (KeyboardInterrupt, typer.Abort):
        sys.exit(INTERRUPTED)


def fail(message: str, status: int = BAD_INPUT) -> NoReturn:
    """End the process with this exit status and `message` as one line on stderr."""
    print("error:", " ".join(message.split()), file=sys.stderr)
    sys.exit(status)


def warn(message: str) -> None:
    """Print `message` as a warning on one line of stderr; the command continues."""
    print("warning:", " ".join(message.split()), file=sys.stderr)


def check_output(path: str | Path, suffixes: tuple[str, ...] = (), *, reads: Iterable[Path] = ()) -> Path:
    """Check before the work that the file `path` can be written; return it.

    Raises
    ------
    InputError
        If the path does not end in one of `suffixes`, its directory cannot be written to, it is no regular file, or
        it is one of the files that the command `reads`.
    """
    path = Path(path)
    if suffixes and path.suffix not in suffixes:
        raise InputError(f"{path}: must end in {' or '.join(suffixes)}, got {path.suffix!r}")
    if not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise InputError(f"{path}: must be in a directory that can be written to, got {str(path.parent)!r}")
    if path.exists() and not path.is_file():
        raise InputError(f"{path}: must be a file, got {'a directory' if path.is_dir() else 'a pipe or a device'}")
    for read in reads:
        if path.exists() and read.exists() and path.samefile(read):
            raise InputError(f"{path}: must not be a file that the command reads, got one: choose another output")
    return path


def color_system() -> Literal["auto"] | None:
    """The colours that Rich may use: those of the terminal, or none if NO_COLOR is set (https://no-color.org)."""
    return None if os.environ.get("NO_COLOR") else "auto"


@contextmanager
def progress(description: str, total: float) -> Iterator[Callable[[float], None]]:
    """Show a progress bar on stderr, if that is a terminal. Yields a function that takes the part of `total` done."""
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console  # imported here, since importing rich takes longer than a short run
    from rich.progress import Progress

    with Progress(console=Console(stderr=True, color_system=color_system()), transient=True) as bar:
        task = bar.add_task(description, total=total)
        yield lambda completed: bar.update(task, completed=completed)

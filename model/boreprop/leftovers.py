"""Drafts and temporary folders, which are to be removed whatever ends the work that needs them."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from shutil import rmtree
from tempfile import gettempdir

_left: set[Path] = set()  # what exists, or may come to exist


@contextmanager
def removed_afterwards(path: Path) -> Iterator[Path]:
    """Yield the path of a file or folder that is to be made, and remove it, if it is there, at the end."""
    _left.add(path)  # before it exists: a signal may come at any moment
    try:
        yield path
    finally:
        _remove(path)
        _left.discard(path)


@contextmanager
def temporary_folder(prefix: str, parent: Path | None = None) -> Iterator[Path]:
    """Yield an empty folder of its own in `parent`, or where temporary files go, and remove it at the end.

    Raises
    ------
    OSError
        If it cannot be made.
    """
    name = f"{prefix}{os.urandom(8).hex()}"
    with removed_afterwards((Path(gettempdir()) if parent is None else parent) / name) as folder:
        folder.mkdir(mode=0o700)
        yield folder


def remove_leftovers() -> None:
    """Remove what a second signal has kept from being removed, or one that came between two statements."""
    while _left:
        with suppress(OSError):
            _remove(_left.pop())


def _remove(path: Path) -> None:
    if path.is_dir():
        rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)

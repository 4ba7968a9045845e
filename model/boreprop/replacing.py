"""Writes files that appear complete or not at all."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from errno import ENOENT
from pathlib import Path

from .leftovers import removed_afterwards


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield the path of a draft beside `path`. At the end the draft replaces `path`; after an error it is removed.

    Of several processes that write the same file, on whatever machines, the last one wins, with a whole file.

    Raises
    ------
    FileNotFoundError
        If the folder does not exist.
    OSError
        If it cannot be written; it names the file.
    """
    if not path.parent.is_dir():
        raise FileNotFoundError(ENOENT, "the folder does not exist", str(path))
    draft = path.with_name(f".{os.urandom(4).hex()}.{path.name}")  # no process number: two containers may have the same
    with removed_afterwards(draft):
        try:
            yield draft
            os.replace(draft, path)
        except OSError as error:
            if error.errno and error.filename is None:  # of a write, as to a full disk
                error.filename = str(path)
            raise

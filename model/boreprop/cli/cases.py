"""The case of a command that drills or analyses it."""

from pathlib import Path

from ..case.case import Case
from ..case.file import load_case
from ..case.usual import unusual
from . import console


def open_case(path: Path) -> Case:
    """Read a case file; warn, once and in one line, of what in it is far from any bottom-hole assembly."""
    case = load_case(path)
    found = unusual(case)
    if found:
        console.warn(f"{path}: {'; '.join(found)}")
    return case

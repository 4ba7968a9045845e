"""Draws runs with Rerun. In a notebook, call `show`."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .notebook import show as show


def __getattr__(name: str) -> Any:  # imports late, so that the command can say which package is missing
    if name != "show":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .notebook import show

    return show

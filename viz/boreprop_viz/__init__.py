"""Runs drawn with Rerun. In a notebook: `show`."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .notebook import show as show


def __getattr__(name: str) -> Any:  # so that the command can say what is missing before anything needs it
    if name != "show":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .notebook import show

    return show

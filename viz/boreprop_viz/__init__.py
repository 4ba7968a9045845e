"""Draws runs with Rerun. In a notebook, call `show`; in a script with a loop of your own, `live`."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .notebook import show as show
    from .own_loop import live as live

MODULES = {"live": "own_loop", "show": "notebook"}  # name → where it is defined


def __getattr__(name: str) -> Any:  # imports late, so that the command can say which package is missing
    if name not in MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{MODULES[name]}", __name__), name)

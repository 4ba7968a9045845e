"""What goes wrong in a way that a user can do something about."""

from reprlib import Repr
from typing import TYPE_CHECKING

from .core.errors import BorepropError as BorepropError
from .core.errors import ParameterError as ParameterError
from .core.errors import TableError as TableError

if TYPE_CHECKING:
    from .run.trajectory import Trajectory


class InputError(BorepropError, ValueError):
    """What a user gave cannot be used. The message is one line: file, key, constraint, value."""


class MissingColumn(InputError, KeyError):
    """A run lacks a column. The message names it, and those that there are."""

    __str__ = Exception.__str__  # that of a KeyError puts the message in quotes


class RootsNotFound(BorepropError):
    """Some of the roots of a mode could not be found. The message says how many, and what helps."""


class Stopped(BorepropError):
    """A run could not go on to its end. The message says where it stopped and what helps.

    Parameters
    ----------
    message
        One line.
    trajectory
        The rows so far, where they are kept; its `stopped` is the message.
    """

    def __init__(self, message: str, trajectory: "Trajectory | None" = None) -> None:
        super().__init__(message)
        self.trajectory = trajectory


def shown(value: object) -> str:
    """`value` for an error message: a table by its keys, anything long by its beginning."""
    short = Repr()
    short.maxlist = short.maxtuple = 8
    short.maxstring = short.maxother = 80
    return short.repr(list(value) if isinstance(value, dict) else value)

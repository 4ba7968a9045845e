"""What goes wrong in a way that a user can do something about."""

from reprlib import Repr

from .core.errors import BorepropError as BorepropError
from .core.errors import CannotContinue as CannotContinue
from .core.errors import ParameterError as ParameterError
from .core.errors import TableError as TableError


class InputError(BorepropError, ValueError):
    """What a user gave cannot be used. The message is one line: file, key, constraint, value."""


class MissingColumn(InputError, KeyError):
    """A run lacks a column. The message names it, and those that there are."""

    __str__ = Exception.__str__  # that of a KeyError puts the message in quotes


class RootsNotFound(BorepropError):
    """Some of the roots of a mode could not be found. The message says how many, and what helps."""


def shown(value: object) -> str:
    """`value` for an error message: a table by its keys, anything long by its beginning."""
    short = Repr()
    short.maxlist = short.maxtuple = 8
    short.maxstring = short.maxother = 80
    return short.repr(list(value) if isinstance(value, dict) else value)

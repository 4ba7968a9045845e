"""Errors that a user can do something about. All are `BorepropError`."""

from reprlib import Repr

from .core.errors import BorepropError as BorepropError
from .core.errors import CannotContinue as CannotContinue
from .core.errors import ParameterError as ParameterError
from .core.errors import TableError as TableError


class InputError(BorepropError, ValueError):
    """A file, option or argument cannot be used. The message is one line: file, key, constraint, value."""


class MissingColumn(InputError, KeyError):
    """A run lacks a column. The message names the missing column and those that the run has."""

    __str__ = Exception.__str__  # KeyError.__str__ would put the message in quotes


class RootsNotFound(BorepropError):
    """Some of the roots of a mode could not be found. The message says how many, and what to do."""


class SpiralNotFound(BorepropError):
    """The equations of a spiral could not be solved. The message says where, and what to do."""


def shown(value: object) -> str:
    """The text of `value` in an error message: of a table its keys, of anything long its beginning."""
    short = Repr()
    short.maxlist = short.maxtuple = 8
    short.maxstring = short.maxother = 80
    return short.repr(list(value) if isinstance(value, dict) else value)

"""What goes wrong in a way that a user can do something about."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .results import Trajectory


class BorepropError(Exception):
    """The base of the errors of this package."""


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

"""The errors of the core: what goes wrong in a way that a user can do something about."""

from math import isnan

from .problems import CONSTRAINTS, OBSTACLES, Problem


class BorepropError(Exception):
    """The base of the errors of this package. The message is one line."""

    exit_status = 2  # of a command that ends with it


class ParameterError(BorepropError, ValueError):
    """A parameter breaks a constraint.

    Attributes
    ----------
    name, constraint, value
        The parts of the message.
    problem
        What an engine has found; None for a constraint that no engine checks.
    """

    def __init__(self, name: str, constraint: str, value: object, problem: Problem | None = None) -> None:
        super().__init__(name, constraint, value, problem)
        self.name, self.constraint, self.value, self.problem = name, constraint, value, problem

    def __str__(self) -> str:
        return self.problem.sentence if self.problem else f"{self.name}: {self.constraint}, got {self.value!r}"


class TableError(BorepropError, ValueError):
    """A table file cannot be read. The message names the file, the line, the constraint and the value."""


class CannotContinue(BorepropError):
    """An engine cannot drill on. Nothing has changed then: the bit is where it was, under the inputs it had.

    Attributes
    ----------
    problem
        What it has met.
    code
        Its kind, a key of `OBSTACLES`.
    place
        Where the bit was then, m from the start of the run.
    helps
        What a user can do about it.
    """

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.problem, self.code, self.place = problem, problem.code, problem.place
        self.helps = problem.tell(OBSTACLES[problem.code][1])

    def __str__(self) -> str:
        return self.problem.sentence


def error_of(problem: Problem) -> ParameterError | CannotContinue:
    """The error to raise for a problem that an engine has found."""
    if problem.code in OBSTACLES:
        return CannotContinue(problem)
    constraint = problem.tell(CONSTRAINTS[problem.code][0])
    value = problem.value if isnan(problem.before) else (problem.before, problem.value)
    return ParameterError(problem.name, constraint, value, problem)

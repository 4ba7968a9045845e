"""What goes wrong in a way that a user can do something about: what travels with the core."""


class BorepropError(Exception):
    """The base of the errors of this package. The message is one line."""

    exit_status = 2  # of a command that ends with it


class ParameterError(BorepropError, ValueError):
    """A parameter breaks a constraint. Carries ``name``, ``constraint`` and ``value``."""

    def __init__(self, name: str, constraint: str, value: object) -> None:
        super().__init__(f"{name}: {constraint}, got {value!r}")
        self.name, self.constraint, self.value = name, constraint, value


class TableError(BorepropError, ValueError):
    """A table file cannot be read. The message names the file, the line, the constraint and the value."""

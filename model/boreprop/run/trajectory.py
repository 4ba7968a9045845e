"""What a run gives: columns over the drilled length."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..case.case import Case
from ..core.quantities import BY_NAME
from ..errors import BorepropError, InputError


class NoSuchColumn(InputError, KeyError):
    """A run has no column of that name."""

    __str__ = Exception.__str__  # that of a KeyError puts quotes around the message


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(Mapping[str, Floats]):
    """A run: a mapping from scalar names of the table of quantities to columns, one value for each row.

    ``run["bit_inclination"]``, ``run["stabilizer_force[1]"]``; its length is its number of columns.

    Parameters
    ----------
    columns
        Name → values in SI units, shape (rows,).
    case
        The case that was drilled, if it is known.
    stopped
        Why it ended before its end, if it did.
    engine
        What drilled it, "native" or "python", if that is known.
    """

    columns: dict[str, Floats]
    case: Case | None = None
    stopped: str | None = None
    engine: str | None = None

    def __getitem__(self, name: str) -> Floats:
        """The column `name`; `InputError`, which is also a `KeyError`, if the run has none."""
        if name not in self.columns:
            raise NoSuchColumn(f"the run must have a column {name!r}, got {', '.join(self.columns)}")
        return self.columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    def __eq__(self, other: object) -> bool:
        """Whether columns, case and why it stopped are the same."""
        return (
            isinstance(other, Trajectory)
            and (self.case, self.stopped, list(self)) == (other.case, other.stopped, list(other))
            and all(np.array_equal(column, other[name]) for name, column in self.items())
        )

    __hash__ = None  # type: ignore[assignment]  # columns may change

    def __repr__(self) -> str:
        length = f" over {self['drilled_length'][-1]:g} m" if self.rows else ""
        told = [f"{self.rows} rows{length}", f"{len(self)} columns", "with its case" if self.case else "without a case"]
        told += [f"{self.engine} engine"] * (self.engine is not None) + ["stopped"] * (self.stopped is not None)
        return f"<Trajectory: {', '.join(told)}>"

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self["drilled_length"])

    @property
    def n(self) -> int:
        """Number of stabilizers: the case's, or as many as there are average inclinations."""
        if self.case is not None:
            return len(self.case.bha.stabilizer_positions)
        return sum(plain_name(name) == "average_inclination" for name in self)

    def stack(self, name: str) -> Floats:
        """The columns ``name[1]``, ``name[2]``, … side by side, shape (rows, n) or (rows, n − 1)."""
        columns = [self[scalar] for scalar in BY_NAME[name].names(self.n)]
        return np.column_stack(columns) if columns else np.empty((self.rows, 0))


class Stopped(BorepropError):
    """A run could not go on to its end. The message says where it stopped and what helps.

    Parameters
    ----------
    message
        One line.
    trajectory
        The rows so far, where they are kept; its `stopped` is the message.
    """

    exit_status = 3

    def __init__(self, message: str, trajectory: Trajectory | None = None) -> None:
        super().__init__(message)
        self.trajectory = trajectory


def plain_name(scalar_name: str) -> str:
    """The name of a quantity, without the number of its component."""
    return scalar_name.partition("[")[0]

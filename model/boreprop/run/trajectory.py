"""What a run gives: columns over the drilled length."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..case.case import Case
from ..core.quantities import BY_NAME
from ..errors import BorepropError, MissingColumn


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(Mapping[str, Floats]):
    """A run: a mapping from the names of its columns to their values, all over the same rows.

    Parameters
    ----------
    columns
        Scalar name of the table of quantities ("drilled_length", "stabilizer_force[1]", …) → values in SI units,
        shape (rows,).
    case
        The case that was run, if it is known.
    stopped
        Why it ended before its end, if it did.
    engine
        What computed it, "native" or "python", if that is known.
    """

    columns: dict[str, Floats]
    case: Case | None = None
    stopped: str | None = None
    engine: str | None = None

    def __getitem__(self, name: str) -> Floats:
        """The column `name`; `MissingColumn` if the run has none."""
        if name not in self.columns:
            raise MissingColumn(f"the run must have a column {name!r}, got {', '.join(self.columns)}")
        return self.columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    def __repr__(self) -> str:
        length = f" over {self['drilled_length'][-1]:g} m" if self.row_count else ""
        engine = f", {self.engine} engine" if self.engine else ""
        case = "" if self.case else ", case not known"
        stopped = ", stopped before its end" if self.stopped else ""
        return f"<Trajectory: {len(self)} columns, {self.row_count} rows{length}{engine}{case}{stopped}>"

    @property
    def row_count(self) -> int:
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
        return np.column_stack(columns) if columns else np.empty((self.row_count, 0))


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
    """The quantity that a column holds: bit_tilt, or of stabilizer_force[1] stabilizer_force."""
    return scalar_name.partition("[")[0]

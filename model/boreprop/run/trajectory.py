"""The trajectory of a run: columns over the drilled length."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..case.case import Case
from ..core.quantities import BY_NAME, Structure
from ..errors import BorepropError, MissingColumn


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(Mapping[str, Floats]):
    """A run: a mapping from the names of its columns to their values, all over the same rows.

    Parameters
    ----------
    columns
        Scalar name ("drilled_length", "stabilizer_force[1]", …) → values in SI units, shape (rows,). The names, units
        and meanings are those of the table of quantities.
    case
        The case that was drilled; None if a file does not say it.
    stopped
        The reason why the run ended early; None if it reached its end.
    engine
        The engine that computed the run, "native" or "python"; None if a file does not say it.

    Examples
    --------
    >>> from boreprop import paper_case, simulate
    >>> run = simulate(paper_case(), length=10.0, sample_interval=2.5)
    >>> run["drilled_length"].tolist()
    [0.0, 2.5, 5.0, 7.5, 10.0]
    >>> run.row_count, run.n, "bit_tilt" in run, run.stack("average_inclination").shape
    (5, 2, True, (5, 2))
    """

    columns: dict[str, Floats]
    case: Case | None = None
    stopped: str | None = None
    engine: str | None = None

    def __getitem__(self, name: str) -> Floats:
        """The values of the column `name`, shape (rows,); `MissingColumn` if the run does not have it."""
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
        case = "" if self.case else ", without its case"
        stopped = ", stopped before its end" if self.stopped else ""
        return f"<Trajectory: {len(self)} columns, {self.row_count} rows{length}{engine}{case}{stopped}>"

    @property
    def row_count(self) -> int:
        """The number of rows."""
        return len(self["drilled_length"])

    @property
    def n(self) -> int:
        """The number of stabilizers: that of the case or, without a case, the number of average inclinations."""
        if self.case is not None:
            return len(self.case.bha.stabilizer_positions)
        return sum(plain_name(name) == "average_inclination" for name in self)

    @property
    def structure(self) -> int | Structure:
        """How the BHA of the case is made up; without a case, the number of its stabilizers."""
        return self.n if self.case is None else self.case.structure

    def stack(self, name: str) -> Floats:
        """The columns ``name[1]``, ``name[2]``, … side by side, shape (rows, n), (rows, n − 1) or (rows, sensors).

        Raises
        ------
        MissingColumn
            If the run lacks one of them.
        """
        names = BY_NAME[name].names(self.structure) if name in BY_NAME else [name]
        columns = [self[scalar] for scalar in names]
        return np.column_stack(columns) if columns else np.empty((self.row_count, 0))


class Stopped(BorepropError):
    """A run could not go on to its end. The message says where it stopped and what to do.

    Parameters
    ----------
    message
        The message, one line.
    trajectory
        The rows up to there; its `stopped` is the message. None where there are none, or they are not kept.
    """

    exit_status = 3

    def __init__(self, message: str, trajectory: Trajectory | None = None) -> None:
        super().__init__(message)
        self.trajectory = trajectory


def plain_name(scalar_name: str) -> str:
    """The name of the quantity in a column: "stabilizer_force" for "stabilizer_force[1]"."""
    return scalar_name.partition("[")[0]

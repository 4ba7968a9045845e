"""What a run gives: columns over the drilled length."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..case.case import Case
from ..core.quantities import BY_NAME
from ..errors import InputError


@dataclass(frozen=True)
class Trajectory:
    """A run, one row per sample.

    Parameters
    ----------
    columns
        Scalar name of the table of quantities ("drilled_length", "stabilizer_force[1]", …) → values in SI units,
        shape (rows,).
    case
        The case that was run, if it is known.
    stopped
        Why it ended before its end, if it did.
    """

    columns: dict[str, NDArray[np.float64]]
    case: Case | None = None
    stopped: str | None = None

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        """The column `name`; `InputError` if the run has none."""
        if name not in self.columns:
            raise InputError(f"the run must have a column {name!r}, got {', '.join(self.columns)}")
        return self.columns[name]

    def __len__(self) -> int:
        return len(self["drilled_length"])

    @property
    def n(self) -> int:
        """Number of stabilizers: the case's, or as many as there are average inclinations."""
        if self.case is not None:
            return len(self.case.bha.stabilizer_positions)
        return sum(_variable(name) == "average_inclination" for name in self.columns)

    def stack(self, name: str) -> NDArray[np.float64]:
        """The columns ``name[1]``, ``name[2]``, … side by side, shape (rows, n) or (rows, n − 1)."""
        columns = [self[scalar] for scalar in BY_NAME[name].names(self.n)]
        return np.column_stack(columns) if columns else np.empty((len(self), 0))


def _variable(scalar_name: str) -> str:
    return scalar_name.partition("[")[0]

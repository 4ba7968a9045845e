"""The engines that drill a case, behind one face: the model in Python, and the same as compiled code."""

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..case.case import Case
from ..core.drilling import Drilling
from ..core.errors import CannotContinue, ParameterError
from ..core.options import Options
from ..kernel.binding import NativeDrilling, available

AnyDrilling = Drilling | NativeDrilling

ENGINES = ("python", "native")


def engine() -> str:
    """The native engine where it is there, else Python."""
    return "native" if available() else "python"


def start(case: Case, engine: str, relative_tolerance: float) -> AnyDrilling:
    """A case before its first step, under its first force; errors as in `simulate`."""
    if engine not in ENGINES:
        raise ParameterError("engine", f"must be {' or '.join(ENGINES)}", engine)
    system, weight, force = (case.bha, case.bit, case.survey), case.active_weight_on_bit, case.schedule.rss_force[0]
    if engine == "native":
        return NativeDrilling(
            *system, active_weight_on_bit=weight, rss_force=force, relative_tolerance=relative_tolerance
        )
    return Drilling(*system, active_weight_on_bit=weight, rss_force=force, options=Options(relative_tolerance))


def follow(
    drilling: AnyDrilling, lengths: Floats, forces: Floats, weight: float, rows: NDArray[np.intc], table: Floats
) -> None:
    """Drill leg after leg, as `NativeDrilling.follow`, on either engine; `CannotContinue` at the leg that fails."""
    if isinstance(drilling, NativeDrilling):
        failure = drilling.follow(lengths, forces, weight, rows, table)
        if failure:
            raise CannotContinue(failure)
        return
    for length, force, row in zip(lengths.tolist(), forces.tolist(), rows.tolist(), strict=True):
        drilling.advance(length, force, weight)
        if row >= 0:
            table[row] = tuple(drilling.outputs().values())

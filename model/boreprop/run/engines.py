"""The engines that drill a case, behind one face: the model in Python, and the same as compiled code."""

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..case.case import Case
from ..core.drilling import Drilling
from ..core.errors import ParameterError
from ..kernel.binding import NativeDrilling, available

AnyDrilling = Drilling | NativeDrilling

ENGINES = ("auto", "native", "python")


def engine() -> str:
    """The engine that "auto" stands for here: "native" where it is built, else "python"."""
    return "native" if available() else "python"


def chosen(name: str) -> str:
    """The engine, "native" or "python", that one of `ENGINES` stands for; `ParameterError` if `name` is none."""
    if name not in ENGINES:
        raise ParameterError("engine", f"must be {', '.join(ENGINES[:-1])} or {ENGINES[-1]}", name)
    return engine() if name == "auto" else name


def start(case: Case, engine: str, relative_tolerance: float) -> AnyDrilling:
    """A case before its first step, under its first force; errors as in `simulate`."""
    make = NativeDrilling if chosen(engine) == "native" else Drilling
    return make(
        case.bha,
        case.bit,
        case.survey,
        active_weight_on_bit=case.active_weight_on_bit,
        rss_force=case.schedule.rss_force[0],
        relative_tolerance=relative_tolerance,
    )


def follow(
    drilling: AnyDrilling, lengths: Floats, forces: Floats, weight: float, rows: NDArray[np.intc], table: Floats
) -> str | None:
    """Drill leg after leg, as `NativeDrilling.follow`, on either engine."""
    if isinstance(drilling, NativeDrilling):
        return drilling.follow(lengths, forces, weight, rows, table)
    for length, force, row in zip(lengths.tolist(), forces.tolist(), rows.tolist(), strict=True):
        failure = drilling.advance(length, force, weight)
        if failure:
            return failure
        if row >= 0:
            table[row] = tuple(drilling.outputs().values())
    return None

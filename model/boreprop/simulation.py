"""A schedule in, a trajectory out."""

from collections.abc import Callable

import numpy as np

from .case import SAMPLE_INTERVAL, Case
from .core.assembly import check_number
from .core.drilling import Drilling
from .core.propagation import RELATIVE_TOLERANCE
from .core.variables import OUTPUTS, scalar_names
from .results import Trajectory

ROUNDING = 1e-9  # of a sample interval: a row this close before the end or a change of force counts as on it


class SimulationError(RuntimeError):
    """The integrator could not go on. The message says where, and what helps."""


def simulate(
    case: Case,
    *,
    sample_interval: float = SAMPLE_INTERVAL,
    length: float | None = None,
    relative_tolerance: float = RELATIVE_TOLERANCE,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Drill a case under its force schedule.

    Parameters
    ----------
    case
        What is drilled.
    sample_interval
        Drilled length between rows, m. Rows are at k times the interval, k = 0, 1, …; where the force changes on a
        row, the row holds the values after the change.
    length
        Length to drill, m; without it, the case's.
    relative_tolerance
        Local error allowed in one step of the integrator, relative to 1 rad and to ℓ₁.
    progress
        Called with the drilled length, m, about a hundred times.

    Returns
    -------
    Trajectory
        The inputs `rss_force` and `active_weight_on_bit` and every output of the table of variables.

    Raises
    ------
    ParameterError
        If a value is out of range.
    SimulationError
        If the integrator cannot go on.
    """
    length = case.length if length is None else length
    check_number("length", length, above=0.0)
    check_number("sample_interval", sample_interval, above=0.0)
    changes = list(zip(case.schedule.drilled_length, case.schedule.rss_force, strict=True))
    _, force = changes.pop(0)
    weight = case.active_weight_on_bit
    drilling = Drilling(
        case.bha,
        case.bit,
        case.survey,
        active_weight_on_bit=weight,
        rss_force=force,
        relative_tolerance=relative_tolerance,
    )

    def drill(to: float) -> None:
        failure = drilling.advance(to, force, weight)
        if failure:
            raise SimulationError(f"after {drilling.drilled_length:g} m of {length:g} m: {failure}")

    rows = int(length / sample_interval + ROUNDING) + 1
    names = ["rss_force", *scalar_names(OUTPUTS, len(case.bha.stabilizer_positions))]
    table = np.empty((rows, len(names)))
    for k in range(rows):
        at = k * sample_interval
        while changes and changes[0][0] <= at + ROUNDING * sample_interval:
            change, next_force = changes.pop(0)
            drill(change)
            force = next_force
        drill(max(at, drilling.drilled_length))
        table[k] = (force, *drilling.outputs().values())
        if progress and k % (rows // 100 + 1) == 0:
            progress(at)
    columns = {"rss_force": table[:, 0], "active_weight_on_bit": np.full(rows, weight)}
    return Trajectory(columns | {name: table[:, j] for j, name in enumerate(names[1:], 1)}, case)

"""What a study is made of: cases that differ from one in some parameters, on a grid or drawn from distributions."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import radians
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...case.case import Case, Schedule
from ...core.quantities import BY_NAME
from ...core.system import BitRock, BottomHoleAssembly
from ...errors import InputError, shown

CONVENIENT = {"eta_pi": "active_weight_on_bit", "bit_tilt_limit_deg": "bit_tilt_limit"}
"""Names that a study knows besides those of the table of variables → what they stand for."""


class Distribution(Protocol):
    """What a parameter may be drawn from: any frozen distribution of scipy.stats."""

    def ppf(self, q: Any, /) -> Any:
        """The value below which a draw lies with probability `q`."""


def parameters(case: Case) -> dict[str, float]:
    """What of `case` can be varied, by the scalar names of the table of variables, SI units.

    The force is the first one of the schedule.
    """
    bha, bit = case.bha, case.bit
    n = len(bha.stabilizer_positions)
    return {
        "rss_force": case.schedule.rss_force[0],
        "active_weight_on_bit": case.active_weight_on_bit,
        **dict(zip(BY_NAME["stabilizer_position"].names(n), bha.stabilizer_positions, strict=True)),
        **dict(zip(BY_NAME["stabilizer_clearance"].names(n), bha.stabilizer_clearances, strict=True)),
        "rss_position": bha.rss_position,
        "distributed_weight": bha.distributed_weight,
        "flexural_stiffness": bha.flexural_stiffness,
        "lateral_steering_resistance": bit.lateral_steering_resistance,
        "angular_steering_resistance": bit.angular_steering_resistance,
        "bit_tilt_limit": bit.tilt_limit,
    }


def vary(case: Case, values: Mapping[str, float]) -> Case:
    """`case` with other values of some parameters.

    Parameters
    ----------
    case
        What all else is taken from.
    values
        Names of `parameters` → values, SI units. Besides: "eta_pi", reached by the weight on bit, with the other
        values in place; "bit_tilt_limit_deg". A "rss_force" acts from the start to the end, instead of the schedule.

    Raises
    ------
    InputError
        If a name is not among these, or two names are for one parameter.
    ParameterError
        If a value is out of range.
    """
    known = parameters(case)
    check_names(known, tuple(values))
    p = {**known, **values}
    if "bit_tilt_limit_deg" in p:
        p["bit_tilt_limit"] = radians(p["bit_tilt_limit_deg"])
    n = len(case.bha.stabilizer_positions)
    bha = BottomHoleAssembly(
        tuple(p[name] for name in BY_NAME["stabilizer_position"].names(n)),
        tuple(p[name] for name in BY_NAME["stabilizer_clearance"].names(n)),
        p["rss_position"],
        p["distributed_weight"],
        p["flexural_stiffness"],
    )
    bit = BitRock(p["lateral_steering_resistance"], p["angular_steering_resistance"], p["bit_tilt_limit"])
    if "eta_pi" in p:
        p["active_weight_on_bit"] = p["eta_pi"] * bha.force_scale / bit.lateral_steering_resistance
    schedule = Schedule((0.0,), (p["rss_force"],)) if "rss_force" in values else case.schedule
    return replace(case, bha=bha, bit=bit, active_weight_on_bit=p["active_weight_on_bit"], schedule=schedule)


def check_names(known: Mapping[str, float], names: tuple[str, ...]) -> None:
    """Raise `InputError` unless each of `names` can be varied, and no two are for one parameter."""
    for name in names:
        if CONVENIENT.get(name, name) not in known:
            raise InputError(f"what is varied must be one of {', '.join([*known, *CONVENIENT])}, got {name!r}")
    meant = [CONVENIENT.get(name, name) for name in names]
    for name in meant:
        if meant.count(name) > 1:
            raise InputError(f"{name}: must be varied under one name, got {', '.join(names)}")


@dataclass(frozen=True, eq=False)
class Study:
    """Cases that differ from one in some parameters. `grid` and `sample` make the usual ones.

    Parameters
    ----------
    case
        What they have in common.
    names
        The parameters that are varied, see `vary`.
    values
        A row for each case, a column for each name, shape (cases, names).
    axes
        Of a grid, whose last axis varies fastest: name → values. None: the cases are in no order.

    Raises
    ------
    InputError
        If a name cannot be varied.
    """

    case: Case
    names: tuple[str, ...]
    values: NDArray[np.float64]
    axes: Mapping[str, NDArray[np.float64]] | None = None

    def __post_init__(self) -> None:
        check_names(parameters(self.case), self.names)

    def __len__(self) -> int:
        return len(self.values)


def grid(case: Case, axes: Mapping[str, ArrayLike]) -> Study:
    """Every combination of the values of some parameters.

    Parameters
    ----------
    case
        What the cases have in common.
    axes
        Name of a parameter, see `vary` → its values, shape (values,).

    Raises
    ------
    InputError
        If a name cannot be varied or has no values, or there is none.
    """
    if not axes:
        raise InputError("a grid must have at least one axis, got none")
    values = {name: np.asarray(axis, dtype=np.float64) for name, axis in axes.items()}
    for name, axis in values.items():
        if axis.ndim != 1 or not axis.size:
            raise InputError(f"{name}: must be a list of at least one value, got {shown(axes[name])}")
    combinations = np.stack(np.meshgrid(*values.values(), indexing="ij"), axis=-1).reshape(-1, len(values))
    return Study(case, tuple(values), combinations, values)


def sample(case: Case, uncertain: Mapping[str, Distribution], n: int, seed: int) -> Study:
    """Cases whose uncertain parameters are drawn from distributions, independently.

    The draws of a parameter follow from the seed and its name: they stay the same when others come or go, and the
    first ones of a larger sample are those of a smaller one.

    Parameters
    ----------
    case
        What the cases have in common.
    uncertain
        Name of a parameter, see `vary` → its distribution, say ``scipy.stats.norm(60e3, 6e3)``.
    n
        Number of cases.
    seed
        ≥ 0.

    Raises
    ------
    InputError
        If a name cannot be varied, a distribution draws what is no finite number, or n or the seed are out of range.
    """
    for name, number, least in (("n", n, 1), ("seed", seed, 0)):
        if number < least:
            raise InputError(f"{name}: must be >= {least}, got {number}")
    values = np.empty((n, len(uncertain)))
    for column, (name, distribution) in zip(values.T, uncertain.items(), strict=True):
        column[:] = distribution.ppf(np.random.default_rng([seed, *name.encode()]).random(n))
        if not np.isfinite(column).all():
            raise InputError(f"{name}: must be drawn from a distribution of finite numbers, got {column[0]}")
    return Study(case, tuple(uncertain), values)

"""What a study is made of: cases that differ from one in some parameters, on a grid or drawn from distributions."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import radians
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...case.case import Case
from ...case.parameters import parameters, with_parameters
from ...core.quantities import BY_NAME, quantity_of
from ...errors import InputError, shown


class Distribution(Protocol):
    """What a parameter may be drawn from: any frozen distribution of scipy.stats."""

    def ppf(self, q: Any, /) -> Any:
        """The value below which a draw lies with probability `q`."""


def vary(case: Case, values: Mapping[str, float]) -> Case:
    """`case` with other values of some parameters.

    Parameters
    ----------
    case
        What all else is taken from.
    values
        Names of `parameters` → values, SI units. Besides: "eta_pi", reached by the weight on bit, with the other
        values in place; an angle in degrees, "bit_tilt_limit_deg". A "rss_force" acts from the start to the end,
        instead of the schedule.

    Raises
    ------
    InputError
        If a name is not among these, or two names are for one parameter.
    ParameterError
        If a value is out of range.
    """
    check_names(case, tuple(values))
    wanted = {
        parameter_of(name): radians(value) if name.endswith("_deg") else value
        for name, value in values.items()
        if name != "eta_pi"
    }
    varied = with_parameters(case, wanted)
    if "eta_pi" not in values:
        return varied
    weight = values["eta_pi"] * varied.bha.force_scale / varied.bit.lateral_steering_resistance
    return with_parameters(varied, {"active_weight_on_bit": weight})


def parameter_of(name: str) -> str:
    """The parameter that is varied under a name: of "eta_pi" the weight, of an angle in degrees the angle."""
    if name == "eta_pi":
        return "active_weight_on_bit"
    angle = BY_NAME.get(name.removesuffix("_deg"))
    return angle.name if angle and angle.unit == "rad" else name


def check_names(case: Case, names: tuple[str, ...]) -> None:
    """Raise `InputError` unless each of `names` can be varied, and no two are for one parameter."""
    known = parameters(case)
    besides = ["eta_pi", *(f"{name}_deg" for name in known if quantity_of(name).unit == "rad")]
    meant = [parameter_of(name) for name in names]
    for name, parameter in zip(names, meant, strict=True):
        if parameter not in known:
            raise InputError(f"what is varied must be one of {', '.join([*known, *besides])}, got {name!r}")
        if meant.count(parameter) > 1:
            raise InputError(f"{parameter}: must be varied under one name, got {', '.join(names)}")


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
        check_names(self.case, self.names)

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

"""The cases of a study: they differ in some parameters, which lie on a grid or are drawn from distributions."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import radians
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...case.case import Case
from ...case.parameters import diameters, parameters, with_parameters
from ...core.checks import checked_float, some_numbers
from ...core.quantities import BY_NAME, quantity_of
from ...errors import InputError, shown


class Distribution(Protocol):
    """A distribution from which a parameter may be drawn: any frozen distribution of scipy.stats."""

    def ppf(self, q: Any, /) -> Any:
        """The quantile `q`: a draw is below it with probability `q`."""


def vary(case: Case, values: Mapping[str, float]) -> Case:
    """Make a case that differs from another in some parameters.

    Parameters
    ----------
    case
        The case to start from.
    values
        Name → value in SI units. The names are those of the inputs and parameters in the table of quantities, such as
        "active_weight_on_bit" or "stabilizer_clearance[1]". "eta_pi" stands for the active weight on bit that gives
        this ηΠ with the other values in place. An angle may be given in degrees: "bit_tilt_limit_deg". An "rss_force"
        replaces the schedule by a constant force.

    Returns
    -------
    Case
        The new case.

    Raises
    ------
    InputError
        If a name is not among these, or two names stand for the same parameter.
    ParameterError
        If a value is out of range.

    Examples
    --------
    >>> from boreprop import paper_case, vary
    >>> case = vary(paper_case(), {"eta_pi": 0.02, "stabilizer_clearance[1]": 2e-3, "bit_tilt_limit_deg": 1.0})
    >>> round(case.active_weight_on_bit, 1), case.bha.stabilizer_clearances
    (3224.9, (0.002,))
    """
    check_names(case, tuple(values))
    return with_varied(case, values)


def with_varied(case: Case, values: Mapping[str, float]) -> Case:
    """`vary` a case by names that `check_names` has accepted."""
    values = {name: checked_float(name, value) for name, value in values.items()}
    wanted = {
        parameter_of(name): radians(value) if name.endswith("_deg") else value
        for name, value in values.items()
        if name != "eta_pi"
    }
    if wanted:
        case = with_parameters(case, wanted)
    if "eta_pi" not in values:
        return case
    weight = values["eta_pi"] * case.bha.force_scale / case.bit.lateral_steering_resistance
    return with_parameters(case, {"active_weight_on_bit": weight})


def parameter_of(name: str) -> str:
    """The parameter for which a name stands: active weight on bit for "eta_pi", the angle for an angle in degrees."""
    if name == "eta_pi":
        return "active_weight_on_bit"
    angle = name.removesuffix("_deg")
    quantity = BY_NAME.get(angle.partition("[")[0])
    return angle if quantity and quantity.unit == "rad" else name


def check_names(case: Case, names: tuple[str, ...]) -> None:
    """Raise `InputError` unless each of `names` can be varied, and no two stand for the same parameter."""
    own = parameters(case) | diameters(case)
    besides = ["eta_pi", *(f"{name}_deg" for name in own if quantity_of(name).unit == "rad")]
    meant = [parameter_of(name) for name in names]
    for name, parameter in zip(names, meant, strict=True):
        if parameter not in own:
            raise InputError(f"a varied parameter must be one of {', '.join([*own, *besides])}, got {name!r}")
        if meant.count(parameter) > 1:
            raise InputError(f"{parameter}: must be varied under one name, got {', '.join(names)}")


@dataclass(frozen=True, eq=False)
class Study:
    """Cases that differ in some parameters. `grid` and `sample` make the usual ones.

    Parameters
    ----------
    case
        The case from which all differ.
    names
        The names of the parameters that are varied, see `vary`.
    values
        Their values in each case, SI units, shape (cases, names).
    axes
        Name → values along the axes of a grid, whose last axis varies fastest. None: the cases do not form a grid.

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
    """Make the cases of a grid: every combination of the values of some parameters.

    Parameters
    ----------
    case
        The case from which all differ.
    axes
        Name of a parameter, see `vary` → its values in SI units, shape (values,).

    Returns
    -------
    Study
        The cases; the last axis varies fastest.

    Raises
    ------
    InputError, ParameterError
        If there is no axis, a name cannot be varied, or an axis has no values.

    Examples
    --------
    >>> from boreprop import grid, paper_case
    >>> cases = grid(paper_case(), {"eta_pi": [0.01, 0.1], "rss_force": [0.0, 5e3]})
    >>> len(cases), cases.values.tolist()
    (4, [[0.01, 0.0], [0.01, 5000.0], [0.1, 0.0], [0.1, 5000.0]])
    """
    if not axes:
        raise InputError("axes: a grid must have at least one axis, got none")
    values = {name: np.array(some_numbers(name, axis), dtype=float) for name, axis in axes.items()}
    combinations = np.stack(np.meshgrid(*values.values(), indexing="ij"), axis=-1).reshape(-1, len(values))
    return Study(case, tuple(values), combinations, values)


def sample(case: Case, uncertain: Mapping[str, Distribution], n: int, seed: int) -> Study:
    """Make the cases of a sample: their uncertain parameters are drawn from distributions, independently.

    The draws of a parameter depend on the seed and on its name only: they do not change when another parameter is added
    or removed, and a larger sample begins with the draws of a smaller one.

    Parameters
    ----------
    case
        The case from which all differ.
    uncertain
        Name of a parameter, see `vary` → its distribution in SI units, for example ``scipy.stats.norm(60e3, 6e3)``.
    n
        Number of cases, at least 1.
    seed
        Seed of the draws, a whole number >= 0.

    Returns
    -------
    Study
        The cases.

    Raises
    ------
    InputError
        If a name cannot be varied, a distribution is none or draws what is not a finite number, or n or the seed is out
        of range.

    Examples
    --------
    >>> from scipy.stats import norm
    >>> from boreprop import paper_case, sample
    >>> cases = sample(paper_case(), {"active_weight_on_bit": norm(60e3, 6e3)}, n=3, seed=1)
    >>> cases.values.round().ravel().tolist()
    [53538.0, 50886.0, 58882.0]
    """
    for name, number, least in (("n", n, 1), ("seed", seed, 0)):
        if number < least:
            raise InputError(f"{name}: must be >= {least}, got {number}")
    values = np.empty((n, len(uncertain)))
    for column, (name, distribution) in zip(values.T, uncertain.items(), strict=True):
        if not hasattr(distribution, "ppf"):
            raise InputError(f"{name}: must be a frozen distribution of scipy.stats, got {shown(distribution)}")
        column[:] = distribution.ppf(np.random.default_rng([seed, *name.encode()]).random(n))
        if not np.isfinite(column).all():
            raise InputError(f"{name}: must be drawn from a distribution of finite numbers, got {column[0]}")
    return Study(case, tuple(uncertain), values)

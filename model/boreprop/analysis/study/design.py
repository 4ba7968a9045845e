"""What a study is made of: cases that differ from one in some parameters, on a grid or drawn from distributions."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from math import inf, nan, radians
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...case.case import Case
from ...case.parameters import parameters, with_parameters
from ...core.quantities import BY_NAME, quantity_of
from ...errors import InputError, shown

T = TypeVar("T")

MOST_VALUES = 5000  # on an axis of a picture


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


# as text, for the command line


def parse_each(parse: Callable[[str], tuple[str, T]], texts: Iterable[str]) -> dict[str, T]:
    """What `parse_axis` or `parse_distribution` makes of each text, by name; `InputError` if a name comes twice."""
    found: dict[str, T] = {}
    for text in texts:
        name, value = parse(text)
        if name in found:
            raise InputError(f"{name}: must be varied once, got {text!r} besides")
        found[name] = value
    return found


def parse_range(option: str, text: str) -> NDArray[np.float64]:
    """The values that START:STOP:COUNT stands for; `InputError` names the `option`."""
    try:
        start, stop, count = text.split(":")
        low, high, number = float(start), float(stop), int(count)
    except ValueError:
        low, high, number = nan, nan, 0
    if not (0 < low < high < inf and 2 <= number <= MOST_VALUES):
        constraint = f"START:STOP:COUNT with 0 < START < STOP and COUNT from 2 to {MOST_VALUES}"
        raise InputError(f"{option}: must be {constraint}, got {text!r}")
    return np.linspace(low, high, number)


def parse_axis(text: str) -> tuple[str, NDArray[np.float64]]:
    """Name and values of "NAME=START:STOP:COUNT", evenly spaced, or "NAME=VALUE,VALUE,…"; `InputError` if neither."""
    name, _, values = text.partition("=")
    try:
        if ":" not in values:
            return name, np.array([float(value) for value in values.split(",")])
        start, stop, count = values.split(":")
        return name, np.linspace(float(start), float(stop), int(count))
    except ValueError as error:
        raise InputError(f"--vary: must be NAME=START:STOP:COUNT or NAME=VALUE,VALUE,…, got {text!r}") from error


def _normal(mean: float, deviation: float) -> Distribution:
    from scipy.stats import norm

    return norm(mean, deviation)


def _lognormal(median: float, deviation_of_log: float) -> Distribution:
    from scipy.stats import lognorm

    return lognorm(deviation_of_log, scale=median)


def _uniform(low: float, high: float) -> Distribution:
    from scipy.stats import uniform

    return uniform(low, high - low)


def _triangular(low: float, mode: float, high: float) -> Distribution:
    from scipy.stats import triang

    return triang((mode - low) / (high - low), low, high - low)


DISTRIBUTIONS: dict[str, Callable[..., Distribution]] = {
    "normal": _normal,
    "lognormal": _lognormal,
    "uniform": _uniform,
    "triangular": _triangular,
}


def parse_distribution(text: str) -> tuple[str, Distribution]:
    """Name and distribution of "NAME=normal(MEAN,DEVIATION)" or another of `DISTRIBUTIONS`; `InputError` if neither."""
    name, _, call = text.partition("=")
    kind, _, arguments = call.strip().partition("(")
    try:
        if kind not in DISTRIBUTIONS or not arguments.endswith(")"):
            raise ValueError
        distribution = DISTRIBUTIONS[kind](*map(float, arguments[:-1].split(",")))
        if not np.isfinite(distribution.ppf(0.5)):
            raise ValueError
    except (ArithmeticError, TypeError, ValueError) as error:
        forms = "normal(MEAN,DEVIATION), lognormal(MEDIAN,DEVIATION OF THE LOG), uniform(LOW,HIGH) or "
        raise InputError(f"--uncertain: must be NAME={forms}triangular(LOW,MODE,HIGH), got {text!r}") from error
    return name, distribution

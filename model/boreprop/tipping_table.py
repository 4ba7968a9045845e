"""Tipping in words."""

from collections.abc import Mapping, Sequence
from math import degrees, inf

from .analysis.rippling import Rippling
from .analysis.tipping import CriticalDogleg
from .case import Case
from .summary import BUILD_LENGTH


def rows(case: Case, found: Mapping[int, CriticalDogleg], limit: float) -> list[tuple[str, str]]:
    """The lines of a table; `found` by side, `limit` the largest turn that was tried, rad."""
    sides = {1: "up", -1: "down"}
    return [
        (f"dogleg that makes it ripple, turning {sides[side]}", _amount(one, case.bha.length_scale, limit))
        for side, one in found.items()
    ]


def _amount(found: CriticalDogleg, length_scale: float, limit: float) -> str:
    if found.angle == inf:
        return f"none up to {degrees(limit):.3g}°"
    if found.angle == 0.0:
        return "any: it ripples from a straight hole"
    severity = f"{degrees(found.curvature) * BUILD_LENGTH:.1f} °/{BUILD_LENGTH:g} m"
    exception = "" if found.monotonic else ", but not every larger one"
    return f"{degrees(found.angle):.2f}° over {length_scale:g} m ({severity}){exception}"


def loop(x: Sequence[float], label: str, up: Sequence[Rippling], down: Sequence[Rippling]) -> str:
    """Up to where there is a ripple on the way up, and from where on the way down."""
    lasts, backs = ([value for value, wave in zip(x, branch, strict=True) if wave.ripples] for branch in (up, down))
    if not lasts:
        return f"it ripples nowhere up to {label} = {x[-1]:.4g}"
    back = f"comes back at {backs[-1]:.4g}" if backs else "does not come back"
    return f"on the way up it ripples to {label} = {lasts[-1]:.4g}; on the way down it {back}"

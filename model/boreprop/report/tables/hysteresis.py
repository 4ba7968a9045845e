"""A hysteresis loop in words: where a ripple dies out and where it comes back."""

from collections.abc import Callable
from math import degrees

from ...analysis.hysteresis import Bracket, Hysteresis
from ...analysis.rippling import Rippling
from ...case.case import Case
from ...units import UNITS, small_length


def loop(case: Case, found: Hysteresis) -> str:
    """A sentence: where the ripple dies out on the way up, and where it comes back on the way down."""
    amount = amounts(case, found.name)
    if not any(ripples(wave) for wave in found.up):
        return f"it ripples nowhere from {amount(found.values[0])} to {amount(found.values[-1])}"
    lasts = [value for value, wave in zip(found.values, found.up, strict=True) if ripples(wave)]
    dies = f"dies out {_between(found.dies, amount)}" if found.dies else f"lasts to {amount(lasts[-1])}"
    over = UNITS["m"].text(case.bha.half_length, ".4g")
    dogleg = f"a dogleg of {degrees(found.dogleg):.3g}° over {over} in a straight hole"
    if found.returns:
        back = f"{dogleg} brings it back {_between(found.returns, amount)}"
    elif ripples(found.down[-1]):
        back = f"{dogleg} brings it back at once, at {amount(found.values[-1])}"
    else:
        back = f"{dogleg} does not bring it back"
    stopped = sum(wave is None for wave in (*found.up, *found.down))
    left_out = f"; {stopped} of {2 * len(found.values)} values left out, where a run stopped" if stopped else ""
    return f"on the way up the ripple {dies}; on the way down {back}{left_out}"


def ripples(wave: Rippling | None) -> bool:
    """Whether a run ripples; a run that could not go on does not."""
    return wave is not None and wave.ripples


def amounts(case: Case, name: str) -> Callable[[float], str]:
    """A function that gives the text of a value of a parameter, in the units people use."""
    if name == "eta_pi":
        per_unit = case.bha.force_scale / case.bit.lateral_steering_resistance
        return lambda value: f"ηΠ = {value:.4g} ({UNITS['N'].text(value * per_unit, '.4g')})"
    if name == "active_weight_on_bit":
        return lambda value: UNITS["N"].text(value, ".4g")
    return lambda value: small_length().text(value, ".4g")


def _between(bracket: Bracket, amount: Callable[[float], str]) -> str:
    return f"between {amount(bracket[0])} and {amount(bracket[1])}"

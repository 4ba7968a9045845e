"""What a study computes of each case: the key figures of its run, unless it is given another function."""

from collections.abc import Callable, Mapping
from math import nan

from ...case.case import Case
from ...core.options import RELATIVE_TOLERANCE
from ...core.quantities import BY_NAME
from ...errors import CannotContinue, RootsNotFound, SpiralNotFound
from ...run.simulate import simulate
from ...run.trajectory import Stopped
from ...units import BUILD_LENGTH
from ..rippling import last_wave
from ..search import State
from ..summary import sum_up
from .design import with_varied

Function = Callable[[Case], Mapping[str, float]]
"""A function that a study can compute of each case: it returns numbers by name."""

ANGLE, CURVATURE, FORCE, LENGTH = (
    BY_NAME[name].unit for name in ("borehole_inclination", "borehole_curvature", "stabilizer_force", "drilled_length")
)

FIGURES = {  # name → unit and meaning
    "end_inclination": (ANGLE, "inclination at the end"),
    "end_azimuth": (ANGLE, "azimuth at the end"),
    "build_rate": (CURVATURE, "build rate, mean"),
    "largest_build_rate": (CURVATURE, f"build rate, largest over {BUILD_LENGTH:g} m"),
    "dogleg_severity": (CURVATURE, "dogleg severity, mean"),
    "largest_dogleg_severity": (CURVATURE, f"dogleg severity, largest over {BUILD_LENGTH:g} m"),
    "largest_contact_force": (FORCE, "largest contact force"),
    "contact_share": ("", "share in contact"),
    "saturation_share": ("", "share with saturated bit tilt"),
    "ripples": ("", "1 if it ends rippling, else 0"),
    "wavelength": (LENGTH, "ripple: wavelength"),
    "amplitude": (ANGLE, "ripple: amplitude of the inclination"),
    "growth": (f"1/{LENGTH}", "ripple: change of the logarithm of the amplitude"),
    "state": ("", "ripple: " + ", ".join(f"{number} {state}" for number, state in enumerate(State))),
}

IN_SPACE = ("end_azimuth", "dogleg_severity", "largest_dogleg_severity")
"""Figures of runs in space only."""


def key_figures(case: Case, relative_tolerance: float = RELATIVE_TOLERANCE) -> dict[str, float]:
    """Simulate a case and give its key figures: the fields of a `Summary`, in SI units, each a number with a name.

    The simulation has a row every 0.1 m. Fields of a `Rippling` that are not reported are not computed, so that a study
    spends its time on the model.

    Examples
    --------
    >>> from boreprop import paper_case
    >>> figures = key_figures(paper_case())
    >>> figures["ripples"], round(figures["wavelength"], 2)
    (True, 5.07)
    """
    run = simulate(case, relative_tolerance=relative_tolerance)
    summary = sum_up(run, last_wave(run))
    wave = summary.rippling
    in_space = {name: getattr(summary, name) for name in IN_SPACE} if case.in_space else {}
    stabilizers = list(enumerate(zip(summary.largest_contact_force, summary.contact_share, strict=True), 1))
    return {
        "end_inclination": summary.end_inclination,
        **in_space,
        "build_rate": summary.build_rate,
        "largest_build_rate": summary.largest_build_rate,
        **{f"largest_contact_force[{i}]": force for i, (force, _) in stabilizers},
        **{f"contact_share[{i}]": share for i, (_, share) in stabilizers},
        "saturation_share": summary.saturation_share,
        "ripples": wave.ripples,
        "wavelength": wave.wavelength if wave.ripples else nan,
        "amplitude": wave.amplitude if wave.ripples else nan,
        "growth": wave.growth,
        "state": list(State).index(wave.state),
    }


def outcome(
    function: Function, case: Case, names: tuple[str, ...], values: tuple[float, ...]
) -> dict[str, float] | str:
    """Called in the worker: the results of one case, or the reason why there are none.

    Errors that no choice of numbers can cause are bugs, and are raised.
    """
    try:
        results = function(with_varied(case, dict(zip(names, values, strict=True))))
        return {name: float(result) for name, result in results.items()}
    except (ArithmeticError, RuntimeError, ValueError, Stopped, CannotContinue, RootsNotFound, SpiralNotFound) as error:
        return str(error) or type(error).__name__

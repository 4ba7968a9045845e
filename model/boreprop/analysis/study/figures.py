"""A simulation in a dozen numbers: what a study tells of each case unless told otherwise."""

from collections.abc import Callable, Mapping
from math import nan

from ...case.case import Case
from ...core.options import RELATIVE_TOLERANCE
from ...run.engines import engine
from ...run.simulate import simulate
from ..rippling import State, last_wave
from ..summary import sum_up

Function = Callable[[Case], Mapping[str, float]]
"""What a study computes of a case: numbers by name."""


def key_figures(case: Case, relative_tolerance: float = RELATIVE_TOLERANCE) -> dict[str, float]:
    """A simulation in a dozen numbers, SI units: what a `boreprop.analysis.summary.Summary` says, one name for each.

    Only what is reported is computed: a study spends its time on the model.

    Examples
    --------
    >>> from boreprop import paper_case
    >>> figures = key_figures(paper_case())
    >>> figures["ripples"], round(figures["wavelength"], 2)
    (True, 5.07)
    """
    run = simulate(case, relative_tolerance=relative_tolerance, engine=engine())
    summary = sum_up(run, last_wave(run))
    wave = summary.rippling
    stabilizers = list(enumerate(zip(summary.largest_contact_force, summary.contact_share, strict=True), 1))
    return {
        "end_inclination": summary.end_inclination,
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


FIGURES = {  # unit and meaning
    "end_inclination": ("rad", "inclination at the end"),
    "build_rate": ("rad/m", "build rate, mean"),
    "largest_build_rate": ("rad/m", "build rate, largest over 30 m"),
    "largest_contact_force": ("N", "largest contact force"),
    "contact_share": ("", "share in contact"),
    "saturation_share": ("", "share with saturated bit tilt"),
    "ripples": ("", "1 if it ends rippling, else 0"),
    "wavelength": ("m", "ripple: wavelength"),
    "amplitude": ("rad", "ripple: amplitude of the inclination"),
    "growth": ("1/m", "ripple: change of the logarithm of the amplitude"),
    "state": ("", "ripple: " + ", ".join(f"{number} {state}" for number, state in enumerate(State))),
}

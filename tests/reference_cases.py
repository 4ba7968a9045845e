"""The reference trajectories in tests/reference, and the model set up for them.

They are dimensionless and come from an independent fourth-order method of steps on a fixed grid of step 1e-5;
cases.json gives the parameters and the largest difference to a run with half the step, which bounds their error.
"""

import json
from itertools import accumulate
from pathlib import Path
from typing import Any

import numpy as np

from boreprop.core.integrator import Integrator
from boreprop.core.modes import bit_tilt
from boreprop.core.options import RELATIVE_TOLERANCE
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled
from systems import begin

FOLDER = Path(__file__).parent / "reference"
CASES: dict[str, dict[str, Any]] = json.loads((FOLDER / "cases.json").read_text(encoding="utf-8"))


def reference(name: str) -> np.ndarray:
    """The rows of a reference trajectory, with the columns xi, theta, Theta, psi, Y, F_0, F_1, …"""
    return np.genfromtxt(FOLDER / f"{name}.csv", delimiter=",", names=True)


def reference_system(name: str) -> tuple[Scaled, Survey]:
    """The drilling system and the existing hole of a reference case, in units of ℓ₁."""
    p = CASES[name]
    scaled = Scaled(tuple(accumulate(p["lambda"])), tuple(p["y_star"]), p["delta"], p["w"], p["epsilon"], p["psi_star"])
    return scaled, Survey(tuple(xi - p["survey_xi"][0] for xi in p["survey_xi"]), tuple(p["survey_inc"]))


def start(name: str, relative_tolerance: float = RELATIVE_TOLERANCE, **options: Any) -> Integrator:
    """The model at the start of a reference case."""
    p = CASES[name]
    scaled, survey = reference_system(name)
    return begin(scaled, survey, p["force_values"][0], p["eta_pi"], relative_tolerance, **options)


def at_the_bit(model: Integrator) -> dict[str, float]:
    """What a reference trajectory has columns for, where the bit is."""
    theta, Y = model.state()
    loads = model.loads()
    mode = model.settled(loads)
    F_0 = mode.F_0(loads)
    psi = bit_tilt(F_0, model.eta_pi, model.scaled.psi_star)
    forces = {f"F_{i}": row(loads) for i, row in enumerate(mode.F, 1)}
    return {"theta": theta, "Theta": theta - psi, "psi": psi, "Y": Y, "F_0": F_0, **forces}

"""The one table of everything that goes into or comes out of the model.

Result files, the FMU's description and the viewer's labels all read it. `n` is the number of stabilizers, counted from
the bit up; a variable of size "n" or "n-1" has one element per (non-ideal) stabilizer, named ``name[1]``, ``name[2]``, …
"""

from dataclasses import dataclass
from math import inf, pi
from typing import Literal

Role = Literal["input", "output", "parameter"]
Kind = Literal["Real", "Integer", "String"]
Size = Literal["1", "n", "n-1"]


@dataclass(frozen=True)
class Variable:
    """One quantity at the edge of the model, in SI units."""

    name: str
    role: Role
    unit: str
    symbol: str
    equation: str
    meaning: str
    kind: Kind = "Real"
    size: Size = "1"
    min: float = -inf
    max: float = inf
    nominal: float = 1.0  # the size it usually has
    start: float | None = None  # None: taken from the case

    def names(self, n: int) -> list[str]:
        """The scalar names of this variable for `n` stabilizers."""
        if self.size == "1":
            return [self.name]
        return [f"{self.name}[{i}]" for i in range(1, (n if self.size == "n" else n - 1) + 1)]


VARIABLES: tuple[Variable, ...] = (
    Variable("rss_force", "input", "N", "F_RSS", "(21)", "force of the steering pads on the BHA, positive builds", nominal=1e4, start=0.0),
    Variable("active_weight_on_bit", "input", "N", "Π F*", "(3)", "weight on bit that goes into drilling", min=0.0, nominal=1e4),
    Variable("rate_of_penetration", "input", "m/s", "", "", "drilled length per time", min=0.0, start=1.0),
    Variable("drilled_length", "output", "m", "ξ ℓ₁", "(17)", "length drilled since the start of the run", min=0.0, nominal=100.0),
    Variable("bit_inclination", "output", "rad", "θ", "(17)", "inclination of the bit axis from the downward vertical"),
    Variable("borehole_inclination", "output", "rad", "Θ", "(16)", "inclination of the borehole at the bit"),
    Variable("bit_tilt", "output", "rad", "ψ", "(10)", "bit inclination minus borehole inclination", nominal=0.01),
    Variable("average_inclination", "output", "rad", "⟨Θ⟩_i", "(6)", "borehole inclination averaged between stabilizers i−1 and i", size="n"),
    Variable("stabilizer_deflection", "output", "m", "δ_i", "(5)", "offset of the BHA from the borehole axis, positive to the high side", size="n-1", nominal=1e-3),
    Variable("stabilizer_force", "output", "N", "F_ℓi − F_ui", "(7)", "force of the wall on the stabilizer, positive from the lower wall", size="n-1", nominal=1e4),
    Variable("stabilizer_contact", "output", "", "", "(7)", "1 on the lower wall, −1 on the upper wall, 0 free", kind="Integer", size="n-1", min=-1, max=1),
    Variable("bit_tilt_saturation", "output", "", "", "(11)", "1 at +ψ*, −1 at −ψ*, 0 between", kind="Integer", min=-1, max=1),
    Variable("bit_lateral_force", "output", "N", "F_0", "(14)", "lateral force on the bit", nominal=1e4),
    Variable("bit_moment", "output", "N.m", "M_0", "(9)", "moment on the bit", nominal=1e4),
    Variable("borehole_curvature", "output", "rad/m", "Θ'", "", "change of borehole inclination over the last ℓ₁, per length", nominal=1e-3),
    Variable("displacement", "output", "m", "x", "", "horizontal position of the bit from the start of the run", nominal=100.0),
    Variable("true_vertical_depth", "output", "m", "z", "", "depth of the bit below the start of the run", nominal=100.0),
    Variable("eta_pi", "output", "", "ηΠ", "(9)", "lateral penetration stiffness of the rock over the BHA's bending stiffness", nominal=0.01),
    Variable("stabilizer_position", "parameter", "m", "s_i", "", "distance of the stabilizer from the bit; the last one is ideal", size="n", min=0.0, nominal=10.0),
    Variable("stabilizer_clearance", "parameter", "m", "y*_i", "(7)", "clearance between stabilizer and wall on each side", size="n-1", min=0.0, nominal=1e-3),
    Variable("rss_position", "parameter", "m", "Δ", "", "distance of the steering pads from the bit", min=0.0),
    Variable("distributed_weight", "parameter", "N/m", "w", "", "buoyant weight of the BHA per length", min=0.0, nominal=1e3),
    Variable("flexural_stiffness", "parameter", "N.m2", "EI", "", "bending stiffness of the BHA", min=0.0, nominal=1e7),
    Variable("lateral_steering_resistance", "parameter", "", "η", "(4)", "lateral over axial drilling resistance", min=0.0, nominal=10.0),
    Variable("angular_steering_resistance", "parameter", "", "χ", "(4)", "angular over axial drilling resistance", min=0.0),
    Variable("bit_tilt_limit", "parameter", "rad", "ψ*", "(10)", "tilt at which the bit gauge meets the wall", min=0.0, max=pi / 2, nominal=0.01),
    Variable("relative_tolerance", "parameter", "", "", "", "local error of one step of the integrator, over 1 rad and ℓ₁", min=1e-12, max=1e-2, nominal=1e-7),
    Variable("survey_file", "parameter", "", "", "", "survey of the existing hole (CSV); empty: the survey packed in the FMU", kind="String"),
)  # fmt: skip

BY_NAME = {variable.name: variable for variable in VARIABLES}
INPUTS = tuple(variable for variable in VARIABLES if variable.role == "input")
OUTPUTS = tuple(variable for variable in VARIABLES if variable.role == "output")


def scalar_names(variables: tuple[Variable, ...], n: int) -> list[str]:
    """The scalar names of `variables` for `n` stabilizers, in the order of the table."""
    return [name for variable in variables for name in variable.names(n)]

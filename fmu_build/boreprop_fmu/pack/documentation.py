"""documentation/index.html of the borehole FMU: the equations, its variables, an example."""

from html import escape
from math import degrees

from boreprop.case.case import Case
from boreprop.core.quantities import VARIABLES, Quantity

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>Borehole</title>
<style>
body {{ font-family: sans-serif; line-height: 1.45; max-width: 62em; margin: 2em auto; padding: 0 1em; }}
table {{ border-collapse: collapse; }}
td, th {{ border-bottom: 1px solid #ccc; padding: 0.25em 0.8em 0.25em 0; text-align: left; vertical-align: top; }}
pre {{ background: #f4f1ea; padding: 0.8em; overflow-x: auto; }}
img {{ float: right; }}
</style>
</head>
<body>
<img src="../model.png" alt="A bottom-hole assembly in a curved hole">
<h1>Borehole</h1>
<p>How a rotary steerable drilling system propagates a borehole in a vertical plane: an elastic bottom-hole assembly
(BHA) lies in the hole that it drilled before, touches its walls or not, and steers the bit. Model and equation numbers
are those of the paper <cite>Delay complementarity modeling for dynamic analysis of directional drilling</cite>.</p>
<p>This FMU: {case}.</p>

<h2>Equations</h2>
<p>Lengths in ℓ₁ (bit to first stabilizer), forces in F* = 3EI/ℓ₁²; ξ is the drilled length, s<sub>i</sub> the
distance of stabilizer i from the bit, λ<sub>i</sub> that from the one before, and ε = χ/η.
A prime is a derivative with respect to ξ.</p>
<pre>
(16)  Θ = θ − ψ                                   borehole inclination, bit inclination, bit tilt
(17)  ε ηΠ θ' = M(θ, ⟨Θ⟩, F, F_RSS),  M = −M_0    angular drilling law
(10)  ψ = clip(F_0 / ηΠ, −ψ*, ψ*)                 lateral drilling law; the bit gauge saturates the tilt
(18)  λ_i ⟨Θ⟩_i' = Θ(ξ − s_(i−1)) − Θ(ξ − s_i)    average inclinations: the delays
 (7)  0 ≤ F_ℓ ⊥ y* + δ ≥ 0                        contact with the lower wall
 (8)  0 ≤ F_u ⊥ y* − δ ≥ 0                        contact with the upper wall
 (5)  δ = K⁻¹ (F_ℓ − F_u) + q̃(θ, ⟨Θ⟩, F_RSS)      deflection of the BHA at its stabilizers
</pre>
<p>The BHA is a propped cantilever, clamped to the bit and hinged at the last stabilizer; M, F_0, K⁻¹ and q̃ follow from
beam theory. The integrator steps on its own grid: results do not depend on the communication step.</p>

<h2>Variables</h2>
<p>SI units; angles in rad, inclination from the downward vertical. Stabilizers count from the bit up. Inputs act from
the start of a step{inputs}. Parameters are fixed after initialization.</p>
<table>
<tr><th>name</th><th>symbol</th><th>equation</th><th>unit</th><th>range</th><th>meaning</th></tr>
{variables}
</table>

<h2>Example</h2>
<pre>
import fmpy
import numpy as np

force = np.array([(0.0, 0.0), (10.0, 5e3), (30.0, 5e3)], dtype=[("time", float), ("rss_force", float)])
result = fmpy.simulate_fmu(
    "Borehole.fmu",
    start_values={{"rate_of_penetration": 1.0}},  # m/s: then time counts metres
    input=force,
    output=["drilled_length", "borehole_inclination"],
    stop_time=30.0,
    output_interval=0.5,
)
print(result[-1])
</pre>

<h2>Errors and states</h2>
<p>{errors}</p>

<h2>Hosts</h2>
<p>{hosts}</p>
</body>
</html>
"""

TEXTS = {
    "python": {
        "inputs": "",
        "errors": """A bad value is logged (status error, category logStatusError) with variable, constraint and value,
and the step is discarded (fmi2Discard): nothing has moved, and the next step with good values works. After a bad
parameter: fmi2Reset. After a state that is not one of this FMU's, every step is discarded until a good state is set or
the instance is reset.""",
        "hosts": """64-bit Linux and Windows, with a CPython 3.10 to 3.13 and its standard library, nothing else. On
Linux a host that is not Python itself must preload libpython.""",
    },
    "native": {
        "inputs": """; a derivative of an input (fmi2SetRealInputDerivatives, first order) acts over the next step that
is done, not one that is discarded, after which the input has the value that it came to. The rate of penetration is
linear in time then, the force and the weight on bit are linear in the drilled length""",
        "errors": """A bad value is logged (status error, category logStatusError) with variable, constraint and value,
and the step is discarded (fmi2Discard): nothing has moved, and the next step with good values works. Bad parameters:
fmi2ExitInitializationMode and every step give fmi2Error until fmi2Reset. Outputs that cannot be computed are NaN, with
fmi2Error. A state that is not one of this FMU's is refused with fmi2Error and changes nothing; one that is may come
from another process and another platform.""",
        "hosts": """Any. The folder binaries/ says what this FMU is compiled for; for other platforms compile
sources/fmi2.c, with any C99 compiler and no library but libm:
<code>cc -shared -fPIC -O2 -ffp-contract=off -I sources sources/fmi2.c -lm -o Borehole.so</code>.""",
    },
}


def documentation(case: Case, runtime: str) -> bytes:
    """The page for the FMU of `case` with this runtime, "python" or "native", UTF-8."""
    n = len(case.bha.stabilizer_positions)
    facts = (
        f"{n} stabilizer{'s' * (n > 1)}, the last one {case.bha.stabilizer_positions[-1]:g} m from the bit; "
        f"the existing hole ends at {degrees(case.survey.inclination[-1]):.3g}°"
    )
    rows = [_row(quantity, quantity.names(n)) for quantity in VARIABLES if quantity.names(n)]
    return PAGE.format(case=facts, variables="\n".join(rows), **TEXTS[runtime]).encode()


def _row(quantity: Quantity, names: list[str]) -> str:
    cells = [
        names[0] if len(names) == 1 else f"{names[0]} … {names[-1]}",
        quantity.symbol,
        quantity.equation,
        quantity.unit,
        quantity.range.replace(">=", "≥").replace("<=", "≤"),
        f"{quantity.role}: {quantity.meaning}",
    ]
    return "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"

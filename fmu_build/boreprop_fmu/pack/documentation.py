"""documentation/index.html of the borehole FMU: the page documentation.html, filled in."""

from html import escape
from importlib.resources import files
from math import degrees, isfinite
from string import Template

from boreprop.case.case import Case
from boreprop.core.quantities import VARIABLES, Variable

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
    """Fill in the page for the FMU of a case.

    Parameters
    ----------
    case
        What the FMU starts from.
    runtime
        "python" or "native".

    Returns
    -------
    The page, UTF-8.
    """
    page = Template(files("boreprop_fmu.pack").joinpath("documentation.html").read_text(encoding="utf-8"))
    n = len(case.bha.stabilizer_positions)
    facts = (
        f"{n} stabilizer{'s' * (n > 1)}, the last one {case.bha.stabilizer_positions[-1]:g} m from the bit; "
        f"the existing hole ends at {degrees(case.survey.inclination[-1]):.3g}°"
    )
    lines = [_line(variable, variable.names(n)) for variable in VARIABLES if variable.names(n)]
    return page.substitute(case=facts, variables="\n".join(lines), **TEXTS[runtime]).encode()


def _line(variable: Variable, names: list[str]) -> str:
    """The line of the table for one variable."""
    cells = [
        names[0] if len(names) == 1 else f"{names[0]} … {names[-1]}",
        variable.symbol,
        variable.equation,
        variable.unit,
        " ".join(f"{sign} {bound:g}" for sign, bound in (("≥", variable.min), ("≤", variable.max)) if isfinite(bound)),
        f"{variable.role}: {variable.meaning}",
    ]
    return "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"

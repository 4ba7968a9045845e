"""Fills in the page documentation.html to make the documentation/index.html of an FMU."""

from html import escape
from importlib.resources import files
from math import degrees
from string import Template

from boreprop.case.case import Case
from boreprop.core.quantities import VARIABLES, Quantity

DISCARDED = """A bad input is logged (status fmi2Error, category logStatusError) with its variable, its constraint and
its value, and the step is discarded (fmi2Discard): the state is unchanged, and the next step with good values works."""
TEXTS = {  # the passages in which the flavours differ
    "python": {
        "inputs": "",
        "errors": f"""{DISCARDED} After a bad parameter the instance must be reset (fmi2Reset). After a state that is
not a valid state of this FMU, every step is discarded until a valid one is set or the instance is reset.""",
        "hosts": """64-bit Linux and Windows, with CPython 3.10 to 3.13 and its standard library; no other package is
needed. On Linux, a host that is not Python itself must preload libpython.""",
    },
    "native": {
        "inputs": """ A derivative of an input (fmi2SetRealInputDerivatives, first order) acts over the next step that
is completed; a discarded step does not use it up. After that step the input keeps the value that it has reached. Over
the step the rate of penetration is linear in time, force and weight on bit are linear in the drilled length.""",
        "errors": f"""{DISCARDED} After bad parameters, fmi2ExitInitializationMode and every step give fmi2Error until
the instance is reset (fmi2Reset). Outputs that cannot be computed are NaN, with fmi2Error. A state that is not a valid
state of this FMU is refused with fmi2Error and changes nothing; a valid one may come from another process or platform.
""",
        "hosts": """Any. The folder binaries/ shows for which platforms this FMU is compiled. For others compile
sources/fmi2.c with a C99 compiler and the headers of FMI 2.0; it needs no library except libm:
<code>cc -shared -fPIC -O2 -ffp-contract=off -DFMI2_FUNCTION_PREFIX= -I FMI_HEADERS sources/fmi2.c -lm -o
Borehole.so</code>. Linked into a program, the functions are called after the modelIdentifier, Borehole_fmi2DoStep.""",
    },
}


def documentation(case: Case, runtime: str) -> bytes:
    """Fill in the page for the FMU of a case.

    Parameters
    ----------
    case
        The case from which the FMU starts.
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
    lines = [_line(quantity, quantity.names(n)) for quantity in VARIABLES if quantity.names(n)]
    return page.substitute(case=facts, variables="\n".join(lines), **TEXTS[runtime]).encode()


def _line(quantity: Quantity, names: list[str]) -> str:
    """The line of the table for one quantity."""
    cells = [
        names[0] if len(names) == 1 else f"{names[0]} … {names[-1]}",
        quantity.symbol,
        quantity.equation,
        quantity.unit,
        quantity.range.replace(">=", "≥").replace("<=", "≤"),
        f"{quantity.role}: {quantity.meaning}",
    ]
    return "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"

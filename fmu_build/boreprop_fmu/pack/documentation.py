"""Writes the folder documentation/ of an FMU: its page, on what it depends, and the licenses of what is in it."""

from collections.abc import Mapping
from html import escape
from importlib.resources import files
from math import degrees
from string import Template

from boreprop.case.case import Case
from boreprop.core.quantities import VARIABLES, Quantity
from boreprop.report.tables.sag import steadily_outside

from .licenses import license_text

DISCARDED = """A bad input is logged with its variable, its constraint and its value, and the step is discarded
(fmi2Discard): the state is unchanged, and the next step with good values works. Errors are logged whatever the host's
loggingOn says, and what keeps the FMU from starting is also written to stderr, as is the reason of the first discard
that is not logged."""
LIMITS = """
<h2>Where this flavour falls short of FMI 2.0</h2>
<p>It runs on the library of pythonfmu, which leaves some points of the standard out of its reach (sections of FMI 2.0.4
in brackets). The native flavour, <code>boreprop-fmu build --runtime native</code>, keeps all of them and needs no
Python.</p>
<ul>
<li>Where the standard wants fmi2Error a step is discarded: after bad parameters, beyond the stop time (2.1.6), from a
time at which the last step did not end, before the initialization and after fmi2Terminate (4.2.4). Any other call that
must not be made is logged, does nothing and gives fmi2OK, and the next step is discarded.</li>
<li>The guid and the type that a host gives to fmi2Instantiate are not compared (2.1.5).</li>
<li>fmuResourceLocation must be file:/// and a path without any escape but %20. Another form ends the host without a
word: file:/, file://localhost/, or a folder with a letter that is not ASCII or with one of # % + ( ) { } &amp; (2.1.5).
So do an instance name, a location or a logger that is NULL, and fmi2FreeFMUstate with NULL (2.1.8).</li>
<li>fmi2GetStatus gives fmi2Error instead of fmi2Discard, and what pythonfmu logs itself has no category of
modelDescription.xml (4.2.3, 2.2.4). Once a step was discarded, fmi2Terminated stays true.</li>
<li>In a host that is not Python, the interpreter ignores SIGPIPE and SIGXFSZ and takes LC_CTYPE from the environment,
for the whole process (2.1). Ctrl-C is given back to the host.</li>
<li>stepFinished is not called (2.1.5).</li>
<li>When the host's process ends, pythonfmu 0.7.0 reads memory that is freed already; where that lies badly the
process is aborted, with all results written.</li>
<li>Each instance leaves 1 kB of memory behind when it is freed (2.1.5); fmi2Reset leaves nothing.</li>
</ul>
"""
TEXTS = {  # the passages in which the flavours differ
    "python": {
        "inputs": "",
        "errors": f"""{DISCARDED} Outputs that cannot be computed are NaN. After a bad parameter the instance must be
reset (fmi2Reset). After a state that is not a valid state of this FMU, every step is discarded until a valid one is set
or the instance is reset.""",
        "hosts": """64-bit Linux and Windows, with CPython 3.10 to 3.13 and its standard library; no other package is
needed. On Linux, a host that is not Python itself must preload libpython. All that the host must have is listed in
<a href="externalDependencies.txt">externalDependencies.txt</a>.""",
        "limits": LIMITS,
    },
    "native": {
        "inputs": """ A derivative of an input (fmi2SetRealInputDerivatives, first order) acts over the next step that
is completed; a discarded step does not use it up. After that step the input keeps the value that it has reached. Over
the step the rate of penetration is linear in time, force, active weight on bit, and bit and rock are linear in the
drilled length; the other inputs are held.
fmi2GetDirectionalDerivative gives the change of any Real output with any input, as long as contacts and tilt saturation
stay as they are. fmi2GetRealOutputDerivatives, first order, gives the change in time of the outputs that cannot jump:
drilled_length, bit_inclination, average_inclination, displacement and true_vertical_depth.""",
        "errors": f"""{DISCARDED} After bad parameters, fmi2ExitInitializationMode and every step give fmi2Error until
the instance is reset (fmi2Reset). A step that does not begin where the last one ended, by more than 1e-9 of its size,
or that ends beyond the stop time gives fmi2Error and moves nothing. Outputs that cannot be computed are NaN, with
fmi2Error. A state that is not a valid state of this FMU is refused with fmi2Error and changes nothing; a valid one may
come from another process or platform.
""",
        "hosts": """Any. The folder binaries/ shows for which platforms this FMU is compiled. For others compile
sources/fmi2.c with a C99 compiler and the headers of FMI 2.0; it needs no library except libm:
<code>cc -shared -fPIC -O2 -ffp-contract=off -DFMI2_FUNCTION_PREFIX= -I FMI_HEADERS sources/fmi2.c -lm -o
$identifier.so</code>. Linked into a program, the functions are called after the modelIdentifier,
${identifier}_fmi2DoStep.""",
        "limits": "",
    },
}
IN_SPACE = """ In space θ, Θ, ψ, F and δ have two components across the bit, a disc takes the place of each pair of
walls and limits, and the lateral law is F_0 = ηΠ e<sup>iϖ</sup> ψ with the walk angle ϖ of the bit. Names that end in
_high and _right are parts to the high side and to the right of it, the names without these ends are magnitudes."""
FREE_BODY = """Between bit, pads and stabilizers nothing holds the beam: a BHA whose body lies on the wall, such as a
pendulum assembly with long collars, is not described. A published one drops 6.0 °/30 m here for 2.9 °/30 m. """
LEFT_OUT = {  # docs/limits.md, whose numbers are tested
    "active weight on bit 30 kN": "+23 %",
    "active weight on bit 90 kN": "−18 %",
    "η halved": "+20 %",
    "χ doubled": "−5 %",
    "stiffness EI a tenth less": "+6 %",
    "EI 60 % from 1 m to 4 m behind the bit, a flexible collar": "+11 %",
    "weight on bit of 120 kN in the stiffness of the beam": "+1 %",
    "last stabilizer 1.6 mm below the centre of the hole": "−0.3 %",
}
RANGES = {"active_weight_on_bit": "> 0, or 0 off bottom"}  # where the FMU takes more than the model
EXTERNAL = """\
What a host must have to run this FMU, besides what is in it

Everywhere: CPython 3.10 to 3.13, 64 bit, with its standard library, in the process of the host. No package is needed.
A host that is a Python program has it.

Linux, x86-64
    libpython: the binary does not link it. A host that is not Python itself must be started with it, for example
        LD_PRELOAD=/usr/lib/x86_64-linux-gnu/libpython3.11.so.1.0 host
    glibc 2.32 (GLIBC_2.32) or later, and the libstdc++ of GCC 12 (GLIBCXX_3.4.30) or later

Windows, x86-64
    python3.dll: put the folder of the installed Python on the PATH before the host is started
    MSVCP140.dll, VCRUNTIME140.dll and VCRUNTIME140_1.dll: Microsoft Visual C++ Redistributable 2015-2022, x64

Files: a survey, if the parameter survey_file names one.

The native flavour of this FMU (boreprop-fmu build --runtime native) needs none of these but the survey.
"""


def documents(case: Case, identifier: str, runtime: str, start: Mapping[str, float | str]) -> dict[str, bytes]:
    """The files of the folder documentation/.

    Parameters
    ----------
    case
        The case from which the FMU starts.
    identifier
        The FMU's modelIdentifier.
    runtime
        "python" or "native".
    start
        Start value of every input and parameter, by scalar name.

    Returns
    -------
    Path in the FMU → content.

    Raises
    ------
    InputError
        If a package is installed without its license.
    """
    written = {"index.html": page(case, identifier, runtime, start), "licenses/license.txt": license_text("boreprop")}
    if runtime == "python":
        written |= {"externalDependencies.txt": EXTERNAL, "licenses/pythonfmu.txt": license_text("pythonfmu")}
    else:
        third_party = files("boreprop.kernel").joinpath("THIRD_PARTY.txt")
        written["licenses/third_party.txt"] = third_party.read_text(encoding="utf-8")
    return {f"documentation/{name}": text.encode() for name, text in written.items()}


def page(case: Case, identifier: str, runtime: str, start: Mapping[str, float | str]) -> str:
    """The page of an FMU, of which documentation.html is the frame; parameters as of `documents`."""
    frame = Template(files("boreprop_fmu.pack").joinpath("documentation.html").read_text(encoding="utf-8"))
    n = len(case.bha.stabilizer_positions)
    facts = (
        f"{n} stabilizer{'s' * (n > 1)}, the last one {case.bha.stabilizer_positions[-1]:g} m from the bit; "
        f"the existing hole ends at {degrees(case.survey.inclination[-1]):.3g}°"
    )
    lines = [_line(quantity, names, start) for quantity in VARIABLES if (names := quantity.names(case.structure))]
    warning = steadily_outside(case)
    outside = f" Of this case, drilled on steadily: {warning}." if warning else ""
    left_out = "\n".join(f"<tr><td>{what}</td><td>{change}</td></tr>" for what, change in LEFT_OUT.items())
    own = {
        "where": "in space" if case.in_space else "in a vertical plane",
        "directions": IN_SPACE if case.in_space else "",
        "assumptions": assumptions(case),
        "left_out": left_out,
        "case": facts,
        "identifier": identifier,
        "variables": "\n".join(lines),
        "outside": outside,
    }
    texts = {name: Template(text).substitute(own) for name, text in TEXTS[runtime].items()}
    return frame.substitute(own, **texts)


def assumptions(case: Case) -> str:
    """What the model leaves out of a case, in sentences."""
    bha = case.bha
    held = [
        "friction and torque are left out",
        "the rock is the same in every direction",
        *["the axial load does not change the stiffness of the beam"] * (not bha.axial_load),
        *["the beam is the same all along"] * (not bha.section_lengths),
        *["the hole is planar"] * (not case.in_space),
    ]
    text = f"{', '.join(held[:-1])}, and {held[-1]}."
    return FREE_BODY * (not bha.body_point_positions) + text[0].upper() + text[1:]


def _line(quantity: Quantity, names: list[str], start: Mapping[str, float | str]) -> str:
    """The line of the table for one quantity."""
    cells = [
        names[0] if len(names) == 1 else f"{names[0]} … {names[-1]}",
        quantity.symbol,
        quantity.equation,
        quantity.unit,
        RANGES.get(quantity.name, quantity.range).replace(">=", "≥").replace("<=", "≤"),
        ", ".join(f"{start[name]}" for name in names if name in start),
        f"{quantity.role}: {quantity.meaning}",
    ]
    return "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"

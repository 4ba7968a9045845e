"""modelDescription.xml of the borehole FMU, from the table of variables."""

from collections.abc import Mapping, Sequence
from importlib.metadata import version
from math import isfinite, pi
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from boreprop.core.quantities import VARIABLES, Variable

UNITS: dict[str, tuple[dict[str, int], tuple[str, float] | None]] = {
    # unit: its SI base units, the unit to show it in and how many of those it is
    "1": ({}, None),
    "N": ({"kg": 1, "m": 1, "s": -2}, ("kN", 1e-3)),
    "N.m": ({"kg": 1, "m": 2, "s": -2}, ("kN.m", 1e-3)),
    "N.m2": ({"kg": 1, "m": 3, "s": -2}, ("kN.m2", 1e-3)),
    "N/m": ({"kg": 1, "s": -2}, None),
    "m": ({"m": 1}, None),
    "m/s": ({"m": 1, "s": -1}, ("m/h", 3600.0)),
    "rad": ({"rad": 1}, ("deg", 180 / pi)),
    "rad/m": ({"rad": 1, "m": -1}, ("deg/30m", 30 * 180 / pi)),
}

DIRECT: dict[str, tuple[str, ...]] = {
    # output: the inputs that it follows at once, without any drilling; eqs. (10), (14), (16), (17), (21)
    "borehole_inclination": ("rss_force", "active_weight_on_bit"),
    "bit_tilt": ("rss_force", "active_weight_on_bit"),
    "stabilizer_deflection": ("rss_force",),
    "stabilizer_force": ("rss_force",),
    "stabilizer_contact": ("rss_force",),
    "bit_tilt_saturation": ("rss_force", "active_weight_on_bit"),
    "bit_lateral_force": ("rss_force",),
    "bit_moment": ("rss_force",),
    "borehole_curvature": ("rss_force", "active_weight_on_bit"),
    "eta_pi": ("active_weight_on_bit",),
}

LOG_CATEGORIES = {"logStatusError": "Bad input, and why a step was discarded."}


def model_description(
    identifier: str,
    guid: str,
    n: int,
    start: Mapping[str, float | str],
    *,
    stop_time: float,
    step_size: float,
    capabilities: Mapping[str, bool],
    source_files: Sequence[str] = (),
) -> bytes:
    """The XML document.

    Parameters
    ----------
    identifier
        Model name and file name of the binaries.
    guid
        The FMU's identity.
    n
        Number of stabilizers.
    start
        Start value of every input and parameter, by scalar name.
    stop_time, step_size
        The default experiment, s.
    capabilities
        Attributes of the element CoSimulation.
    source_files
        What is to be compiled of the folder sources/.
    """
    root = Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=identifier,
        guid=guid,
        description="Borehole propagation of a directional drilling system: a delay complementarity model",
        version=version("boreprop"),
        generationTool=f"boreprop {version('boreprop')}",
        variableNamingConvention="structured",
    )
    flags = {name: str(value).lower() for name, value in capabilities.items()}
    simulation = SubElement(root, "CoSimulation", {"modelIdentifier": identifier, **flags})
    if source_files:
        files = SubElement(simulation, "SourceFiles")
        for name in source_files:
            SubElement(files, "File", name=name)
    _add_units(SubElement(root, "UnitDefinitions"))
    categories = SubElement(root, "LogCategories")
    for name, meaning in LOG_CATEGORIES.items():
        SubElement(categories, "Category", name=name, description=meaning)
    SubElement(root, "DefaultExperiment", startTime="0.0", stopTime=repr(stop_time), stepSize=repr(step_size))
    scalars = [(name, variable) for variable in VARIABLES for name in variable.names(n)]
    variables = SubElement(root, "ModelVariables")
    for reference, (name, variable) in enumerate(scalars):
        _add_variable(variables, name, reference, variable, start)
    _add_structure(SubElement(root, "ModelStructure"), scalars)
    indent(root)
    document: bytes = tostring(root, encoding="utf-8", xml_declaration=True)
    return document + b"\n"


def _add_units(units: Element) -> None:
    for name, (base, display) in UNITS.items():
        unit = SubElement(units, "Unit", name=name)
        SubElement(unit, "BaseUnit", {symbol: str(exponent) for symbol, exponent in base.items()})
        if display:
            SubElement(unit, "DisplayUnit", name=display[0], factor=repr(display[1]))


def _add_variable(
    variables: Element, name: str, reference: int, variable: Variable, start: Mapping[str, float | str]
) -> None:
    source = ", ".join(part for part in (variable.symbol, variable.equation and f"eq. {variable.equation}") if part)
    attributes = {
        "name": name,
        "valueReference": str(reference),
        "description": f"{variable.meaning} [{source}]" if source else variable.meaning,
        "causality": variable.role,
        "variability": "continuous" if variable.kind == "Real" else "discrete",
    }
    if variable.role == "parameter":
        attributes |= {"variability": "fixed", "initial": "exact"}
    if variable.role == "output":
        attributes |= {"initial": "calculated"}
    scalar = SubElement(variables, "ScalarVariable", attributes)
    typed = SubElement(scalar, variable.kind)
    if variable.kind == "Real":
        unit = variable.unit or "1"
        typed.set("unit", unit)
        display = UNITS[unit][1]
        if display:
            typed.set("displayUnit", display[0])
        typed.set("nominal", repr(variable.nominal))
    number = repr if variable.kind == "Real" else "{:d}".format
    if isfinite(variable.min):
        typed.set("min", number(variable.min))
    if isfinite(variable.max):
        typed.set("max", number(variable.max))
    if name in start:
        value = start[name]
        typed.set("start", value if isinstance(value, str) else repr(value))


def _add_structure(structure: Element, scalars: list[tuple[str, Variable]]) -> None:
    index = {name: str(i) for i, (name, _) in enumerate(scalars, start=1)}
    outputs = [(name, variable) for name, variable in scalars if variable.role == "output"]
    unknowns = SubElement(structure, "Outputs")
    for name, variable in outputs:
        depends_on = " ".join(index[source] for source in DIRECT.get(variable.name, ()))
        SubElement(unknowns, "Unknown", index=index[name], dependencies=depends_on)
    unknowns = SubElement(structure, "InitialUnknowns")
    for name, _ in outputs:  # no dependencies named: they depend on everything
        SubElement(unknowns, "Unknown", index=index[name])
